#pragma once
/// Exposure times of photographs, from their names or from a table (docs/reference/formats.md).

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

/// Returns the exposure time in seconds at the end of a file's name (without extension): `0.004s`, `4e-3s` and
/// `frame_2_0.5s` are decimal, `frame_1_250s` and `1-250s` are 1/250 s. Returns nothing if the name does not end in
/// such a number. Throws gonio::error if two whole numbers end the name and the first is not 1: `frame_2_250s` may be
/// frame 2 or 2/250 s.
[[nodiscard]] std::optional<double> exposure_time_of_name(std::string_view name);

/// Throws gonio::error starting with `name` unless the exposure time is from 1e-7 s to a day.
void require_believable_exposure(double seconds, const std::string& name);

/// Exposure times in seconds by file name, with extension.
using exposure_times = std::map<std::string, double, std::less<>>;

/// Reads a table (.csv of any dialect) with the header `file,seconds` and a line for each file. Seconds are a number or
/// a fraction such as 1/250. A name that contains a comma is in quotes. Throws gonio::error naming the line if a field
/// is missing, if seconds are not positive, or if a file is listed twice.
[[nodiscard]] exposure_times read_exposure_times(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/exposure_times.ipp>
#endif
