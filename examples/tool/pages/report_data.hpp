#pragma once
/// What the page of `gonio report` shows, as the JSON that examples/report/report.js reads.

#include "tool/files/json.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <functional>
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
[[nodiscard]] json report_data(const reported_fit& fit);

/// Adds another measurement to what `report_data` returned: its readings, its albedo, and its luminance in the planes
/// of the scans.
void add_measurement(json& report, const std::string& name, const reported_fit& other);

/// A model, what it was fitted to, and what `gonio fit --json` prints.
struct reported_model {
  std::string name;
  std::function<gonio::rgb(const gonio::direction& wi, const gonio::direction& wo)> value;
  const gonio::sample_set& samples;  ///< of a table: some of its values in three planes of incidence
  json details;
  gonio::thread_count threads;
};

/// What the page of it shows, but for its record.
[[nodiscard]] json model_report_data(const reported_model& model);

/// The values of a table in the planes of lights at 15, 45 and 70 degrees, every five degrees of the viewer.
[[nodiscard]] gonio::sample_set in_plane_values(const gonio::brdf_table& table);

/// How well directions are known over theta_h and theta_d, of a reconstruction with its uncertainty.
[[nodiscard]] json known_map(const reconstruction& found);

}  // namespace cli
