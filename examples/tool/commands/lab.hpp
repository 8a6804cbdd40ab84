#pragma once
/// The steps of `gonio lab`, one file each.

#include "tool/options/command.hpp"

namespace cli {

void add_lab_plan(command& lab);
void add_lab_scan(command& lab);
void add_lab_replay(command& lab);
void add_lab_calibrate(command& lab);
void add_lab_probe(command& lab);
void add_lab_unwrap(command& lab);
void add_lab_photograph(command& lab);
void add_lab_merge(command& lab);

}  // namespace cli
