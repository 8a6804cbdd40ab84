#pragma once
/// Poses as text: rotation and translation of a scan, as written down after an alignment by hand
/// (docs/reference/formats.md).

#include <gonio/shape/alignment.hpp>

#include <filesystem>

namespace gonio::io {

/// Reads a pose from a scan to the model, x -> R x + t, lengths in mm: a 4 x 4 matrix whose last line is 0 0 0 1, or a
/// line `rotation` with the nine numbers of R, row by row, and a line `translation` with the three of t. `#` starts a
/// comment line. R is replaced by the nearest rotation.
///
/// Throws gonio::error that names the file, and the line if possible, if the text has neither form, if a number is not
/// finite, or if R is not a rotation within 1e-3: scale, shear and reflection are not rigid motions.
[[nodiscard]] shape::similarity_transform read_pose(const std::filesystem::path& path);

/// Writes the 4 x 4 matrix with the fewest digits that read back as the same numbers.
void write_pose(const std::filesystem::path& path, const shape::similarity_transform& pose);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/pose.ipp>
#endif
