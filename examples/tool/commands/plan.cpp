/// `gonio plan`: prints directions as poses of a goniometer, and draws them.

#include "commands.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/image_text.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/render/image.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace cli {

namespace {

struct plan_options {
  std::filesystem::path directions, image;
  bool print_json = false;
};

/// Light and viewer at polar angles and azimuths in degrees, the light at azimuth 0.
struct pose {
  double theta_i = 0.0, theta_o = 0.0, phi_o = 0.0;
  gonio::direction wi, wo;
};

double polar_degrees(const gonio::direction& w) { return gonio::degrees(gonio::polar_angle(w)); }

/// Since the material is isotropic, the sample is rotated so that the light is in the half plane of positive x.
pose to_pose(const gonio::direction_pair& pair) {
  pose at;
  at.theta_i = polar_degrees(pair.wi);
  at.theta_o = polar_degrees(pair.wo);
  const double azimuth_i = at.theta_i > 1e-9 ? gonio::azimuth(pair.wi) : 0.0;
  const double turn = at.theta_o > 1e-9 ? gonio::azimuth(pair.wo) - azimuth_i : 0.0;
  const double turned = gonio::azimuth(gonio::spherical_direction(std::numbers::pi / 2.0, turn));
  at.phi_o = gonio::degrees(turned);
  at.wi = gonio::spherical_direction(gonio::radians(at.theta_i), 0.0);
  at.wo = gonio::spherical_direction(gonio::radians(at.theta_o), turned);
  return at;
}

void print_poses(const std::vector<pose>& poses) {
  std::cout << "Angles in degrees; the sample is turned so that the light's azimuth is 0.\n\n"
            << "| | theta_i | theta_o | phi_o | wi | wo |\n|---|---|---|---|---|---|\n";
  const auto vector = [](const gonio::direction& w) {
    return fixed(w.x(), 4) + ' ' + fixed(w.y(), 4) + ' ' + fixed(w.z(), 4);
  };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const pose& at = poses[i];
    std::cout << "| " << i + 1 << " | " << fixed(at.theta_i, 2) << " | " << fixed(at.theta_o, 2) << " | "
              << fixed(at.phi_o, 2) << " | " << vector(at.wi) << " | " << vector(at.wo) << " |\n";
  }
}

void print_json(const std::vector<pose>& poses) {
  json all = json::array();
  for (const pose& at : poses)
    all.push_back({{"theta_i", at.theta_i},
                   {"theta_o", at.theta_o},
                   {"phi_o", at.phi_o},
                   {"wi", {at.wi.x(), at.wi.y(), at.wi.z()}},
                   {"wo", {at.wo.x(), at.wo.y(), at.wo.z()}}});
  std::cout << all.dump(2) << '\n';
}

// ---- the drawing: the hemisphere from above ----------------------------------------------------

constexpr int hemisphere_radius = 240, hemisphere_margin = 20;

/// Returns distinct colours, one per pose in turn.
gonio::rgb colour_of(std::size_t number) {
  constexpr std::array<std::array<double, 3>, 6> colours{
      {{0.7, 0.02, 0.02}, {0.02, 0.1, 0.7}, {0.02, 0.4, 0.05}, {0.5, 0.05, 0.5}, {0.7, 0.25, 0.0}, {0.0, 0.35, 0.4}}};
  const auto& [r, g, b] = colours[number % colours.size()];
  return {r, g, b};
}

/// Paints the pixels whose distance from `at` is in a range.
void paint_ring(gonio::image& image, const Eigen::Vector2d& at, double inner, double outer, const gonio::rgb& colour) {
  const auto first = [&](double middle) { return std::max(0, static_cast<int>(middle - outer - 1.0)); };
  const auto last = [&](double middle, std::size_t size) {
    return std::min(static_cast<int>(size) - 1, static_cast<int>(middle + outer + 1.0));
  };
  for (int row = first(at.y()); row <= last(at.y(), image.shape(0)); ++row)
    for (int column = first(at.x()); column <= last(at.x(), image.shape(1)); ++column) {
      const double distance = (Eigen::Vector2d(column + 0.5, row + 0.5) - at).norm();
      if (distance >= inner && distance <= outer) gonio::set_pixel(image, row, column, colour);
    }
}

/// Returns the position of a direction in the drawing: the polar angle is the distance from the centre.
Eigen::Vector2d place_of(const gonio::direction& w) {
  const double radius = hemisphere_radius * polar_degrees(w) / 90.0, azimuth = gonio::azimuth(w);
  return {hemisphere_radius + hemisphere_margin + radius * std::cos(azimuth),
          hemisphere_radius + hemisphere_margin - radius * std::sin(azimuth)};
}

/// Draws numbers beside their points, without overlaps.
class number_labels {
 public:
  explicit number_labels(gonio::image& image)
      : image_(image),
        inside_(Eigen::Vector2d::Ones(),
                Eigen::Vector2d(static_cast<double>(image.shape(1)) - 1.0, static_cast<double>(image.shape(0)) - 1.0)) {
  }

  /// Draws a number near a point, on the side away from `other` or on the next with room; omits it if there is none.
  void add(const Eigen::Vector2d& at, const Eigen::Vector2d& other, std::size_t number, const gonio::rgb& colour) {
    const std::string text = std::to_string(number);
    const text_extent size = extent_of(text, scale_);
    const Eigen::Vector2d half(0.5 * static_cast<double>(size.columns), 0.5 * static_cast<double>(size.rows));
    for (int side = 0; side < 8; ++side) {
      const double turn = (side % 2 == 0 ? 1 : -1) * ((side + 1) / 2) * std::numbers::pi / 4.0;
      const double angle = std::atan2(at.y() - other.y(), at.x() - other.x()) + turn;
      const Eigen::Vector2d middle =
          at + Eigen::Vector2d((half.x() + 7.0) * std::cos(angle), (half.y() + 7.0) * std::sin(angle));
      const Eigen::AlignedBox2d box(middle - half, middle + half);
      if (!inside_.contains(box)) continue;
      if (std::ranges::any_of(taken_, [&](const Eigen::AlignedBox2d& taken) { return taken.intersects(box); }))
        continue;
      taken_.push_back(box);
      const auto row = static_cast<std::size_t>(box.min().y()), column = static_cast<std::size_t>(box.min().x());
      // White background, so that no line crosses the number.
      const gonio::image paper = gonio::uniform_image(static_cast<Eigen::Index>(size.rows),
                                                      static_cast<Eigen::Index>(size.columns), gonio::rgb::Ones());
      gonio::render::paste(image_, paper, row, column);
      draw_text(image_, row, column, text, scale_, colour);
      return;
    }
  }

  /// Keeps numbers away from a point.
  void keep_free(const Eigen::Vector2d& at, double radius) {
    taken_.emplace_back(at - Eigen::Vector2d::Constant(radius), at + Eigen::Vector2d::Constant(radius));
  }

 private:
  static constexpr std::size_t scale_ = 1;
  gonio::image& image_;
  Eigen::AlignedBox2d inside_;
  std::vector<Eigen::AlignedBox2d> taken_;
};

/// Draws the numbers of the poses at their viewers, in the order of the file, and the degrees of the circles. With more
/// than 40 poses only every second, third, ... pose is numbered.
void draw_numbers(gonio::image& image, const std::vector<pose>& poses) {
  const Eigen::Vector2d middle(hemisphere_radius + hemisphere_margin, hemisphere_radius + hemisphere_margin);
  for (const int theta : {30, 60, 90}) {
    const std::string text = std::to_string(theta);
    draw_text(image, static_cast<std::size_t>(middle.y() + hemisphere_radius * theta / 90.0 + 2.0),
              static_cast<std::size_t>(middle.x()) + 3, text, 1, gonio::rgb::Constant(0.2));
  }
  number_labels labels(image);
  for (const pose& at : poses) {
    labels.keep_free(place_of(at.wi), 5.0);
    labels.keep_free(place_of(at.wo), 5.0);
  }
  const std::size_t step = 1 + (poses.size() - 1) / 40;
  for (std::size_t i = 0; i < poses.size(); i += step)
    labels.add(place_of(poses[i].wo), place_of(poses[i].wi), i + 1, colour_of(i));
}

/// Draws each pose as a line from its light (a disc) to its viewer (a ring) with its number; circles every 30 degrees.
gonio::image drawing_of(const std::vector<pose>& poses) {
  const auto size = static_cast<Eigen::Index>(2 * (hemisphere_radius + hemisphere_margin));
  gonio::image image = gonio::uniform_image(size, size, gonio::rgb::Ones());
  const Eigen::Vector2d middle(hemisphere_radius + hemisphere_margin, hemisphere_radius + hemisphere_margin);
  for (const int theta : {30, 60, 90})
    paint_ring(image, middle, hemisphere_radius * theta / 90.0 - 0.6, hemisphere_radius * theta / 90.0 + 0.6,
               gonio::rgb::Constant(theta == 90 ? 0.2 : 0.6));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector2d light = place_of(poses[i].wi), viewer = place_of(poses[i].wo);
    const int steps = 1 + static_cast<int>((viewer - light).norm());
    for (int step = 0; step <= steps; ++step)
      paint_ring(image, light + (viewer - light) * (static_cast<double>(step) / steps), 0.0, 0.8, colour_of(i));
    paint_ring(image, light, 0.0, 5.0, colour_of(i));
    paint_ring(image, viewer, 0.0, 4.0, gonio::rgb::Ones());
    paint_ring(image, viewer, 3.5, 5.5, colour_of(i));
  }
  if (!poses.empty()) draw_numbers(image, poses);
  return image;
}

void run(const plan_options& options) {
  std::vector<pose> poses;
  for (const gonio::direction_pair& pair : cli::read_direction_pairs(options.directions, reading_of()))
    poses.push_back(to_pose(pair));
  if (!options.image.empty()) gonio::io::write_png(options.image, drawing_of(poses));
  if (options.print_json)
    print_json(poses);
  else
    print_poses(poses);
}

}  // namespace

void add_plan(command& app) {
  auto command = app.add_subcommand("plan", "Print directions as poses of a goniometer, and draw them");
  const auto options = std::make_shared<plan_options>();
  command.add_input("directions", options->directions, "Directions, as `gonio design` writes them (.csv)").required();
  command.add_output("--image", options->image, {".png"},
                     "Drawing of the hemisphere from above: discs are lights, rings are viewers (.png)");
  command.add_flag("--json", options->print_json, "Print the poses as JSON");
  command.callback([options] { run(*options); });
}

}  // namespace cli
