#pragma once
/// Bodies of evaluate/perceived_candidates.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/evaluate/perceived_candidates.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/float_product.hpp>
#include <gonio/solve/product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE perceived_candidates::perceived_candidates(design::point_geometry geometry, located_rows rows,
                                                        Eigen::VectorXd error_variances,
                                                        const expected_covariance& expected,
                                                        const perceived_options& options, thread_count threads)
    : geometry_(std::move(geometry)),
      rows_(std::move(rows)),
      error_variances_(std::move(error_variances)),
      expected_(expected),
      options_(options),
      threads_(threads),
      discrepancy_(expected.model.variance * discrepancy_covariance(rows_.angles, expected.model.lengths)) {
  if (!(options.variance_share >= 0.0 && options.variance_share <= 1.0))
    refuse({"the share of the variance must be from 0 to 1, not ", options.variance_share});
  if (options.most_materials < 1 || options.sphere_size < 2)
    refuse("the perceived error of a design needs at least one material, and spheres at least two points wide");
  if (!(options.power >= 1.0)) refuse({"the power of the mean over materials must be at least 1, not ", options.power});
  for (Eigen::Index i = 0; i < geometry_.size(); ++i) allowed_.push_back(geometry_.allows(i));
}

GONIO_INLINE std::vector<perceived_candidates::family> perceived_candidates::families_of(
    const std::vector<std::string>& names) const {
  std::map<std::string, family> by_name;
  const Eigen::Index count = std::ssize(names), taken = std::min(count, options_.most_materials);
  for (Eigen::Index i = 0; i < count; ++i) {
    family& of = by_name[material_family(names[i])];
    of.members.push_back(i);
    if (i * taken / count != (i + 1) * taken / count) of.judged.push_back(i);
  }
  if (by_name.size() < 2)
    refuse(
        "the perceived error of a design (--criterion perceived) needs a prior of at least two families of materials; "
        "a family shares the name up to the first '_'");
  std::vector<family> judged;
  for (auto& [name, of] : by_name)
    if (!of.judged.empty()) judged.push_back(std::move(of));
  return judged;
}

/// Pivoted Cholesky factorisation: Golub and Van Loan, Matrix Computations, 4.2.8.
GONIO_INLINE Eigen::MatrixXf perceived_candidates::discrepancy_factor() const {
  const Eigen::Index n = discrepancy_.rows();
  Eigen::VectorXd rest = discrepancy_.diagonal();
  const double negligible = 0.01 * rest.maxCoeff();
  Eigen::MatrixXf factor(n, 0);
  Eigen::Index rank = 0;
  for (; rank < n; ++rank) {
    Eigen::Index pivot = 0;
    const double variance = rest.maxCoeff(&pivot);
    if (variance <= negligible) break;
    if (rank == factor.cols()) factor.conservativeResize(Eigen::NoChange, std::min(n, 2 * rank + 64));
    const Eigen::VectorXf known = factor.leftCols(rank) * factor.row(pivot).head(rank).transpose();
    const Eigen::VectorXd next = (discrepancy_.col(pivot) - known.cast<double>()) / std::sqrt(variance);
    factor.col(rank) = next.cast<float>();
    rest -= next.cwiseAbs2();
    rest[pivot] = 0.0;
  }
  return factor.leftCols(rank);
}

GONIO_INLINE void perceived_candidates::leave_out(const Eigen::MatrixXd& members,
                                                  const std::vector<seen_material>& seen,
                                                  const Eigen::MatrixXf& discrepancy) {
  const Eigen::Index k = rows_.rows.cols(), n = rows_.rows.rows(), points = weights_.size();
  // Compute the mean and the covariance of the coefficients of all materials outside of the family.
  const double others = expected_.observations - static_cast<double>(members.cols());
  const Eigen::VectorXd mean = members.rowwise().sum() / -others;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(k, k) - product_with_transpose(members);
  covariance = covariance / others - mean * mean.transpose();
  excluded_family found{
      product(covariance, rows_.rows.transpose()), Eigen::MatrixXd(n, 3 * std::ssize(seen)), {}, {}, {}};
  const Eigen::VectorXd shift = rows_.rows * mean;
  const Eigen::MatrixXf weights = found.weights.cast<float>(), rows = rows_.rows.cast<float>(),
                        transposed = discrepancy.transpose();
  const Eigen::Index of_each = 3 * points, all = of_each * std::ssize(seen);
  found.seen = Eigen::MatrixXf::Zero(all, n);
  found.errors.resize(all);
  found.variances.resize(all);
  for (Eigen::Index m = 0; m < std::ssize(seen); ++m) {
    found.mapped.middleCols(3 * m, 3) = seen[m].mapped.colwise() - shift;
    // Order by channel, then by point, so that loops over points are contiguous.
    Eigen::MatrixXf slopes(of_each, n);
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index point = 0; point < points; ++point)
        slopes.row(c * points + point) = seen[m].slopes.slopes.row(3 * point + c).cast<float>();
    const Eigen::MatrixXf by_rows = product(slopes, rows), by_discrepancy = product(slopes, discrepancy);
    for_each_block(
        n, 128,
        [&](block range) {
          auto out = found.seen.block(of_each * m, range.begin, of_each, range.size());
          add_product(by_rows, weights.middleCols(range.begin, range.size()), out);
          add_product(by_discrepancy, transposed.middleCols(range.begin, range.size()), out);
        },
        threads_);
    found.variances.segment(of_each * m, of_each) =
        found.seen.middleRows(of_each * m, of_each).cwiseProduct(slopes).rowwise().sum();
    const Eigen::MatrixXf mapped = found.mapped.middleCols(3 * m, 3).cast<float>();
    for (Eigen::Index c = 0; c < 3; ++c)
      found.errors.segment(of_each * m + c * points, points) = slopes.middleRows(c * points, points) * mapped.col(c);
  }
  materials_ += std::ssize(seen);
  families_.push_back(std::move(found));
}

/// The state of a left-out family after some samples.
struct perceived_candidates::remainder {
  Eigen::MatrixXd covariances;        ///< P_X: samples x n
  Eigen::MatrixXd explained;          ///< K^-1 P_X
  Eigen::MatrixXd measured;           ///< y_X: samples x 3 per material
  Eigen::MatrixXf seen;               ///< s P_X': points x samples
  Eigen::VectorXf errors, variances;  ///< e and v
};

GONIO_INLINE perceived_candidates::remainder perceived_candidates::remains(const excluded_family& some,
                                                                           std::span<const Eigen::Index> cells) const {
  const Eigen::Index count = std::ssize(cells), n = rows_.rows.rows(), points = weights_.size();
  remainder left{Eigen::MatrixXd(count, n),
                 {},
                 Eigen::MatrixXd(count, some.mapped.cols()),
                 Eigen::MatrixXf(some.seen.rows(), count),
                 some.errors,
                 some.variances};
  if (count == 0) return left;
  Eigen::MatrixXd rows(count, rows_.rows.cols());
  for (Eigen::Index i = 0; i < count; ++i) rows.row(i) = rows_.rows.row(cells[i]);
  left.covariances = product(rows, some.weights);
  Eigen::MatrixXd among(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    left.covariances.row(i) += discrepancy_.col(cells[i]).transpose();
    left.measured.row(i) = some.mapped.row(cells[i]);
    left.seen.col(i) = some.seen.col(cells[i]);
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      among(i, j) = left.covariances(i, cells[j]) + (i == j ? error_variances_[cells[i]] : 0.0);
  const cholesky factors(among);
  left.explained = factors.solve(left.covariances);
  const Eigen::MatrixXf inverse = factors.inverse().cast<float>(), dual = factors.solve(left.measured).cast<float>();
  left.variances -= product(left.seen, inverse).cwiseProduct(left.seen).rowwise().sum();
  for (Eigen::Index channel = 0; channel < dual.cols(); ++channel)
    left.errors.segment(points * channel, points) -= left.seen.middleRows(points * channel, points) * dual.col(channel);
  return left;
}

GONIO_INLINE double perceived_candidates::seen_power(const Eigen::Ref<const Eigen::ArrayXf>& errors,
                                                     const Eigen::Ref<const Eigen::ArrayXf>& variances) const {
  const auto share = static_cast<float>(options_.variance_share);
  const Eigen::Index points = weights_.size();
  const Eigen::ArrayXf squares = (1.0F - share) * errors.square() + share * variances.max(0.0F);
  const auto of = [&](Eigen::Index channel) { return squares.segment(channel * points, points); };
  const double mean = double{((of(0) + of(1) + of(2)).sqrt() * weights_).sum()};
  return options_.power == 1.0 ? mean : std::pow(mean, options_.power);
}

GONIO_INLINE double perceived_candidates::power_mean(double sum) const {
  const double mean = sum / static_cast<double>(materials_);
  return options_.power == 1.0 ? mean : std::pow(mean, 1.0 / options_.power);
}

GONIO_INLINE double perceived_candidates::operator()(std::span<const Eigen::Index> cells) const {
  const Eigen::Index of_each = 3 * weights_.size();
  double sum = 0.0;
  for (const excluded_family& some : families_) {
    const remainder left = remains(some, cells);
    for (Eigen::Index m = 0; m < some.materials(); ++m)
      sum += seen_power(left.errors.segment(of_each * m, of_each).array(),
                        left.variances.segment(of_each * m, of_each).array());
  }
  return power_mean(sum);
}

GONIO_INLINE std::vector<float> perceived_candidates::errors_with_each(std::span<const Eigen::Index> cells) const {
  return errors_with_each(cells, {0, geometry_.size()});
}

GONIO_INLINE std::vector<float> perceived_candidates::errors_with_each(std::span<const Eigen::Index> cells,
                                                                       block range) const {
  std::vector<double> sums(range.size(), 0.0);
  for (const excluded_family& some : families_) add_with_each(some, cells, range, sums);
  std::vector<float> errors(range.size(), std::numeric_limits<float>::infinity());
  for (Eigen::Index i = 0; i < range.size(); ++i)
    if (allowed_[range.begin + i]) errors[i] = static_cast<float>(power_mean(sums[i]));
  return errors;
}

GONIO_INLINE void perceived_candidates::add_with_each(const excluded_family& some, std::span<const Eigen::Index> cells,
                                                      block range, std::vector<double>& sums) const {
  const Eigen::Index points = weights_.size(), of_each = 3 * points;
  const remainder left = remains(some, cells);
  const Eigen::MatrixXf explained = left.explained.cast<float>();
  for_each_block(
      range.size(), sweep_block,
      [&](block part) {
        const Eigen::Index begin = range.begin + part.begin, end = range.begin + part.end;
        if (std::none_of(allowed_.begin() + begin, allowed_.begin() + end, [](bool allowed) { return allowed; }))
          return;
        // Compute s P for the process given the samples.
        Eigen::MatrixXf seen = some.seen.middleCols(begin, part.size());
        if (!cells.empty()) seen.noalias() -= left.seen * explained.middleCols(begin, part.size());
        Eigen::ArrayXf errors(of_each);
        for (Eigen::Index x = begin; x < end; ++x) {
          if (!allowed_[x]) continue;
          double variance = rows_.rows.row(x).dot(some.weights.col(x)) + discrepancy_(x, x) + error_variances_[x];
          Eigen::RowVectorXd off = some.mapped.row(x);
          if (!cells.empty()) {
            variance -= left.covariances.col(x).dot(left.explained.col(x));
            off -= left.explained.col(x).transpose() * left.measured;
          }
          const Eigen::RowVectorXf step = (off / variance).cast<float>();
          for (Eigen::Index m = 0; m < some.materials(); ++m) {
            const auto with = seen.col(x - begin).segment(of_each * m, of_each).array();
            for (Eigen::Index c = 0; c < 3; ++c)
              errors.segment(c * points, points) = left.errors.segment(of_each * m + c * points, points).array() -
                                                   step[3 * m + c] * with.segment(c * points, points);
            sums[x - range.begin] += seen_power(errors, left.variances.segment(of_each * m, of_each).array() -
                                                            with.square() / static_cast<float>(variance));
          }
        }
      },
      threads_);
}

}  // namespace gonio
