/// gonio reconstruct: samples in, a table over all directions out.

#include "command.hpp"
#include "inputs.hpp"
#include "pictures.hpp"
#include "progress_bar.hpp"
#include "solver_choice.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct reconstruct_options {
  std::filesystem::path samples, output, picture;
  std::string method = "pca", metric;
  double root = 2.0;
  material_source materials;
  solver_choice solver;
  bool print_json = false;
  gonio::thread_count threads;
};

/// A fit on its way to the user.
struct reconstruction {
  gonio::brdf_table table;
  gonio::solution found;
};

template <class Basis>
reconstruction fit(const Basis& basis, const gonio::any_solver& solver, const gonio::sample_set& samples,
                   gonio::thread_count threads) {
  const auto fitted = gonio::decomposition{basis, solver, threads}.fit(samples);
  return {fitted.tabulate(gonio::valid_cells(), threads), fitted.found()};
}

/// Principal components under the metric that they were learned with.
reconstruction reconstruct_by_components(const reconstruct_options& options, const gonio::sample_set& samples) {
  const auto solver = make_solver(options.solver, {"tikhonov", "40"});
  if (solver.non_negative())
    throw gonio::error("--solver " + options.solver.name +
                       " finds weights >= 0, which mean nothing for principal components, whose signs are arbitrary: "
                       "use tikhonov, lasso, tsvd or ls, or --method linear");
  if (!options.metric.empty() && options.metric != "log-relative")
    throw gonio::error("a prior is learned under the log-relative metric: --metric " + options.metric +
                       " needs --method linear");
  if (!options.materials.is_prior() || !options.materials.exclude.empty())
    throw gonio::error("--networks, --merl and --exclude need --method linear: the components of --prior are fixed");
  return fit(gonio::io::read_prior(options.materials.prior), solver, samples, options.threads);
}

/// The materials themselves under any metric (Noell et al. 2014, section 2.2).
reconstruction reconstruct_by_materials(const reconstruct_options& options, const gonio::sample_set& samples) {
  const auto solver = make_solver(options.solver, {"nnls", "gcv"});
  progress_bar bar;
  auto materials = read_materials(options.materials, options.threads, bar.listener());
  bar.wipe();
  const auto left_out = options.materials.is_prior() ? options.materials.exclude : std::vector<std::string>{};
  const auto under = [&](const auto& metric) {
    const gonio::measured basis{std::move(materials), metric, options.threads};
    return fit(basis.without(left_out), solver, samples, options.threads);
  };
  if (options.metric == "lin") return under(gonio::lin{});
  if (options.metric == "root") return under(gonio::root{options.root});
  if (options.metric == "log-relative") {
    const auto metric = gonio::log_relative::to_median_of(materials, options.threads);
    return under(metric);
  }
  return under(gonio::log{});
}

void describe(const gonio::solution& found, std::size_t samples, bool print_json) {
  const gonio::rgb residual = found.residual.array() / std::sqrt(static_cast<double>(samples));
  gonio::rgb used;
  for (Eigen::Index c = 0; c < 3; ++c) used[c] = static_cast<double>((found.weights.col(c).array() != 0.0).count());
  if (print_json) {
    std::cout << json{{"samples", samples},
                      {"mapped_residual_rms", per_channel(residual)},
                      {"certificate", per_channel(found.certificate.array())},
                      {"non_zero_weights", per_channel(used)},
                      {"iterations", found.iterations}}
                     .dump(2)
              << '\n';
    return;
  }
  std::cout << samples << " samples, residual in the mapped domain (rms) " << fixed(residual.x(), 3) << ' '
            << fixed(residual.y(), 3) << ' ' << fixed(residual.z(), 3) << ", weights that are not zero "
            << fixed(used.x(), 0) << ' ' << fixed(used.y(), 0) << ' ' << fixed(used.z(), 0) << '\n';
}

void reconstruct(const reconstruct_options& options) {
  const auto samples = gonio::io::read_samples(options.samples);
  const auto [table, found] = options.method == "pca" ? reconstruct_by_components(options, samples)
                                                      : reconstruct_by_materials(options, samples);
  if (!options.output.empty()) gonio::io::write_merl(options.output, table);
  if (!options.picture.empty()) gonio::io::write_png(options.picture, sphere_picture(table, options.threads));
  describe(found, samples.size(), options.print_json);
}

}  // namespace

void add_reconstruct(CLI::App& app) {
  auto* command = app.add_subcommand("reconstruct", "Complete a BRDF from samples");
  const auto options = std::make_shared<reconstruct_options>();
  command->add_option("samples", options->samples, "Measurements (.csv)")->required();
  command
      ->add_option("--method", options->method,
                   "pca: principal components (Nielsen et al. 2015); linear: a combination of the materials themselves "
                   "(Noell et al. 2014)")
      ->check(CLI::IsMember({"pca", "linear"}))
      ->capture_default_str();
  add_prior_option(*command, options->materials.prior);
  add_material_options(*command, options->materials);
  command
      ->add_option(
          "--metric", options->metric,
          "Errors of linear are those of the reflectance mapped by: lin, root, log (ln(1 + x), the default) or "
          "log-relative")
      ->check(CLI::IsMember({"lin", "root", "log", "log-relative"}));
  command->add_option("--root", options->root, "Which root --metric root takes")->capture_default_str();
  add_solver_options(*command, options->solver);
  command->add_option("-o,--output", options->output, "Table to write (.binary)");
  command->add_option("--image", options->picture, "Picture of a sphere to write (.png)");
  command->add_flag("--json", options->print_json, "Print the result of the fit as JSON");
  add_threads_option(*command, options->threads);
  command->callback([options] { reconstruct(*options); });
}

}  // namespace cli
