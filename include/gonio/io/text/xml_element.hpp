#pragma once
/// Elements of XML texts by name, for the files of a few programs: no attributes, no entities, no tree of elements.
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

/// An element of an XML text: its content and its position. Elements contain no others of the same name, except the
/// bases of the matrices, which are read through their own elements.
class xml_element {
 public:
  /// The whole file as one element.
  xml_element(std::string_view file, const std::string& name) : file_(file), content_(file), name_(name) {}

  /// Returns the elements of this name inside it, in order.
  [[nodiscard]] std::vector<xml_element> all(std::string_view name) const;
  /// Returns the first of these. Throws gonio::error if there is none.
  [[nodiscard]] xml_element first(std::string_view name) const;
  /// Returns the trimmed text of the first of these; empty if there is none.
  [[nodiscard]] std::string_view text(std::string_view name) const;
  /// Returns the text between its tags.
  [[nodiscard]] std::string_view content() const noexcept { return content_; }
  /// Returns the position of a part of the file.
  [[nodiscard]] text_place place(std::string_view part) const {
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
