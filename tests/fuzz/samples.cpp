/// Samples, and the same file as directions: what is accepted as one of a kind is as the other, and what is written is
/// read.

#include "harness.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

namespace {

/// How many directions a reader finds, or what it says against them.
struct answer {
  std::size_t count = 0;
  std::optional<gonio::error> refusal;
};

template <class Read>
answer ask(const Read& read) {
  try {
    return {read().size(), {}};
  } catch (const gonio::error& refusal) {
    return {0, refusal};
  }
}

void require_same(const answer& one, const answer& other) {
  if (one.count == other.count) return;
  for (const answer& each : {one, other})
    std::fprintf(stderr, "%s\n", each.refusal ? each.refusal->what() : "accepted");
  std::abort();
}

const std::optional<gonio::io::sample_quantity> none, percent = gonio::io::sample_quantity::percent;

/// It begins with the file's name.
void check_note(const std::string& sentence) {
  if (!sentence.starts_with("/proc/self/fd/")) std::abort();
}

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes);
  const answer angles = ask([&] { return gonio::io::read_directions(file.path()); });
  require_same(angles, ask([&] { return gonio::io::read_direction_pairs(file.path()); }));
  if (angles.refusal) throw *angles.refusal;
  // A file that does not say what its numbers are is read as percent.
  const answer plain = ask([&] { return gonio::io::read_samples(file.path()); });
  const auto given = gonio::io::read_sample_file(
      file.path(), {.columns = {}, .quantity = plain.refusal ? percent : none, .note = check_note});
  const std::string text = gonio::io::write_samples(given.samples, given.provenance);
  const auto again = gonio::io::read_sample_file(text, fuzz::bytes_name);
  if (again.samples.size() != given.samples.size() || !(again.samples.channels() == given.samples.channels()))
    std::abort();
  for (Eigen::Index i = 0; i < std::ssize(given.samples); ++i)
    if (!std::ranges::equal(again.samples.values(i), given.samples.values(i))) std::abort();
  if (comment_lines(again.provenance) != comment_lines(given.provenance)) std::abort();
}

const fuzz::registered harness("samples", &read);

}  // namespace
