#pragma once
/// Passes over a tall matrix that is never in memory: A'A, A'(A U) and A U, a block of rows at a time. Rows are divided
/// into a fixed number of groups, whose sums are added as a binary tree. The result has the same bytes for any number
/// of threads, and for any number of processes if each process owns subtrees.

#include <gonio/core/parallel.hpp>
#include <gonio/solve/matrix_view.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

namespace gonio {

/// The number of contiguous groups of rows, for any matrix and machine: a power of two, and the largest number of
/// processes.
inline constexpr Eigen::Index row_groups = 64;
/// All groups.
inline constexpr block all_row_groups{0, row_groups};

/// Returns the rows of some groups. Groups are as equal as possible; each has a multiple of 128 rows, except the last
/// group that is not empty. Groups of a small matrix may be empty.
[[nodiscard]] block rows_of_groups(Eigen::Index rows, block groups);

/// Returns the sum of `of_group` over the groups of a subtree: 2^n groups, where the number of the first is a multiple
/// of 2^n. Throws gonio::error for other groups. Holds one matrix for each thread; with one thread, at most 7 more.
[[nodiscard]] Eigen::MatrixXd sum_over_groups(block groups, thread_count threads,
                                              const std::function<Eigen::MatrixXd(Eigen::Index group)>& of_group);

/// Returns the total of the sums of subtrees of equal size, given in order: for example of the groups [0, 8) and [8,
/// 16). Adds them as sum_over_groups does. Throws gonio::error unless the number of sums is a power of two.
[[nodiscard]] Eigen::MatrixXd sum_of_subtrees(std::vector<Eigen::MatrixXd> sums);

/// Returns A'A of the n rows of a subtree of groups, k x k for k columns. n k^2 operations. Each thread holds two
/// matrices of that size.
[[nodiscard]] Eigen::MatrixXd gram(const row_source& rows, block groups, thread_count threads = {});

/// Receives A U for a block of at most 128 rows. It is called from several threads at once.
using product_writer = std::function<void(block range, const Eigen::MatrixXd& product)>;

/// Returns A'(A U), k x l, for the n rows of a subtree of groups and U of k x l. 4 n k l operations. Each thread holds
/// two k x l matrices and 128 rows. If given, `write` receives A U.
[[nodiscard]] Eigen::MatrixXd gram_times(const row_source& rows, const Eigen::MatrixXd& vectors, block groups,
                                         thread_count threads = {}, const product_writer& write = {});

/// Computes A U alone, for any range of groups. 2 n k l operations for n rows and U of k x l.
void for_each_product(const row_source& rows, const Eigen::MatrixXd& vectors, block groups, thread_count threads,
                      const product_writer& write);

/// How several processes share passes over groups. If there is only one process, the members are not set.
struct shared_groups {
  using sum_of = std::function<Eigen::MatrixXd(block groups)>;

  block own = all_row_groups;  ///< the subtree of this process; empty if there are more processes than groups
  /// Returns the sum over all groups, at every process: calls `of_groups` with `own`, and adds the sums of all
  /// processes along the tree.
  std::function<Eigen::MatrixXd(const sum_of& of_groups)> sum;
  /// Gathers numbers for each row at the process that writes the result. Each process provides the numbers of its own
  /// groups.
  std::function<void(std::span<float> numbers, Eigen::Index rows)> complete;

  /// Calls `sum` if it is set; otherwise computes the sum over all groups in this process.
  [[nodiscard]] Eigen::MatrixXd sum_over_all(const sum_of& of_groups) const;
  /// Calls `complete` if it is set.
  void complete_rows(std::span<float> numbers, Eigen::Index rows) const;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/row_groups.ipp>
#endif
