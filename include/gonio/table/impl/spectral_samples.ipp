#pragma once
/// Bodies of table/spectral_samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/table/spectral_samples.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace gonio {

GONIO_INLINE sample_set spectral_samples::at_wavelength(Eigen::Index band) const {
  sample_set samples;
  samples.reserve(directions.size());
  for (Eigen::Index i = 0; i < size(); ++i)
    samples.push_back({directions[i], rgb::Constant(double{values(i, band)}), weight(i)});
  return samples;
}

GONIO_INLINE sample_set spectral_samples::colours(illuminant light) const {
  if (bands() == 1) return at_wavelength(0);
  const spectral_colour colour(wavelengths, light);
  sample_set samples;
  samples.reserve(directions.size());
  for (Eigen::Index i = 0; i < size(); ++i) samples.push_back({directions[i], colour(spectrum(i)), weight(i)});
  return samples;
}

GONIO_INLINE sample_set spectral_samples::in_three_channels(illuminant light) const {
  if (bands() == 1 || std::ranges::any_of(wavelengths, is_visible)) return colours(light);
  sample_set samples;
  samples.reserve(directions.size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    rgb means;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Eigen::Index first = c * bands() / 3, end = std::max((c + 1) * bands() / 3, first + 1);
      means[c] = values.row(i).segment(first, end - first).cast<double>().mean();
    }
    samples.push_back({directions[i], means, weight(i)});
  }
  return samples;
}

GONIO_INLINE spectral_samples spectral_samples::subset(std::span<const Eigen::Index> positions) const {
  spectral_samples some{wavelengths, {}, cell_matrix(std::ssize(positions), values.cols())};
  for (Eigen::Index to = 0; to < std::ssize(positions); ++to) {
    some.directions.push_back(directions[positions[to]]);
    for (Eigen::Index band = 0; band < values.cols(); ++band) some.values(to, band) = values(positions[to], band);
    if (!weights.empty()) some.weights.push_back(weights[positions[to]]);
  }
  return some;
}

GONIO_INLINE void require_usable(const spectral_samples& samples) {
  require_wavelengths(samples.wavelengths);
  const Eigen::Index n = samples.size();
  if (n == 0) detail::refuse_no_samples();
  if (samples.values.rows() != n || samples.values.cols() != samples.bands() ||
      (!samples.weights.empty() && std::ssize(samples.weights) != n))
    refuse({n, " spectral samples at ", samples.bands(), " wavelengths have ", samples.values.rows(), " x ",
            samples.values.cols(), " values and ", samples.weights.size(), " weights"});
  for (Eigen::Index i = 0; i < n; ++i) {
    detail::require_usable_sample({samples.directions[i], rgb::Zero(), samples.weight(i)}, i + 1);
    for (Eigen::Index band = 0; band < samples.bands(); ++band)
      if (!std::isfinite(samples.values(i, band)))
        refuse({"sample ", i + 1, ": the reflectance at wavelength ", band + 1, " is not finite"});
  }
}

}  // namespace gonio
