/// gonio-papers shape-poses: errors of recovered ears if the initial pose is off, and is then held or refitted. After
/// "Anatomically correct surface recovery", section 2 and Algorithm 1.

#include "papers/experiments.hpp"
#include "papers/surfaces2016/ear_options.hpp"
#include "synthetic/ear_study.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/registration.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <Eigen/Geometry>

#include <array>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace papers {

namespace {

using gonio::shape::similarity_transform;

/// The error of a pose: a rotation about the centroid of the scan, and a shift, both in random directions.
struct pose_error {
  double degrees, millimetres;
};
constexpr std::array<pose_error, 5> pose_errors{{{0.0, 0.0}, {0.5, 0.1}, {1.0, 0.25}, {4.0, 1.0}, {16.0, 4.0}}};

/// A scan, its true pose in the model's space, and the initial pose.
struct posed_ear {
  const synthetic::ear_scan& scan;
  gonio::shape::surface_index index;
  similarity_transform right, initial;
};

/// Returns the error of a method in mm. Throws gonio::error if the method refuses the scan.
using judged_way = std::function<double(const posed_ear&)>;

struct named_way {
  std::string name;
  judged_way off;
};

similarity_transform moved(const similarity_transform& right, const synthetic::ear_scan& scan, const pose_error& by,
                           synthetic::number_source& numbers) {
  const auto any_direction = [&] {
    return Eigen::Vector3d(numbers.normal(), numbers.normal(), numbers.normal()).normalized().eval();
  };
  const Eigen::Vector3d middle = right(gonio::shape::centroid_of(scan.mesh.vertices));
  similarity_transform off;
  off.rotation = Eigen::AngleAxisd(gonio::radians(by.degrees), any_direction()).toRotationMatrix();
  off.translation = middle - off.rotation * middle + by.millimetres * any_direction();
  return off * right;
}

/// Returns the methods that recover a hole. Their error is the mean absolute distance from the truth in the hole.
std::vector<named_way> ways_to_recover(const gonio::shape::shape_model& model, const synthetic::ear_study& study,
                                       gonio::thread_count threads) {
  const auto in_hole = [&study, threads](const posed_ear& ear, const gonio::shape::recovered_shape& found) {
    const gonio::shape::point_columns in_scan = found.pose.inverse()(found.surface.vertices);
    return gonio::shape::distance_to(gonio::shape::surface_index(ear.scan.complete),
                                     gonio::shape::chosen_columns(in_scan, study.hole_of(ear.scan)), threads)
        .absolute_mean;
  };
  const auto recovers = [=, &model](bool holds_pose) -> judged_way {
    gonio::shape::recovery_options how;
    how.coarse.holds_pose = how.fine.holds_pose = holds_pose;
    return [=, &model](const posed_ear& ear) {
      return in_hole(ear, gonio::shape::recover(model, ear.index, ear.initial, how, threads));
    };
  };
  const auto algorithm_1 = [=, &model](bool fits_first, bool aligns) -> judged_way {
    gonio::shape::algorithm_1_options how;
    how.coarse.holds_pose = !fits_first;
    how.aligns = aligns;
    how.local_rounds = 0;
    return [=, &model](const posed_ear& ear) {
      return in_hole(ear, gonio::shape::recover_algorithm_1(model, ear.index, ear.initial, how, threads));
    };
  };
  return {{"recover, held", recovers(true)},
          {"recover, fitted", recovers(false)},
          {"Algorithm 1, held", algorithm_1(false, false)},
          {"Algorithm 1, aligned in its rounds", algorithm_1(false, true)},
          {"Algorithm 1, fitted before and aligned", algorithm_1(true, true)}};
}

/// Returns the methods that register a whole scan. Their error is the mean distance of the vertices from their true
/// positions.
std::vector<named_way> ways_to_register(const gonio::shape::shape_model& model, gonio::thread_count threads) {
  const auto registers = [&model, threads](bool holds_pose, bool realigns) -> judged_way {
    gonio::shape::registration_options how;
    how.fit.holds_pose = holds_pose;
    how.realigns = realigns;
    return [&model, how, threads](const posed_ear& ear) {
      const auto found = gonio::shape::register_scan(model, ear.index, ear.initial, how, threads);
      if (!found.accepted()) gonio::refuse(found.refusal);
      return (found.pose.inverse()(found.vertices) - ear.scan.truth).colwise().norm().mean();
    };
  };
  return {{"held, held", registers(true, false)},
          {"held, aligned anew", registers(true, true)},
          {"fitted, held", registers(false, false)},
          {"fitted, aligned anew", registers(false, true)}};
}

/// Returns the mean over the ears that were not refused, and the number of refused ones.
std::string cell_of(const std::vector<std::optional<double>>& off) {
  double sum = 0.0;
  Eigen::Index refused = 0;
  for (const auto& each : off) each ? sum += *each : static_cast<double>(++refused);
  const Eigen::Index found = std::ssize(off) - refused;
  std::string text = found > 0 ? cli::fixed(sum / static_cast<double>(found), 3) : "-";
  if (refused > 0) text += " (" + std::to_string(refused) + " refused)";
  return text;
}

void print_table(const std::vector<named_way>& ways, const std::vector<synthetic::ear_scan>& scans,
                 const gonio::shape::shape_model& model, std::uint64_t seed) {
  std::cout << "| pose off by |";
  for (const named_way& way : ways) std::cout << ' ' << way.name << " |";
  std::cout << "\n|---|";
  for (std::size_t i = 0; i < ways.size(); ++i) std::cout << "---|";
  std::cout << '\n';
  for (const pose_error& error : pose_errors) {
    std::vector<std::vector<std::optional<double>>> off(ways.size());
    synthetic::number_source numbers(seed);
    for (const synthetic::ear_scan& scan : scans) {
      const similarity_transform right = gonio::shape::align(scan.truth, model.mean().vertices);
      const posed_ear ear{scan, gonio::shape::surface_index(scan.mesh), right, moved(right, scan, error, numbers)};
      for (std::size_t i = 0; i < ways.size(); ++i) try {
          off[i].emplace_back(ways[i].off(ear));
        } catch (const gonio::error&) {
          off[i].emplace_back();
        }
    }
    std::cout << "| " << error.degrees << " degrees, " << error.millimetres << " mm |";
    for (const auto& each : off) std::cout << ' ' << cell_of(each) << " |";
    std::cout << std::endl;
  }
}

void print_poses(const ear_options& options) {
  const synthetic::ear_study study(options.seed);
  const gonio::shape::shape_model model = study.learn(options.shapes, options.threads);
  synthetic::scan_options with_hole;
  with_hole.hole = synthetic::hole_options::large();
  std::vector<synthetic::ear_scan> partial, whole;
  for (Eigen::Index i = 0; i < options.ears; ++i) {
    partial.push_back(study.held_out(i, with_hole));
    whole.push_back(study.held_out(i, {}));
  }
  std::cout << "Recovered large holes, mean absolute distance from the truth there, mm, over " << options.ears
            << " ears:\n\n";
  print_table(ways_to_recover(model, study, options.threads), partial, model, options.seed);
  std::cout
      << "\nRegistered whole scans, mean distance of the vertices from where they are on the ear, mm; the pose in "
         "the fit, then while the model is propagated:\n\n";
  print_table(ways_to_register(model, options.threads), whole, model, options.seed);
}

}  // namespace

void add_shape_poses(command& app) {
  auto command = app.add_subcommand("shape-poses", "Synthetic ears recovered from poses that are off, held or fitted");
  const auto options = std::make_shared<ear_options>();
  add_ear_options(command, *options);
  command.callback([options] { print_poses(*options); });
}

}  // namespace papers
