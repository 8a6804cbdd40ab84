#pragma once
/// Bodies of io/text/xml_element.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/xml_element.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Takes the next element of this name from the front of a text; returns its content, or a null view at the end.
GONIO_INLINE std::string_view xml_element::next(std::string_view& rest, std::string_view name) const {
  constexpr std::string_view ends_of_name = " \t\r\n/>";
  const std::string close = message_of({"</", name, ">"});
  for (std::size_t open = rest.find('<'); open != std::string_view::npos; open = rest.find('<')) {
    rest.remove_prefix(open);
    if (rest.starts_with("<!--")) {
      rest.remove_prefix(std::min(rest.find("-->"), rest.size()));
      continue;
    }
    rest.remove_prefix(1);
    const std::string_view after = rest.substr(std::min(name.size(), rest.size()));
    if (!rest.starts_with(name) || after.empty() || ends_of_name.find(after.front()) == std::string_view::npos)
      continue;
    const std::size_t tag = rest.find('>');
    if (tag == std::string_view::npos) position(rest).refuse({"the tag <", name, "> is not closed"});
    if (rest[tag - 1] == '/') return rest.substr(tag, 0);
    const std::string_view content = rest.substr(tag + 1);
    const std::size_t end = content.find(close);
    if (end == std::string_view::npos)
      position(rest).refuse({"the element <", name, "> is not closed, expected ", close});
    rest = content.substr(end);
    return content.substr(0, end);
  }
  return {};
}

GONIO_INLINE std::vector<xml_element> xml_element::all(std::string_view name) const {
  std::vector<xml_element> found;
  std::string_view rest = content_;
  for (std::string_view each = next(rest, name); each.data() != nullptr; each = next(rest, name))
    found.push_back(xml_element(*this, each));
  return found;
}

GONIO_INLINE xml_element xml_element::first(std::string_view name) const {
  std::string_view rest = content_;
  const std::string_view found = next(rest, name);
  if (found.data() == nullptr) position(content_).refuse({"there is no element <", name, "> here"});
  return {*this, found};
}

GONIO_INLINE std::string_view xml_element::text(std::string_view name) const {
  std::string_view rest = content_;
  std::string_view found = next(rest, name);
  while (!found.empty() && found.front() == '\n') found.remove_prefix(1);
  return trimmed(found.substr(0, found.find('\n')));
}

}  // namespace gonio::io::detail
