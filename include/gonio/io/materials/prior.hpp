#pragma once
/// The learned prior as a file: principal components under the log-relative metric, quantised, deflated and
/// checksummed. The format is described in docs/reference/formats.md.

#include <gonio/basis/pca.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// A prior as the bytes of a file: components as 8-bit codes, mean and logarithm of the reference as 16-bit
/// ones.
[[nodiscard]] std::vector<std::byte> write_prior(const log_relative_pca& prior);

/// The prior in the bytes of a file. Throws gonio::error starting with `name` where they are not a prior, of
/// another version, damaged (checksum), truncated or over-long.
[[nodiscard]] log_relative_pca read_prior(std::span<const std::byte> bytes, const std::string& name);

/// Does the file start as a prior does?
[[nodiscard]] bool is_prior(const std::filesystem::path& path);

/// Writes a prior. An existing file is replaced only once the new one is complete.
void write_prior(const std::filesystem::path& path, const log_relative_pca& prior);

/// Reads a file, which is refused for the same reasons.
[[nodiscard]] log_relative_pca read_prior(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/prior.ipp>
#endif
