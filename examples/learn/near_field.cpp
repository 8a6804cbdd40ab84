/// Two images of a flat sample from a short distance. Light and camera are half a degree away from their stated
/// directions.

#include "lab/near_field_lab.hpp"
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <cstdio>
#include <vector>

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const auto material = gonio::model::formula_material("red-paint");
  const double field_of_view = gonio::radians(45.0);
  const gonio::capture::sample_disc disc{.radius = std::tan(field_of_view / 2.0)};

  std::vector<gonio::sample_set> images;
  gonio::sample_set samples;
  for (const auto& [light, view] : gonio::io::read_direction_pairs("near-field-45-2-expected-error.csv")) {
    const gonio::capture::near_field_setup setup{.camera = gonio::design::near_field_camera(view, field_of_view, 48),
                                                 .light = gonio::directional_light{light},
                                                 .disc = disc,
                                                 .block = 2};
    const gonio::image image = lab::photograph(material, disc, setup, {0.01, gonio::radians(0.5)}, 7);
    images.push_back(gonio::capture::near_field_samples(image, setup));
    samples.insert(samples.end(), images.back().begin(), images.back().end());
  }
  std::printf("%zu samples in two images\n", samples.size());

  const gonio::valid_cells cells(gonio::grid({90, 30, 36}));
  const gonio::brdf_table truth = gonio::tabulate(material, cells);
  const gonio::appearance_metric appearance(cells);
  const auto show = [&](const char* name, const auto& paint) {
    const gonio::comparison off = gonio::compare(paint.tabulate(cells), truth, prior.metric(), appearance);
    std::printf("%-28s mapped rms %.3f, Delta E %.2f\n", name, off.mapped_rms.mean(), off.delta_e_env);
  };
  show("at the stated positions:", gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples));

  gonio::pose_refinement refinement(prior, images, {.deviation = gonio::radians(0.5)});
  refinement.solve();
  show("at the corrected positions:", refinement.result());
  for (const gonio::pose_correction& found : refinement.turns())
    std::printf("light turned by %.2f degrees, camera by %.2f\n", gonio::degrees(found.light.norm()),
                gonio::degrees(found.camera.norm()));
}
