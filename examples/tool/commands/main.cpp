/// The `gonio` command-line tool.

#include "commands.hpp"

#include <string>
#include <vector>

int main(int argc, char** argv) {
  cli::program app("gonio", "gonio completes a BRDF from a few reflectance measurements.", GONIO_VERSION);
  const cli::team alone;
  const std::vector<std::string> words(argv, argv + argc);
  cli::add_learn(app, alone);
  cli::add_expand(app);
  cli::add_design(app, words, alone);
  cli::add_plan(app);
  cli::add_sample(app);
  cli::add_near_field(app);
  cli::add_sphere(app);
  cli::add_reconstruct(app, words);
  cli::add_report(app, words);
  cli::add_svbrdf(app, alone);
  cli::add_texels(app);
  cli::add_fit(app, words);
  cli::add_compare(app);
  cli::add_convert(app);
  cli::add_check(app, words);
  cli::add_render(app);
  cli::add_info(app);
  cli::add_properties(app);
  cli::add_lab(app);
  cli::add_shape(app);
  return app.run(argc, argv);
}
