/// gonio lab calibrate: scans of a material and of the white reference as samples of the material's BRDF.

#include "command_line/fixed.hpp"
#include "command_line/machine_choice.hpp"
#include "lab.hpp"
#include <gonio/capture/calibration.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/scan_journal.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct calibrate_command {
  std::filesystem::path material, reference, response, output;
  double gamma = 0.0;  ///< of a camera that is known; 0: find its response
  double reflectance = 0.99, saturation = 0.98;
  gonio::capture::sensor_noise noise{.read = 1.6, .shot = 0.2};
  bool brighter = false;  ///< the material than the reference
};

/// The readings of a scan that are there.
void append_readings(const gonio::io::recorded_scan& scan, std::vector<gonio::capture::reading>& all) {
  for (const auto& each : scan.readings)
    if (each) all.push_back(*each);
}

gonio::capture::calibration calibration_of(const calibrate_command& options, const gonio::io::recorded_scan& material,
                                           const gonio::io::recorded_scan& reference) {
  const std::uint16_t largest = material.largest_count;
  const auto saturation = static_cast<std::uint16_t>(std::lround(options.saturation * largest));
  if (options.gamma > 0.0) {
    const auto known = gonio::capture::camera_response::power_law(largest, options.gamma);
    return {{known, known, known}, options.noise, options.reflectance, saturation};
  }
  std::vector<gonio::capture::reading> all;
  append_readings(reference, all);
  append_readings(material, all);
  return {gonio::capture::estimate_responses(all, largest), options.noise, options.reflectance, saturation};
}

/// A line for each value of the responses.
void write_responses(const std::filesystem::path& path, const gonio::capture::calibration& known) {
  std::string text = "count,log_exposure_r,log_exposure_g,log_exposure_b\n";
  const auto& responses = known.responses;
  const auto knots = responses[0].log_exposures().size();
  for (Eigen::Index k = 0; k < knots; ++k) {
    text += gonio::io::detail::shortest(static_cast<double>(k + 1) * responses[0].largest_count() /
                                        static_cast<double>(knots));
    for (const gonio::capture::camera_response& each : responses)
      text += ',' + gonio::io::detail::shortest(each.log_exposures()[k]);
    text += '\n';
  }
  gonio::io::write_atomically(path, std::as_bytes(std::span(text)));
}

void require_same_poses(const calibrate_command& options, const gonio::io::recorded_scan& material,
                        const gonio::io::recorded_scan& reference) {
  const auto same = [](const auto& a, const auto& b) { return a.wi == b.wi && a.wo == b.wo; };
  if (material.largest_count != reference.largest_count || !std::ranges::equal(material.poses, reference.poses, same))
    gonio::refuse(options.material.string() + " and " + options.reference.string() +
                  ": expected scans of the same poses by the same camera");
}

void require_reference(const calibrate_command& options,
                       const std::vector<gonio::capture::measured_reflectance>& usable) {
  if (!options.brighter) try {
      gonio::capture::require_bright_reference(usable, options.reflectance);
    } catch (const gonio::error& refusal) {
      gonio::refuse({options.reference.native(), ": ", refusal.what(),
                     " (if not, as where only a highlight was measured: --brighter)"});
    }
}

void run(const calibrate_command& options) {
  // Read both scans, and calibrate the camera and the geometry.
  const auto material = gonio::io::read_scan(options.material), reference = gonio::io::read_scan(options.reference);
  require_same_poses(options, material, reference);
  const gonio::capture::calibration known = calibration_of(options, material, reference);
  // Measure the reflectance of each pose, and say which poses are left out.
  std::vector<gonio::capture::measured_reflectance> usable;
  const auto leave_out = [&](std::size_t pose, const std::string& reason) {
    std::cout << "left out: pose " << pose + 1 << ", " << in_degrees(material.poses[pose]) << ": " << reason << '\n';
  };
  for (std::size_t i = 0; i < material.poses.size(); ++i) {
    const auto &seen = material.readings[i], &white = reference.readings[i];
    if (!seen || !white) {
      leave_out(i, std::string("the scan of the ") + (seen ? "reference" : "material") + " does not have it yet");
      continue;
    }
    const auto found = gonio::capture::measure_reflectance(*seen, *white, material.poses[i], known);
    if (found.is_usable())
      usable.push_back(found);
    else
      leave_out(i, found.doubt);
  }
  if (usable.empty()) gonio::refuse(options.material.string() + ": no pose can be used");
  require_reference(options, usable);
  // Write the samples, and say how well they are known.
  gonio::sample_set samples;
  std::vector<double> deviations;
  for (const auto& each : usable) {
    samples.push_back(each.as_sample());
    deviations.push_back(each.relative_deviation());
  }
  gonio::io::write_samples(options.output, samples);
  if (!options.response.empty()) write_responses(options.response, known);
  std::cout << samples.size() << " samples, each known to " << fixed(100.0 * gonio::upper_median(deviations), 2)
            << " % (median)\n";
  if (material.subject && reference.subject)
    std::cout << "of '" << material.subject->sample << "' beside '" << reference.subject->sample << "'\n";
}

}  // namespace

void add_lab_calibrate(command& lab) {
  auto command = lab.add_subcommand("calibrate", "Turn scans of a material and of the white reference into samples");
  const auto options = std::make_shared<calibrate_command>();
  command.add_input("material", options->material, "Scan of the material (.scan)").required();
  command.add_input("--reference", options->reference, "Scan of the white reference at the same poses (.scan)")
      .required();
  command.add_option("--reflectance", options->reflectance, "Of the white reference")
      .check(check::range(0.01, 1.0))
      .capture_default_str();
  command
      .add_option("--gamma", options->gamma,
                  "The camera's response is known: counts are the exposure to the power of 1/gamma (1: linear)")
      .check(check::positive_number());
  command.add_option("--saturation", options->saturation, "Share of the largest count from which a pixel is saturated")
      .check(check::range(0.1, 1.0))
      .capture_default_str();
  command.add_option("--read-noise", options->noise.read, "Deviation of every count")
      .check(check::non_negative_number())
      .capture_default_str();
  command.add_option("--shot-noise", options->noise.shot, "Variance in counts for each count")
      .check(check::non_negative_number())
      .capture_default_str();
  command.add_option("--flicker", options->noise.relative, "Relative deviation of each exposure")
      .check(check::non_negative_number())
      .capture_default_str();
  command.add_flag("--brighter", options->brighter,
                   "The material is brighter than the reference in most samples, and that is right");
  command.add_output("--response", options->response, {".csv"}, "The camera's response, to write (.csv)");
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
