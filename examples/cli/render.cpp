/// gonio render: pictures of tables, side by side.

#include "command.hpp"
#include "inputs.hpp"
#include "pictures.hpp"

#include <memory>

namespace cli {

namespace {

struct render_options {
  std::vector<std::filesystem::path> tables;
  std::filesystem::path output;
  bool slices = false;
  gonio::thread_count threads;
};

void render(const render_options& options) {
  std::vector<gonio::image> pictures;
  for (const auto& path : options.tables) {
    const auto table = gonio::io::read_merl_any(path);
    pictures.push_back(options.slices ? slice_picture(table, options.threads) : sphere_picture(table, options.threads));
  }
  gonio::io::write_png(options.output, gonio::side_by_side(pictures, 8));
}

}  // namespace

void add_render(CLI::App& app) {
  auto* command = app.add_subcommand("render", "Draw tables as spheres under two lights, or as slices, side by side");
  const auto options = std::make_shared<render_options>();
  command->add_option("tables", options->tables, "Tables (.binary or .binary.gz), left to right")->required();
  command->add_option("-o,--output", options->output, "Picture to write (.png)")->required();
  command->add_flag("--slices", options->slices, "Slices at phi_d = 90 degrees: theta_h to the right, theta_d upwards");
  add_threads_option(*command, options->threads);
  command->callback([options] { render(*options); });
}

}  // namespace cli
