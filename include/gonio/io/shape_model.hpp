#pragma once
/// An active shape model as a file; the format is described in docs/formats.md.

#include <gonio/io/checked_file.hpp>
#include <gonio/shape/shape_model.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::io {

namespace detail {

inline constexpr checked_file_kind shape_model_kind{"gonio-shapes", 1, "shape model"};

void put_shape_model(byte_writer& out, const shape_model& model);

/// A matrix of so many rows and columns, as its numbers lie in memory.
template <class Matrix>
[[nodiscard]] Matrix take_matrix(byte_reader& in, std::size_t rows, std::size_t columns) {
  const auto numbers = in.take_all<typename Matrix::Scalar>(rows * columns);
  return Eigen::Map<const Matrix>(numbers.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

[[nodiscard]] shape_model take_shape_model(byte_reader& in, const std::string& name);

}  // namespace detail

/// A model as the bytes of a file: nothing is lost.
[[nodiscard]] std::vector<std::byte> encode_shape_model(const shape_model& model);

/// The model in the bytes of a file. Throws gonio::error starting with `name` for what `decode_checked` refuses, counts
/// that lie, values that are not finite, and triangles that are no surface.
[[nodiscard]] shape_model decode_shape_model(std::span<const std::byte> bytes, const std::string& name);

/// Writes a model. An existing file is replaced only once the new one is complete.
inline void write_shape_model(const std::filesystem::path& path, const shape_model& model) {
  write_atomically(path, encode_shape_model(model));
}

/// Reads a model; see decode_shape_model for what is refused.
[[nodiscard]] inline shape_model read_shape_model(const std::filesystem::path& path) {
  return decode_shape_model(read_bytes(path), path.string());
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/shape_model.ipp>
#endif
