#pragma once
/// Bodies of solve/row_groups.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/product_sum.hpp>
#include <gonio/solve/row_groups.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace gonio::detail {

/// The number of rows that are read at a time. The products of these rows are summed before they are added to the
/// total.
inline constexpr Eigen::Index rows_at_once = product_sum<double>::block_rows;

/// The sums of subtrees of groups, each kept until the sum of the neighbouring subtree is known.
class waiting_sums {
 public:
  explicit waiting_sums(block groups) : groups_(groups) {}

  /// Adds the sum of a group. Joins it with the sums of neighbouring subtrees that are already known.
  void add(Eigen::Index group, Eigen::MatrixXd sum) {
    Eigen::Index size = 1, number = group - groups_.begin;
    for (; size < groups_.size(); size *= 2, number /= 2) {
      const std::pair here{size, number}, neighbour{size, number ^ 1};
      const std::scoped_lock lock(mutex_);
      const auto found = sums_.find(neighbour);
      if (found == sums_.end()) {
        sums_.emplace(here, std::move(sum));
        return;
      }
      sum += found->second;
      sums_.erase(found);
    }
    total_ = std::move(sum);
  }

  [[nodiscard]] Eigen::MatrixXd take_total() { return std::move(total_); }

 private:
  block groups_;
  std::mutex mutex_;
  std::map<std::pair<Eigen::Index, Eigen::Index>, Eigen::MatrixXd> sums_;  // by size and number of the subtree
  Eigen::MatrixXd total_;
};

/// Calls `work(range)` for each block of a group's rows, in order.
template <class Work>
void for_each_block_of(Eigen::Index group, Eigen::Index all_rows, Work&& work) {
  const block rows = rows_of_groups(all_rows, {group, group + 1});
  for (Eigen::Index begin = rows.begin; begin < rows.end; begin += rows_at_once)
    work(block{begin, std::min(rows.end, begin + rows_at_once)});
}

/// Calls `work(range, A, A U)` for each block of a group's rows.
template <class Work>
void for_each_product_of(Eigen::Index group, const row_source& rows, const Eigen::MatrixXd& transposed_vectors,
                         Work&& work) {
  row_matrix held(rows_at_once, rows.columns);
  for_each_block_of(group, rows.rows, [&](block range) {
    auto read = held.topRows(range.size());
    rows.read(range, read);
    work(range, read, product(transposed_vectors, read.transpose()).transpose().eval());
  });
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE block rows_of_groups(Eigen::Index rows, block groups) {
  const Eigen::Index blocks = (rows + detail::rows_at_once - 1) / detail::rows_at_once;
  const auto begin = [&](Eigen::Index group) {
    return std::min(rows, group * blocks / row_groups * detail::rows_at_once);
  };
  return {begin(groups.begin), begin(groups.end)};
}

GONIO_INLINE Eigen::MatrixXd sum_over_groups(block groups, thread_count threads,
                                             const std::function<Eigen::MatrixXd(Eigen::Index group)>& of_group) {
  const Eigen::Index count = groups.size();
  if (groups.begin < 0 || groups.end > row_groups || count < 1 || !std::has_single_bit(std::uint64_t(count)) ||
      groups.begin % count != 0)
    refuse({"groups ", groups.begin, " to ", groups.end, " are not a subtree of the ", row_groups, " groups"});
  detail::waiting_sums sums(groups);
  for_each_index(
      count, 1,
      [&](Eigen::Index number) {
        const Eigen::Index group = groups.begin + number;
        sums.add(group, of_group(group));
      },
      threads);
  return sums.take_total();
}

GONIO_INLINE Eigen::MatrixXd sum_of_subtrees(std::vector<Eigen::MatrixXd> sums) {
  if (!std::has_single_bit(sums.size())) refuse({"sums of ", sums.size(), " subtrees, expected a power of two"});
  for (std::size_t step = 1; step < sums.size(); step *= 2)
    for (std::size_t i = 0; i < sums.size(); i += 2 * step) {
      sums[i] += sums[i + step];
      sums[i + step].resize(0, 0);
    }
  return std::move(sums.front());
}

GONIO_INLINE Eigen::MatrixXd gram(const row_source& rows, block groups, thread_count threads) {
  return sum_over_groups(groups, threads, [&](Eigen::Index group) {
    detail::product_sum<double> sum(rows.columns);
    detail::for_each_block_of(group, rows.rows, [&](block range) {
      row_matrix read(range.size(), rows.columns);
      rows.read(range, read);
      for (Eigen::Index row = 0; row < read.rows(); ++row) sum.put(row, read.data() + row * read.cols(), read.cols());
      sum.add(range.size());
    });
    return sum.symmetric();
  });
}

GONIO_INLINE Eigen::MatrixXd gram_times(const row_source& rows, const Eigen::MatrixXd& vectors, block groups,
                                        thread_count threads, const product_writer& write) {
  const Eigen::MatrixXd transposed = vectors.transpose();
  return sum_over_groups(groups, threads, [&](Eigen::Index group) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows.columns, vectors.cols());
    detail::for_each_product_of(group, rows, transposed, [&](block range, auto read, const Eigen::MatrixXd& along) {
      if (write) write(range, along);
      add_product(read.transpose(), along, sum);
    });
    return sum;
  });
}

GONIO_INLINE void for_each_product(const row_source& rows, const Eigen::MatrixXd& vectors, block groups,
                                   thread_count threads, const product_writer& write) {
  const Eigen::MatrixXd transposed = vectors.transpose();
  for_each_index(
      groups.size(), 1,
      [&](Eigen::Index number) {
        detail::for_each_product_of(
            groups.begin + number, rows, transposed,
            [&](block range, const auto& /*read*/, const Eigen::MatrixXd& along) { write(range, along); });
      },
      threads);
}

GONIO_INLINE Eigen::MatrixXd shared_groups::sum_over_all(const sum_of& of_groups) const {
  return sum ? sum(of_groups) : of_groups(own);
}

GONIO_INLINE void shared_groups::complete_rows(std::span<float> numbers, Eigen::Index rows) const {
  if (complete) complete(numbers, rows);
}

}  // namespace gonio
