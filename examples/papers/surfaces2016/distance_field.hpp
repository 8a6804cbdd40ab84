#pragma once
/// A surface as the zero of a field of signed distances, which is a Gaussian Markov random field over voxels near it:
/// the rival of "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V, section
/// 4), after Paulsen, Baerentzen and Larsen, "Markov random field surface reconstruction" (IEEE TVCG 16(4), 2010).

#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace papers {

/// How a field is found. Millimetres.
struct distance_field_options {
  double spacing = 0.35;     ///< of the voxels
  double band = 2.5;         ///< voxels are at most as far from where the surface is expected
  double reach = 1.0;        ///< a voxel is observed if the scan is at most as far away
  double smoothness = 0.01;  ///< lambda: how much the prior counts beside an observation, in voxels
};

/// Where voxels are: a part of a grid.
class voxel_band {
 public:
  /// The voxels at most `options.band` from any of the points.
  voxel_band(const gonio::shape::point_columns& near, const distance_field_options& options);

  [[nodiscard]] Eigen::Index size() const noexcept { return std::ssize(voxels_); }
  [[nodiscard]] Eigen::Vector3d centre(Eigen::Index voxel) const;
  /// The number of a voxel; -1 if it is not in the band.
  [[nodiscard]] int at(const Eigen::Array3i& place) const;
  [[nodiscard]] int neighbour(Eigen::Index voxel, Eigen::Index axis, int step) const;
  /// In voxels, from the centre of the grid's first one.
  [[nodiscard]] Eigen::Vector3d grid_place(const Eigen::Vector3d& point) const { return (point - origin_) / spacing_; }
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

 private:
  double spacing_;
  Eigen::Vector3d origin_;  ///< the centre of the first voxel
  Eigen::Array3i extent_;
  std::vector<int> numbers_;  ///< of all voxels of the grid
  std::vector<Eigen::Array3i> voxels_;
};

/// The distances d that minimise sum_observed (d_i - o_i)^2 + lambda sum_i (sum of the six neighbours - 6 d_i)^2: the
/// most probable field, by a sparse Cholesky factorisation. The second sum is over voxels whose neighbours are all in
/// the band. What is observed is the signed distance to the scan, unless its closest place is on a border: there the
/// surface goes on, and nothing is known.
class distance_field {
 public:
  /// `near` are points near the whole surface, also where the scan has a hole. Throws gonio::error if the observations
  /// do not determine the field.
  distance_field(const gonio::shape::surface_index& scan, const gonio::shape::point_columns& near,
                 const distance_field_options& options);

  /// The points moved along the field's gradient to where it is zero. Those that leave the band stay where they left
  /// it; `lost` counts them.
  [[nodiscard]] gonio::shape::point_columns on_surface(gonio::shape::point_columns points, Eigen::Index& lost) const;

 private:
  /// The field and its gradient, trilinear between voxels.
  struct value_and_gradient {
    double value = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    bool is_inside = true;  ///< the band
  };
  [[nodiscard]] value_and_gradient at(const Eigen::Vector3d& point) const;

  voxel_band band_;
  Eigen::VectorXd distances_;
};

}  // namespace papers
