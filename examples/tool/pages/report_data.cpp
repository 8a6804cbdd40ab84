#include "report_data.hpp"

#include "fixed.hpp"
#include "images.hpp"
#include "measures_as_json.hpp"
#include "report_page.hpp"
#include "report_readings.hpp"
#include "sample_facts.hpp"
#include "sample_warnings.hpp"
#include "tool/files/measurement_files.hpp"
#include "viewer_table.hpp"
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/text/base64.hpp>
#include <gonio/model/instrument_readings.hpp>
#include <gonio/model/physical_properties.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

namespace cli {

namespace {

using gonio::radians;

/// Rounds to five digits: more are not known, and would lengthen the page.
double five_digits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10.0, 4.0 - std::floor(std::log10(std::abs(value))));
  return std::round(value * unit) / unit;
}

json five_digits(const gonio::rgb& value) {
  return {five_digits(value.x()), five_digits(value.y()), five_digits(value.z())};
}

/// The values of a fit in any directions and, if known, their uncertainty.
struct known_fit {
  using function = std::function<gonio::rgb(const gonio::direction& wi, const gonio::direction& wo)>;
  function value, relative;  ///< `relative`: relative uncertainty; may be empty

  explicit known_fit(function model) : value(std::move(model)) {}
  explicit known_fit(const reconstruction& found)
      : value(gonio::render::horizon_lookup(found.table)),
        relative(gonio::render::horizon_lookup(*found.uncertainty)) {}

  /// Adds the fit and its uncertainty to the description of a pair of directions.
  void describe(const gonio::direction& wi, const gonio::direction& wo, json& told) const {
    told["fit"] = five_digits(gonio::rgb(value(wi, wo).max(0.0)));
    if (relative) told["known_to"] = five_digits(relative(wi, wo).y());
  }
};

/// Returns the data of the interactive viewer: its tables, and the exposure that `gonio render` uses for a sphere under
/// the viewer's first light.
json viewer_of(const reported_fit& fit) {
  const reconstruction& found = fit.found;
  const gonio::render::directional_lighting light({{gonio::direction(1.0, 1.0, 1.0)}});
  const std::array sphere{sphere_image(found.table, {.size = 64, .exposure = {}}, fit.options.threads, light)};
  json shown{{"exposure", five_digits(gonio::render::exposure_of_spheres(sphere))},
             {"table", viewer_table(found.table)},
             {"uncertainty", viewer_uncertainty(*found.uncertainty)}};
  if (fit.truth) shown["truth"] = viewer_table(*fit.truth);
  return shown;
}

std::string sphere_url(const gonio::brdf_table& table, gonio::thread_count threads) {
  const image_options how{.size = 320, .exposure = {}};
  std::array spheres{sphere_image(table, how, threads)};
  expose_spheres(spheres, how);
  return gonio::io::data_url("image/png", gonio::io::write_png(spheres.front(), "the sphere"));
}

/// Returns the viewer's angle from the normal in the plane of incidence, in radians: positive on the side away from the
/// light; NaN if the viewer is more than a degree off the plane.
double in_plane_angle(const gonio::direction_pair& pair) {
  const double azimuth = std::hypot(pair.wi.x(), pair.wi.y()) > 1e-4 ? std::atan2(pair.wi.y(), pair.wi.x()) : 0.0;
  const gonio::direction wo = gonio::turned_about_normal(pair.wo, -azimuth);
  if (std::abs(wo.y()) > std::sin(radians(1.0))) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(-wo.x(), wo.z());
}

/// Returns the samples of the file to show: if there are many, a random choice and the worst rejected ones.
std::vector<Eigen::Index> shown_samples(const reported_fit& fit) {
  const std::vector<Eigen::Index> numbers = gonio::counting_positions(fit.measured.samples);
  if (std::ssize(numbers) <= most_residuals) return numbers;
  std::set<Eigen::Index> some;
  for (const Eigen::Index i : gonio::random_choice(std::ssize(numbers), most_residuals, 0)) some.insert(numbers[i]);
  const auto& worst = fit.found.rejected;
  some.insert(worst.begin(), worst.begin() + std::min(std::ssize(worst), most_residuals / 4));
  return {some.begin(), some.end()};
}

/// Returns the numbers, from 1, of samples that contradict the others.
std::set<Eigen::Index> disagreeing(const reconstruction& found) {
  std::set<Eigen::Index> numbers;
  for (const Eigen::Index i : found.rejected) numbers.insert(i + 1);
  return numbers;
}

/// Returns a sample with its number in the file, and the fit in its directions.
json told_sample(Eigen::Index number, const gonio::sample& sample, const known_fit& known) {
  const auto& [wi, wo] = sample.directions.pair();
  json told{{"sample", number}};
  told.update(angles_as_json(sample.directions));
  told["measured"] = five_digits(sample.value);
  if (const double angle = in_plane_angle({wi, wo}); !std::isnan(angle)) told["in_plane"] = rounded_degrees(angle);
  known.describe(wi, wo, told);
  return told;
}

json samples_of(const reported_fit& fit, const known_fit& known) {
  std::map<Eigen::Index, const gonio::sample_residual*> checked;
  for (const gonio::sample_residual& each : fit.found.residuals) checked[each.number] = &each;
  const std::set<Eigen::Index> off = disagreeing(fit.found);
  json all = json::array();
  for (const Eigen::Index i : shown_samples(fit)) {
    json told = told_sample(i + 1, fit.measured.samples[i], known);
    if (const auto found = checked.find(i); found != checked.end()) {
      told["others"] = five_digits(found->second->predicted);
      told["deviation"] = five_digits(found->second->relative_deviation);
      told["disagreement"] = five_digits(found->second->disagreement);
    }
    told["disagrees"] = off.contains(i + 1);
    all.push_back(std::move(told));
  }
  return all;
}

/// In-plane samples whose lights are less than half a degree apart.
struct in_plane_scan {
  double lowest = 0.0, sum = 0.0;  ///< of theta_i, degrees
  std::vector<json> samples;       ///< the numbers of the samples

  [[nodiscard]] double theta_i() const { return sum / static_cast<double>(samples.size()); }
};

/// Returns the scans with three samples or more, ordered by theta_i; of more than six, the six with most samples.
std::vector<in_plane_scan> find_scans(const json& samples) {
  std::vector<std::pair<double, json>> in_plane;
  for (const json& each : samples.elements())
    if (each.contains("in_plane")) in_plane.emplace_back(each["theta_i"].number(), each["sample"]);
  std::ranges::sort(in_plane, [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second.number()) < std::pair(b.first, b.second.number());
  });
  std::vector<in_plane_scan> all;
  for (const auto& [theta_i, number] : in_plane) {
    if (all.empty() || theta_i >= all.back().lowest + 0.5)
      all.push_back({.lowest = theta_i, .sum = 0.0, .samples = {}});
    all.back().sum += theta_i;
    all.back().samples.push_back(number);
  }
  std::erase_if(all, [](const in_plane_scan& scan) { return scan.samples.size() < 3; });
  std::ranges::sort(all, [](const in_plane_scan& a, const in_plane_scan& b) {
    return std::pair(b.samples.size(), a.lowest) < std::pair(a.samples.size(), b.lowest);
  });
  all.resize(std::min<std::size_t>(all.size(), 6));
  std::ranges::sort(all, {}, &in_plane_scan::lowest);
  return all;
}

/// Returns directions in one plane, from angles to the normal in degrees; the viewer's `angle` is positive on the side
/// away from the light.
gonio::direction_pair in_plane_pair(double theta_i, double angle) {
  return {gonio::spherical_direction(radians(theta_i), 0.0), gonio::spherical_direction(radians(-angle), 0.0)};
}

/// Returns the viewer's angles of all curves: -87 to 87 degrees, every half degree.
std::vector<double> curve_angles() {
  std::vector<double> angles;
  for (int half = -2 * 87; half <= 2 * 87; ++half) angles.push_back(0.5 * half);
  return angles;
}

/// Returns the fit in the plane of incidence, at the viewer's angles of `curve_angles`.
json curve_of(double theta_i, const known_fit& known) {
  json curve = json::array();
  for (const double angle : curve_angles()) {
    json told{{"angle", angle}};
    const auto [wi, wo] = in_plane_pair(theta_i, angle);
    known.describe(wi, wo, told);
    curve.push_back(std::move(told));
  }
  return curve;
}

/// Returns the fit for the lights of all scans, or for three other lights if there are no scans.
json scans_of(const json& samples, const known_fit& known) {
  json all = json::array();
  for (const in_plane_scan& scan : find_scans(samples))
    all.push_back({{"theta_i", std::round(10.0 * scan.theta_i()) / 10.0},
                   {"samples", scan.samples},
                   {"curve", curve_of(scan.theta_i(), known)}});
  if (!all.empty()) return all;
  for (const double theta_i : {15.0, 45.0, 70.0})
    all.push_back({{"theta_i", theta_i}, {"samples", json::array()}, {"curve", curve_of(theta_i, known)}});
  return all;
}

/// Returns the luminance of a fit and of its samples in the plane of incidence, for the light of another file's scan.
/// The samples' theta_i may differ by half a degree.
json luminance_in_plane(double theta_i, const reported_fit& fit, const known_fit& known) {
  json curve = json::array(), samples = json::array();
  for (const double angle : curve_angles()) {
    const auto [wi, wo] = in_plane_pair(theta_i, angle);
    curve.push_back(five_digits(std::max(gonio::luminance(known.value(wi, wo)), 0.0)));
  }
  for (const Eigen::Index i : shown_samples(fit)) {
    const gonio::sample& sample = fit.measured.samples[i];
    const gonio::direction_pair& pair = sample.directions.pair();
    const double angle = in_plane_angle(pair);
    if (std::isnan(angle) || std::abs(gonio::degrees(gonio::polar_angle(pair.wi)) - theta_i) > 0.5) continue;
    samples.push_back({{"sample", i + 1},
                       {"in_plane", rounded_degrees(angle)},
                       {"luminance", five_digits(gonio::luminance(sample.value))}});
  }
  return {{"curve", std::move(curve)}, {"samples", std::move(samples)}};
}

/// Returns the uncertainty by theta_h and theta_d: the median over phi_d, without directions below the horizon. Columns
/// of theta_h are narrower near highlights.
json map_of(const known_fit& known) {
  constexpr int columns = 18, rows = 12, azimuths = 12;
  const auto edge = [](int column) { return 90.0 * column * column / (columns * columns); };
  json all = json::array();
  for (int column = 0; column < columns; ++column)
    for (int row = 0; row < rows; ++row) {
      const double theta_h = 0.5 * (edge(column) + edge(column + 1)), theta_d = 90.0 * (row + 0.5) / rows;
      std::vector<double> found;
      for (int k = 0; k < azimuths; ++k) {
        const double phi_d = (k + 0.5) * std::numbers::pi / azimuths;
        const auto [wi, wo] = gonio::to_directions({radians(theta_h), radians(theta_d), phi_d});
        if (wi.z() > 0.0 && wo.z() > 0.0) found.push_back(known.relative(wi, wo).y());
      }
      if (found.empty()) continue;
      all.push_back({{"theta_h", {five_digits(edge(column)), five_digits(edge(column + 1))}},
                     {"theta_d", {90.0 * row / rows, 90.0 * (row + 1) / rows}},
                     {"known_to", five_digits(gonio::median(found))}});
    }
  return all;
}

/// Returns albedo by angle of incidence; `known_to` is its relative error if all directions are off by their
/// uncertainty at once.
json albedo_of(const known_fit& known) {
  constexpr int bins = 120;
  const auto value = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    return known.value(wi, wo);
  };
  const auto unsure = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    return known.value(wi, wo) * known.relative(wi, wo);
  };
  const auto values = gonio::model::albedo_by_angle(value, bins);
  const auto deviations =
      known.relative ? gonio::model::albedo_by_angle(unsure, bins) : std::vector<gonio::model::albedo_at_angle>();
  json all = json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double albedo = gonio::luminance(values[i].value);
    const bool is_known = albedo > 0.0 && !deviations.empty();
    all.push_back(
        {{"theta_i", rounded_degrees(values[i].theta)},
         {"albedo", five_digits(values[i].value)},
         {"known_to", is_known ? json(five_digits(gonio::luminance(deviations[i].value) / albedo)) : json(nullptr)}});
  }
  return all;
}

/// Returns the numbers of samples that are rejected or weighted less than half, the worst first, at most a dozen.
json worst_of(const reconstruction& found) {
  json numbers = json::array();
  for (const Eigen::Index i : found.rejected)
    if (numbers.size() < 12) numbers.push_back(i + 1);
  return numbers;
}

json warnings_of(const reported_fit& fit) {
  std::vector<std::string> all = doubts_of(fit.measured);
  all.insert(all.end(), fit.found.warnings.begin(), fit.found.warnings.end());
  return all;
}

/// Returns the readings of instruments on the fit, with `known_to`.
json readings_of(const reconstruction& found) {
  json readings = to_json(gonio::model::read_instruments(found.table));
  readings["known_to"] = readings_known_to(found.table, *found.uncertainty);
  return readings;
}

/// Returns the record of the fit without the command.
json record_of_fit(const reported_fit& fit) {
  const auto& [options, measured, found, truth] = fit;
  const gonio::log_relative_pca prior = prior_of(options.materials);
  return record_of(
      {{"Samples", options.samples.string() + ": " + std::to_string(measured.samples.size()) + ", of which " +
                       std::to_string(gonio::counting_positions(measured.samples).size()) + " count"},
       {"Quantity",
        std::string(measured.quantity ? name_of(*measured.quantity) : "brdf") +
            (measured.samples.channels().wavelengths().size() == 1 ? ", at " + measured.samples.channels().name(0)
                                                                   : "")},
       {"Instrument", measured.provenance.instrument},
       {"Date", measured.provenance.date},
       {"Conditions", measured.provenance.conditions},
       {"Prior", options.materials.prior.string() + ": " + std::to_string(prior.size()) + " components of " +
                     std::to_string(prior.names().size()) + " materials"},
       {"Method", "principal components and a discrepancy of variance " + fixed(options.discrepancy, 3) +
                      ", instead of a penalty eta"},
       {"Noise", options.noise ? fixed(100.0 * *options.noise, 2) + " % (stated)" : "not stated"},
       {"Residual", found.sentence}});
}

}  // namespace

json known_map(const reconstruction& found) { return map_of(known_fit(found)); }

gonio::sample_set in_plane_values(const gonio::brdf_table& table) {
  const gonio::render::horizon_lookup value(table);
  gonio::sample_set samples;
  for (const double light : {15.0, 45.0, 70.0})
    for (int viewer = -85; viewer <= 85; viewer += 5) {
      const gonio::direction_pair pair = in_plane_pair(light, viewer);
      samples.push_back({pair, value(pair.wi, pair.wo), 1.0});
    }
  return samples;
}

json model_report_data(const reported_model& model) {
  const known_fit known(model.value);
  const auto seen = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    return model.value(wi, wo);
  };
  const std::vector<Eigen::Index> counting = gonio::counting_positions(model.samples);
  json samples = json::array();
  for (const Eigen::Index i : gonio::random_choice(std::ssize(counting), most_residuals, 0)) {
    json told = told_sample(counting[i] + 1, model.samples[counting[i]], known);
    told["disagrees"] = false;
    samples.push_back(std::move(told));
  }
  json data{{"kind", "fit"},
            {"name", model.name},
            {"count", counting.size()},
            {"sphere", sphere_url(gonio::tabulate(seen, gonio::valid_cells(), model.threads), model.threads)},
            {"readings", to_json(gonio::model::read_instruments(seen))},
            {"details", model.details}};
  data["scans"] = scans_of(samples, known);
  data["samples"] = std::move(samples);
  data["albedo"] = albedo_of(known);
  return data;
}

json report_data(const reported_fit& fit) {
  const known_fit known(fit.found);
  json data{{"kind", "reconstruct"},
            {"name", fit.options.samples.stem().string()},
            {"count", gonio::counting_positions(fit.measured.samples).size()},
            {"sphere", sphere_url(fit.found.table, fit.options.threads)},
            {"viewer", viewer_of(fit)},
            {"details", fit.found.details},
            {"worst", worst_of(fit.found)},
            {"warnings", warnings_of(fit)},
            {"samples", samples_of(fit, known)}};
  data["readings"] = readings_of(fit.found);
  data["scans"] = scans_of(data["samples"], known);
  data["map"] = map_of(known);
  data["albedo"] = albedo_of(known);
  data["record"] = record_of_fit(fit);
  return data;
}

void add_measurement(json& report, const std::string& name, const reported_fit& other) {
  const known_fit known(other.found);
  json scans = json::array();
  for (const json& scan : report["scans"].elements())
    scans.push_back(luminance_in_plane(scan["theta_i"].number(), other, known));
  report["others"].push_back({{"name", name},
                              {"count", gonio::counting_positions(other.measured.samples).size()},
                              {"details", {{"known_to", other.found.details["known_to"]}}},
                              {"readings", readings_of(other.found)},
                              {"scans", std::move(scans)},
                              {"albedo", albedo_of(known)}});
  const json warnings = warnings_of(other);
  for (const json& sentence : warnings.elements()) report["warnings"].push_back(name + ": " + sentence.text());
  report["record"].push_back(json::array(
      {"Beside", other.options.samples.string() + ": " + std::to_string(other.measured.samples.size()) + ", of which " +
                     std::to_string(gonio::counting_positions(other.measured.samples).size()) + " count; " +
                     other.found.sentence}));
}

}  // namespace cli
