#include "papers/experiments.hpp"

namespace papers {

void add_resumable(command& app, const team& processes) {
  add_noell_tables(app, processes);
  add_noell_gap(app, processes);
  add_directions(app, processes);
  add_directions_measured(app, processes);
  add_models(app, processes);
  add_real_materials(app, processes);
  add_real_fits(app, processes);
  add_model_from_weights(app, processes);
  add_real_methods(app, processes);
  add_design_experiment(app, processes);
  add_in_plane(app, processes);
  add_near_field_photographs(app, processes);
  add_sphere_photograph(app, processes);
}

}  // namespace papers
