#pragma once
/// A soft and a specular prior in one file: the threshold between them, and two priors as io/materials/prior.hpp writes
/// them. docs/reference/formats.md describes the format.

#include <gonio/basis/soft_specular_prior.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// Returns a soft and a specular prior as the bytes of a file, quantised as by `write_prior`.
[[nodiscard]] std::vector<std::byte> write_soft_specular_prior(const soft_specular_prior& prior);

/// Reads a soft and a specular prior from the bytes of a file. Throws gonio::error starting with `name` if the file
/// does not hold two priors with the same metric, is of another version, damaged (checksum), truncated or too long.
[[nodiscard]] soft_specular_prior read_soft_specular_prior(std::span<const std::byte> bytes, const std::string& name);

/// Does the file start with the magic word of a soft and a specular prior?
[[nodiscard]] bool is_soft_specular_prior(const std::filesystem::path& path);

/// Writes a soft and a specular prior. An existing file is replaced only when the new one is complete.
void write_soft_specular_prior(const std::filesystem::path& path, const soft_specular_prior& prior);

/// Reads a file of a soft and a specular prior. Throws gonio::error as the function for bytes does.
[[nodiscard]] soft_specular_prior read_soft_specular_prior(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/soft_specular_prior.ipp>
#endif
