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

GONIO_INLINE double deviations_of(confidence_level level, Eigen::Index samples) noexcept {
  const auto n = static_cast<double>(std::max<Eigen::Index>(samples, 1));
  // Of more than 500 samples the posterior knows 500; what the estimate gains by the others was measured to 20,000.
  const double many = std::pow(std::clamp(500.0 / n, 1.0 / 40.0, 1.0), 1.0 / 7.0);
  return many * (level == confidence_level::sixty_eight_percent ? 0.51 : 1.85);
}

namespace detail {

GONIO_INLINE const valid_cells& certainty_cells() {
  static const valid_cells cells(grid({15, 9, 12}));
  return cells;
}

GONIO_INLINE bool is_grazing(const half_difference& angles) {
  const cosine_pair cosine = cosines(angles);
  return std::min(cosine.i, cosine.o) < std::cos(radians(80.0));
}

GONIO_INLINE std::vector<half_difference> highlight_angles() {
  std::vector<half_difference> all;
  for (int theta_h = 0; theta_h < 5; ++theta_h)
    for (int theta_d = 5; theta_d < 70; theta_d += 10)
      for (int phi_d = 0; phi_d < 180; phi_d += 30) all.push_back({radians(theta_h), radians(theta_d), radians(phi_d)});
  return all;
}

GONIO_INLINE certainty certainty_of(std::vector<double> everywhere, std::vector<double> grazing,
                                    std::vector<double> highlight, Eigen::Index samples) {
  const double reach = deviations_of(confidence_level::sixty_eight_percent, samples),
               far_reach = deviations_of(confidence_level::ninety_five_percent, samples);
  return {.known_to = std::expm1(reach * median(std::move(everywhere))),
          .known_to_at_grazing = std::expm1(reach * median(std::move(grazing))),
          .highlight_factor = std::exp(far_reach * median(std::move(highlight)))};
}

}  // namespace detail

}  // namespace gonio
