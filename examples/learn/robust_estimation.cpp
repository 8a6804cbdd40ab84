/// 2000 measurements, a fifth of them wrong: a least-squares fit follows the outliers, a robust reconstruction does
/// not.

#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/robust/robust_reconstruction.hpp>
#include <gonio/solve/nnls.hpp>

#include <cstdio>

int main() {
  // Fewer cells than the prior's, so that this program takes only seconds.
  const gonio::valid_cells cells(gonio::grid({45, 15, 18}));
  const auto prior = gonio::thin(gonio::io::read_prior("materials.prior"), cells);
  const gonio::measured materials{gonio::expand(prior), gonio::log{}};

  const gonio::brdf_table truth = gonio::tabulate(gonio::model::formula_material("red-paint"), cells);
  const auto measured_cells = gonio::random_cells(cells, 2000, 1);
  const gonio::sample_set samples =
      gonio::sample_table(truth, measured_cells, {.outlier_ratio = 0.2, .noise = 0.02}, 1);

  const gonio::appearance_metric appearance(cells);
  const auto show = [&](const char* name, const gonio::brdf_table& estimate) {
    const gonio::comparison off = gonio::compare(estimate, truth, prior.metric(), appearance);
    std::printf("%-24s mapped rms %.3f, Delta E %.2f, peak %.2f of the truth's\n", name, off.mapped_rms.mean(),
                off.delta_e_env, off.peak_ratio.mean());
  };
  show("NNLS", gonio::decomposition{materials, gonio::nnls{}}.fit(samples).tabulate(cells));

  auto run = gonio::robust_reconstruction{materials}.initialise(samples);
  while (!run.converged()) run.step();
  show("robust reconstruction", run.result().tabulate(cells));
  std::printf("%zu rounds\n", run.history().size());
}
