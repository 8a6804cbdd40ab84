#include <gonio/core/brdf.hpp>

#include <doctest/doctest.h>

#include <numbers>

namespace {

/// The archetype: the smallest type that satisfies the concept.
struct white_lambertian {
  gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return gonio::rgb::Constant(wi.z() > 0 && wo.z() > 0 ? std::numbers::inv_pi : 0.0);
  }
};
static_assert(gonio::brdf<white_lambertian> && gonio::brdf<gonio::brdf_view<white_lambertian>>);

struct may_throw {
  gonio::rgb operator()(const gonio::direction&, const gonio::direction&) const { return gonio::rgb::Zero(); }
};
static_assert(!gonio::brdf<may_throw>, "evaluating a BRDF never throws");
static_assert(!gonio::brdf<int>);

}  // namespace

TEST_CASE("the archetype of a BRDF evaluates") {
  const white_lambertian white;
  CHECK(white({0, 0, 1}, {0, 0, 1}).x() == doctest::Approx(std::numbers::inv_pi));
  CHECK(white({0, 0, -1}, {0, 0, 1}).x() == 0.0);
}
