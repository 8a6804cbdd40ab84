#pragma once
/// Scans of the ear canals of `synthetic::ear_canal_family`, with their true values: randomly triangulated and posed,
/// noisy, with holes, and with the defects that a bootstrap must reject.

#include "ear_canal_holes.hpp"
#include "ear_canal_mesh.hpp"
#include "ear_canals.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace synthetic {

/// The defect of a scan.
enum class scan_defect {
  none,
  mirrored,      ///< a right ear
  half,          ///< the inner or the outer half is missing
  upside_down,   ///< rotated by 180 degrees about the horizontal axis of the canal
  heavy_noise,   ///< 0.6 mm
  other_object,  ///< no ear canal at all
};

/// The settings of a scan, in millimetres and radians.
struct scan_options {
  std::size_t vertices = 0;                       ///< before holes; 0 for any number from 8,000 to 15,000
  std::size_t complete_vertices = 20000;          ///< of `ear_scan::complete`; 0 for none
  double turn = 20.0 * std::numbers::pi / 180.0;  ///< largest rotation about the vertical axis
  double tilt = 3.0 * std::numbers::pi / 180.0;   ///< standard deviation about each horizontal axis
  double shift = 5.0;                             ///< standard deviation along each axis
  double noise = 0.03;                            ///< standard deviation along the normals
  double cut = 0.008;  ///< standard deviation, in u, of the position and slant of the cut at the outer end
  std::optional<hole_options> hole;
  scan_defect defect = scan_defect::none;
};

/// A scan and its true values.
struct ear_scan {
  gonio::shape::triangle_mesh mesh;
  parameter_columns parameters;       ///< (u, v) of each vertex of `mesh`; for spurious flaps, a neighbour's
  gonio::shape::point_columns truth;  ///< the template's vertices, in the scan's coordinates; empty for another object
  /// Whether each vertex of the template is on the scanned part of the surface, up to a triangle's size.
  std::vector<bool> covered;
  gonio::shape::triangle_mesh
      complete;  ///< without holes and noise, in the scan's coordinates; begins at u = `ear_canal::outermost`
  Eigen::Affine3d placement;  ///< from the family's coordinates to the scan's; reflects if mirrored
  scan_defect defect = scan_defect::none;
  ear_canal individual;  ///< for another object, the individual that it replaces

  /// Returns a point of the individual in the scan's coordinates.
  [[nodiscard]] Eigen::Vector3d point_at(double u, double v) const { return placement * individual.at(u, v); }
};

namespace detail {

inline void require_options(const scan_options& options) {
  const std::array<std::pair<const char*, double>, 5> lengths{{{"turn", options.turn},
                                                               {"tilt", options.tilt},
                                                               {"shift", options.shift},
                                                               {"noise", options.noise},
                                                               {"cut", options.cut}}};
  for (const auto& [name, value] : lengths)
    if (!(value >= 0.0 && std::isfinite(value)))
      gonio::refuse(std::string("a scan's ") + name + " must be finite and not negative, not " + std::to_string(value));
}

/// Returns a smooth closed object of the size of an ear canal, cut open at u = 0.
[[nodiscard]] inline parametric_surface blob(std::uint64_t seed) {
  number_source numbers(seed);
  std::array<double, 3> axes{}, bumps{}, phases{};
  for (double& axis : axes) axis = numbers.uniform(7.0, 13.0);
  for (double& bump : bumps) bump = numbers.uniform(0.03, 0.10);
  for (double& phase : phases) phase = numbers.uniform(0.0, 2.0 * std::numbers::pi);
  return [=](double u, double v) -> Eigen::Vector3d {
    const double polar = std::numbers::pi * (0.15 + 0.85 * u), ring = u >= 1.0 ? 0.0 : std::sin(polar);
    double radius = 1.0;
    for (std::size_t m = 0; m < bumps.size(); ++m)
      radius += bumps[m] * ring * ring * std::cos((static_cast<double>(m) + 1.0) * v + 2.0 * polar + phases[m]);
    return {radius * axes[0] * std::cos(polar), radius * axes[1] * ring * std::cos(v),
            -radius * axes[2] * ring * std::sin(v)};
  };
}

/// Returns the outward unit normal of a smooth parametric surface.
[[nodiscard]] inline Eigen::Vector3d normal_of(const parametric_surface& surface, double u, double v) {
  constexpr double step = 1e-4;
  const double inside = std::min(u, 1.0 - 10.0 * step);
  const Eigen::Vector3d along = surface(inside + step, v) - surface(inside - step, v),
                        round = surface(inside, v + step) - surface(inside, v - step);
  return round.cross(along).normalized();
}

/// Makes one scan. Each step has its own random source, so the options of one step do not change the other steps.
class scanner {
 public:
  scanner(const ear_canal& individual, std::uint64_t seed, const scan_options& options)
      : individual_(individual), options_(options), seeds_(seed) {
    require_options(options);
    for (std::uint64_t& one : own_seeds_) one = seeds_.seed();
    surface_ = surface_of(individual);
    if (options.defect == scan_defect::other_object) surface_ = blob(own_seeds_[0]);
  }

  [[nodiscard]] ear_scan scan(const ear_canal_template& common) {
    const Eigen::Affine3d placement = draw_placement();
    sampled_surface sampled = sample();
    add_noise(sampled);
    std::optional<ear_hole> hole;
    if (options_.hole) {
      number_source numbers(own_seeds_[1]);
      hole.emplace(individual_, *options_.hole, numbers);
      hole->cut(sampled, numbers);
    }
    if (options_.defect == scan_defect::half) cut_in_half(sampled);
    ear_scan made{posed(std::move(sampled.mesh), placement),
                  std::move(sampled.parameters),
                  {},
                  {},
                  {},
                  placement,
                  options_.defect,
                  individual_};
    if (options_.defect != scan_defect::other_object) {
      made.truth = placement * common.corresponded(individual_);
      for (const auto& point : common.parameters().colwise())
        made.covered.push_back(is_scanned(point) && !(hole && hole->contains(point)));
    }
    if (options_.complete_vertices > 0) made.complete = posed(complete(), placement);
    return made;
  }

 private:
  [[nodiscard]] Eigen::Affine3d draw_placement() const {
    number_source numbers(own_seeds_[2]);
    const double turn = options_.turn * numbers.uniform(-1.0, 1.0);
    const double roll = options_.tilt * numbers.normal_within(3.0), pitch = options_.tilt * numbers.normal_within(3.0);
    Eigen::Vector3d shift;
    for (double& along : shift) along = options_.shift * numbers.normal_within(3.0);
    Eigen::Affine3d placement(Eigen::Translation3d(shift) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) *
                              Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()));
    if (options_.defect == scan_defect::upside_down)
      placement.linear() *= Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    if (options_.defect == scan_defect::mirrored) placement.linear() *= Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
    return placement;
  }

  /// Returns the mesh of the scan without noise, in the family's coordinates.
  [[nodiscard]] sampled_surface sample() {
    number_source numbers(own_seeds_[3]);
    const auto drawn = 8000 + static_cast<std::size_t>(7001.0 * numbers.uniform());
    cut_ = options_.cut > 0.0 ? std::clamp(options_.cut * numbers.normal(), -0.02, 0.02) : 0.0;
    slant_ = options_.cut > 0.0 ? std::clamp(options_.cut * numbers.normal(), -0.02, 0.02) : 0.0;
    slant_phase_ = numbers.uniform(0.0, 2.0 * std::numbers::pi);
    const irregularity irregular{.seed = numbers.seed()};
    const auto slanted = [this](double u, double v) { return surface_(u + slant_at(u, v), v); };
    parametric_mesh made = mesh_of(slanted, cut_, options_.vertices > 0 ? options_.vertices : drawn, irregular);
    for (auto point : made.parameters.colwise()) point.x() += slant_at(point.x(), point.y());
    gonio::shape::point_columns normals(3, made.parameters.cols());
    for (Eigen::Index i = 0; i < normals.cols(); ++i)
      normals.col(i) = normal_of(surface_, made.parameters(0, i), made.parameters(1, i));
    return {std::move(made.mesh), std::move(made.parameters), std::move(normals)};
  }

  /// Returns the shift in u of the slanted cut at the outer end. It fades inwards.
  [[nodiscard]] double slant_at(double u, double v) const {
    return slant_ * std::pow(1.0 - std::max(0.0, u), 4) * std::sin(v + slant_phase_);
  }

  void add_noise(sampled_surface& sampled) const {
    number_source numbers(own_seeds_[4]);
    const double noise = options_.defect == scan_defect::heavy_noise ? 0.6 : options_.noise;
    for (Eigen::Index i = 0; i < sampled.normals.cols(); ++i)
      sampled.mesh.vertices.col(i) += noise * numbers.normal() * sampled.normals.col(i);
  }

  void cut_in_half(sampled_surface& sampled) {
    const bool keep_outer = keeps_outer_half();
    sampled.keep_where([&](Eigen::Index vertex) { return (sampled.parameters(0, vertex) < 0.5) == keep_outer; });
  }

  [[nodiscard]] bool keeps_outer_half() const { return number_source(own_seeds_[5]).uniform() < 0.5; }

  [[nodiscard]] bool is_scanned(const Eigen::Vector2d& point) const {
    if (point.x() < cut_ + slant_at(cut_, point.y())) return false;
    return options_.defect != scan_defect::half || (point.x() < 0.5) == keeps_outer_half();
  }

  [[nodiscard]] gonio::shape::triangle_mesh complete() const {
    const double from = options_.defect == scan_defect::other_object ? -0.03 : ear_canal::outermost;
    return mesh_of(surface_, from, options_.complete_vertices).mesh;
  }

  [[nodiscard]] static gonio::shape::triangle_mesh posed(gonio::shape::triangle_mesh mesh,
                                                         const Eigen::Affine3d& placement) {
    mesh.vertices = (placement * mesh.vertices).eval();
    if (placement.linear().determinant() < 0.0) mesh.triangles.row(0).swap(mesh.triangles.row(1));
    return mesh;
  }

  const ear_canal& individual_;
  scan_options options_;
  number_source seeds_;
  std::array<std::uint64_t, 6> own_seeds_{};
  parametric_surface surface_;
  double cut_ = 0.0, slant_ = 0.0, slant_phase_ = 0.0;
};

}  // namespace detail

/// Returns a scan of an individual. Equal arguments give equal scans; `hole` and `noise` do not change the rest of the
/// scan. Throws gonio::error for invalid options. O(vertices): 10,000 with the complete surface take about 0.03 s.
[[nodiscard]] inline ear_scan scan_of(const ear_canal& individual, const ear_canal_template& common, std::uint64_t seed,
                                      const scan_options& options = {}) {
  return detail::scanner(individual, seed, options).scan(common);
}

/// Returns scans of `count` individuals of a family. Each has one of the defects with probability `share_of_defects`,
/// otherwise `options.defect`. The first scans are the same for any `count`. Throws gonio::error unless the share is
/// from 0 to 1.
[[nodiscard]] inline std::vector<ear_scan> population(const ear_canal_family& family, const ear_canal_template& common,
                                                      std::size_t count, std::uint64_t seed,
                                                      double share_of_defects = 0.0, const scan_options& options = {}) {
  if (!(share_of_defects >= 0.0 && share_of_defects <= 1.0))
    gonio::refuse("a share of defective scans must be from 0 to 1, not " + std::to_string(share_of_defects));
  constexpr std::array defects{scan_defect::mirrored, scan_defect::half, scan_defect::upside_down,
                               scan_defect::heavy_noise, scan_defect::other_object};
  number_source numbers(seed);
  std::vector<ear_scan> scans;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t of_individual = numbers.seed(), of_scan = numbers.seed();
    const double chance = numbers.uniform(), kind = numbers.uniform();
    scan_options own = options;
    if (chance < share_of_defects)
      own.defect = defects[static_cast<std::size_t>(kind * static_cast<double>(defects.size()))];
    scans.push_back(scan_of(family.draw(of_individual), common, of_scan, own));
  }
  return scans;
}

}  // namespace synthetic
