#include <gonio/model/clipped_brdf.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>

#include <doctest/doctest.h>

#include <numbers>

namespace {

/// A grey diffuser whose red is negative if light and viewer are on the same side of the normal.
struct dark_red {
  double red;
  gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return gonio::rgb::Zero();
    const double grey = 0.5 * std::numbers::inv_pi;
    return {wi.x() * wo.x() + wi.y() * wo.y() > 0.0 ? red : grey, grey, grey};
  }
};

}  // namespace

static_assert(gonio::brdf<gonio::model::clipped_brdf<dark_red>>);

TEST_CASE("negative values count as zero, and no other value changes") {
  const dark_red f{-0.1};
  const gonio::model::clipped_brdf clipped(f);
  const gonio::direction light(0.6, 0, 0.8), same_side(0.8, 0, 0.6), other_side(-0.8, 0, 0.6);
  CHECK(clipped(light, same_side)[0] == 0.0);
  CHECK(clipped(light, same_side)[1] == f(light, same_side)[1]);
  CHECK((clipped(light, other_side) == f(light, other_side)).all());
}

TEST_CASE("negative values are counted, and integrated as a sphere of light sees them") {
  const gonio::valid_cells cells(gonio::grid({18, 9, 12}));
  CHECK(gonio::model::count_negative_values(gonio::model::ggx{}, cells).cells == 0);
  const double grey = 0.5 * std::numbers::inv_pi, red = -0.5 * grey;
  const auto found = gonio::model::count_negative_values(dark_red{red}, cells);
  CHECK(found.cells > cells.size() / 5);
  CHECK(found.cells < cells.size());
  // Half of all pairs are on the same side. If green and blue are 1, red is 1 / 4, or 1 / 2 without its negative part.
  CHECK(found.added[0] == doctest::Approx(0.25 / (2.5 / 3.0)).epsilon(0.03));
  CHECK(found.added[1] == doctest::Approx(0.0));
}
