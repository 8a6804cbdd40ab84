#include "described_materials.hpp"

#include "tool/pages/sample_facts.hpp"
#include <gonio/io/materials/mbsdf.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/utia.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace cli {

json describe_rgl(const std::filesystem::path& path) {
  const gonio::io::rgl_material file = gonio::io::read_rgl(path);
  const std::vector<double>&theta_i = file.material.parts().theta_i, &phi_i = file.material.parts().phi_i;
  json facts{{"kind", "RGL material"},
             {"description", file.description},
             {"directions_of_light", file.material.parts().lights()},
             {"theta_i", {rounded_degrees(theta_i.front()), rounded_degrees(theta_i.back())}}};
  if (file.material.is_anisotropic()) facts["phi_i"] = {rounded_degrees(phi_i.front()), rounded_degrees(phi_i.back())};
  if (file.spectra) facts["wavelengths_nm"] = file.spectra->wavelengths;
  return facts;
}

json describe_mbsdf(const std::filesystem::path& path) {
  const gonio::io::mbsdf_material file = gonio::io::read_mbsdf(path);
  const gonio::model::polar_grid& cells = file.reflection.grid();
  const std::span<const float> values = file.reflection.values();
  json facts{{"kind", "MDL measurement"},
             {"grid", {cells.polar, cells.polar, cells.azimuth}},
             {"channels", file.reflection.channels()},
             {"transmission", file.has_transmission},
             {"maximum", double{*std::ranges::max_element(values)}},
             {"negative_values", std::ranges::count_if(values, [](float value) { return value < 0.0f; })}};
  for (const auto& [key, value] : file.metadata) facts["metadata"][key] = value;
  return facts;
}

json describe_utia(const std::filesystem::path& path) {
  const gonio::model::angle_grid_brdf material = gonio::io::read_utia(path);
  const gonio::model::angle_grid& grid = material.grid();
  return {{"kind", "UTIA material"},
          {"directions_of_light", grid.phi_i.size() * grid.theta_i.size()},
          {"theta_i", {rounded_degrees(grid.theta_i.front()), rounded_degrees(grid.theta_i.back())}},
          {"phi_i", {rounded_degrees(grid.phi_i.front()), rounded_degrees(grid.phi_i.back())}},
          {"maximum", double{*std::ranges::max_element(grid.values)}},
          {"negative_values", std::ranges::count_if(grid.values, [](float value) { return value < 0.0f; })}};
}

}  // namespace cli
