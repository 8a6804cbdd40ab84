/// gonio-papers near-field-photographs: measured materials reconstructed from raw close-up photographs of a flat
/// sample, compared with perfect images of radiance. The photographs are simulated: exposure brackets by a noisy sensor
/// behind a lens with distortion and vignetting. Light and camera are slightly off their stated positions.

#include "lab/near_field_lab.hpp"
#include "lab/photographs.hpp"
#include "lab/white_material.hpp"
#include "papers/experiments.hpp"
#include "papers/our_own/photographed_materials.hpp"
#include "tool/files/json.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/capture/merged_frames.hpp>
#include <gonio/capture/near_field_image.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace papers {

namespace {

struct near_field_photographs_options : left_out_options {
  std::filesystem::path directions;
  std::vector<std::string> names{"vch_golden_yellow", "paper_white", "chm_light_blue"};
  double field_of_view = 25.0;  ///< degrees
  double noise = 0.02;
  double angular_error = 0.5;  ///< degrees
  Eigen::Index pixels = 192, block = 4;
};

/// The laboratory: a camera at distance 1 from a sample that exceeds the evaluated area, and a lamp at distance 4.
class near_field_laboratory {
 public:
  explicit near_field_laboratory(const near_field_photographs_options& given) : given_(given) {}

  /// Returns the setup of a view as the experimenter states it.
  [[nodiscard]] gonio::capture::near_field_setup setup(const gonio::direction_pair& pair) const {
    const double field_of_view = gonio::radians(given_.field_of_view);
    const gonio::lens_camera camera(gonio::design::near_field_camera(pair.wo, field_of_view, given_.pixels),
                                    {.k1 = -0.2, .k2 = 0.05, .p1 = 0.002, .p2 = -0.001});
    constexpr double lamp_distance = 4.0;
    const gonio::capture::point_lamp lamp{lamp_distance * pair.wi, gonio::rgb::Constant(lamp_distance * lamp_distance)};
    return {.camera = camera,
            .light = lamp,
            .disc = gonio::capture::sample_disc{std::tan(field_of_view / 2.0)},
            .block = static_cast<std::size_t>(given_.block),
            .white_reflectance = reflectance_of_white};
  }

  /// Returns the true setup, with light and camera off their stated positions.
  [[nodiscard]] gonio::capture::near_field_setup true_setup(const gonio::capture::near_field_setup& stated,
                                                            std::uint64_t seed) const {
    std::mt19937_64 generator(seed);
    return lab::misaligned(stated, gonio::radians(given_.angular_error), generator);
  }

  template <class Brdf>
  [[nodiscard]] gonio::image radiance(const Brdf& material, const gonio::capture::near_field_setup& truth,
                                      double noise = 0.0, std::uint64_t seed = 0) const {
    constexpr double sample_radius = 1.0;
    return lab::photograph(material, {sample_radius}, truth, {.noise = noise}, seed);
  }

  /// Takes an exposure bracket of raw frames and dark frames with one camera, and merges them.
  template <class Brdf>
  [[nodiscard]] gonio::capture::merged_frames photograph(const Brdf& material,
                                                         const gonio::capture::near_field_setup& truth,
                                                         std::uint64_t seed) const {
    // White saturates in about 0.04 s; a highlight is a thousand times brighter.
    constexpr std::array<double, 9> times{6.4e-6,    2.56e-5, 1.024e-4, 4.096e-4, 1.6384e-3,
                                          6.5536e-3, 0.026,   0.105,    0.42};
    const lab::photograph_settings settings = lab::photograph_settings::usual();
    const auto frames = lab::photograph_bracket(radiance(material, truth, given_.noise, seed), times, settings, seed);
    const auto pixels = static_cast<std::size_t>(given_.pixels);
    const std::array<double, 2> dark_times{times.front(), times.back()};
    const gonio::capture::dark_signal dark(lab::photograph_dark(pixels, pixels, dark_times, 4, settings, seed));
    const auto linear = gonio::capture::camera_response::power_law(
        gonio::capture::counts_above(settings.chip.largest_count, dark), 1.0);
    return gonio::capture::merge_frames(frames, {linear, linear, linear}, dark,
                                        {.noise = lab::noise_of(settings), .saturation = saturating_count});
  }

  static constexpr double reflectance_of_white = 0.98;

 private:
  static constexpr std::uint16_t saturating_count = 4013;  ///< 98 % of the largest

  const near_field_photographs_options& given_;
};

/// Returns the pixels that are not hot and whose exposures agree, in both images.
std::vector<bool> sound_pixels(const gonio::capture::merged_frames& one, const gonio::capture::merged_frames& other) {
  using gonio::capture::value_state;
  std::vector<bool> sound;
  for (Eigen::Index pixel = 0; pixel < std::ssize(one.states) / 3; ++pixel) {
    const auto is_sound = [&](const auto& merged) {
      const value_state state = merged.pixel_state(pixel);
      return state != value_state::hot && state != value_state::contradictory;
    };
    sound.push_back(is_sound(one) && is_sound(other));
  }
  return sound;
}

/// Returns the radiance with infinity at saturated values. These are only lower bounds, so no block may average over
/// them.
gonio::image with_infinite_saturation(const gonio::capture::merged_frames& merged) {
  gonio::image radiance = merged.radiance;
  for (std::size_t i = 0; i < radiance.size(); ++i)
    if (merged.states[i] == gonio::capture::value_state::saturated)
      radiance.data()[i] = std::numeric_limits<float>::infinity();
  return radiance;
}

/// The samples of all views.
struct views {
  std::vector<gonio::sample_set> perfect;    ///< perfect images, light and camera as stated
  std::vector<gonio::sample_set> misplaced;  ///< perfect images, light and camera off their stated positions
  std::vector<gonio::sample_set> raw;        ///< raw frames
};

gonio::sample_set joined(const std::vector<gonio::sample_set>& parts) {
  gonio::sample_set all;
  for (const gonio::sample_set& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

class near_field_photographs_experiment : photograph_experiment {
 public:
  near_field_photographs_experiment(const near_field_photographs_options& given, progress_bar& bar)
      : photograph_experiment(given, given.names, bar),
        given_(given),
        laboratory_(given),
        poses_(gonio::io::read_direction_pairs(given.directions)) {}

  [[nodiscard]] std::map<std::string, json> run() {
    std::map<std::string, json> found;
    for (std::size_t number = 0; number < given_.names.size(); ++number) {
      const std::string& name = given_.names[number];
      const json key{"near-field-photographs",
                     "intervals",
                     name,
                     given_.directions.filename().string(),
                     given_.components,
                     given_.noise,
                     given_.angular_error,
                     given_.field_of_view,
                     given_.pixels,
                     given_.block};
      found[name] = once(key, number, name, [&] { return errors_of(material(name)); });
    }
    return found;
  }

 private:
  [[nodiscard]] views photograph(const judged_material& material) const {
    const measured_brdf brdf{material.measured};
    views taken;
    for (const gonio::direction_pair& pose : poses_) {
      const std::uint64_t seed = 1000 * (material.number + 1) + 10 * taken.raw.size();
      gonio::capture::near_field_setup stated = laboratory_.setup(pose);
      const gonio::capture::near_field_setup truth = laboratory_.true_setup(stated, seed);
      taken.perfect.push_back(near_field_samples(laboratory_.radiance(brdf, stated), stated));
      taken.misplaced.push_back(near_field_samples(laboratory_.radiance(brdf, truth), stated));
      // The white reference replaces the sample.
      constexpr double reflectance = near_field_laboratory::reflectance_of_white;
      const auto merged = laboratory_.photograph(brdf, truth, seed + 1);
      const auto white = laboratory_.photograph(lab::white_material{reflectance}, truth, seed + 2);
      stated.mask = sound_pixels(merged, white);
      stated.saturation = std::numeric_limits<float>::max();
      taken.raw.push_back(
          near_field_samples(with_infinite_saturation(merged), stated,
                             gonio::capture::white_reference{with_infinite_saturation(white), reflectance, {}}));
    }
    return taken;
  }

  /// Returns the samples with refined poses of light and camera, like `gonio near-field --misplaced`.
  [[nodiscard]] gonio::sample_set refined(const gonio::log_relative_pca& prior,
                                          const std::vector<gonio::sample_set>& images,
                                          gonio::light_calibration calibrated_by) const {
    if (given_.angular_error == 0.0) return joined(images);
    gonio::pose_refinement refinement(
        prior, images,
        {.deviation = gonio::radians(given_.angular_error), .calibrated_by = calibrated_by, .threads = given_.threads});
    refinement.solve();
    return refinement.samples();
  }

  [[nodiscard]] json errors_of(const judged_material& material) const {
    const gonio::log_relative_pca prior = prior_of(material);
    const estimator_type estimator = estimator_of(prior);
    const views taken = photograph(material);
    const gonio::sample_set misplaced = refined(prior, taken.misplaced, gonio::light_calibration::irradiance);
    const gonio::sample_set raw = refined(prior, taken.raw, gonio::light_calibration::reference_in_place);
    const gonio::sample_set stated = joined(taken.raw);
    const auto perfect_error = judged(estimator, joined(taken.perfect), material),
               misplaced_error = judged(estimator, misplaced, material),
               stated_error = judged(estimator, stated, material), raw_error = judged(estimator, raw, material);
    return {{"samples", raw.size()},
            {"stated_error", 100.0 * median_error(stated, material)},
            {"refined_error", 100.0 * median_error(raw, material)},
            {"perfect_env", perfect_error.delta_e_env},
            {"misplaced_env", misplaced_error.delta_e_env},
            {"stated_env", stated_error.delta_e_env},
            {"raw_env", raw_error.delta_e_env},
            {"perfect_lights", perfect_error.delta_e_lights},
            {"raw_lights", raw_error.delta_e_lights},
            {"intervals", raw_error.intervals.to_json()}};
  }

  const near_field_photographs_options& given_;
  near_field_laboratory laboratory_;
  std::vector<gonio::direction_pair> poses_;
};

void print(const std::map<std::string, json>& found) {
  std::cout
      << "| material | samples | median error of a sample, as stated | pose found | Delta E env: perfect images | "
         "perfect, pose off | raw frames, as stated | raw frames, pose found | ratio to perfect | to perfect, pose "
         "off | Delta E lights: perfect | raw frames | within 68 % | "
         "within 95 % (worst region) |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, errors] : found) {
    const auto number = [&, &of = errors](const char* key) { return of[key].number(); };
    std::cout << "| " << name << " | " << fixed(number("samples"), 0) << " | " << fixed(number("stated_error"), 1)
              << " % | " << fixed(number("refined_error"), 1) << " % | " << fixed(number("perfect_env"), 2) << " | "
              << fixed(number("misplaced_env"), 2) << " | " << fixed(number("stated_env"), 2) << " | "
              << fixed(number("raw_env"), 2) << " | " << fixed(number("raw_env") / number("perfect_env"), 2) << " | "
              << fixed(number("raw_env") / number("misplaced_env"), 2) << " | " << fixed(number("perfect_lights"), 2)
              << " | " << fixed(number("raw_lights"), 2) << " | " << interval_counts(errors["intervals"]).text()
              << " |\n";
  }
}

}  // namespace

void add_near_field_photographs(command& app, const team& processes) {
  auto command = app.add_subcommand("near-field-photographs",
                                    "Reconstruct measured materials from simulated raw photographs of a flat sample");
  const auto options = std::make_shared<near_field_photographs_options>();
  add_left_out_options(command, *options);
  command.add_input("--directions", options->directions, "Light and camera of each view (.csv)").required();
  command.add_option("--names", options->names, "Materials to photograph").capture_default_str();
  command.add_option("--fov", options->field_of_view, "Field of view in degrees")
      .check(check::range(1.0, 89.0))
      .capture_default_str();
  command.add_option("--noise", options->noise, "Relative noise of a pixel, in addition to the noise of the chip")
      .check(check::non_negative_number())
      .capture_default_str();
  command
      .add_option("--angular-error", options->angular_error, "Angle in degrees by which light and camera each are off")
      .check(check::range(0.0, 45.0))
      .capture_default_str();
  command.add_option("--pixels", options->pixels, "Rows and columns of the image")
      .check(check::range(16, 2048))
      .capture_default_str();
  command.add_option("--block", options->block, "Rows and columns of the blocks of pixels that become one sample each")
      .check(check::range(1, 64))
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<near_field_photographs_experiment>(given, [](const auto& found) { print(found); });
  });
}

}  // namespace papers
