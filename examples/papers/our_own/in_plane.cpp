/// gonio-papers in-plane: how much scans in the plane of incidence, the most common measurements, reveal about the rest
/// of a material, and which further directions help.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/our_own/interval_counts.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/next_measurement.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <optional>

namespace papers {

namespace {

struct in_plane_options : left_out_options {
  std::vector<double> incidences{0, 30, 60};
  double step = 5.0;
  Eigen::Index more = 5;
};

/// The methods: the scans alone, or with further directions. These are in the plane of incidence, anywhere (chosen for
/// the mean material), or anywhere (chosen one by one from the readings so far).
const std::vector<std::string> in_plane_methods{"scans", "more in the plane", "the same anywhere", "adaptive anywhere"};

/// Returns viewing angles every few degrees on both sides of the normal, except where the viewer hides the light.
std::vector<gonio::half_difference> scan_directions(const in_plane_options& given) {
  constexpr double largest = 85.0, hidden = 2.5;
  std::vector<gonio::half_difference> directions;
  for (const double incidence : given.incidences)
    for (double view = incidence > 0.0 ? -largest : given.step; view <= largest + 1e-9; view += given.step) {
      if (std::abs(view - incidence) < hidden) continue;
      const gonio::direction wi = gonio::spherical_direction(gonio::radians(incidence), 0.0),
                             wo = gonio::spherical_direction(gonio::radians(std::abs(view)),
                                                             view < 0.0 ? std::numbers::pi : 0.0);
      directions.push_back(gonio::to_half_difference(wi, wo));
    }
  return directions;
}

using chooser_type = gonio::measurement_chooser<gonio::log_relative>;

class in_plane_experiment : left_out_experiment {
 public:
  in_plane_experiment(const in_plane_options& given, progress_bar& bar)
      : left_out_experiment(given, bar), given_(given) {}

  /// Returns for each method the errors of each material.
  [[nodiscard]] std::map<std::string, json> run() {
    std::map<std::string, json> found;
    for (const judged_material& material : measured_materials(given_.materials, library_))
      for (const std::string& method : in_plane_methods) {
        const json key{"in-plane", method, material.name, given_.components, given_.more, scan_.size()};
        found[method][material.name] = once(key, material.turn, material.name + " " + method, [&] {
          const setup& with = setup_without(material.family);
          return errors_of(material, measured_by(method, material, with), with);
        });
      }
    return found;
  }

  /// Returns the directions to add to the scans if the material is the mean of all materials.
  [[nodiscard]] std::vector<gonio::next_measurement> recommended() {
    const setup& with = setup_without("");
    return with.anywhere.choose(scan_of_mean(with), given_.more);
  }

  [[nodiscard]] Eigen::Index samples() const { return std::ssize(scan_); }

 private:
  struct setup {
    gonio::reconstruction<gonio::log_relative> estimator;
    chooser_type anywhere, within;
  };

  const setup& setup_without(const std::string& family) {
    if (setup_ && family_ == family) return *setup_;
    setup_.reset();
    const auto estimator =
        gonio::reconstruction{library_.prior_without(family, given_.components), {}, given_.threads}.keeping_all();
    gonio::design::apparatus plane;
    plane.constraint.plane_tolerance = gonio::radians(0.5);
    const auto candidates = gonio::design::default_candidates();
    setup_.emplace(setup{estimator, chooser_type{estimator, {}, candidates, given_.threads},
                         chooser_type{estimator, plane, candidates, given_.threads}});
    family_ = family;
    return *setup_;
  }

  [[nodiscard]] gonio::sample_set scan_of_mean(const setup& with) const {
    gonio::sample_set samples;
    for (const gonio::half_difference& angles : scan_) samples.push_back({angles, gonio::rgb::Ones(), 1.0});
    return of_mean_material(samples, with.estimator.prior());
  }

  [[nodiscard]] gonio::sample_set measured_by(const std::string& method, const judged_material& material,
                                              const setup& with) const {
    gonio::sample_set samples = measure(material.measured, scan_, 0.0, 0);
    if (method == "scans") return samples;
    const auto add = [&](const gonio::next_measurement& next) {
      samples.push_back({next.angles, material.measured(gonio::to_directions(next.angles)), 1.0});
    };
    if (method == "the same anywhere") {
      for (const auto& next : with.anywhere.choose(scan_of_mean(with), given_.more)) add(next);
      return samples;
    }
    const chooser_type& chooser = method == "adaptive anywhere" ? with.anywhere : with.within;
    for (Eigen::Index i = 0; i < given_.more; ++i) add(chooser.choose(samples, 1).front());
    return samples;
  }

  json errors_of(const judged_material& material, const gonio::sample_set& samples, const setup& with) const {
    const auto paint = with.estimator.fit(samples);
    const auto table = paint.tabulate(library_.cells());
    const gonio::comparison errors = compare(table, material);
    json all{{"mapped_rms", errors.mapped_rms.mean()},
             {"delta_e_env", errors.delta_e_env},
             {"delta_e_lights", errors.delta_e_lights}};
    const json by_region = errors_by_region(table, material.truth, paint);
    for (const auto& [name, value] : by_region.items()) all[name] = value;
    return all;
  }

  /// Returns mapped errors, stated deviations and the coverage of 95 % intervals, in and out of the plane, over every
  /// 37th cell. A cell is near the plane if its phi_d is within 10 degrees of 0 or 180. It is out of the plane if its
  /// phi_d is at least 30 degrees from both.
  [[nodiscard]] json errors_by_region(const gonio::brdf_table& table, const gonio::brdf_table& truth,
                                      const gonio::reconstruction<gonio::log_relative>::result_type& known) const {
    struct sums {
      double squares = 0.0, within = 0.0, count = 0.0;
      std::vector<double> deviations;
    } near, far;
    for (const Eigen::Index cell : judged_cells(library_.cells())) {
      const gonio::location at = gonio::locate_cell(library_.cells(), cell);
      const double phi_d = gonio::degrees(at.angles.phi_d), from_plane = std::min(phi_d, 180.0 - phi_d);
      if (from_plane > 10.0 && from_plane < 30.0) continue;
      sums& region = from_plane <= 10.0 ? near : far;
      const gonio::rgb value = truth.at(cell).max(0.0), estimate = table.at(cell);
      const auto [low, high] = known.interval(estimate, at, gonio::confidence_level::ninety_five_percent);
      for (Eigen::Index c = 0; c < 3; ++c) {
        const double difference = metric_.forward(estimate[c], at) - metric_.forward(value[c], at);
        region.squares += difference * difference;
      }
      region.within += static_cast<double>((value >= low && value <= high).count());
      region.count += 3.0;
      region.deviations.push_back(known.deviation(at));
    }
    return {{"near_rms", std::sqrt(near.squares / near.count)}, {"far_rms", std::sqrt(far.squares / far.count)},
            {"near_stated", gonio::median(near.deviations)},    {"far_stated", gonio::median(far.deviations)},
            {"near_within", 100.0 * near.within / near.count},  {"far_within", 100.0 * far.within / far.count}};
  }

  const in_plane_options& given_;
  std::vector<gonio::half_difference> scan_ = scan_directions(given_);
  std::string family_;
  std::optional<setup> setup_;
};

void print(const std::map<std::string, json>& found, const std::vector<gonio::next_measurement>& recommended,
           Eigen::Index samples, Eigen::Index more) {
  std::cout << "Means (medians) over " << found.begin()->second.size() << " materials, " << samples
            << " samples in the plane.\n\n| directions | mapped rms | in the plane | out of it | Delta E env | Delta E "
               "lights | stated deviation in the plane, out of it | within 95 %, in the plane, out of it "
               "|\n|---|---|---|---|---|---|---|---|\n";
  for (const std::string& method : in_plane_methods) {
    std::map<std::string, std::vector<double>> values;
    for (const auto& [name, errors] : found.at(method).items())
      for (const auto& [key, value] : errors.items()) values[key].push_back(value.number());
    const auto mean_and_median = [&](const char* key, int digits) {
      const distribution of(values[key]);
      return fixed(of.mean, digits) + " (" + fixed(of.median, digits) + ")";
    };
    const auto mean = [&](const char* key, int digits) { return fixed(distribution(values[key]).mean, digits); };
    std::cout << "| scans" << (method == "scans" ? "" : ", and " + std::to_string(more) + ": " + method) << " | "
              << mean_and_median("mapped_rms", 3) << " | " << mean_and_median("near_rms", 3) << " | "
              << mean_and_median("far_rms", 3) << " | " << mean_and_median("delta_e_env", 2) << " | "
              << mean_and_median("delta_e_lights", 2) << " | " << mean("near_stated", 3) << ", "
              << mean("far_stated", 3) << " | " << mean("near_within", 1) << ", " << mean("far_within", 1) << " |\n";
  }
  std::cout << "\nFor a material that nothing is known of, by the prior of all:\n\n| theta_i | phi_i | theta_o | phi_o "
               "|\n|---|---|---|---|\n";
  for (const gonio::next_measurement& next : recommended) {
    const auto [wi, wo] = next.pose;
    std::cout << "| " << fixed(gonio::degrees(gonio::polar_angle(wi)), 1) << " | 0 | "
              << fixed(gonio::degrees(gonio::polar_angle(wo)), 1) << " | "
              << fixed(std::remainder(gonio::degrees(gonio::azimuth(wo) - gonio::azimuth(wi)), 360.0), 1) << " |\n";
  }
}

}  // namespace

void add_in_plane(command& app, const team& processes) {
  auto command = app.add_subcommand("in-plane", "Scan measured materials in the plane of incidence");
  const auto options = std::make_shared<in_plane_options>();
  add_left_out_options(command, *options);
  command.add_option("--incidences", options->incidences, "Polar angles of the light in degrees").capture_default_str();
  command.add_option("--step", options->step, "Degrees of viewing angle between samples")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--more", options->more, "Number of further directions")
      .check(check::positive_number())
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    progress_bar bar;
    in_plane_experiment work(given, bar);
    const auto found = work.run();
    if (!given.prints()) return;
    const auto recommended = work.recommended();
    bar.wipe();
    print(found, recommended, work.samples(), given.more);
  });
}

}  // namespace papers
