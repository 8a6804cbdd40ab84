#include "../golden.hpp"
#include <gonio/render/lighting.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::direction;
using gonio::rgb;

namespace {

constexpr double pi = std::numbers::pi;

/// Returns an integer of [0, 10^6] as a fraction. All are equally likely from the first example on.
double any_fraction() { return 1e-6 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1'000'001)); }

/// Returns a normal that faces the camera.
direction any_normal() {
  const double theta = any_fraction() * 0.999 * pi / 2.0;
  return gonio::spherical_direction(theta, any_fraction() * 2.0 * pi);
}

/// The smallest lighting, from the concept's documentation.
struct headlight {
  template <class Visit>
  void for_each_incident(const direction& normal, Visit&& visit) const {
    const direction wo = gonio::render::surface_frame(normal).to_local({0.0, 0.0, 1.0});
    if (wo.z() > 0.0) visit(wo, wo, rgb(rgb::Constant(wo.z())));
  }
};
static_assert(gonio::render::sphere_lighting<headlight>);
static_assert(!gonio::render::sphere_lighting<direction>);

struct white_everywhere {
  rgb operator()(const direction&) const noexcept { return rgb::Ones(); }
};

struct incident {
  direction wi, wo;
  rgb weight;
};

template <gonio::render::sphere_lighting Lighting>
std::vector<incident> all_incident(const Lighting& lighting, const direction& normal) {
  std::vector<incident> result;
  lighting.for_each_incident(normal, [&](const direction& wi, const direction& wo, const rgb& weight) {
    result.push_back({wi, wo, weight});
  });
  return result;
}

template <gonio::render::sphere_lighting Lighting>
rgb irradiance(const Lighting& lighting, const direction& normal) {
  rgb sum = rgb::Zero();
  for (const incident& light : all_incident(lighting, normal)) sum += light.weight;
  return sum;
}

template <gonio::render::sphere_lighting Lighting>
void check_contract(const Lighting& lighting) {
  CHECK(rc::check([&] {
    const direction normal = any_normal();
    const gonio::render::surface_frame frame(normal);
    for (const auto& [wi, wo, weight] : all_incident(lighting, normal)) {
      RC_ASSERT(std::abs(wi.norm() - 1.0) < 1e-14);
      RC_ASSERT(wi.z() > 0.0);
      RC_ASSERT((frame.to_world(wo) - direction::UnitZ()).norm() < 1e-14);
      RC_ASSERT((weight >= 0.0).all());
    }
  }));
}

}  // namespace

TEST_CASE("a surface frame is orthonormal, right-handed, and has the normal as its z axis") {
  CHECK(rc::check([] {
    const direction normal = gonio::spherical_direction(any_fraction() * pi, any_fraction() * 2.0 * pi);
    const gonio::render::surface_frame frame(normal);
    Eigen::Matrix3d axes;
    axes << frame.tangent, frame.bitangent, frame.normal;
    RC_ASSERT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < 1e-14);
    RC_ASSERT(std::abs(axes.determinant() - 1.0) < 1e-14);
    RC_ASSERT((frame.to_local(normal) - direction::UnitZ()).norm() < 1e-14);
    const direction any = any_normal();
    RC_ASSERT((frame.to_world(frame.to_local(any)) - any).norm() < 1e-14);
  }));
}

TEST_CASE("every lighting keeps the contract of the concept") {
  check_contract(headlight());
  check_contract(gonio::render::two_lights());
  check_contract(gonio::render::environment_lighting(12, 10));
}

TEST_CASE("the environment agrees with the reference") {
  const auto golden = golden_csv("env.csv");
  REQUIRE(golden.at("x").size() == 100);
  for (std::size_t i = 0; i < golden.at("x").size(); ++i) {
    CAPTURE(i);
    const rgb radiance = gonio::render::environment_radiance({golden.at("x")[i], golden.at("y")[i], golden.at("z")[i]});
    CHECK(radiance.x() == doctest::Approx(golden.at("r")[i]).epsilon(1e-13));
    CHECK(radiance.y() == doctest::Approx(golden.at("g")[i]).epsilon(1e-13));
    CHECK(radiance.z() == doctest::Approx(golden.at("b")[i]).epsilon(1e-13));
  }
}

TEST_CASE("the environment's windows shine at their centres, and their cut-off edges are not seen") {
  // The brightest window, with intensity 60 and a width of 7 degrees, on a sky below 0.6.
  const direction window = direction(-0.85, 0.2, -0.48).normalized();
  CHECK(gonio::render::environment_radiance(window).x() > 60.0);
  CHECK(gonio::render::environment_radiance(window).x() < 60.6);
  const direction aside = window.cross(direction::UnitY()).normalized();
  const auto window_alone = [](double degrees) { return 60.0 * std::exp(-std::pow(degrees / 7.0, 4.0)); };
  double before = gonio::render::environment_radiance(window).x();
  for (int step = 1; step <= 300; ++step) {
    CAPTURE(step);
    const double angle = gonio::radians(0.1 * step);
    const double after = gonio::render::environment_radiance(std::cos(angle) * window + std::sin(angle) * aside).x();
    // The remainder is the sky, which changes by less than 0.01 in each step.
    const double sky = (after - before) - (window_alone(0.1 * step) - window_alone(0.1 * (step - 1)));
    CHECK(std::abs(sky) < 0.01);
    before = after;
  }
}

TEST_CASE("directional lights give their irradiance times the cosine, above the horizon only") {
  const gonio::render::directional_lighting lights({{{0.0, 0.0, 2.0}, {1.0, 2.0, 3.0}}, {{3.0, 0.0, 0.0}}});
  CHECK(rc::check([&] {
    const direction normal = any_normal();
    const rgb expected = rgb(1.0, 2.0, 3.0) * normal.z() + std::max(normal.x(), 0.0);
    RC_ASSERT((irradiance(lights, normal) - expected).abs().maxCoeff() < 1e-14);
    for (const incident& light : all_incident(lights, normal))
      RC_ASSERT(std::abs(light.wi.dot(light.wo) - normal.z() / light.wo.z()) < 1e-12 ||
                std::abs(light.wi.dot(light.wo)) < 1e-14);
  }));
  CHECK(all_incident(lights, direction(0.0, 0.6, -0.8)).empty());  // the camera does not see this point
}

TEST_CASE("the thesis's lights: one in front, one behind that reaches the lower left rim only") {
  const gonio::render::directional_lighting lights = gonio::render::two_lights();
  const auto normal_at = [](double x, double y) { return direction(x, y, std::sqrt(1.0 - x * x - y * y)); };
  const direction front = direction(1.0, 1.0, 1.0).normalized();
  CHECK(irradiance(lights, front).x() == doctest::Approx(1.0));
  CHECK(all_incident(lights, direction(0.0, 0.0, 1.0)).size() == 1);
  CHECK(irradiance(lights, direction(0.0, 0.0, 1.0)).x() == doctest::Approx(1.0 / std::sqrt(3.0)));
  CHECK(all_incident(lights, normal_at(-0.5, -0.5)).empty());
  const auto rim = all_incident(lights, normal_at(-0.7, -0.7));
  REQUIRE(rim.size() == 1);
  CHECK(rim[0].weight.x() == doctest::Approx((1.4 - 3.0 * std::sqrt(0.02)) / std::sqrt(11.0)));
  CHECK(rim[0].wi.z() < 0.3);
  CHECK(rim[0].wo.z() < 0.15);
  CHECK(all_incident(lights, normal_at(0.7, 0.7)).size() == 1);
}

TEST_CASE("incident directions of an environment mirror the camera at half vectors that cover the hemisphere") {
  const gonio::render::environment_lighting lighting(9, 7);
  // Seen along the normal, wi is above the horizon if h is within 45 degrees of the normal: 6 of 9 rings in
  // sqrt(theta_h).
  const auto seen = all_incident(lighting, direction(0.0, 0.0, 1.0));
  CHECK(seen.size() == 6 * 7);
  for (const auto& [wi, wo, weight] : seen) {
    const double theta_h = std::acos(wi.dot(wo)) / 2.0;
    const double ring = 9.0 * std::sqrt(theta_h / (pi / 2.0)) - 0.5;
    CHECK(ring == doctest::Approx(std::round(ring)).epsilon(1e-7).scale(1));
  }
}

TEST_CASE("under uniform light a point that faces the camera receives pi, and finer bins come nearer for all") {
  const gonio::render::environment_lighting usual(90, 72, white_everywhere()), fine(360, 288, white_everywhere());
  const auto error = [](const auto& lighting, double theta) {
    return std::abs(irradiance(lighting, gonio::spherical_direction(theta, 0.4)).x() / pi - 1.0);
  };
  for (const double theta : {0.0, 0.4, 0.8, 1.2, 1.4}) {
    CAPTURE(theta);
    // Bins are in or out by their centres. Bins cut at wi's horizon have zero weight at the cut; those cut at h's do
    // not.
    CHECK(error(usual, theta) < 0.01);
    CHECK(error(fine, theta) < 0.002);
  }
}
