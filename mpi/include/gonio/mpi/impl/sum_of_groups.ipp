#pragma once
/// Bodies of mpi/sum_of_groups.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/mpi/ranks.hpp>
#include <gonio/mpi/sum_of_groups.hpp>

#include <Eigen/Core>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <span>
#include <vector>

namespace gonio::mpi {

namespace detail {

/// Encodes a partial sum as a message: its number of rows and its values; no values if it is empty.
[[nodiscard]] GONIO_INLINE std::vector<std::byte> message_of_sum(const Eigen::MatrixXd& sum) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(sum.size() + 1) * sizeof(double));
  const Eigen::Index rows = sum.rows();
  std::memcpy(bytes.data(), &rows, sizeof rows);
  if (sum.size() > 0) std::memcpy(bytes.data() + sizeof rows, sum.data(), bytes.size() - sizeof rows);
  return bytes;
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd sum_of_message(std::span<const std::byte> bytes) {
  const auto rows = number_of<Eigen::Index>(bytes);
  const auto count = static_cast<Eigen::Index>(bytes.size() / sizeof(double)) - 1;
  Eigen::MatrixXd sum(rows, rows > 0 ? count / rows : 0);
  if (sum.size() > 0) std::memcpy(sum.data(), bytes.data() + sizeof rows, bytes.size() - sizeof rows);
  return sum;
}

/// The binary tree of sums. Each sum is at the rank of its first group.
class tree_of_sums {
 public:
  tree_of_sums(const ranks& ranks, Eigen::Index groups, const std::function<Eigen::MatrixXd(Eigen::Index)>& partial)
      : ranks_(ranks), partial_(partial) {
    for (int rank = 0; rank < ranks.size(); ++rank) {
      const block own = groups_of(rank, ranks.size(), groups);
      for (Eigen::Index group = own.begin; group < own.end; ++group) owners_.push_back(rank);
    }
  }

  /// Returns the sum of a range of groups if its first group belongs to this rank. Otherwise sends this rank's part of
  /// the sum, and returns nothing.
  [[nodiscard]] Eigen::MatrixXd sum(block range) {
    if (owner(range.begin) > ranks_.rank() || owner(range.end - 1) < ranks_.rank()) return {};
    if (range.size() == 1) return leaf(range.begin);
    const Eigen::Index half =
        range.begin + static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::uint64_t>(range.size()))) / 2;
    Eigen::MatrixXd total = sum({range.begin, half}), rest = sum({half, range.end});
    const int to = owner(range.begin), from = owner(half);
    if (to != from && from == ranks_.rank()) ranks_.send(to, message_of_sum(rest));
    if (to != ranks_.rank()) return {};
    if (to != from) rest = sum_of_message(ranks_.receive(from));
    if (total.rows() != rest.rows() || total.cols() != rest.cols()) return {};  // one rank has failed
    total += rest;
    return total;
  }

  /// Returns the exception of `partial`, if any.
  [[nodiscard]] const std::exception_ptr& thrown() const noexcept { return thrown_; }

 private:
  [[nodiscard]] int owner(Eigen::Index group) const { return owners_[static_cast<std::size_t>(group)]; }

  [[nodiscard]] Eigen::MatrixXd leaf(Eigen::Index group) {
    try {
      if (!thrown_) return partial_(group);
    } catch (...) {
      thrown_ = std::current_exception();
    }
    return {};
  }

  const ranks& ranks_;
  const std::function<Eigen::MatrixXd(Eigen::Index)>& partial_;
  std::vector<int> owners_;
  std::exception_ptr thrown_;
};

}  // namespace detail

GONIO_INLINE block groups_of(int rank, int ranks, Eigen::Index groups) {
  const auto before = [&](Eigen::Index count) { return (count * groups + ranks - 1) / ranks; };
  return {before(rank), before(rank + 1)};
}

GONIO_INLINE Eigen::MatrixXd sum_of_groups(const ranks& ranks, Eigen::Index groups,
                                           const std::function<Eigen::MatrixXd(Eigen::Index)>& partial) {
  if (groups < 1) refuse("a sum needs at least one group");
  detail::tree_of_sums tree(ranks, groups, partial);
  const Eigen::MatrixXd total = tree.sum({0, groups});
  ranks.together([&] {
    if (tree.thrown()) std::rethrow_exception(tree.thrown());
  });
  return detail::sum_of_message(ranks.broadcast(detail::message_of_sum(total)));
}

}  // namespace gonio::mpi
