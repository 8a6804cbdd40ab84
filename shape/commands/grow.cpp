/// gonio shape grow: grows a model from a few annotated synthetic ear canals, and from scans of other ear canals, some
/// of them defective. Prints how many scans it accepts and their errors. After section 2 of "Anatomically correct
/// surface recovery".

#include "shape.hpp"
#include "synthetic/ear_canal_scans.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/shape/bootstrap.hpp>

#include <algorithm>
#include <iostream>
#include <memory>

namespace cli {

namespace {

struct shape_grow_command {
  Eigen::Index annotated = 12, scans = 310;
  double defects = 0.1;
  std::uint64_t seed = 77;
  double wrong = 2.5;
  gonio::shape::bootstrap_options how;
  bool as_json = false;
  gonio::thread_count threads;
};

/// The results of a bootstrap with scans whose true values are known.
struct judged_bootstrap {
  Eigen::Index good = 0, defective = 0, accepted_good = 0, accepted_defective = 0;
  std::vector<double> off;            ///< mean distance from the true vertices, for each accepted good scan, ascending
  std::vector<std::string> refusals;  ///< reasons why good scans were refused
  std::vector<std::string> rightly;   ///< reasons why defective scans were refused

  [[nodiscard]] std::size_t farther_than(double distance) const {
    return std::ranges::count_if(off, [=](double one) { return one > distance; });
  }
  /// Returns the quantile `share` of `off`, mm; 0 if it is empty.
  [[nodiscard]] double off_at(double share) const {
    return off.empty() ? 0.0 : off[static_cast<std::size_t>(share * static_cast<double>(off.size() - 1))];
  }
};

judged_bootstrap judge_bootstrap(const std::vector<synthetic::ear_scan>& truths,
                                 const std::vector<gonio::shape::bootstrap_outcome>& outcomes) {
  judged_bootstrap judged;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const bool good = truths[i].defect == synthetic::scan_defect::none;
    ++(good ? judged.good : judged.defective);
    if (!outcomes[i].accepted()) {
      (good ? judged.refusals : judged.rightly).push_back(outcomes[i].refusal);
      continue;
    }
    ++(good ? judged.accepted_good : judged.accepted_defective);
    if (!good) continue;
    const gonio::shape::registration& found = *outcomes[i].registered;
    judged.off.push_back((found.vertices - found.pose(truths[i].truth)).colwise().norm().mean());
  }
  std::ranges::sort(judged.off);
  return judged;
}

void print_bootstrap(const judged_bootstrap& judged, const shape_grow_command& options) {
  std::cout << "accepted " << judged.accepted_good << " of " << judged.good << " good scans and "
            << judged.accepted_defective << " of " << judged.defective << " defective ones\n"
            << "mean distance of an accepted scan's vertices from the true ones, mm: median "
            << fixed(judged.off_at(0.5), 2) << ", nine of ten below " << fixed(judged.off_at(0.9), 2) << ", largest "
            << fixed(judged.off_at(1.0), 2) << "; above " << fixed(options.wrong, 1) << ": "
            << judged.farther_than(options.wrong) << "\n";
  for (const std::string& refusal : judged.refusals) std::cout << "good, refused: " << refusal << '\n';
  for (const std::string& refusal : judged.rightly) std::cout << "defective, refused: " << refusal << '\n';
}

json json_of(const judged_bootstrap& judged, const shape_grow_command& options) {
  return {{"good", judged.good},
          {"defective", judged.defective},
          {"accepted_good", judged.accepted_good},
          {"accepted_defective", judged.accepted_defective},
          {"median_off", judged.off_at(0.5)},
          {"largest_off", judged.off_at(1.0)},
          {"too_far", judged.farther_than(options.wrong)},
          {"refusals_of_good", judged.refusals},
          {"refusals_of_defective", judged.rightly}};
}

void grow_shapes(const shape_grow_command& options) {
  const synthetic::ear_canal_template common;
  const synthetic::ear_canal_family family;
  synthetic::number_source seeds(options.seed);
  std::vector<gonio::shape::point_columns> shapes;
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < options.annotated; ++i) {
    shapes.push_back(common.corresponded(family.draw(seeds.seed())));
    names.push_back("annotated-" + std::to_string(i + 1));
  }
  const auto truths = synthetic::population(family, common, options.scans, seeds.seed(), options.defects);
  std::vector<gonio::shape::named_scan> scans;
  for (const synthetic::ear_scan& one : truths) scans.push_back({"scan-" + std::to_string(scans.size() + 1), one.mesh});
  progress_bar bar;
  const auto grown = gonio::shape::bootstrap_shape_model(
      std::move(shapes), std::move(names), common.mesh().triangles, scans, options.how, options.threads,
      [&](std::string_view stage, double done) { bar.draw(stage, done); });
  bar.wipe();
  const judged_bootstrap judged = judge_bootstrap(truths, grown.outcomes);
  if (options.as_json)
    std::cout << json_of(judged, options).dump(2) << '\n';
  else
    print_bootstrap(judged, options);
}

}  // namespace

void add_shape_grow(command& shape) {
  auto command =
      shape.add_subcommand("grow", "Grow a model of synthetic ear canals by scans, and print how many it accepts");
  const auto options = std::make_shared<shape_grow_command>();
  command.add_option("--annotated", options->annotated, "Number of annotated shapes to begin with")
      .check(check::range(2, 100000))
      .capture_default_str();
  command.add_option("--scans", options->scans, "Number of scans to add")
      .check(check::range(1, 100000))
      .capture_default_str();
  command.add_option("--defects", options->defects, "Share of the scans that have defects and must be refused")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command
      .add_option("--most-missing", options->how.registration.most_missing,
                  "Largest share of the vertices that a scan may miss")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command
      .add_option("--wrong", options->wrong,
                  "Mean distance from the true vertices above which a shape counts as wrong, mm")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of all random numbers").capture_default_str();
  add_threads_option(command, options->threads);
  command.add_flag("--json", options->as_json, "Print figures as JSON");
  command.callback([options] { grow_shapes(*options); });
}

}  // namespace cli
