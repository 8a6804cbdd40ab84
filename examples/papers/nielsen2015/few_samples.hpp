#pragma once
/// The experiment of Nielsen et al. 2015, section 6: reconstruct materials that the prior has not seen from a
/// few directions, and compare with their full tables.

#include <gonio/basis/project.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/material_result.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <span>
#include <type_traits>
#include <vector>

namespace gonio {

/// Reconstructs each truth by an estimator from `measure(truth, its number)`, and compares over the truth's cells in
/// the domain of `metric`.
template <estimator Estimator, error_metric Metric, class Measure>
requires std::is_invocable_r_v<sample_set, Measure&, const brdf_table&, std::size_t>
[[nodiscard]] std::vector<material_result> reconstruct_each(const Estimator& estimator, Measure&& measure,
                                                            const material_set& truths, const Metric& metric,
                                                            const appearance_judge& judge, thread_count threads = {}) {
  std::vector<material_result> results;
  for (std::size_t m = 0; m < truths.names.size(); ++m) {
    const brdf_table truth = truths.table(m);
    const brdf_table estimate = estimator.fit(sample_set(measure(truth, m))).tabulate(truths.cells, threads);
    results.push_back({truths.names[m], compare(estimate, truth, metric, judge, threads)});
  }
  return results;
}

/// The same from the cells of its table. A material's defects come from `seed` plus its number.
template <estimator Estimator, error_metric Metric>
[[nodiscard]] std::vector<material_result> reconstruct_from_cells(
    const Estimator& estimator, std::span<const std::size_t> cells, const material_set& truths, const Metric& metric,
    const appearance_judge& judge, thread_count threads = {}, const measurement_defects& defects = {},
    std::uint64_t seed = 0) {
  return reconstruct_each(
      estimator,
      [&](const brdf_table& truth, std::size_t number) { return measure(truth, cells, defects, seed + number); },
      truths, metric, judge, threads);
}

/// The same by a prior with Tikhonov's penalty eta (Eq. 12).
template <basis Basis, error_metric Metric>
[[nodiscard]] std::vector<material_result> reconstruct_from_cells(
    const Basis& prior, double eta, std::span<const std::size_t> cells, const material_set& truths,
    const Metric& metric, const appearance_judge& judge, thread_count threads = {},
    const measurement_defects& defects = {}, std::uint64_t seed = 0) {
  return reconstruct_from_cells(decomposition{prior, tikhonov{eta}}, cells, truths, metric, judge, threads, defects,
                                seed);
}

/// The same without defects, at the cells nearest to `directions`.
template <basis Basis, error_metric Metric>
[[nodiscard]] std::vector<material_result> reconstruct_from_directions(const Basis& prior, double eta,
                                                                       std::span<const half_difference> directions,
                                                                       const material_set& truths, const Metric& metric,
                                                                       const appearance_judge& judge,
                                                                       thread_count threads = {}) {
  return reconstruct_from_cells(prior, eta, cells_at(truths.cells, directions), truths, metric, judge, threads);
}

/// The lower bound: each truth projected on the prior's components. Prior and truths must share their cells.
template <error_metric Metric>
[[nodiscard]] std::vector<material_result> project_on(const pca<Metric>& prior, const material_set& truths,
                                                      const appearance_judge& judge, thread_count threads = {}) {
  std::vector<material_result> results;
  for (std::size_t m = 0; m < truths.names.size(); ++m) {
    const brdf_table truth = truths.table(m);
    solution projected;
    projected.weights = project(prior, truth, threads);
    const brdf_table estimate = fitted_brdf(prior, std::move(projected)).tabulate(truths.cells, threads);
    results.push_back({truths.names[m], compare(estimate, truth, prior.metric(), judge, threads)});
  }
  return results;
}

}  // namespace gonio
