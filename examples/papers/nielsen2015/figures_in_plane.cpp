/// Nielsen et al. 2015, Fig. 10: materials that the prior has not seen, reconstructed from 20 directions and compared
/// with a scan in the plane of incidence with the light at 45 degrees.

#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/scattered_errors.hpp"
#include "papers/xu2016/figures.hpp"
#include "tool/files/measurement_files.hpp"
#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace papers::figures {

namespace {

using angles = std::vector<gonio::half_difference>;

constexpr double light_angle = 45.0;

/// A sample, and its viewer's angle in degrees, negative on the light's side.
struct seen_sample {
  double view = 0.0;
  gonio::sample sample;
};

/// A material's name, its samples for each set of directions (by the set's name), and its scan.
struct scanned_material {
  std::string name;
  std::map<std::string, gonio::sample_set> sets;
  std::vector<seen_sample> scan;
};

std::map<std::string, angles> sets_of_directions() {
  std::map<std::string, angles> sets{{"published", gonio::design::nielsen_directions(20)}};
  if (const auto ours = written_points(shipped_directions(), "expected-error", 20)) sets["expected-error"] = *ours;
  return sets;
}

/// Returns a tabulated material. Its samples are the cells nearest to the directions; its scan has steps of one degree.
scanned_material of_table(const std::string& name, const gonio::brdf_table& truth) {
  scanned_material material{name, {}, {}};
  for (const auto& [set, directions] : sets_of_directions())
    material.sets[set] = gonio::sample_table(truth, gonio::cells_at(truth.cells(), directions));
  for (int view = -85; view <= 85; ++view) {
    const gonio::direction wi = gonio::spherical_direction(gonio::radians(light_angle), 0.0),
                           wo = gonio::spherical_direction(gonio::radians(std::abs(view)),
                                                           view < 0 ? 0.0 : std::numbers::pi);
    const angles one{gonio::to_half_difference(wi, wo)};
    const gonio::sample_set seen = gonio::sample_table(truth, gonio::cells_at(truth.cells(), one));
    material.scan.push_back({static_cast<double>(view), *seen.begin()});
  }
  return material;
}

/// Returns a material from scattered measurements. Each direction takes its nearest measurement. The scan takes the
/// measurements in the plane of incidence whose light or, by reciprocity, viewer is within 6 degrees of 45.
scanned_material of_samples(const std::string& name, const gonio::sample_set& all) {
  constexpr double near_the_light = 6.0, in_plane = 1.0;
  scanned_material material{name, {}, {}};
  for (const auto& [set, directions] : sets_of_directions())
    for (const gonio::half_difference& wanted : directions) {
      const auto [wi, wo] = gonio::to_directions(wanted);
      const auto distance = [&](const gonio::sample& sample) {
        const gonio::direction_pair pair = sample.directions.pair();
        return std::min(gonio::angle_between(pair.wi, wi) + gonio::angle_between(pair.wo, wo),
                        gonio::angle_between(pair.wi, wo) + gonio::angle_between(pair.wo, wi));
      };
      material.sets[set].push_back(*std::ranges::min_element(all, {}, distance));
    }
  for (const gonio::sample& sample : all) {
    auto [wi, wo] = sample.directions.pair();
    const auto is_near = [&](const gonio::direction& one) {
      return std::abs(gonio::degrees(gonio::polar_angle(one)) - light_angle) <= near_the_light;
    };
    if (!is_near(wi)) std::swap(wi, wo);
    if (!is_near(wi)) continue;
    const double side = wi.x() * wo.x() + wi.y() * wo.y(), across = wi.x() * wo.y() - wi.y() * wo.x();
    if (std::abs(across) > std::sin(gonio::radians(in_plane))) continue;
    material.scan.push_back({(side > 0.0 ? -1.0 : 1.0) * gonio::degrees(gonio::polar_angle(wo)), sample});
  }
  if (material.scan.empty())
    gonio::refuse("of '" + name + "' no sample is in the plane of incidence with the light near 45 degrees");
  return material;
}

std::vector<scanned_material> materials_of(const options& given) {
  std::vector<scanned_material> materials;
  if (!given.measured_tables.empty())
    for (const auto& [name, path] : gonio::io::list_merl_directory(given.measured_tables))
      materials.push_back(of_table(name, gonio::io::read_merl_any(path)));
  for (const std::filesystem::path& file : given.measured_samples)
    materials.push_back(of_samples(file.stem().string(), read_measurements(file)));
  if (materials.empty()) gonio::refuse("figure 2015-10 needs --tables, --samples or both");
  return materials;
}

/// Returns the errors of a reconstruction on a scan: in all directions, near the mirror direction, in the other
/// directions, and cosine-weighted.
std::vector<json> errors_on(const scanned_material& material, const std::string& set, const gonio::brdf auto& fit) {
  constexpr double highlight = 15.0;  // degrees from the mirror direction
  logarithmic_error all, mirror, others;
  cosine_weighted_error weighted;
  for (const auto& [view, sample] : material.scan) {
    const gonio::direction_pair pair = sample.directions.pair();
    const gonio::rgb estimate = fit(pair.wi, pair.wo);
    all.add(estimate, sample.value);
    (std::abs(view - light_angle) <= highlight ? mirror : others).add(estimate, sample.value);
    weighted.add(estimate, sample.value, pair);
  }
  return {material.name, set, material.scan.size(), all.value(), mirror.value(), others.value(), weighted.value()};
}

}  // namespace

tables nielsen_10(const options& given, const gonio::progress& listener) {
  const std::vector<scanned_material> materials = materials_of(given);
  const laboratory lab = open_laboratory(given, given.networks.read(), listener);  // of all 100
  const gonio::decomposition estimator{lab.prior(), gonio::tikhonov{given.eta}};
  table errors{"From 20 directions: how far the scan is off; mirror: within 15 degrees of the mirror direction",
               {{"material"},
                {"set"},
                {"directions of the scan", 0},
                {"rms of ln(f + 0.001)"},
                {"of it: mirror"},
                {"others"},
                {"cosine-weighted relative error"}}};
  table curves{
      "The curves from the published 20, green: measured / reconstructed, by the viewer's angle in degrees "
      "(negative: the light's side)",
      {{"material"}}};
  for (int view = -75; view <= 75; view += 15) curves.columns.push_back({std::to_string(view)});
  for (const scanned_material& material : materials)
    for (const auto& [set, samples] : material.sets) {
      const auto fit = estimator.fit(samples);
      errors.rows.push_back(errors_on(material, set, fit));
      if (set != "published") continue;
      auto& row = curves.rows.emplace_back(std::vector<json>{material.name});
      for (int view = -75; view <= 75; view += 15) {
        const auto next = std::ranges::min_element(material.scan, {},
                                                   [&](const seen_sample& seen) { return std::abs(seen.view - view); });
        const gonio::direction_pair pair = next->sample.directions.pair();
        std::ostringstream both;
        both.precision(3);
        both << next->sample.value[1] << " / " << fit(pair.wi, pair.wo)[1];
        row.push_back(both.str());
      }
    }
  return {std::move(errors), std::move(curves)};
}

}  // namespace papers::figures
