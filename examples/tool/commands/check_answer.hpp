#pragma once
/// The answer of `gonio check`: a verdict in few lines, a table of several parts, or JSON.

#include "tool/files/json.hpp"
#include <gonio/conformity/conformity.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cli {

/// The samples of a file that have nonzero weight.
struct measured_surface {
  std::string name;  ///< of the file
  std::vector<gonio::sample_directions> counting;
  std::vector<Eigen::Index> numbers;  ///< of the samples in the file, from 1
  std::vector<std::size_t> lines;     ///< of the samples in the file, from 1; empty if the format has no lines
  gonio::located_samples located;     ///< on the prior's cells
  json facts;                         ///< the file's statements about the samples
};

/// The options for all parts.
struct check_question {
  double false_alarms = 0.01;
  bool is_verbose = false;
};

/// A part and the result of its comparison.
struct checked_part {
  const measured_surface& part;
  const measured_surface& reference;
  gonio::conformity_options options;
  gonio::conformity found;
  gonio::familiarity familiarity;
  bool conforms = true;
};

/// Prints GO or NO-GO, the worst direction, the shift of all directions, and the limitations of the answer. Prints at
/// most five lines unless `is_verbose`.
void print_verdict(const check_question& question, const checked_part& checked);

/// Prints a table with a row for each part, then the limitations of each answer.
void print_table(const check_question& question, const std::vector<checked_part>& parts);

/// Returns the whole answer, as `gonio check --json` prints it.
[[nodiscard]] json as_json(const check_question& question, const checked_part& checked);

}  // namespace cli
