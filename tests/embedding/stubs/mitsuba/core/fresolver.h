#pragma once
// As much of Mitsuba 3 as the recipe of docs/learn/renderer.md uses, so that it is compiled. Names are Mitsuba's.

#include <filesystem>
#include <string>

namespace mitsuba {

struct FileResolver {
  std::filesystem::path resolve(const std::filesystem::path& path) const { return path; }
};
inline FileResolver* file_resolver() {
  static FileResolver resolver;
  return &resolver;
}

}  // namespace mitsuba
