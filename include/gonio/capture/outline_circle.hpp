#pragma once
/// A circle in an image.

namespace gonio::capture {

/// A circle around a sphere in an image, in pixels. Pixel (row, column) covers columns from `column` to `column + 1`.
struct outline_circle {
  double column = 0.0, row = 0.0, radius = 0.0;
};

}  // namespace gonio::capture
