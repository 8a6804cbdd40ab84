/// Why 20 measurements are enough: 137 materials vary in few ways, and each measurement informs about all of them.

#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <cstdio>

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const gonio::valid_cells cells(gonio::grid({90, 30, 36}));
  const gonio::appearance_metric appearance(cells);

  // How much of the variance between the materials is in the first components?
  const Eigen::ArrayXd squares = prior.singular_values().array().square();
  for (const Eigen::Index first : {1, 5, 20})
    std::printf("the first %2td of %td components: %.1f %% of the variance\n", first, prior.size(),
                100.0 * prior.explained_variance() * squares.head(first).sum() / squares.sum());

  // Measure two materials that are in no database, in 1 to 20 directions.
  std::printf("Delta E of a sphere\n%-12s %8s %8s\n", "measurements", "paint", "rubber");
  for (const Eigen::Index count : {1, 2, 5, 10, 20}) {
    std::printf("%-12td", count);
    for (const char* name : {"red-paint", "blue-rubber"}) {
      const auto truth = gonio::model::formula_material(name);
      gonio::sample_set samples;
      for (const gonio::half_difference& angles : gonio::design::nielsen_directions(count)) {
        const auto [wi, wo] = gonio::to_directions(angles);
        samples.push_back({angles, truth(wi, wo)});
      }
      const auto fit = gonio::decomposition{prior, gonio::tikhonov{5.0}}.fit(samples);
      const auto off = gonio::compare(fit.tabulate(cells), gonio::tabulate(truth, cells), prior.metric(), appearance);
      std::printf(" %8.2f", off.delta_e_env);
    }
    std::printf("\n");
  }
}
