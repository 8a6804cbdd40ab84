#pragma once
/// Bodies of estimate/reconstructed.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/reconstructed.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE double deviations_of(confidence_level level, Eigen::Index samples, double unknown) noexcept {
  const auto n = static_cast<double>(std::max<Eigen::Index>(samples, 1));
  // The posterior uses only 500 samples. With more, the estimate is better near them, but not where a twentieth of the
  // variance remains. The factor was measured up to 20,000 samples.
  const double many = std::pow(std::clamp(500.0 / n, 1.0 / 40.0, 1.0), 1.0 / 7.0),
               here = many + (1.0 - many) * std::min(20.0 * unknown, 1.0);
  if (level == confidence_level::ninety_five_percent) return 1.85 * here;
  return 0.5 * (here + unknown * std::sqrt(unknown));
}

namespace detail {

GONIO_INLINE const valid_cells& certainty_cells() {
  static const valid_cells cells(grid({15, 9, 12}));
  return cells;
}

GONIO_INLINE std::vector<half_difference> highlight_angles() {
  std::vector<half_difference> all;
  for (int theta_h = 0; theta_h < 5; ++theta_h)
    for (int theta_d = 5; theta_d < 70; theta_d += 10)
      for (int phi_d = 0; phi_d < 180; phi_d += 30) all.push_back({radians(theta_h), radians(theta_d), radians(phi_d)});
  return all;
}

GONIO_INLINE certainty certainty_of(std::vector<double> everywhere, std::vector<double> highlight, double measured_to) {
  const valid_cells& cells = certainty_cells();
  std::vector<double> grazing, beyond;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const half_difference angles = cells.angles(cell);
    const cosine_pair cosine = cosines(angles);
    if (std::min(cosine.i, cosine.o) < std::cos(radians(80.0))) grazing.push_back(everywhere[cell]);
    if (angles.theta_h > measured_to + radians(4.0)) beyond.push_back(everywhere[cell]);
  }
  certainty known{.known_to = std::expm1(median(std::move(everywhere))),
                  .known_to_at_grazing = std::expm1(median(std::move(grazing))),
                  .highlight_factor = std::exp(median(std::move(highlight))),
                  .measured_to = measured_to};
  if (5 * std::ssize(beyond) >= cells.size()) known.known_to_outside = std::expm1(median(std::move(beyond)));
  return known;
}

}  // namespace detail

}  // namespace gonio
