/// From one or two pictures to a whole BRDF: Xu et al. 2016, sections 6 and 7, with a simulated laboratory.

#include "lab/near_field_lab.hpp"
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>
#include <iostream>
#include <cmath>
#include <vector>

namespace {

/// Light and camera at half and difference angles in degrees as seen from the middle of the sample.
gonio::near_field_setup shot_at(double theta_h, double theta_d, double phi_d) {
  const auto [light, camera] =
      gonio::to_directions({gonio::radians(theta_h), gonio::radians(theta_d), gonio::radians(phi_d)});
  const double radius = std::tan(gonio::radians(12.5));
  return {.camera = gonio::pinhole_camera::look_at(gonio::camera_intrinsics::square(64, gonio::radians(26.0)), camera,
                                                   {0.0, 0.0, 0.0}, {0.1, 0.2, 1.0}),
          .light = {light, gonio::rgb::Constant(3.0)},
          .disc = gonio::sample_disc{radius},
          .block = 2};
}
double error_of(const gonio::brdf_table& estimate, const gonio::formula_brdf& truth) {
  double sum = 0.0; std::size_t n = 0;
  for (std::size_t cell = 0; cell < estimate.cells().size(); cell += 101) {
    const auto [wi, wo] = gonio::to_directions(estimate.cells().angles(cell));
    sum += (estimate.at(cell) / truth(wi, wo)).max(1e-9).log().square().mean(); ++n;
  }
  return std::sqrt(sum / static_cast<double>(n));
}

}  // namespace

TEST_CASE("one picture tells most, two tell more, and what goes slightly wrong harms slightly") {
  const auto prior = gonio::io::read_prior(std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior");
  const std::vector shots{shot_at(3.0, 50.0, 0.0), shot_at(8.0, 70.0, 60.0)};
  for (const char* name : {"red-paint", "blue-rubber", "gold-metal", "grey-lambertian"}) {
    const auto truth = gonio::formula_material(name);
    for (const auto& [count, defects] : std::vector<std::pair<std::size_t, lab::near_field_defects>>{{1, {}}, {2, {}}, {2, {.noise = 0.05}}, {2, {.misalignment = gonio::radians(1.0)}}, {2, {.noise=0.05,.misalignment = gonio::radians(1.0)}}})
    for (double eta : {40.0, 400.0, 4000.0}) {
      gonio::sample_set samples;
      for (std::size_t i = 0; i < count; ++i) {
        const auto picture = lab::photograph(truth, {.radius = 0.5}, shots[i], defects, i);
        const auto some = gonio::near_field_samples(picture, shots[i]);
        samples.insert(samples.end(), some.begin(), some.end());
      }
      const auto fitted = gonio::decomposition{prior, gonio::tikhonov{eta}}.fit(samples);
      std::cout << name << " " << count << " n" << samples.size() << " noise " << defects.noise << " mis " << defects.misalignment << " eta " << eta << " err " << error_of(fitted.tabulate(gonio::valid_cells()), truth) << std::endl;
    }
  }
}
