#pragma once
/// Bodies of io/images/exposure_times.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/images/exposure_times.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Returns the longest ending of a text that consists of the given characters.
[[nodiscard]] GONIO_INLINE std::string_view ending_of(std::string_view text, std::string_view characters) {
  const std::size_t before = text.find_last_not_of(characters);
  return before == std::string_view::npos ? text : text.substr(before + 1);
}

/// Reads a positive number or quotient of two numbers by `numbers.read_number`; nothing if the text is neither.
template <class Numbers>
[[nodiscard]] std::optional<double> positive_quotient(std::string_view text, Numbers&& numbers) {
  const std::size_t slash = text.find('/');
  double above = 0.0, below = 1.0;
  if (numbers.read_number(trimmed(text.substr(0, slash)), above) != nullptr) return {};
  if (slash != std::string_view::npos && numbers.read_number(trimmed(text.substr(slash + 1)), below) != nullptr)
    return {};
  if (!(above > 0.0 && below > 0.0 && above / below > 0.0 && above / below < 1e9)) return {};
  return above / below;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::optional<double> exposure_time_of_name(std::string_view name) {
  constexpr std::string_view digits = "0123456789";
  if (!name.ends_with('s')) return {};
  const std::string_view whole = name;
  name.remove_suffix(1);
  std::string_view number = detail::ending_of(name, "0123456789.");
  // A power of ten, as in 1e-04?
  const std::string_view mantissa = name.substr(0, name.size() - number.size());
  if (mantissa.ends_with("e-")) {
    const std::string_view whole_number = detail::ending_of(mantissa.substr(0, mantissa.size() - 2), "0123456789.");
    if (!whole_number.empty()) number = name.substr(name.size() - number.size() - 2 - whole_number.size());
  }
  const std::optional<double> seconds = detail::positive_quotient(number, csv_dialect{});
  if (!seconds) return {};
  // The denominator of a fraction?
  const bool is_whole = number.find_first_not_of(digits) == std::string_view::npos;
  std::string_view before = name.substr(0, name.size() - number.size());
  if (!is_whole || before.empty() || (before.back() != '_' && before.back() != '-')) return seconds;
  before.remove_suffix(1);
  const std::string_view above = detail::ending_of(before, digits);
  if (above.empty()) return seconds;
  if (above == "1") return 1.0 / *seconds;
  gonio::refuse({"the name ", in_quotes(whole), " ends in two numbers, ", in_quotes(above), " and ", in_quotes(number),
                 ", expected one number of seconds, or a fraction such as 1_250s"});
}

GONIO_INLINE void require_believable_exposure(double seconds, const std::string& name) {
  constexpr double least = 1e-7, most = 86400.0;
  if (!(seconds >= least && seconds <= most))
    gonio::refuse({name, ": an exposure time of ", shortest(seconds), " s, expected from 1e-07 s to a day"});
}

GONIO_INLINE exposure_times read_exposure_times(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  csv_reader table(as_text(bytes), path.string());
  exposure_times times;
  const std::vector<std::string_view>& fields = table.fields();
  if (table.next() && (fields.size() != 2 || fields[0] != "file" || fields[1] != "seconds"))
    table.position().refuse("expected the header 'file,seconds'");
  while (table.next()) {
    const std::optional<double> time = detail::positive_quotient(fields[1], table);
    if (fields[0].empty() || !time)
      table.position().refuse({"expected a file and a positive number of seconds, not ", in_quotes(fields[0]), " and ",
                               in_quotes(fields[1])});
    if (!times.emplace(fields[0], *time).second)
      table.position().refuse({"the file ", in_quotes(fields[0]), " appears twice"});
  }
  if (times.empty()) gonio::refuse({path.string(), ": has no exposure time"});
  return times;
}

}  // namespace gonio::io
