#pragma once
/// Bodies of io/measurements/fred_bsdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/fred_bsdf.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Throws gonio::error unless a line `format` states degrees and plain values.
GONIO_INLINE void check_fred_format(std::string_view line, const text_position& position) {
  std::vector<std::string_view> words;
  split_at_blanks(line, words);
  const std::vector<std::string_view> expected{"format", "angles=deg", "bsdf=value", "scale=1"};
  if (words != expected)
    position.refuse({in_quotes(line), " is not supported, expected '", listed(expected, " "), "'"});
}

/// Reads a direction from polar angle and azimuth in degrees; `turn` is added to the azimuth.
[[nodiscard]] GONIO_INLINE direction fred_direction(std::string_view theta, std::string_view phi, double turn,
                                                    const text_position& position) {
  const double polar = read_number(theta, position, [] { return "a polar angle"; }),
               azimuth = read_number(phi, position, [] { return "an azimuth"; });
  if (!(std::abs(polar) <= 90.0))
    position.refuse({"a polar angle is ", shortest(polar), ", expected degrees from -90 to 90"});
  if (!(std::abs(azimuth) <= 360.0))
    position.refuse({"an azimuth is ", shortest(azimuth), ", expected degrees from -360 to 360"});
  return spherical_direction(radians(polar), radians(azimuth) + turn);
}

[[nodiscard]] GONIO_INLINE sample_collector collect_fred(std::string_view text, text_position& position) {
  sample_collector collector;
  std::optional<direction> wi;
  std::vector<std::string_view> words;
  int lines = 0;
  for_each_line(text, position, [&](std::string_view line) {
    if (++lines == 1 && line != "type bsdf_data") position.refuse({in_quotes(line), ", expected 'type bsdf_data'"});
    if (lines == 2) check_fred_format(line, position);
    if (lines <= 2) return;
    split_at_blanks(line, words);
    if (words.size() == 2) {
      wi = fred_direction(words[0], words[1], std::numbers::pi, position);
    } else if (words.size() == 3 && wi) {
      const double value = read_number(words[2], position, [] { return "a value"; });
      require_float_range(value, position);
      collector.add({*wi, fred_direction(words[0], words[1], 0.0, position)}, {&value, 1});
    } else {
      position.refuse({words.size(), words.size() == 1 ? " number" : " numbers",
                       ", expected two angles of the light or, on lines below, two angles of the viewer and a value"});
    }
  });
  if (lines < 2) gonio::refuse({position.name, ": ends before its lines 'type bsdf_data' and 'format'"});
  return collector;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_fred_bsdf(std::string_view text) {
  text_position position;
  std::string_view line;
  text = without_byte_order_mark(text);
  return next_line(text, position, line) && line == "type bsdf_data";
}

GONIO_INLINE sample_set read_fred_bsdf(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  return detail::collect_fred(text, position).samples(name);
}

GONIO_INLINE sample_set read_fred_bsdf(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_fred_bsdf(as_text(bytes), path.string());
}

}  // namespace gonio::io
