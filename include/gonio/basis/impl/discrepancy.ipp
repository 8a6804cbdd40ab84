#pragma once
/// Bodies of basis/discrepancy.hpp.

#include <gonio/basis/discrepancy.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gonio {

namespace detail {

GONIO_INLINE Eigen::Vector4d discrepancy_place(const half_difference& angles,
                                               const correlation_lengths& lengths) noexcept {
  constexpr double right_angle = std::numbers::pi / 2.0;
  const double radius = 0.5 * std::sin(angles.theta_d) / lengths.azimuth;
  return {std::sqrt(std::max(angles.theta_h, 0.0) / right_angle) / lengths.theta_h,
          angles.theta_d / right_angle / lengths.theta_d, radius * std::cos(2.0 * angles.phi_d),
          radius * std::sin(2.0 * angles.phi_d)};
}

[[nodiscard]] inline double squared_exponential(double squared_distance) noexcept {
  return std::exp(-0.5 * squared_distance);
}

[[nodiscard]] inline double squared_distance(const double* one, const double* other) noexcept {
  double sum = 0.0;
  for (Eigen::Index c = 0; c < 4; ++c) sum += (one[c] - other[c]) * (one[c] - other[c]);
  return sum;
}

/// k of two places.
[[nodiscard]] inline double covariance(const double* one, const double* other) noexcept {
  return squared_exponential(squared_distance(one, other));
}

using discrepancy_places = Eigen::Matrix<double, 4, Eigen::Dynamic>;

/// Where angles are, a column each. Throws gonio::error if one is not finite, or for impossible lengths.
[[nodiscard]] GONIO_INLINE discrepancy_places places_of(std::span<const half_difference> angles,
                                                        const correlation_lengths& lengths) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (!positive(lengths.theta_h) || !positive(lengths.theta_d) || !positive(lengths.azimuth))
    refuse({"the correlation lengths of a discrepancy must be positive and finite, not ", lengths.theta_h, ", ",
            lengths.theta_d, " and ", lengths.azimuth});
  discrepancy_places places(4, std::ssize(angles));
  Eigen::Index column = 0;
  for (const half_difference& each : angles) {
    places.col(column) = discrepancy_place(each, lengths);
    if (!std::isfinite(places.col(column).sum())) refuse({"centre ", column + 1, " of a discrepancy is not finite"});
    ++column;
  }
  return places;
}

/// k of one place with others, from number `begin` on.
GONIO_INLINE void covariances_with(const double* place, const discrepancy_places& others, Eigen::Index begin,
                                   double* out) {
  const Eigen::Index count = others.cols() - begin;
  for (Eigen::Index i = 0; i < count; ++i) out[i] = -0.5 * squared_distance(&others(0, begin + i), place);
  Eigen::Map<Eigen::ArrayXd> numbers(out, count);
  numbers = numbers.exp();
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd covariance_of(const discrepancy_places& places) {
  const Eigen::Index n = places.cols();
  Eigen::MatrixXd all(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    covariances_with(&places(0, j), places, j, &all(j, j));
    for (Eigen::Index i = j + 1; i < n; ++i) all(j, i) = all(i, j);
  }
  return all;
}

}  // namespace detail

GONIO_INLINE Eigen::MatrixXd discrepancy_covariance(std::span<const half_difference> angles,
                                                    const correlation_lengths& lengths) {
  return detail::covariance_of(detail::places_of(angles, lengths));
}

GONIO_INLINE Eigen::VectorXd discrepancy_covariance(std::span<const half_difference> angles,
                                                    const half_difference& place, const correlation_lengths& lengths) {
  const Eigen::Vector4d here = detail::discrepancy_place(place, lengths);
  Eigen::VectorXd with(std::ssize(angles));
  for (Eigen::Index i = 0; i < with.size(); ++i)
    with[i] = detail::covariance(detail::discrepancy_place(angles[i], lengths).data(), here.data());
  return with;
}

GONIO_INLINE Eigen::MatrixXd discrepancy_covariance(std::span<const half_difference> angles,
                                                    std::span<const half_difference> others,
                                                    const correlation_lengths& lengths) {
  const detail::discrepancy_places places = detail::places_of(others, lengths);
  const detail::discrepancy_places rows = detail::places_of(angles, lengths);
  Eigen::MatrixXd all(rows.cols(), places.cols());
  for (Eigen::Index j = 0; j < all.cols(); ++j) detail::covariances_with(&places(0, j), rows, 0, &all(0, j));
  return all;
}

GONIO_INLINE discrepancy_functions discrepancy_functions::covariances(std::span<const half_difference> centres,
                                                                      const correlation_lengths& lengths) {
  if (centres.empty()) refuse("a discrepancy needs at least one centre");
  return discrepancy_functions(stored{detail::places_of(centres, lengths), lengths, 1.0, {}});
}

GONIO_INLINE discrepancy_functions::discrepancy_functions(std::span<const half_difference> centres, double amplitude,
                                                          const correlation_lengths& lengths)
    : discrepancy_functions(covariances(centres, lengths)) {
  if (!(amplitude > 0.0 && std::isfinite(amplitude)))
    refuse({"the amplitude of a discrepancy must be positive and finite, not ", amplitude});
  Eigen::MatrixXd among = detail::covariance_of(shared_->places);
  // A small part more keeps it positive definite where places coincide.
  constexpr double least_eigenvalue = 1e-7;
  for (Eigen::Index i = 0; i < among.cols(); ++i) among(i, i) += least_eigenvalue;
  cholesky factors(among);
  if (!factors.positive_definite()) refuse("the covariance of a discrepancy's centres is not positive definite");
  shared_ = std::make_shared<const stored>(stored{shared_->places, lengths, amplitude, std::move(factors)});
}

GONIO_INLINE void discrepancy_functions::read(const half_difference& angles, double* out) const noexcept {
  const Eigen::Vector4d here = detail::discrepancy_place(angles, shared_->lengths);
  const double scale = std::sqrt(shared_->amplitude);
  for (Eigen::Index i = 0; i < size(); ++i) out[i] = scale * detail::covariance(&shared_->places(0, i), here.data());
  if (shared_->factors) shared_->factors->solve_lower_in_place(out);
}

GONIO_INLINE void discrepancy_functions::read(std::span<const half_difference> angles, row_block out) const {
  Eigen::MatrixXd columns(size(), std::ssize(angles));
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    detail::covariances_with(detail::discrepancy_place(angles[i], shared_->lengths).data(), shared_->places, 0,
                             &columns(0, i));
  if (shared_->factors) columns = std::sqrt(shared_->amplitude) * shared_->factors->solve_lower(columns);
  out = columns.transpose();
}

GONIO_INLINE Eigen::MatrixXd discrepancy_functions::covariance_weights(const Eigen::MatrixXd& weights) const {
  if (!shared_->factors) return weights;
  return std::sqrt(shared_->amplitude) * shared_->factors->solve_upper(weights);
}

GONIO_INLINE cell_fields<3> discrepancy_functions::combination(const Eigen::MatrixXd& weights, const valid_cells& cells,
                                                               thread_count threads) const {
  const grid& over = cells.grid();
  const auto [heights, rows, columns] = over.extents();
  const correlation_lengths& lengths = shared_->lengths;
  // What each centre's covariance is multiplied by.
  const Eigen::MatrixXd centre_weights = covariance_weights(weights);
  // The part of theta_h times these: three columns for each theta_h of the grid.
  Eigen::MatrixXd by_height(size(), 3 * heights);
  for (int i = 0; i < heights; ++i) {
    const double place = detail::discrepancy_place({over.theta_h(i), 0.0, 0.0}, lengths)[0];
    for (Eigen::Index centre = 0; centre < size(); ++centre) {
      const double along = shared_->places(0, centre) - place;
      const double factor = detail::squared_exponential(along * along);
      for (int c = 0; c < 3; ++c) by_height(centre, 3 * i + c) = factor * centre_weights(centre, c);
    }
  }
  // The part of theta_d and phi_d, a slice of the grid at a time.
  cell_fields<3> field(3, cells.size());
  for_each_index(
      rows, 1,
      [&](Eigen::Index row) {
        const int j = static_cast<int>(row);
        detail::discrepancy_places places(4, columns);
        for (int k = 0; k < columns; ++k)
          places.col(k) = detail::discrepancy_place({0.0, over.theta_d(j), over.phi_d(k)}, lengths);
        Eigen::MatrixXd slice(columns, size());
        for (Eigen::Index centre = 0; centre < size(); ++centre) {
          Eigen::Vector4d beside = shared_->places.col(centre);
          beside[0] = 0.0;  // theta_h has its own factor
          detail::covariances_with(beside.data(), places, 0, &slice(0, centre));
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
