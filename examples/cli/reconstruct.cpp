/// gonio reconstruct: samples in, a table over all directions out.

#include "command.hpp"
#include "inputs.hpp"
#include "pictures.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct reconstruct_options {
  std::filesystem::path samples, prior, output, picture;
  std::string method = "pca";
  double eta = 40.0;
  bool print_json = false;
  gonio::thread_count threads;
};

void describe(const gonio::solution& found, std::size_t samples, bool print_json) {
  const gonio::rgb residual = found.residual.array() / std::sqrt(static_cast<double>(samples));
  if (print_json) {
    std::cout << json{{"samples", samples},
                      {"mapped_residual_rms", per_channel(residual)},
                      {"certificate", per_channel(found.certificate.array())}}
                     .dump(2)
              << '\n';
    return;
  }
  std::cout << samples << " samples, residual in the mapped domain (rms) " << fixed(residual.x(), 3) << ' '
            << fixed(residual.y(), 3) << ' ' << fixed(residual.z(), 3) << '\n';
}

void reconstruct(const reconstruct_options& options) {
  const auto samples = gonio::io::read_samples(options.samples);
  const auto prior = gonio::io::read_prior(options.prior);
  const auto fit = gonio::decomposition{prior, gonio::tikhonov{options.eta}}.fit(samples);
  const auto table = fit.tabulate(gonio::valid_cells(), options.threads);
  if (!options.output.empty()) gonio::io::write_merl(options.output, table);
  if (!options.picture.empty()) gonio::io::write_png(options.picture, sphere_picture(table, options.threads));
  describe(fit.found(), samples.size(), options.print_json);
}

}  // namespace

void add_reconstruct(CLI::App& app) {
  auto* command = app.add_subcommand("reconstruct", "Complete a BRDF from samples");
  const auto options = std::make_shared<reconstruct_options>();
  command->add_option("samples", options->samples, "Measurements (.csv)")->required();
  add_prior_option(*command, options->prior);
  command
      ->add_option("--method", options->method,
                   "pca: principal components with Tikhonov's penalty (Nielsen et al. 2015)")
      ->check(CLI::IsMember({"pca"}))
      ->capture_default_str();
  command->add_option("--eta", options->eta, "Penalty: the larger, the nearer to the mean material")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Table to write (.binary)");
  command->add_option("--image", options->picture, "Picture of a sphere to write (.png)");
  command->add_flag("--json", options->print_json, "Print the result of the fit as JSON");
  add_threads_option(*command, options->threads);
  command->callback([options] { reconstruct(*options); });
}

}  // namespace cli
