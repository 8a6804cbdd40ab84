#pragma once
/// Bodies of estimate/leave_one_material_out_error.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/leave_one_material_out_error.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Returns diag(d) A.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd scaled_rows(const Eigen::VectorXd& d, const Eigen::MatrixXd& a) {
  Eigen::MatrixXd scaled(a.rows(), a.cols());
  for (Eigen::Index j = 0; j < a.cols(); ++j) scaled.col(j) = d.cwiseProduct(a.col(j));
  return scaled;
}

/// Returns A'B.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd dots(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd found(a.cols(), b.cols());
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    for (Eigen::Index j = 0; j < b.cols(); ++j) found(i, j) = a.col(i).dot(b.col(j));
  return found;
}

/// Returns the row and the column of the largest remaining entry: the pivot of a step of Gaussian elimination.
[[nodiscard]] GONIO_INLINE std::array<Eigen::Index, 2> largest_beyond(Eigen::Index step, const Eigen::MatrixXd& a) {
  std::array<Eigen::Index, 2> found{step, step};
  for (Eigen::Index i = step; i < a.rows(); ++i)
    for (Eigen::Index j = step; j < a.cols(); ++j)
      if (std::abs(a(i, j)) > std::abs(a(found[0], found[1]))) found = {i, j};
  return found;
}

/// Solves A X = B by Gaussian elimination with complete pivoting. X is zero in directions in which A is singular up to
/// rounding. Golub and Van Loan, Matrix Computations, 4th ed. 2013, 3.4.8. Eigen's solver would take a second to
/// compile.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd solve_by_elimination(Eigen::MatrixXd a, Eigen::MatrixXd b) {
  const Eigen::Index size = a.rows();
  std::vector<Eigen::Index> unknown(static_cast<std::size_t>(size));
  std::iota(unknown.begin(), unknown.end(), Eigen::Index{0});
  Eigen::Index rank = 0;
  double least = 0.0;
  for (; rank < size; ++rank) {
    const auto [row, column] = largest_beyond(rank, a);
    if (!(std::abs(a(row, column)) > least)) break;
    if (rank == 0)
      least = static_cast<double>(size) * std::numeric_limits<double>::epsilon() * std::abs(a(row, column));
    std::swap(unknown[rank], unknown[column]);
    for (Eigen::Index i = 0; i < size; ++i) std::swap(a(i, rank), a(i, column));
    for (Eigen::Index j = 0; j < size; ++j) std::swap(a(rank, j), a(row, j));
    for (Eigen::Index j = 0; j < b.cols(); ++j) std::swap(b(rank, j), b(row, j));
    for (Eigen::Index i = rank + 1; i < size; ++i) {
      const double factor = a(i, rank) / a(rank, rank);
      for (Eigen::Index j = 0; j < size; ++j) a(i, j) -= factor * a(rank, j);
      for (Eigen::Index j = 0; j < b.cols(); ++j) b(i, j) -= factor * b(rank, j);
    }
  }
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(size, b.cols());
  for (Eigen::Index i = rank - 1; i >= 0; --i)
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
      double sum = b(i, c);
      for (Eigen::Index j = i + 1; j < rank; ++j) sum -= a(i, j) * x(unknown[j], c);
      x(unknown[i], c) = sum / a(i, i);
    }
  return x;
}

/// Adds A X to sum.
GONIO_INLINE void add_combined(const Eigen::MatrixXd& a, const Eigen::MatrixXd& x, Eigen::MatrixXd& sum) {
  for (Eigen::Index j = 0; j < x.cols(); ++j)
    for (Eigen::Index i = 0; i < x.rows(); ++i) sum.col(j) += x(i, j) * a.col(i);
}

}  // namespace detail

GONIO_INLINE Eigen::VectorXd leave_one_material_out_error::operator()(const Eigen::VectorXd& etas) const {
  Eigen::VectorXd errors(etas.size());
  for_each_block(
      etas.size(), 1,
      [&](block range) {
        const Eigen::Index e = range.begin;
        errors[e] = error_at(etas[e]);
      },
      threads_);
  return errors;
}

GONIO_INLINE leave_one_material_out_error::sums::sums(Eigen::Index k)
    : gram(Eigen::MatrixXd::Zero(k, k)), noise(Eigen::MatrixXd::Zero(k, k)), shift(Eigen::VectorXd::Zero(k)) {}

GONIO_INLINE leave_one_material_out_error::sums& leave_one_material_out_error::sums::operator+=(const sums& other) {
  gram += other.gram;
  noise += other.noise;
  shift += other.shift;
  return *this;
}

GONIO_INLINE void leave_one_material_out_error::sums::add(Eigen::MatrixXd columns, const Eigen::VectorXd& weights,
                                                          const Eigen::VectorXd& shifts,
                                                          const Eigen::VectorXd& variances) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    shift += weights[i] * shifts[i] * columns.col(i);
    columns.col(i) *= std::sqrt(weights[i]);
  }
  gram += product_with_transpose(columns);
  // Clamp variances: if a basis explains all materials, rounding can make them negative.
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    columns.col(i) *= std::sqrt(weights[i] * std::max(variances[i], 0.0));
  noise += product_with_transpose(columns);
}

GONIO_INLINE void leave_one_material_out_error::require_sensible(Eigen::Index locations, const Eigen::VectorXd& weights,
                                                                 Eigen::Index materials) {
  if (weights.size() != locations || locations == 0)
    refuse(std::to_string(locations) + " locations have " + std::to_string(weights.size()) +
           " weights, expected a weight for each location, and at least one location");
  if (materials < 2) refuse("choosing eta needs a prior of at least two materials: give a number (--eta)");
}

GONIO_INLINE void leave_one_material_out_error::initialise(const sums& all, const Eigen::VectorXd& singular_values,
                                                           const Eigen::MatrixXf& coefficients, Eigen::Index channels) {
  const Eigen::VectorXd squares = singular_values.cwiseProduct(singular_values);
  decompose(squares, all);
  for (Eigen::Index row = 0; row < coefficients.rows(); row += channels)
    materials_.push_back(leave_out(squares, coefficients.middleRows(row, channels).transpose().cast<double>(),
                                   static_cast<double>(coefficients.rows())));
}

GONIO_INLINE void leave_one_material_out_error::decompose(const Eigen::VectorXd& squares, const sums& all) {
  const symmetric_eigen eigen = decompose_symmetric(all.gram, "a least-squares problem");
  const double largest = eigen.values[eigen.values.size() - 1];
  const Eigen::Index rank = std::count_if(eigen.values.data(), eigen.values.data() + eigen.values.size(),
                                          [&](double value) { return value > 1e-12 * largest; });
  if (rank == 0 || !(largest > 0.0))
    refuse("eta cannot be chosen, because all components are 0 at the measured directions: give a number (--eta)");
  values_ = eigen.values.tail(rank);
  vectors_ = eigen.vectors.rightCols(rank);
  const Eigen::MatrixXd transposed = vectors_.transpose();
  norm_ = product(transposed, detail::scaled_rows(squares, vectors_));
  noise_norm_ = norm_.cwiseProduct(product(transposed, product(all.noise, vectors_)));
  shift_.resize(rank);
  for (Eigen::Index j = 0; j < rank; ++j) shift_[j] = vectors_.col(j).dot(all.shift);
}

GONIO_INLINE leave_one_material_out_error::excluded_material leave_one_material_out_error::leave_out(
    const Eigen::VectorXd& squares, const Eigen::MatrixXd& own, double observations) const {
  const Eigen::Index channels = own.cols();
  const auto count = static_cast<double>(channels);
  const double others = observations - count;
  // R = I + b 1 1', the symmetric root of I + 1 1' / (m - p).
  const double b = (std::sqrt(1.0 + count / others) - 1.0) / count;
  Eigen::VectorXd sum = own.col(0);
  for (Eigen::Index c = 1; c < channels; ++c) sum += own.col(c);
  Eigen::MatrixXd t(own.rows(), channels), n(own.rows(), channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    t.col(c) = own.col(c) + sum / others;
    n.col(c) = own.col(c) + b * sum;
  }
  const Eigen::MatrixXd mt = detail::scaled_rows(squares, t), mn = detail::scaled_rows(squares, n);
  Eigen::MatrixXd all(own.rows(), 4 * channels);
  all.leftCols(channels) = t;
  all.middleCols(channels, channels) = n;
  all.middleCols(2 * channels, channels) = mt;
  all.rightCols(channels) = mn;
  const Eigen::MatrixXd seen = product(vectors_.transpose(), all);
  return {seen.leftCols(channels),
          seen.middleCols(channels, channels),
          seen.middleCols(2 * channels, channels),
          seen.rightCols(channels),
          detail::dots(n, mn),
          detail::dots(n, mt),
          detail::dots(t, mt).diagonal()};
}

GONIO_INLINE double leave_one_material_out_error::error_at(double eta) const {
  Eigen::VectorXd d(values_.size());
  for (Eigen::Index j = 0; j < d.size(); ++j) d[j] = 1.0 / (values_[j] + eta);
  double variance = 0.0;
  for (Eigen::Index j = 0; j < d.size(); ++j) variance += d[j] * noise_norm_.col(j).dot(d);
  double sum = 0.0, count = 0.0;
  for (const excluded_material& material : materials_) {
    const Eigen::VectorXd bias = squared_bias(material, d);
    for (Eigen::Index c = 0; c < bias.size(); ++c) sum += std::sqrt(std::max(bias[c] + variance, 0.0));
    count += static_cast<double>(bias.size());
  }
  return sum / count;
}

GONIO_INLINE Eigen::VectorXd leave_one_material_out_error::squared_bias(const excluded_material& material,
                                                                        const Eigen::VectorXd& d) const {
  // Reconstruct with the material in the basis: u = D q.
  const Eigen::VectorXd f = values_.cwiseProduct(d), shift = d.cwiseProduct(shift_);
  const Eigen::MatrixXd fn = detail::scaled_rows(f, material.n);
  Eigen::MatrixXd u = detail::scaled_rows(f, material.t);  // D q, the reconstruction with the material in the basis
  const Eigen::Index channels = u.cols();
  for (Eigen::Index c = 0; c < channels; ++c) u.col(c) += shift;
  // Leave the material out by Woodbury's identity: (D^-1 - N N')^-1 differs from D by a system with one unknown for
  // each channel.
  const Eigen::MatrixXd within = Eigen::MatrixXd::Identity(channels, channels) - detail::dots(material.n, fn);
  const Eigen::MatrixXd known = detail::dots(material.n, u);
  detail::add_combined(fn, detail::solve_by_elimination(within, known), u);
  // Express the reconstruction as x - c = V u - N p, and take the gradient of its distance from t.
  const Eigen::MatrixXd p = detail::dots(material.n, u);
  Eigen::MatrixXd gradient = product(norm_, u);
  detail::add_combined(material.mn, -2.0 * p, gradient);
  for (Eigen::Index c = 0; c < channels; ++c) gradient.col(c) -= 2.0 * material.mt.col(c);
  // Sum the squared distance of each channel in the norm M.
  Eigen::VectorXd found = material.tmt;
  for (Eigen::Index c = 0; c < channels; ++c) {
    found[c] += u.col(c).dot(gradient.col(c));
    for (Eigen::Index i = 0; i < channels; ++i) {
      double along = 2.0 * material.nmt(i, c);
      for (Eigen::Index j = 0; j < channels; ++j) along += material.nmn(i, j) * p(j, c);
      found[c] += p(i, c) * along;
    }
  }
  return found;
}

}  // namespace gonio
