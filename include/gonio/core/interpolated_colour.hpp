#pragma once
/// Colours of spectra that are linear between a few wavelengths.

#include <gonio/core/spectrum.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace gonio {

/// Returns a matrix (3 x wavelengths) that converts reflectances at the wavelengths to red, green and blue. The
/// spectrum is linear between the wavelengths and constant outside, as renderers read spectra. Integrates in steps of 1
/// nm. Throws gonio::error for wavelengths that `spectral_colour` refuses.
[[nodiscard]] inline Eigen::MatrixXd interpolated_colour(std::span<const double> wavelengths) {
  static_cast<void>(spectral_colour(wavelengths));  // throws for an invalid spectrum
  std::vector<double> fine;
  for (int nanometres = 360; nanometres <= 830; ++nanometres) fine.push_back(nanometres);
  const spectral_colour colour(fine);
  Eigen::MatrixXd weights(3, std::ssize(wavelengths));
  std::vector<double> hat(fine.size());
  for (Eigen::Index i = 0; i < weights.cols(); ++i) {
    const double here = wavelengths[i], before = wavelengths[i == 0 ? 0 : i - 1],
                 after = wavelengths[std::min(i + 1, weights.cols() - 1)];
    for (std::size_t j = 0; j < fine.size(); ++j) {
      const double at = fine[j], step = at < here ? here - before : after - here;
      hat[j] = step > 0.0 ? std::max(1.0 - std::abs(at - here) / step, 0.0) : 1.0;
    }
    const rgb here_alone = colour(hat);
    for (Eigen::Index c = 0; c < 3; ++c) weights(c, i) = here_alone[c];
  }
  return weights;
}

}  // namespace gonio
