/// A metric of your own: the cube root of reflectance, roughly its perceived brightness. The program fits nonnegative
/// weights of the prior's materials with it and with two of the library's metrics.

#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/nnls.hpp>

#include <cmath>
#include <cstdio>

struct cube_root {
  double forward(double rho, const auto& /*at*/) const noexcept { return std::cbrt(rho); }
  double inverse(double y, const auto& /*at*/) const noexcept { return y * y * y; }
};
static_assert(gonio::error_metric<cube_root>);

template <gonio::brdf Paint>
void show(const char* name, const Paint& paint) {
  const gonio::direction light = gonio::spherical_direction(gonio::radians(30.0), 0.0);
  const gonio::direction mirror = gonio::spherical_direction(gonio::radians(30.0), gonio::radians(180.0));
  const gonio::direction beside = gonio::spherical_direction(gonio::radians(30.0), gonio::radians(90.0));
  std::printf("%-10s red at the mirror direction %.3f, beside it %.4f sr^-1\n", name, paint(light, mirror).x(),
              paint(light, beside).x());
}

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const gonio::material_set materials = gonio::expand(prior);
  const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
  const auto fit = [&](const auto& metric) {
    return gonio::decomposition{gonio::measured{materials, metric}, gonio::nnls{}}.fit(samples);
  };
  show("lin", fit(gonio::lin{}));
  show("log", fit(gonio::log{}));
  show("cube root", fit(cube_root{}));
  show("the truth", gonio::model::formula_material("red-paint"));
}
