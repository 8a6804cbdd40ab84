/// gonio properties: checks the properties of a physical BRDF.

#include "commands.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include <gonio/core/printable.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/instrument_readings.hpp>
#include <gonio/model/measured_properties.hpp>
#include <gonio/model/physical_properties.hpp>

#include <array>
#include <iostream>
#include <memory>

namespace cli {

namespace {

struct properties_options {
  std::filesystem::path file;
  measurement_options reading;
  double tolerance = 0.5;
  bool print_json = false;
  gonio::thread_count threads;
};

/// The albedo of a physical BRDF is at most 1; 0.005 is the quadrature error.
constexpr double largest_possible_albedo = 1.005;

constexpr std::array channel_names{"red", "green", "blue"};

json to_json(const gonio::half_difference& angles) {
  return {{"theta_h", gonio::degrees(angles.theta_h)},
          {"theta_d", gonio::degrees(angles.theta_d)},
          {"phi_d", gonio::degrees(angles.phi_d)}};
}

/// Returns whether the largest albedo is possible, and the albedo by angle for a figure.
template <gonio::brdf Brdf>
json energy_of(const Brdf& f) {
  const auto albedos = gonio::model::albedo_by_angle(f);
  const gonio::model::largest_albedo largest = gonio::model::largest_of(albedos);
  json all = json::array();
  for (const auto& [theta, value] : albedos)
    all.push_back({{"theta_i", gonio::degrees(theta)}, {"albedo", per_channel(value)}});
  return {{"kept", largest.value <= largest_possible_albedo},
          {"largest_albedo", largest.value},
          {"theta_i", gonio::degrees(largest.theta)},
          {"by_angle", all}};
}

/// Returns the properties of a table of any kind.
json properties_of(const gonio::brdf_table& table) {
  const gonio::model::table_values values = gonio::model::summarise(table);
  const gonio::model::tail_rise rise = gonio::model::largest_tail_rise(table);
  return {{"negative",
           {{"cells", values.negative_cells},
            {"of", table.cells().size()},
            {"lowest", values.minimum.minCoeff()},
            {"at", to_json(table.cells().angles(values.lowest_cell))}}},
          {"tails",
           {{"largest_rise", rise.amount},
            {"theta_h", gonio::degrees(rise.theta_h)},
            {"theta_d", gonio::degrees(rise.theta_d)},
            {"channel", channel_names[static_cast<std::size_t>(rise.channel)]}}}};
}

json to_json(const gonio::model::worst_pair& worst) {
  json found{{"median", worst.median}, {"worst", worst.amount}};
  found["at"] = to_json(gonio::to_half_difference(worst.at.wi, worst.at.wo));
  return found;
}

/// Returns the properties of a MERL table. Its format cannot represent violations of reciprocity or isotropy.
json properties_of_merl(const std::filesystem::path& path) {
  const gonio::brdf_table table = gonio::io::read_merl_any(path);
  json all{{"kind", "MERL table"}, {"energy", energy_of(table)}};
  all.update(properties_of(table));
  all["readings"] = cli::to_json(gonio::model::read_instruments(table));
  all["reciprocity"] = {{"kept_by", "the format"}};
  all["isotropy"] = {{"kept_by", "the format"}};
  return all;
}

/// Returns the values as measured, not averaged over both orders of the directions. Light and viewer are swapped:
/// `directional_albedo` integrates over the light, but the albedo of measured values is an integral over the viewer.
struct light_and_viewer_swapped {
  gonio::model::adaptive_brdf material;

  [[nodiscard]] gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return material.as_measured(wo, wi);
  }
};

json properties_of_rgl(const std::filesystem::path& path, gonio::thread_count threads) {
  const auto material = gonio::io::colours_of(gonio::io::read_rgl(path), path);
  if (material.is_anisotropic()) gonio::refuse({path.native(), ": is anisotropic, expected an isotropic material"});
  const light_and_viewer_swapped as_measured{material};
  json all{{"kind", "RGL material"}, {"energy", energy_of(as_measured)}};
  all.update(properties_of(gonio::tabulate(material, gonio::valid_cells(), threads)));
  all["readings"] = cli::to_json(gonio::model::read_instruments(as_measured));
  all["reciprocity"] = to_json(gonio::model::worst_asymmetry(as_measured));
  all["isotropy"] = {{"kept_by", "the format"}};
  return all;
}

json to_json(const gonio::model::equal_samples& equal) {
  json found{{"pairs", equal.pairs}};
  if (equal.pairs == 0) return found;
  found["median"] = equal.median;
  found["worst"] = equal.worst;
  found["samples"] = {equal.first + 1, equal.second + 1};
  return found;
}

/// Returns the properties of samples. Samples cannot be integrated, so this gives no albedo; it compares samples whose
/// values should be equal.
json properties_of_samples(const properties_options& options) {
  const gonio::io::sample_file measured = read_colour_file(options.file, options.reading);
  const gonio::sample_set& samples = measured.samples;
  const auto symmetries = gonio::model::compare_equal_samples(samples, gonio::radians(options.tolerance));
  Eigen::Index negative = 0, lowest = 0;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    if ((samples[i].value < 0.0).any()) ++negative;
    if (samples[i].value.minCoeff() < samples[lowest].value.minCoeff()) lowest = i;
  }
  json all{{"kind", "samples"}};
  all.update(facts_of(measured));
  all["negative"] = {{"samples", negative},
                     {"of", samples.size()},
                     {"lowest", samples[lowest].value.minCoeff()},
                     {"sample", lowest + 1}};
  all["repeats"] = to_json(symmetries.repeated);
  all["reciprocity"] = to_json(symmetries.reciprocal);
  all["isotropy"] = to_json(symmetries.turned);
  return all;
}

json properties_of_file(const properties_options& options) {
  if (holds_measurements(options.file)) return properties_of_samples(options);
  require_unused(options.reading, options.file);
  if (lower_extension(options.file) == ".bsdf") return properties_of_rgl(options.file, options.threads);
  return properties_of_merl(options.file);
}

std::string percent(const json& share) { return fixed(100.0 * share.number(), 1) + " %"; }

std::string where(const json& angles) {
  return "theta_h " + fixed(angles["theta_h"], 1) + ", theta_d " + fixed(angles["theta_d"], 1) + ", phi_d " +
         fixed(angles["phi_d"], 1);
}

std::string energy_sentence(const json& energy) {
  return std::string(energy["kept"].truth() ? "kept" : "broken") + ": an albedo of up to " +
         fixed(energy["largest_albedo"], 3) + ", at " + fixed(energy["theta_i"], 0) + " degrees";
}

std::string negative_sentence(const json& negative, bool of_samples) {
  const json& count = negative[of_samples ? "samples" : "cells"];
  const std::string all = negative["of"].dump() + (of_samples ? " samples" : " cells");
  if (count.number() == 0.0) return "none of " + all;
  return count.dump() + " of " + all + ", down to " + reflectance(negative["lowest"].number()) + " sr^-1, " +
         (of_samples ? "sample " + negative["sample"].dump() : "at " + where(negative["at"]));
}

/// Returns a sentence on a format, on the worst pair of directions, or on pairs of samples.
std::string symmetry_sentence(const json& symmetry, const char* what) {
  if (symmetry.contains("kept_by")) return "kept by " + symmetry["kept_by"].text();
  if (symmetry.contains("pairs") && symmetry["pairs"].number() == 0.0) return std::string("no samples ") + what;
  const std::string amounts =
      "off by " + percent(symmetry["median"]) + " (median) and " + percent(symmetry["worst"]) + " at worst, ";
  if (!symmetry.contains("pairs")) return amounts + "at " + where(symmetry["at"]);
  return symmetry["pairs"].dump() + " pairs " + what + ", " + amounts + "samples " +
         symmetry["samples"].elements()[0].dump() + " and " + symmetry["samples"].elements()[1].dump();
}

std::string tails_sentence(const json& tails) {
  if (tails["largest_rise"].number() < 5e-4) return "monotone";  // within the rounding of stored values
  return "rise by up to " + percent(tails["largest_rise"]) + " (" + tails["channel"].text() + "), at theta_h " +
         fixed(tails["theta_h"], 1) + ", theta_d " + fixed(tails["theta_d"], 1);
}

void print_readings(const json& readings) {
  const auto row = [](const char* instrument, const std::string& reading) {
    std::cout << "| " << instrument << " | " << reading << " |\n";
  };
  const json& gloss = readings["gloss"];
  std::cout << "\n| instrument | reading |\n|---|---|\n";
  row("gloss at 20, 60, 85 degrees (ISO 2813)",
      fixed(gloss["20"], 1) + ", " + fixed(gloss["60"], 1) + ", " + fixed(gloss["85"], 1));
  row("haze at 20 degrees (ISO 13803)", fixed(readings["haze_20"], 1));
  row("haze index (ASTM D4039)", fixed(readings["haze_index"], 1));
  row("reflectance at 8 degrees, specular included", percent(readings["luminous_reflectance_8"]));
  row("reflectance at 8 degrees, specular excluded (4 degrees)",
      percent(readings["luminous_reflectance_8_specular_excluded"]));
  row("total integrated scatter (outside 2.5 degrees)", percent(readings["total_integrated_scatter"]));
  std::cout << "\n| degrees from the mirror direction, light at 45 | L* | a* | b* |\n|---|---|---|---|\n";
  for (const json& each : readings["colours"].elements())
    std::cout << "| " << fixed(each["aspecular"], 0) << " | " << fixed(each["L"], 1) << " | " << fixed(each["a"], 1)
              << " | " << fixed(each["b"], 1) << " |\n";
}

/// Prints Markdown, like `gonio plan`.
void print(const std::filesystem::path& file, const json& all) {
  const auto row = [](const char* what, const std::string& sentence) {
    std::cout << "| " << what << " | " << sentence << " |\n";
  };
  const bool of_samples = all["kind"].text() == "samples";
  std::cout << gonio::printable(file.filename().string()) << ", " << all["kind"].text()
            << "\n\n| property | found |\n|---|---|\n";
  row("energy", of_samples ? "not known: samples have no integral (gonio reconstruct makes a table of them)"
                           : energy_sentence(all["energy"]));
  row("negative values", negative_sentence(all["negative"], of_samples));
  row("reciprocity", symmetry_sentence(all["reciprocity"], "with light and viewer swapped"));
  row("isotropy", symmetry_sentence(all["isotropy"], "turned about the normal"));
  if (of_samples) return row("repeats", symmetry_sentence(all["repeats"], "of the same directions"));
  row("tails", tails_sentence(all["tails"]));
  print_readings(all["readings"]);
  std::cout << "\n| theta_i | albedo, red | green | blue |\n|---|---|---|---|\n";
  for (const json& at : all["energy"]["by_angle"].elements()) {
    std::cout << "| " << fixed(at["theta_i"], 0);
    for (const json& share : at["albedo"].elements()) std::cout << " | " << fixed(share, 3);
    std::cout << " |\n";
  }
}

}  // namespace

void add_properties(command& app) {
  auto command =
      app.add_subcommand("properties",
                         "Check whether a table or samples are physical; for a table, print the readings of a gloss "
                         "meter, an integrating sphere and a multi-angle instrument (docs/learn/properties.md)");
  const auto options = std::make_shared<properties_options>();
  command
      .add_input("file", options->file,
                 "Table (.binary, .binary.gz or .bsdf) or measurements (.csv, or .brdf in Cornell's text format)")
      .required();
  add_measurement_options(command, options->reading);
  options->reading.takes_anisotropic = true;
  command
      .add_option("--tolerance", options->tolerance,
                  "Directions of samples count as equal if they differ by at most this, in degrees")
      .check(check::range(0.001, 5.0))
      .capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([command, options] {
    if (command.count("--tolerance") > 0 && !holds_measurements(options->file))
      gonio::refuse("--tolerance needs samples (.csv or .brdf), not " + options->file.string());
    const json all = properties_of_file(*options);
    if (options->print_json)
      std::cout << all.dump(2) << '\n';
    else
      print(options->file, all);
  });
}

}  // namespace cli
