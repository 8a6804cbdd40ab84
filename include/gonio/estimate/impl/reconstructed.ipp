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

GONIO_INLINE double deviations_of(confidence_level level, double unknown) noexcept {
  if (level == confidence_level::ninety_five_percent) return 1.85;
  return 0.5 * (1.0 + unknown * std::sqrt(unknown));
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
  std::vector<double> grazing, outside;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const half_difference angles = cells.angles(cell);
    const cosine_pair cosine = cosines(angles);
    if (std::min(cosine.i, cosine.o) < std::cos(radians(80.0))) grazing.push_back(everywhere[cell]);
    if (angles.theta_h > measured_to + radians(4.0)) outside.push_back(everywhere[cell]);
  }
  certainty known{.known_to = std::expm1(median(std::move(everywhere))),
                  .known_to_at_grazing = std::expm1(median(std::move(grazing))),
                  .highlight_factor = std::exp(median(std::move(highlight))),
                  .measured_to = measured_to};
  if (5 * std::ssize(outside) >= cells.size()) known.known_to_outside = std::expm1(median(std::move(outside)));
  return known;
}

}  // namespace detail

}  // namespace gonio
