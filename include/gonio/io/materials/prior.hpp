#pragma once
/// The file of a learned prior: principal components under the log-relative metric, quantised, deflated and
/// checksummed. docs/reference/formats.md describes the format.

#include <gonio/basis/pca.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// Returns a prior as the bytes of a file: components in 8-bit codes, mean and logarithm of the reference in 16-bit.
[[nodiscard]] std::vector<std::byte> write_prior(const log_relative_pca& prior);

/// Reads a prior from the bytes of a file. Throws gonio::error starting with `name` if the file is not a prior, is of
/// another version, damaged (checksum), truncated or too long.
[[nodiscard]] log_relative_pca read_prior(std::span<const std::byte> bytes, const std::string& name);

/// Does the file start with a prior's magic word?
[[nodiscard]] bool is_prior(const std::filesystem::path& path);

/// Writes a prior. An existing file is replaced only when the new one is complete.
void write_prior(const std::filesystem::path& path, const log_relative_pca& prior);

/// Reads a prior's file. Throws gonio::error as the function above does.
[[nodiscard]] log_relative_pca read_prior(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/prior.ipp>
#endif
