/// gonio shape demo: recovers scans of synthetic ear canals that the model has not learned, with holes between the
/// bends, and compares the result with smooth filling of the holes and Algorithm 1. After section 4 of "Anatomically
/// correct surface recovery".

#include "shape.hpp"
#include "synthetic/ear_study.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/contact_sheet.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/shape/cross_validated_uncertainty.hpp>
#include <gonio/shape/hole_filling.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/io/shape_model.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <array>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

namespace cli {

namespace {

struct shape_demo_command {
  Eigen::Index shapes = 310, held_out = 10;
  std::uint64_t seed = 1;
  std::string hole = "large";
  double edge_noise = 0.0;
  Eigen::Index trials = 0;
  std::filesystem::path folder;
  bool as_json = false;
  gonio::thread_count threads;
};

/// A surface recovered by one method, and its error in the hole.
struct judged_surface {
  std::string name;
  gonio::shape::point_columns vertices;  ///< in the scan's space
  gonio::shape::surface_distance hole;
};

/// The results of all methods for one ear, and the uncertainty of `recover`.
struct judged_ear {
  std::vector<judged_surface> ways;
  Eigen::Index missing = 0;      ///< vertices in the hole
  std::optional<double> inside;  ///< fraction of the hole's true vertices in the 95 % ellipsoids, if requested
};

synthetic::ear_scan scan_held_out(const synthetic::ear_study& study, const shape_demo_command& options,
                                  Eigen::Index number) {
  synthetic::scan_options how;
  how.hole = options.hole == "large" ? synthetic::hole_options::large() : synthetic::hole_options::small();
  how.hole->edge_noise = options.edge_noise;
  return study.held_out(number, how);
}

/// Returns the fraction of vertices whose true position is in the 95 % ellipsoid about the recovered one.
double share_inside(const gonio::shape::cross_validated_uncertainty& uncertainty,
                    const gonio::shape::recovered_shape& ours, const gonio::shape::point_columns& truth,
                    const std::vector<Eigen::Index>& vertices) {
  const double radius = uncertainty.squared_radius(0.95);
  const auto inside = std::ranges::count_if(vertices, [&](Eigen::Index vertex) {
    const Eigen::Vector3d off = ours.surface.vertices.col(vertex) - ours.pose(truth.col(vertex));
    return off.dot(uncertainty.covariance(vertex).llt().solve(off)) <= radius;
  });
  return static_cast<double>(inside) / static_cast<double>(vertices.size());
}

/// Recovers a scan with all methods and measures their errors in its hole.
judged_ear judge_ear(const gonio::shape::shape_model& model, const synthetic::ear_study& study,
                     const synthetic::ear_scan& scan, const shape_demo_command& options) {
  const gonio::shape::surface_index index(scan.mesh), complete(scan.complete);
  const gonio::shape::similarity_transform pose = find_pose(model, scan.mesh, options.threads);
  const std::vector<Eigen::Index> hole = study.hole_of(scan);
  judged_ear judged;
  judged.missing = hole.size();
  const auto judge = [&](std::string name, const gonio::shape::point_columns& vertices, const auto& to_model) {
    gonio::shape::point_columns in_scan = to_model.inverse()(vertices);
    const gonio::shape::point_columns recovered = in_scan(Eigen::all, hole);
    judged.ways.push_back(
        {std::move(name), std::move(in_scan), gonio::shape::distance_to(complete, recovered, options.threads)});
  };
  const gonio::shape::recovered_shape ours = gonio::shape::recover(model, index, pose, {}, options.threads);
  gonio::shape::point_columns shown = ours.surface.vertices;
  shown(Eigen::all, ours.known.vertices) = ours.known.positions;
  judge("thin plate",
        gonio::shape::fill_smoothly(model.topology(), shown, gonio::shape::marks_of(ours.known, model.vertices())),
        ours.pose);
  gonio::shape::algorithm_1_options published;
  published.local_rounds = 0;
  const auto at_once = gonio::shape::recover_algorithm_1(model, index, pose, published, options.threads);
  judge("Algorithm 1", at_once.surface.vertices, at_once.pose);
  published.local_rounds = 3;
  const auto locally = gonio::shape::recover_algorithm_1(model, index, pose, published, options.threads);
  judge("+ local smoothing", locally.surface.vertices, locally.pose);
  judge("gonio", ours.surface.vertices, ours.pose);
  if (options.trials > 0)
    judged.inside = share_inside({model, index, ours, {.trials = options.trials, .recovery = {}}, options.threads},
                                 ours, scan.truth, hole);
  return judged;
}

void print_column(const std::string& text) { std::cout << std::setw(19) << text; }

void print_inside(double share) { std::cout << "   " << fixed(100.0 * share, 1) << " %"; }

void print_ear(std::size_t number, const judged_ear& ear) {
  if (number == 1) {
    std::cout << "signed and absolute mean distance from the truth in the hole, mm\n  #";
    for (const judged_surface& way : ear.ways) print_column(way.name);
    std::cout << (ear.inside ? "   inside the 95 % ellipsoid\n" : "\n");
  }
  std::cout << std::setw(3) << number;
  for (const judged_surface& way : ear.ways)
    print_column(fixed(way.hole.signed_mean, 3) + " " + fixed(way.hole.absolute_mean, 3));
  if (ear.inside) print_inside(*ear.inside);
  std::cout << std::endl;
}

/// Prints the methods' errors averaged over the ears, and the fraction of all missing vertices in the ellipsoids.
void print_means(const std::vector<judged_ear>& ears) {
  std::cout << "all";
  for (std::size_t way = 0; way < ears.front().ways.size(); ++way) {
    double sum = 0.0;
    for (const judged_ear& ear : ears) sum += ear.ways[way].hole.absolute_mean;
    print_column(fixed(sum / static_cast<double>(ears.size()), 3));
  }
  double inside = 0.0, missing = 0.0;
  for (const judged_ear& ear : ears) {
    inside += ear.inside.value_or(0.0) * static_cast<double>(ear.missing);
    missing += static_cast<double>(ear.missing);
  }
  if (ears.front().inside) print_inside(inside / missing);
  std::cout << std::endl;
}

json json_of(const judged_ear& ear) {
  json all = {{"missing", ear.missing}};
  if (ear.inside) all["inside"] = *ear.inside;
  for (const judged_surface& way : ear.ways)
    all[way.name] = {{"signed_mean", way.hole.signed_mean},
                     {"absolute_mean", way.hole.absolute_mean},
                     {"largest", way.hole.largest}};
  return all;
}

/// Adds the scan and the result of each method to the images of a sheet.
void add_row(std::vector<gonio::image>& images, sheet_text& text, const gonio::shape::shape_model& model,
             const synthetic::ear_scan& scan, const std::vector<judged_surface>& ways) {
  const auto upright = [&](gonio::shape::point_columns vertices) {
    return gonio::shape::point_columns(scan.placement.inverse() * vertices);
  };
  constexpr double largest = 0.5;
  constexpr std::size_t pixels = 160;
  const gonio::shape::surface_index complete(scan.complete);
  images.push_back(shape_image({upright(scan.mesh.vertices), scan.mesh.triangles}, {}, largest, pixels));
  text.labels.emplace_back("scan");
  for (const judged_surface& way : ways) {
    const Eigen::VectorXd distances = gonio::shape::signed_distances(complete, way.vertices);
    images.push_back(shape_image(model.mesh(upright(way.vertices)), distances, largest, pixels));
    text.labels.push_back(way.name);
  }
}

void write_example(const std::filesystem::path& folder, const gonio::shape::shape_model& model,
                   const synthetic::ear_scan& scan, const std::vector<judged_surface>& ways) {
  gonio::io::write_shape_model(folder / "ears.shapes", model);
  gonio::io::write_mesh(folder / "scan.ply", scan.mesh);
  gonio::io::write_mesh(folder / "truth.ply", scan.complete);
  gonio::io::write_mesh(folder / "recovered.ply", model.mesh(ways.back().vertices));
}

void show_shapes(const shape_demo_command& options) {
  if (!options.folder.empty()) std::filesystem::create_directories(options.folder);
  const synthetic::ear_study study(options.seed);
  const gonio::shape::shape_model model = study.learn(options.shapes, options.threads);
  json report = {{"shapes", model.shapes()}, {"vertices", model.vertices()}, {"held_out", json::array()}};
  std::vector<gonio::image> images;
  sheet_text text{{}, "signed distance from the truth: blue -0.5 mm or less, white 0, red 0.5 mm or more"};
  std::vector<judged_ear> ears;
  for (Eigen::Index i = 0; i < options.held_out; ++i) {
    const synthetic::ear_scan scan = scan_held_out(study, options, i);
    judged_ear ear = judge_ear(model, study, scan, options);
    if (!options.as_json) print_ear(i + 1, ear);
    report["held_out"].push_back(json_of(ear));
    if (!options.folder.empty()) {
      if (i == 0) write_example(options.folder, model, scan, ear.ways);
      if (i < 3) add_row(images, text, model, scan, ear.ways);
    }
    for (judged_surface& way : ear.ways) way.vertices.resize(3, 0);  // saves memory for many ears
    ears.push_back(std::move(ear));
  }
  if (options.as_json)
    std::cout << report.dump(2) << '\n';
  else
    print_means(ears);
  if (images.empty()) return;
  gonio::io::write_png(options.folder / "recovered.png", contact_sheet(images, 1 + ears.front().ways.size(), text));
  if (!options.as_json)
    std::cout << "In " << options.folder.string()
              << ": recovered.png (the scan, then the result of each method, coloured by the distance from the truth: "
                 "-0.5 mm is blue, 0 white, 0.5 mm red), ears.shapes (the model), and scan.ply, truth.ply and "
                 "recovered.ply of the first ear\n";
}

}  // namespace

void add_shape_demo(command& shape) {
  auto command = shape.add_subcommand("demo", "Recover synthetic ear canals, and compare with smooth filling of holes");
  const auto options = std::make_shared<shape_demo_command>();
  command.add_option("--shapes", options->shapes, "Number of shapes to learn from")
      .check(check::range(3, 100000))
      .capture_default_str();
  command.add_option("--held-out", options->held_out, "Number of shapes to recover")
      .check(check::range(1, 10000))
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of all random numbers").capture_default_str();
  command.add_option("--hole", options->hole, "Size of the hole between the bends: large or small")
      .check(check::one_of({"large", "small"}))
      .capture_default_str();
  command.add_option("--edge-noise", options->edge_noise, "Noise of the scan within 1.5 mm of the hole, mm")
      .check(check::range(0.0, 5.0))
      .capture_default_str();
  command
      .add_option(
          "--trials", options->trials,
          "Number of shapes to leave out for each ear, to measure the uncertainty and test it: 0, or at least 10")
      .check(check::range(0, 100000))
      .capture_default_str();
  add_threads_option(command, options->threads);
  command.add_flag("--json", options->as_json, "Print figures as JSON");
  command.add_output_folder("-o,--output", options->folder,
                            {"recovered.png", "ears.shapes", "scan.ply", "truth.ply", "recovered.ply"},
                            "Folder for an image, the model, and the files of one ear");
  command.callback([options] { show_shapes(*options); });
}

}  // namespace cli
