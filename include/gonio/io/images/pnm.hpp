#pragma once
/// Netpbm images of counts, PPM (P6) and PGM (P5), of up to 16 bits: the linear output of raw converters. The file
/// gives its largest possible count, often less than the bits allow. Format: netpbm.sourceforge.net/doc/ppm.html.

#include <gonio/table/stored_codes.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace gonio::io {

/// Reads the counts of a PPM or PGM file, which holds one image and nothing after it. Grey becomes three equal
/// channels. Throws gonio::error starting with `name` if the bytes are of another kind, truncated or too long, if a
/// count is above the file's largest one, or if the image has more than 16384 rows or columns.
[[nodiscard]] stored_codes read_pnm(std::span<const std::byte> bytes, const std::string& name);

/// Reads a PPM or PGM file.
[[nodiscard]] stored_codes read_pnm(const std::filesystem::path& path);

/// Writes a PPM file: 8 bits if the largest count is below 256, otherwise 16. Throws gonio::error if the number of
/// counts does not fit the size, or if a count is above the largest.
void write_pnm(const std::filesystem::path& path, const stored_codes& codes);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/pnm.ipp>
#endif
