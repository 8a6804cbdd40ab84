#pragma once
/// The origin of measurements: free text from the comment lines `# instrument: ...`, `# date: ...` and
/// `# conditions: ...` of their file.

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

/// A comment `# key: value`: the key in lower case, key and value trimmed; both empty if there is no colon.
struct comment_entry {
  std::string key;
  std::string_view value;
};
[[nodiscard]] comment_entry entry_of(std::string_view comment);

/// Stores an entry whose key is instrument, date or conditions; ignores any other. Appends it, after a semicolon, to an
/// earlier entry of the same key.
void keep(sample_provenance& provenance, const comment_entry& entry);

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_provenance.ipp>
#endif
