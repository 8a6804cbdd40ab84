#pragma once
/// The ranks of an MPI job: `mpirun -n 4 program` starts four processes of the program, numbered from 0. What they send
/// one another is counted here, so that collective operations are made of single messages: nothing is left to what an
/// MPI library chooses, neither the order of a sum nor the bytes on the network. Standard: MPI 3.1 (mpi-forum.org).
/// Needs an MPI library (gonio::mpi); its headers are not included.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace gonio::mpi {

/// What a rank has sent to others, and the processor time that it spent in MPI: copying, and waiting, which spins.
struct traffic {
  std::uint64_t messages = 0, bytes = 0;
  double processor_seconds = 0.0;
};

/// This process among all of its job. One thread calls it. A process that is no part of a job is the one rank 0.
///
/// ```cpp
/// #include <gonio/mpi/gather_in_order.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::mpi::ranks ranks;
///   const auto square = [](Eigen::Index i) { return std::vector<std::byte>{static_cast<std::byte>(i * i)}; };
///   gather_in_order(ranks, {0, 9}, square,
///                   [](Eigen::Index i, auto bytes) { std::printf("%d %d\n", int(i), int(bytes[0])); });
/// }
/// ```
class ranks {
 public:
  /// Begins MPI if the program has not.
  ranks();
  /// Ends MPI if it was begun here. Where an exception is on its way the whole job is ended instead: others may wait
  /// for a message of this rank.
  ~ranks();
  ranks(const ranks&) = delete;
  ranks& operator=(const ranks&) = delete;

  [[nodiscard]] int rank() const noexcept;
  [[nodiscard]] int size() const noexcept;
  /// Rank 0 reads and writes what there is one of.
  [[nodiscard]] bool is_first() const noexcept { return rank() == 0; }
  /// Ranks on this machine, of which this is one: they share its cores.
  [[nodiscard]] int on_this_machine() const noexcept;
  [[nodiscard]] traffic sent() const noexcept;

  /// Sends bytes, of any number, and returns when the other rank receives them.
  void send(int to, std::span<const std::byte> bytes) const;
  /// Sends bytes, and returns at once: they stay in memory until the other rank receives them.
  void post(int to, std::vector<std::byte> bytes) const;
  /// Returns when at most so many of what was posted are not received.
  void wait(std::size_t most = 0) const;
  /// The next bytes that a rank sent to this one.
  [[nodiscard]] std::vector<std::byte> receive(int from) const;
  /// Has a rank sent something that was not received yet?
  [[nodiscard]] bool has_message(int from) const;

  /// Every rank's bytes at rank 0, by their ranks; nothing elsewhere. size() - 1 messages.
  [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) const;
  /// Rank 0's bytes at every rank, by a binary tree: size() - 1 messages, at most log2(size()) after one another.
  [[nodiscard]] std::vector<std::byte> broadcast(std::vector<std::byte> bytes) const;

  /// Does work that may throw in each rank. If it throws in any, it throws in all: the sentence of the lowest of these
  /// ranks, with its number unless all failed, as gonio::error if it was one and as std::runtime_error if not.
  void together(const std::function<void()>& work) const;
  /// Did `together` throw? Then all ranks know, and none waits for another.
  [[nodiscard]] bool failed_together() const noexcept;

  /// Throws gonio::error in all ranks unless the checksum of what each has read is the same: "the ranks read different
  /// inputs: rank 1's prior is not rank 0's" for `what` = "prior".
  void agree_on(std::uint32_t checksum, std::string_view what) const;

  /// Ends all processes of the job with an exit code.
  [[noreturn]] void abort(int code) const;

 private:
  struct state;
  std::unique_ptr<state> state_;
};

/// A number, or a struct of numbers, as what ranks send.
template <class Number>
[[nodiscard]] std::vector<std::byte> bytes_of(const Number& number) {
  std::vector<std::byte> bytes(sizeof number);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// What `bytes_of` was given.
template <class Number>
[[nodiscard]] Number number_of(std::span<const std::byte> bytes) {
  Number number;
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/ranks.ipp>
#endif
