#pragma once
/// The content of the page of `gonio report`, as the JSON that examples/report/report.js reads.

#include "tool/files/json.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <functional>
#include <string>
#include <vector>

namespace cli {

/// A fit and its samples.
struct reported_fit {
  const reconstruct_options& options;
  const gonio::io::sample_file& measured;
  const reconstruction& found;     ///< including its uncertainty
  const gonio::brdf_table* truth;  ///< shown for comparison; may be null
};

/// Returns the content of a fit's page: directions in degrees, reflectance in sr^-1, samples numbered from 1;
/// `known_to` is relative, with a probability of 68 %. Of more than `most_residuals` samples, the page shows that many
/// at random and the worst rejected ones.
[[nodiscard]] json report_data(const reported_fit& fit);

/// Adds another measurement to the result of `report_data`: its readings, its albedo, and its luminance in the planes
/// of the scans.
void add_measurement(json& report, const std::string& name, const reported_fit& other);

/// A model, its samples, and the output of `gonio fit --json`.
struct reported_model {
  std::string name;
  std::function<gonio::rgb(const gonio::direction& wi, const gonio::direction& wo)> value;
  const gonio::sample_set& samples;  ///< for a table: some of its values in three planes of incidence
  json details;
  gonio::thread_count threads;
};

/// Returns the content of the model's page, without its record.
[[nodiscard]] json model_report_data(const reported_model& model);

/// Returns the values of a table in the planes of lights at 15, 45 and 70 degrees, every five degrees of the viewer.
[[nodiscard]] gonio::sample_set in_plane_values(const gonio::brdf_table& table);

/// Returns the uncertainty by theta_h and theta_d of a reconstruction that has `uncertainty`.
[[nodiscard]] json known_map(const reconstruction& found);

}  // namespace cli
