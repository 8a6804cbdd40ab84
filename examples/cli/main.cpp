/// The `gonio` command-line tool.

#include "commands.hpp"

int main(int argc, char** argv) {
  cli::program app("gonio", "gonio completes a BRDF from a few reflectance measurements.", GONIO_VERSION);
  cli::add_learn(app);
  cli::add_expand(app);
  cli::add_design(app);
  cli::add_plan(app);
  cli::add_sample(app);
  cli::add_near_field(app);
  cli::add_sphere(app);
  cli::add_reconstruct(app);
  cli::add_report(app, {argv, argv + argc});
  cli::add_fit(app);
  cli::add_compare(app);
  cli::add_convert(app);
  cli::add_check(app);
  cli::add_render(app);
  cli::add_info(app);
  cli::add_properties(app);
  cli::add_lab(app);
  cli::add_shape(app);
  return app.run(argc, argv);
}
