/// gonio-papers anisotropic: anisotropic models fitted to noisy samples of brushed materials, and how different the
/// fitted sphere looks.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "tool/files/json.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/rgb.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/render/sphere.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace papers {

namespace {

struct anisotropic_options {
  Eigen::Index draws = 10;
  std::vector<Eigen::Index> samples{50, 200, 1000};
  std::vector<std::string> models{"ggx-anisotropic", "ward-anisotropic", "ward-bounded-anisotropic", "ggx"};
  double noise = 0.02;
  std::uint64_t seed = 0;
  bool print_json = false;
  gonio::thread_count threads;
};

/// A brushed metal or varnish: GGX beside a Lambertian lobe. Along the grooves it is smoother, by a factor of 1.5 to 6.
gonio::model::analytic_brdf draw_material(std::mt19937_64& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const auto colour = [&](double low, double high) {
    return gonio::rgb(between(low, high), between(low, high), between(low, high));
  };
  const double smooth = between(0.06, 0.2), ratio = between(1.5, 6.0);
  const double rough = std::min(smooth * ratio, 0.8), f0 = between(0.05, 0.9), rotation = between(-1.5, 1.5);
  return gonio::model::analytic_brdf(
      {{gonio::model::lobe_kind_named("lambert"), colour(0.02, 0.3), {}},
       {gonio::model::lobe_kind_named("ggx-anisotropic"), colour(0.4, 1.0), {smooth, rough, f0, rotation}}});
}

/// The slopes of the last lobe, the smaller one first, and the azimuth of its axis in degrees, from 0 to 180. An
/// isotropic lobe has no axis.
struct lobe_axes {
  double smooth, rough, azimuth;

  explicit lobe_axes(const gonio::model::analytic_brdf& f) {
    const auto& lobe = f.lobes().back();
    const auto about = lobe.kind().parameters();
    smooth = lobe.parameters()[0];
    rough = lobe.kind().is_anisotropic() ? lobe.parameters()[1] : smooth;
    azimuth = lobe.kind().is_anisotropic() ? lobe.parameters()[about.size() - 1] : 0.0;
    if (smooth > rough) {
      std::swap(smooth, rough);
      azimuth += std::numbers::pi / 2.0;
    }
    azimuth = gonio::degrees(azimuth - std::numbers::pi * std::floor(azimuth / std::numbers::pi));
  }

  /// Returns the larger relative error of the slopes.
  [[nodiscard]] double slope_error(const lobe_axes& truth) const {
    return std::max(std::abs(smooth / truth.smooth - 1.0), std::abs(rough / truth.rough - 1.0));
  }
  /// Returns the angle between the axes in degrees.
  [[nodiscard]] double turn_from(const lobe_axes& truth) const {
    const double difference = std::abs(azimuth - truth.azimuth);
    return std::min(difference, 180.0 - difference);
  }
};

/// Spheres whose grooves run about the vertical axis, in the formula environment. The truth has the mean luminance of
/// middle grey; colours are clipped as by a display.
class turned_spheres {
 public:
  explicit turned_spheres(gonio::thread_count threads) : light_(60, 48), threads_(threads) {}

  [[nodiscard]] std::vector<gonio::rgb> colours(const gonio::model::analytic_brdf& f) const {
    const gonio::image image = gonio::render::render_sphere(f, light_, {.size = size, .is_turned = true}, threads_);
    std::vector<gonio::rgb> all;
    for (const auto& point : gonio::render::sphere_points(size))
      all.push_back(gonio::pixel(image, point.row, point.column));
    return all;
  }

  /// Returns the mean Delta E of CIELAB 1976.
  [[nodiscard]] static double difference(const std::vector<gonio::rgb>& truth, const std::vector<gonio::rgb>& fit) {
    double mean = 0.0, sum = 0.0;
    for (const gonio::rgb& colour : truth) mean += gonio::luminance(colour) / static_cast<double>(truth.size());
    const auto shown = [&](const gonio::rgb& colour) {
      return gonio::to_lab((colour * (middle_grey / mean)).max(0.0).min(1.0));
    };
    for (std::size_t i = 0; i < truth.size(); ++i) sum += (shown(truth[i]) - shown(fit[i])).matrix().norm();
    return sum / static_cast<double>(truth.size());
  }

 private:
  static constexpr int size = 36;
  static constexpr double middle_grey = 0.18;

  gonio::render::environment_lighting<> light_;
  gonio::thread_count threads_;
};

struct brushed_material {
  gonio::model::analytic_brdf truth;
  std::vector<gonio::rgb> colours;  ///< of its sphere
};

json errors_of(const std::string& model, Eigen::Index samples, const anisotropic_options& given,
               const std::vector<brushed_material>& materials, const turned_spheres& spheres) {
  model_choice choice;
  choice.model = model;
  choice.fit.threads = given.threads;
  std::uint64_t seed = given.seed + 1000;
  std::vector<double> slopes, turns, differences;
  for (const auto& [truth, colours] : materials) {
    const auto pairs = gonio::random_pairs(gonio::valid_cells(), samples, ++seed);
    const auto measured = gonio::sample_brdf(truth, pairs, {.noise = given.noise}, seed);
    const auto fit = fit_chosen(choice, gonio::model::fit_observations(measured));
    slopes.push_back(lobe_axes(fit.model).slope_error(lobe_axes(truth)));
    turns.push_back(lobe_axes(fit.model).turn_from(lobe_axes(truth)));
    differences.push_back(turned_spheres::difference(colours, spheres.colours(fit.model)));
  }
  const auto summary = [](const std::vector<double>& all) {
    return json{{"median", distribution(all).median}, {"worst", *std::ranges::max_element(all)}};
  };
  return {{"model", model},
          {"samples", samples},
          {"slopes", summary(slopes)},
          {"rotation", summary(turns)},
          {"delta_e", summary(differences)}};
}

void print(const json& rows, const anisotropic_options& given) {
  std::cout << given.draws
            << " brushed materials at random, GGX beside a Lambertian lobe, measured in random directions "
            << "with " << 100.0 * given.noise << " % noise. Slopes: the larger relative error of both. Rotation: of "
            << "the axes. Delta E: CIELAB, mean over a sphere with grooves about its vertical axis. Median, then the "
            << "worst material.\n\n"
            << "| model | samples | slopes, % | worst | rotation, degrees | worst | Delta E | worst |\n"
            << "|---|---|---|---|---|---|---|---|\n";
  for (const json& row : rows.elements()) {
    const bool has_axes = row["model"].text() != "ggx";
    const auto pair = [&](const char* key, double scale, bool is_known) {
      if (!is_known) return std::string(" | |");
      return " " + fixed(scale * row[key]["median"].number(), 2) + " | " +
             fixed(scale * row[key]["worst"].number(), 2) + " |";
    };
    std::cout << "| " << row["model"].text() << " | " << row["samples"] << " |"
              << pair("slopes", 100.0, row["model"].text() == "ggx-anisotropic") << pair("rotation", 1.0, has_axes)
              << pair("delta_e", 1.0, true) << '\n';
  }
}

void run(const anisotropic_options& given) {
  progress_bar bar;
  const turned_spheres spheres(given.threads);
  std::mt19937_64 random(given.seed);
  std::vector<brushed_material> materials;
  for (Eigen::Index draw = 0; draw < given.draws; ++draw) {
    gonio::model::analytic_brdf truth = draw_material(random);
    std::vector<gonio::rgb> colours = spheres.colours(truth);
    materials.push_back({std::move(truth), std::move(colours)});
  }
  json rows = json::array();
  const double all = static_cast<double>(given.models.size() * given.samples.size());
  for (const std::string& model : given.models)
    for (const Eigen::Index samples : given.samples) {
      gonio::report(bar.listener(), model, static_cast<double>(rows.size()) / all);
      rows.push_back(errors_of(model, samples, given, materials, spheres));
    }
  bar.wipe();
  if (given.print_json)
    std::cout << rows.dump(2) << '\n';
  else
    print(rows, given);
}

}  // namespace

void add_anisotropic(command& app) {
  auto command = app.add_subcommand(
      "anisotropic", "Anisotropic models fitted to noisy samples of brushed materials: slopes, rotation and Delta E");
  const auto options = std::make_shared<anisotropic_options>();
  command.add_option("--draws", options->draws, "Random materials")
      .check(check::range(1, 10'000))
      .capture_default_str();
  command.add_option("--samples", options->samples, "Numbers of samples")
      .check(check::range(12, 1'000'000))
      .capture_default_str();
  command.add_option("--models", options->models, "Models to fit, beside a Lambertian lobe").capture_default_str();
  command.add_option("--noise", options->noise, "Relative deviation")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of what is random").capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
