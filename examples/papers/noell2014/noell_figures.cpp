/// gonio-papers noell-figures: draws Fig. 1 to 5 of Noell, Koehler and Stricker 2014.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/noell2014/correction_check.hpp"
#include "papers/noell2014/noell_experiment.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/figure_tiles.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/iteration_figure.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/robust/robust_reconstruction.hpp>

#include <algorithm>
#include <iostream>
#include <memory>

namespace papers {

namespace {

struct figure_options {
  int figure = 3;
  std::filesystem::path networks, environment, table, image;
  std::string material = "specular-red-phenolic";
  double data_ratio = 0.1;
  std::uint64_t seed = 1;
  gonio::thread_count threads;
};

/// The methods that Fig. 3 compares, in its order, and ours.
const std::vector<std::string> all_methods{"lc-lin", "lc", "rbf-lin", "rbf", "pull-push", "our"};

class noell_figures {
 public:
  noell_figures(const figure_options& options, const gonio::progress& listener)
      : options_(options),
        experiment_(options.networks, options.environment, options.threads, listener),
        listener_(listener) {}

  /// Draws the figure and prints its caption.
  void draw() {
    switch (options_.figure) {
      case 1:
        return draw_overview();
      case 2:
        return draw_corrections();
      case 3:
        return draw_methods();
      case 4:
        return draw_iteration();
      default:
        return draw_measured();
    }
  }

 private:
  /// Fig. 1: random cells with theta_h of at least 12 degrees, 20 % of them with another cell's value.
  void draw_overview() {
    const gonio::brdf_table truth = truth_of_material();
    std::vector<Eigen::Index> cells = random_cells_of(truth.cells());
    std::erase_if(cells, [&](Eigen::Index cell) { return truth.cells().angles(cell).theta_h < gonio::radians(12.0); });
    compare(truth, gonio::sample_table(truth, cells, {.outlier_ratio = 0.2}, options_.seed), options_.material,
            grace());
  }

  /// Fig. 3: random cells, 40 % of them with another cell's value.
  void draw_methods() {
    const gonio::brdf_table truth = truth_of_material();
    compare(truth, measured_share(truth), options_.material, grace());
  }

  /// Fig. 5: a measured table outside the database, under point lights.
  void draw_measured() {
    if (options_.table.empty()) gonio::refuse("--figure 5 needs --table FILE, a measured table");
    const gonio::brdf_table truth =
        gonio::resample(gonio::io::read_merl_any(options_.table), gonio::valid_cells(), options_.threads);
    const auto cells = random_cells_of(truth.cells());
    compare(truth, gonio::sample_table(truth, cells), "",
            {truth.cells(), gonio::render::two_lights(), cells_across_tile, gonio::sphere_delta_e::middle_grey,
             options_.threads});
  }

  /// Columns: the measurements, the truth, each method. Rows: slice, sphere, image of differences.
  void compare(const gonio::brdf_table& truth, const gonio::sample_set& samples, const std::string& left_out,
               gonio::sphere_delta_e delta_e) {
    const sphere_tiles spheres(std::move(delta_e), truth, options_.threads);
    std::vector<std::vector<labelled_tile>> columns{
        {{measurements_tile(samples), "measurements"}},
        {{slice_tile(truth, options_.threads), "truth"}, {spheres.sphere(truth), "truth"}}};
    std::cout << "Columns: measurements (grey: none), truth";
    for (const std::string& method : all_methods) std::cout << ", " << method;
    std::cout << ".\nRows: slice at phi_d = 90 degrees, sphere, its differences (light 0, dark 20 and more).\n\n"
              << "| method | Delta E |\n|---|---|\n";
    for (const std::string& method : all_methods) {
      gonio::report(listener_, method, 0.0);
      const gonio::brdf_table estimate =
          experiment_.estimate(method, {.material = left_out, .data_ratio = options_.data_ratio}, samples);
      auto [image, mean] = spheres.difference(estimate);
      columns.push_back({{slice_tile(estimate, options_.threads), method},
                         {spheres.sphere(estimate), method},
                         {std::move(image), "Delta E " + fixed(mean, 2)}});
      std::cout << "| " << method << " | " << fixed(mean, 2) << " |\n";
    }
    columns.back().push_back(delta_e_scale_tile());
    write(tiles_in_columns(columns));
  }

  /// Fig. 2: eleven correction functions, and the approximation of each by all other functions.
  void draw_corrections() {
    const gonio::correction& functions = experiment_.corrections_without("");
    std::vector<std::vector<labelled_tile>> columns;
    std::cout << "First row: correction functions (blue: a half or less, white: 1, red: 2 or more). Second row: by the "
                 "others, NNLS.\n\n| column | material |\n|---|---|\n";
    const Eigen::Index count = std::ssize(functions.names()), shown = std::min<Eigen::Index>(count, 11);
    for (Eigen::Index column = 0; column < shown; ++column) {
      const Eigen::Index material = column * count / shown;
      Eigen::MatrixXd itself = Eigen::MatrixXd::Zero(functions.size(), 3);
      itself.row(material).setOnes();
      const Eigen::MatrixXd others = weights_of_others(functions, material, gonio::nnls{}, options_.threads);
      columns.push_back(
          {{factor_tile(gonio::fitted_brdf{functions, itself}, options_.threads), functions.names()[material]},
           {factor_tile(gonio::fitted_brdf{functions, others}, options_.threads), "by the others"}});
      std::cout << "| " << columns.size() << " | " << functions.names()[material] << " |\n";
    }
    columns.front().push_back(factor_scale_tile());
    write(tiles_in_columns(columns));
  }

  /// Fig. 4: the effect of the first rounds of our iteration on the measurements of Fig. 3.
  void draw_iteration() {
    const gonio::brdf_table truth = truth_of_material();
    const gonio::sample_set samples = measured_share(truth);
    const gonio::correction& functions = experiment_.corrections_without(options_.material);
    iteration_figure figure(functions, samples, truth, options_.threads);
    const gonio::robust_reconstruction method{
        experiment_.materials_without(options_.material), functions, {.smallest_change = 0.0}, {}, options_.threads};
    auto run = method.initialise(samples);
    figure.look(run);
    while (!run.converged()) {
      run.step();
      figure.look(run);
    }
    const auto [image, differences] = figure.draw();
    std::cout << "Columns: truth and measurements; the combination of materials; factors wanted, found and true; the "
                 "estimate; and so on.\n\n| round | Delta E |\n|---|---|\n";
    for (const auto& [round, mean] : differences) std::cout << "| " << round << " | " << fixed(mean, 2) << " |\n";
    write(image);
  }

  [[nodiscard]] gonio::brdf_table truth_of_material() const {
    return experiment_.materials().table(experiment_.materials().find(options_.material));
  }

  [[nodiscard]] std::vector<Eigen::Index> random_cells_of(const gonio::valid_cells& cells) const {
    return gonio::random_cells(cells, gonio::share_of(cells.size(), options_.data_ratio), options_.seed);
  }

  [[nodiscard]] gonio::sample_set measured_share(const gonio::brdf_table& truth) const {
    return gonio::sample_table(truth, random_cells_of(truth.cells()), {.outlier_ratio = 0.4}, options_.seed);
  }

  /// Returns the measure of Delta E under the paper's light.
  [[nodiscard]] gonio::sphere_delta_e grace() const {
    if (options_.environment.empty()) gonio::refuse("--figure 1 and 3 need --environment FILE, a natural light");
    const gonio::render::environment_map map(gonio::io::read_hdr(options_.environment));
    return {experiment_.materials().cells, gonio::render::environment_lighting(90, 72, map), cells_across_tile,
            gonio::sphere_delta_e::middle_grey, options_.threads};
  }

  void write(const gonio::image& image) const {
    if (!options_.image.empty()) gonio::io::write_png(options_.image, image);
  }

  figure_options options_;
  noell_experiment experiment_;
  gonio::progress listener_;
};

void run_figures(const figure_options& options) {
  progress_bar bar;
  noell_figures figures(options, bar.listener());
  figures.draw();
  bar.wipe();
}

}  // namespace

void add_noell_figures(command& app) {
  auto command = app.add_subcommand("noell-figures", "Draw a figure of Noell et al. 2014");
  const auto options = std::make_shared<figure_options>();
  add_networks_option(command, options->networks);
  command.add_option("--figure", options->figure, "1 to 5").check(check::range(1, 5)).capture_default_str();
  command.add_input("--environment", options->environment, "Latitude-longitude image of a natural light (.hdr)");
  command.add_input("--table", options->table, "The measured table of --figure 5 (MERL's format)");
  command
      .add_option("--material", options->material,
                  "Material of the networks that is measured, except in --figure 2 and 5")
      .capture_default_str();
  command.add_option("--data", options->data_ratio, "Share of the table that is measured")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of cells and outliers").capture_default_str();
  command.add_output("-o,--output", options->image, {".png"}, "The figure");
  add_threads_option(command, options->threads);
  command.callback([options] { run_figures(*options); });
}

}  // namespace papers
