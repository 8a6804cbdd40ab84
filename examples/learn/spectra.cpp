/// A spectral measurement: 20 directions at 16 wavelengths. Each wavelength is fitted as a grey material, all in one
/// system. Colours are computed at the end, under any illuminant.

#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <cstdio>

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const auto truth = gonio::model::formula_material("red-paint");  // the sample in the instrument, in RGB:
  std::vector<double> wavelengths;
  for (int nanometres = 400; nanometres <= 700; nanometres += 20) wavelengths.push_back(nanometres);
  const gonio::model::smooth_spectra smooth(wavelengths);  // spectra with these colours

  const auto directions = gonio::io::read_directions("nielsen-20.csv");
  gonio::sample_set measured{gonio::channels(wavelengths)};
  for (const gonio::sample_directions at : directions) measured.add(at, smooth(truth(at.pair().wi, at.pair().wo)));
  gonio::io::write_samples("spectra.csv", measured);  // columns 400nm, 420nm, ...

  const auto paint = gonio::decomposition{prior, gonio::tikhonov{5.0}}.fit(measured);
  const gonio::direction wi = gonio::spherical_direction(0.8, 0.0), wo = gonio::spherical_direction(0.4, 2.0);
  const Eigen::ArrayXd expected = smooth(truth(wi, wo)), found = paint.values(wi, wo);
  for (const Eigen::Index band : {0, 5, 10, 15})
    std::printf("%3.0f nm %8.4f, reconstructed %.4f sr^-1\n", wavelengths[band], expected[band], found[band]);

  const gonio::spectral_table table = paint.tabulate_spectra(gonio::valid_cells());
  const gonio::rgb daylit = table.colours()(wi, wo), lamplit = table.colours(gonio::illuminant::a)(wi, wo);
  std::printf("under D65 %.4f %.4f %.4f\n", daylit.x(), daylit.y(), daylit.z());
  std::printf("under A   %.4f %.4f %.4f\n", lamplit.x(), lamplit.y(), lamplit.z());
  gonio::io::write_rgl("paint.bsdf", gonio::io::tabulate_adaptively(table));  // for spectral renderers
}
