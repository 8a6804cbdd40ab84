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
  double albedo_tolerance = gonio::model::usual_albedo_tolerance;  ///< of a .bsdf
  gonio::thread_count threads;

  /// Is nothing written that shows colours?
  [[nodiscard]] bool holds_spectra_alone() const {
    return (output.empty() || lower_extension(output) == ".bsdf") && image.empty() && uncertainty_image.empty() &&
           !report.is_given();
  }
  /// Over which spectra are tabulated: the basis's own have all that it knows, and take a fifteenth of the memory,
  /// which is enough for a .bsdf; other files have the cells of MERL's tables.
  [[nodiscard]] gonio::valid_cells cells_of_spectra(const gonio::valid_cells& of_basis) const {
    return holds_spectra_alone() ? of_basis : gonio::valid_cells();
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

/// The same components and a discrepancy beside them, of samples that count as much as they are likely to be right.
[[nodiscard]] reconstruction reconstruct_with_discrepancy(const reconstruct_options& options,
                                                          const gonio::log_relative_pca& prior,
                                                          const gonio::sample_set& samples);

/// The components alone, of samples whose light and viewer may be off their directions, without those that a
/// reconstruction rejects, which knows of it; that one says how sure it is. Noise that is not stated is taken for none:
/// cross-validation would take what is misplaced for noise.
[[nodiscard]] reconstruction reconstruct_misplaced(const reconstruct_options& options,
                                                   const gonio::log_relative_pca& prior,
                                                   const gonio::sample_set& samples);

/// The components of soft or of specular materials, whichever the samples choose (Nielsen et al. 2015, section 8).
[[nodiscard]] reconstruction reconstruct_by_soft_or_specular(const reconstruct_options& options,
                                                             const gonio::sample_set& samples);

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

/// Scattered-data interpolation (Gortler et al. 1996).
[[nodiscard]] reconstruction reconstruct_by_pull_push(const reconstruct_options& options,
                                                      const gonio::sample_set& samples);

/// The mean of the samples nearest to each direction.
[[nodiscard]] reconstruction reconstruct_by_neighbours(const reconstruct_options& options,
                                                       const gonio::sample_set& samples);

/// Can a method fit each wavelength? Correction weighs samples by all three channels of their colours.
[[nodiscard]] inline bool takes_spectra(const std::string& method) { return method != "correction"; }

/// A fit of spectra, and its colours.
[[nodiscard]] reconstruction described_spectra(gonio::spectral_table spectra, const reconstruct_options& options);
/// A fit as its table, and its wavelengths if they are kept.
template <class Fit>
[[nodiscard]] reconstruction tabulated(const Fit& fitted, const reconstruct_options& options) {
  if constexpr (requires { fitted.tabulate_spectra(gonio::valid_cells(), options.threads); })
    if (options.fits_spectra)
      return described_spectra(
          fitted.tabulate_spectra(options.cells_of_spectra(fitted.functions().cells()), options.threads), options);
  return {fitted.tabulate(gonio::valid_cells(), options.threads)};
}
/// What a method for colours makes of samples, three wavelengths at a time taking the places of red, green and blue.
[[nodiscard]] reconstruction by_threes(const reconstruct_options& options, const gonio::sample_set& samples,
                                       const std::function<gonio::brdf_table(const gonio::sample_set&)>& complete);
/// What the solver of a fit of `samples` samples says.
void describe_residuals(const gonio::solve_report& report, Eigen::Index samples, reconstruction& result);
/// A number for each channel: "0.1 0.2 0.3", of more than three "0.1 to 0.3".
[[nodiscard]] std::string in_words(const Eigen::ArrayXd& numbers, int digits);
[[nodiscard]] json listed(const Eigen::ArrayXd& numbers);

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
