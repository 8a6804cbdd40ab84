#pragma once
/// Bodies of render/exposure.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/sphere.hpp>
#include <gonio/table/image.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace gonio::render {

GONIO_INLINE double brightness_of_sphere(const image& image, double share) {
  if (image.shape(0) != image.shape(1))
    refuse({"an image of a sphere must be square, not of ", image.shape(0), " x ", image.shape(1), " pixels"});
  std::vector<double> brightest;
  for (const sphere_point& point : sphere_points(static_cast<int>(image.shape(0))))
    brightest.push_back(pixel(image, point.row, point.column).maxCoeff());
  return quantile(brightest, share);
}

GONIO_INLINE double exposure_of_spheres(std::span<const image> images) {
  double brightest = 0.0;
  for (const image& image : images) brightest = std::max(brightest, brightness_of_sphere(image));
  return brightest > 0.0 ? 1.0 / brightest : 1.0;
}

GONIO_INLINE void expose(image& image, double exposure) {
  for (float& value : image) value = static_cast<float>(exposure * value);
}

}  // namespace gonio::render
