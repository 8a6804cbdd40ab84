#pragma once
/// The surface point and normal that each pixel of an image sees.

#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <cstddef>

namespace gonio {

/// A surface as seen by a camera: a column for each pixel, row by row, in the camera's world frame and unit of length.
/// The surface may come from a formula, from a normal map or from a mesh. 48 bytes a pixel.
struct surface_image {
  std::size_t rows = 0, columns = 0;
  Eigen::Matrix3Xd positions;
  Eigen::Matrix3Xd normals;  ///< of length 1; zero if a pixel does not see the surface

  /// Returns an image of this size that sees nothing.
  [[nodiscard]] static surface_image nothing(std::size_t rows, std::size_t columns) {
    const auto pixels = static_cast<Eigen::Index>(rows * columns);
    return {rows, columns, Eigen::Matrix3Xd::Zero(3, pixels), Eigen::Matrix3Xd::Zero(3, pixels)};
  }

  [[nodiscard]] Eigen::Index pixel(std::size_t row, std::size_t column) const noexcept {
    return static_cast<Eigen::Index>(row * columns + column);
  }
  [[nodiscard]] bool sees(Eigen::Index pixel) const noexcept {
    return normals(0, pixel) != 0.0 || normals(1, pixel) != 0.0 || normals(2, pixel) != 0.0;
  }
};

}  // namespace gonio
