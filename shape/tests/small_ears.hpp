#pragma once
/// A coarse model of synthetic ear canals, and scans of others, for tests with scans.

#include "synthetic/ear_canal_scans.hpp"
#include <gonio/shape/shape_model.hpp>

#include <cstdint>
#include <string>
#include <vector>

struct small_ears {
  synthetic::ear_canal_family family;
  synthetic::ear_canal_template common{500};
  std::vector<gonio::shape::point_columns> shapes;
  std::vector<std::string> names;
  gonio::shape::shape_model model;

  explicit small_ears(std::size_t count = 60)
      : shapes(draw(count)),
        names(name(count)),
        model(gonio::shape::learn_shape_model(shapes, names, common.mesh().triangles)) {}

  /// Returns a scan of an ear that the model has not seen.
  [[nodiscard]] synthetic::ear_scan scan(std::uint64_t seed, synthetic::scan_options how = {}) const {
    how.vertices = 2500;
    how.complete_vertices = 6000;
    return synthetic::scan_of(family.draw(5000 + seed), common, seed, how);
  }

  [[nodiscard]] static synthetic::scan_options with_hole() {
    synthetic::scan_options how;
    how.hole = synthetic::hole_options::large();
    return how;
  }

  [[nodiscard]] static const small_ears& of_sixty() {
    static const small_ears ears;
    return ears;
  }

 private:
  [[nodiscard]] std::vector<gonio::shape::point_columns> draw(std::size_t count) const {
    std::vector<gonio::shape::point_columns> drawn;
    for (std::size_t i = 0; i < count; ++i) drawn.push_back(common.corresponded(family.draw(i)));
    return drawn;
  }
  [[nodiscard]] static std::vector<std::string> name(std::size_t count) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back("ear-" + std::to_string(i));
    return all;
  }
};
