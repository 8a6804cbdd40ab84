#pragma once
/// Images of linear light, read and written by all commands: .hdr, .npy or .exr.

#include <gonio/table/image.hpp>

#include <filesystem>
#include <string>

namespace cli {

/// Returns the formats for help texts: ".hdr, .npy or .exr", the latter if this build has OpenEXR.
[[nodiscard]] std::string radiance_formats();

/// Returns the format for reading a file: ".npy", ".exr" or ".hdr"; a file that starts as Radiance's files do is ".hdr"
/// under any name. Throws gonio::error naming the file if it is none of them, for example a photograph.
[[nodiscard]] std::string radiance_format(const std::filesystem::path& path);

/// Reads an image. Throws gonio::error naming the file.
[[nodiscard]] gonio::image read_radiance(const std::filesystem::path& path);

/// Writes an image in the format of its extension; .hdr for any other.
void write_radiance(const std::filesystem::path& path, const gonio::image& picture);

}  // namespace cli
