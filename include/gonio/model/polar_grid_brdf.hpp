#pragma once
/// Isotropic materials on a uniform grid of both polar angles and of the azimuth difference: the format of measurements
/// in renderers for NVIDIA's Material Definition Language (MDL specification 1.10.2, appendix B).

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace gonio::model {

/// The number of cells along each axis, all of equal angular size. At azimuth 0 the viewer is on the light's side, at
/// 180 degrees on the side of the mirror direction.
struct polar_grid {
  Eigen::Index polar = 90;     ///< cells of theta_i from 0 to 90 degrees, and of theta_o
  Eigen::Index azimuth = 180;  ///< cells of |phi_o - phi_i| from 0 to 180 degrees

  [[nodiscard]] Eigen::Index size() const noexcept { return polar * polar * azimuth; }

  friend bool operator==(const polar_grid&, const polar_grid&) = default;
};

/// A BRDF in sr^-1 given at the centres of the cells of a polar grid. It is trilinear between centres and constant
/// outside the outermost centres. A value type; copies share the values.
///
/// Measurements are not reciprocal. The `brdf` concept requires reciprocity, so the value is the mean of f(wi, wo) and
/// f(wo, wi), as in MDL's renderers. `as_measured` returns f(wi, wo).
class polar_grid_brdf {
 public:
  /// Takes one value for each cell, or three (linear Rec. 709). theta_i varies slowest, then theta_o, then the azimuth.
  /// Throws gonio::error unless the number of values matches and all are finite.
  polar_grid_brdf(const polar_grid& grid, std::vector<float> values);

  [[nodiscard]] const polar_grid& grid() const noexcept { return grid_; }
  [[nodiscard]] std::span<const float> values() const noexcept { return *values_; }
  /// 1 or 3.
  [[nodiscard]] Eigen::Index channels() const noexcept { return channels_; }

  /// Returns zero below the horizon. O(1).
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return 0.5 * (as_measured(wi, wo) + as_measured(wo, wi));
  }

  /// Returns the value with the light at `wi` and the viewer at `wo`.
  [[nodiscard]] rgb as_measured(const direction& wi, const direction& wo) const noexcept;

 private:
  polar_grid grid_;
  Eigen::Index channels_ = 3;
  std::shared_ptr<const std::vector<float>> values_;
};

static_assert(brdf<polar_grid_brdf>);

/// Returns the directions at the centre of a cell. The light's azimuth is 0.
[[nodiscard]] direction_pair directions_of(const polar_grid& grid, Eigen::Index cell) noexcept;

/// Throws gonio::error unless each axis has a cell, theta has at most 360 and phi at most 720 (1.1 GB).
void require_polar_grid(const polar_grid& grid);

/// Evaluates a BRDF at the centres of all cells: one channel if it is grey everywhere, otherwise three. A grid has one
/// value for viewers on both sides of the plane of light and normal. Measured tables may differ between the two sides,
/// so the value is the mean of both. Throws gonio::error like `require_polar_grid`, and for values that are not finite.
/// The bytes do not depend on the number of threads.
template <brdf Brdf>
[[nodiscard]] polar_grid_brdf tabulate_polar(const Brdf& f, const polar_grid& grid = {}, thread_count threads = {}) {
  require_polar_grid(grid);
  std::vector<float> values(3 * grid.size());
  for_each_index(
      grid.size(), 4096,
      [&](Eigen::Index cell) {
        const auto [wi, wo] = directions_of(grid, cell);
        const rgb value = 0.5 * (rgb(f(wi, wo)) + rgb(f(wi, direction(wo.x(), -wo.y(), wo.z()))));
        for (Eigen::Index c = 0; c < 3; ++c) values[3 * cell + c] = static_cast<float>(value[c]);
      },
      threads);
  bool grey = true;
  for (Eigen::Index cell = 0; grey && cell < grid.size(); ++cell)
    grey = values[3 * cell] == values[3 * cell + 1] && values[3 * cell] == values[3 * cell + 2];
  if (grey) {
    for (Eigen::Index cell = 0; cell < grid.size(); ++cell) values[cell] = values[3 * cell];
    values.resize(grid.size());
  }
  return {grid, std::move(values)};
}

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/polar_grid_brdf.ipp>
#endif
