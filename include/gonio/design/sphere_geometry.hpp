#pragma once
/// Images of a sphere of the material (Marschner et al. 2000, doi:10.1364/AO.39.002592; Nielsen et al. 2015,
/// doi:10.1145/2816795.2818085, section 6). If light and camera are far away, all points of the sphere have the same
/// theta_d, half the angle between light and camera. The image shows every (theta_h, phi_d) at which light and camera
/// are above the horizon.

#include <gonio/design/capture_geometry.hpp>

#include <Eigen/Core>

#include <numeric>

namespace gonio::design {

/// Has one candidate for each theta_d of a grid: the candidate's samples are all valid cells with this theta_d, each
/// once.
class sphere_geometry {
 public:
  /// Light and camera must be at least `smallest_separation` radians apart.
  explicit sphere_geometry(valid_cells cells, double smallest_separation = 0.0)
      : cells_(std::move(cells)), smallest_separation_(smallest_separation) {}

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] Eigen::Index size() const noexcept { return cells_.grid().extents().theta_d; }
  [[nodiscard]] bool allows(Eigen::Index slice) const {
    return !cells_of(slice).empty() && 2.0 * cells_.grid().theta_d(static_cast<int>(slice)) >= smallest_separation_;
  }

  /// Returns the pair at the point where the sphere's normal is midway between light and camera.
  [[nodiscard]] direction_pair centre(Eigen::Index slice) const {
    return to_directions({0.0, cells_.angles(cells_of(slice).front()).theta_d, 0.0});
  }
  [[nodiscard]] Eigen::Index nearest(const direction_pair& pair) const {
    return cells_.grid().nearest(to_half_difference(pair.wi, pair.wo)).theta_d;
  }

  [[nodiscard]] std::vector<half_difference> directions(Eigen::Index slice) const;

  [[nodiscard]] std::optional<Eigen::Index> stepped(Eigen::Index from, const grid_step& step) const;

  /// Returns the valid cells of the slice with one theta_d.
  [[nodiscard]] std::vector<Eigen::Index> cells_of(Eigen::Index slice) const;

 private:
  valid_cells cells_;
  double smallest_separation_;
};
static_assert(capture_geometry<sphere_geometry>);

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/sphere_geometry.ipp>
#endif
