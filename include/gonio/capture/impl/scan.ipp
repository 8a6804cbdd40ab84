#pragma once
/// Bodies of capture/scan.hpp.

#include <gonio/capture/device.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/capture/trajectory.hpp>
#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/progress.hpp>

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture::detail {

GONIO_INLINE std::string fault_of(const reading& taken, std::uint16_t largest_count) {
  if (taken.frames.empty()) return "the camera gave no frame";
  if (taken.frames.size() != taken.times.size())
    return "the camera gave " + std::to_string(taken.frames.size()) + " frames for " +
           std::to_string(taken.times.size()) + " exposures";
  for (const camera_frame& each : taken.frames) {
    if (each.rows() == 0 || each.rows() != taken.frames.front().rows())
      return "a frame has " + std::to_string(each.rows()) + " pixels, the first " +
             std::to_string(taken.frames.front().rows());
    if (each.maxCoeff() > largest_count)
      return "a pixel has " + std::to_string(each.maxCoeff()) + " counts, the largest is " +
             std::to_string(largest_count);
  }
  return {};
}

}  // namespace gonio::capture::detail
