#pragma once
/// Measures many pairs of directions despite failures of the machine. The scan is planned, checked and ordered, and
/// each reading is stored immediately (Nielsen's thesis 2016, note on the gonioreflectometer, Table 1).

#include <gonio/capture/device.hpp>
#include <gonio/capture/trajectory.hpp>
#include <gonio/core/assertion.hpp>
#include <gonio/core/progress.hpp>

#include <Eigen/Core>

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture {

/// A pose that a scan could not measure: its number, counted from 0, and the reason.
struct missing_pose {
  Eigen::Index number = 0;
  std::string reason;
};

/// The path of a machine through pairs of directions.
struct scan_plan {
  std::vector<direction_pair> poses;      ///< the poses in the order of measurement
  std::vector<missing_pose> unreachable;  ///< numbered by their positions among the requested pairs
  double length = 0.0;                    ///< radians of travel from the first pose to the last
};

/// Returns the pair that a machine can measure: as given or, by reciprocity, with light and viewer exchanged. If
/// neither is possible, returns the obstacle for the pair as given.
template <goniometer Machine>
[[nodiscard]] placement place_either_way(const Machine& machine, const direction_pair& pair) {
  placement as_asked = machine.place(pair);
  if (as_asked.is_reachable()) return as_asked;
  placement exchanged = machine.place({pair.wo, pair.wi});
  return exchanged.is_reachable() ? exchanged : as_asked;
}

/// Returns a short path through all pairs that a machine can measure, and lists the unreachable ones.
template <goniometer Machine>
[[nodiscard]] scan_plan plan_scan(const Machine& machine, std::span<const direction_pair> pairs) {
  scan_plan plan;
  std::vector<direction_pair> reachable;
  for (Eigen::Index i = 0; i < std::ssize(pairs); ++i) {
    const placement found = place_either_way(machine, pairs[i]);
    if (found.is_reachable())
      reachable.push_back(found.at);
    else
      plan.unreachable.push_back({i, found.obstacle});
  }
  const auto order = short_way(
      reachable.size(), [&](Eigen::Index i, Eigen::Index j) { return machine.travel(reachable[i], reachable[j]); });
  for (const Eigen::Index i : order) plan.poses.push_back(reachable[i]);
  for (Eigen::Index i = 1; i < std::ssize(plan.poses); ++i)
    plan.length += machine.travel(plan.poses[i - 1], plan.poses[i]);
  return plan;
}

/// Storage for the readings of a scan. `has(pose)` returns true if the reading of the pose with this number is stored.
/// `add(pose, reading)` stores a reading, and returns only when a crash of the process cannot lose it any more.
///
/// With a model of the library, a file:
/// ```cpp
/// #include <gonio/io/measurements/scan_journal.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const std::vector<gonio::direction_pair> poses{{{0, 0, 1}, {0.6, 0, 0.8}}, {{0.6, 0, 0.8}, {0, 0, 1}}};
///   const gonio::io::scan_subject subject{.sample = "red paint", .setup = "bench 2"};
///   const gonio::io::scan_journal journal("red-paint.scan", subject, poses, 4095);
///   std::printf("the first pose is %s\n", journal.has(0) ? "measured" : "to be measured");
/// }
/// ```
/// With a model of your own, in memory, for a simulated machine:
/// ```cpp
/// #include <gonio/capture/scan.hpp>
///
/// #include <map>
///
/// struct readings_in_memory {
///   std::map<std::size_t, gonio::capture::reading> kept;
///   bool has(std::size_t pose) const { return kept.contains(pose); }
///   void add(std::size_t pose, const gonio::capture::reading& taken) { kept.emplace(pose, taken); }
/// };
/// static_assert(gonio::capture::scan_record<readings_in_memory>);
///
/// int main() {
///   readings_in_memory record;
///   record.add(0, {{0.1}, {gonio::capture::camera_frame::Constant(1, 3, 7)}});
///   return record.has(0) ? 0 : 1;
/// }
/// ```
template <class J>
concept scan_record = requires(J& record, const J& same, Eigen::Index pose, const reading& taken) {
  { same.has(pose) } -> std::convertible_to<bool>;
  record.add(pose, taken);
};

struct scan_options {
  int attempts = 2;           ///< attempts at a pose before the scan skips it
  int failures_in_a_row = 3;  ///< number of successive failing poses after which the scan stops
};

/// The result of a scan.
struct scan_outcome {
  Eigen::Index measured = 0, kept_before = 0;
  std::vector<missing_pose> missing;  ///< poses that were tried and not measured
  bool is_broken_off = false;         ///< too many poses failed in a row: the poses after the last were not tried

  [[nodiscard]] bool is_complete() const noexcept { return missing.empty() && !is_broken_off; }
};

namespace detail {

/// Returns the fault of a reading; empty if there is none.
[[nodiscard]] std::string fault_of(const reading& taken, std::uint16_t largest_count);

/// Retries a pose until it is measured. If every attempt fails, returns nothing and the reason.
template <goniometer Machine>
[[nodiscard]] std::pair<std::optional<reading>, std::string> try_to_measure(Machine& machine,
                                                                            const direction_pair& pose, int attempts) {
  std::string reason;
  for (int attempt = 0; attempt < attempts; ++attempt) try {
      reading taken = machine.measure(pose);
      reason = fault_of(taken, machine.largest_count());
      if (reason.empty()) return {std::move(taken), {}};
    } catch (const device_failure& failure) {
      reason = failure.what();
    }
  return {std::nullopt, reason};
}

}  // namespace detail

/// Measures the poses that a record does not have yet, in their order, and stores each reading before the machine moves
/// on. Skips a pose that cannot be reached, or that fails `attempts` times, by a failure of a device or a faulty
/// reading. Stops after `failures_in_a_row` such poses. Exceptions other than device_failure propagate; stored readings
/// remain stored.
template <goniometer Machine, scan_record Record>
scan_outcome scan(Machine& machine, std::span<const direction_pair> poses, Record& record,
                  const scan_options& options = {}, const progress& listener = {}) {
  GONIO_ASSERT(options.attempts > 0 && options.failures_in_a_row > 0);
  scan_outcome outcome;
  int failures = 0;
  for (Eigen::Index number = 0; number < std::ssize(poses); ++number) {
    report(listener, "scanning", static_cast<double>(number) / static_cast<double>(poses.size()));
    if (record.has(number)) {
      ++outcome.kept_before;
      continue;
    }
    if (const placement found = machine.place(poses[number]); !found.is_reachable()) {
      outcome.missing.push_back({number, found.obstacle});
      continue;
    }
    const auto [taken, reason] = detail::try_to_measure(machine, poses[number], options.attempts);
    if (taken) {
      record.add(number, *taken);
      ++outcome.measured;
      failures = 0;
      continue;
    }
    outcome.missing.push_back({number, reason});
    if (++failures < options.failures_in_a_row) continue;
    outcome.is_broken_off = true;
    break;
  }
  return outcome;
}

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/scan.ipp>
#endif
