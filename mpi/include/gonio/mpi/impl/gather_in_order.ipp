#pragma once
/// Bodies of mpi/gather_in_order.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/mpi/gather_in_order.hpp>
#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <exception>
#include <functional>
#include <utility>
#include <vector>

namespace gonio::mpi {

namespace detail {

/// The last byte of a message tells whether it is a part or its rank's last message.
inline constexpr std::byte is_part{1}, is_end{0};

[[nodiscard]] inline std::exception_ptr thrown_by(const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

/// Runs at rank 0: takes all parts, but stops at a part that fails at any rank. Then tells all other ranks to stop, and
/// waits until they have.
[[nodiscard]] GONIO_INLINE std::exception_ptr take_in_order(
    const ranks& ranks, block range, const std::function<std::vector<std::byte>(Eigen::Index)>& compute,
    const std::function<void(Eigen::Index, std::vector<std::byte>)>& take) {
  std::vector<bool> has_ended(static_cast<std::size_t>(ranks.size()), false);
  const auto receive = [&](int from) {
    std::vector<std::byte> bytes = ranks.receive(from);
    has_ended[static_cast<std::size_t>(from)] = bytes.back() == is_end;
    bytes.pop_back();
    return bytes;
  };
  const auto thrown = thrown_by([&] {
    for (Eigen::Index i = range.begin; i < range.end; ++i) {
      const int owner = static_cast<int>((i - range.begin) % ranks.size());
      std::vector<std::byte> bytes = owner == 0 ? compute(i) : receive(owner);
      if (has_ended[static_cast<std::size_t>(owner)]) return;  // the owner knows the reason
      take(i, std::move(bytes));
    }
  });
  for (int other = 1; other < ranks.size(); ++other) ranks.post(other, {});
  for (int other = 1; other < ranks.size(); ++other)
    while (!has_ended[static_cast<std::size_t>(other)]) static_cast<void>(receive(other));
  ranks.wait();
  return thrown;
}

/// Runs at all other ranks: sends the rank's parts until all are sent, one fails, or rank 0 tells the rank to stop.
[[nodiscard]] GONIO_INLINE std::exception_ptr send_in_order(
    const ranks& ranks, block range, const std::function<std::vector<std::byte>(Eigen::Index)>& compute) {
  const auto thrown = thrown_by([&] {
    for (Eigen::Index i = range.begin + ranks.rank(); i < range.end && !ranks.has_message(0); i += ranks.size()) {
      std::vector<std::byte> bytes = compute(i);
      bytes.push_back(is_part);
      ranks.wait(1);
      ranks.post(0, std::move(bytes));
    }
  });
  ranks.post(0, {is_end});
  ranks.wait();
  static_cast<void>(ranks.receive(0));
  return thrown;
}

}  // namespace detail

GONIO_INLINE void gather_in_order(const ranks& ranks, block range,
                                  const std::function<std::vector<std::byte>(Eigen::Index)>& compute,
                                  const std::function<void(Eigen::Index, std::vector<std::byte>)>& take) {
  const std::exception_ptr thrown = ranks.is_first() ? detail::take_in_order(ranks, range, compute, take)
                                                     : detail::send_in_order(ranks, range, compute);
  ranks.together([&] {
    if (thrown) std::rethrow_exception(thrown);
  });
}

}  // namespace gonio::mpi
