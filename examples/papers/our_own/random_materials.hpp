#pragma once
/// Any number of synthetic materials: analytic models drawn at random.

#include <gonio/core/random.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/smooth_spectra.hpp>
#include <gonio/model/sum_of_lobes.hpp>
#include <gonio/model/ward.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/spectral_table.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace papers {

struct random_parameters {
  gonio::model::lambertian base;
  gonio::model::ggx second;
  double roughness = 0.0;  ///< of the first lobe
  gonio::rgb tint;
  bool is_ggx = false;  ///< otherwise Ward's
};

/// Draws parameters. The same number gives the same material.
inline random_parameters draw_parameters(std::uint64_t number) {
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
  const double roughness = logarithmic(0.03, 0.8), specular = logarithmic(0.01, 0.8);
  const gonio::rgb tint = colour(specular, within(0.0, 1.0) < 0.67);
  return {base, second, roughness, tint, within(0.0, 1.0) < 0.5};
}

inline gonio::brdf_table tabulate_parameters(const random_parameters& drawn, const gonio::valid_cells& cells,
                                             gonio::thread_count threads) {
  const auto& [base, second, roughness, tint, is_ggx] = drawn;
  if (is_ggx)
    return gonio::tabulate(gonio::model::sum_of_lobes{base, gonio::model::ggx{.alpha = roughness, .f0 = tint}, second},
                           cells, threads);
  const gonio::model::ward_bounded gloss{tint, {.roughness = roughness}};
  return gonio::tabulate(gonio::model::sum_of_lobes{base, gloss, second}, cells, threads);
}

/// Tabulates the sum of a Lambertian lobe and two others. The second of these is GGX; the first is GGX or Ward (bounded
/// albedo). Albedos are uniform. Roughnesses from 0.03 to 0.8 and reflectances from 0.01 to 0.8 are uniform in their
/// logarithm. A third of the lobes are coloured.
inline gonio::brdf_table random_material(std::uint64_t number, const gonio::valid_cells& cells,
                                         gonio::thread_count threads) {
  return tabulate_parameters(draw_parameters(number), cells, threads);
}

/// Returns the same material at the wavelengths of `spectra`. Its albedo and reflectances are the smoothest spectra of
/// the given colours. Three wavelengths at a time are evaluated as red, green and blue.
inline gonio::spectral_table random_spectra(std::uint64_t number, const gonio::model::smooth_spectra& spectra,
                                            const gonio::valid_cells& cells, gonio::thread_count threads) {
  const random_parameters drawn = draw_parameters(number);
  const Eigen::ArrayXd base = spectra(drawn.base.albedo), second = spectra(drawn.second.f0), tint = spectra(drawn.tint);
  gonio::spectral_table table(cells, spectra.wavelengths());
  for (Eigen::Index first = 0; first < table.bands(); first += 3) {
    const auto three = [&](const Eigen::ArrayXd& all) {
      const Eigen::Index last = table.bands() - 1;
      return gonio::rgb(all[first], all[std::min(first + 1, last)], all[std::min(first + 2, last)]);
    };
    random_parameters here = drawn;
    here.base.albedo = three(base);
    here.second.f0 = three(second);
    here.tint = three(tint);
    const gonio::brdf_table values = tabulate_parameters(here, cells, threads);
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
      for (Eigen::Index band = first; band < std::min(first + 3, table.bands()); ++band)
        table.values()(cell, band) = values.values()[3 * cell + band - first];
  }
  return table;
}

}  // namespace papers
