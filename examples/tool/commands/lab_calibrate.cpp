/// gonio lab calibrate: converts a scan of a material to samples of its BRDF, by a scan of the white reference (the
/// relative method) or of the lamp (the absolute method).

#include "lab.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/calibration_options.hpp"
#include "tool/options/machine_choice.hpp"
#include "tool/options/number_list.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/capture/calibration.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/scan_journal.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace cli {

namespace {

using gonio::capture::calibration;
using gonio::capture::measured_reflectance;
using gonio::io::recorded_scan;

struct calibrate_command {
  std::filesystem::path material, reference, lamp, response, output;
  calibration_options calibration;
  bool nearest = false;        ///< use the reference's reading with the nearest light, not at the same pose
  bool brighter = false;       ///< the material may be brighter than the reference
  double solid_angle = 0.0;    ///< of the lamp, in sr
  double transmittance = 1.0;  ///< of the filter before the lamp
  std::string lens;            ///< focal length, f-number, distance
};

/// Writes a line for each count at which the responses are tabulated, with the logarithm of the exposure in each
/// channel.
void write_responses(const std::filesystem::path& path, const calibration& known) {
  std::string text = "count,log_exposure_r,log_exposure_g,log_exposure_b\n";
  const auto& responses = known.responses;
  const auto knots = responses[0].log_exposures().size();
  for (Eigen::Index k = 0; k < knots; ++k) {
    text += gonio::io::shortest(static_cast<double>(k + 1) * responses[0].largest_count() / static_cast<double>(knots));
    for (const gonio::capture::camera_response& each : responses)
      text += ',' + gonio::io::shortest(each.log_exposures()[k]);
    text += '\n';
  }
  gonio::io::write_atomically(path, std::as_bytes(std::span(text)));
}

/// Throws gonio::error unless both scans are by the same camera.
void require_one_camera(const recorded_scan& material, const recorded_scan& other, const std::string& both) {
  if (material.largest_count != other.largest_count) gonio::refuse(both + ": expected scans by the same camera");
}

void require_comparable(const calibrate_command& options, const recorded_scan& material,
                        const recorded_scan& reference) {
  const std::string both = options.material.string() + " and " + options.reference.string();
  require_one_camera(material, reference, both);
  const auto same = [](const auto& a, const auto& b) { return a.wi == b.wi && a.wo == b.wo; };
  if (!options.nearest && !std::ranges::equal(material.poses, reference.poses, same))
    gonio::refuse(
        both +
        ": expected scans of the same poses; --nearest-reference uses the reference's reading with the nearest light");
}

/// Returns the calibration with the response estimated from all scans.
calibration calibration_of(const calibrate_command& options, const recorded_scan& material,
                           const std::optional<recorded_scan>& other) {
  std::vector<gonio::capture::reading> all;
  if (other) all = readings_of(*other);
  std::ranges::move(readings_of(material), std::back_inserter(all));
  return calibration_of(options.calibration, all, material.largest_count);
}

/// Returns the mean of a merged photograph of the lamp. What its pixels have in common, the lamp's and the shutter's
/// flicker, is its deviation.
std::array<gonio::capture::uncertain, 3> exposures_of(const std::filesystem::path& photograph, double flicker) {
  const gonio::image picture = read_radiance(photograph);
  const std::size_t pixels = picture.shape(0) * picture.shape(1);
  gonio::rgb sum = gonio::rgb::Zero();
  for (std::size_t i = 0; i < pixels; ++i) sum += gonio::pixel(picture, i / picture.shape(1), i % picture.shape(1));
  const gonio::rgb mean = sum / static_cast<double>(pixels);
  if (!(mean > 0.0).all() || !mean.isFinite().all())
    gonio::refuse({photograph.string(), ": expected a photograph of the lamp, positive and finite in each channel"});
  std::array<gonio::capture::uncertain, 3> exposures;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double value = mean[static_cast<Eigen::Index>(channel)];
    exposures[channel] = {value, flicker * value};
  }
  return exposures;
}

/// One of the two methods: its calibration, and the reflectance that it gives at each pose.
struct method {
  calibration known;
  std::function<measured_reflectance(std::size_t pose)> measure;
  std::string beside;  ///< the reference or the lamp; empty if the file does not say
};

measured_reflectance unmeasured(const gonio::direction_pair& pose, const std::string& subject) {
  measured_reflectance none{pose};
  none.doubt = "the scan of the " + subject + " has no reading of this pose yet";
  return none;
}

/// Returns the relative method: the reference at the same pose or, if requested, under the nearest light.
method relative_method(const calibrate_command& options, const recorded_scan& material) {
  const auto reference = std::make_shared<recorded_scan>(gonio::io::read_scan(options.reference));
  require_comparable(options, material, *reference);
  const calibration known = calibration_of(options, material, *reference);
  std::optional<gonio::capture::reference_readings> nearest;
  if (options.nearest) nearest = reference_readings_of(*reference);
  const auto measure = [=, &material](std::size_t pose) {
    const auto& seen = material.readings[pose];
    if (!seen) return unmeasured(material.poses[pose], "material");
    if (nearest) return nearest->measure(*seen, material.poses[pose], known);
    const auto& white = reference->readings[pose];
    if (!white) return unmeasured(material.poses[pose], "reference");
    return gonio::capture::measure_reflectance(*seen, *white, material.poses[pose], known);
  };
  return {known, measure, reference->subject ? reference->subject->sample : ""};
}

/// Returns the absolute method: the lamp itself, by a scan or by a photograph.
method absolute_method(const calibrate_command& options, const recorded_scan& material) {
  std::optional<recorded_scan> scan;
  if (lower_extension(options.lamp) == ".scan") {
    scan = gonio::io::read_scan(options.lamp);
    require_one_camera(material, *scan, options.material.string() + " and " + options.lamp.string());
  }
  const calibration known = calibration_of(options, material, scan);
  const auto exposures = [&] {
    if (!scan) return exposures_of(options.lamp, known.noise.relative);
    try {
      return gonio::capture::mean_exposures(readings_of(*scan), known);
    } catch (const gonio::error& refusal) {
      gonio::refuse({options.lamp.string(), ": ", refusal.what(), " (a lamp needs a filter of another density)"});
    }
  }();
  const gonio::capture::measured_lamp lamp{exposures, options.solid_angle, options.transmittance};
  const auto measure = [=, &material](std::size_t pose) {
    const auto& seen = material.readings[pose];
    if (!seen) return unmeasured(material.poses[pose], "material");
    return gonio::capture::measure_reflectance(*seen, lamp, material.poses[pose], known);
  };
  return {known, measure, scan && scan->subject ? scan->subject->sample : ""};
}

void require_reference(const calibrate_command& options, const std::vector<measured_reflectance>& usable,
                       const gonio::capture::reference_reflectance& reflectance) {
  if (!options.brighter) try {
      gonio::capture::require_bright_reference(usable, reflectance);
    } catch (const gonio::error& refusal) {
      gonio::refuse({options.reference.native(), ": ", refusal.what(),
                     " (--brighter accepts this, for example if only a highlight was measured)"});
    }
}

/// Warns if most samples are brighter than a perfect white.
void warn_of_bright(const std::vector<measured_reflectance>& usable) {
  const auto bright =
      std::ranges::count_if(usable, [](const auto& each) { return each.value.mean() > 1.05 * std::numbers::inv_pi; });
  if (2 * bright > std::ssize(usable))
    warn(std::to_string(bright) + " of " + counted(std::ssize(usable), "sample") +
         " are brighter than a perfect white: are --lamp-solid-angle and --filter-transmittance right?");
}

/// The cone of directions in which a lens receives light from a point of the sample (Eq. 1, 4 and 5).
struct lens_cone {
  double half_angle = 0.0, solid_angle = 0.0;
};

lens_cone cone_of(const std::string& lens) {
  const auto numbers = numbers_in(lens, "--lens");
  if (numbers.size() != 3) gonio::refuse({"--lens ", lens, ": expected FOCAL,F_NUMBER,DISTANCE"});
  try {
    return {gonio::capture::pixel_half_angle(numbers[0], numbers[1], numbers[2]),
            gonio::capture::pixel_solid_angle(numbers[0], numbers[1], numbers[2])};
  } catch (const gonio::error& refusal) {
    gonio::refuse({"--lens ", lens, ": ", refusal.what()});
  }
}

/// Prints the cone, and the smallest and largest reflectance into it (Eq. 13).
void describe(const lens_cone& cone, const std::vector<measured_reflectance>& usable) {
  std::vector<double> reflectances;
  for (const measured_reflectance& each : usable)
    reflectances.push_back(gonio::capture::reflectance_into(each.value.mean(), cone.solid_angle, each.at.wo.z()));
  const auto [least, most] = std::ranges::minmax(reflectances);
  std::cout << "lens: half angle " << fixed(gonio::degrees(cone.half_angle), 3)
            << " degrees (gonio reconstruct --receiver-half-angle), solid angle " << significant(cone.solid_angle)
            << " sr; it receives " << significant(least) << " to " << significant(most) << " of the light\n";
}

void write(const calibrate_command& options, const std::vector<measured_reflectance>& usable) {
  gonio::sample_set samples;
  std::vector<double> deviations;
  for (const auto& each : usable) {
    samples.push_back(each.as_sample());
    deviations.push_back(each.relative_deviation());
  }
  gonio::io::write_samples(options.output, samples);
  std::cout << counted(std::ssize(samples), "sample") << ", each known to "
            << fixed(100.0 * gonio::upper_median(deviations), 2) << " % (median)\n";
}

void run(const calibrate_command& options) {
  std::optional<lens_cone> lens;
  if (!options.lens.empty()) lens = cone_of(options.lens);
  // Read the scans, and calibrate the camera and the geometry.
  const recorded_scan material = gonio::io::read_scan(options.material);
  const bool is_absolute = !options.lamp.empty();
  const method by = is_absolute ? absolute_method(options, material) : relative_method(options, material);
  // Measure the reflectance of each pose, and print which poses cannot be used.
  std::vector<measured_reflectance> usable;
  for (std::size_t i = 0; i < material.poses.size(); ++i) {
    const auto found = by.measure(i);
    if (found.is_usable())
      usable.push_back(found);
    else
      std::cout << "not usable: pose " << i + 1 << ", " << in_degrees(material.poses[i]) << ": " << found.doubt << '\n';
  }
  if (usable.empty()) gonio::refuse(options.material.string() + ": no pose can be used");
  if (!is_absolute) require_reference(options, usable, by.known.reflectance);
  // Write the samples, and print their uncertainty.
  if (is_absolute) warn_of_bright(usable);
  write(options, usable);
  if (!options.response.empty()) write_responses(options.response, by.known);
  if (material.subject && !by.beside.empty())
    std::cout << "of '" << material.subject->sample << "' beside '" << by.beside << "'\n";
  if (lens) describe(*lens, usable);
}

/// Refuses an option of the method that is not chosen.
void require_taken(const command& given) {
  const bool is_absolute = given.count("--lamp") > 0;
  for (const char* option : {"--reflectance", "--nearest-reference", "--brighter"})
    if (is_absolute && given.count(option) > 0) gonio::refuse({option, " needs --reference, not --lamp"});
  for (const char* option : {"--lamp-solid-angle", "--filter-transmittance"})
    if (!is_absolute && given.count(option) > 0) gonio::refuse({option, " needs --lamp, not --reference"});
  if (is_absolute && given.count("--lamp-solid-angle") == 0)
    gonio::refuse("--lamp needs --lamp-solid-angle, that of the lamp seen from the sample in sr");
}

}  // namespace

void add_lab_calibrate(command& lab) {
  auto command = lab.add_subcommand("calibrate",
                                    "Convert scans of a material and of the white reference, or the lamp, to samples");
  const auto options = std::make_shared<calibrate_command>();
  command.add_input("material", options->material, "Scan of the material (.scan)").required();
  // Declare the two methods.
  auto beside = command.add_option_group("light", "Measurement of the light");
  beside.add_input("--reference", options->reference,
                   "Scan of the white reference (.scan) at the same poses or, with --nearest-reference, at any poses");
  beside.add_input(
      "--lamp", options->lamp,
      "Scan with the camera looking into the lamp (.scan), or such a photograph, merged and cropped to the "
      "lamp (" +
          radiance_formats() + ")");
  beside.require_option(1);
  command
      .add_option("--lamp-solid-angle", options->solid_angle,
                  "With --lamp: its solid angle seen from the sample, in sr")
      .check(check::range(1e-9, 2.0 * std::numbers::pi));
  command
      .add_option("--filter-transmittance", options->transmittance,
                  "With --lamp: transmittance of the filter through which the camera saw it")
      .check(check::range(1e-9, 1.0))
      .capture_default_str();
  command.add_flag("--nearest-reference", options->nearest,
                   "Use the reference reading with the nearest light, scaled by both cosines, if the reference was "
                   "measured at other poses");
  command.add_flag("--brighter", options->brighter,
                   "Accept a material that is brighter than the reference in most samples");
  add_calibration_options(command, options->calibration);
  // Declare the results.
  command.add_option("--lens", options->lens,
                     "Focal length, f-number and distance to the sample, FOCAL,F_NUMBER,DISTANCE: print the cone that "
                     "the lens receives, and the reflectances into it");
  command.add_output("--response", options->response, {".csv"}, "Camera response to write (.csv)");
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([options, command] {
    require_taken(command);
    run(*options);
  });
}

}  // namespace cli
