#pragma once
/// The origin of measurements, free text from the comment lines `# instrument: ...`, `# date: ...` and `# conditions:
/// ...` of their file.

#include <string>
#include <string_view>

namespace gonio::io {

struct sample_provenance {
  std::string instrument, date, conditions;

  [[nodiscard]] bool empty() const noexcept { return instrument.empty() && date.empty() && conditions.empty(); }
  friend bool operator==(const sample_provenance&, const sample_provenance&) = default;
};

/// Returns a comment line for each nonempty entry. Control characters are escaped (`printable`), so that an entry
/// cannot end its line and inject a line of numbers.
[[nodiscard]] std::string comment_lines(const sample_provenance& provenance);

namespace detail {

/// A comment `key: value` without its #: the key in lower case, both trimmed; both empty if there is no colon.
struct comment_entry {
  std::string key;
  std::string_view value;
};
[[nodiscard]] comment_entry entry_of(std::string_view comment);

/// Keeps an entry if it belongs to a provenance; appends it after a semicolon if one with the same key exists.
void keep(sample_provenance& provenance, const comment_entry& entry);

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_provenance.ipp>
#endif
