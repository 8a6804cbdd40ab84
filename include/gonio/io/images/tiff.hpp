#pragma once
/// TIFF images of counts, as cameras and raw converters write them, and the exposure time in their EXIF data. Needs
/// libtiff 4.5 (gonio::tiff); its headers are not included. Format: TIFF 6.0; EXIF 2.32 (CIPA DC-008).

#include <gonio/table/stored_codes.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gonio::io {

/// Reads the counts of the first image of a TIFF file: strips of 8 or 16 bits in any compression that libtiff supports.
/// Channels after the third are ignored, grey becomes three equal channels. The orientation tag is ignored.
///
/// Throws gonio::error starting with `name` if the bytes are not a TIFF file or are truncated, if the image is tiled,
/// has separate planes, a palette, another colour space or other samples, or if it has more than 16384 rows or columns
/// or more pixels than the file's size allows.
[[nodiscard]] stored_codes read_tiff(std::span<const std::byte> bytes, const std::string& name);

/// Reads a TIFF file.
[[nodiscard]] stored_codes read_tiff(const std::filesystem::path& path);

/// Returns the exposure time in seconds from the EXIF data of a TIFF file; nothing if it has none. Throws gonio::error
/// starting with `name` if the bytes are not a TIFF file, or if the time is not from 1e-7 s to a day.
[[nodiscard]] std::optional<double> read_tiff_exposure_time(std::span<const std::byte> bytes, const std::string& name);

/// Returns the exposure time of a TIFF file.
[[nodiscard]] std::optional<double> read_tiff_exposure_time(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/tiff.ipp>
#endif
