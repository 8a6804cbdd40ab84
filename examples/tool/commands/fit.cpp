/// gonio fit: fits an analytic model to measurements.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/images.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/report_data.hpp"
#include "tool/pages/report_page.hpp"
#include <gonio/io/materials/renderer_material.hpp>
#include <gonio/model/physical_properties.hpp>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>

namespace cli {

namespace {

/// A renderer's format for a fitted model.
struct renderer_format {
  const char* option;
  const char* extension;
  const char* description;
  std::string (*text)(const gonio::model::analytic_brdf& model);
};

constexpr std::array renderer_formats{
    renderer_format{"--pbrt", ".pbrt", "Material of pbrt-v4 to write (.pbrt)", gonio::io::pbrt_material},
    renderer_format{"--mitsuba", ".xml", "Material of Mitsuba 3 to write (.xml)", gonio::io::mitsuba_material},
    renderer_format{"--materialx", ".mtlx", "Surface of OpenPBR to write, in MaterialX (.mtlx)",
                    [](const gonio::model::analytic_brdf& model) { return gonio::io::materialx_material(model); }},
    renderer_format{"--gltf", ".gltf", "Sphere of glTF 2.0 with the material, to write (.gltf)",
                    gonio::io::gltf_material},
    renderer_format{"--osl", ".osl", "Shader of Blender's Cycles to write, in the Open Shading Language (.osl)",
                    gonio::io::osl_shader}};

struct fit_command_options {
  measurement_options reading;
  std::filesystem::path measurements, output, image;
  page_option report;
  std::array<std::filesystem::path, renderer_formats.size()> for_renderers;
  gonio::model::cell_weighting cell_weights = gonio::model::cell_weighting::equal;
  bool print_json = false, no_cosine_weight = false;
  image_options how;
  model_choice choice;
};

void print(const gonio::model::model_fit& fit, const gonio::model::largest_albedo& albedo, std::size_t measurements) {
  std::cout << measurements << " measurements, loss " << fit.loss << " after " << fit.evaluations << " evaluations"
            << (fit.converged ? "" : ", not converged") << '\n';
  for (const gonio::model::analytic_lobe& lobe : fit.model.lobes()) {
    std::cout << lobe.kind().name() << ": colour " << fixed(lobe.colour()[0], 4) << ' ' << fixed(lobe.colour()[1], 4)
              << ' ' << fixed(lobe.colour()[2], 4);
    const auto about = lobe.kind().parameters();
    for (std::size_t i = 0; i < about.size(); ++i) {
      std::cout << ", " << about[i].name << ' ' << fixed(lobe.parameters()[i], 4);
      if (!about[i].unit.empty()) std::cout << " (" << about[i].unit << ')';
    }
    std::cout << '\n';
  }
  std::cout << "largest albedo " << fixed(albedo.value, 3) << ", of light at " << fixed(gonio::degrees(albedo.theta), 0)
            << " degrees" << (albedo.value > 1.0 ? ": more light than comes in" : "") << '\n';
}

/// Writes the page for people. `samples` are the fitted ones, or some values of the table.
void write_report(const fit_command_options& options, const gonio::model::analytic_brdf& model,
                  const gonio::sample_set& samples, const json& details) {
  json data =
      model_report_data({options.measurements.stem().string(), model, samples, details, options.choice.fit.threads});
  data["record"] = record_of({{"Measurements", options.measurements.string()},
                              {"Model", options.choice.model + ", metric " + options.choice.metric}});
  data["of_table"] = holds_table(options.measurements);
  write_report_page(options.report, data);
}

/// Refuses what does not fit, before reading.
void require_possible(const fit_command_options& options) {
  if (options.cell_weights != gonio::model::cell_weighting::equal && !holds_table(options.measurements))
    gonio::refuse("--cell-weights needs a table: samples carry their own weights");
  if (!is_anisotropic(options.choice)) return;
  if (holds_table(options.measurements))
    gonio::refuse({options.measurements.native(), ": --model ", options.choice.model,
                   " needs samples with azimuths, not a whole material ('gonio sample' measures it)"});
  if (options.report.is_given()) gonio::refuse({"--report needs an isotropic --model, not ", options.choice.model});
  if (!options.output.empty() && lower_extension(options.output) != ".bsdf")
    gonio::refuse({options.output.native(), ": cannot hold the anisotropic --model ", options.choice.model,
                   ", write a .bsdf file"});
}

/// Refuses samples whose half vectors have all about the same azimuth: they do not tell the two slopes of an
/// anisotropic model apart.
void require_azimuths(const gonio::sample_set& samples, const fit_command_options& options) {
  std::optional<double> first;
  for (const gonio::sample& each : samples) {
    const auto& [wi, wo] = each.directions.pair();
    if (each.angles().theta_h < gonio::radians(1.0)) continue;
    const double azimuth = std::atan2(wi.y() + wo.y(), wi.x() + wo.x());
    if (!first) first = azimuth;
    if (std::abs(std::remainder(azimuth - *first, std::numbers::pi)) > gonio::radians(5.0)) return;
  }
  gonio::refuse({options.measurements.native(), ": all half vectors have the same azimuth, but --model ",
                 options.choice.model,
                 " needs samples at several azimuths of the surface (theta_i,phi_i,theta_o,phi_o)"});
}

/// Writes an anisotropic model as a table for renderers, and draws it.
void write_turned(const fit_command_options& options, const gonio::model::analytic_brdf& model) {
  const gonio::thread_count threads = options.choice.fit.threads;
  if (!options.output.empty())
    gonio::io::write_rgl(options.output,
                         {gonio::model::tabulate_adaptively(model, gonio::model::anisotropic_resolution{}, threads),
                          options.output.stem().string(),
                          {}});
  if (options.image.empty()) return;
  std::vector<gonio::image> images{turned_sphere_image(model, options.how, threads)};
  expose_spheres(images, options.how);
  gonio::io::write_png(options.image, images.front());
}

/// Tabulates the fit, and draws it beside the measured table if there is one.
void write_fitted(const fit_command_options& options, const gonio::model::analytic_brdf& model,
                  const std::optional<gonio::brdf_table>& table) {
  if (model.is_anisotropic()) return write_turned(options, model);
  if (options.output.empty() && options.image.empty()) return;
  const gonio::valid_cells cells = table ? table->cells() : gonio::valid_cells();
  const gonio::brdf_table fitted = gonio::tabulate(model, cells, options.choice.fit.threads);
  if (!options.output.empty()) write_table(options.output, fitted);
  if (options.image.empty()) return;
  std::vector<gonio::image> images;
  if (table) images.push_back(sphere_image(*table, options.how, options.choice.fit.threads));
  images.push_back(sphere_image(fitted, options.how, options.choice.fit.threads));
  expose_spheres(images, std::span(images).first(1), options.how);  // with the exposure of the measurement
  gonio::io::write_png(options.image, gonio::render::side_by_side(images, 8));
}

void fit(const fit_command_options& options) {
  require_possible(options);
  // Read the measurements, and fit the model under the metric.
  std::optional<gonio::brdf_table> table;
  if (holds_table(options.measurements)) table.emplace(read_table(options.measurements, options.choice.fit.threads));
  if (table) require_unused(options.reading, options.measurements);
  gonio::io::sample_file measured;
  if (!table) measured = read_colour_file(options.measurements, options.reading);
  if (is_anisotropic(options.choice)) require_azimuths(measured.samples, options);
  const auto observations =
      table ? gonio::model::fit_observations(*table, options.choice.fit.threads, options.cell_weights)
            : gonio::model::fit_observations(measured.samples);
  const gonio::model::model_fit found = fit_chosen(options.choice, observations);

  // Describe the material before any file is written, so that a refusal leaves no files.
  std::array<std::string, renderer_formats.size()> materials;
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (!options.for_renderers[i].empty()) materials[i] = renderer_formats[i].text(found.model);
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (!materials[i].empty()) gonio::io::write_renderer_material(options.for_renderers[i], materials[i]);
  write_fitted(options, found.model, table);
  // Print the fit.
  const gonio::model::largest_albedo albedo = gonio::model::find_largest_albedo(found.model);
  json all{{"measurements", observations.size()},
           {"loss", found.loss},
           {"evaluations", found.evaluations},
           {"converged", found.converged},
           {"promised_gain", found.promised_gain},
           {"lobes", to_json(found.model)},
           {"energy", {{"largest_albedo", albedo.value}, {"theta_i", gonio::degrees(albedo.theta)}}}};
  all.update(facts_of(measured));
  if (options.report.is_given())
    write_report(options, found.model, table ? in_plane_values(*table) : measured.samples, all);
  if (!options.print_json) return print(found, albedo, observations.size());
  std::cout << all.dump(2) << '\n';
}

}  // namespace

void add_fit(command& app, const std::vector<std::string>& words) {
  auto command = app.add_subcommand("fit", "Fit an analytic model to samples or a table");
  const auto options = std::make_shared<fit_command_options>();
  // Declare the measurements and the model.
  command
      .add_input(
          "measurements", options->measurements,
          "Samples (.csv, or .brdf in Cornell's text format) or a table (.binary, .binary.gz, .npy, .bsdf or .mbsdf)")
      .required();
  add_measurement_options(command, options->reading);
  std::string names;
  for (const auto kinds : {gonio::model::lobe_kinds(), gonio::model::anisotropic_lobe_kinds()})
    for (const gonio::model::lobe_kind* kind : kinds) names += (names.empty() ? "" : ", ") + std::string(kind->name());
  command
      .add_option(
          "--model", options->choice.model,
          "Lobe to fit together with a Lambertian one, or a sum of lobes as sum:ward+ggx; an anisotropic one needs "
          "samples with azimuths: " +
              names)
      .capture_default_str();
  // Declare the comparison.
  command
      .add_option("--metric", options->choice.metric,
                  "Metric that compares reflectance x: lin (x), log (ln(1 + x)) or cubic (cube root of x)")
      .check(check::one_of({"lin", "log", "cubic"}))
      .capture_default_str();
  command.add_flag("--fresnel", options->choice.fresnel,
                   "Multiply the last lobe, which must be one of Phong's, by the Fresnel reflectance of a dielectric");
  add_fit_options(command, options->choice.fit);
  command.add_flag("--no-cosine-weight", options->no_cosine_weight,
                   "Compare reflectance without the cosine of the light");
  add_cell_weights_option(command, options->cell_weights);
  // Declare the output.
  command.add_output("-o,--output", options->output, {".binary", ".npy", ".bsdf", ".mbsdf"},
                     "Table of the model to write (.binary, .npy, or .bsdf or .mbsdf for renderers)");
  auto image =
      command.add_output("--image", options->image, {".png"},
                         "Image to write (.png): spheres of the measurement, if it is a table, and of the model");
  add_image_options(command, options->how, image);
  for (std::size_t i = 0; i < renderer_formats.size(); ++i) {
    const auto& [option, extension, description, text] = renderer_formats[i];
    command.add_output(option, options->for_renderers[i], {extension}, description);
  }
  add_report_option(command, options->report, words);
  command.add_flag("--json", options->print_json, "Print the fit as JSON");
  add_threads_option(command, options->choice.fit.threads);
  command.callback([command, options] {
    if (command.count("--cosine-weighted") > 0 && options->no_cosine_weight)
      gonio::refuse("--cosine-weighted and --no-cosine-weight exclude each other: give one of them");
    options->choice.fit.cosine_weighted = !options->no_cosine_weight;
    options->reading.takes_anisotropic = is_anisotropic(options->choice);
    fit(*options);
  });
}

}  // namespace cli
