#pragma once
/// Directions in the local frame of a surface (normal +z) and Rusinkiewicz's half and difference angles.
/// S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", EGWR 1998
/// (doi:10.1007/978-3-7091-6453-2_2).
///
/// A pair (wi, wo) of an isotropic material has three degrees of freedom: theta_h, the angle between the half vector h
/// and the normal; theta_d, the angle between wi and h; phi_d, the azimuth of wi about h, counted from the plane of
/// normal and h. Swapping wi and wo adds pi to phi_d, so that Helmholtz reciprocity allows phi_d to be folded into [0,
/// pi).

#include <gonio/core/compiled_alignment.hpp>

#include <Eigen/Core>

#include <cmath>
#include <numbers>

namespace gonio {

/// A unit vector in the local frame: x and y tangential, z along the normal.
using direction = Eigen::Vector3d;

/// Half and difference angles in radians: theta_h and theta_d in [0, pi/2] for directions above the
/// horizon, phi_d in [0, pi).
struct half_difference {
  double theta_h = 0.0;
  double theta_d = 0.0;
  double phi_d = 0.0;
};

/// A direction towards the light (wi) and one towards the viewer (wo).
struct direction_pair {
  direction wi;
  direction wo;
};

/// The cosines of wi and wo with the normal; negative below the horizon.
struct cosine_pair {
  double i = 0.0;
  double o = 0.0;
};

[[nodiscard]] constexpr double radians(double degrees) noexcept { return degrees * (std::numbers::pi / 180.0); }

[[nodiscard]] constexpr double degrees(double radians) noexcept { return radians * (180.0 / std::numbers::pi); }

/// Returns the direction at polar angle `theta` from the normal and azimuth `phi`, both in radians.
[[nodiscard]] inline direction spherical_direction(double theta, double phi) noexcept {
  const double sin_theta = std::sin(theta);
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::cos(theta)};
}

/// Returns the angle of a direction from the normal, from 0 to pi, accurately even near the normal.
[[nodiscard]] inline double polar_angle(const direction& w) noexcept {
  return std::atan2(std::hypot(w.x(), w.y()), w.z());
}

/// Returns the azimuth of a direction in (-pi, pi]. Azimuths within 1e-12 of -pi become pi.
[[nodiscard]] inline double azimuth(const direction& w) noexcept {
  const double phi = std::atan2(w.y(), w.x());
  return phi > -std::numbers::pi + 1e-12 ? phi : std::numbers::pi;
}

// All vector operations of this header are written out: each kind of Eigen expression would cost compile time in every
// file that includes the header.

/// Returns the length of a vector.
[[nodiscard]] inline double norm_of(double x, double y, double z) noexcept {
  return std::sqrt(x * x + (y * y + z * z));
}

/// Returns a vector scaled to length 1; a zero vector is unchanged.
[[nodiscard]] inline direction normalised(const direction& w) noexcept {
  const double length = norm_of(w.x(), w.y(), w.z());
  return length > 0.0 ? direction(w.x() / length, w.y() / length, w.z() / length) : w;
}

namespace detail {

/// Returns a u + b v.
[[nodiscard]] inline direction combined(double a, const direction& u, double b, const direction& v) noexcept {
  return {a * u.x() + b * v.x(), a * u.y() + b * v.y(), a * u.z() + b * v.z()};
}

}  // namespace detail

/// Returns the angle in radians between two directions of any nonzero length, accurately even for small angles.
[[nodiscard]] inline double angle_between(const direction& a, const direction& b) noexcept {
  const direction u = normalised(a), v = normalised(b);
  return 2.0 * std::atan2(norm_of(u.x() - v.x(), u.y() - v.y(), u.z() - v.z()),
                          norm_of(u.x() + v.x(), u.y() + v.y(), u.z() + v.z()));
}

/// Rotates a direction about the normal by an azimuth in radians.
[[nodiscard]] inline direction turned_about_normal(const direction& w, double azimuth) noexcept {
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  return {c * w.x() - s * w.y(), s * w.x() + c * w.y(), w.z()};
}

namespace detail {

/// Returns a x b. Eigen's cross product is in its Geometry module, which would double the compile time of this header.
[[nodiscard]] inline Eigen::Vector3d cross_product(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

}  // namespace detail

/// Turns a direction w by `angle`, towards the azimuth `side` about w, both in radians. If w is more than 26 degrees
/// from the normal, `side` 0 is parallel to the surface.
[[nodiscard]] inline direction turned(const direction& w, double angle, double side) noexcept {
  const direction across = std::abs(w.z()) < 0.9 ? direction(0.0, 0.0, 1.0) : direction(1.0, 0.0, 0.0);
  const direction beside = normalised(detail::cross_product(w, across));
  const direction towards = detail::combined(std::cos(side), beside, std::sin(side), detail::cross_product(w, beside));
  return detail::combined(std::cos(angle), w, std::sin(angle), towards);
}

/// Turns a direction like `turned`, but leaves it unchanged if the result would be at or below the horizon.
[[nodiscard]] inline direction turned_above_horizon(const direction& w, double angle, double side) noexcept {
  const direction elsewhere = turned(w, angle, side);
  return elsewhere.z() > 0.0 ? elsewhere : w;
}

/// Folds an azimuth in radians into [0, pi): an isotropic reciprocal BRDF has this period in phi_d.
[[nodiscard]] inline double fold_phi_d(double phi) noexcept {
  const double folded = phi - std::numbers::pi * std::floor(phi / std::numbers::pi);
  // A tiny negative angle rounds up to pi, which is equivalent to 0.
  return folded < std::numbers::pi ? folded : 0.0;
}

/// Returns the half and difference angles of a pair of unit vectors, accurately at any angle. All three come from atan2
/// of quantities without cancellation, because acos of a cosine near 1 loses half the digits. The azimuth of h is 0 at
/// theta_h = 0, and phi_d is 0 at theta_d = 0. Opposite directions have no half vector; the normal is used instead.
[[nodiscard]] inline half_difference to_half_difference(const direction& wi, const direction& wo) noexcept {
  // wi and wo are symmetric about h, so their sum is along h and their difference is perpendicular to it.
  const direction sum(wi.x() + wo.x(), wi.y() + wo.y(), wi.z() + wo.z());
  const direction difference(wi.x() - wo.x(), wi.y() - wo.y(), wi.z() - wo.z());
  const double length = norm_of(sum.x(), sum.y(), sum.z());
  const direction h =
      length > 0.0 ? direction(sum.x() / length, sum.y() / length, sum.z() / length) : direction(0.0, 0.0, 1.0);
  const double sin_theta_h = std::hypot(h.x(), h.y());
  const double cos_phi_h = sin_theta_h > 0.0 ? h.x() / sin_theta_h : 1.0;
  const double sin_phi_h = sin_theta_h > 0.0 ? h.y() / sin_theta_h : 0.0;
  // Rotate the difference by -phi_h about z, then by -theta_h about y, which moves h to the pole.
  const double along = cos_phi_h * difference.x() + sin_phi_h * difference.y();
  const double x = h.z() * along - sin_theta_h * difference.z();
  const double y = cos_phi_h * difference.y() - sin_phi_h * difference.x();
  const double across = norm_of(difference.x(), difference.y(), difference.z());
  return {std::atan2(sin_theta_h, h.z()), std::atan2(across, length), fold_phi_d(std::atan2(y, x))};
}

/// Returns the pair with these angles whose half vector is in the xz plane (phi_h = 0).
[[nodiscard]] inline direction_pair to_directions(const half_difference& angles) noexcept {
  const double sin_h = std::sin(angles.theta_h), cos_h = std::cos(angles.theta_h);
  const double sin_d = std::sin(angles.theta_d), cos_d = std::cos(angles.theta_d);
  const double across = sin_d * std::cos(angles.phi_d);
  // Compute the components along h and perpendicular to it.
  const double x = cos_d * sin_h, z = cos_d * cos_h;
  const double off_x = across * cos_h, off_y = sin_d * std::sin(angles.phi_d), off_z = -across * sin_h;
  return {{x + off_x, off_y, z + off_z}, {x - off_x, -off_y, z - off_z}};
}

/// Returns cos(theta_i) and cos(theta_o) of a pair with these angles.
[[nodiscard]] inline cosine_pair cosines(const half_difference& angles) noexcept {
  const double sum = std::cos(angles.theta_h) * std::cos(angles.theta_d);
  const double difference = std::sin(angles.theta_h) * std::sin(angles.theta_d) * std::cos(angles.phi_d);
  return {sum - difference, sum + difference};
}

}  // namespace gonio
