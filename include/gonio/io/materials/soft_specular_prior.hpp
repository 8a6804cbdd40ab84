#pragma once
/// A soft and a specular prior as one file: the threshold between them, and two priors as io/materials/prior.hpp writes
/// them. The format is described in docs/reference/formats.md.

#include <gonio/basis/soft_specular_prior.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// Both priors as the bytes of a file, quantised as `write_prior` does.
[[nodiscard]] std::vector<std::byte> write_soft_specular_prior(const soft_specular_prior& prior);

/// The priors in the bytes of a file. Throws gonio::error starting with `name` where they are not two priors of one
/// metric, of another version, damaged (checksum), truncated or over-long.
[[nodiscard]] soft_specular_prior read_soft_specular_prior(std::span<const std::byte> bytes, const std::string& name);

/// Does the file start as two priors do?
[[nodiscard]] bool is_soft_specular_prior(const std::filesystem::path& path);

/// Writes both priors. An existing file is replaced only once the new one is complete.
void write_soft_specular_prior(const std::filesystem::path& path, const soft_specular_prior& prior);

/// Reads a file, which is refused for the same reasons.
[[nodiscard]] soft_specular_prior read_soft_specular_prior(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/soft_specular_prior.ipp>
#endif
