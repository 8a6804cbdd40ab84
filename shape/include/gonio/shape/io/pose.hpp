#pragma once
/// Poses as text: how a scan is turned and shifted, as whoever aligns one by hand writes it down
/// (docs/reference/formats.md).

#include <gonio/shape/alignment.hpp>

#include <filesystem>

namespace gonio::io {

/// Reads a pose from a scan to the model, x -> R x + t, lengths in mm: a matrix of 4 x 4 numbers whose last line is
/// 0 0 0 1, or a line `rotation` with the nine numbers of R, row by row, and a line `translation` with the three of t.
/// `#` starts a comment line. R is taken to the nearest rotation.
///
/// Throws gonio::error naming the file, and the line where there is one to name, if it is neither of these, if a number
/// is not finite, or if R is no rotation to 1e-3: a scale, a shear and a mirror image are no rigid motion.
[[nodiscard]] shape::similarity_transform read_pose(const std::filesystem::path& path);

/// Writes the matrix of 4 x 4 numbers, each in the fewest digits that read back as the same number.
void write_pose(const std::filesystem::path& path, const shape::similarity_transform& pose);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/pose.ipp>
#endif
