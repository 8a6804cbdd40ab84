#pragma once
/// Bodies of io/materials/soft_specular_prior.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/impl/prior.ipp>
#include <gonio/io/materials/soft_specular_prior.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io::detail {

/// Writes the length of a prior's payload in 64 bits, then the payload.
GONIO_INLINE void write_half(byte_writer& out, const log_relative_pca& prior) {
  byte_writer half;
  write_prior(half, prior);
  out.write(std::uint64_t{half.bytes().size()});
  out.write_bytes(half.bytes().data(), half.bytes().size());
}

[[nodiscard]] GONIO_INLINE log_relative_pca read_half(byte_reader& in, const std::string& name) {
  byte_reader half(in.read_bytes(in.read<std::uint64_t>()), name);
  return read_prior(half, name);
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::vector<std::byte> write_soft_specular_prior(const soft_specular_prior& prior) {
  byte_writer payload;
  payload.write(prior.threshold());
  detail::write_half(payload, prior.soft());
  detail::write_half(payload, prior.specular());
  return write_checked(detail::soft_specular_kind, payload.bytes());
}

GONIO_INLINE soft_specular_prior read_soft_specular_prior(std::span<const std::byte> bytes, const std::string& name) {
  const auto payload = read_checked(detail::soft_specular_kind, bytes, name);
  byte_reader in(payload, name);
  const auto threshold = in.read<double>();
  const log_relative_pca soft = detail::read_half(in, name), specular = detail::read_half(in, name);
  if (in.left() != 0) gonio::refuse({name, ": ", in.left(), " bytes follow the specular prior"});
  return detail::naming_prior(name, [&] { return soft_specular_prior(soft, specular, threshold); });
}

GONIO_INLINE bool is_soft_specular_prior(const std::filesystem::path& path) {
  return is_of_kind(detail::soft_specular_kind, path);
}

GONIO_INLINE void write_soft_specular_prior(const std::filesystem::path& path, const soft_specular_prior& prior) {
  write_atomically(path, write_soft_specular_prior(prior));
}

GONIO_INLINE soft_specular_prior read_soft_specular_prior(const std::filesystem::path& path) {
  return read_soft_specular_prior(read_bytes(path), path.string());
}

}  // namespace gonio::io
