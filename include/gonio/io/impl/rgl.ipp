#pragma once
/// Bodies of io/rgl.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/byte_stream.hpp>
#include <gonio/io/rgl.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

inline constexpr std::string_view tensor_magic{"tensor_file\0", 12};
inline constexpr std::uint8_t tensor_float32 = 10;
/// Bytes of an element by the code of its type: nothing, eight kinds of integers, then float16, float32 and float64.
inline constexpr std::array<std::uint64_t, 12> tensor_element_size{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

/// Bytes of an array, or more than `most` if that is exceeded.
[[nodiscard]] inline std::uint64_t tensor_size(const tensor_field& field, std::uint64_t most) {
  std::uint64_t size = tensor_element_size[field.type];
  for (const std::uint64_t extent : field.shape) {
    if (extent != 0 && size > most / extent) return most + 1;
    size *= extent;
  }
  return size;
}

GONIO_INLINE std::map<std::string, tensor_field> tensor_fields(std::span<const std::byte> bytes,
                                                               const std::string& name) {
  byte_reader reader(bytes, name);
  const auto magic = reader.take_bytes(std::min(tensor_magic.size(), bytes.size()));
  if (!std::ranges::equal(magic, std::as_bytes(std::span(tensor_magic))))
    refuse({name, ": does not start with 'tensor_file', expected a .bsdf file of the RGL database"});
  const auto major = reader.take<std::uint8_t>(), minor = reader.take<std::uint8_t>();
  if (major != 1 || minor != 0) refuse({name, ": has version ", int{major}, ".", int{minor}, ", expected 1.0"});
  std::map<std::string, tensor_field> fields;
  for (auto left = reader.take<std::uint32_t>(); left > 0; --left) {
    const auto letters = reader.take_all<char>(reader.take<std::uint16_t>());
    const std::string field_name(letters.begin(), letters.end());
    tensor_field field;
    const auto dimensions = reader.take<std::uint16_t>();
    field.type = reader.take<std::uint8_t>();
    const auto position = reader.take<std::uint64_t>();
    field.shape = reader.take_all<std::uint64_t>(dimensions);
    if (field.type == 0 || field.type >= tensor_element_size.size())
      refuse({name, ": the array '", field_name, "' has elements of the unknown type ", int{field.type}});
    const std::uint64_t size = tensor_size(field, bytes.size());
    if (position > bytes.size() || size > bytes.size() - position)
      refuse({name, ": the array '", field_name, "' does not lie within the ", bytes.size(), " bytes of the file"});
    field.elements = bytes.subspan(position, size);
    if (!fields.emplace(field_name, std::move(field)).second)
      refuse({name, ": the array '", field_name, "' appears twice"});
  }
  return fields;
}

/// What a material's file holds, asked for by name.
class rgl_arrays {
 public:
  rgl_arrays(std::span<const std::byte> bytes, const std::string& name)
      : fields_(tensor_fields(bytes, name)), name_(name) {}

  [[nodiscard]] bool has(const std::string& field) const { return fields_.contains(field); }

  /// The shape of an array of this many dimensions.
  [[nodiscard]] const std::vector<std::uint64_t>& shape(const std::string& field, std::size_t dimensions) const {
    const tensor_field& found = array(field);
    if (found.shape.size() != dimensions)
      refuse({name_, ": the array '", field, "' has ", found.shape.size(), " dimensions, expected ", dimensions});
    return found.shape;
  }

  /// An array of bytes as text.
  [[nodiscard]] std::string text(const std::string& field) const {
    const std::span<const std::byte> letters = array(field).elements;
    return {reinterpret_cast<const char*>(letters.data()), letters.size()};
  }

  [[nodiscard]] std::vector<float> numbers(const std::string& field) const {
    const tensor_field& found = array(field);
    if (found.type != tensor_float32) refuse({name_, ": the array '", field, "' does not hold float32 numbers"});
    return byte_reader(found.elements, name_).take_all<float>(found.elements.size() / sizeof(float));
  }

  /// The last two dimensions of an array as tables; of an array over the azimuths of the light, of which an isotropic
  /// material may have two, the tables of the first.
  [[nodiscard]] model::unit_square_tables tables(const std::string& field, std::size_t dimensions) const {
    const std::vector<std::uint64_t>& extents = shape(field, dimensions);
    std::vector<float> values = numbers(field);
    std::size_t count = 1;
    for (std::size_t i = 1; i + 2 < dimensions; ++i) count *= extents[i];
    const std::size_t rows = extents[dimensions - 2], columns = extents[dimensions - 1];
    if (dimensions > 2) {
      if (extents[0] == 0) refuse({name_, ": the array '", field, "' is empty"});
      values.resize(values.size() / extents[0]);
    }
    return {static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns),
            std::move(values)};
  }

 private:
  [[nodiscard]] const tensor_field& array(const std::string& field) const {
    const auto found = fields_.find(field);
    if (found == fields_.end()) refuse({name_, ": has no array '", field, "'"});
    return found->second;
  }

  std::map<std::string, tensor_field> fields_;
  const std::string& name_;
};

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE rgl_material parse_rgl(std::span<const std::byte> bytes, const std::string& name) {
  const detail::rgl_arrays arrays(bytes, name);
  if (!arrays.has("rgb") && arrays.has("spectra"))
    gonio::refuse({name, ": holds spectra, expected a file of the RGB variant, with an array 'rgb'"});
  if (const std::size_t azimuths = arrays.numbers("phi_i").size(); azimuths > 2)
    gonio::refuse({name, ": is anisotropic (", azimuths, " azimuths of the light), expected an isotropic material"});
  const std::vector<float> theta_i = arrays.numbers("theta_i");
  std::string description;
  if (arrays.has("description")) description = arrays.text("description");
  try {
    // A float's pi/2 may be larger than a double's.
    std::vector<double> angles(theta_i.begin(), theta_i.end());
    for (double& angle : angles)
      if (angle > 0.5 * std::numbers::pi && angle < 0.5 * std::numbers::pi + 1e-6) angle = 0.5 * std::numbers::pi;
    return {model::adaptive_brdf({std::move(angles), arrays.tables("ndf", 2), arrays.tables("sigma", 2),
                                  arrays.tables("vndf", 4), arrays.tables("rgb", 5)}),
            std::move(description)};
  } catch (const error& why) {
    const std::string what = why.what();
    gonio::refuse({what.starts_with(name) ? "" : name + ": ", what});
  }
}

GONIO_INLINE std::vector<named_file> list_rgl_directory(const std::filesystem::path& folder) {
  static constexpr std::array<std::string_view, 1> extensions{".bsdf"};
  return list_named_files(folder, extensions, "material");
}

}  // namespace gonio::io
