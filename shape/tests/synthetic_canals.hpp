#pragma once
/// Bent tubes with an oval flare and a dimple, similar to ear canals, for tests of shape recognition.

#include "synthetic_surfaces.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

/// Parameters that distinguish canals, about -2 to 2 each; zeros give the mean.
using canal_traits = std::array<double, 6>;

inline canal_traits synthetic_traits(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  canal_traits traits{};
  for (double& trait : traits) {
    for (int i = 0; i < 4; ++i) trait += synthetic_number(generator) - 0.5;
    trait *= std::sqrt(3.0);
  }
  return traits;
}

/// Returns a canal along the y axis, open at both ends and (25 + length) mm high (25 mm for the mean canal): `rings`
/// rings of `around` vertices, numbered as in `tube_mesh`.
inline gonio::shape::triangle_mesh canal_mesh(int rings, int around, const canal_traits& traits = {}) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  const auto& [bend, twist, width, flare, dimple, length] = traits;
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double along = static_cast<double>(ring) / (rings - 1),
                   angle = -2.0 * std::numbers::pi * (i + 0.5 * (ring % 2)) / around;
      const double opening = std::exp(-along * along / 0.08), turned = angle - (0.8 + 0.2 * twist) * along;
      const double hollow = std::exp(-std::pow((along - 0.55) / 0.12, 2) + 2.0 * (std::cos(turned - 2.0) - 1.0));
      const double radius = (3.8 + 0.4 * width) * (1.0 + 0.25 * std::cos(2.0 * turned)) +
                            (6.0 + flare) * opening * (1.0 + 0.35 * std::cos(angle - 0.5)) -
                            (1.2 + 0.3 * dimple) * hollow;
      const double aside = (3.0 + 0.6 * bend) * std::sin(2.5 * along),
                   behind = (2.0 - 0.4 * bend) * std::sin(5.0 * along);
      vertices.emplace_back(aside + radius * std::cos(angle), (25.0 + length) * along,
                            behind + radius * std::sin(angle));
      if (ring == 0) continue;
      const int here = ring * around + i, next = ring * around + (i + 1) % around, below = here - around,
                below_next = next - around;
      // As in `tube_mesh`, except that every second ring is rotated by half a step.
      if (ring % 2 == 1) {
        triangles.emplace_back(below, below_next, here);
        triangles.emplace_back(below_next, next, here);
      } else {
        triangles.emplace_back(below, below_next, next);
        triangles.emplace_back(below, next, here);
      }
    }
  return mesh_of(vertices, triangles);
}
