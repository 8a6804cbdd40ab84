#pragma once
/// Bodies of io/measurements/openmaterial.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/openmaterial.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/json_reader.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/model/smooth_spectra.hpp>
#include <gonio/table/aperture.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

// ---- writing

inline constexpr std::string_view openmaterial_meaning =
    "Values are the BRDF in 1/sr, without the cosine of any angle. Azimuth 0 is the side of the light, pi the "
    "mirror direction. Spectra are smooth and match linear Rec. 709 colours under D65.";

/// Returns the angle of a node, rounded down to the six decimals of the schema's limits.
[[nodiscard]] inline double openmaterial_angle(Eigen::Index node, Eigen::Index steps, double full) {
  constexpr double millionths = 1e6;
  return std::floor(full * static_cast<double>(node) / static_cast<double>(steps) * millionths + 1e-3) / millionths;
}

/// Calls `use(theta_i, theta_o, phi)` for each row of a wavelength.
template <class Use>
void for_each_openmaterial_row(const openmaterial_steps& steps, Use&& use) {
  constexpr double pi = std::numbers::pi;
  for (Eigen::Index i = 0; i <= steps.polar; ++i)
    for (Eigen::Index o = 0; o <= steps.polar; ++o)
      for (Eigen::Index phi = 0; phi <= steps.azimuth; ++phi)
        use(openmaterial_angle(i, steps.polar, 0.5 * pi), openmaterial_angle(o, steps.polar, 0.5 * pi),
            openmaterial_angle(phi, steps.azimuth, 2.0 * pi));
}

GONIO_INLINE std::vector<direction_pair> openmaterial_directions(const openmaterial_steps& steps) {
  if (steps.polar < 1 || steps.polar > 60 || steps.azimuth < 1 || steps.azimuth > 120)
    refuse({"an OpenMATERIAL table needs 1 to 60 steps of the zenith and 1 to 120 of the azimuth, not ", steps.polar,
            " and ", steps.azimuth});
  std::vector<direction_pair> pairs;
  for_each_openmaterial_row(steps, [&](double theta_i, double theta_o, double phi) {
    pairs.push_back({spherical_direction(theta_i, 0.0), spherical_direction(theta_o, phi)});
  });
  return pairs;
}

/// Appends a float in the fewest digits.
inline void append_float(std::string& text, float value) {
  std::array<char, 32> digits{};
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

/// Returns a text in JSON's quotes.
[[nodiscard]] inline std::string json_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + '"';
}

/// Returns 128 bits derived from the name and the numbers (RFC 9562, version 8), so that equal tables have equal ids.
[[nodiscard]] inline std::string openmaterial_uuid(std::string_view name, std::span<const float> values) {
  constexpr std::uint64_t prime = 0x100000001b3;  // FNV-1a
  std::array<std::uint64_t, 2> hash{0xcbf29ce484222325, 0x84222325cbf29ce4};
  const auto add = [&](std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes)
      for (std::uint64_t& half : hash) half = (half ^ std::to_integer<std::uint64_t>(byte)) * prime;
  };
  add(std::as_bytes(std::span(name)));
  add(std::as_bytes(values));
  hash[0] = (hash[0] & ~std::uint64_t{0xF000}) | 0x8000;
  hash[1] = (hash[1] & ~(std::uint64_t{3} << 62)) | (std::uint64_t{2} << 62);
  std::string text;
  for (int digit = 0; digit < 32; ++digit) {
    if (digit == 8 || digit == 12 || digit == 16 || digit == 20) text += '-';
    text += "0123456789abcdef"[hash[digit / 16] >> (60 - digit % 16 * 4) & 15];
  }
  return text;
}

[[nodiscard]] inline std::string openmaterial_head(const openmaterial_metadata& metadata, std::string_view uuid) {
  std::string text = "{\n  \"metadata\": {\n";
  const auto entry = [&](std::string_view key, std::string_view value, bool is_list = false) {
    text += message_of({"    \"", key, "\": ", is_list ? "[" : "", json_quoted(value), is_list ? "]" : "", ",\n"});
  };
  entry("name", metadata.name);
  entry("description",
        message_of({metadata.description, metadata.description.empty() ? "" : " ", openmaterial_meaning}));
  entry("uuid", uuid);
  entry("materialVersion", "1.0.0");
  entry("openMaterial3dVersion", "1.0.0");
  entry("copyrights", metadata.copyright, true);
  entry("license", metadata.license);
  entry("authors", metadata.author, true);
  entry("sources", metadata.sources);
  return text + "    \"typicalSensorTechnology\": \"camera\"\n  },\n";
}

GONIO_INLINE std::string openmaterial_text(const std::vector<rgb>& colours, const openmaterial_steps& steps,
                                           const openmaterial_metadata& metadata) {
  const model::smooth_spectra spectra;
  const std::vector<double>& nanometres = spectra.wavelengths();
  const Eigen::Index rows = std::ssize(colours), bands = std::ssize(nanometres);
  std::vector<float> values(rows * bands);
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (!colours[row].allFinite()) refuse({"row ", row, " of an OpenMATERIAL table is not finite"});
    const Eigen::ArrayXd spectrum = spectra(colours[row]).max(0.0);
    for (Eigen::Index band = 0; band < bands; ++band) values[band * rows + row] = static_cast<float>(spectrum[band]);
  }
  std::vector<std::string> angles;
  for_each_openmaterial_row(steps, [&](double theta_i, double theta_o, double phi) {
    angles.push_back(message_of({", ", shortest(theta_i), ", ", shortest(theta_o), ", ", shortest(phi), ", "}));
  });
  std::string text = openmaterial_head(metadata, openmaterial_uuid(metadata.name, values));
  text += "  \"brdf\": {\n    \"wavelengths\": [";
  std::vector<std::string> metres;
  for (const double wavelength : nanometres) {
    metres.push_back(message_of({shortest(wavelength), "e-9"}));
    text += message_of({metres.size() == 1 ? "" : ", ", metres.back()});
  }
  text += "],\n    \"lookupTable\": [\n";
  for (Eigen::Index band = 0; band < bands; ++band)
    for (Eigen::Index row = 0; row < rows; ++row) {
      text += message_of({"      [", metres[band], angles[row]});
      append_float(text, values[band * rows + row]);
      text += band + 1 == bands && row + 1 == rows ? "]\n" : "],\n";
    }
  return text + "    ]\n  }\n}\n";
}

// ---- reading

/// Reads a file row by row.
class openmaterial_reader {
 public:
  openmaterial_reader(std::string_view text, text_position& position) : json_(text, position), position_(position) {}

  [[nodiscard]] sample_collector read() {
    json_.open_object("the file");
    while (const auto key = json_.next_key()) {
      if (*key == "brdf")
        read_brdf();
      else
        json_.skip();
    }
    json_.finish();
    if (!has_table_) gonio::refuse({position_.name, ": there is no brdf.lookupTable, expected a table of reflectance"});
    return samples();
  }

 private:
  /// Theta_i, theta_o, phi, wavelength in nanometres, value. The file has the wavelength, in metres, first.
  using row = std::array<double, 5>;

  void read_brdf() {
    json_.open_object("brdf");
    while (const auto key = json_.next_key()) {
      if (*key == "receiverSolidAngles") {
        read_solid_angles();
        continue;
      }
      if (*key != "lookupTable") {
        json_.skip();
        continue;
      }
      if (std::exchange(has_table_, true)) json_.refuse({"brdf.lookupTable appears twice"});
      json_.open_array("brdf.lookupTable");
      while (json_.next_element())
        if (const std::optional<row> values = read_row()) rows_.push_back(checked(*values));
    }
  }

  /// Reads one solid angle for each wavelength and averages them, since a sample has one receiver.
  void read_solid_angles() {
    double sum = 0.0, count = 0.0;
    json_.open_array("brdf.receiverSolidAngles");
    while (json_.next_element()) {
      json_.open_object("a receiver's solid angle");
      while (const auto key = json_.next_key()) {
        if (*key == "solidAngle") {
          sum += json_.read_number("solidAngle");
          count += 1.0;
        } else {
          json_.skip();
        }
      }
    }
    if (count > 0.0) receiver_.receiver = receiver_half_angle(sum / count, json_);
  }

  /// Returns nothing if one of the numbers is null.
  [[nodiscard]] std::optional<row> read_row() {
    row values{};
    std::size_t count = 0;
    bool has_null = false;
    json_.open_array("a row");
    for (; json_.next_element(); ++count) {
      if (count == values.size()) json_.refuse({"a row has more than 5 numbers"});
      if (json_.peek() == 'n') {
        json_.skip();
        has_null = true;
      } else {
        values[count] = json_.read_number("a row");
      }
    }
    if (count != values.size()) json_.refuse({"a row has ", count, " numbers, expected 5"});
    if (has_null) return std::nullopt;
    return values;
  }

  [[nodiscard]] row checked(const row& values) const {
    const auto [wavelength, theta_i, theta_o, phi, value] = values;
    require("wavelength in metres", wavelength, 1e-9, 17.16e-3);
    // Accept pi / 2 and 2 pi rounded up to four decimals.
    require("zenith angle of the light in rad", theta_i, 0.0, 1.5708);
    require("zenith angle of the viewer in rad", theta_o, 0.0, 1.5708);
    require("azimuth in rad", phi, 0.0, 6.2832);
    if (std::abs(value) > double{std::numeric_limits<float>::max()})
      json_.refuse({shortest(value), " sr^-1 is outside the range of float"});
    // Rows of equal directions must have equal azimuths: use 0 for any azimuth at the normal and for a whole turn.
    const bool is_none = theta_i == 0.0 || theta_o == 0.0 || phi >= 6.28318;
    return {theta_i, theta_o, is_none ? 0.0 : phi, 1e9 * wavelength, value};
  }

  void require(std::string_view what, double value, double least, double most) const {
    if (!(value >= least && value <= most))
      json_.refuse({"a ", what, " of ", shortest(value), ", expected ", shortest(least), " to ", shortest(most)});
  }

  [[nodiscard]] sample_collector samples() {
    std::ranges::sort(rows_);
    const auto have_same = [](const row& one, const row& other, std::size_t numbers) {
      return std::equal(one.begin(), one.begin() + static_cast<std::ptrdiff_t>(numbers), other.begin());
    };
    sample_collector collector;
    collector.use_aperture(receiver_);
    std::vector<double> wavelengths, values;
    for (std::size_t i = 0; i < rows_.size();) {
      const row first = rows_[i];
      wavelengths.clear();
      values.clear();
      while (i < rows_.size() && have_same(rows_[i], first, 3)) {
        const row& at = rows_[i];
        double sum = 0.0, count = 0.0;
        for (; i < rows_.size() && have_same(rows_[i], at, 4); ++i, count += 1.0) sum += rows_[i][4];
        wavelengths.push_back(at[3]);
        values.push_back(sum / count);
      }
      collector.use_wavelengths(wavelengths);
      collector.add({spherical_direction(first[0], 0.0), spherical_direction(first[1], first[2])}, values);
    }
    return collector;
  }

  json_reader json_;
  const text_position& position_;
  bool has_table_ = false;
  aperture receiver_;
  std::vector<row> rows_;
};

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE void write_openmaterial(const std::filesystem::path& path, const std::string& text) {
  if (!path.filename().string().ends_with("_brdf.xompt"))
    gonio::refuse({path.string(), ": an OpenMATERIAL table needs a name that ends in _brdf.xompt"});
  write_atomically(path, std::as_bytes(std::span(text)));
}

GONIO_INLINE bool looks_like_openmaterial(std::string_view text) {
  text = without_byte_order_mark(text);
  const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  if (!text.substr(first).starts_with('{')) return false;
  const auto has = [&](std::string_view key) { return text.find(key) != std::string_view::npos; };
  return has("\"openMaterial3dVersion\"") || has("\"lookupTable\"");
}

GONIO_INLINE sample_set read_openmaterial(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  return detail::openmaterial_reader(text, position).read().samples(name);
}

GONIO_INLINE sample_set read_openmaterial(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_openmaterial(as_text(bytes), path.string());
}

}  // namespace gonio::io
