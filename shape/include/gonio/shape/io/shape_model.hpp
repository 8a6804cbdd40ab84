#pragma once
/// An active shape model as a file; the format is described in docs/reference/formats.md.

#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/shape/shape_model.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

namespace detail {

inline constexpr checked_file_kind shape_model_kind{"gonio-shapes", 1, "shape model"};

}  // namespace detail

/// Converts a model to the bytes of a file without loss.
[[nodiscard]] std::vector<std::byte> write_shape_model(const shape::shape_model& model);

/// Reads a model from the bytes of a file. Throws gonio::error that starts with `name` for bytes that `read_checked`
/// refuses, wrong counts, values that are not finite, and triangles that are not a surface.
[[nodiscard]] shape::shape_model read_shape_model(std::span<const std::byte> bytes, const std::string& name);

/// Writes a model. An existing file is replaced only once the new one is complete.
void write_shape_model(const std::filesystem::path& path, const shape::shape_model& model);

/// Reads a model from a file. Throws gonio::error if the file cannot be read, or if `read_shape_model` refuses its
/// bytes.
[[nodiscard]] shape::shape_model read_shape_model(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/shape_model.ipp>
#endif
