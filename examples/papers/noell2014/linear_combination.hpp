#pragma once
/// The linear-combination (LC) estimate of Noell, Koehler and Stricker 2014, section 3.1, from full data: each test
/// material as a combination of all other materials.

#include "papers/material_result.hpp"
#include "papers/noell2014/leave_one_out.hpp"
#include <gonio/evaluate/appearance_metric.hpp>

namespace papers {

/// Reconstructs each named material from all other materials, and compares the result with its table in `truths`.
/// `truths` must have the materials of the basis in the same order over the same cells.
template <gonio::error_metric Metric, gonio::normal_solver Solver, gonio::error_metric Judged>
[[nodiscard]] std::vector<material_result> combine_others(
    const papers::leave_one_out_decomposition<Metric, Solver>& others, std::span<const std::string> names,
    const gonio::material_set& truths, const Judged& metric, const gonio::appearance_metric& appearance,
    gonio::thread_count threads = {}) {
  std::vector<material_result> results;
  for (const std::string& name : names) {
    const std::size_t material = truths.find(name);
    const gonio::brdf_table estimate = others.reconstruct(material).tabulate(truths.cells, threads);
    results.push_back({name, gonio::compare(estimate, truths.table(material), metric, appearance, threads)});
  }
  return results;
}

}  // namespace papers
