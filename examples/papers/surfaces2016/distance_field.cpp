#include "papers/surfaces2016/distance_field.hpp"

#include <gonio/core/error.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace papers {

voxel_band::voxel_band(const gonio::shape::point_columns& near, const distance_field_options& options)
    : spacing_(options.spacing) {
  const Eigen::Vector3d lowest = near.rowwise().minCoeff().array() - options.band - spacing_,
                        highest = near.rowwise().maxCoeff().array() + options.band + spacing_;
  origin_ = lowest;
  extent_ = ((highest - lowest) / spacing_).array().ceil().cast<int>() + 1;
  numbers_.assign(static_cast<std::size_t>(extent_.prod()), -1);
  // Mark the voxels near each point, then number them in the grid's order.
  const int around = static_cast<int>(std::ceil(options.band / spacing_));
  const auto index = [&](const Eigen::Array3i& coordinates) {
    return coordinates.x() + static_cast<std::size_t>(extent_.x()) * (coordinates.y() + extent_.y() * coordinates.z());
  };
  for (const auto& point : near.colwise()) {
    const Eigen::Array3i middle = grid_coordinates(point).array().round().cast<int>();
    for (int z = -around; z <= around; ++z)
      for (int y = -around; y <= around; ++y)
        for (int x = -around; x <= around; ++x) {
          const Eigen::Array3i coordinates = middle + Eigen::Array3i(x, y, z);
          if ((coordinates < 0).any() || (coordinates >= extent_).any()) continue;
          const Eigen::Vector3d centre = origin_ + spacing_ * coordinates.cast<double>().matrix();
          if ((centre - point).norm() <= options.band) numbers_[index(coordinates)] = 0;
        }
  }
  for (int z = 0; z < extent_.z(); ++z)
    for (int y = 0; y < extent_.y(); ++y)
      for (int x = 0; x < extent_.x(); ++x) {
        int& number = numbers_[index({x, y, z})];
        if (number < 0) continue;
        number = static_cast<int>(voxels_.size());
        voxels_.emplace_back(x, y, z);
      }
}

Eigen::Vector3d voxel_band::centre(Eigen::Index voxel) const {
  return origin_ + spacing_ * voxels_[voxel].cast<double>().matrix();
}

int voxel_band::at(const Eigen::Array3i& coordinates) const {
  if ((coordinates < 0).any() || (coordinates >= extent_).any()) return -1;
  return numbers_[coordinates.x() +
                  static_cast<std::size_t>(extent_.x()) * (coordinates.y() + extent_.y() * coordinates.z())];
}

int voxel_band::neighbour(Eigen::Index voxel, Eigen::Index axis, int step) const {
  Eigen::Array3i coordinates = voxels_[voxel];
  coordinates[axis] += step;
  return at(coordinates);
}

namespace {

/// Returns the rows of the prior: the sum of a voxel's six neighbours minus six times the voxel.
Eigen::SparseMatrix<double, Eigen::RowMajor> laplacian_of(const voxel_band& band) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index voxel = 0; voxel < band.size(); ++voxel) {
    std::vector<int> around;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) around.push_back(band.neighbour(voxel, axis, step));
    if (std::ranges::find(around, -1) != around.end()) continue;
    const int row = static_cast<int>(voxel);
    entries.emplace_back(row, row, -6.0);
    for (const int other : around) entries.emplace_back(row, other, 1.0);
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> laplacian(band.size(), band.size());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

}  // namespace

distance_field::distance_field(const gonio::shape::surface_index& scan, const gonio::shape::point_columns& near,
                               const distance_field_options& options)
    : band_(near, options) {
  // Observe the voxels near the scan.
  Eigen::VectorXd observed = Eigen::VectorXd::Zero(band_.size()), weights = observed;
  for (Eigen::Index voxel = 0; voxel < band_.size(); ++voxel) {
    const Eigen::Vector3d centre = band_.centre(voxel);
    const gonio::shape::surface_point found = scan.closest(centre);
    if (found.on_border || found.distance > options.reach) continue;
    observed[voxel] = scan.signed_distance(centre);
    weights[voxel] = 1.0;
  }
  // Find the most probable field.
  const Eigen::SparseMatrix<double, Eigen::RowMajor> laplacian = laplacian_of(band_);
  // Makes the system regular: a corner voxel that no other voxel uses becomes 0.
  constexpr double negligible = 1e-12;
  Eigen::SparseMatrix<double> of_observations(band_.size(), band_.size());
  of_observations.setIdentity();
  of_observations.diagonal() = weights.array() + negligible;
  const Eigen::SparseMatrix<double> of_prior = laplacian.transpose() * laplacian;
  const Eigen::SparseMatrix<double> precision = of_observations + options.smoothness * of_prior;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(precision);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0.0))
    gonio::refuse("the scan does not determine the field of distances near the hole");
  distances_ = factors.solve(observed);
}

distance_field::value_and_gradient distance_field::at(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d coordinates = band_.grid_coordinates(point);
  const Eigen::Array3i first = coordinates.array().floor().cast<int>();
  const Eigen::Vector3d share = coordinates - first.cast<double>().matrix();
  value_and_gradient found;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const int voxel = band_.at(first + step);
    if (voxel < 0) return {0.0, Eigen::Vector3d::Zero(), false};
    Eigen::Vector3d factor;
    for (Eigen::Index axis = 0; axis < 3; ++axis) factor[axis] = step[axis] == 1 ? share[axis] : 1.0 - share[axis];
    found.value += factor.prod() * distances_[voxel];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double others = factor[(axis + 1) % 3] * factor[(axis + 2) % 3];
      found.gradient[axis] += (step[axis] == 1 ? others : -others) * distances_[voxel] / band_.spacing();
    }
  }
  return found;
}

gonio::shape::point_columns distance_field::on_surface(gonio::shape::point_columns points, Eigen::Index& lost) const {
  constexpr int most_steps = 50;
  constexpr double longest_step = 0.25, close_enough = 1e-6;  // mm
  lost = 0;
  for (auto point : points.colwise()) {
    bool is_found = false;
    for (int i = 0; i < most_steps && !is_found; ++i) {
      const value_and_gradient here = at(point);
      if (!here.is_inside || !(here.gradient.squaredNorm() > 0.0)) break;
      Eigen::Vector3d step = -here.value / here.gradient.squaredNorm() * here.gradient;
      if (step.norm() > longest_step) step *= longest_step / step.norm();
      point += step;
      is_found = step.norm() < close_enough;
    }
    if (!is_found) ++lost;
  }
  return points;
}

}  // namespace papers
