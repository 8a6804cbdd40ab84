#pragma once
// As fresolver.h.

#include <string_view>

namespace mitsuba {

struct Properties {
  template <class T>
  T get(std::string_view) const {
    return {};
  }
};

}  // namespace mitsuba
