#pragma once
/// Base of the experiments that reconstruct measured materials from simulated photographs.

#include "papers/our_own/interval_counts.hpp"
#include "papers/our_own/left_out_families.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/reconstruction.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace papers {

/// A measured material as a BRDF.
struct measured_brdf {
  const reflectance& measured;

  [[nodiscard]] gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return gonio::rgb::Zero();
    return measured({wi, wo});
  }
};

class photograph_experiment : protected left_out_experiment {
 protected:
  using estimator_type = gonio::reconstruction<gonio::log_relative>;

  /// Throws gonio::error if the folder of materials lacks one of `names`; the message has the missing name.
  photograph_experiment(const left_out_options& given, const std::vector<std::string>& names, cli::progress_bar& bar)
      : left_out_experiment(given, bar), given_(given), all_(measured_materials(given.materials, library_)) {
    for (const std::string& name : names) static_cast<void>(material(name));
  }

  [[nodiscard]] const judged_material& material(const std::string& name) const {
    const auto found = std::ranges::find(all_, name, &judged_material::name);
    if (found == all_.end()) gonio::refuse("--names: " + given_.materials.string() + " has no material " + name);
    return *found;
  }

  /// Returns the prior learned without a material's family.
  [[nodiscard]] gonio::log_relative_pca prior_of(const judged_material& of) const {
    return library_.prior_without(of.family, given_.components);
  }
  [[nodiscard]] estimator_type estimator_of(gonio::log_relative_pca prior) const {
    return estimator_type(std::move(prior), gonio::discrepancy_model{}, given_.threads);
  }

  /// Errors of a reconstruction, and how often its intervals hold.
  struct judgement : gonio::comparison {
    interval_counts intervals;
  };

  /// Judges the reconstruction that `gonio reconstruct` makes.
  [[nodiscard]] judgement judged(const estimator_type& estimator, const gonio::sample_set& samples,
                                 const judged_material& of) const {
    const auto known = estimator.fit(samples);
    const gonio::brdf_table table = known.tabulate(library_.cells());
    return {compare(table, of), count_within(known, table, of.truth)};
  }

  /// Returns the median relative error of the samples in green, in their stated directions.
  [[nodiscard]] static double median_error(const gonio::sample_set& samples, const judged_material& of) {
    std::vector<double> relative;
    for (const gonio::sample& s : samples)
      relative.push_back(std::abs(s.value.y() / of.measured(s.directions.pair()).y() - 1.0));
    return gonio::median(std::move(relative));
  }

 private:
  const left_out_options& given_;
  std::vector<judged_material> all_;
};

}  // namespace papers
