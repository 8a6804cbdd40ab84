#pragma once
/// Bodies of evaluate/test_materials.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/evaluate/test_materials.hpp>

#include <string>
#include <vector>

namespace gonio {

GONIO_INLINE const std::vector<std::string>& nielsen_test_materials() {
  static const std::vector<std::string> names{
      "black-soft-plastic", "blue-acrylic",          "blue-metallic-paint2",     "green-fabric",     "light-red-paint",
      "pink-jasper",        "silver-metallic-paint", "specular-violet-phenolic", "two-layer-silver", "white-fabric"};
  return names;
}

}  // namespace gonio
