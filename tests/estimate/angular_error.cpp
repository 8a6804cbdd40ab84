#include "../synthetic_materials.hpp"
#include <gonio/estimate/angular_error.hpp>

#include <doctest/doctest.h>

namespace {

const gonio::log_relative_pca& moved_prior() {
  static const auto basis = learn(synthetic_materials(small_cells(), 12), 100);
  return basis;
}

/// Returns the mapped value at a location of one of the materials that the basis was learned from.
double mapped(std::size_t observation, const gonio::location& at) {
  const auto c = moved_prior().coefficients().row(observation).cast<double>();
  return gonio::offset_at(moved_prior(), at) + gonio::row_at(moved_prior(), at).dot(c);
}

/// Returns m times the mean squared error of a value, over the observations and 64 directions of the angular error.
double measured_eta(const gonio::direction_pair& meant, double angle) {
  const auto here = gonio::locate(small_cells(), gonio::to_half_difference(meant.wi, meant.wo));
  const auto& metric = moved_prior().metric();
  double sum = 0.0;
  constexpr int sides = 64;
  for (int side = 0; side < sides; ++side) {
    const double towards = 2.0 * std::numbers::pi * side / sides;
    for (const gonio::direction_pair& pair :
         {gonio::direction_pair{gonio::turned(meant.wi, angle, towards), meant.wo},
          gonio::direction_pair{meant.wi, gonio::turned(meant.wo, angle, towards)}}) {
      const auto there = gonio::locate(small_cells(), gonio::to_half_difference(pair.wi, pair.wo));
      for (std::size_t j = 0; j < 36; ++j) {
        const double reflectance = metric.inverse(mapped(j, there), there);
        const double wrong = metric.forward(reflectance, here) - mapped(j, here);
        sum += wrong * wrong;
      }
    }
  }
  return sum / sides;
}

}  // namespace

TEST_CASE("the penalty is the mean square change of the materials' values") {
  for (const auto& [theta_h, theta_d, phi_d] : {std::array{2.0, 20.0, 40.0}, std::array{8.0, 40.0, 90.0},
                                                std::array{25.0, 10.0, 130.0}, std::array{40.0, 30.0, 60.0}}) {
    const auto pair = gonio::to_directions({gonio::radians(theta_h), gonio::radians(theta_d), gonio::radians(phi_d)});
    for (const double angle : {gonio::radians(0.1), gonio::radians(0.5)}) {
      CAPTURE(theta_h);
      CAPTURE(angle);
      CHECK(gonio::angular_error_penalty(moved_prior(), pair, angle) ==
            doctest::Approx(measured_eta(pair, angle)).epsilon(0.1));
    }
  }
}

TEST_CASE("without an angular error there is no penalty; the penalties of light and viewer add") {
  const auto pair = gonio::to_directions({0.1, 0.6, 1.0});
  CHECK(gonio::angular_error_penalty(moved_prior(), pair, 0.0) == doctest::Approx(0.0).epsilon(1e-9));
  CHECK(gonio::angular_error_penalty(moved_prior(), pair, 0.01) >
        2.0 * gonio::angular_error_penalty(moved_prior(), pair, 0.005));
}
