#pragma once
/// Bodies of io/measurements/sample_provenance.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE comment_entry entry_of(std::string_view comment) {
  const std::size_t colon = comment.find(':');
  if (colon == std::string_view::npos) return {};
  return {lower_case(trimmed(comment.substr(0, colon))), trimmed(comment.substr(colon + 1))};
}

[[gnu::cold]] GONIO_INLINE void keep(sample_provenance& provenance, const comment_entry& entry) {
  std::string* const text = entry.key == "instrument"   ? &provenance.instrument
                            : entry.key == "date"       ? &provenance.date
                            : entry.key == "conditions" ? &provenance.conditions
                                                        : nullptr;
  if (text == nullptr || entry.value.empty()) return;
  if (!text->empty()) *text += "; ";
  *text += entry.value;
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::string comment_lines(const sample_provenance& provenance) {
  std::string text;
  const auto append = [&](std::string_view key, const std::string& value) {
    if (!value.empty()) text += message_of({"# ", key, ": ", printable(value), "\n"});
  };
  append("instrument", provenance.instrument);
  append("date", provenance.date);
  append("conditions", provenance.conditions);
  return text;
}

}  // namespace gonio::io
