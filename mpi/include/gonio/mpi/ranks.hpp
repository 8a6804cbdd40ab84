#pragma once
/// The ranks of an MPI job: `mpirun -n 4 program` starts four processes of the program, numbered from 0. Messages
/// between them are counted here. Collective operations consist of single messages, so neither the order of a sum nor
/// the bytes on the network depend on the MPI library. Standard: MPI 3.1 (mpi-forum.org). This header needs an MPI
/// library (gonio::mpi), but does not include the library's headers.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace gonio::mpi {

/// The messages a rank has sent, and its processor time in MPI: copying, and waiting, which spins.
struct traffic {
  std::uint64_t messages = 0, bytes = 0;
  double processor_seconds = 0.0;
};

/// This process in its job. Only one thread may call it. A process outside a job is the only rank, 0.
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
  /// Initialises MPI if the program has not.
  ranks();
  /// Finalises MPI if the constructor initialised it. If an exception is propagating, it ends the whole job, because
  /// others may wait for a message of this rank.
  ~ranks();
  ranks(const ranks&) = delete;
  ranks& operator=(const ranks&) = delete;

  [[nodiscard]] int rank() const noexcept;
  [[nodiscard]] int size() const noexcept;
  /// Returns true at rank 0, which reads and writes unique resources.
  [[nodiscard]] bool is_first() const noexcept { return rank() == 0; }
  /// Returns the number of ranks on this machine, including this one. They share its cores.
  [[nodiscard]] int on_this_machine() const noexcept;
  [[nodiscard]] traffic sent() const noexcept;

  /// Sends any number of bytes, and returns when the other rank receives them.
  void send(int to, std::span<const std::byte> bytes) const;
  /// Sends bytes and returns at once. They stay in memory until the other rank receives them.
  void post(int to, std::vector<std::byte> bytes) const;
  /// Waits until at most `most` of the posted messages are still to be received.
  void wait(std::size_t most = 0) const;
  /// Returns the next bytes that a rank sent to this one.
  [[nodiscard]] std::vector<std::byte> receive(int from) const;
  /// Returns true if a rank sent something that has not been received yet.
  [[nodiscard]] bool has_message(int from) const;

  /// Returns every rank's bytes at rank 0, in rank order; nothing at other ranks. Takes size() - 1 messages.
  [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) const;
  /// Returns rank 0's bytes at every rank: size() - 1 messages in a binary tree, at most log2(size()) in sequence.
  [[nodiscard]] std::vector<std::byte> broadcast(std::vector<std::byte> bytes) const;

  /// Runs work that may throw in each rank. If the work throws in any rank, this function throws in all ranks, with the
  /// message of the lowest failing rank and, unless all ranks failed, its number: gonio::error if the work threw one,
  /// otherwise std::runtime_error.
  void together(const std::function<void()>& work) const;
  /// Returns true if `together` threw. Then all ranks know of the failure, and none waits for another.
  [[nodiscard]] bool failed_together() const noexcept;

  /// Throws gonio::error in all ranks unless the checksum of each rank's input is the same: "the ranks read different
  /// inputs: rank 1's prior differs from rank 0's" for `what` = "prior".
  void agree_on(std::uint32_t checksum, std::string_view what) const;

  /// Ends all processes of the job with an exit code.
  [[noreturn]] void abort(int code) const;

 private:
  struct state;
  std::unique_ptr<state> state_;
};

/// Returns a number, or a struct of numbers, as bytes to send.
template <class Number>
[[nodiscard]] std::vector<std::byte> bytes_of(const Number& number) {
  std::vector<std::byte> bytes(sizeof number);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// Returns the argument of `bytes_of`.
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
