#pragma once
/// Bodies of shape/io/shape_model.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/shape/io/shape_model.hpp>
#include <gonio/shape/shape_model.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE void write_shape_model(byte_writer& out, const shape::shape_model& model) {
  const shape::shape_basis& basis = model.basis();
  out.write(static_cast<std::uint32_t>(model.vertices()));
  out.write(static_cast<std::uint32_t>(model.triangles().cols()));
  out.write(static_cast<std::uint32_t>(basis.size()));
  out.write(static_cast<std::uint32_t>(basis.names().size()));
  out.write(basis.explained_variance());
  out.write_text(basis.source());
  for (const std::string& name : basis.names()) out.write_text(name);
  const auto write_matrix = [&](const auto& matrix) {
    using number = typename std::remove_cvref_t<decltype(matrix)>::Scalar;
    out.write_all(std::span<const number>(matrix.data(), matrix.size()));
  };
  write_matrix(model.triangles());
  write_matrix(basis.singular_values());
  write_matrix(basis.coefficients());
  out.write_all(std::span<const float>(basis.mean()));
  write_matrix(basis.components());
}

/// Reads a matrix in its memory order.
template <class Matrix>
[[nodiscard]] Matrix read_matrix(byte_reader& in, std::size_t rows, std::size_t columns) {
  const auto bytes = in.read_bytes(rows * columns * sizeof(typename Matrix::Scalar));
  Matrix matrix(rows, columns);
  std::ranges::copy(bytes, std::as_writable_bytes(std::span(matrix.data(), rows * columns)).begin());
  return matrix;
}

/// Returns the minimum number of bytes after the counts: the explained variance, a length for each text, all numbers.
[[nodiscard]] GONIO_INLINE double least_rest(double vertices, double triangles, double components, double shapes) {
  return 8.0 + 4.0 * (1.0 + shapes) + 12.0 * triangles + components * (8.0 + 4.0 * shapes) +
         12.0 * vertices * (1.0 + components);
}

[[nodiscard]] GONIO_INLINE shape::shape_model read_shape_model(byte_reader& in, const std::string& name) {
  // Read the counts. Refuse counts that the rest of the file cannot hold.
  const std::size_t vertices = in.read<std::uint32_t>(), triangles = in.read<std::uint32_t>(),
                    components = in.read<std::uint32_t>(), shapes = in.read<std::uint32_t>();
  if (components == 0 || components > shapes)
    gonio::refuse({name, ": ", components, " components of ", shapes, " shapes, expected 1 to ", shapes});
  const auto as_real = [](std::size_t count) { return static_cast<double>(count); };
  if (least_rest(as_real(vertices), as_real(triangles), as_real(components), as_real(shapes)) > as_real(in.left()))
    gonio::refuse({name, ": the file is truncated or its counts are wrong: ", in.left(), " bytes cannot hold ",
                   components, " components of ", shapes, " shapes of ", vertices, " vertices and ", triangles,
                   " triangles"});
  // Read the names and the matrices.
  const auto explained_variance = in.read<double>();
  std::string source = in.read_text();
  std::vector<std::string> names(shapes);
  for (std::string& shape : names) shape = in.read_text();
  auto corners = read_matrix<shape::triangle_columns>(in, 3, triangles);
  const auto singular_values = read_matrix<Eigen::VectorXd>(in, components, 1);
  const auto coefficients = read_matrix<Eigen::MatrixXf>(in, shapes, components);
  auto mean = in.read_all<float>(3 * vertices);
  auto functions = read_matrix<cell_matrix>(in, 3 * vertices, components);
  if (in.left() != 0) gonio::refuse(name + ": " + std::to_string(in.left()) + " bytes follow the last component");
  // Refuse values that are not finite.
  const bool finite = std::isfinite(explained_variance) && singular_values.allFinite() && coefficients.allFinite() &&
                      functions.allFinite() &&
                      std::ranges::all_of(mean, [](float value) { return std::isfinite(value); });
  if (!finite) gonio::refuse(name + ": a value of the shape model is not finite");
  // Construct the model. Errors of its own checks get the file's name.
  try {
    return {shape::shape_basis({{std::ssize(mean) / 3},
                                lin{},
                                std::move(names),
                                singular_values,
                                std::move(functions),
                                std::move(mean),
                                coefficients,
                                explained_variance,
                                std::move(source)}),
            std::move(corners)};
  } catch (const error& refusal) {
    gonio::refuse(name + ": " + refusal.what());
  }
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::vector<std::byte> write_shape_model(const shape::shape_model& model) {
  byte_writer payload;
  detail::write_shape_model(payload, model);
  return write_checked(detail::shape_model_kind, payload.bytes());
}

GONIO_INLINE shape::shape_model read_shape_model(std::span<const std::byte> bytes, const std::string& name) {
  const auto payload = read_checked(detail::shape_model_kind, bytes, name);
  byte_reader in(payload, name);
  return detail::read_shape_model(in, name);
}

GONIO_INLINE void write_shape_model(const std::filesystem::path& path, const shape::shape_model& model) {
  write_atomically(path, write_shape_model(model));
}

GONIO_INLINE shape::shape_model read_shape_model(const std::filesystem::path& path) {
  return read_shape_model(read_bytes(path), path.string());
}

}  // namespace gonio::io
