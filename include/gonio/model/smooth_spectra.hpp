#pragma once
/// Spectra for colours: lets a spectral renderer use a material that is known only in RGB.
///
/// Smits, "An RGB-to-Spectrum Conversion for Reflectances", Journal of Graphics Tools 4(4), 1999
/// (doi:10.1080/10867651.1999.10487511): a colour is a non-negative sum of white, a secondary and a primary colour.
/// Here each of these seven spectra is the smoothest non-negative spectrum with exactly its colour.

#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::model {

/// Gives each linear Rec. 709 colour a spectrum: linear between its wavelengths, constant outside. Under D65, the
/// spectrum has the given colour for the observer of core/spectrum.hpp. A colour without negative channels has a
/// spectrum without negative values. Among colours whose channels have the same order by size, the spectrum is a linear
/// function of the colour.
class smooth_spectra {
 public:
  /// Uses wavelengths from 380 to 760 nanometres in steps of 20.
  smooth_spectra();

  /// Takes wavelengths in nanometres. Throws gonio::error unless they ascend, and if some primary colour has no
  /// spectrum at them. Solves six quadratic programs.
  explicit smooth_spectra(std::vector<double> wavelengths);

  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }

  /// Returns the values at the wavelengths. O(wavelengths).
  [[nodiscard]] Eigen::ArrayXd operator()(const rgb& colour) const;

 private:
  std::vector<double> wavelengths_;
  Eigen::ArrayXXd primaries_, secondaries_;  ///< primaries: red, green, blue; secondaries: white without each of these
};

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/smooth_spectra.ipp>
#endif
