#pragma once
/// Networks and measured materials of two families, as the experiments that leave families out read them.

#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

/// A folder with five networks of random weights, and three measured materials of two families.
class measured_database {
 public:
  measured_database() {
    write_synthetic_networks(folder_, {"a", "b", "c", "d", "e"});
    std::filesystem::create_directory(folder_ / "measured");
    constexpr gonio::model::adaptive_resolution small{.theta_i = 8, .values = 16, .visible_normals = 16, .normals = 64};
    const auto& names = gonio::model::formula_material_names();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto tables = gonio::model::tabulate_adaptively(gonio::model::formula_material(names[i]), small);
      const std::string name = (i < 2 ? "first_" : "second_") + std::to_string(i) + ".bsdf";
      gonio::io::write_rgl(folder_ / "measured" / name, tables);
    }
  }

  [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }

  /// The options that name it, with a prior that is learned soon.
  [[nodiscard]] std::string options() const {
    return "--thin 9 30 --components 3 --networks " + at("n.npy") + " --materials " + at("measured");
  }

 private:
  scratch::folder folder_;
};
