#pragma once
/// The functions of a basis at given locations, for iterations that solve for weights repeatedly with the same rows but
/// different sample weights: Noell, Koehler and Stricker 2014, Eq. 7-10.

#include <gonio/basis/basis.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

/// Reads the rows of a basis at cells in place. Interpolates rows between cells once and stores them, 12 bytes for each
/// location and function.
template <colour_basis Basis>
requires tabulated_basis<std::remove_cvref_t<decltype(channel_of(std::declval<const Basis&>(), 0))>>
class sampled_functions {
 public:
  sampled_functions(const Basis& functions, const std::vector<location>& locations, thread_count threads = {})
      : columns_(columns_of(functions)),
        unknowns_(functions.size()),
        channels_{channel_of(functions, 0), channel_of(functions, 1), channel_of(functions, 2)},
        threads_(threads) {
    rows_.fill(std::vector<const float*>(locations.size()));
    interpolate_between_cells(locations);
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index i = 0; i < std::ssize(locations); ++i)
        if (locations[i].count == 1) rows_[c][i] = channels_[c].row(locations[i].cell[0]).data();
  }

  [[nodiscard]] Eigen::Index size() const noexcept { return rows_[0].size(); }
  /// Returns the number of functions of the basis, including excluded ones.
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return unknowns_; }
  /// Returns the numbers of the functions that are not excluded, in ascending order.
  [[nodiscard]] const std::vector<Eigen::Index>& columns() const noexcept { return columns_; }

  /// Returns Q = A'VA and m = A'Vb of one channel. A has the functions' rows at the n locations; `weights` (the
  /// diagonal of V) and `values` (b) are arrays of n floats. Skips a row if its weight times max(1, |value|) is less
  /// than a millionth of the largest weight. Products are double: if columns are nearly dependent, a Gram matrix of
  /// float products is indefinite, and no solver can certify its optimum. At most n k^2 operations for k functions.
  template <class Weights, class Values>
  [[nodiscard]] normal_equations normal(Eigen::Index channel, const Weights& weights, const Values& values) const {
    using sum_type = detail::product_sum<double>;
    const float least = least_weight(weights);
    const auto add_rows = [&](sum_type& sum, block range) {
      Eigen::Index count = 0;
      for (Eigen::Index i = range.begin; i < range.end; ++i) {
        prefetch_row_after(channel, i);
        if (!counts(weights[i], values[i], least)) continue;
        const double root = std::sqrt(static_cast<double>(weights[i]));
        sum.put(count, rows_[channel][i], unknowns_, root);
        sum(count++, unknowns_) = root * values[i];
      }
      sum.add(count);
    };
    const sum_type zero(unknowns_ + 1);
    const Eigen::MatrixXd all = sum_over_blocks(size(), sum_type::block_rows, zero, add_rows, threads_).symmetric();
    return {all.topLeftCorner(unknowns_, unknowns_), all.topRightCorner(unknowns_, 1), all.diagonal().tail(1)};
  }

  /// Returns m = A'Vb alone, k x 3 for the three channels, for a known Q. Weights and values are 3 x n. Skips the same
  /// rows as `normal`, so m is in the range of Q except for rounding. Costs one pass over the rows.
  [[nodiscard]] Eigen::MatrixXd rhs(const channel_values& weights, const channel_values& values) const {
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(unknowns_, 3);
    std::array<float, 3> least{};
    for (Eigen::Index c = 0; c < 3; ++c) least[c] = least_weight(weights.row(c));
    return sum_over_blocks(
        size(), 128, zero,
        [&](Eigen::MatrixXd& sum, block range) {
          for (Eigen::Index i = range.begin; i < range.end; ++i)
            for (Eigen::Index c = 0; c < 3; ++c) {
              prefetch_row_after(c, i);
              const float weight = weights(c, i), value = values(c, i);
              if (!counts(weight, value, least[c])) continue;
              const double factor = static_cast<double>(weight) * value;
              sum.col(c) += factor * row(c, i).transpose().template cast<double>();
            }
        },
        threads_);
  }

  /// Returns the weighted sums A x of the functions at all n locations, 3 x n, for weights x of the k functions in each
  /// channel, k x 3. Reads the rows once.
  [[nodiscard]] channel_values apply(const Eigen::MatrixXd& x) const {
    const Eigen::MatrixXf weights = x.cast<float>();
    channel_values values(3, size());
    for_each_index(
        size(), 1024,
        [&](Eigen::Index i) {
          for (Eigen::Index c = 0; c < 3; ++c) {
            prefetch_row_after(c, i);
            values(c, i) = row(c, i).dot(weights.col(c));
          }
        },
        threads_);
    return values;
  }

 private:
  template <class Weights>
  [[nodiscard]] float least_weight(const Weights& weights) const {
    return size() > 0 ? 1e-6f * weights.maxCoeff() : 0.0f;
  }

  [[nodiscard]] static bool counts(float weight, float value, float least) noexcept {
    return weight > 0.0f && weight * std::max(1.0f, std::abs(value)) >= least;
  }

  [[nodiscard]] auto row(Eigen::Index channel, Eigen::Index position) const noexcept {
    return Eigen::Map<const Eigen::RowVectorXf>(rows_[channel][position], unknowns_);
  }

  /// Prefetches the row of a later location: the hardware cannot predict scattered rows.
  void prefetch_row_after(Eigen::Index channel, Eigen::Index position) const noexcept {
    const Eigen::Index next = position + 4;
    if (next >= size()) return;
    prefetch(rows_[channel][next], unknowns_);
  }

  void interpolate_between_cells(const std::vector<location>& locations) {
    std::vector<Eigen::Index> between;
    for (Eigen::Index i = 0; i < std::ssize(locations); ++i)
      if (locations[i].count != 1) between.push_back(i);
    interpolated_ = std::make_shared<cell_matrix>(3 * std::ssize(between), unknowns_);
    for_each_block(
        between.size(), 256,
        [&](block range) {
          Eigen::RowVectorXd row(unknowns_);
          for (Eigen::Index slot = range.begin; slot < range.end; ++slot)
            for (Eigen::Index c = 0; c < 3; ++c) {
              auto own = interpolated_->row(3 * slot + c);
              read_row_at(channels_[c], locations[between[slot]], row);
              own = row.template cast<float>();
              rows_[c][between[slot]] = own.data();
            }
        },
        threads_);
  }

  using channel_type = std::remove_cvref_t<decltype(channel_of(std::declval<const Basis&>(), 0))>;

  std::vector<Eigen::Index> columns_;
  Eigen::Index unknowns_;
  std::array<channel_type, 3> channels_;  // keep the rows alive
  std::array<std::vector<const float*>, 3> rows_;
  std::shared_ptr<cell_matrix> interpolated_;  // copies read the same rows
  thread_count threads_;
};

}  // namespace gonio
