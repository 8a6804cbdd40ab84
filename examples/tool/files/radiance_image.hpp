#pragma once
/// Images of linear light, read and written by all commands: .hdr, .npy or .exr.

#include <gonio/table/image.hpp>

#include <filesystem>
#include <string>

namespace cli {

/// Returns the formats for help texts: ".hdr, .npy or .exr", without .exr in a build without OpenEXR.
[[nodiscard]] std::string radiance_formats();

/// Returns the format of a file to read, by its extension: ".npy", ".exr" or ".hdr". With another extension, a file
/// that starts like Radiance's is ".hdr". Throws gonio::error naming any other file, for example a photograph.
[[nodiscard]] std::string radiance_format(const std::filesystem::path& path);

/// Reads an image. Throws gonio::error naming the file.
[[nodiscard]] gonio::image read_radiance(const std::filesystem::path& path);

/// Writes an image in the format of its extension; .hdr for any other.
void write_radiance(const std::filesystem::path& path, const gonio::image& picture);

}  // namespace cli
