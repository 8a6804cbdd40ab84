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
  std::optional<int> iterations = {};  ///< the exact number; if empty, the method stops by itself
  std::optional<int> basis = {};       ///< number of other materials to estimate from, drawn by the seed; if empty, all
};

/// Holds the materials, the bases of the methods (each made on first use), and the measures of error.
class noell_experiment {
 public:
  noell_experiment(const std::filesystem::path& networks, const std::filesystem::path& environment,
                   gonio::thread_count threads, const gonio::progress& listener);
  ~noell_experiment();

  [[nodiscard]] const std::vector<std::string>& names() const noexcept;

  [[nodiscard]] const gonio::material_set& materials() const noexcept;

  /// Returns a method's estimate from samples and the other materials that a case draws; from all materials if the case
  /// names no material to leave out.
  [[nodiscard]] gonio::brdf_table estimate(const std::string& method, const noell_case& which,
                                           const gonio::sample_set& samples);

  /// Returns all materials except one under the paper's metric.
  [[nodiscard]] gonio::measured<gonio::log> materials_without(const std::string& material);

  /// Returns the correction functions of all materials except one, by gonio's rule.
  [[nodiscard]] const gonio::correction& corrections_without(const std::string& material);

  /// Measures the material, reconstructs it by a method from the other materials that the case draws, and returns its
  /// errors (`noell_measures::judge`) and the seconds of the fit.
  [[nodiscard]] json run(const std::string& method, const noell_case& which);

  /// Prepares cases with the same share of data and seed, which makes `run` faster for them: their radial basis
  /// functions share the normal equations.
  void prepare(const std::string& method, std::span<const noell_case> cases);

  /// Returns the number of cells to measure, at least 1. `data` is a share of them or, above 1, a number.
  [[nodiscard]] static Eigen::Index samples_of(double data, Eigen::Index cells) noexcept;

  /// Returns whether a method corrects its estimate iteratively.
  [[nodiscard]] static bool iterates(const std::string& method);

  /// Returns whether a method combines other materials.
  [[nodiscard]] static bool combines(const std::string& method);

  /// Returns the error in the name of a method; empty if there is none.
  [[nodiscard]] static std::string complaint(const std::string& method);

  /// Returns the paper's result for a method in a setting, if it is printed.
  [[nodiscard]] static std::optional<double> published(const std::string& method, double data_ratio,
                                                       double outlier_ratio);

 private:
  struct parts;
  std::unique_ptr<parts> parts_;
};

}  // namespace papers
