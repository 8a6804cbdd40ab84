/// `gonio-papers`: the published experiments, and ours on real measurements.

#include "papers/experiments.hpp"
#include "papers/markdown_page.hpp"

int main(int argc, char** argv) {
  cli::program app("gonio-papers", "Run an experiment and print its table", GONIO_VERSION);
  papers::markdown_page page(argc, argv, GONIO_VERSION);
  app.extend_subcommands([&page](cli::command& experiment) { page.add_option(experiment); },
                         [&page](const std::function<void()>& work) { page.around(work); });
  papers::add_nielsen_test_materials(app);
  papers::add_measured_materials(app);
  papers::add_linear_combination(app);
  papers::add_noell_measured(app);
  papers::add_noell_figures(app);
  papers::add_noell_corrections(app);
  papers::add_cosine_weight(app);
  papers::add_figures(app);
  papers::add_soft_specular(app);
  papers::add_components(app);
  papers::add_eta(app);
  papers::add_model_properties(app);
  papers::add_model_recovery(app);
  papers::add_anisotropic(app);
  papers::add_laboratory(app);
  papers::add_importance_sampling(app);
  papers::add_measured_intervals(app);
  papers::add_implausible_samples(app);
  papers::add_conformity(app);
  papers::add_scattered_samples(app);
  papers::add_spectra(app);
  papers::add_shape_poses(app);
  papers::add_shape_fields(app);
  papers::add_shape_causes(app);
  papers::add_svbrdf(app);
  papers::add_streamed_learning(app);
  papers::add_resumable(app, cli::alone());
  papers::add_run(app);
  return app.run(argc, argv);
}
