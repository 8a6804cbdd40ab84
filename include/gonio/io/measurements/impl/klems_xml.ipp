#pragma once
/// Bodies of io/measurements/klems_xml.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/klems_xml.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/xml_element.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

// ---- bases ---------------------------------------------------------------------------------------------------------

/// A patch's centre. Patches are ordered ring by ring, from azimuth 0.
struct klems_patch {
  double theta, azimuth;  ///< radians
};

inline constexpr std::size_t most_patches = 4096;

[[nodiscard]] GONIO_INLINE double number_of(const xml_element& in, std::string_view name, double lowest,
                                            double highest) {
  const xml_element found = in.first(name);
  const text_position position = found.position(found.content());
  const std::string tag = message_of({"<", name, ">"});
  return require_between(read_number(trimmed(found.content()), position, [&] { return tag; }), tag, lowest, highest,
                         position);
}

[[nodiscard]] GONIO_INLINE std::vector<klems_patch> read_basis(const xml_element& basis) {
  std::vector<klems_patch> patches;
  for (const xml_element& ring : basis.all("AngleBasisBlock")) {
    const double theta = radians(number_of(ring, "Theta", 0.0, 90.0));
    const double count = number_of(ring, "nPhis", 1.0, static_cast<double>(most_patches));
    if (count != std::floor(count) || static_cast<double>(patches.size()) + count > static_cast<double>(most_patches))
      ring.position(ring.content())
          .refuse(
              {"<nPhis>: ", shortest(count), ", expected whole numbers, at most ", most_patches, " patches in all"});
    for (double k = 0.0; k < count; ++k) patches.push_back({theta, 2.0 * std::numbers::pi * k / count});
  }
  if (patches.empty()) basis.position(basis.content()).refuse("the basis has no rings, expected <AngleBasisBlock>");
  return patches;
}

/// Returns the patches of the basis with this name.
[[nodiscard]] GONIO_INLINE std::vector<klems_patch> basis_named(const xml_element& definition, std::string_view name,
                                                                const text_position& position) {
  for (const xml_element& each : definition.all("AngleBasis"))
    if (each.text("AngleBasisName") == name) return read_basis(each);
  position.refuse({"there is no <AngleBasis> with the name ", in_quotes(name)});
}

// ---- matrices ------------------------------------------------------------------------------------------------------

// Finds the word's position only for error messages, because finding it is slow.
GONIO_INLINE double scattering_value(const xml_element& data, std::string_view word) {
  double number = 0.0;
  if (const char* wrong = read_number(word, number))
    data.position(word).refuse({"<ScatteringData>: ", in_quotes(word), wrong});
  if (std::abs(number) > double{std::numeric_limits<float>::max()}) require_float_range(number, data.position(word));
  return number;
}

/// Reads the numbers of a matrix, separated by commas or blanks. Refuses surplus numbers before they are stored.
[[nodiscard]] GONIO_INLINE std::vector<double> read_matrix(const xml_element& data, std::size_t count) {
  constexpr std::string_view between = ", \t\r\n";
  std::vector<double> numbers;
  std::string_view rest = data.content();
  for (std::size_t begin = rest.find_first_not_of(between); begin != std::string_view::npos;
       begin = rest.find_first_not_of(between)) {
    rest.remove_prefix(begin);
    const std::string_view word = rest.substr(0, rest.find_first_of(between));
    const double number = scattering_value(data, word);
    if (numbers.size() == count)
      data.position(word).refuse(
          {"<ScatteringData> has more than ", count, " numbers, expected one for each pair of patches"});
    numbers.push_back(number);
    rest.remove_prefix(word.size());
  }
  if (numbers.size() != count)
    data.position(rest).refuse(
        {"<ScatteringData> has ", numbers.size(), " numbers, expected ", count, ", one for each pair of patches"});
  return numbers;
}

GONIO_INLINE xml_element reflection_of(const xml_element& file, const std::string& name, const window_block& wanted) {
  std::vector<std::string_view> directions;
  if (wanted.of != window_block::side::back) directions.push_back("Reflection Front");
  if (wanted.of != window_block::side::front) directions.push_back("Reflection Back");
  std::string found;
  for (const std::string_view direction : directions)
    for (const xml_element& data : file.all("WavelengthData")) {
      const std::string_view wavelength = data.text("Wavelength");
      for (const xml_element& block : data.all("WavelengthDataBlock")) {
        const std::string_view of_block = block.text("WavelengthDataDirection");
        if (of_block == direction && lower_case(wavelength) == lower_case(wanted.wavelength)) return block;
        if (direction == directions.front() && found.size() < 200)
          found += message_of({found.empty() ? "" : ", ", in_quotes(of_block), " of ", in_quotes(wavelength)});
      }
    }
  gonio::refuse({name, ": has no '", listed(directions, "' or '"), "' of ", in_quotes(wanted.wavelength), ", it has ",
                 found.empty() ? "no matrix" : found});
}

/// Returns the direction of a patch's centre; `turn` is added to the azimuth.
[[nodiscard]] GONIO_INLINE direction centre_of(const klems_patch& patch, double turn) {
  return spherical_direction(patch.theta, patch.azimuth + turn);
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_klems_xml(std::string_view text) {
  return text.find("<WindowElement") != std::string_view::npos;
}

GONIO_INLINE sample_set read_klems_xml(std::string_view text, const std::string& name, const window_block& wanted) {
  const detail::xml_element file(text, name), definition = file.first("DataDefinition");
  const std::string_view structure = definition.text("IncidentDataStructure");
  if (structure != "Columns" && structure != "Rows")
    definition.position(definition.content())
        .refuse({"<IncidentDataStructure> ", in_quotes(structure), " is not supported, expected Columns or Rows"});
  const detail::xml_element block = detail::reflection_of(file, name, wanted), data = block.first("ScatteringData");
  const text_position position = block.position(block.content());
  const auto columns = detail::basis_named(definition, block.text("ColumnAngleBasis"), position);
  const auto rows = detail::basis_named(definition, block.text("RowAngleBasis"), position);
  const std::vector<double> matrix = detail::read_matrix(data, rows.size() * columns.size());
  const bool are_columns_incident = structure == "Columns";
  detail::sample_collector collector;
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const detail::klems_patch &incident = are_columns_incident ? columns[column] : rows[row],
                                &outgoing = are_columns_incident ? rows[row] : columns[column];
      const double value = matrix[row * columns.size() + column];
      collector.add({detail::centre_of(incident, std::numbers::pi), detail::centre_of(outgoing, 0.0)}, {&value, 1});
    }
  return std::move(collector).samples(name);
}

GONIO_INLINE sample_set read_klems_xml(const std::filesystem::path& path, const window_block& wanted) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_klems_xml(as_text(bytes), path.string(), wanted);
}

}  // namespace gonio::io
