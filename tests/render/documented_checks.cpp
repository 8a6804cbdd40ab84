// The code block of docs/learn/renderer.md that shows how to check a sampler.

#include "../sampler_checks.hpp"
#include <gonio/model/formula_materials.hpp>
#include <gonio/render.hpp>
#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>

TEST_CASE("what a renderer's author checks of a sampler") {
  const gonio::render::half_vector_sampler paint(gonio::render::lookup_table<float>::of(
      gonio::tabulate(gonio::model::formula_material("red-paint"), gonio::valid_cells(gonio::grid({45, 45, 60})))));

  const gonio::direction wo = gonio::spherical_direction(gonio::radians(60.0), 0.7);
  const auto furnace = sampler_checks::albedo_by_sampling(paint, wo, 20'000, 1);  // the mean weight
  const double albedo = sampler_checks::albedo_by_quadrature(paint.brdf(), wo);   // within 3 furnace.standard_error
  const double p = sampler_checks::chi_square_p_value(paint, wo, 100'000, 2);     // tiny where sample and pdf disagree
  const double one = sampler_checks::integral_of_pdf(paint, wo);                  // less if pdf is cut at the horizon

  CHECK(std::abs(furnace.mean - albedo) < 3.0 * furnace.standard_error);
  CHECK(p > 1e-3);
  CHECK(one == doctest::Approx(1.0).epsilon(0.01));
}
