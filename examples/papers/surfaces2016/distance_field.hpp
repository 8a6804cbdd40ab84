#pragma once
/// A surface as the zero set of a field of signed distances, a Gaussian Markov random field over nearby voxels.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V, section 4) compares
/// with this method of Paulsen, Baerentzen and Larsen, "Markov random field surface reconstruction" (IEEE TVCG 16(4),
/// 2010).

#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace papers {

/// Options of the field, in millimetres.
struct distance_field_options {
  double spacing = 0.35;     ///< of the voxels
  double band = 2.5;         ///< largest distance of a voxel from the expected surface
  double reach = 1.0;        ///< largest distance between scan and observed voxels
  double smoothness = 0.01;  ///< lambda: weight of the prior relative to an observation, in voxels
};

/// The voxels of the field: a part of a grid.
class voxel_band {
 public:
  /// Takes the voxels at most `options.band` from any of the points.
  voxel_band(const gonio::shape::point_columns& near, const distance_field_options& options);

  [[nodiscard]] Eigen::Index size() const noexcept { return std::ssize(voxels_); }
  [[nodiscard]] Eigen::Vector3d centre(Eigen::Index voxel) const;
  /// Returns the number of a voxel; -1 if it is not in the band.
  [[nodiscard]] int at(const Eigen::Array3i& coordinates) const;
  [[nodiscard]] int neighbour(Eigen::Index voxel, Eigen::Index axis, int step) const;
  /// Returns a position in voxels, from the centre of the grid's first voxel.
  [[nodiscard]] Eigen::Vector3d grid_coordinates(const Eigen::Vector3d& point) const {
    return (point - origin_) / spacing_;
  }
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

 private:
  double spacing_;
  Eigen::Vector3d origin_;  ///< the centre of the first voxel
  Eigen::Array3i extent_;
  std::vector<int> numbers_;  ///< of all voxels of the grid; -1 outside the band
  std::vector<Eigen::Array3i> voxels_;
};

/// The most probable field, by a sparse Cholesky factorisation: the distances d that minimise sum_observed (d_i -
/// o_i)^2 + lambda sum_i (sum of the six neighbours - 6 d_i)^2. The second sum is over voxels whose neighbours are all
/// in the band. The observations o are signed distances to the scan. A voxel whose closest point is on a border of the
/// scan is not observed, because the surface continues there.
class distance_field {
 public:
  /// `near` holds points near the whole surface, including the holes of the scan. Throws gonio::error if the
  /// observations do not determine the field.
  distance_field(const gonio::shape::surface_index& scan, const gonio::shape::point_columns& near,
                 const distance_field_options& options);

  /// Moves the points along the field's gradient to its zero. `lost` counts the points that leave the band or do not
  /// converge; these stay where the search ends.
  [[nodiscard]] gonio::shape::point_columns on_surface(gonio::shape::point_columns points, Eigen::Index& lost) const;

 private:
  /// The field and its gradient, interpolated trilinearly between voxels.
  struct value_and_gradient {
    double value = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    bool is_inside = true;  ///< whether the point is in the band
  };
  [[nodiscard]] value_and_gradient at(const Eigen::Vector3d& point) const;

  voxel_band band_;
  Eigen::VectorXd distances_;
};

}  // namespace papers
