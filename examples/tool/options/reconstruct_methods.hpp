#pragma once
/// The methods of `gonio reconstruct`, one function each, and what they have in common.

#include "materials.hpp"
#include "solver_choice.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/pages/report_page.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/basis/rbf.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/estimate/reconstructed.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/interpolate/scattered_options.hpp>
#include <gonio/metric/any_metric.hpp>
#include <gonio/render/image.hpp>
#include <gonio/robust/corrected_brdf.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/table/spectral_samples.hpp>
#include <gonio/table/spectral_table.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace cli {

struct reconstruct_options {
  std::filesystem::path samples, output, image, history, iteration_figure, truth;
  measurement_options reading;
  gonio::io::sample_provenance provenance = {};  ///< of the samples: stands above the residuals
  std::string method = "pca", metric, gamma = "auto";
  double root = 2.0, angular_error = 0.0;
  std::optional<double> noise;
  double discrepancy = 0.02;
  bool keeps_all = false;
  std::filesystem::path residuals, uncertainty, uncertainty_image;
  page_option report;
  bool keeps_uncertainty = false;  ///< beside those that are written: in the result
  bool keeps_residuals = false;    ///< the same of at most `most_residuals` samples
  bool fits_spectra = false;       ///< each wavelength instead of colours
  bool has_own_options = false;    ///< the method was asked for something beside what all methods have
  bool as_printed = false;         ///< correction as Noell et al. 2014 print it
  int iterations = 10;
  std::uint64_t seed = 0;
  Eigen::Index neighbours = gonio::scattered_options{}.neighbours;
  material_source materials;
  solver_choice solver;
  bool print_json = false;
  gonio::thread_count threads;

  /// Is nothing written that shows colours?
  [[nodiscard]] bool holds_spectra_alone() const {
    return (output.empty() || lower_extension(output) == ".bsdf") && image.empty() && uncertainty_image.empty() &&
           !report.is_given();
  }
  [[nodiscard]] bool tells_residuals() const { return keeps_residuals || report.is_given(); }
  [[nodiscard]] bool wants_uncertainty() const {
    return keeps_uncertainty || !uncertainty.empty() || !uncertainty_image.empty() || report.is_given();
  }
};

/// What all others say of each sample is told of so many.
inline constexpr Eigen::Index most_residuals = 1000;

/// A fit on its way to the user.
struct reconstruction {
  gonio::brdf_table table;
  json details = json::object();                    ///< what --json prints beside the number of samples
  std::string sentence{};                           ///< the same for people
  std::vector<std::string> warnings{};              ///< sentences, for people: on standard error
  std::optional<gonio::brdf_table> uncertainty{};   ///< relative, if it is asked for
  std::vector<gonio::sample_residual> residuals{};  ///< of the samples that count, if it is asked for
  std::vector<Eigen::Index> rejected{};             ///< positions in the file, the worst first: of pca
  std::vector<gonio::correction_round> history{};
  std::optional<gonio::image> iteration_figure{};
  std::optional<gonio::spectral_table> spectra{};  ///< if each wavelength is fitted; `table` is its colours
};

/// Principal components under the metric that they were learned with.
[[nodiscard]] reconstruction reconstruct_by_components(const reconstruct_options& options,
                                                       const gonio::sample_set& samples);

/// What `--method pca` fits, once what it cannot do is refused.
struct component_choice {
  gonio::log_relative_pca prior;
  gonio::any_solver solver;
  bool has_discrepancy = false, is_penalised = false;  ///< the latter: by Tikhonov's eta, which is chosen or given
};
[[nodiscard]] component_choice choose_components(const reconstruct_options& options);

/// Tikhonov's penalty where none is given.
[[nodiscard]] double chosen_eta(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                                const gonio::sample_set& samples);

/// The same components and a discrepancy beside them, without samples that the others contradict; of 100 samples and
/// more, outliers count less.
[[nodiscard]] reconstruction reconstruct_with_discrepancy(const reconstruct_options& options,
                                                          const gonio::log_relative_pca& prior,
                                                          const gonio::sample_set& samples);

/// The same for each wavelength. Which samples disagree is judged by their colours.
[[nodiscard]] reconstruction reconstruct_spectra_with_discrepancy(const reconstruct_options& options,
                                                                  const gonio::log_relative_pca& prior,
                                                                  const gonio::spectral_samples& spectra);

/// The components of soft or of specular materials, whichever the samples choose (Nielsen et al. 2015, section 8).
[[nodiscard]] reconstruction reconstruct_by_soft_or_specular(const reconstruct_options& options,
                                                             const gonio::sample_set& samples);

/// What `--method soft-specular` takes samples for, and the fit.
struct soft_specular_choice {
  gonio::soft_specular_prior prior;
  gonio::soft_specular_penalties penalties;
  gonio::soft_or_specular_fit<gonio::fitted_brdf<gonio::log_relative_pca>, gonio::fitted_brdf<gonio::log_relative_pca>>
      fitted;

  [[nodiscard]] bool is_soft() const noexcept { return fitted.kind() == gonio::material_kind::soft; }
  [[nodiscard]] double eta() const noexcept { return is_soft() ? penalties.soft : penalties.specular; }
  [[nodiscard]] const gonio::log_relative_pca& components() const noexcept {
    return is_soft() ? prior.soft() : prior.specular();
  }
};
[[nodiscard]] soft_specular_choice choose_soft_or_specular(const reconstruct_options& options,
                                                           const gonio::sample_set& samples);
void describe(const soft_specular_choice& choice, reconstruction& result);

/// The materials themselves under any metric (Noell et al. 2014, section 2.2).
[[nodiscard]] reconstruction reconstruct_by_materials(const reconstruct_options& options,
                                                      const gonio::sample_set& samples);

/// A combination of the materials, corrected until it agrees with the samples that are no outliers (Noell et al. 2014,
/// section 2.4).
[[nodiscard]] reconstruction reconstruct_by_corrections(const reconstruct_options& options,
                                                        const gonio::sample_set& samples);

/// Radial basis functions under any metric (Noell et al. 2014, section 3.1).
[[nodiscard]] reconstruction reconstruct_by_radial_functions(const reconstruct_options& options,
                                                             const gonio::sample_set& samples);

/// These functions, and their solver.
[[nodiscard]] gonio::rbf<gonio::any_metric> chosen_radial_functions(const reconstruct_options& options);
inline const gonio::tikhonov radial_solver{1e-6};

/// Scattered-data interpolation (Gortler et al. 1996).
[[nodiscard]] reconstruction reconstruct_by_pull_push(const reconstruct_options& options,
                                                      const gonio::sample_set& samples);

/// The mean of the samples nearest to each direction.
[[nodiscard]] reconstruction reconstruct_by_neighbours(const reconstruct_options& options,
                                                       const gonio::sample_set& samples);

/// Can a method fit each wavelength?
[[nodiscard]] inline bool takes_spectra(const std::string& method) { return method != "correction"; }

/// Each wavelength as a grey material. Throws gonio::error for --method correction, which weighs samples by all three
/// channels of their colours.
[[nodiscard]] reconstruction reconstruct_each_wavelength(const reconstruct_options& options,
                                                         const gonio::spectral_samples& spectra,
                                                         const gonio::sample_set& colours);

/// A fit of spectra, and its colours.
[[nodiscard]] reconstruction described_spectra(gonio::spectral_table spectra, const reconstruct_options& options);
/// What its solver says, of `samples` samples.
void describe_residuals(const gonio::solve_report& report, Eigen::Index samples, reconstruction& result);

/// The metric chosen, log if none is; `relative()` makes the one that needs a reference.
template <class Relative>
[[nodiscard]] gonio::any_metric chosen_metric(const reconstruct_options& options, Relative&& relative) {
  if (options.metric == "lin") return gonio::lin();
  if (options.metric == "root") return gonio::root(options.root);
  if (options.metric == "log-relative") return relative();
  return gonio::log();
}

/// The materials chosen under the metric chosen, without those that are excluded.
[[nodiscard]] gonio::measured<gonio::any_metric> chosen_materials(const reconstruct_options& options,
                                                                  const gonio::progress& listener);

}  // namespace cli
