#pragma once
/// OpenEXR images of linear light: channels R, G and B, or Y alone, of 16 or 32 bits. Unlike HDR files they hold
/// negative and infinite values, and all digits of a float. Needs OpenEXR 3 (gonio::exr); its headers are not included.
/// Format: openexr.com/en/latest/OpenEXRFileLayout.html.

#include <gonio/table/image.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace gonio::io {

/// The image in the bytes of an OpenEXR file of scan lines or tiles; its data window is the image. Other channels are
/// ignored. Throws gonio::error starting with `name` if the bytes are no such file or are truncated, if the image has
/// more than 16384 pixels one way or more pixels than is believable of the bytes, if there is neither R, G and B nor Y,
/// and if a value is a NaN.
[[nodiscard]] image parse_exr(std::span<const std::byte> bytes, const std::string& name);

/// Reads an OpenEXR file.
[[nodiscard]] image read_exr(const std::filesystem::path& path);

/// Writes an OpenEXR file of 32-bit channels, deflated (ZIP). NaN is refused.
void write_exr(const std::filesystem::path& path, const image& picture);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/exr.ipp>
#endif
