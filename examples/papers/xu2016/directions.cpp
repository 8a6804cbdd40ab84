/// gonio-papers directions: compares published sets of directions with ours, on materials that the prior has not
/// learned.

#include "lab/near_field_lab.hpp"
#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/mean_errors.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/resumable_results.hpp"
#include "tool/files/json.hpp"
#include "tool/options/design_search.hpp"
#include "tool/options/solver_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/errors_in_variables_decomposition.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <iostream>
#include <memory>
#include <optional>

namespace papers {

namespace {

struct directions_options : resumable_options {
  studied_networks networks;
  std::filesystem::path folder;
  std::vector<std::string> sets{"published", "industry",  "random",         "condition",
                                "a-optimal", "d-optimal", "expected-error", "perceived"};
  std::vector<Eigen::Index> counts{1, 2, 5, 10, 20};
  std::vector<std::filesystem::path> files;  ///< of directions to compare with the sets
  std::string geometry = "point";
  std::string reconstruction_eta = "auto";
  bool in_sample = false;
  double eta = gonio::default_eta, common_shift = 0.0, field_of_view = 25.0, step = 5.0, noise = 0.0,
         angular_error = 0.0, expected = 0.0;
  std::uint64_t seed = 0;
  bool print_json = false;
};

/// The prior, the test materials and the metric that evaluate all sets.
struct laboratory : nielsen_split {
  gonio::appearance_metric appearance;
};

laboratory open_laboratory(const directions_options& options, const gonio::progress& listener) {
  auto split = nielsen_split::learn(options.networks, options.threads, listener);
  const gonio::valid_cells cells = split.truths.cells;
  return {std::move(split), gonio::appearance_metric(cells, 36, options.threads)};
}

design_options search_for(const directions_options& options, const std::string& criterion, std::size_t count) {
  design_options search;
  search.count = count;
  search.geometry = options.geometry;
  search.criterion = criterion == "perceived" ? "perceived-norm" : criterion;
  search.eta = options.eta;
  search.search = "exchange";
  search.apparatus = {};
  search.apparatus.noise = options.noise;
  if (criterion == "expected-error" || criterion == "perceived") {
    search.common_shift = options.common_shift;
    search.in_sample = options.in_sample;
  }
  search.near_field.field_of_view = gonio::radians(options.field_of_view);
  search.near_field.step = gonio::radians(options.step);
  if (options.geometry == "point" && (criterion == "expected-error" || criterion == "perceived"))
    search.apparatus.angular_error = gonio::radians(options.expected);
  search.seed = options.seed;
  search.threads = options.threads;
  return search;
}

/// Returns a given set of point samples, without a search.
designed point_samples(const std::vector<gonio::half_difference>& directions) {
  designed set{{}, directions, 0.0};
  for (const gonio::half_difference& angles : directions) set.poses.push_back(gonio::to_directions(angles));
  return set;
}

/// A set of directions and its size: a named set, or a file.
struct judged_set {
  std::string name;
  Eigen::Index count = 0;
  std::vector<gonio::direction_pair> directions = {};  ///< from the file
};

/// Returns whether a set exists. Sets without a search are points, in the published numbers.
bool exists(const directions_options& options, const std::string& set, std::size_t count) {
  const bool points = options.geometry == "point";
  if (set == "published") return points && gonio::design::has_nielsen_directions(count);
  if (set == "industry") return points && count == gonio::design::westlund_meyer_directions().size();
  return set != "random" || points;
}

std::vector<judged_set> sets_to_judge(const directions_options& options) {
  std::vector<judged_set> all;
  for (const std::filesystem::path& file : options.files) {
    auto directions = gonio::io::read_direction_pairs(file);
    const Eigen::Index count = directions.size();
    all.push_back({file.filename().string(), count, std::move(directions)});
  }
  for (const Eigen::Index count : options.counts)
    for (const std::string& set : options.sets)
      if (exists(options, set, count)) all.push_back({set, count});
  return all;
}

/// Returns a set that exists: reads it, or searches for it.
designed find_set(const laboratory& lab, const directions_options& options, const judged_set& wanted,
                  const gonio::progress& listener) {
  const auto& [set, count, directions] = wanted;
  if (!directions.empty() && options.geometry != "point")
    return placed(lab.prior, search_for(options, "expected-error", count), directions);
  if (!directions.empty()) {
    designed found{directions, {}, 0.0};
    for (const auto& [wi, wo] : directions) found.samples.push_back(gonio::to_half_difference(wi, wo));
    return found;
  }
  if (set == "published") return point_samples(gonio::design::nielsen_directions(count));
  if (set == "industry") return point_samples(gonio::design::westlund_meyer_directions());
  if (set == "random") {
    std::vector<gonio::half_difference> angles;
    for (const Eigen::Index cell : gonio::random_cells(lab.truths.cells, count, options.seed))
      angles.push_back(lab.truths.cells.angles(cell));
    return point_samples(angles);
  }
  return design(lab.prior, search_for(options, set, count), listener);
}

bool takes_images(const directions_options& options) {
  return options.geometry != "point" && options.geometry != "sphere";
}

/// Returns the samples of all images of a material. The simulated laboratory gives each image its own defects.
std::vector<gonio::sample_set> photographed(const gonio::brdf_table& material, const directions_options& options,
                                            const designed& found, std::uint64_t seed) {
  const gonio::design::near_field_options apparatus = search_for(options, "expected-error", 1).near_field;
  const gonio::capture::sample_disc disc{std::tan(apparatus.field_of_view / 2.0)};
  std::vector<gonio::sample_set> images;
  for (const auto& [wi, wo] : found.poses) {
    const gonio::capture::near_field_setup setup{
        .camera = gonio::design::near_field_camera(wo, apparatus.field_of_view, apparatus.pixels),
        .light = gonio::directional_light{wi},
        .disc = disc};
    const gonio::image image = lab::photograph(
        material, disc, setup, {.noise = options.noise, .misalignment = gonio::radians(options.angular_error)}, ++seed);
    images.push_back(gonio::capture::near_field_samples(image, setup));
  }
  return images;
}

gonio::sample_set sampled(const gonio::brdf_table& material, const directions_options& options, const designed& found,
                          std::uint64_t seed) {
  const gonio::measurement_defects defects{.noise = options.noise};
  if (options.angular_error > 0.0)
    return gonio::corrupt(
        gonio::sample_table_misplaced(material, found.poses, gonio::radians(options.angular_error), seed), defects,
        seed, [](auto&) { return gonio::rgb(gonio::rgb::Zero()); });
  return gonio::sample_table(material, gonio::cells_at(material.cells(), found.samples), defects, seed);
}

/// Reconstructs as if the directions were exact.
gonio::fitted_brdf<gonio::log_relative_pca> trusting(const laboratory& lab, const directions_options& options,
                                                     const gonio::sample_set& samples) {
  // Choose eta as `gonio reconstruct` does if the noise is unknown.
  if (options.reconstruction_eta == "auto")
    return gonio::decomposition{lab.prior, gonio::tikhonov{gonio::eta_of_unknown_noise(lab.prior, samples)}}.fit(
        samples);
  return gonio::decomposition{lab.prior, make_solver({"tikhonov", options.reconstruction_eta}, {"tikhonov", "gcv"})}
      .fit(samples);
}

/// Reconstructs points whose directions may be off, like `gonio reconstruct --misplaced`.
gonio::fitted_brdf<gonio::log_relative_pca> expecting(const laboratory& lab, const directions_options& options,
                                                      const gonio::sample_set& samples) {
  const double eta = options.reconstruction_eta == "auto"
                         ? gonio::eta_of_noise(lab.prior, samples, options.noise, options.threads)
                         : number_of_eta(options.reconstruction_eta);
  return gonio::errors_in_variables_decomposition{lab.prior, eta, gonio::radians(options.expected), options.threads}
      .fit(samples);
}

/// Measures and reconstructs a material, as if the directions were exact or with expected errors.
gonio::fitted_brdf<gonio::log_relative_pca> reconstructed(const laboratory& lab, const gonio::brdf_table& material,
                                                          const directions_options& options, const designed& found,
                                                          std::uint64_t seed) {
  const double expected = gonio::radians(options.expected);
  if (!takes_images(options)) {
    const gonio::sample_set samples = sampled(material, options, found, seed);
    if (!(expected > 0.0)) return trusting(lab, options, samples);
    return expecting(lab, options, samples);
  }
  const auto images = photographed(material, options, found, seed);
  if (expected > 0.0) {
    gonio::pose_refinement_options expectation{.deviation = expected, .threads = options.threads};
    if (options.reconstruction_eta != "auto") expectation.eta = number_of_eta(options.reconstruction_eta);
    gonio::pose_refinement refinement(lab.prior, images, expectation);
    refinement.solve();
    return refinement.result();
  }
  gonio::sample_set all;
  for (const gonio::sample_set& samples : images) all.insert(all.end(), samples.begin(), samples.end());
  return trusting(lab, options, all);
}

json judged(const laboratory& lab, const directions_options& options, const designed& found) {
  design_options expectation = search_for(options, "expected-error", 1);
  expectation.in_sample = false;
  const double left_out = quality_of(lab.prior, expectation, found).expected_error;
  expectation.in_sample = true;
  const double in_sample = quality_of(lab.prior, expectation, found).expected_error;
  std::vector<material_result> results;
  for (std::size_t number = 0; number < lab.truths.names.size(); ++number) {
    const gonio::brdf_table truth = lab.truths.table(number);
    const auto estimate = reconstructed(lab, truth, options, found, options.seed + 1000 * number);
    results.push_back(
        {lab.truths.names[number], gonio::compare(estimate.tabulate(lab.truths.cells, options.threads), truth,
                                                  lab.prior.metric(), lab.appearance, options.threads)});
  }
  json poses = json::array();
  for (const auto& [wi, wo] : found.poses)
    poses.push_back({{"wi", {wi.x(), wi.y(), wi.z()}}, {"wo", {wo.x(), wo.y(), wo.z()}}});
  const double condition =
      gonio::design::condition_number{}(gonio::design::rows_at(lab.prior, found.samples).components);
  return {{"expected_error", in_sample},     {"leave_one_material_out_error", left_out}, {"condition", condition},
          {"samples", found.samples.size()}, {"errors", mean_errors(results)},           {"poses", poses}};
}

/// Prints null as "infinite": JSON has no infinity.
std::string printed(const json& value, int digits) {
  if (!value.is_number() || !std::isfinite(value.number())) return "infinite";
  return fixed(value, digits);
}

void print_row(const json& row) {
  const json& result = row["result"];
  const json& errors = result["errors"];
  std::cout << "| " << row["count"] << " | " << row["set"].text() << " | " << printed(result["expected_error"], 4)
            << " | " << printed(result["leave_one_material_out_error"], 4) << " | " << printed(result["condition"], 2)
            << " | " << printed(errors["mapped_rms"], 3) << " | " << printed(errors["delta_e_env"], 2) << " | "
            << printed(errors["delta_e_lights"], 2) << " | " << printed(errors["peak_ratio"], 2) << " |\n";
}

/// Writes a set as a file of directions, named after its geometry, size and criterion.
void write_set(const directions_options& options, const json& row) {
  const auto vector = [](const json& w) { return gonio::direction(w[0].number(), w[1].number(), w[2].number()); };
  std::vector<gonio::direction_pair> poses;
  for (const json& pose : row["result"]["poses"].elements()) poses.push_back({vector(pose["wi"]), vector(pose["wo"])});
  std::string name = options.geometry;
  if (takes_images(options)) name += '-' + std::to_string(std::lround(options.field_of_view));
  name += '-' + row["count"].dump() + '-' + row["set"].text() + ".csv";
  std::filesystem::create_directories(options.folder);
  gonio::io::write_direction_pairs(options.folder / name, poses);
}

void run(const directions_options& options) {
  // Refuse options that the geometry does not take.
  if (options.geometry == "sphere" && options.angular_error > 0.0)
    gonio::refuse("--misplaced needs --geometry point or near-field");
  if (options.expected > 0.0 && options.geometry == "sphere")
    gonio::refuse("--expected-misplacement needs --geometry point or near-field");
  progress_bar bar;
  const auto listener = bar.listener();
  // Find and evaluate each set, unless the state file has its result.
  resumable_results results(options);
  std::optional<laboratory> lab;  // opened on first use
  json all = json::array();
  std::size_t turn = 0;
  for (const judged_set& set : sets_to_judge(options)) {
    const json key{options.geometry,
                   options.geometry == "point" || options.geometry == "sphere" ? 0.0 : options.field_of_view,
                   set.count,
                   set.name,
                   options.eta,
                   options.in_sample,
                   options.noise,
                   options.common_shift,
                   options.angular_error,
                   options.reconstruction_eta,
                   options.step,
                   options.seed,
                   options.expected,
                   options.networks.thin.steps.first,
                   options.networks.thin.steps.second};
    const json& result = results.once(key, turn++, [&] {
      if (!lab) lab.emplace(open_laboratory(options, listener));
      const designed found = find_set(*lab, options, set, listener);
      gonio::report(listener, "judging " + std::to_string(set.count) + " of " + set.name, 0.0);
      return judged(*lab, options, found);
    });
    all.push_back({{"set", set.name}, {"count", set.count}, {"result", result}});
  }
  if (!options.prints()) return;
  bar.wipe();

  // Write the sets, and print the errors.
  if (!options.folder.empty())
    for (const json& row : all.elements()) write_set(options, row);
  if (options.print_json) {
    std::cout << all.dump(2) << '\n';
    return;
  }
  std::cout << "| n | chosen by | E | left out | condition | test: rms | Delta E env | Delta E lights | peak |\n"
            << "|---|---|---|---|---|---|---|---|---|\n";
  for (const json& row : all.elements()) print_row(row);
}

}  // namespace

void add_directions(command& app, const team& processes) {
  auto command = app.add_subcommand("directions",
                                    "Compare published directions with ours on ten materials; the prior has learned 90 "
                                    "others (Nielsen 2015, Xu 2016)");
  const auto options = std::make_shared<directions_options>();
  // Declare the sets.
  add_networks_option(command, options->networks);
  command.add_option("--sets", options->sets, "published, industry, random, or a criterion of `gonio design`")
      .check(check::one_of(
          {"published", "industry", "random", "condition", "a-optimal", "d-optimal", "expected-error", "perceived"}))
      .capture_default_str();
  command.add_input(
      "--files", options->files,
      "Files of directions to compare with the sets (.csv); for images, the directions at the centre of each image");
  add_counts_option(command, options->counts);
  // Declare the geometry and the search.
  command.add_option("--geometry", options->geometry, "Geometry of the measurements, as in `gonio design`")
      .check(check::one_of({"point", "sphere", "near-field", "fixed-camera", "fixed-light"}))
      .capture_default_str();
  command.add_option("--fov", options->field_of_view, "Near field: angle in degrees that the sample spans from above")
      .capture_default_str();
  command.add_option("--step", options->step, "Near field: degrees between candidates").capture_default_str();
  command.add_option("--eta", options->eta, "Tikhonov's penalty in the search for sets").capture_default_str();
  command.add_flag(
      "--in-sample", options->in_sample,
      "Search by each material's error with a prior that has learned it, as Xu et al. do, instead of leaving it out");
  // Declare the reconstruction.
  command
      .add_option("--reconstruction-eta", options->reconstruction_eta,
                  "Penalty of the reconstruction: a number (Nielsen et al. 2015: 40), gcv, loo, or auto, as `gonio "
                  "reconstruct` chooses it")
      .capture_default_str();
  // Declare the errors of the measurements.
  command.add_option("--noise", options->noise, "Relative deviation of every measurement; the searches know it")
      .capture_default_str();
  command
      .add_option("--common-shift", options->common_shift,
                  "Size of a shift common to all logarithms, for the searches: beta of Xu et al. 2016, Eq. 15")
      .capture_default_str();
  command
      .add_option("--misplaced", options->angular_error,
                  "Angle in degrees by which light and viewer are off, each in a random direction")
      .capture_default_str();
  command
      .add_option("--expected-misplacement", options->expected,
                  "Expected angular error of light and viewer in degrees. For points, search and reconstruction allow "
                  "for it; for images, the reconstruction corrects the directions")
      .capture_default_str();
  // Declare the run and its output.
  command.add_option("--seed", options->seed, "Seed of all random numbers").capture_default_str();
  command.add_output_folder("--write", options->folder, {}, "Folder to write each set to, as directions (.csv)");
  command.add_flag("--json", options->print_json, "Print everything, with the poses, as JSON");
  add_resumable_options(command, *options);
  do_together(command, processes, options, run);
}

}  // namespace papers
