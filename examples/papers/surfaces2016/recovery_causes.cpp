/// gonio-papers shape-causes: why Algorithm 1 is less accurate here than in its paper. Changes the start, the rounds,
/// the scans, the holes and the learned shapes one at a time. After "Anatomically correct surface recovery", section 4.

#include "papers/experiments.hpp"
#include "papers/surfaces2016/ear_options.hpp"
#include "papers/surfaces2016/nelder_mead.hpp"
#include "synthetic/ear_study.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/registration.hpp>
#include <gonio/shape/surface_distance.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace papers {

namespace {

using gonio::shape::algorithm_1_options;
using gonio::shape::fit_to_scan_result;
using gonio::shape::point_columns;
using gonio::shape::recovered_shape;
using gonio::shape::shape_model;
using gonio::shape::similarity_transform;
using gonio::shape::surface_index;

struct shape_causes_command : ear_options {
  std::string hole = "small";
  std::vector<std::string> rows;
};

/// A scan with a hole, and its true values.
struct causes_ear {
  synthetic::ear_scan scan;
  surface_index index, complete;
  std::vector<Eigen::Index> hole;
  similarity_transform right;  ///< its true pose in the model's space

  causes_ear(const synthetic::ear_study& study, const shape_model& model, Eigen::Index number,
             const synthetic::scan_options& how)
      : scan(study.held_out(number, how)),
        index(scan.mesh),
        complete(scan.complete),
        hole(study.hole_of(scan)),
        right(gonio::shape::align(scan.truth, model.mean().vertices)) {}
};

using recovering = std::function<recovered_shape(const shape_model&, const causes_ear&)>;

/// Errors of the vertices, mm, as means over the ears.
struct mean_distances {
  double signed_size = 0.0;  ///< of the magnitudes of the ears' signed means, as in the paper's table
  double absolute = 0.0;

  void add(const gonio::shape::surface_distance& off, double share) {
    signed_size += share * std::abs(off.signed_mean);
    absolute += share * off.absolute_mean;
  }
};

void print_row(const std::string& name, const shape_model& model, const std::vector<causes_ear>& ears,
               const recovering& recover) {
  mean_distances in_hole, everywhere;
  for (const causes_ear& ear : ears) {
    const recovered_shape found = recover(model, ear);
    const point_columns in_scan = found.pose.inverse()(found.surface.vertices);
    const double share = 1.0 / static_cast<double>(ears.size());
    in_hole.add(gonio::shape::distance_to(ear.complete, gonio::shape::chosen_columns(in_scan, ear.hole)), share);
    everywhere.add(gonio::shape::distance_to(ear.complete, in_scan), share);
  }
  std::cout << "| " << name;
  for (const double mean : {in_hole.signed_size, in_hole.absolute, everywhere.signed_size, everywhere.absolute})
    std::cout << " | " << cli::fixed(mean, 3);
  std::cout << " |" << std::endl;
}

/// Returns the weights of a shape in the model's space, by least squares.
Eigen::VectorXd weights_of(const gonio::shape::shape_basis& basis, const point_columns& shape) {
  const std::vector<bool> all(shape.cols(), true);
  return gonio::shape::fit_shape(basis, gonio::tikhonov{1e-9}, gonio::shape::vertex_observations::marked(shape, all),
                                 {1})
      .weights();
}

/// Returns an initial fit for Algorithm 1 with the given weights.
fit_to_scan_result initial_fit(const shape_model& part, const similarity_transform& pose,
                               const Eigen::VectorXd& weights) {
  const point_columns shape = gonio::shape::shape_of(part.basis(), weights);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(weights.size() + gonio::shape::shape_with_motion::motions);
  all.head(weights.size()) = weights;
  return {pose, gonio::shape::shape_with_motion(part.basis(), shape), all, {}, gonio::tikhonov{1.0}, 0};
}

/// Fits as section 2 does: aligns by closest points, then finds the weights by downhill simplex over the mean distance
/// (Eq. 3), in turns.
fit_to_scan_result fit_by_simplex(const shape_model& model, const causes_ear& ear, int evaluations, int turns) {
  const shape_model part = model.truncated_to_variance(0.99);
  const double deviation = 1.0 / std::sqrt(static_cast<double>(part.shapes()));  // of a weight
  gonio::shape::posed_scan posed{ear.index, ear.right};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(part.basis().size());
  for (int turn = 0; turn < turns; ++turn) {
    const auto correspondences =
        gonio::shape::closest_correspondences(posed, part.shape(weights), gonio::shape::correspondence_options{}, {1});
    const point_columns shape = gonio::shape::shape_of(part.basis(), weights);
    const auto step =
        gonio::shape::align(correspondences.positions, gonio::shape::chosen_columns(shape, correspondences.vertices));
    posed.pose = step * posed.pose;
    std::vector<Eigen::Index> some;
    for (std::size_t i = 0; i < correspondences.vertices.size(); i += 4) some.push_back(correspondences.vertices[i]);
    const auto mean_distance = [&](const Eigen::VectorXd& scaled) {
      const point_columns moved = gonio::shape::shape_of(part.basis(), deviation * scaled);
      double sum = 0.0;
      for (const Eigen::Index vertex : some) sum += posed.closest(moved.col(vertex)).distance;
      return sum / static_cast<double>(some.size());
    };
    weights = deviation * nelder_mead(mean_distance, weights / deviation, {.most_evaluations = evaluations});
  }
  return initial_fit(part, posed.pose, weights);
}

recovering algorithm_1(const algorithm_1_options& how) {
  return [how](const shape_model& model, const causes_ear& ear) {
    return gonio::shape::recover_algorithm_1(model, ear.index, ear.right, how, {1});
  };
}

recovering algorithm_1_after(std::function<fit_to_scan_result(const shape_model&, const causes_ear&)> find_initial,
                             const algorithm_1_options& how) {
  return [find_initial = std::move(find_initial), how](const shape_model& model, const causes_ear& ear) {
    return gonio::shape::recover_algorithm_1(model, ear.index, find_initial(model, ear), how, {1});
  };
}

/// Learns from whole scans that a first model registers, as the paper's model does.
shape_model learn_from_registered(const shape_model& first, const synthetic::ear_study& study, Eigen::Index count) {
  std::vector<point_columns> shapes;
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < count; ++i) {
    const synthetic::ear_scan scan = study.held_out(1000 + i, {});
    const auto right = gonio::shape::align(scan.truth, first.mean().vertices);
    const auto found = gonio::shape::register_scan(first, surface_index(scan.mesh), right, {}, {1});
    if (!found.accepted()) continue;
    shapes.push_back(found.vertices);
    names.push_back("ear-" + std::to_string(i + 1));
  }
  return gonio::shape::learn_shape_model(shapes, names, first.triangles(), {1});
}

/// Prints the rows that change Algorithm 1's start or rounds, and two for comparison.
void print_changed_rounds(const std::function<void(const std::string&, const recovering&)>& row,
                          const algorithm_1_options& ten_rounds) {
  const auto changed = [&](const std::string& name, auto&& change) {
    algorithm_1_options how = ten_rounds;
    change(how);
    row(name, algorithm_1(how));
  };
  row("ten rounds", algorithm_1(ten_rounds));
  row("start: the true shape", algorithm_1_after(
                                   [](const shape_model& model, const causes_ear& ear) {
                                     const point_columns truth = ear.right(ear.scan.truth);
                                     return initial_fit(model, ear.right, weights_of(model.basis(), truth));
                                   },
                                   ten_rounds));
  row("start: the mean shape", algorithm_1_after(
                                   [](const shape_model& model, const causes_ear& ear) {
                                     return initial_fit(model, ear.right, Eigen::VectorXd::Zero(model.basis().size()));
                                   },
                                   ten_rounds));
  for (const int evaluations : {500, 2000})
    row("start: weights by downhill simplex, " + std::to_string(evaluations) + " evaluations",
        algorithm_1_after([evaluations](const shape_model& model,
                                        const causes_ear& ear) { return fit_by_simplex(model, ear, evaluations, 3); },
                          ten_rounds));
  changed("pose held before the rounds", [](algorithm_1_options& how) { how.coarse.holds_pose = true; });
  changed("without line 4", [](algorithm_1_options& how) { how.aligns = false; });
  changed("from 99.9 % of the variance on", [](algorithm_1_options& how) { how.first_explained_variance = 0.999; });
  changed("up to 99 % of the variance", [](algorithm_1_options& how) { how.last_explained_variance = 0.99; });
  changed("smoothed", [](algorithm_1_options& how) { how.local_rounds = 3; });
  for (const int rounds : {30, 100})
    changed(std::to_string(rounds) + " rounds",
            [rounds](algorithm_1_options& how) { how.rounds = how.most_rounds = rounds; });
  changed("points count 0.01 along the surface",
          [](algorithm_1_options& how) { how.correspondence.tangential = 0.01; });
  const int until_convergence = algorithm_1_options{}.most_rounds;
  changed("until convergence", [&](algorithm_1_options& how) { how.most_rounds = until_convergence; });
  changed("until convergence, smoothed", [&](algorithm_1_options& how) {
    how.most_rounds = until_convergence;
    how.local_rounds = 3;
  });
  row("true positions of the seen vertices", [](const shape_model& model, const causes_ear& ear) {
    const point_columns truth = ear.right(ear.scan.truth);
    const auto known = gonio::shape::vertex_observations::marked(truth, ear.scan.covered);
    const auto found = gonio::shape::fit_shape(model.basis(), gonio::truncated_svd{0.999}, known, {1});
    return recovered_shape{model.mesh(found.vertices()), known, ear.right,
                           initial_fit(model, ear.right, found.weights())};
  });
  row("gonio", [&ten_rounds](const shape_model& model, const causes_ear& ear) {
    gonio::shape::recovery_options how;
    how.confidence = ten_rounds.confidence;
    return gonio::shape::recover(model, ear.index, ear.right, how, {1});
  });
}

void print_causes(const shape_causes_command& options) {
  const synthetic::ear_study study(options.seed);
  const shape_model model = study.learn(options.shapes, options.threads);
  const auto ears_of = [&](const shape_model& of, const synthetic::scan_options& how) {
    std::vector<causes_ear> ears;
    for (Eigen::Index i = 0; i < options.ears; ++i) ears.emplace_back(study, of, i, how);
    return ears;
  };
  const auto wanted = [&](const std::string& name) {
    return options.rows.empty() || std::ranges::find(options.rows, name) != options.rows.end();
  };
  synthetic::scan_options how;
  how.hole = options.hole == "large" ? synthetic::hole_options::large() : synthetic::hole_options::small();
  const std::vector<causes_ear> ears = ears_of(model, how);
  algorithm_1_options ten_rounds;
  ten_rounds.most_rounds = ten_rounds.rounds;
  ten_rounds.local_rounds = 0;
  ten_rounds.confidence = 0.999999;  // refuses none of these ears, whatever is changed
  std::cout << "Mean distances from the truth over " << options.ears << " ears, mm; " << options.shapes
            << " shapes, of which " << model.truncated_to_variance(0.9).basis().size()
            << " components have 90 % of the "
            << "variance and " << model.truncated_to_variance(0.999).basis().size() << " 99.9 %\n\n"
            << "| change | hole: signed | absolute | all vertices: signed | absolute |\n|---|---|---|---|---|\n";
  print_changed_rounds(
      [&](const std::string& name, const recovering& recover) {
        if (wanted(name)) print_row(name, model, ears, recover);
      },
      ten_rounds);
  const auto with_scans = [&](const std::string& name, const synthetic::scan_options& other) {
    if (wanted(name)) print_row(name, model, ears_of(model, other), algorithm_1(ten_rounds));
  };
  synthetic::scan_options quiet = how;
  quiet.noise = 0.0;
  with_scans("scans without noise", quiet);
  for (const auto& [length, share] : {std::pair{2.0, 0.15}, std::pair{4.0, 0.3}, std::pair{7.0, 0.55}}) {
    synthetic::scan_options other = how;
    other.hole->length = length;
    other.hole->share = share;
    with_scans("holes of " + cli::fixed(length, 0) + " mm, " + cli::fixed(100.0 * share, 0) + " % of the circumference",
               other);
  }
  for (const Eigen::Index shapes : {80, 310}) {
    const std::string name = "learned from " + std::to_string(shapes) + " shapes";
    if (!wanted(name)) continue;
    const shape_model other = study.learn(shapes, options.threads);
    print_row(name, other, ears_of(other, how), algorithm_1(ten_rounds));
  }
  if (wanted("learned from registered scans")) {
    const shape_model other = learn_from_registered(model, study, options.shapes);
    print_row("learned from registered scans", other, ears_of(other, how), algorithm_1(ten_rounds));
  }
}

}  // namespace

void add_shape_causes(command& app) {
  auto command = app.add_subcommand("shape-causes", "Why Algorithm 1 is off as it is on synthetic ears");
  const auto options = std::make_shared<shape_causes_command>();
  options->shapes = 161;
  options->ears = 4;
  add_ear_options(command, *options);
  command.add_option("--rows", options->rows, "Rows to print, by their names; all rows if none is named");
  command.add_option("--hole", options->hole, "Size of the hole between the bends: large or small")
      .check(check::one_of({"large", "small"}))
      .capture_default_str();
  command.callback([options] { print_causes(*options); });
}

}  // namespace papers
