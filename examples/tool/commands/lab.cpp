/// gonio lab: from directions to samples, step by step, in a simulated laboratory or with recorded frames.

#include "lab.hpp"

#include "commands.hpp"

namespace cli {

void add_lab(command& app) {
  auto lab = app.add_subcommand(
      "lab", "Plan, scan and calibrate measurements; light probes, photographs (docs/learn/laboratory.md)");
  lab.require_subcommand();
  add_lab_plan(lab);
  add_lab_scan(lab);
  add_lab_replay(lab);
  add_lab_calibrate(lab);
  add_lab_probe(lab);
  add_lab_unwrap(lab);
  add_lab_photograph(lab);
  add_lab_merge(lab);
}

}  // namespace cli
