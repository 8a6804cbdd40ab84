#pragma once
/// Spectra for colours: lets a spectral renderer use a material that is known only in RGB.
///
/// Smits, "An RGB-to-Spectrum Conversion for Reflectances", Journal of Graphics Tools 4(4), 1999
/// (doi:10.1080/10867651.1999.10487511): a colour is a non-negative sum of white, a secondary and a primary colour.
/// Here the seven spectra are the smoothest non-negative ones with exactly that colour.

#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::model {

/// A spectrum for each linear Rec. 709 colour: linear between its wavelengths, constant outside. Under D65 it has that
/// colour for the observer of core/spectrum.hpp. It is not negative if the colour is not. It is linear among colours
/// whose channels have the same order.
class smooth_spectra {
 public:
  /// Wavelengths from 380 to 760 nanometres, every 20.
  smooth_spectra();

  /// Takes wavelengths in nanometres. Throws gonio::error unless they ascend, and if no spectrum at them has a primary
  /// colour. Solves six quadratic programs.
  explicit smooth_spectra(std::vector<double> wavelengths);

  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }

  /// Returns the values at the wavelengths. O(wavelengths).
  [[nodiscard]] Eigen::ArrayXd operator()(const rgb& colour) const;

 private:
  std::vector<double> wavelengths_;
  Eigen::ArrayXXd primaries_, secondaries_;  ///< columns: red, green, blue; and white without each of them
};

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/smooth_spectra.ipp>
#endif
