#pragma once
/// Passes over a tall matrix that is never held: A'A, A'(A U) and A U, a block of rows at a time. Rows are cut into a
/// fixed number of groups, and the sums of groups are added as a binary tree, so that the same bytes come out for any
/// number of threads, and of processes that each own some subtrees of it.

#include <gonio/core/parallel.hpp>
#include <gonio/solve/matrix_view.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

namespace gonio {

/// Contiguous groups of rows, whatever the matrix and the machine: a power of two, as many as processes can share.
inline constexpr Eigen::Index row_groups = 64;
/// All of them.
inline constexpr block all_row_groups{0, row_groups};

/// The rows of some groups. All groups but the last that is not empty have multiples of 128 rows, as equal as they can
/// be; those of a small matrix may be empty.
[[nodiscard]] block rows_of_groups(Eigen::Index rows, block groups);

/// The sum of what `of_group` gives for each of some groups, which are a subtree: 2^n of them, from a multiple of 2^n
/// on. Throws gonio::error if they are not. Holds a matrix for each thread and at most 7 more with one thread.
[[nodiscard]] Eigen::MatrixXd sum_over_groups(block groups, thread_count threads,
                                              const std::function<Eigen::MatrixXd(Eigen::Index group)>& of_group);

/// The sum of the sums of equal subtrees in their order, as sum_over_groups adds them: of [0, 8) and [8, 16), say.
/// Their number is a power of two; throws gonio::error if it is not.
[[nodiscard]] Eigen::MatrixXd sum_of_subtrees(std::vector<Eigen::MatrixXd> sums);

/// A'A of the rows of a subtree of groups: columns x columns. n k^2 operations for n rows and k columns. Each thread
/// holds two matrices of that size.
[[nodiscard]] Eigen::MatrixXd gram(const row_source& rows, block groups, thread_count threads = {});

/// Takes A U of a block of at most 128 rows, from several threads at once.
using product_writer = std::function<void(block range, const Eigen::MatrixXd& product)>;

/// A'(A U) of the same rows for U of columns x l: columns x l. 4 n k l operations. Each thread holds two matrices of
/// that size and 128 rows. `write`, if there is one, is given A U meanwhile.
[[nodiscard]] Eigen::MatrixXd gram_times(const row_source& rows, const Eigen::MatrixXd& vectors, block groups,
                                         thread_count threads = {}, const product_writer& write = {});

/// A U alone, of any range of groups. 2 n k l operations.
void for_each_product(const row_source& rows, const Eigen::MatrixXd& vectors, block groups, thread_count threads,
                      const product_writer& write);

/// How several processes share passes over groups. One process alone does all: then nothing is set.
struct shared_groups {
  using sum_of = std::function<Eigen::MatrixXd(block groups)>;

  block own = all_row_groups;  ///< a subtree that is this process'; empty if there are more processes than groups
  /// The sum over all groups, at every process: `of_groups` is called with `own`, and the sums are added along the
  /// tree.
  std::function<Eigen::MatrixXd(const sum_of& of_groups)> sum;
  /// Of numbers for each row, of which each process has those of its own groups, the process that writes gets all.
  std::function<void(std::span<float> numbers, Eigen::Index rows)> complete;

  /// `sum`, or what it is alone.
  [[nodiscard]] Eigen::MatrixXd sum_over_all(const sum_of& of_groups) const;
  /// `complete`, or nothing.
  void complete_rows(std::span<float> numbers, Eigen::Index rows) const;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/row_groups.ipp>
#endif
