#include "physical.hpp"
#include <gonio/model/lobe.hpp>

#include <limits>

/// The smallest lobe with a parameter: a power of the cosines.
template <class Real>
struct cosine_shape {
  static constexpr std::string_view name = "cosine";
  static constexpr std::array parameters{gonio::model::shape_parameter{"power", "", 0.5, 2.0, 1.0}};
  static auto members(auto& self) { return std::tie(self.power); }

  Real power = Real(1.0);

  Real operator()(const gonio::model::lobe_geometry& at) const { return power * at.cosine_i * at.cosine_o; }
};

using cosine_lobe = gonio::model::lobe<cosine_shape>;
static_assert(gonio::brdf<cosine_lobe>);

TEST_CASE("the geometry of a lobe: cosines, half vector, mirror direction") {
  CHECK(rc::check([] {
    const gonio::direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-6 && wo.z() > 1e-6);
    const gonio::model::lobe_geometry at(wi, wo);
    const gonio::direction mirrored(-wi.x(), -wi.y(), wi.z());
    RC_ASSERT(std::abs(at.mirrored_cosine() - mirrored.dot(wo)) < 1e-14);
    RC_ASSERT(std::abs(at.h.norm() - 1.0) < 1e-14);
    RC_ASSERT(std::abs(at.cosine_d - wi.dot(at.h)) < 1e-7);
    const double tangent = std::tan(std::acos(std::min(at.h.z(), 1.0)));
    RC_ASSERT(std::abs(at.squared_tangent_h() - tangent * tangent) <= 1e-6 * (1.0 + tangent * tangent));
  }));
}

TEST_CASE("a lobe is its colour times its shape, and zero below the horizon") {
  const cosine_lobe f({0.1, 0.2, 0.4}, {.power = 2.0});
  check_finite_at_special_pairs_and_zero_below_the_horizon(f);
  check_reciprocal_isotropic_and_not_negative(f);
  const gonio::rgb value = f({0.6, 0.0, 0.8}, {0.0, 0.0, 1.0});
  CHECK(value[2] == doctest::Approx(0.4 * 2.0 * 0.8));
  CHECK(value[0] == doctest::Approx(value[2] / 4.0));
}

TEST_CASE("parameters as an array and back") {
  const auto values = gonio::model::values_of<cosine_shape, double>({.power = 1.25});
  CHECK(values.size() == 1);
  CHECK(values[0] == 1.25);
  CHECK(gonio::model::shape_from<cosine_shape, double>(values).power == 1.25);
}

TEST_CASE("what is out of bounds is refused by name") {
  CHECK_THROWS_WITH_AS(cosine_lobe(gonio::rgb::Ones(), {.power = 3.0}),
                       "cosine: power must be from 0.500000 to 2.000000, not 3.000000", gonio::error);
  CHECK_THROWS_WITH_AS(cosine_lobe(gonio::rgb::Ones(), {.power = std::numeric_limits<double>::quiet_NaN()}),
                       doctest::Contains("power must be"), gonio::error);
  CHECK_THROWS_WITH_AS(cosine_lobe({0.1, -0.1, 0.1}), doctest::Contains("colour"), gonio::error);
  CHECK_THROWS_WITH_AS(cosine_lobe({0.1, std::numeric_limits<double>::infinity(), 0.1}), doctest::Contains("colour"),
                       gonio::error);
}
