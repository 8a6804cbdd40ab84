#pragma once
/// Bodies of basis/discrepancy.hpp.

#include <gonio/basis/discrepancy.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/fresnel.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gonio {

GONIO_INLINE double fresnel_rise(double theta_d) noexcept {
  constexpr double f0 = 0.04;
  return 1.0 - std::log(fresnel_schlick(std::cos(theta_d), f0)) / std::log(f0);
}

namespace detail {

GONIO_INLINE discrepancy_coordinates coordinates_of(const half_difference& angles,
                                                    const correlation_lengths& lengths) noexcept {
  constexpr double right_angle = std::numbers::pi / 2.0;
  const double radius = 0.5 * std::sin(angles.theta_d) / lengths.azimuth;
  double along_theta_d = angles.theta_d / right_angle;
  if (lengths.fresnel_weight != 0.0) along_theta_d += lengths.fresnel_weight * fresnel_rise(angles.theta_d);
  return {std::sqrt(std::max(angles.theta_h, 0.0) / right_angle) / lengths.theta_h, along_theta_d / lengths.theta_d,
          radius * std::cos(2.0 * angles.phi_d), radius * std::sin(2.0 * angles.phi_d)};
}

[[nodiscard]] inline double squared_exponential(double squared_distance) noexcept {
  return std::exp(-0.5 * squared_distance);
}

[[nodiscard]] inline double squared_distance(const discrepancy_coordinates& one,
                                             const discrepancy_coordinates& other) noexcept {
  double sum = 0.0;
  for (std::size_t c = 0; c < 4; ++c) sum += (one[c] - other[c]) * (one[c] - other[c]);
  return sum;
}

/// Returns the covariance k of two locations.
[[nodiscard]] inline double covariance(const discrepancy_coordinates& one,
                                       const discrepancy_coordinates& other) noexcept {
  return squared_exponential(squared_distance(one, other));
}

/// Returns the coordinates of angles. Throws gonio::error if an angle is not finite, or unless the correlation lengths
/// are positive and finite.
[[nodiscard]] GONIO_INLINE std::vector<discrepancy_coordinates> checked_coordinates(
    std::span<const half_difference> angles, const correlation_lengths& lengths) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (!positive(lengths.theta_h) || !positive(lengths.theta_d) || !positive(lengths.azimuth))
    refuse({"the correlation lengths of a discrepancy must be positive and finite, not ", lengths.theta_h, ", ",
            lengths.theta_d, " and ", lengths.azimuth});
  if (!(lengths.fresnel_weight >= 0.0) || !std::isfinite(lengths.fresnel_weight))
    refuse({"the Fresnel weight of a discrepancy must be at least 0 and finite, not ", lengths.fresnel_weight});
  std::vector<discrepancy_coordinates> coordinates;
  for (const half_difference& each : angles) {
    coordinates.push_back(coordinates_of(each, lengths));
    for (const double coordinate : coordinates.back())
      if (!std::isfinite(coordinate)) refuse({"centre ", coordinates.size(), " of a discrepancy is not finite"});
  }
  return coordinates;
}

/// Writes the covariance k of one location with each of the others.
GONIO_INLINE void covariances_with(const discrepancy_coordinates& one, std::span<const discrepancy_coordinates> others,
                                   double* out) {
  for (std::size_t i = 0; i < others.size(); ++i) out[i] = -0.5 * squared_distance(others[i], one);
  exponentiate(out, std::ssize(others));
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd covariance_of(std::span<const discrepancy_coordinates> coordinates) {
  const Eigen::Index n = std::ssize(coordinates);
  Eigen::MatrixXd all(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    covariances_with(coordinates[j], coordinates.subspan(j), &all(j, j));
    for (Eigen::Index i = j + 1; i < n; ++i) all(j, i) = all(i, j);
  }
  return all;
}

}  // namespace detail

GONIO_INLINE Eigen::MatrixXd discrepancy_covariance(std::span<const half_difference> angles,
                                                    const correlation_lengths& lengths) {
  return detail::covariance_of(detail::checked_coordinates(angles, lengths));
}

GONIO_INLINE Eigen::VectorXd discrepancy_covariance(std::span<const half_difference> angles,
                                                    const half_difference& other, const correlation_lengths& lengths) {
  const detail::discrepancy_coordinates here = detail::coordinates_of(other, lengths);
  Eigen::VectorXd with(std::ssize(angles));
  for (Eigen::Index i = 0; i < with.size(); ++i)
    with[i] = detail::covariance(detail::coordinates_of(angles[i], lengths), here);
  return with;
}

GONIO_INLINE Eigen::MatrixXd discrepancy_covariance(std::span<const half_difference> angles,
                                                    std::span<const half_difference> others,
                                                    const correlation_lengths& lengths) {
  const std::vector<detail::discrepancy_coordinates> columns = detail::checked_coordinates(others, lengths),
                                                     rows = detail::checked_coordinates(angles, lengths);
  Eigen::MatrixXd all(std::ssize(rows), std::ssize(columns));
  for (Eigen::Index j = 0; j < all.cols(); ++j) detail::covariances_with(columns[j], rows, &all(0, j));
  return all;
}

GONIO_INLINE discrepancy_functions discrepancy_functions::covariances(std::span<const half_difference> centres,
                                                                      const correlation_lengths& lengths) {
  if (centres.empty()) refuse("a discrepancy needs at least one centre");
  return discrepancy_functions(stored{detail::checked_coordinates(centres, lengths), lengths, 1.0, {}});
}

GONIO_INLINE discrepancy_functions::discrepancy_functions(std::span<const half_difference> centres, double amplitude,
                                                          const correlation_lengths& lengths)
    : discrepancy_functions(covariances(centres, lengths)) {
  if (!(amplitude > 0.0 && std::isfinite(amplitude)))
    refuse({"the amplitude of a discrepancy must be positive and finite, not ", amplitude});
  Eigen::MatrixXd among = detail::covariance_of(shared_->coordinates);
  // A small number on the diagonal keeps the matrix positive definite if locations coincide.
  constexpr double least_eigenvalue = 1e-7;
  for (Eigen::Index i = 0; i < among.cols(); ++i) among(i, i) += least_eigenvalue;
  cholesky factors(among);
  if (!factors.positive_definite()) refuse("the covariance of a discrepancy's centres is not positive definite");
  shared_ = std::make_shared<const stored>(stored{shared_->coordinates, lengths, amplitude, std::move(factors)});
}

GONIO_INLINE void discrepancy_functions::read(const half_difference& angles, double* out) const noexcept {
  const detail::discrepancy_coordinates here = detail::coordinates_of(angles, shared_->lengths);
  const double scale = std::sqrt(shared_->amplitude);
  for (Eigen::Index i = 0; i < size(); ++i) out[i] = scale * detail::covariance(shared_->coordinates[i], here);
  if (shared_->factors) shared_->factors->solve_lower_in_place(out);
}

GONIO_INLINE void discrepancy_functions::read(std::span<const half_difference> angles, row_block out) const {
  Eigen::MatrixXd columns(size(), std::ssize(angles));
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    detail::covariances_with(detail::coordinates_of(angles[i], shared_->lengths), shared_->coordinates, &columns(0, i));
  if (shared_->factors) columns = shared_->factors->solve_lower(columns);
  const double scale = shared_->factors ? std::sqrt(shared_->amplitude) : 1.0;
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    for (Eigen::Index k = 0; k < size(); ++k) out(i, k) = scale * columns(k, i);
}

GONIO_INLINE Eigen::MatrixXd discrepancy_functions::covariance_weights(const Eigen::MatrixXd& weights) const {
  if (!shared_->factors) return weights;
  Eigen::MatrixXd found = shared_->factors->solve_upper(weights);
  for (Eigen::Index i = 0; i < found.size(); ++i) found.data()[i] *= std::sqrt(shared_->amplitude);
  return found;
}

GONIO_INLINE cell_fields<3> discrepancy_functions::combination(const Eigen::MatrixXd& weights, const valid_cells& cells,
                                                               thread_count threads) const {
  const grid& over = cells.grid();
  const auto [heights, rows, columns] = over.extents();
  const correlation_lengths& lengths = shared_->lengths;
  // Convert the weights to weights of the covariances with the centres.
  const Eigen::MatrixXd centre_weights = covariance_weights(weights);
  // Multiply these weights by the covariance's factor of theta_h: three columns for each theta_h of the grid.
  Eigen::MatrixXd by_height(size(), 3 * heights);
  for (int i = 0; i < heights; ++i) {
    const double here = detail::coordinates_of({over.theta_h(i), 0.0, 0.0}, lengths)[0];
    for (Eigen::Index centre = 0; centre < size(); ++centre) {
      const double along = shared_->coordinates[centre][0] - here;
      const double factor = detail::squared_exponential(along * along);
      for (int c = 0; c < 3; ++c) by_height(centre, 3 * i + c) = factor * centre_weights(centre, c);
    }
  }
  // Multiply by the covariance's factor of theta_d and phi_d, a slice of the grid at a time.
  cell_fields<3> field(3, cells.size());
  for_each_index(
      rows, 1,
      [&](Eigen::Index row) {
        const int j = static_cast<int>(row);
        std::vector<detail::discrepancy_coordinates> coordinates;
        for (int k = 0; k < columns; ++k)
          coordinates.push_back(detail::coordinates_of({0.0, over.theta_d(j), over.phi_d(k)}, lengths));
        Eigen::MatrixXd slice(columns, size());
        for (Eigen::Index centre = 0; centre < size(); ++centre) {
          detail::discrepancy_coordinates beside = shared_->coordinates[centre];
          beside[0] = 0.0;  // theta_h has its own factor
          detail::covariances_with(beside, coordinates, &slice(0, centre));
        }
        const Eigen::MatrixXd values = product(slice, by_height);
        for (int i = 0; i < heights; ++i)
          for (int k = 0; k < columns; ++k) {
            const Eigen::Index linear = over.linear({i, j, k});
            if (!cells.contains(linear)) continue;
            for (int c = 0; c < 3; ++c)
              field(c, cells.representative(linear)) = static_cast<float>(values(k, 3 * i + c));
          }
      },
      threads);
  return field;
}

}  // namespace gonio
