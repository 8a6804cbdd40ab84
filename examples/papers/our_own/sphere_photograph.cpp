/// gonio-papers sphere-photograph: measured materials reconstructed from simulated photographs of a sphere, compared
/// with perfect samples in the same directions.

#include "lab/sphere_lab.hpp"
#include "papers/experiments.hpp"
#include "papers/our_own/photographed_materials.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace papers {

namespace {

struct sphere_photograph_options : left_out_options {
  std::vector<std::filesystem::path> directions;
  std::vector<Eigen::Index> published;  ///< sets of Nielsen et al. 2015, Table 2
  std::vector<std::string> names{"vch_golden_yellow", "paper_white", "chm_light_blue"};
  double noise = 0.02;
  int pixels = 320;
  int coarser = 1;  ///< size of the cells whose pixels are averaged, relative to those of MERL's grid
};

/// A named set of direction pairs, with one photograph for each pair.
struct photograph_set {
  std::string name;
  std::vector<gonio::direction_pair> pairs;
};

std::vector<photograph_set> sets_of(const sphere_photograph_options& options) {
  std::vector<photograph_set> sets;
  for (const std::filesystem::path& file : options.directions)
    sets.push_back({file.stem().string(), gonio::io::read_direction_pairs(file)});
  for (const Eigen::Index count : options.published) {
    sets.push_back({"published-" + std::to_string(count), {}});
    for (const gonio::half_difference& angles : gonio::design::nielsen_sphere_directions(count))
      sets.back().pairs.push_back(gonio::to_directions(angles));
  }
  if (sets.empty()) gonio::refuse("sphere-photograph needs --directions or --published");
  return sets;
}

/// The laboratory: a sphere of radius 1 slightly off centre, a camera at 12 radii with lens distortion and vignetting,
/// and a lamp at 15 radii.
class sphere_laboratory {
 public:
  explicit sphere_laboratory(int pixels)
      : camera_(gonio::pinhole_camera::look_at(
                    gonio::camera_intrinsics::square(static_cast<std::size_t>(pixels), gonio::radians(11.5)),
                    {0.0, 0.0, 12.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}),
                {.k1 = -0.25, .k2 = 0.1, .p1 = 0.002, .p2 = -0.001}) {}

  [[nodiscard]] const gonio::lens_camera& camera() const noexcept { return camera_; }
  [[nodiscard]] const gonio::capture::placed_sphere& sphere() const noexcept { return sphere_; }

  /// Returns a lamp that the sphere sees at 2 theta_d from the camera.
  [[nodiscard]] static gonio::capture::point_lamp lamp(double theta_d) {
    return {15.0 * Eigen::Vector3d(std::sin(2.0 * theta_d), 0.0, std::cos(2.0 * theta_d)), gonio::rgb::Constant(700.0)};
  }

  template <class Brdf>
  [[nodiscard]] gonio::image take(const Brdf& material, const gonio::capture::point_lamp& lamp, double noise,
                                  std::uint64_t seed) const {
    return lab::photograph(material, sphere_, camera_, lamp, {.noise = noise, .background = 1e-4, .vignetting = true},
                           seed);
  }

 private:
  gonio::lens_camera camera_;
  gonio::capture::placed_sphere sphere_{{0.02, -0.03, 0.0}, 1.0};
};

/// The samples from a set of photographs.
struct photographed {
  gonio::sample_set samples;
  Eigen::Index pixels = 0;
  Eigen::Index views = 0;  ///< number of photographs with visible lit points
  double off = 0.0;        ///< error of the sphere's centre across the view, pixels
};

class sphere_photograph_experiment : photograph_experiment {
 public:
  sphere_photograph_experiment(const sphere_photograph_options& given, progress_bar& bar)
      : photograph_experiment(given, given.names, bar), given_(given), laboratory_(given.pixels) {}

  [[nodiscard]] std::map<std::string, std::map<std::string, json>> run() {
    std::map<std::string, std::map<std::string, json>> found;
    for (std::size_t number = 0; number < given_.names.size(); ++number) {
      const std::string& name = given_.names[number];
      std::optional<estimator_type> estimator;
      for (const photograph_set& set : sets_of(given_)) {
        const json key{"sphere-photograph", "intervals",  name,          set.name,
                       given_.components,   given_.noise, given_.pixels, given_.coarser};
        found[set.name][name] = once(key, number, name + " " + set.name, [&] {
          if (!estimator) estimator.emplace(estimator_of(prior_of(material(name))));
          return errors_of(material(name), photograph(material(name), set), set.pairs.size(), *estimator);
        });
      }
    }
    return found;
  }

 private:
  /// Photographs the material and a white sphere for each direction. Locates the sphere in the white image that shows
  /// the most of its outline.
  [[nodiscard]] photographed photograph(const judged_material& material, const photograph_set& set) const {
    struct shot {
      gonio::capture::point_lamp lamp;
      gonio::image picture;
      gonio::capture::white_reference white;
    };
    std::vector<shot> shots;
    constexpr double reflectance = 0.98;
    for (const gonio::direction_pair& pair : set.pairs) {
      const auto lamp = sphere_laboratory::lamp(gonio::to_half_difference(pair.wi, pair.wo).theta_d);
      const std::uint64_t seed = 100 * material.number + 2 * shots.size();
      shots.push_back(
          {lamp,
           laboratory_.take(measured_brdf{material.measured}, lamp, given_.noise, seed),
           {laboratory_.take(lab::white_material{reflectance}, lamp, given_.noise, seed + 1), reflectance, {}}});
    }
    const auto outline = gonio::capture::fullest_outline(std::ssize(shots), [&](Eigen::Index i) {
      return gonio::capture::find_sphere(shots[i].white.photograph, laboratory_.camera(), 1.0,
                                         {.light = shots[i].lamp});
    });
    photographed taken;
    std::string why;
    const gonio::surface_image surface = gonio::capture::surface_of(outline.sphere, laboratory_.camera());
    const gonio::capture::photograph_options options{
        .cells = gonio::grid({90 / given_.coarser, 90 / given_.coarser, 180 / given_.coarser})};
    for (const shot& each : shots) try {
        const auto found =
            gonio::capture::samples_of(each.picture, surface, laboratory_.camera(), each.lamp, each.white, options);
        taken.samples.insert(taken.samples.end(), found.samples.begin(), found.samples.end());
        taken.pixels += found.pixels;
        ++taken.views;
      } catch (const gonio::error& refusal) {
        why = refusal.what();  // with light and camera nearly opposite, no lit point is visible
      }
    if (taken.views == 0) gonio::refuse(set.name + ": " + why);
    const Eigen::Vector3d off = outline.sphere.centre - laboratory_.sphere().centre;
    taken.off = off.head<2>().norm() / (12.0 * laboratory_.camera().pixel_angle());
    return taken;
  }

  [[nodiscard]] json errors_of(const judged_material& material, const photographed& taken, std::size_t views,
                               const estimator_type& estimator) const {
    // Compare with perfect samples in the same directions.
    gonio::sample_set perfect = taken.samples;
    for (gonio::sample& s : perfect) s.value = material.measured(s.directions.pair());
    const auto photo = judged(estimator, taken.samples, material), same = judged(estimator, perfect, material),
               alike = judged(estimator.keeping_all(), taken.samples, material);
    return {{"samples", taken.samples.size()},
            {"pixels", taken.pixels},
            {"views", std::to_string(taken.views) + " of " + std::to_string(views)},
            {"off", taken.off},
            {"median_error", 100.0 * median_error(taken.samples, material)},
            {"perfect_env", same.delta_e_env},
            {"photo_env", photo.delta_e_env},
            {"alike_env", alike.delta_e_env},
            {"perfect_lights", same.delta_e_lights},
            {"photo_lights", photo.delta_e_lights},
            {"intervals", photo.intervals.to_json()}};
  }

  const sphere_photograph_options& given_;
  sphere_laboratory laboratory_;
};

void print(const std::map<std::string, std::map<std::string, json>>& found) {
  std::cout << "| set | material | photographs with light | pixels | samples | centre off, pixels | median error of a "
               "sample | Delta E env: "
               "perfect | photographs | ratio | all samples alike | Delta E lights: perfect | photographs "
               "| within 68 % | within 95 % (worst region) |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [file, materials] : found)
    for (const auto& [name, errors] : materials) {
      const auto number = [&, &of = errors](const char* key) { return of[key].number(); };
      std::cout << "| " << file << " | " << name << " | " << errors["views"].text() << " | "
                << fixed(number("pixels"), 0) << " | " << fixed(number("samples"), 0) << " | "
                << fixed(number("off"), 2) << " | " << fixed(number("median_error"), 1) << " % | "
                << fixed(number("perfect_env"), 2) << " | " << fixed(number("photo_env"), 2) << " | "
                << fixed(number("photo_env") / number("perfect_env"), 2) << " | " << fixed(number("alike_env"), 2)
                << " | " << fixed(number("perfect_lights"), 2) << " | " << fixed(number("photo_lights"), 2) << " | "
                << interval_counts(errors["intervals"]).text() << " |\n";
    }
}

}  // namespace

void add_sphere_photograph(command& app, const team& processes) {
  auto command =
      app.add_subcommand("sphere-photograph", "Reconstruct measured materials from simulated photographs of a sphere");
  const auto options = std::make_shared<sphere_photograph_options>();
  add_left_out_options(command, *options);
  command.add_input("--directions", options->directions,
                    "Sphere designs (.csv): a photograph for each of their theta_d");
  command.add_option("--published", options->published, "Sets of Nielsen et al. 2015, Table 2: 1, 2 or 5 photographs");
  command
      .add_option("--coarser", options->coarser,
                  "Pixels are averaged over cells this many times as large as those of MERL's grid")
      .check(check::range(1, 10))
      .capture_default_str();
  command.add_option("--names", options->names, "Materials to photograph").capture_default_str();
  command.add_option("--noise", options->noise, "Relative noise of a pixel").capture_default_str();
  command.add_option("--pixels", options->pixels, "Rows and columns of the image")
      .check(check::range(64, 2048))
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<sphere_photograph_experiment>(given, [](const auto& found) { print(found); });
  });
}

}  // namespace papers
