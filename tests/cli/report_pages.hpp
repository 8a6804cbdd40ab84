#pragma once
/// Pages of `gonio report` as read by tests.

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

/// A scan of red paint in the plane of a light at 45 degrees. If `wrong`, the seventh sample is five times too bright.
inline std::string in_plane_scan(const std::string& comments, bool wrong) {
  const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");
  const gonio::direction light = gonio::spherical_direction(gonio::radians(45.0), 0.0);
  std::string text = comments + "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
  for (int i = 0; i < 15; ++i) {
    const int degrees = -70 + 10 * i;
    const double phi = degrees < 0 ? 0.0 : 180.0;
    const gonio::direction view = gonio::spherical_direction(gonio::radians(std::abs(degrees)), gonio::radians(phi));
    const gonio::rgb value = paint(light, view) * (wrong && i == 6 ? 5.0 : 1.0);
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), "45,0,%d,%.0f,%.6g,%.6g,%.6g\n", std::abs(degrees), phi, value.x(),
                  value.y(), value.z());
    text += line.data();
  }
  return text;
}

struct page_files {
  scratch::folder folder;

  [[nodiscard]] std::string path(const std::string& name) const { return (folder / name).string(); }

  /// Returns the page made from a file with this name and text.
  [[nodiscard]] std::string page_of(const std::string& name, const std::string& text,
                                    const std::string& arguments = "") const {
    scratch::put(folder / name, text);
    run("report '" + path(name) + "' -o '" + path("page.html") + "' " + arguments);
    return scratch::get(folder / "page.html");
  }
};

inline std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

inline std::string data_text(const std::string& page) {
  const std::string opening = R"(<script id="data" type="application/json">)";
  const std::size_t start = page.find(opening);
  REQUIRE(start != std::string::npos);
  const std::size_t end = page.find("</script>", start);
  REQUIRE(end != std::string::npos);
  return page.substr(start + opening.size(), end - start - opening.size());
}
