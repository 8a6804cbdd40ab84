#pragma once
/// Images of linear light, as all commands read and write them: .hdr, .npy or .exr.

#include <gonio/table/image.hpp>

#include <filesystem>
#include <string>

namespace cli {

/// What a help calls such files: ".hdr, .npy or .exr", where this build has OpenEXR.
[[nodiscard]] std::string radiance_formats();

/// How a file is to be read: as ".npy", ".exr" or ".hdr", which is what begins as Radiance's files do, whatever its
/// name. Throws gonio::error naming the file if it is none of them, as photographs that a camera wrote.
[[nodiscard]] std::string radiance_format(const std::filesystem::path& path);

/// Reads one. Throws gonio::error naming the file.
[[nodiscard]] gonio::image read_radiance(const std::filesystem::path& path);

/// Writes one as its extension says, of any other an .hdr.
void write_radiance(const std::filesystem::path& path, const gonio::image& picture);

}  // namespace cli
