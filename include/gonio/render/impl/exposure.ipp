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
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace gonio::render {

GONIO_INLINE double brightness_of_sphere(const image& picture, double share) {
  if (picture.shape(0) != picture.shape(1))
    refuse({"an image of a sphere must be square, not of ", picture.shape(0), " x ", picture.shape(1), " pixels"});
  std::vector<double> brightest;
  for (const sphere_point& point : sphere_points(static_cast<int>(picture.shape(0))))
    brightest.push_back(pixel(picture, point.row, point.column).maxCoeff());
  return quantile(brightest, share);
}

GONIO_INLINE double exposure_of_spheres(std::span<const image> images) {
  double brightest = 0.0;
  for (const image& picture : images) brightest = std::max(brightest, brightness_of_sphere(picture));
  return brightest > 0.0 ? 1.0 / brightest : 1.0;
}

GONIO_INLINE double exposure_of(const image& picture) {
  std::vector<float> brightest;
  const std::size_t pixels = picture.size() / 3, step = std::max<std::size_t>(pixels / 100'000, 1);
  for (std::size_t i = 0; i < pixels; i += step) {
    const float largest = *std::max_element(picture.data() + 3 * i, picture.data() + 3 * i + 3);
    if (largest > 0.0f) brightest.push_back(largest);
  }
  return brightest.empty() ? 1.0 : 1.0 / quantile(std::move(brightest), 0.99);
}

GONIO_INLINE void expose(image& picture, double exposure) {
  for (float& value : picture) value = static_cast<float>(exposure * value);
}

}  // namespace gonio::render
