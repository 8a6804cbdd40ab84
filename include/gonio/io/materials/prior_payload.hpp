#pragma once
/// The inflated content of a prior's file (docs/reference/formats.md), for programs that have no files or inflate bytes
/// themselves, such as one in a browser. `io/materials/prior.hpp` reads and writes files.

#include <gonio/basis/pca.hpp>
#include <gonio/io/bytes/byte_stream.hpp>

#include <string>

namespace gonio::io {

/// Appends a prior: components as 8-bit codes, mean and logarithm of the reference as 16-bit codes.
/// O(cells x components).
void write_prior(byte_writer& out, const log_relative_pca& prior);

/// Reads a prior. Throws gonio::error starting with `name` if the bytes left are not exactly one prior. Counts that the
/// bytes cannot hold are refused before memory is allocated. O(cells x components).
[[nodiscard]] log_relative_pca read_prior(byte_reader& in, const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/prior_payload.ipp>
#endif
