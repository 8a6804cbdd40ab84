#include "reconstruct_choice.hpp"

#include "tool/files/measurement_files.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/method_record.hpp"
#include "tool/pages/sample_warnings.hpp"
#include <gonio/core/finite.hpp>
#include <gonio/model/physical_properties.hpp>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

namespace cli {

namespace {

const reconstruct_method& method_named(const std::string& name) {
  const auto& all = reconstruct_methods();
  const auto found = std::ranges::find(all, name, [](const reconstruct_method& m) { return std::string_view(m.name); });
  if (found != all.end()) return *found;
  std::string names;
  for (const reconstruct_method& m : all) names += (names.empty() ? "" : ", ") + std::string(m.name);
  gonio::refuse("there is no method '" + name + "': expected one of " + names);
}

/// Refuses a table that is not finite. The error names the file of the samples, which are the cause, not the output.
void require_finite(const gonio::brdf_table& table, const gonio::sample_set& samples,
                    const reconstruct_options& options) {
  if (gonio::all_finite(table.values())) return;
  double largest = 0.0;
  for (const gonio::sample& s : samples) largest = std::max(largest, s.value.abs().maxCoeff());
  std::ostringstream value;
  value << largest;
  const std::string file = options.samples.empty() ? "" : options.samples.native() + ": ";
  gonio::refuse({file, "these samples, up to ", value.str(),
                 " sr^-1, lead to a table that is not finite with --method ", options.method});
}

/// Refuses samples without a positive value if some are negative: nothing can be inferred from them.
void require_light(const gonio::sample_set& samples, const reconstruct_options& options) {
  double largest = 0.0, least = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    for (const double value : samples.values(i)) {
      largest = std::max(largest, value);
      least = std::min(least, value);
    }
  if (largest > 0.0 || !(least < 0.0)) return;
  const std::string file = options.samples.empty() ? "" : options.samples.native() + ": ";
  gonio::refuse({file, "none of ", samples.size(),
                 " samples reflects light, and some are negative: was the subtracted dark signal too large?"});
}

/// Warns of a result that creates energy by far, usually because the quantity is another one: "the result reflects 4.6
/// times the light that arrives at 8 degrees: are the values and --quantity right?". Narrow highlights that few samples
/// determine may exceed 1 by a little.
std::string warning_of_energy(const gonio::brdf_table& table) {
  constexpr double most = 1.5;
  const double albedo = gonio::model::directional_albedo(table, gonio::radians(8.0)).maxCoeff();
  if (!(albedo > most)) return "";
  return "the result reflects " + fixed(albedo, 1) +
         " times the light that arrives at 8 degrees: are the values and --quantity right?";
}

/// Adds the warnings that every method gives; refuses a fit that is not finite.
reconstruction with_warnings(reconstruction result, const reconstruct_options& options,
                             const gonio::sample_set& samples) {
  std::ranges::move(warnings_of(samples, options.noise.value_or(0.0)), std::back_inserter(result.warnings));
  if (std::string sentence = warning_of(options.method, std::ssize(gonio::counting_positions(samples)));
      !sentence.empty())
    result.warnings.push_back(std::move(sentence));
  if (samples.have_apertures() && !result.details.contains("discrepancy"))
    result.warnings.emplace_back("half angles are ignored: they need --method pca with a discrepancy");
  require_finite(result.table, samples, options);
  if (std::string sentence = warning_of_energy(result.table); !sentence.empty())
    result.warnings.push_back(std::move(sentence));
  return result;
}

/// Refuses options of a solver or a metric that is not used.
void require_taken(const reconstruct_options& options, const std::function<bool(const std::string&)>& is_given) {
  const std::string own = options.method == "linear" ? "nnls" : "tikhonov";
  const std::string& solver = options.solver.name.empty() ? own : options.solver.name;
  const auto needs = [&](const char* option, const std::string& needed, bool is_there) {
    if (is_given(option) && !is_there) gonio::refuse({option, " needs ", needed});
  };
  needs("--eta", "--solver tikhonov, not " + solver, solver == "tikhonov");
  needs("--lambda", "--solver lasso, not " + solver, solver == "lasso");
  needs("--variance", "--solver tsvd, not " + solver, solver == "tsvd");
  needs("--root", "--metric root", options.metric == "root");
}

}  // namespace

const std::vector<reconstruct_method>& reconstruct_methods() {
  static const std::vector<reconstruct_method> all{
      {"pca",
       "principal components",
       reconstruct_by_components,
       {"--prior",
        "--networks",
        "--merl",
        "--rgl",
        "--exclude",
        "--metric",
        "--root",
        "--solver",
        "--eta",
        "--noise",
        "--lambda",
        "--variance",
        "--misplaced",
        "--discrepancy",
        "--no-reject",
        "--residuals",
        "--uncertainty",
        "--uncertainty-image",
        "--report",
        "--source-half-angle",
        "--receiver-half-angle"}},  // pca itself refuses some of these options: its messages say why
      {"soft-specular", "pca of a split prior", reconstruct_by_soft_or_specular, {"--prior", "--eta"}},
      {"linear",
       "combination of materials",
       reconstruct_by_materials,
       {"--prior", "--networks", "--merl", "--rgl", "--exclude", "--metric", "--root", "--solver", "--eta", "--lambda",
        "--variance"}},
      {"correction",
       "linear, corrected",
       reconstruct_by_corrections,
       {"--prior", "--networks", "--merl", "--rgl", "--exclude", "--metric", "--root", "--gamma", "--as-printed",
        "--iterations", "--history", "--iteration-figure", "--truth", "--seed"}},
      {"rbf", "radial functions", reconstruct_by_radial_functions, {"--prior", "--metric", "--root", "--seed"}},
      {"pull-push", "interpolation", reconstruct_by_pull_push, {}},
      {"scattered", "nearest samples (docs/reference/estimators.md)", reconstruct_by_neighbours, {"--neighbours"}}};
  return all;
}

void take_given(reconstruct_options& options, const std::function<bool(const std::string&)>& is_given) {
  const reconstruct_method& chosen = method_named(options.method);
  const auto takes = [](const reconstruct_method& m, std::string_view option) {
    return std::ranges::count(m.takes, option) > 0;
  };
  for (const reconstruct_method& other : reconstruct_methods())
    for (const std::string_view option : other.takes) {
      if (!is_given(std::string(option)) || takes(chosen, option)) continue;
      std::string names;
      for (const reconstruct_method& m : reconstruct_methods())
        if (takes(m, option)) names += (names.empty() ? "" : " or ") + std::string(m.name);
      gonio::refuse(std::string(option) + " needs --method " + names + ", not --method " + chosen.name);
    }
  require_taken(options, is_given);
  options.has_own_options = std::ranges::any_of(chosen.takes, [&](std::string_view option) {
    return option != "--prior" && option != "--seed" && is_given(std::string(option));
  });
}

reconstruction reconstruct(const reconstruct_options& options, const gonio::sample_set& samples) {
  if (options.fits_spectra && !takes_spectra(options.method))
    gonio::refuse("--spectra is not available with --method " + options.method +
                  ": it weights samples by their colours");
  require_light(samples, options);
  // The components' method replaces wrong values of spectra before it converts the spectra to colours.
  const auto colours = options.method == "pca" ? std::nullopt : colours_to_fit(options, samples);
  return with_warnings(method_named(options.method).reconstruct(options, colours ? *colours : samples), options,
                       samples.in_three_channels());
}

}  // namespace cli
