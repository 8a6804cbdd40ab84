#pragma once
/// Where measurements come from: what the comment lines `# instrument: ...`, `# date: ...` and `# conditions: ...` of
/// their file say, in any words.

#include <string>
#include <string_view>

namespace gonio::io {

struct sample_provenance {
  std::string instrument, date, conditions;

  [[nodiscard]] bool empty() const noexcept { return instrument.empty() && date.empty() && conditions.empty(); }
  friend bool operator==(const sample_provenance&, const sample_provenance&) = default;
};

/// A comment line for each entry that is there. Control characters are escaped (`printable`), so that an entry cannot
/// be taken for a line of numbers.
[[nodiscard]] std::string comment_lines(const sample_provenance& provenance);

namespace detail {

/// A comment `key: value` without its #: the key in small letters, both trimmed; without a colon both are empty.
struct comment_entry {
  std::string key;
  std::string_view value;
};
[[nodiscard]] comment_entry entry_of(std::string_view comment);

/// Keeps an entry that is one of a provenance; one that is there already is gone on with, behind a semicolon.
void keep(sample_provenance& provenance, const comment_entry& entry);

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_provenance.ipp>
#endif
