#pragma once
/// Finds elements of XML texts by name, for the files of a few programs: no attributes, entities or tree of elements.
/// ```
/// const xml_element file(text, name);
/// for (const xml_element& layer : file.all("Layer")) use(layer.text("Name"));
/// ```

#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// An element of an XML text: its content and its position. An element must not contain one of its own name.
class xml_element {
 public:
  /// The whole file as one element.
  xml_element(std::string_view file, const std::string& name) : file_(file), content_(file), name_(name) {}

  /// Returns the elements of this name inside this element, in order.
  [[nodiscard]] std::vector<xml_element> all(std::string_view name) const;
  /// Returns the first element of this name inside this element. Throws gonio::error if there is none.
  [[nodiscard]] xml_element first(std::string_view name) const;
  /// Returns the first line, trimmed, of the first element of this name; empty if there is none.
  [[nodiscard]] std::string_view text(std::string_view name) const;
  /// Returns the text between this element's tags.
  [[nodiscard]] std::string_view content() const noexcept { return content_; }
  /// Returns the position of a part of the file.
  [[nodiscard]] text_position position(std::string_view part) const {
    return {name_, 1 + static_cast<std::size_t>(std::count(file_.data(), part.data(), '\n'))};
  }

 private:
  xml_element(const xml_element& in, std::string_view content) : file_(in.file_), content_(content), name_(in.name_) {}
  [[nodiscard]] std::string_view next(std::string_view& rest, std::string_view name) const;

  std::string_view file_, content_;
  std::string name_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/xml_element.ipp>
#endif
