/// `gonio plan`: prints directions as poses of a goniometer, and draws them.

#include "commands.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/image_text.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/render/false_colour.hpp>
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

/// Returns the pose with the sample rotated until the light has azimuth 0, as isotropic materials allow.
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

constexpr int hemisphere_radius = 400, hemisphere_margin = 50, legend_rows = 60;
constexpr int drawing_size = 2 * (hemisphere_radius + hemisphere_margin);
constexpr std::size_t text_scale = 2;
const Eigen::Vector2d zenith = Eigen::Vector2d::Constant(drawing_size / 2);

/// Returns the colour of pose `number`. Successive poses cycle through six different colours that are dark enough for
/// lines on white.
gonio::rgb colour_of(std::size_t number) {
  constexpr std::array dark{4, 5, 2, 6, 0, 1};
  return gonio::render::category_colour(dark[number % dark.size()]);
}

/// Paints a shape with smooth edges. `distance(point)` is the distance from its edge in pixels, positive outside.
template <class Distance>
void paint(gonio::image& image, const Eigen::AlignedBox2d& box, const gonio::rgb& colour, const Distance& distance) {
  const auto first = [](double least) { return std::max(0, static_cast<int>(least) - 1); };
  const auto end = [](double most, std::size_t size) {
    return std::min(static_cast<int>(size), static_cast<int>(most) + 2);
  };
  for (int row = first(box.min().y()); row < end(box.max().y(), image.shape(0)); ++row)
    for (int column = first(box.min().x()); column < end(box.max().x(), image.shape(1)); ++column) {
      const double covered = std::clamp(0.5 - distance(Eigen::Vector2d(column + 0.5, row + 0.5)), 0.0, 1.0);
      if (covered > 0.0)
        gonio::set_pixel(image, row, column, (1.0 - covered) * gonio::pixel(image, row, column) + covered * colour);
    }
}

/// Paints the points whose distance from `at` is in a range.
void paint_ring(gonio::image& image, const Eigen::Vector2d& at, double inner, double outer, const gonio::rgb& colour) {
  paint(image, {at.array() - outer, at.array() + outer}, colour, [&](const Eigen::Vector2d& point) {
    const double radius = (point - at).norm();
    return std::max(radius - outer, inner - radius);
  });
}

void paint_line(gonio::image& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
                const gonio::rgb& colour) {
  const Eigen::Vector2d way = to - from;
  const double squared_length = std::max(way.squaredNorm(), 1e-12);
  paint(image, {from.cwiseMin(to).array() - width, from.cwiseMax(to).array() + width}, colour,
        [&](const Eigen::Vector2d& point) {
          const double share = std::clamp(way.dot(point - from) / squared_length, 0.0, 1.0);
          return (point - from - share * way).norm() - 0.5 * width;
        });
}

/// Returns the position of angles in degrees in the drawing: the polar angle is the distance from the centre.
Eigen::Vector2d position_of(double polar, double azimuth) {
  const double radius = hemisphere_radius * polar / 90.0, turn = gonio::radians(azimuth);
  return zenith + radius * Eigen::Vector2d(std::cos(turn), -std::sin(turn));
}

Eigen::Vector2d position_of(const gonio::direction& w) {
  return position_of(polar_degrees(w), gonio::degrees(gonio::azimuth(w)));
}

/// Draws text with its middle at a point.
void write_centred(gonio::image& image, const Eigen::Vector2d& middle, const std::string& text) {
  const text_extent size = extent_of(text, text_scale);
  draw_text(image, static_cast<std::size_t>(middle.y()) - size.rows / 2,
            static_cast<std::size_t>(middle.x()) - size.columns / 2, text, text_scale, gonio::rgb::Constant(0.1));
}

/// Draws circles of the polar angle every 30 degrees, and the azimuth every 45 degrees.
void draw_angles(gonio::image& image) {
  for (int azimuth = 0; azimuth < 360; azimuth += 45) {
    paint_line(image, zenith, position_of(90.0, azimuth), 1.0, gonio::rgb::Constant(0.75));
    write_centred(image, position_of(96.0, azimuth), std::to_string(azimuth));
  }
  for (const int theta : {30, 60, 90}) {
    const double radius = hemisphere_radius * theta / 90.0;
    paint_ring(image, zenith, radius - 0.7, radius + 0.7, gonio::rgb::Constant(theta == 90 ? 0.1 : 0.5));
    if (theta < 90) write_centred(image, position_of(theta + 3.0, 67.5), std::to_string(theta));
  }
}

void draw_light(gonio::image& image, const Eigen::Vector2d& at, const gonio::rgb& colour) {
  paint_ring(image, at, 0.0, 8.0, colour);
}

void draw_viewer(gonio::image& image, const Eigen::Vector2d& at, const gonio::rgb& colour) {
  paint_ring(image, at, 0.0, 7.0, gonio::rgb::Ones());
  paint_ring(image, at, 5.5, 8.5, colour);
}

/// Draws the meaning of the marks below the hemisphere.
void draw_legend(gonio::image& image) {
  constexpr double row = drawing_size + 0.3 * legend_rows;
  const gonio::rgb ink = gonio::rgb::Constant(0.1);
  draw_light(image, {hemisphere_margin, row}, ink);
  draw_viewer(image, {hemisphere_margin + 140.0, row}, ink);
  const auto write = [&](int column, const char* text) {
    draw_text(image, static_cast<std::size_t>(row) - 8, static_cast<std::size_t>(hemisphere_margin + column), text,
              text_scale, ink);
  };
  write(16, "light");
  write(156, "viewer, with the number of the pose");
  write(600, "angles in degrees");
}

/// Draws numbers beside their points, without overlaps.
class number_labels {
 public:
  explicit number_labels(gonio::image& image)
      : image_(image),
        inside_(Eigen::Vector2d::Ones(),
                Eigen::Vector2d(static_cast<double>(image.shape(1)) - 1.0, static_cast<double>(image.shape(0)) - 1.0)) {
  }

  /// Draws a number near a point, away from `other`, or on the next side that has room; omits the number if no side has
  /// room.
  void add(const Eigen::Vector2d& at, const Eigen::Vector2d& other, std::size_t number, const gonio::rgb& colour) {
    const std::string text = std::to_string(number);
    const text_extent size = extent_of(text, text_scale);
    const Eigen::Vector2d half(0.5 * static_cast<double>(size.columns), 0.5 * static_cast<double>(size.rows));
    for (int side = 0; side < 8; ++side) {
      const double turn = (side % 2 == 0 ? 1 : -1) * ((side + 1) / 2) * std::numbers::pi / 4.0;
      const double angle = std::atan2(at.y() - other.y(), at.x() - other.x()) + turn;
      const Eigen::Vector2d middle =
          at + Eigen::Vector2d((half.x() + 11.0) * std::cos(angle), (half.y() + 11.0) * std::sin(angle));
      const Eigen::AlignedBox2d box(middle - half, middle + half);
      if (!inside_.contains(box)) continue;
      if (std::ranges::any_of(taken_, [&](const Eigen::AlignedBox2d& taken) { return taken.intersects(box); }))
        continue;
      taken_.push_back(box);
      const auto row = static_cast<std::size_t>(box.min().y()), column = static_cast<std::size_t>(box.min().x());
      // Draw a white background: no line crosses the number.
      const gonio::image paper = gonio::uniform_image(static_cast<Eigen::Index>(size.rows),
                                                      static_cast<Eigen::Index>(size.columns), gonio::rgb::Ones());
      gonio::render::paste(image_, paper, row, column);
      draw_text(image_, row, column, text, text_scale, colour);
      return;
    }
  }

  /// Keeps numbers away from a point.
  void keep_free(const Eigen::Vector2d& at, double radius) {
    taken_.emplace_back(at - Eigen::Vector2d::Constant(radius), at + Eigen::Vector2d::Constant(radius));
  }

 private:
  gonio::image& image_;
  Eigen::AlignedBox2d inside_;
  std::vector<Eigen::AlignedBox2d> taken_;
};

/// Draws the numbers of the poses at their viewers, in the order of the file. With more than 40 poses only every
/// second, third, ... pose is numbered.
void draw_numbers(gonio::image& image, const std::vector<pose>& poses) {
  number_labels labels(image);
  for (const pose& at : poses) {
    labels.keep_free(position_of(at.wi), 8.0);
    labels.keep_free(position_of(at.wo), 8.0);
  }
  const std::size_t step = 1 + (poses.size() - 1) / 40;
  for (std::size_t i = 0; i < poses.size(); i += step)
    labels.add(position_of(poses[i].wo), position_of(poses[i].wi), i + 1, colour_of(i));
}

/// Draws each pose as a line from its light (a disc) to its viewer (a ring) with its number. All lines are below all
/// marks.
gonio::image drawing_of(const std::vector<pose>& poses) {
  gonio::image image = gonio::uniform_image(drawing_size + legend_rows, drawing_size, gonio::rgb::Ones());
  draw_angles(image);
  for (std::size_t i = 0; i < poses.size(); ++i)
    paint_line(image, position_of(poses[i].wi), position_of(poses[i].wo), 2.0, colour_of(i));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    draw_light(image, position_of(poses[i].wi), colour_of(i));
    draw_viewer(image, position_of(poses[i].wo), colour_of(i));
  }
  if (!poses.empty()) draw_numbers(image, poses);
  draw_legend(image);
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
