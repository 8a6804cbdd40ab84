/// gonio evaluate: the published experiments, and the prior on real measurements.

#include "evaluate.hpp"

#include "command.hpp"
#include "inputs.hpp"

namespace cli {

void add_evaluate(CLI::App& app) {
  auto* command = app.add_subcommand("evaluate", "Run an experiment and print its table");
  command->require_subcommand(1);
  add_nielsen_test_materials(*command);
  add_measured_materials(*command);
  add_linear_combination(*command);
  add_noell_tables(*command);
  add_noell_measured(*command);
  add_noell_corrections(*command);
  add_directions(*command);
  add_directions_measured(*command);
  add_figures(*command);
  add_soft_specular(*command);
  add_eta(*command);
  add_models(*command);
  add_model_properties(*command);
  add_model_recovery(*command);
  add_laboratory(*command);
  add_importance_sampling(*command);
}

}  // namespace cli
