/// Finds the five measurements that best distinguish the materials of a prior.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/prior.hpp>

#include <cstdio>

int main() {
  // Every cell is a candidate. Fewer cells than the prior's make the search faster.
  const gonio::valid_cells cells(gonio::grid({45, 15, 18}));
  const auto prior = gonio::thin(gonio::io::read_prior("materials.prior"), cells);
  const gonio::design::expected_error criterion(prior, {.leave_out = true});
  const gonio::design::cell_candidates candidates(prior, criterion);
  const gonio::design::capture_plan greedy = gonio::design::grow_greedily(candidates, 5);
  const gonio::design::capture_plan best = gonio::design::exchange(candidates, greedy);
  const auto published = gonio::cells_at(cells, gonio::design::nielsen_directions(5));
  // Print errors in percent of the error that is expected without any measurement.
  const double nothing = candidates({}) / 100.0;
  std::printf(
      "expected error of five directions: chosen one by one %.1f %%, exchanged %.1f %%, by Nielsen et al. %.1f %%\n",
      greedy.value / nothing, best.value / nothing, candidates(published) / nothing);

  std::printf("theta_i  phi_i  theta_o  phi_o, degrees\n");
  for (const Eigen::Index cell : best.candidates) {
    const auto [wi, wo] = candidates.geometry().centre(cell);
    std::printf("%7.1f %6.1f %8.1f %6.1f\n", gonio::degrees(gonio::polar_angle(wi)), gonio::degrees(gonio::azimuth(wi)),
                gonio::degrees(gonio::polar_angle(wo)), gonio::degrees(gonio::azimuth(wo)));
  }
}
