/// gonio-papers components: Nielsen et al. 2015, Fig. 3 and 4: the first principal components of the database, for
/// mapped and unmapped reflectance.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/component_figure.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/component_variance.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/metric/lin.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace papers {

namespace {

struct components_options {
  studied_networks networks;
  std::filesystem::path image;
  Eigen::Index count = 5;
  int size = 96;
  bool print_json = false;
  gonio::thread_count threads;
};

/// The largest theta_h of the specular peak, radians.
constexpr double peak = gonio::radians(5.0);

/// The components under one metric: printed results, and images.
struct learned_components {
  std::string label;
  std::vector<double> shares;   ///< each component's share of the variance
  std::vector<double> in_peak;  ///< share of each component's squared values in the specular peak
  gonio::image slices;
};

/// Returns for each component the share of its squared values that lies in the peak.
template <class Metric>
std::vector<double> shares_in_peak(const gonio::pca<Metric>& prior) {
  Eigen::VectorXd inside = Eigen::VectorXd::Zero(prior.size()), all = inside;
  for (Eigen::Index cell = 0; cell < prior.cells().size(); ++cell) {
    const auto row = prior.row(cell);
    const bool is_inside = prior.cells().angles(cell).theta_h <= peak;
    for (Eigen::Index k = 0; k < prior.size(); ++k) {
      const double square = double{row[k]} * row[k];
      all[k] += square;
      if (is_inside) inside[k] += square;
    }
  }
  const Eigen::VectorXd shares = inside.cwiseQuotient(all);
  return {shares.begin(), shares.end()};
}

template <class Metric>
learned_components learn(const components_options& options, gonio::material_set materials, const Metric& metric,
                         const std::string& label, const gonio::progress& listener) {
  const auto prior = gonio::learn_pca(std::move(materials), metric, options.count, options.threads, listener);
  const Eigen::VectorXd shares = gonio::variance_shares(prior);
  learned_components learned{label, {shares.begin(), shares.end()}, shares_in_peak(prior), {}};
  if (!options.image.empty())
    learned.slices = draw_component_slices(prior, prior.size(), options.size, options.threads, label).image;
  return learned;
}

double share_of_cells_in_peak(const gonio::valid_cells& cells) {
  Eigen::Index inside = 0;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
    if (cells.angles(cell).theta_h <= peak) ++inside;
  return static_cast<double>(inside) / static_cast<double>(cells.size());
}

std::string percent(double share) { return fixed(100.0 * share, 1); }

void print(const std::array<learned_components, 2>& both, double cells_in_peak, std::size_t materials) {
  std::cout << "Principal components of " << materials << " materials x 3 channels. In the peak, theta_h up to 5 "
            << "degrees, are " << percent(cells_in_peak) << " % of the cells.\n\n| component |";
  for (const learned_components& one : both)
    std::cout << ' ' << one.label << ": % of the variance | up to here | % of it in the peak |";
  std::cout << "\n|---|---|---|---|---|---|---|\n";
  std::array<double, 2> sums{};
  for (std::size_t k = 0; k < std::min(both[0].shares.size(), both[1].shares.size()); ++k) {
    std::cout << "| " << k + 1;
    for (std::size_t i = 0; i < 2; ++i) {
      sums[i] += both[i].shares[k];
      std::cout << " | " << percent(both[i].shares[k]) << " | " << percent(sums[i]) << " | "
                << percent(both[i].in_peak[k]);
    }
    std::cout << " |\n";
  }
}

void run(const components_options& options) {
  progress_bar bar;
  const auto listener = bar.listener();
  const auto networks = options.networks.read();
  const auto cells = options.networks.cells();
  const auto tabulate = [&] { return gonio::model::tabulate_networks(networks, cells, options.threads, listener); };
  auto materials = tabulate();
  const auto metric = gonio::log_relative::to_median_of(materials, options.threads);
  // Tabulate the materials twice: learning consumes them, so only one copy is in memory.
  auto mapped = learn(options, std::move(materials), metric, "mapped", listener);
  const std::array both{std::move(mapped), learn(options, tabulate(), gonio::lin(), "as it is", listener)};
  bar.wipe();
  if (!options.image.empty())
    gonio::io::write_png(options.image, gonio::render::stacked(std::array{both[0].slices, both[1].slices}));
  const double cells_in_peak = share_of_cells_in_peak(cells);
  if (!options.print_json) return print(both, cells_in_peak, networks.names.size());
  json result{{"materials", networks.names.size()}, {"cells_in_peak", cells_in_peak}};
  for (const learned_components& one : both)
    result[one.label] = json{{"shares_of_variance", one.shares}, {"shares_in_peak", one.in_peak}};
  std::cout << result.dump(2) << '\n';
}

}  // namespace

void add_components(command& app) {
  auto command = app.add_subcommand("components",
                                    "The first principal components with and without mapping: their shares of the "
                                    "variance, and where it lies (Nielsen 2015)");
  const auto options = std::make_shared<components_options>();
  add_networks_option(command, options->networks);
  command.add_option("--count", options->count, "Number of components")
      .check(check::positive_number())
      .capture_default_str();
  command.add_output("--image", options->image, {".png"},
                     "Image to write (.png) of slices at phi_d = 90 degrees. Above: the reference BRDF and the mapped "
                     "components. Below: the mean and the components without mapping. A component's slice shows what "
                     "one standard deviation adds, from blue (less) over white to red (more)");
  command.add_option("--size", options->size, "Rows and columns of each slice")
      .check(check::range(8, 1024))
      .capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
