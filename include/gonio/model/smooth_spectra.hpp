#pragma once
/// Spectra for colours: what a spectral renderer is given of a material that is known in RGB alone.
///
/// Smits, "An RGB-to-Spectrum Conversion for Reflectances", Journal of Graphics Tools 4(4), 1999
/// (doi:10.1080/10867651.1999.10487511): a colour is a sum of white, of a secondary and of a primary colour, none of
/// them negative. Here the seven spectra are the smoothest that are not negative and have exactly that colour.

#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::model {

/// A spectrum for each linear Rec. 709 colour: linear between its wavelengths, constant outside. Under D65 it has that
/// colour, for the observer of core/spectrum.hpp; it is not negative if the colour is not. Linear in colours of which
/// the channels have one order.
class smooth_spectra {
 public:
  /// From 380 to 760 nanometres, every 20.
  smooth_spectra();

  /// At wavelengths in nanometres. Throws gonio::error unless they ascend, and if no spectrum of them has one of the
  /// primary colours. Solves six quadratic programs.
  explicit smooth_spectra(std::vector<double> wavelengths);

  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }

  /// The values at the wavelengths. O(wavelengths).
  [[nodiscard]] Eigen::ArrayXd operator()(const rgb& colour) const;

 private:
  std::vector<double> wavelengths_;
  Eigen::ArrayXXd primaries_, secondaries_;  ///< columns: red, green, blue, and what white lacks without each
};

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/smooth_spectra.ipp>
#endif
