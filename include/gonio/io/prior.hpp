#pragma once
/// The learned prior as a file: principal components under the log-relative metric, quantised, deflated and
/// checksummed. The format is described in docs/formats.md.

#include <gonio/basis/pca.hpp>
#include <gonio/io/checked_file.hpp>
#include <gonio/io/quantise.hpp>

#include <cstdint>
#include <string>

namespace gonio::io {

namespace detail {

inline constexpr checked_file_kind prior_kind{"gonio-pca", 1, "prior"};

[[nodiscard]] std::vector<float> log_of_reference(const log_relative& metric);

void put_prior(byte_writer& out, const log_relative_pca& prior);

[[nodiscard]] valid_cells take_cells(byte_reader& in, const std::string& name);

[[nodiscard]] std::vector<float> dequantise_all(const quantised<std::uint16_t>& column);

[[nodiscard]] log_relative_pca take_prior(byte_reader& in, const std::string& name);

}  // namespace detail

/// A prior as the bytes of a file: components as 8-bit codes, mean and logarithm of the reference as 16-bit
/// ones.
[[nodiscard]] std::vector<std::byte> encode_prior(const log_relative_pca& prior);

/// The prior in the bytes of a file. Throws gonio::error starting with `name` where they are not a prior, of
/// another version, damaged (checksum), truncated or over-long.
[[nodiscard]] log_relative_pca decode_prior(std::span<const std::byte> bytes, const std::string& name);

/// Does the file start as a prior does?
[[nodiscard]] inline bool is_prior(const std::filesystem::path& path) { return is_of_kind(detail::prior_kind, path); }

/// Writes a prior. An existing file is replaced only once the new one is complete.
inline void write_prior(const std::filesystem::path& path, const log_relative_pca& prior) {
  write_atomically(path, encode_prior(prior));
}

/// Reads a prior; see decode_prior for what is refused.
[[nodiscard]] inline log_relative_pca read_prior(const std::filesystem::path& path) {
  return decode_prior(read_bytes(path), path.string());
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/prior.ipp>
#endif
