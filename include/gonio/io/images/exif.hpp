#pragma once
/// Reads the exposure time from the EXIF data of a JPEG file, as cameras write beside a raw file. Needs libexif
/// (gonio::exif); its headers are not included. Format: EXIF 2.32 (CIPA DC-008).

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gonio::io {

/// Returns the exposure time in seconds; nothing if the EXIF data has none. Throws gonio::error starting with `name` if
/// the bytes are not a JPEG file with EXIF data, or if the time is not from 1e-7 s to a day.
[[nodiscard]] std::optional<double> read_exif_exposure_time(std::span<const std::byte> bytes, const std::string& name);

/// Returns the exposure time of a JPEG file.
[[nodiscard]] std::optional<double> read_exif_exposure_time(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/exif.ipp>
#endif
