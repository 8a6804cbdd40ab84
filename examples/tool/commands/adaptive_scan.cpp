#include "adaptive_scan.hpp"

#include "tool/options/machine_choice.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/fixed.hpp"

#include <algorithm>
#include <iostream>

namespace cli {

namespace {

gonio::io::recorded_scan read_reference(const adaptive_options& options, std::uint16_t largest_count) {
  gonio::io::recorded_scan scan = gonio::io::read_scan(options.reference);
  if (scan.largest_count != largest_count)
    gonio::refuse({options.reference.string(), ": the largest count of its camera is ", scan.largest_count,
                   ", but this scan's camera has ", largest_count});
  if (scan.measured() == 0) gonio::refuse({options.reference.string(), ": the reference has no reading yet"});
  return scan;
}

}  // namespace

adaptive_choice::adaptive_choice(const adaptive_options& options, const calibration_options& calibration,
                                 std::uint16_t largest_count)
    : adaptive_choice(options, calibration, read_reference(options, largest_count)) {}

adaptive_choice::adaptive_choice(const adaptive_options& options, const calibration_options& calibration,
                                 const gonio::io::recorded_scan& reference)
    : options_(options),
      calibration_(calibration_of(calibration, readings_of(reference), reference.largest_count)),
      reference_(reference_readings_of(reference)),
      chooser_(gonio::reconstruction{read_prior(options.prior), {.noise = gonio::design::usual_apparatus().noise}},
               gonio::design::usual_apparatus()) {}

gonio::sample_set adaptive_choice::samples_of(const gonio::io::recorded_scan& scan) const {
  gonio::sample_set samples;
  for (std::size_t i = 0; i < scan.poses.size(); ++i) {
    if (!scan.readings[i]) continue;
    const auto found = reference_.measure(*scan.readings[i], scan.poses[i], calibration_);
    if (found.is_usable()) samples.push_back(found.as_sample());
  }
  if (samples.empty()) gonio::refuse("no reading of the scan can be used to choose the next pose");
  return samples;
}

std::optional<gonio::direction_pair> adaptive_choice::next(
    const gonio::io::recorded_scan& scan, const std::function<bool(const gonio::direction_pair&)>& is_reachable) const {
  const gonio::sample_set samples = samples_of(scan);
  const double known_to = chooser_.candidates().estimator().fit(samples).certainty().known_to;
  std::cout << counted(std::ssize(samples), "sample") << ": half of all directions are " << cli::known_to(known_to, 1)
            << '\n';
  if (known_to <= options_.until) return std::nullopt;
  if (std::ssize(scan.poses) >= options_.most) {
    std::cout << "stopped at --most " << options_.most << " poses, before --until "
              << gonio::io::shortest(options_.until) << " was reached\n";
    return std::nullopt;
  }
  // A failed pose is tried again, but not chosen again.
  const auto is_new = [&](const gonio::direction_pair& pair) {
    return std::ranges::none_of(scan.poses, [&](const gonio::direction_pair& known) {
      return gonio::angle_between(known.wi, pair.wi) < 1e-6 && gonio::angle_between(known.wo, pair.wo) < 1e-6;
    });
  };
  const auto may_be_chosen = [&](const gonio::direction_pair& pair) { return is_reachable(pair) && is_new(pair); };
  const gonio::next_measurement best = chooser_.choose(samples, 1, may_be_chosen).front();
  std::cout << "next: " << in_degrees(best.pose) << '\n';
  return best.pose;
}

}  // namespace cli
