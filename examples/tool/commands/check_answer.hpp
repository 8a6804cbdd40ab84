#pragma once
/// What `gonio check` says: a verdict in few lines, a table of several parts, or JSON.

#include "tool/files/json.hpp"
#include <gonio/conformity/conformity.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cli {

/// The samples of a file that count.
struct measured_surface {
  std::string name;  ///< of the file
  std::vector<gonio::sample_directions> counting;
  std::vector<Eigen::Index> numbers;  ///< in the file, from 1
  std::vector<std::size_t> lines;     ///< in the file, from 1; empty if the format has none
  gonio::located_samples located;     ///< on the prior's cells
  json facts;                         ///< what the file says of them
};

/// What was asked of all parts.
struct check_question {
  double false_alarms = 0.01;
  bool is_verbose = false;
};

/// A part, and what was found.
struct checked_part {
  const measured_surface& part;
  const measured_surface& reference;
  gonio::conformity_options options;
  gonio::conformity found;
  gonio::familiarity familiarity;
  bool conforms = true;
};

/// GO or NO-GO, the worst direction, all directions together, and what limits the answer: at most five lines unless
/// `is_verbose`.
void print_verdict(const check_question& question, const checked_part& checked);

/// A row for each part.
void print_table(const check_question& question, const std::vector<checked_part>& parts);

/// All of it, with the keys that docs/learn/in-plane-scan.md documents.
[[nodiscard]] json as_json(const check_question& question, const checked_part& checked);

}  // namespace cli
