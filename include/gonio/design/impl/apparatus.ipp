#pragma once
/// Bodies of design/apparatus.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/design/apparatus.hpp>

namespace gonio::design {

GONIO_INLINE apparatus usual_apparatus() {
  apparatus usual;
  usual.noise = 0.02;
  usual.dark_signal = 1e-4;
  usual.constraint.light.largest = usual.constraint.viewer.largest = radians(80.0);
  usual.constraint.smallest_separation = radians(5.0);
  return usual;
}

}  // namespace gonio::design
