#pragma once
/// How long photographs were exposed: by their names, or by a table (docs/reference/formats.md).

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

/// Seconds of exposure that the end of a file's name, without its extension, says: `0.004s`, `4e-3s` and `frame_2_0.5s`
/// are decimal, `frame_1_250s` and `1-250s` are 1/250 s. Nothing if it ends in no such number. Throws gonio::error if
/// two whole numbers stand there of which the first is not 1, as in `frame_2_250s`: that may be frame 2, or 2/250 s.
[[nodiscard]] std::optional<double> exposure_time_of_name(std::string_view name);

/// Throws gonio::error starting with `name` unless an exposure that a file claims lasts from 1e-7 s to a day.
void require_believable_exposure(double seconds, const std::string& name);

/// Seconds of exposure by the names of files, with their extensions.
using exposure_times = std::map<std::string, double, std::less<>>;

/// Reads a table (.csv, of any dialect) with the header `file,seconds` and a line for each file; seconds are a number,
/// or two with a slash, as in 1/250; a name that holds a comma is in quotes. Throws gonio::error naming the line if it
/// has not these two fields, if seconds are not positive, or if a file is there twice.
[[nodiscard]] exposure_times read_exposure_times(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/exposure_times.ipp>
#endif
