/// gonio-papers shape-fields: fills holes of synthetic ears by a Markov random field of signed distances, compared with
/// a thin plate and our recovery. After "Anatomically correct surface recovery", section 4.

#include "papers/experiments.hpp"
#include "papers/surfaces2016/distance_field.hpp"
#include "papers/surfaces2016/ear_options.hpp"
#include "synthetic/ear_study.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/shape/hole_filling.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace papers {

namespace {

struct shape_fields_command : ear_options {
  std::string hole = "large";
  double edge_noise = 0.0;
  distance_field_options field;
};

/// The number of methods whose errors in a hole are compared: the field, the membrane, the thin plate, and `recover`.
constexpr std::size_t ways = 4;
struct judged_hole {
  std::array<gonio::shape::surface_distance, ways> off;
  Eigen::Index lost = 0;  ///< vertices of the hole near which the field has no zero
};

judged_hole judge_hole(const gonio::shape::shape_model& model, const synthetic::ear_study& study,
                       const synthetic::ear_scan& scan, const shape_fields_command& options) {
  const gonio::shape::surface_index index(scan.mesh), complete(scan.complete);
  const std::vector<Eigen::Index> hole = study.hole_of(scan);
  // Recover the hole with gonio, and fill it smoothly from the template's vertices that the scan shows.
  const auto right = gonio::shape::align(scan.truth, model.mean().vertices);
  const auto ours = gonio::shape::recover(model, index, right, {}, options.threads);
  const auto to_scan = ours.pose.inverse();
  gonio::shape::point_columns shown = ours.surface.vertices;
  shown(Eigen::all, ours.known.vertices) = ours.known.positions;
  const std::vector<bool> known = gonio::shape::marks_of(ours.known, model.vertices());
  const auto filled = [&](gonio::shape::smoothness kind) -> gonio::shape::point_columns {
    return to_scan(gonio::shape::fill_smoothly(model.topology(), shown, known, kind));
  };
  const auto in_hole = [&](const gonio::shape::point_columns& all) { return gonio::shape::chosen_columns(all, hole); };
  const gonio::shape::point_columns plate = in_hole(filled(gonio::shape::smoothness::thin_plate));
  // Find the field near the thin plate, and move the plate's vertices to the zero of the field.
  judged_hole judged;
  const distance_field field(index, plate, options.field);
  const std::array<gonio::shape::point_columns, ways> found{field.on_surface(plate, judged.lost),
                                                            in_hole(filled(gonio::shape::smoothness::membrane)), plate,
                                                            in_hole(to_scan(ours.surface.vertices))};
  for (std::size_t way = 0; way < ways; ++way)
    judged.off[way] = gonio::shape::distance_to(complete, found[way], options.threads);
  return judged;
}

void print_fields(const shape_fields_command& options) {
  const synthetic::ear_study study(options.seed);
  const gonio::shape::shape_model model = study.learn(options.shapes, options.threads);
  synthetic::scan_options how;
  how.hole = options.hole == "large" ? synthetic::hole_options::large() : synthetic::hole_options::small();
  how.hole->edge_noise = options.edge_noise;
  std::cout << "| # | random field of distances | membrane | thin plate | gonio |\n|---|---|---|---|---|\n";
  std::array<double, ways> sums{};
  Eigen::Index lost = 0;
  for (Eigen::Index i = 0; i < options.ears; ++i) {
    const judged_hole judged = judge_hole(model, study, study.held_out(i, how), options);
    lost += judged.lost;
    std::cout << "| " << i + 1 << " |";
    for (std::size_t way = 0; way < ways; ++way) {
      std::cout << ' ' << cli::fixed(judged.off[way].signed_mean, 3) << ' '
                << cli::fixed(judged.off[way].absolute_mean, 3) << " |";
      sums[way] += judged.off[way].absolute_mean;
    }
    std::cout << std::endl;
  }
  std::cout << "| mean of absolute |";
  for (const double sum : sums) std::cout << ' ' << cli::fixed(sum / static_cast<double>(options.ears), 3) << " |";
  std::cout << '\n';
  if (lost > 0) std::cout << '\n' << lost << " vertices left the field before its zero.\n";
}

}  // namespace

void add_shape_fields(command& app) {
  auto command = app.add_subcommand("shape-fields", "Holes of synthetic ears filled by a Markov random field");
  const auto options = std::make_shared<shape_fields_command>();
  add_ear_options(command, *options);
  command.add_option("--hole", options->hole, "Size of the hole between the bends: large or small")
      .check(check::one_of({"large", "small"}))
      .capture_default_str();
  command.add_option("--edge-noise", options->edge_noise, "Noise of the scan within 1.5 mm of the hole, mm")
      .check(check::range(0.0, 5.0))
      .capture_default_str();
  command.add_option("--spacing", options->field.spacing, "Spacing of the field's voxels, mm")
      .check(check::range(0.1, 2.0))
      .capture_default_str();
  command.add_option("--smoothness", options->field.smoothness, "Weight of the field's prior")
      .check(check::positive_number())
      .capture_default_str();
  command.callback([options] { print_fields(*options); });
}

}  // namespace papers
