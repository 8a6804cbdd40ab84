#pragma once
/// What the file of a prior holds once it is inflated (docs/reference/formats.md), for a program that has no files or
/// inflates bytes itself, as one in a browser does. `io/materials/prior.hpp` reads and writes files.

#include <gonio/basis/pca.hpp>
#include <gonio/io/bytes/byte_stream.hpp>

#include <string>

namespace gonio::io {

/// Appends a prior: components as 8-bit codes, mean and logarithm of the reference as 16-bit ones. O(cells x k).
void write_prior(byte_writer& out, const log_relative_pca& prior);

/// Reads a prior, which must be all that is left. Throws gonio::error starting with `name` where the bytes are not a
/// prior's; counts that they cannot hold are refused before memory is asked for. O(cells x k).
[[nodiscard]] log_relative_pca read_prior(byte_reader& in, const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/prior_payload.ipp>
#endif
