#pragma once
/// Any number of synthetic materials: analytic models drawn at random.

#include <gonio/core/random.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/sum_of_lobes.hpp>
#include <gonio/model/ward.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cmath>
#include <random>

namespace papers {

/// A table of a Lambertian base below two lobes, the second GGX's; the first is GGX's or Ward's (bounded albedo).
/// Albedos are uniform, roughnesses from 0.03 to 0.8 and reflectances from 0.01 to 0.8 in their logarithm; a third of
/// the lobes are coloured. The same number gives the same material.
inline gonio::brdf_table random_material(std::uint64_t number, const gonio::valid_cells& cells,
                                         gonio::thread_count threads) {
  std::mt19937_64 generator(number);
  const auto within = [&](double low, double high) { return low + (high - low) * gonio::uniform_number(generator); };
  const auto logarithmic = [&](double low, double high) { return std::exp(within(std::log(low), std::log(high))); };
  const auto colour = [&](double brightness, bool grey) {
    if (grey) return gonio::rgb(gonio::rgb::Constant(brightness));
    const double r = within(0.2, 1.0), g = within(0.2, 1.0), b = within(0.2, 1.0);
    return gonio::rgb(gonio::rgb(r, g, b) * brightness);
  };
  const gonio::model::lambertian base{colour(within(0.0, 0.8), within(0.0, 1.0) < 0.2)};
  const gonio::model::ggx second{.alpha = logarithmic(0.03, 0.8),
                                 .f0 = colour(logarithmic(0.01, 0.3), within(0.0, 1.0) < 0.67)};
  const double roughness = logarithmic(0.03, 0.8), reflectance = logarithmic(0.01, 0.8);
  const gonio::rgb tint = colour(reflectance, within(0.0, 1.0) < 0.67);
  if (within(0.0, 1.0) < 0.5)
    return gonio::tabulate(gonio::model::sum_of_lobes{base, gonio::model::ggx{.alpha = roughness, .f0 = tint}, second},
                           cells, threads);
  const gonio::model::ward_bounded gloss{tint, {.roughness = roughness}};
  return gonio::tabulate(gonio::model::sum_of_lobes{base, gloss, second}, cells, threads);
}

}  // namespace papers
