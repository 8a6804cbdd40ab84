#include "physical.hpp"
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/sum_of_lobes.hpp>

using gonio::direction;
using gonio::rgb;
using gonio::model::ggx;
using gonio::model::lambertian;
using gonio::model::sum_of_lobes;

namespace {

/// The smallest BRDF: not default constructible, and its value is only convertible to rgb.
struct archetype {
  struct value {
    operator rgb() const noexcept { return {1.0, 2.0, 3.0}; }
  };
  explicit archetype(int) {}
  value operator()(const direction&, const direction&) const noexcept { return {}; }
};

}  // namespace

TEST_CASE("a sum keeps what a BRDF must keep") {
  const sum_of_lobes f{lambertian{{0.3, 0.2, 0.1}}, ggx{.alpha = 0.1, .f0 = rgb::Constant(0.04)}, ggx{.alpha = 0.4}};
  check_reciprocal_isotropic_and_not_negative(f);
  check_finite_at_special_pairs_and_zero_below_the_horizon(f);
}

TEST_CASE("a sum is the sum, of any number of lobes, and of sums") {
  const lambertian diffuse{{0.3, 0.2, 0.1}};
  const ggx wide{.alpha = 0.5}, narrow{.alpha = 0.1, .f0 = {0.1, 0.2, 0.3}};
  const sum_of_lobes one{wide};
  const sum_of_lobes two{diffuse, wide};
  const sum_of_lobes nested{two, narrow};
  static_assert(std::is_same_v<decltype(nested), const sum_of_lobes<sum_of_lobes<lambertian, ggx>, ggx>>);
  CHECK(rc::check([&] {
    const direction wi = any_direction(), wo = any_direction();
    RC_ASSERT((one(wi, wo) == wide(wi, wo)).all());
    const rgb sum = diffuse(wi, wo) + wide(wi, wo);
    RC_ASSERT((two(wi, wo) == sum).all());
    RC_ASSERT((nested(wi, wo) == sum + narrow(wi, wo)).all());
    RC_ASSERT((sum_of_lobes<>()(wi, wo) == 0.0).all());
    RC_ASSERT((sum_of_lobes{archetype(1), archetype(2)}(wi, wo) == rgb(2.0, 4.0, 6.0)).all());
  }));
}

TEST_CASE("the lobes of a sum can be read") {
  const sum_of_lobes f{lambertian{}, ggx{.alpha = 0.37}};
  CHECK(std::get<1>(f.lobes()).alpha == 0.37);
}
