#pragma once
/// Bodies of mpi/ranks.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/mpi/ranks.hpp>

#include <mpi.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace gonio::mpi {

namespace detail {

/// A message being sent. MPI counts its size as int, so long messages are sent in pieces. A full piece is followed by
/// another.
struct posted {
  std::vector<std::byte> bytes;
  std::vector<MPI_Request> pieces;
};

inline constexpr std::size_t full_piece = std::size_t{1} << 30;
/// Messages of `together` have their own tag, which identifies a rank that failed alone.
inline constexpr int message_tag = 0, outcome_tag = 1;

/// Adds this thread's processor time during the timer's lifetime to a sum.
class processor_timer {
 public:
  explicit processor_timer(double& sum) : sum_(sum), start_(now()) {}
  processor_timer(const processor_timer&) = delete;
  processor_timer& operator=(const processor_timer&) = delete;
  ~processor_timer() { sum_ += now() - start_; }

 private:
  static double now() {
    std::timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double& sum_;
  double start_;
};

}  // namespace detail

// Errors of MPI itself end the job, as is the default for a communicator.
struct ranks::state {
  MPI_Comm all = MPI_COMM_NULL;
  int rank = 0, size = 1, on_this_machine = 1;
  int tag = detail::message_tag;
  bool ends_mpi = false, failed_together = false;
  std::string failure;  ///< the failure of this rank, while the rank tells it to all other ranks
  traffic sent;
  std::deque<detail::posted> under_way;

  [[nodiscard]] std::vector<MPI_Request> start(int to, std::span<const std::byte> bytes) {
    std::vector<MPI_Request> pieces;
    sent.bytes += bytes.size();
    bool was_full = true;
    for (std::size_t begin = 0; was_full; begin += detail::full_piece) {
      const std::size_t count = std::min(bytes.size() - begin, detail::full_piece);
      pieces.emplace_back();
      MPI_Issend(bytes.data() + begin, static_cast<int>(count), MPI_BYTE, to, tag, all, &pieces.back());
      ++sent.messages;
      was_full = count == detail::full_piece;
    }
    return pieces;
  }
  /// Ends the job because one of two ranks failed while the other continued.
  [[noreturn]] void end_apart(int other, int tag_of_other, std::span<const std::byte> bytes) const {
    std::string why = failure;
    if (tag_of_other == detail::outcome_tag) {
      why.resize(bytes.size());
      if (!bytes.empty()) std::memcpy(why.data(), bytes.data(), bytes.size());
    }
    const std::string sentence =
        message_of({"rank ", tag_of_other == detail::outcome_tag ? other : rank,
                    " failed alone: ", why.empty() ? "its work differs from the others'" : why.substr(1), "\n"});
    std::fputs(sentence.c_str(), stderr);
    MPI_Abort(all, 1);
    std::abort();  // not reached, MPI_Abort has ended the process
  }
  void finish(std::vector<MPI_Request>& pieces) {
    const detail::processor_timer timer(sent.processor_seconds);
    MPI_Waitall(static_cast<int>(pieces.size()), pieces.data(), MPI_STATUSES_IGNORE);
  }
};

namespace detail {

/// The message of a failed rank: a letter for the kind of exception, and the text.
inline constexpr char is_refusal = 'r', is_failure = 'f';

[[nodiscard]] GONIO_INLINE std::string failure_of(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const gonio::error& error) {
    return std::string(1, is_refusal) + error.what();
  } catch (const std::bad_alloc&) {
    return std::string(1, is_failure) + "there is not enough memory";
  } catch (const std::exception& error) {
    return std::string(1, is_failure) + error.what();
  }
}

/// Returns the message for all ranks: empty if none failed; otherwise the first failure, with its rank unless all
/// failed.
[[nodiscard]] GONIO_INLINE std::vector<std::byte> outcome_of(const std::vector<std::vector<std::byte>>& failures) {
  const auto has_failed = [](const auto& failure) { return !failure.empty(); };
  const auto first = std::ranges::find_if(failures, has_failed);
  if (first == failures.end()) return {};
  std::vector<std::byte> told = *first;
  if (std::ranges::all_of(failures, has_failed)) return told;
  const std::string who = message_of({"rank ", first - failures.begin(), ": "});
  const auto letters = std::as_bytes(std::span(who));
  told.insert(told.begin() + 1, letters.begin(), letters.end());
  return told;
}

}  // namespace detail

GONIO_INLINE ranks::ranks() : state_(std::make_unique<state>()) {
  int begun = 0;
  MPI_Initialized(&begun);
  if (begun == 0) {
    int threads = 0;  // MPI's answer; only this thread calls MPI, other threads only compute
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads);
    state_->ends_mpi = true;
  }
  MPI_Comm_dup(MPI_COMM_WORLD, &state_->all);
  MPI_Comm_rank(state_->all, &state_->rank);
  MPI_Comm_size(state_->all, &state_->size);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(state_->all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &state_->on_this_machine);
  MPI_Comm_free(&machine);
}

GONIO_INLINE ranks::~ranks() {
  if (std::uncaught_exceptions() > 0 && state_->size > 1) abort(1);
  MPI_Comm_free(&state_->all);
  if (state_->ends_mpi) MPI_Finalize();
}

GONIO_INLINE int ranks::rank() const noexcept { return state_->rank; }
GONIO_INLINE int ranks::size() const noexcept { return state_->size; }
GONIO_INLINE int ranks::on_this_machine() const noexcept { return state_->on_this_machine; }
GONIO_INLINE traffic ranks::sent() const noexcept { return state_->sent; }
GONIO_INLINE bool ranks::failed_together() const noexcept { return state_->failed_together; }

GONIO_INLINE void ranks::abort(int code) const {
  MPI_Abort(state_->all, code);
  std::abort();  // not reached, MPI_Abort has ended the process
}

// ---- messages ----------------------------------------------------------------------------------

GONIO_INLINE void ranks::send(int to, std::span<const std::byte> bytes) const {
  auto pieces = state_->start(to, bytes);
  state_->finish(pieces);
}

GONIO_INLINE void ranks::post(int to, std::vector<std::byte> bytes) const {
  auto& added = state_->under_way.emplace_back();
  added.bytes = std::move(bytes);
  added.pieces = state_->start(to, added.bytes);
}

GONIO_INLINE void ranks::wait(std::size_t most) const {
  while (state_->under_way.size() > most) {
    state_->finish(state_->under_way.front().pieces);
    state_->under_way.pop_front();
  }
}

GONIO_INLINE bool ranks::has_message(int from) const {
  int is_there = 0;
  MPI_Iprobe(from, detail::message_tag, state_->all, &is_there, MPI_STATUS_IGNORE);
  return is_there != 0;
}

GONIO_INLINE std::vector<std::byte> ranks::receive(int from) const {
  const detail::processor_timer timer(state_->sent.processor_seconds);
  std::vector<std::byte> bytes;
  bool was_full = true;
  while (was_full) {
    MPI_Status status;
    int count = 0;
    MPI_Probe(from, MPI_ANY_TAG, state_->all, &status);
    MPI_Get_count(&status, MPI_BYTE, &count);
    const std::size_t begin = bytes.size();
    bytes.resize(begin + static_cast<std::size_t>(count));
    MPI_Recv(bytes.data() + begin, count, MPI_BYTE, from, status.MPI_TAG, state_->all, MPI_STATUS_IGNORE);
    was_full = static_cast<std::size_t>(count) == detail::full_piece;
    if (status.MPI_TAG != state_->tag) state_->end_apart(from, status.MPI_TAG, bytes);
  }
  return bytes;
}

GONIO_INLINE std::vector<std::vector<std::byte>> ranks::gather(std::span<const std::byte> bytes) const {
  std::vector<std::vector<std::byte>> all;
  if (!is_first()) {
    send(0, bytes);
    return all;
  }
  all.emplace_back(bytes.begin(), bytes.end());
  for (int other = 1; other < size(); ++other) all.push_back(receive(other));
  return all;
}

GONIO_INLINE std::vector<std::byte> ranks::broadcast(std::vector<std::byte> bytes) const {
  // Rank r receives from the rank whose number is r without its lowest set bit. It sends to r + 2^i for all bits i
  // below that bit.
  const unsigned own = static_cast<unsigned>(rank()), count = static_cast<unsigned>(size());
  const unsigned lowest = own == 0 ? std::bit_ceil(count) : own & (~own + 1u);
  if (own != 0) bytes = receive(static_cast<int>(own - lowest));
  for (unsigned bit = lowest >> 1; bit > 0; bit >>= 1)
    if (own + bit < count) send(static_cast<int>(own + bit), bytes);
  return bytes;
}

// ---- knowledge of all ranks --------------------------------------------------------------------

GONIO_INLINE void ranks::together(const std::function<void()>& work) const {
  state_->failure = detail::failure_of(work);
  state_->tag = detail::outcome_tag;
  const auto all = gather(std::as_bytes(std::span(state_->failure)));
  const auto told = broadcast(detail::outcome_of(all));
  state_->tag = detail::message_tag;
  state_->failure.clear();
  if (told.empty()) return;
  state_->failed_together = true;
  std::string sentence(told.size() - 1, ' ');
  std::memcpy(sentence.data(), told.data() + 1, sentence.size());
  if (static_cast<char>(told.front()) == detail::is_refusal) refuse(sentence);
  throw std::runtime_error(sentence);
}

GONIO_INLINE void ranks::agree_on(std::uint32_t checksum, std::string_view what) const {
  const auto all = gather(bytes_of(checksum));
  const auto other = std::ranges::find_if(all, [&](const auto& each) { return each != all.front(); });
  const auto told = broadcast(bytes_of(other == all.end() ? std::ptrdiff_t{0} : other - all.begin()));
  const auto odd = number_of<std::ptrdiff_t>(told);
  if (odd == 0) return;
  together([&] { refuse({"the ranks read different inputs: rank ", odd, "'s ", what, " differs from rank 0's"}); });
}

}  // namespace gonio::mpi
