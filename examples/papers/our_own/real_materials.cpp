/// gonio-papers real-materials: measured materials, each reconstructed by a prior that has not seen its family.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/highlight_shape.hpp"
#include "papers/our_own/interval_counts.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "papers/our_own/rank_correlation.hpp"
#include "papers/our_own/scan_samplings.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/materials/networks.hpp>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>

namespace papers {

namespace {

struct real_materials_options : left_out_options {
  std::filesystem::path folder = shipped_directions();
  std::string set = "perceived";
  std::vector<Eigen::Index> designed{5, 10, 20}, random{20, 100, 500, 2000};
  std::vector<std::string> methods{"first", "all", "discrepancy", "default"};
  Eigen::Index first_components = 60, repetitions = 2, wrong = 0, wrong_channels = 3, random_materials = 0;
  double noise = 0.0, receiver_half_angle = 0.0, lobe_width = 1.0, wrong_factor = 10.0;
  bool surrogates = false, scans = false;

  [[nodiscard]] gonio::aperture aperture() const { return {0.0, gonio::radians(receiver_half_angle)}; }
};

std::vector<sampling> samplings(const real_materials_options& given) {
  if (given.scans) return scan_samplings();
  std::vector<sampling> all;
  for (const Eigen::Index count : given.designed)
    all.push_back({std::to_string(count) + " designed", {required_points(given.folder, given.set, count)}});
  for (const Eigen::Index count : given.random) all.push_back(random_sampling(count, given.repetitions));
  return all;
}

/// Returns a material with lobes `width` times as wide: scales theta_h by 1 / width at the highlight, and by a factor
/// nearer to 1 farther from it.
judged_material with_lobes(judged_material material, double width) {
  material.measured = [of = material.measured, width](const gonio::direction_pair& pair) {
    gonio::half_difference angles = gonio::to_half_difference(pair.wi, pair.wo);
    angles.theta_h *= 1.0 + (1.0 / width - 1.0) * std::exp(-gonio::degrees(angles.theta_h) / 10.0);
    const gonio::direction_pair moved = gonio::to_directions(angles);
    return of(moved.wi.z() > 0.02 && moved.wo.z() > 0.02 ? moved : pair);
  };
  for (Eigen::Index cell = 0; cell < material.truth.cells().size(); ++cell)
    material.truth.set(cell, material.measured(gonio::to_directions(material.truth.cells().angles(cell))));
  return material;
}

/// Makes some random samples alternately too bright and too dark, in the first channels after a random one. Returns
/// their indices.
std::vector<Eigen::Index> corrupt_some(gonio::sample_set& samples, const real_materials_options& given,
                                       std::uint64_t seed) {
  const std::vector<Eigen::Index> chosen = gonio::random_choice(samples.size(), given.wrong, seed);
  for (Eigen::Index i = 0; i < std::ssize(chosen); ++i)
    for (Eigen::Index c = 0; c < given.wrong_channels; ++c)
      samples[chosen[i]].value[(chosen[i] + c) % 3] *= i % 2 == 0 ? given.wrong_factor : 1.0 / given.wrong_factor;
  return chosen;
}

class experiment : left_out_experiment {
 public:
  experiment(const real_materials_options& given, progress_bar& bar) : left_out_experiment(given, bar), given_(given) {}

  /// Returns a row for each sampling and method with the errors of each material, averaged over the repetitions.
  [[nodiscard]] json run() {
    const std::vector<judged_material> materials = judged();
    json rows = json::array();
    for (const sampling& where : samplings(given_))
      for (const std::string& method : given_.methods) {
        json by_material = json::object();
        for (const judged_material& material : materials) {
          const json key{method,
                         where.name,
                         material.name,
                         given_.components,
                         given_.noise,
                         given_.repetitions,
                         given_.set,
                         given_.surrogates,
                         given_.wrong,
                         given_.receiver_half_angle,
                         "intervals",
                         given_.lobe_width,
                         given_.wrong_factor,
                         given_.wrong_channels,
                         given_.random_materials};
          by_material[material.name] = once(key, material.turn, where.name + " " + method + " " + material.name,
                                            [&] { return errors_of(material, where, method); });
        }
        rows.push_back({{"sampling", where.name}, {"method", method}, {"materials", by_material}});
      }
    return rows;
  }

 private:
  [[nodiscard]] std::vector<judged_material> judged() const {
    std::vector<judged_material> all;
    if (!given_.surrogates) {
      all = measured_materials(given_.materials, library_);
      if (given_.lobe_width != 1.0)
        for (judged_material& each : all) each = with_lobes(std::move(each), given_.lobe_width);
      return all;
    }
    const auto known = gonio::io::read_networks(given_.networks.front());
    for (const std::string& name : gonio::nielsen_test_materials()) {
      const Eigen::Index i = library_.first().find(name);
      const auto measured = [f = known.networks[i]](const gonio::direction_pair& pair) { return f(pair.wi, pair.wo); };
      all.push_back({name, "", library_.first().table(i), measured, all.size(), all.size()});
    }
    return all;
  }

  /// Returns a prior that has not learned a family: of all materials if `everything`, otherwise of the first file of
  /// networks. With --surrogates, it has not learned the ten test materials.
  const gonio::log_relative_pca& prior(bool everything, const std::string& family) {
    const std::string key = everything ? "all " + family : "first";
    if (const auto known = priors_.find(key); known != priors_.end()) return known->second;
    if (everything && !given_.surrogates)
      return priors_.emplace(key, library_.prior_without(family, given_.components, given_.random_materials))
          .first->second;
    const auto& tests = gonio::nielsen_test_materials();
    auto set = library_.materials(everything ? library_.all() : 1, [&](const std::string& name) {
      return given_.surrogates ? std::ranges::find(tests, name) == tests.end() : gonio::material_family(name) != family;
    });
    const auto metric = gonio::log_relative::to_median_of(set, given_.threads);
    const Eigen::Index components = everything ? given_.components : given_.first_components;
    return priors_.emplace(key, gonio::learn_pca(std::move(set), metric, components, given_.threads)).first->second;
  }

  /// Returns the instrument's readings: means over its aperture.
  [[nodiscard]] reflectance reading_of(const judged_material& material) const {
    const gonio::aperture cones = given_.aperture();
    if (cones.is_point()) return material.measured;
    return [of = material.measured, cones](const gonio::direction_pair& axes) {
      const auto value = [&](const gonio::direction& wi, const gonio::direction& wo) { return of({wi, wo}); };
      return gonio::mean_within(axes, cones, gonio::measurement_defects::pairs_a_reading, value);
    };
  }

  /// An estimate, and the samples that it rejects, the worst first.
  struct estimated {
    gonio::brdf_table table;
    std::vector<Eigen::Index> left_out = {};
    interval_counts intervals = {};
    double rank = 0.0;    ///< rank correlation of deviations and errors
    bool warned = false;  ///< whether the highlight is known only to a factor of 4 or worse
  };

  /// Returns the rank correlation of stated deviations and errors at the judged cells.
  [[nodiscard]] double rank_of_deviations(const interval_counts::reconstructed_type& known,
                                          const gonio::brdf_table& table, const gonio::brdf_table& truth,
                                          double judged_from) const {
    std::vector<double> deviations, errors;
    for (const Eigen::Index cell : judged_cells(library_.cells(), judged_from)) {
      const gonio::location at = gonio::locate_cell(library_.cells(), cell);
      const gonio::rgb value = truth.at(cell).max(0.0), estimate = table.at(cell);
      double error = 0.0;
      for (Eigen::Index c = 0; c < 3; ++c)
        error += std::abs(metric_.forward(value[c], at) - metric_.forward(estimate[c], at));
      deviations.push_back(known.deviation(at));
      errors.push_back(error);
    }
    return rank_correlation(deviations, errors);
  }

  /// Returns for each channel whether the highlight is within the gamut. Only then is a ratio of peaks meaningful.
  [[nodiscard]] static std::array<bool, 3> in_gamut(const judged_material& material) {
    std::array<bool, 3> inside{true, true, true};
    for (const double theta_d : {5.0, 25.0, 45.0, 65.0}) {
      const gonio::rgb value = material.measured(gonio::to_directions({0.0, gonio::radians(theta_d), 1.0}));
      for (Eigen::Index c = 0; c < 3; ++c) inside[c] = inside[c] && value[c] > 0.0;
    }
    return inside;
  }

  estimated estimate(const std::string& method, const gonio::sample_set& samples, const judged_material& material,
                     double judged_from) {
    const gonio::log_relative_pca& known = prior(method != "first", material.family);
    if (method == "first" || method == "all") {
      const double eta = given_.noise > 0.0 ? gonio::eta_of_noise(known, samples, given_.noise, given_.threads)
                                            : gonio::eta_of_unknown_noise(known, samples, 0.3, given_.threads);
      const gonio::decomposition components{known, gonio::tikhonov{eta}, given_.threads};
      return {components.fit(samples).tabulate(library_.cells(), given_.threads)};
    }
    const gonio::reconstruction both{known, {.noise = given_.noise}, given_.threads};
    const auto paint = (method == "discrepancy" ? both.keeping_all() : both)
                           .fit(method == "untold" ? samples : samples.through(given_.aperture()));
    estimated found{paint.tabulate(library_.cells()), paint.rejected()};
    found.intervals = count_within(paint, found.table, material.truth, judged_from);
    found.rank = rank_of_deviations(paint, found.table, material.truth, judged_from);
    found.warned = paint.certainty().highlight_factor > 4.0;
    return found;
  }

  json errors_of(const judged_material& material, const sampling& where, const std::string& method) {
    interval_counts intervals;
    double rms = 0.0, environment = 0.0, lights = 0.0, low = 1e300, high = 0.0, named = 0.0, left_out = 0.0;
    double rank = 0.0, peaks_off = 0.0, peaks_off_warned = 0.0, warned = 0.0, dips = 0.0, turning_points = 0.0;
    const std::array<bool, 3> inside = in_gamut(material);
    const auto times = static_cast<double>(where.sets.size());
    for (Eigen::Index r = 0; r < std::ssize(where.sets); ++r) {
      const std::uint64_t seed = 1000 * material.number + r;
      gonio::sample_set samples = measure(reading_of(material), where.sets[r], given_.noise, seed);
      const std::vector<Eigen::Index> wrong = corrupt_some(samples, given_, seed + 100);
      const estimated found = estimate(method, samples, material, where.judged_from);
      const gonio::comparison errors = compare(found.table, material);
      rms += errors.mapped_rms.mean() / times;
      environment += errors.delta_e_env / times;
      lights += errors.delta_e_lights / times;
      const highlight_shape shape = highlight_shape_of(found.table);
      dips += shape.mirror < 0.9 ? 1.0 : 0.0;
      turning_points += shape.turning_points / times;
      bool off = false;
      for (Eigen::Index c = 0; c < 3; ++c) {
        const double ratio = errors.peak_ratio[c];
        if (!inside[c]) continue;
        low = std::min(low, ratio);
        high = std::max(high, ratio);
        off = off || ratio < 0.25 || ratio > 4.0;
      }
      peaks_off += off ? 1.0 : 0.0;
      peaks_off_warned += off && found.warned ? 1.0 : 0.0;
      warned += found.warned ? 1.0 : 0.0;
      rank += found.rank / times;
      intervals.add(found.intervals);
      left_out += static_cast<double>(found.left_out.size()) / times;
      const auto is_first = [&](Eigen::Index i) {
        const auto end = found.left_out.begin() + std::min(std::ssize(found.left_out), std::ssize(wrong));
        return std::find(found.left_out.begin(), end, i) != end;
      };
      named += std::ranges::all_of(wrong, is_first) ? 1.0 / times : 0.0;
    }
    return {{"mapped_rms", rms},
            {"delta_e_env", environment},
            {"delta_e_lights", lights},
            {"least_peak", low},
            {"largest_peak", high},
            {"named", named},
            {"left_out", left_out},
            {"intervals", intervals.to_json()},
            {"rank", rank},
            {"dips", dips},
            {"turning_points", turning_points},
            {"true_turning_points", highlight_shape_of(material.truth).turning_points},
            {"peaks_off", peaks_off},
            {"warned", warned},
            {"peaks_off_warned", peaks_off_warned}};
  }

  const real_materials_options& given_;
  std::map<std::string, gonio::log_relative_pca> priors_;
};

/// Returns the coverage of the 68 and 95 % intervals, and the coverage of 95 % intervals in the worst region.
std::string coverage(const json& materials) {
  interval_counts all;
  for (const auto& [name, errors] : materials.items()) all.add(interval_counts(errors["intervals"]));
  return all.text();
}

void print(const real_materials_options& given, const json& rows) {
  std::cout << "Means (medians) over " << rows[0]["materials"].size() << " materials";
  if (!given.scans) std::cout << ", " << given.repetitions << " random sets each";
  if (given.noise > 0.0) std::cout << ", noise of " << fixed(100.0 * given.noise, 0) << " %";
  if (given.wrong > 0)
    std::cout << ", " << (given.wrong_channels < 3 ? std::to_string(given.wrong_channels) + " of the channels of " : "")
              << counted(given.wrong, "sample") << ' ' << fixed(given.wrong_factor, 0)
              << " times too bright or too dark";
  if (given.random_materials > 0)
    std::cout << ", priors that also learned " << given.random_materials << " random materials";
  if (given.lobe_width != 1.0) std::cout << ", lobes " << fixed(given.lobe_width, 1) << " times as wide";
  if (given.receiver_half_angle > 0.0)
    std::cout << ", a receiver of a half angle of " << fixed(given.receiver_half_angle, 1) << " degrees";
  std::cout
      << ".\n\n| samples | method | mapped rms | Delta E env | Delta E lights | peak, least to largest | peaks beyond "
         "4 times (warned), warned in all | left out | wrong ones first | within 68 % | within 95 % (worst region) | "
         "rank correlation | dips | turning points (of the truth) |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const json& row : rows.elements()) {
    std::map<std::string, std::vector<double>> values;
    for (const auto& [name, errors] : row["materials"].items())
      for (const auto& [key, value] : errors.items())
        if (value.is_number()) values[key].push_back(value.number());
    const auto mean_and_median = [&](const char* key, int digits) {
      const auto found = distribution(values[key]);
      return fixed(found.mean, digits) + " (" + fixed(found.median, digits) + ")";
    };
    const auto total = [&](const char* key) { return std::accumulate(values[key].begin(), values[key].end(), 0.0); };
    std::cout << "| " << row["sampling"].text() << " | " << row["method"].text() << " | "
              << mean_and_median("mapped_rms", 3) << " | " << mean_and_median("delta_e_env", 2) << " | "
              << mean_and_median("delta_e_lights", 2) << " | " << fixed(std::ranges::min(values["least_peak"]), 2)
              << " to " << fixed(std::ranges::max(values["largest_peak"]), 2) << " | " << fixed(total("peaks_off"), 0)
              << " (" << fixed(total("peaks_off_warned"), 0) << "), " << fixed(total("warned"), 0) << " | "
              << fixed(distribution(values["left_out"]).mean, 2) << " | "
              << (given.wrong == 0 ? "-" : fixed(100.0 * distribution(values["named"]).mean, 0) + " %") << " | "
              << coverage(row["materials"]) << " | " << fixed(distribution(values["rank"]).mean, 2) << " | "
              << fixed(total("dips"), 0) << " | " << fixed(distribution(values["turning_points"]).mean, 2) << " ("
              << fixed(distribution(values["true_turning_points"]).mean, 2) << ") |\n";
  }
}

}  // namespace

void add_real_materials(command& app, const team& processes) {
  auto command = app.add_subcommand("real-materials",
                                    "Reconstruct measured materials by priors that have not seen their families");
  const auto options = std::make_shared<real_materials_options>();
  add_left_out_options(command, *options);
  command.add_input_folder("--directions", options->folder, {".csv"}, "Folder of designed sets");
  command.add_option("--set", options->set, "Name of the designed sets: perceived for point-20-perceived.csv")
      .capture_default_str();
  command.add_option("--designed", options->designed, "Numbers of designed directions").capture_default_str();
  command.add_option("--random", options->random, "Numbers of random directions").capture_default_str();
  command
      .add_option("--methods", options->methods,
                  "first: components of the first file of networks; all: components of all networks and of the other "
                  "measured materials; discrepancy: as all, with a discrepancy; default: as discrepancy, without "
                  "samples that contradict the others, as gonio reconstruct does; untold: as default, but without "
                  "knowing the half angle of the receiver")
      .check(check::one_of({"first", "all", "discrepancy", "default", "untold"}))
      .capture_default_str();
  command
      .add_option("--first-components", options->first_components,
                  "Number of components of the prior of the first file")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--wrong", options->wrong, "Number of random samples that are made too bright or too dark")
      .capture_default_str();
  command.add_option("--wrong-factor", options->wrong_factor, "Factor by which they are too bright or too dark")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--wrong-channels", options->wrong_channels, "Number of channels in which they are wrong")
      .check(check::range(1.0, 3.0))
      .capture_default_str();
  command.add_option("--random-materials", options->random_materials,
                     "Number of synthetic materials that all priors but the first also learn: analytic models drawn at "
                     "random");
  command.add_option("--repetitions", options->repetitions, "Number of random sets of each size")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--noise", options->noise, "Relative deviation of the measurements, which the methods know")
      .capture_default_str();
  command
      .add_option("--receiver-half-angle", options->receiver_half_angle,
                  "Half angle of the receiver in degrees: samples are means over its cone")
      .check(check::range(0.0, 45.0));
  command.add_flag("--scans", options->scans,
                   "Use samplings like scans: in planes, and below some theta_h, where coverage is counted from 8 "
                   "degrees farther out");
  command.add_option("--lobe-width", options->lobe_width, "Factor by which the lobes of materials are widened")
      .check(check::range(0.1, 10.0));
  command.add_flag(
      "--surrogates", options->surrogates,
      "Reconstruct the ten test materials of Nielsen et al. from the networks, instead of the measured materials");
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<experiment>(given, [&](const json& rows) { print(given, rows); });
  });
}

}  // namespace papers
