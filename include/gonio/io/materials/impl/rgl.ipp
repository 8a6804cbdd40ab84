#pragma once
/// Bodies of io/materials/rgl.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/interpolated_colour.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/table/channels.hpp>

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
inline constexpr std::uint8_t tensor_uint8 = 1, tensor_float32 = 10;
/// Bytes of an element for each type code: nothing, eight kinds of integers, then float16, float32 and float64.
inline constexpr std::array<std::uint64_t, 12> tensor_element_size{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

/// Returns the size of an array in bytes, or a number above `most` if the size exceeds `most`.
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
  const auto magic = reader.read_bytes(std::min(tensor_magic.size(), bytes.size()));
  if (!std::ranges::equal(magic, std::as_bytes(std::span(tensor_magic))))
    refuse({name, ": does not start with 'tensor_file', expected a .bsdf file of the RGL database"});
  const auto major = reader.read<std::uint8_t>(), minor = reader.read<std::uint8_t>();
  if (major != 1 || minor != 0) refuse({name, ": has version ", int{major}, ".", int{minor}, ", expected 1.0"});
  std::map<std::string, tensor_field> fields;
  for (auto left = reader.read<std::uint32_t>(); left > 0; --left) {
    const auto letters = reader.read_all<char>(reader.read<std::uint16_t>());
    const std::string field_name(letters.begin(), letters.end());
    tensor_field field;
    const auto dimensions = reader.read<std::uint16_t>();
    field.type = reader.read<std::uint8_t>();
    const auto position = reader.read<std::uint64_t>();
    field.shape = reader.read_all<std::uint64_t>(dimensions);
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

/// The arrays of a material's file by name.
class rgl_arrays {
 public:
  rgl_arrays(std::span<const std::byte> bytes, const std::string& name)
      : fields_(tensor_fields(bytes, name)), name_(name) {}

  [[nodiscard]] bool has(const std::string& field) const { return fields_.contains(field); }

  /// Returns the shape of an array; refuses another number of dimensions.
  [[nodiscard]] const std::vector<std::uint64_t>& shape(const std::string& field, std::size_t dimensions) const {
    const tensor_field& found = array(field);
    if (found.shape.size() != dimensions)
      refuse({name_, ": the array '", field, "' has ", found.shape.size(), " dimensions, expected ", dimensions});
    return found.shape;
  }

  /// Returns an array of bytes as text.
  [[nodiscard]] std::string text(const std::string& field) const {
    const std::span<const std::byte> letters = array(field).elements;
    return {reinterpret_cast<const char*>(letters.data()), letters.size()};
  }

  [[nodiscard]] std::vector<float> numbers(const std::string& field) const {
    const tensor_field& found = array(field);
    if (found.type != tensor_float32) refuse({name_, ": the array '", field, "' does not hold float32 numbers"});
    return byte_reader(found.elements, name_).read_all<float>(found.elements.size() / sizeof(float));
  }

  /// Returns an array as tables of its last two dimensions. If it has more than two dimensions, the first is the
  /// light's azimuth. An isotropic material may have two azimuths; only the tables of the first azimuth are returned.
  [[nodiscard]] model::unit_square_tables tables(const std::string& field, std::size_t dimensions) const {
    const std::vector<std::uint64_t>& extents = shape(field, dimensions);
    std::vector<float> values = numbers(field);
    std::size_t count = 1;
    for (std::size_t i = 1; i + 2 < dimensions; ++i) count *= extents[i];
    const std::size_t rows = extents[dimensions - 2], columns = extents[dimensions - 1];
    if (dimensions > 2) {
      if (extents[0] == 0) refuse({name_, ": the array '", field, "' is empty"});
      const std::vector<float> azimuths = numbers("phi_i");
      if (azimuths.size() > most_isotropic && extents[0] != azimuths.size())
        refuse({name_, ": the array '", field, "' has ", extents[0], " azimuths of the light, but phi_i has ",
                azimuths.size()});
      if (azimuths.size() > most_isotropic)
        count *= extents[0];
      else
        values.resize(values.size() / extents[0]);
    }
    return {static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns),
            std::move(values)};
  }

  /// Returns the azimuths of the light in radians; none for an isotropic material.
  [[nodiscard]] std::vector<double> azimuths() const {
    const std::vector<float> all = numbers("phi_i");
    if (all.size() <= most_isotropic) return {};
    return {all.begin(), all.end()};
  }

 private:
  /// An isotropic material may have the tables of this many azimuths of the light, which are alike.
  static constexpr std::size_t most_isotropic = 2;

  [[nodiscard]] const tensor_field& array(const std::string& field) const {
    const auto found = fields_.find(field);
    if (found == fields_.end()) refuse({name_, ": has no array '", field, "'"});
    return found->second;
  }

  std::map<std::string, tensor_field> fields_;
  const std::string& name_;
};

/// Returns red, green and blue of spectra: black if no wavelength is visible.
[[nodiscard]] inline model::unit_square_tables rgb_of(const rgl_spectra& spectra) {
  const bool is_seen = std::ranges::any_of(spectra.wavelengths, is_visible);
  const Eigen::MatrixXd weights =
      is_seen ? interpolated_colour(spectra.wavelengths) : Eigen::MatrixXd::Zero(3, std::ssize(spectra.wavelengths));
  const model::unit_square_tables& all = spectra.values;
  const Eigen::Index size = all.rows * all.columns, bands = weights.cols(), angles = all.tables / bands;
  model::unit_square_tables colours{3 * angles, all.rows, all.columns, std::vector<float>(3 * angles * size)};
  for (Eigen::Index angle = 0; angle < angles; ++angle)
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index i = 0; i < size; ++i) {
        double sum = 0.0;
        for (Eigen::Index band = 0; band < bands; ++band)
          sum += weights(c, band) * double{all.values[(angle * bands + band) * size + i]};
        colours.values[(3 * angle + c) * size + i] = static_cast<float>(sum);
      }
  return colours;
}

/// Throws gonio::error unless there is a table for each wavelength and each direction of the light.
inline void require_spectra(const rgl_spectra& spectra, Eigen::Index angles) {
  const model::unit_square_tables& all = spectra.values;
  const Eigen::Index tables = std::ssize(spectra.wavelengths) * angles;
  if (all.rows < 2 || all.columns < 2)
    refuse({"the spectra need tables of at least 2 x 2 numbers, not ", all.rows, " x ", all.columns});
  if (all.tables != tables || std::ssize(all.values) != tables * all.rows * all.columns)
    refuse({"the spectra need ", tables, " tables, for ", spectra.wavelengths.size(), " wavelengths and ", angles,
            " angles, not ", all.tables});
}

[[nodiscard]] inline rgl_spectra read_spectra(const rgl_arrays& arrays, Eigen::Index angles) {
  const std::vector<float> wavelengths = arrays.numbers("wavelengths");
  rgl_spectra spectra{{wavelengths.begin(), wavelengths.end()}, arrays.tables("spectra", 5)};
  require_spectra(spectra, angles);
  return spectra;
}

/// The arrays of a container to write. Keeps views of them, because spectra take hundreds of megabytes.
class tensor_writer {
 public:
  using extents = std::vector<std::uint64_t>;

  void add(const std::string& name, const extents& shape, std::span<const std::byte> elements, std::uint8_t type) {
    fields_.push_back({name, type, shape, elements});
  }
  void add(const std::string& name, const extents& shape, std::vector<float>&&) = delete;
  void add(const std::string& name, const extents& shape, const std::vector<float>& numbers) {
    add(name, shape, std::as_bytes(std::span(numbers)), tensor_float32);
  }
  /// Adds tables: their rows and columns are the last two dimensions.
  void add(const std::string& name, extents shape, const model::unit_square_tables& tables) {
    shape.push_back(static_cast<std::uint64_t>(tables.rows));
    shape.push_back(static_cast<std::uint64_t>(tables.columns));
    add(name, shape, tables.values);
  }

  /// Calls `write(bytes)` for each part of the file in order.
  template <class Write>
  void write_parts(Write&& write) const {
    write(std::span<const std::byte>(head()));
    for (const field& each : fields_) write(each.elements);
  }

 private:
  [[nodiscard]] std::vector<std::byte> head() const {
    std::uint64_t position = tensor_magic.size() + 2 + sizeof(std::uint32_t);
    for (const field& each : fields_) position += 13 + each.name.size() + 8 * each.shape.size();
    byte_writer writer;
    writer.write_bytes(tensor_magic.data(), tensor_magic.size());
    writer.write(std::uint8_t{1});
    writer.write(std::uint8_t{0});
    writer.write(static_cast<std::uint32_t>(fields_.size()));
    for (const field& each : fields_) {
      writer.write(static_cast<std::uint16_t>(each.name.size()));
      writer.write_bytes(each.name.data(), each.name.size());
      writer.write(static_cast<std::uint16_t>(each.shape.size()));
      writer.write(each.type);
      writer.write(position);
      writer.write_all(std::span(each.shape));
      position += each.elements.size();
    }
    return std::move(writer).bytes();
  }

  struct field {
    std::string name;
    std::uint8_t type = 0;
    extents shape;
    std::span<const std::byte> elements;
  };

  std::vector<field> fields_;
};

/// Returns the luminance of the values, by which renderers sample directions. It is at least 0.001 of the mean, so that
/// every direction can be sampled.
[[nodiscard]] inline std::vector<float> luminances(const model::unit_square_tables& colours) {
  constexpr double least_share = 1e-3;
  const Eigen::Index size = colours.rows * colours.columns, angles = colours.tables / 3;
  std::vector<float> all(angles * size);
  for (Eigen::Index angle = 0; angle < angles; ++angle) {
    const float* red = colours.row(3 * angle, 0);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const rgb value(red[i], red[size + i], red[2 * size + i]);
      const double bright = std::max(luminance(value), 0.0);
      all[angle * size + i] = static_cast<float>(bright);
      sum += bright;
    }
    const double mean = sum > 0.0 ? sum / static_cast<double>(size) : 1.0;
    const auto least = static_cast<float>(least_share * mean);
    for (Eigen::Index i = 0; i < size; ++i) all[angle * size + i] = std::max(all[angle * size + i], least);
  }
  return all;
}

/// Calls `write(bytes)` for each part of the file in order.
template <class Write>
void write_rgl_parts(const rgl_material& material, Write&& write) {
  const model::adaptive_brdf_parts& parts = material.material.parts();
  const model::unit_square_tables& values = material.spectra ? material.spectra->values : parts.reflectance;
  if (material.spectra) require_spectra(*material.spectra, parts.lights());
  if (values.rows != values.columns || values.rows != parts.reflectance.rows)
    gonio::refuse({"a .bsdf file needs square tables of reflectance, not ", values.rows, " x ", values.columns});
  const auto size = static_cast<std::uint64_t>(values.rows), angles = static_cast<std::uint64_t>(parts.theta_i.size()),
             azimuths = std::max<std::uint64_t>(parts.phi_i.size(), 1);
  const std::string description = material.description.empty() ? "gonio" : material.description;
  std::vector<float> phi_i(parts.phi_i.begin(), parts.phi_i.end());
  if (phi_i.empty()) phi_i.push_back(0.0f);
  const std::vector<float> theta_i(parts.theta_i.begin(), parts.theta_i.end()),
      luminance = luminances(parts.reflectance);
  std::vector<float> wavelengths;
  if (material.spectra) wavelengths.assign(material.spectra->wavelengths.begin(), material.spectra->wavelengths.end());
  tensor_writer file;
  file.add("description", {description.size()}, std::as_bytes(std::span(description)), tensor_uint8);
  file.add("phi_i", {azimuths}, phi_i);
  file.add("theta_i", {angles}, theta_i);
  file.add("sigma", {}, parts.projected_area);
  file.add("ndf", {}, parts.normals);
  file.add("vndf", {azimuths, angles}, parts.visible_normals);
  file.add("luminance", {azimuths, angles, size, size}, luminance);
  if (material.spectra) file.add("wavelengths", {wavelengths.size()}, wavelengths);
  const auto channels = static_cast<std::uint64_t>(values.tables) / (azimuths * angles);
  file.add(material.spectra ? "spectra" : "rgb", {azimuths, angles, channels}, values);
  file.add("jacobian", {1}, std::as_bytes(std::span("\1", 1)), tensor_uint8);
  file.write_parts(std::forward<Write>(write));
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE model::adaptive_brdf colours_of(rgl_material material, const std::string& name) {
  if (material.spectra) require_colour(channels(material.spectra->wavelengths), name);
  return std::move(material.material);
}

GONIO_INLINE rgl_spectra upsampled_spectra(const model::adaptive_brdf& material, const model::smooth_spectra& spectra) {
  const model::unit_square_tables& colours = material.parts().reflectance;
  const Eigen::Index size = colours.rows * colours.columns, bands = std::ssize(spectra.wavelengths());
  const Eigen::Index angles = colours.tables / 3;
  rgl_spectra all{spectra.wavelengths(),
                  {bands * angles, colours.rows, colours.columns, std::vector<float>(bands * angles * size)}};
  for (Eigen::Index angle = 0; angle < angles; ++angle) {
    const float* red = colours.row(3 * angle, 0);
    float* first = all.values.values.data() + angle * bands * size;
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::ArrayXd values = spectra({red[i], red[size + i], red[2 * size + i]});
      for (Eigen::Index band = 0; band < bands; ++band) first[band * size + i] = static_cast<float>(values[band]);
    }
  }
  return all;
}

GONIO_INLINE std::vector<std::byte> write_rgl(const rgl_material& material) {
  std::vector<std::byte> all;
  detail::write_rgl_parts(material,
                          [&](std::span<const std::byte> part) { all.insert(all.end(), part.begin(), part.end()); });
  return all;
}

GONIO_INLINE void write_rgl(const std::filesystem::path& path, const rgl_material& material) {
  write_atomically(path, [&](file_writer& file) {
    detail::write_rgl_parts(material, [&](std::span<const std::byte> part) { file.write(part); });
  });
}

GONIO_INLINE rgl_material read_rgl(std::span<const std::byte> bytes, const std::string& name) {
  const detail::rgl_arrays arrays(bytes, name);
  const std::vector<float> theta_i = arrays.numbers("theta_i");
  std::string description;
  if (arrays.has("description")) description = arrays.text("description");
  // If `jacobian` is 0, the file holds plain values, which are not relative to the distribution of normals.
  if (arrays.has("jacobian") && arrays.text("jacobian") != std::string("\1"))
    gonio::refuse(
        {name, ": the array 'jacobian' is not 1: the values must be relative to the distribution of normals"});
  try {
    // pi/2 as a float may be larger than as a double.
    std::vector<double> angles(theta_i.begin(), theta_i.end());
    for (double& angle : angles)
      if (angle > 0.5 * std::numbers::pi && angle < 0.5 * std::numbers::pi + 1e-6) angle = 0.5 * std::numbers::pi;
    std::vector<double> azimuths = arrays.azimuths();
    const auto lights = static_cast<Eigen::Index>(angles.size() * std::max<std::size_t>(azimuths.size(), 1));
    std::optional<rgl_spectra> spectra;
    if (!arrays.has("rgb") && arrays.has("spectra")) spectra = detail::read_spectra(arrays, lights);
    model::unit_square_tables colours = spectra ? detail::rgb_of(*spectra) : arrays.tables("rgb", 5);
    return {model::adaptive_brdf({std::move(angles), arrays.tables("ndf", 2), arrays.tables("sigma", 2),
                                  arrays.tables("vndf", 4), std::move(colours), std::move(azimuths)}),
            std::move(description), std::move(spectra)};
  } catch (const error& why) {
    const std::string what = why.what();
    gonio::refuse({what.starts_with(name) ? "" : name + ": ", what});
  }
}

GONIO_INLINE std::vector<named_file> list_rgl_directory(const std::filesystem::path& folder) {
  static constexpr std::array<std::string_view, 1> extensions{".bsdf"};
  return list_named_files(folder, extensions, "material of the RGL database");
}

}  // namespace gonio::io
