/// gonio lab calibrate: converts scans of a material and of the white reference to samples of the material's BRDF.

#include "lab.hpp"
#include "tool/options/calibration_options.hpp"
#include "tool/options/machine_choice.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/calibration.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/scan_journal.hpp>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

namespace cli {

namespace {

struct calibrate_command {
  std::filesystem::path material, reference, response, output;
  calibration_options calibration;
  bool nearest = false;   ///< use the nearest reading of the reference, not measured at the same poses
  bool brighter = false;  ///< the material may be brighter than the reference
};

/// Returns the calibration with the response estimated from both scans.
gonio::capture::calibration calibration_of(const calibrate_command& options, const gonio::io::recorded_scan& material,
                                           const gonio::io::recorded_scan& reference) {
  std::vector<gonio::capture::reading> all = readings_of(reference);
  std::ranges::move(readings_of(material), std::back_inserter(all));
  return calibration_of(options.calibration, all, material.largest_count);
}

/// Writes a line for each value of the responses.
void write_responses(const std::filesystem::path& path, const gonio::capture::calibration& known) {
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

void require_comparable(const calibrate_command& options, const gonio::io::recorded_scan& material,
                        const gonio::io::recorded_scan& reference) {
  const std::string both = options.material.string() + " and " + options.reference.string();
  if (material.largest_count != reference.largest_count) gonio::refuse(both + ": expected scans by the same camera");
  const auto same = [](const auto& a, const auto& b) { return a.wi == b.wi && a.wo == b.wo; };
  if (!options.nearest && !std::ranges::equal(material.poses, reference.poses, same))
    gonio::refuse(
        both +
        ": expected scans of the same poses; --nearest-reference uses the reference's reading with the nearest light");
}

/// Returns a material's reflectance at a pose, relative to the reference at the same pose or, if requested, under the
/// nearest light. If it cannot be measured, gives the reason.
gonio::capture::measured_reflectance measured_at(std::size_t pose, const gonio::io::recorded_scan& material,
                                                 const gonio::io::recorded_scan& reference,
                                                 const std::optional<gonio::capture::reference_readings>& nearest,
                                                 const gonio::capture::calibration& known) {
  const auto missing = [&](const char* what) {
    gonio::capture::measured_reflectance none{material.poses[pose]};
    none.doubt = std::string("the scan of the ") + what + " has no reading of this pose yet";
    return none;
  };
  const auto& seen = material.readings[pose];
  if (!seen) return missing("material");
  if (nearest) return nearest->measure(*seen, material.poses[pose], known);
  const auto& white = reference.readings[pose];
  if (!white) return missing("reference");
  return gonio::capture::measure_reflectance(*seen, *white, material.poses[pose], known);
}

void require_reference(const calibrate_command& options,
                       const std::vector<gonio::capture::measured_reflectance>& usable,
                       const gonio::capture::reference_reflectance& reflectance) {
  if (!options.brighter) try {
      gonio::capture::require_bright_reference(usable, reflectance);
    } catch (const gonio::error& refusal) {
      gonio::refuse({options.reference.native(), ": ", refusal.what(),
                     " (--brighter accepts this, for example if only a highlight was measured)"});
    }
}

void run(const calibrate_command& options) {
  // Read both scans, and calibrate the camera and the geometry.
  const auto material = gonio::io::read_scan(options.material), reference = gonio::io::read_scan(options.reference);
  require_comparable(options, material, reference);
  const gonio::capture::calibration known = calibration_of(options, material, reference);
  // Measure the reflectance of each pose, and print which poses are left out.
  std::vector<gonio::capture::measured_reflectance> usable;
  std::optional<gonio::capture::reference_readings> nearest;
  if (options.nearest) nearest = reference_readings_of(reference);
  for (std::size_t i = 0; i < material.poses.size(); ++i) {
    const auto found = measured_at(i, material, reference, nearest, known);
    if (found.is_usable())
      usable.push_back(found);
    else
      std::cout << "left out: pose " << i + 1 << ", " << in_degrees(material.poses[i]) << ": " << found.doubt << '\n';
  }
  if (usable.empty()) gonio::refuse(options.material.string() + ": no pose can be used");
  require_reference(options, usable, known.reflectance);
  // Write the samples, and print their uncertainty.
  gonio::sample_set samples;
  std::vector<double> deviations;
  for (const auto& each : usable) {
    samples.push_back(each.as_sample());
    deviations.push_back(each.relative_deviation());
  }
  gonio::io::write_samples(options.output, samples);
  if (!options.response.empty()) write_responses(options.response, known);
  std::cout << counted(std::ssize(samples), "sample") << ", each known to "
            << fixed(100.0 * gonio::upper_median(deviations), 2) << " % (median)\n";
  if (material.subject && reference.subject)
    std::cout << "of '" << material.subject->sample << "' beside '" << reference.subject->sample << "'\n";
}

}  // namespace

void add_lab_calibrate(command& lab) {
  auto command = lab.add_subcommand("calibrate", "Convert scans of a material and of the white reference to samples");
  const auto options = std::make_shared<calibrate_command>();
  command.add_input("material", options->material, "Scan of the material (.scan)").required();
  command
      .add_input("--reference", options->reference,
                 "Scan of the white reference at the same poses, or at any with --nearest-reference (.scan)")
      .required();
  add_calibration_options(command, options->calibration);
  command.add_flag("--nearest-reference", options->nearest,
                   "Use the reference reading with the nearest light, scaled by both cosines, if the reference was "
                   "measured at other poses");
  command.add_flag("--brighter", options->brighter,
                   "Accept a material that is brighter than the reference in most samples");
  command.add_output("--response", options->response, {".csv"}, "Camera response to write (.csv)");
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
