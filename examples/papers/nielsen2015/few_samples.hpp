#pragma once
/// The experiment of Nielsen et al. 2015, section 6: reconstructs materials that the prior has not seen from a few
/// directions, and compares them with their full tables.

#include "papers/material_result.hpp"
#include <gonio/basis/project.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/table/material_set.hpp>

#include <span>
#include <type_traits>
#include <vector>

namespace papers {

/// Reconstructs each truth, a material's full table, from the samples that `measure(truth, its number)` returns.
/// Compares the result with the truth at the truth's cells, mapped by `metric`.
template <gonio::estimator Estimator, gonio::error_metric Metric, class Measure>
requires std::is_invocable_r_v<gonio::sample_set, Measure&, const gonio::brdf_table&, std::size_t>
[[nodiscard]] std::vector<material_result> reconstruct_each(const Estimator& estimator, Measure&& measure,
                                                            const gonio::material_set& truths, const Metric& metric,
                                                            const gonio::appearance_metric& appearance,
                                                            gonio::thread_count threads = {}) {
  std::vector<material_result> results;
  for (std::size_t m = 0; m < truths.names.size(); ++m) {
    const gonio::brdf_table truth = truths.table(m);
    const gonio::brdf_table estimate =
        estimator.fit(gonio::sample_set(measure(truth, m))).tabulate(truths.cells, threads);
    results.push_back({truths.names[m], gonio::compare(estimate, truth, metric, appearance, threads)});
  }
  return results;
}

/// Reconstructs each truth from cells of its table. The seed of a material's defects is `seed` plus its number.
template <gonio::estimator Estimator, gonio::error_metric Metric>
[[nodiscard]] std::vector<material_result> reconstruct_from_cells(
    const Estimator& estimator, std::span<const Eigen::Index> cells, const gonio::material_set& truths,
    const Metric& metric, const gonio::appearance_metric& appearance, gonio::thread_count threads = {},
    const gonio::measurement_defects& defects = {}, std::uint64_t seed = 0) {
  return reconstruct_each(
      estimator,
      [&](const gonio::brdf_table& truth, std::size_t number) {
        return gonio::sample_table(truth, cells, defects, seed + number);
      },
      truths, metric, appearance, threads);
}

/// Reconstructs each truth from cells by a prior with Tikhonov's penalty eta (Eq. 12).
template <gonio::basis Basis, gonio::error_metric Metric>
[[nodiscard]] std::vector<material_result> reconstruct_from_cells(
    const Basis& prior, double eta, std::span<const Eigen::Index> cells, const gonio::material_set& truths,
    const Metric& metric, const gonio::appearance_metric& appearance, gonio::thread_count threads = {},
    const gonio::measurement_defects& defects = {}, std::uint64_t seed = 0) {
  return reconstruct_from_cells(gonio::decomposition{prior, gonio::tikhonov{eta}}, cells, truths, metric, appearance,
                                threads, defects, seed);
}

/// Reconstructs each truth without defects, from the cells nearest to `directions`.
template <gonio::basis Basis, gonio::error_metric Metric>
[[nodiscard]] std::vector<material_result> reconstruct_from_directions(
    const Basis& prior, double eta, std::span<const gonio::half_difference> directions,
    const gonio::material_set& truths, const Metric& metric, const gonio::appearance_metric& appearance,
    gonio::thread_count threads = {}) {
  return reconstruct_from_cells(prior, eta, gonio::cells_at(truths.cells, directions), truths, metric, appearance,
                                threads);
}

/// Projects each truth on the prior's components, which gives a lower bound of the error. Prior and truths must share
/// their cells.
template <gonio::error_metric Metric>
[[nodiscard]] std::vector<material_result> project_on(const gonio::pca<Metric>& prior,
                                                      const gonio::material_set& truths,
                                                      const gonio::appearance_metric& appearance,
                                                      gonio::thread_count threads = {}) {
  std::vector<material_result> results;
  for (std::size_t m = 0; m < truths.names.size(); ++m) {
    const gonio::brdf_table truth = truths.table(m);
    Eigen::MatrixXd projected = gonio::project(prior, truth, threads);
    const gonio::brdf_table estimate = gonio::fitted_brdf(prior, std::move(projected)).tabulate(truths.cells, threads);
    results.push_back({truths.names[m], gonio::compare(estimate, truth, prior.metric(), appearance, threads)});
  }
  return results;
}

}  // namespace papers
