#pragma once
/// One reconstruction of the benchmark of Noell et al. 2014: a material, its simulated measurement, a method.

#include "papers/experiments.hpp"
#include "papers/noell2014/noell_tables.hpp"
#include "tool/files/json.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/correction.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace papers {

struct noell_case {
  std::string material;
  double data_ratio = 1.0;  ///< share of the cells; above 1, their number
  double outlier_ratio = 0.0;
  std::uint64_t seed = 1;
  std::optional<int> iterations = {};  ///< exactly as many; or else the method stops by itself
  std::optional<int> basis = {};       ///< how many other materials, drawn by the seed, to estimate from; or else all
};

/// Holds the materials, the bases that methods need (each made when first asked for), and the measures of error.
class noell_experiment {
 public:
  noell_experiment(const std::filesystem::path& networks, const std::filesystem::path& environment,
                   gonio::thread_count threads, const gonio::progress& listener);
  ~noell_experiment();

  [[nodiscard]] const std::vector<std::string>& names() const noexcept;

  /// The materials' tables.
  [[nodiscard]] const gonio::material_set& materials() const noexcept;

  /// The estimate by a method from samples, from the other materials that a case draws; from all if it has no name.
  [[nodiscard]] gonio::brdf_table estimate(const std::string& method, const noell_case& which,
                                           const gonio::sample_set& samples);

  /// All materials but one under the paper's metric.
  [[nodiscard]] gonio::measured<gonio::log> materials_without(const std::string& material);

  /// The correction functions of all materials but one, by gonio's rule.
  [[nodiscard]] const gonio::correction& corrections_without(const std::string& material);

  /// Measures the material, reconstructs it by a method from the other materials that the case draws, and judges
  /// (`noell_measures::judge`); seconds are those of the fit.
  [[nodiscard]] json run(const std::string& method, const noell_case& which);

  /// Does what is done once for cases of the same share of data and seed, which are then quicker: radial basis
  /// functions have their normal equations in common.
  void prepare(const std::string& method, std::span<const noell_case> cases);

  /// How many of the cells are measured, given a share of them or, above 1, a number; at least 1.
  [[nodiscard]] static Eigen::Index samples_of(double data, Eigen::Index cells) noexcept;

  /// Does a method correct its estimate again and again?
  [[nodiscard]] static bool iterates(const std::string& method);

  /// Does a method combine other materials?
  [[nodiscard]] static bool combines(const std::string& method);

  /// What is wrong with the name of a method; empty if nothing is.
  [[nodiscard]] static std::string complaint(const std::string& method);

  /// What the paper prints for a method in a setting, if anything.
  [[nodiscard]] static std::optional<double> published(const std::string& method, double data_ratio,
                                                       double outlier_ratio);

 private:
  struct parts;
  std::unique_ptr<parts> parts_;
};

}  // namespace papers
