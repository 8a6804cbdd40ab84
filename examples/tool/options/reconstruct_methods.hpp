#pragma once
/// The methods of `gonio reconstruct`, one function each, and their common parts.

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
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/render/image.hpp>
#include <gonio/robust/corrected_brdf.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/table/spectral_table.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cli {

struct reconstruct_options {
  std::filesystem::path samples, output, image, history, iteration_figure, truth;
  measurement_options reading;
  gonio::io::sample_provenance provenance = {};  ///< of the samples; written above the residuals
  std::string method = "pca", metric, gamma = "auto";
  double root = 2.0, angular_error = 0.0;
  std::optional<double> noise;
  double discrepancy = 0.02;
  bool keeps_all = false;
  std::filesystem::path residuals, uncertainty, uncertainty_image;
  page_option report;
  bool keeps_uncertainty = false;  ///< keep the uncertainty in the result, not only in files
  bool keeps_residuals = false;    ///< keep the residuals in the result, too; needs at most `most_residuals` samples
  bool fits_spectra = false;       ///< fit each wavelength instead of colours
  bool has_own_options = false;    ///< an option of the method's own was given
  bool as_printed = false;         ///< correction as printed in Noell et al. 2014
  int iterations = 10;
  std::uint64_t seed = 0;
  Eigen::Index neighbours = gonio::scattered_options{}.neighbours;
  material_source materials;
  solver_choice solver;
  bool print_json = false;
  double albedo_tolerance = gonio::model::usual_albedo_tolerance;  ///< for a .bsdf
  gonio::thread_count threads;

  /// Returns whether all outputs can hold spectra, so that no colours are needed.
  [[nodiscard]] bool holds_spectra_alone() const {
    return (output.empty() || lower_extension(output) == ".bsdf") && image.empty() && uncertainty_image.empty() &&
           !report.is_given();
  }
  /// Returns the cells over which spectra are tabulated: for a .bsdf, the basis' own cells, which hold all its
  /// information in a fifteenth of the memory; otherwise the cells of MERL's tables.
  [[nodiscard]] gonio::valid_cells cells_of_spectra(const gonio::valid_cells& of_basis) const {
    return holds_spectra_alone() ? of_basis : gonio::valid_cells();
  }
  [[nodiscard]] bool tells_residuals() const { return keeps_residuals || report.is_given(); }
  [[nodiscard]] bool wants_uncertainty() const {
    return keeps_uncertainty || !uncertainty.empty() || !uncertainty_image.empty() || report.is_given();
  }
};

/// The largest number of samples for which residuals are listed.
inline constexpr Eigen::Index most_residuals = 1000;

/// The result of a method.
struct reconstruction {
  gonio::brdf_table table;
  json details = json::object();                    ///< printed by --json together with the number of samples
  std::string sentence{};                           ///< the details as a sentence for people
  std::vector<std::string> warnings{};              ///< sentences for people, on standard error
  std::optional<gonio::brdf_table> uncertainty{};   ///< relative, if requested
  std::vector<gonio::sample_residual> residuals{};  ///< of the samples with nonzero weight, if requested
  std::vector<Eigen::Index> rejected{};             ///< positions in the file, the worst first; only pca
  std::vector<gonio::correction_round> history{};
  std::optional<gonio::image> iteration_figure{};
  std::optional<gonio::spectral_table> spectra{};  ///< if each wavelength is fitted; `table` has its colours
};

/// Fits principal components under the metric with which they were learned.
[[nodiscard]] reconstruction reconstruct_by_components(const reconstruct_options& options,
                                                       const gonio::sample_set& samples);

/// Fits principal components and a model discrepancy; each sample is weighted by its probability of being an inlier.
[[nodiscard]] reconstruction reconstruct_with_discrepancy(const reconstruct_options& options,
                                                          const gonio::log_relative_pca& prior,
                                                          const gonio::sample_set& samples);

/// Fits only the components, with angular errors of light and viewer. A reconstruction that knows the angular error
/// weights the samples beforehand and gives the uncertainty. Without --noise, the noise is zero: cross-validation would
/// mistake angular errors for noise.
[[nodiscard]] reconstruction reconstruct_misplaced(const reconstruct_options& options,
                                                   const gonio::log_relative_pca& prior,
                                                   const gonio::sample_set& samples);

/// Fits the components of soft or of specular materials, chosen by the samples (Nielsen et al. 2015, section 8).
[[nodiscard]] reconstruction reconstruct_by_soft_or_specular(const reconstruct_options& options,
                                                             const gonio::sample_set& samples);

/// Combines the materials themselves under any metric (Noell et al. 2014, section 2.2).
[[nodiscard]] reconstruction reconstruct_by_materials(const reconstruct_options& options,
                                                      const gonio::sample_set& samples);

/// Combines the materials and corrects the result until it agrees with the inliers (Noell et al. 2014, section 2.4).
[[nodiscard]] reconstruction reconstruct_by_corrections(const reconstruct_options& options,
                                                        const gonio::sample_set& samples);

/// Fits radial basis functions under any metric (Noell et al. 2014, section 3.1).
[[nodiscard]] reconstruction reconstruct_by_radial_functions(const reconstruct_options& options,
                                                             const gonio::sample_set& samples);

/// Interpolates scattered data (Gortler et al. 1996).
[[nodiscard]] reconstruction reconstruct_by_pull_push(const reconstruct_options& options,
                                                      const gonio::sample_set& samples);

/// Averages the samples nearest to each direction.
[[nodiscard]] reconstruction reconstruct_by_neighbours(const reconstruct_options& options,
                                                       const gonio::sample_set& samples);

/// Returns the colours of spectra if wavelengths are not kept; none if the samples are fitted in their own channels.
[[nodiscard]] inline std::optional<gonio::sample_set> colours_to_fit(const reconstruct_options& options,
                                                                     const gonio::sample_set& samples) {
  if (options.fits_spectra || !samples.channels().are_wavelengths()) return std::nullopt;
  return samples.colours();
}

/// Can the method fit each wavelength? Correction cannot: it weights samples by their three colour channels.
[[nodiscard]] inline bool takes_spectra(const std::string& method) { return method != "correction"; }

/// Returns the result of a fit of spectra: the spectra, and a table of their colours.
[[nodiscard]] reconstruction described_spectra(gonio::spectral_table spectra, const reconstruct_options& options);
/// Returns a fit as a table, and as spectra if wavelengths are kept.
template <class Fit>
[[nodiscard]] reconstruction tabulated(const Fit& fitted, const reconstruct_options& options) {
  if constexpr (requires { fitted.tabulate_spectra(gonio::valid_cells(), options.threads); })
    if (options.fits_spectra)
      return described_spectra(
          fitted.tabulate_spectra(options.cells_of_spectra(fitted.functions().cells()), options.threads), options);
  return {fitted.tabulate(gonio::valid_cells(), options.threads)};
}
/// Applies a method for colours to spectra: to three wavelengths at a time, passed as red, green and blue.
[[nodiscard]] reconstruction by_threes(const reconstruct_options& options, const gonio::sample_set& samples,
                                       const std::function<gonio::brdf_table(const gonio::sample_set&)>& complete);
/// Adds the solver's report on a fit of `samples` samples.
void describe_residuals(const gonio::solve_report& report, Eigen::Index samples, reconstruction& result);
/// Returns the channels' numbers as text: "0.1 0.2 0.3"; for more than three channels, "0.1 to 0.3".
[[nodiscard]] std::string in_words(const Eigen::ArrayXd& numbers, int digits);
[[nodiscard]] json listed(const Eigen::ArrayXd& numbers);

/// Returns the chosen metric, log by default; `relative()` makes the metric that needs a reference.
template <class Relative>
[[nodiscard]] gonio::any_metric chosen_metric(const reconstruct_options& options, Relative&& relative) {
  if (options.metric == "lin") return gonio::lin();
  if (options.metric == "root") return gonio::root(options.root);
  if (options.metric == "log-relative") return relative();
  return gonio::log();
}

/// Returns the chosen materials without the excluded ones, under the chosen metric.
[[nodiscard]] gonio::measured<gonio::any_metric> chosen_materials(const reconstruct_options& options,
                                                                  const gonio::progress& listener);

}  // namespace cli
