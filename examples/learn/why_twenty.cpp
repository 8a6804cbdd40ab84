/// Why 20 measurements are enough: 137 materials vary in few ways, and each measurement informs about all of them.

#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>

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

  // Measure two materials that are in no database in the first 1 to 20 directions that gonio design chooses, and
  // reconstruct them as gonio reconstruct does.
  const auto directions = gonio::io::read_direction_pairs("point-20-perceived.csv");
  const gonio::reconstruction estimator{prior};
  std::printf("Delta E of a sphere\n%-12s %8s %8s\n", "measurements", "paint", "rubber");
  for (const std::size_t count : {1, 2, 5, 10, 20}) {
    std::printf("%-12zu", count);
    for (const char* name : {"red-paint", "blue-rubber"}) {
      const auto truth = gonio::model::formula_material(name);
      gonio::sample_set samples;
      for (std::size_t i = 0; i < count; ++i)
        samples.push_back({directions[i], truth(directions[i].wi, directions[i].wo)});
      const auto fit = estimator.fit(samples);
      const auto off = gonio::compare(fit.tabulate(cells), gonio::tabulate(truth, cells), prior.metric(), appearance);
      std::printf(" %8.2f", off.delta_e_env);
    }
    std::printf("\n");
  }
}
