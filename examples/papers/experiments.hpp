#pragma once
/// The experiments of `gonio-papers`, one file each.

#include "tool/options/command.hpp"
#include "tool/options/team.hpp"

namespace papers {

using namespace cli;  // command-line classes

void add_nielsen_test_materials(command& app);
void add_measured_materials(command& app);
void add_linear_combination(command& app);
void add_noell_measured(command& app);
void add_noell_figures(command& app);
void add_noell_corrections(command& app);
void add_cosine_weight(command& app);
void add_figures(command& app);
void add_soft_specular(command& app);
void add_components(command& app);
void add_eta(command& app);
void add_model_properties(command& app);
void add_model_recovery(command& app);
void add_anisotropic(command& app);
void add_laboratory(command& app);
void add_importance_sampling(command& app);
void add_measured_intervals(command& app);
void add_implausible_samples(command& app);
void add_conformity(command& app);
void add_scattered_samples(command& app);
void add_spectra(command& app);
void add_shape_poses(command& app);
void add_shape_fields(command& app);
void add_shape_causes(command& app);
void add_svbrdf(command& app);
void add_streamed_learning(command& app);
void add_run(command& app);

// Experiments whose results survive an interruption, and which a team of processes may share. `processes` must live
// until the program ends.
void add_noell_tables(command& app, const team& processes);
void add_noell_gap(command& app, const team& processes);
void add_directions(command& app, const team& processes);
void add_directions_measured(command& app, const team& processes);
void add_models(command& app, const team& processes);
void add_real_materials(command& app, const team& processes);
void add_real_fits(command& app, const team& processes);
void add_model_from_weights(command& app, const team& processes);
void add_real_methods(command& app, const team& processes);
void add_design_experiment(command& app, const team& processes);
void add_in_plane(command& app, const team& processes);
void add_near_field_photographs(command& app, const team& processes);
void add_sphere_photograph(command& app, const team& processes);
void add_resumable(command& app, const team& processes);

}  // namespace papers
