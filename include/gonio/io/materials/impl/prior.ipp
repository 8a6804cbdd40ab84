#pragma once
/// Bodies of io/materials/prior.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/prior_payload.hpp>
#include <gonio/io/text/text.hpp>

#include <span>
#include <string>
#include <vector>

namespace gonio::io::detail {

/// Version 2 may have wavelengths. A prior in RGB is written as version 1, which older programs can read.
inline constexpr checked_file_kind prior_kind{"gonio-pca", 2, "prior", 1};
inline constexpr checked_file_kind colour_prior_kind{"gonio-pca", 1, "prior"};
inline constexpr checked_file_kind soft_specular_kind{"gonio-split", 1, "soft and specular prior"};

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> write_prior(const log_relative_pca& prior) {
  byte_writer payload;
  write_prior(payload, prior);
  return write_checked(prior.wavelengths().empty() ? detail::colour_prior_kind : detail::prior_kind, payload.bytes());
}

[[gnu::cold]] GONIO_INLINE log_relative_pca read_prior(std::span<const std::byte> bytes, const std::string& name) {
  if (as_text(bytes).starts_with(detail::soft_specular_kind.magic))
    gonio::refuse({name, ": has a soft and a specular prior, expected one prior of all materials"});
  const auto payload = read_checked(detail::prior_kind, bytes, name);
  byte_reader in(payload, name);
  return read_prior(in, name);
}

[[gnu::cold]] GONIO_INLINE bool is_prior(const std::filesystem::path& path) {
  return is_of_kind(detail::prior_kind, path);
}

[[gnu::cold]] GONIO_INLINE void write_prior(const std::filesystem::path& path, const log_relative_pca& prior) {
  write_atomically(path, write_prior(prior));
}

[[gnu::cold]] GONIO_INLINE log_relative_pca read_prior(const std::filesystem::path& path) {
  return read_prior(read_bytes(path), path.string());
}

}  // namespace gonio::io
