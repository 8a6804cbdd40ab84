#pragma once
/// What the page of `gonio report` shows, as the JSON that examples/report/report.js reads.

#include "command_line/json.hpp"
#include "command_line/reconstruct_choice.hpp"
#include <gonio/io/samples.hpp>

#include <string>
#include <vector>

namespace cli {

/// A fit, and what it was fitted to.
struct reported_fit {
  const reconstruct_options& options;
  const gonio::io::sample_file& measured;
  const reconstruction& found;     ///< with its uncertainty
  const gonio::brdf_table* truth;  ///< to be shown beside it; may be nothing
};

/// Directions in degrees, reflectances in sr^-1, numbers of samples from 1; "known to" is relative, with a probability
/// of 68 %. Of more than `most_residuals` samples, so many at random are shown, and those that were left out.
/// `words` is the command line, for the record of what was done.
[[nodiscard]] json report_data(const reported_fit& fit, const std::vector<std::string>& words);

/// How well directions are known over theta_h and theta_d, of a reconstruction with its uncertainty.
[[nodiscard]] json known_map(const reconstruction& found);

}  // namespace cli
