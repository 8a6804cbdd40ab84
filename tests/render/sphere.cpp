#include <gonio/render/sphere.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <numbers>

using gonio::brdf_table;
using gonio::direction;
using gonio::image;
using gonio::pixel;
using gonio::rgb;
using gonio::valid_cells;
using gonio::render::sphere_colours;
using gonio::render::sphere_operator;

namespace {

constexpr double pi = std::numbers::pi;

struct white_lambertian {
  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return rgb::Constant(wi.z() > 0 && wo.z() > 0 ? std::numbers::inv_pi : 0.0);
  }
};

/// A coloured highlight on a coloured diffuse part, brighter towards grazing.
struct glossy {
  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const auto angles = gonio::to_half_difference(wi, wo);
    const double lobe = std::exp(-std::pow(angles.theta_h / 0.3, 2.0)) / std::max(std::cos(angles.theta_d), 0.05);
    return rgb(0.1, 0.02, 0.01) + rgb(0.3, 0.4, 0.5) * lobe;
  }
};

/// The smallest lighting.
struct headlight {
  template <class Visit>
  void for_each_incident(const direction& normal, Visit&& visit) const {
    const direction wo = gonio::render::surface_frame(normal).to_local({0.0, 0.0, 1.0});
    if (wo.z() > 0.0) visit(wo, wo, rgb(rgb::Constant(wo.z())));
  }
};

struct no_light {
  template <class Visit>
  void for_each_incident(const direction&, Visit&&) const {}
};

gonio::render::environment_lighting<> coarse_environment() { return gonio::render::environment_lighting(20, 16); }

gonio::render::directional_lighting light_from(const direction& towards) {
  return gonio::render::directional_lighting({{towards}});
}

/// Returns the mean luminance over the pixels of the sphere.
double mean_luminance(const image& picture, int size) {
  double sum = 0.0;
  const auto points = gonio::render::sphere_points(size);
  for (const auto& point : points) sum += gonio::luminance(pixel(picture, point.row, point.column));
  return sum / static_cast<double>(points.size());
}

/// Returns the colours of an image at the points of an operator.
sphere_colours at_points(const image& picture, const sphere_operator& op) {
  sphere_colours colours(std::ssize(op.points()), 3);
  for (std::size_t i = 0; i < op.points().size(); ++i)
    colours.row(i) = pixel(picture, op.points()[i].row, op.points()[i].column).transpose();
  return colours;
}

/// Image and operator round weights and results to float: a few times 6e-8 of the brightest value.
void check_equal(const sphere_colours& a, const sphere_colours& b) {
  REQUIRE(a.rows() == b.rows());
  CHECK((a - b).abs().maxCoeff() <= 5e-7 * b.abs().maxCoeff());
  CHECK(b.abs().maxCoeff() > 0.0);
}

}  // namespace

TEST_CASE("the points of a sphere are those of the reference's grid") {
  const auto points = gonio::render::sphere_points(36);
  // As computed by the reference's render.py; near pi 18^2 = 1018. (Its README says 996 pixels.)
  REQUIRE(points.size() == 1020);
  for (const auto& point : points) {
    CHECK(point.normal.norm() == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(point.normal.z() > 0.0);
    CHECK(point.normal.x() == doctest::Approx((point.column + 0.5) / 18.0 - 1.0));
    CHECK(point.normal.y() == doctest::Approx(1.0 - (point.row + 0.5) / 18.0));
  }
  CHECK(std::ranges::is_sorted(points, {}, [](const auto& p) { return 36 * p.row + p.column; }));
  CHECK(gonio::render::sphere_points(1).size() == 1);
  CHECK(gonio::render::sphere_points(2).size() == 4);
}

TEST_CASE("a white Lambertian sphere has mean luminance 1, whatever the light") {
  const auto mean = [](const auto& lighting, int size) {
    return mean_luminance(gonio::render::render_sphere(white_lambertian(), lighting, {.size = size}), size);
  };
  // Pixels are floats.
  CHECK(mean(gonio::render::two_lights(), 36) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(mean(gonio::render::two_lights(), 77) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(mean(coarse_environment(), 20) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(mean(headlight(), 20) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(mean(gonio::render::directional_lighting({{{1, 2, 3}, {40.0, 2.0, 0.5}}}), 20) ==
        doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE("a Lambertian sphere under one light has the closed form's pixels") {
  // At phase angle g between light and camera, the mean of max(n.l, 0) over the disc is 2 (sin g + (pi - g) cos g) / (3
  // pi). The exposure is its inverse times pi.
  for (const double g : {0.0, 0.5, 1.3, 2.0}) {
    CAPTURE(g);
    const direction light = gonio::spherical_direction(g, 1.1);
    const int size = 200;
    const image picture = gonio::render::render_sphere(white_lambertian(), light_from(light), {.size = size});
    const double mean = 2.0 * (std::sin(g) + (pi - g) * std::cos(g)) / (3.0 * pi);
    for (const auto& point : gonio::render::sphere_points(size)) {
      const double expected = std::max(point.normal.dot(light), 0.0) / mean;
      // The exposure is a sum over 31,000 pixels, not an integral over the disc.
      REQUIRE(pixel(picture, point.row, point.column).y() == doctest::Approx(expected).epsilon(2e-3).scale(1));
    }
  }
}

TEST_CASE("turning the light about the view direction turns the image") {
  const std::size_t size = 24;
  const direction light(0.3, 0.8, -0.2), turned(-0.8, 0.3, -0.2);  // by 90 degrees, from x towards y
  const gonio::render::sphere_view view{.size = static_cast<int>(size), .background = {0.1, 0.2, 0.3}};
  const image before = gonio::render::render_sphere(glossy(), light_from(light), view);
  const image after = gonio::render::render_sphere(glossy(), light_from(turned), view);
  double brightest = 0.0;
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column) {
      // A point at (x, y) moves to (-y, x): column c goes to row size - 1 - c, row r to column r.
      const rgb expected = pixel(before, row, column), found = pixel(after, size - 1 - column, row);
      brightest = std::max(brightest, expected.maxCoeff());
      REQUIRE((found - expected).abs().maxCoeff() <= 1e-5 * (1.0 + expected.maxCoeff()));
    }
  CHECK(brightest > 1.0);
}

TEST_CASE("light from behind shows at the lower left rim, more so on a glossy surface") {
  const int size = 64;
  const auto behind = light_from({-1.0, -1.0, -3.0});
  const image picture = gonio::render::render_sphere(glossy(), behind, {.size = size});
  const image matte = gonio::render::render_sphere(white_lambertian(), behind, {.size = size});
  std::size_t lit = 0;
  for (const auto& point : gonio::render::sphere_points(size)) {
    const double x = point.normal.x(), y = point.normal.y();
    const bool sees_the_light = -x - y > 3.0 * point.normal.z();
    CHECK((pixel(picture, point.row, point.column) > 0.0).all() == sees_the_light);
    if (!sees_the_light) continue;
    ++lit;
    CHECK(x * x + y * y > 9.0 / 11.0);
  }
  CHECK(lit > 30);
  const auto contrast = [&](const image& p) { return pixel(p, 54, 9).x() / pixel(p, 48, 3).x(); };
  CHECK(contrast(picture) != doctest::Approx(contrast(matte)).epsilon(0.1));

  // Under both lights and one exposure, the rim of the glossy sphere is brighter than its front.
  const image both = gonio::render::render_sphere(glossy(), gonio::render::two_lights(), {.size = size});
  CHECK(pixel(both, 54, 9).x() > pixel(both, 40, 24).x());
}

TEST_CASE("the background surrounds the sphere and is blended into pixels that it covers in part") {
  const rgb background(0.25, 0.5, 4.0);
  const image sharp =
      gonio::render::render_sphere(white_lambertian(), headlight(), {.size = 20, .background = background});
  CHECK((pixel(sharp, 0, 0) == background).all());
  CHECK((pixel(sharp, 19, 19) == background).all());

  const gonio::render::sphere_view view{.size = 20, .supersampling = 4, .background = background};
  const image smooth = gonio::render::render_sphere(white_lambertian(), no_light(), view);
  std::size_t partly = 0;
  std::vector<int> covered(400);
  for (const auto& point : gonio::render::sphere_points(80)) ++covered[point.row / 4 * 20 + point.column / 4];
  for (std::size_t i = 0; i < 400; ++i) {
    const rgb expected = background * (1.0 - covered[i] / 16.0);
    CHECK((pixel(smooth, i / 20, i % 20) - expected).abs().maxCoeff() < 1e-6);
    if (covered[i] > 0 && covered[i] < 16) ++partly;
  }
  CHECK(partly > 20);
}

TEST_CASE("supersampling averages, and keeps the exposure") {
  const image fine = gonio::render::render_sphere(glossy(), gonio::render::two_lights(), {.size = 40});
  const image smooth =
      gonio::render::render_sphere(glossy(), gonio::render::two_lights(), {.size = 10, .supersampling = 4});
  for (std::size_t row = 0; row < 10; ++row)
    for (std::size_t column = 0; column < 10; ++column) {
      rgb mean = rgb::Zero();
      for (std::size_t s = 0; s < 16; ++s) mean += pixel(fine, 4 * row + s / 4, 4 * column + s % 4) / 16.0;
      CHECK((pixel(smooth, row, column) - mean).abs().maxCoeff() <= 1e-6 * (1.0 + mean.maxCoeff()));
    }
}

TEST_CASE("brighter lights change nothing, a brighter BRDF everything in proportion") {
  const gonio::render::directional_lighting dim({{{1, 1, 1}}, {{-1, -1, -3}}});
  const gonio::render::directional_lighting bright(
      {{{1, 1, 1}, rgb::Constant(8.0)}, {{-1, -1, -3}, rgb::Constant(8.0)}});
  CHECK(gonio::render::render_sphere(glossy(), dim, {.size = 16}) ==
        gonio::render::render_sphere(glossy(), bright, {.size = 16}));
  const auto twice = [](const direction& wi, const direction& wo) noexcept { return rgb(2.0 * glossy()(wi, wo)); };
  const image one = gonio::render::render_sphere(glossy(), dim, {.size = 16});
  const image two = gonio::render::render_sphere(twice, dim, {.size = 16});
  for (std::size_t i = 0; i < one.size(); ++i) CHECK(two.data()[i] == 2.0f * one.data()[i]);
}

TEST_CASE("without light everything is black and finite") {
  const image picture = gonio::render::render_sphere(glossy(), no_light(), {.size = 8});
  for (const float value : picture) CHECK(value == 0.0f);
}

TEST_CASE("the sphere operator is the image of the table at its nearest cells") {
  // A coarse grid: many directions are in cells whose centre is below the horizon. These cells count as zero.
  for (const auto& grid : {gonio::grid({20, 15, 30}), gonio::grid({12, 9, 8}, gonio::cell_anchor::lower_corner)}) {
    const valid_cells cells(grid);
    const brdf_table table = gonio::tabulate(glossy(), cells);
    const auto check = [&](const auto& lighting) {
      const sphere_operator op(cells, lighting, 24);
      const image picture = gonio::render::render_sphere(gonio::nearest_lookup(table), lighting, {.size = 24});
      check_equal(op.apply(table), at_points(picture, op));
      check_equal(at_points(op.to_image(op.apply(table)), op), at_points(picture, op));
    };
    check(gonio::render::two_lights());
    check(coarse_environment());
    check(headlight());
  }
}

TEST_CASE("the sphere operator is linear, also for negative values, and reads only the cells that light reaches") {
  const valid_cells cells(gonio::grid({20, 15, 30}));
  const sphere_operator op(cells, coarse_environment(), 16);
  const brdf_table a = gonio::tabulate(glossy(), cells), b = gonio::tabulate(white_lambertian(), cells);
  brdf_table difference(cells);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) difference.set(cell, a.at(cell) - 3.0 * b.at(cell));
  const sphere_colours expected = op.apply(a) - 3.0 * op.apply(b);
  CHECK((op.apply(difference) - expected).abs().maxCoeff() < 1e-5);
  CHECK(expected.minCoeff() < 0.0);
  CHECK((op.apply(brdf_table(cells)) == 0.0).all());
  CHECK(op.entries() > 0);
  CHECK(op.entries() <= op.points().size() * 20 * 16);
}

TEST_CASE("the number of threads does not change a byte of a sphere") {
  const valid_cells cells(gonio::grid({20, 15, 30}));
  const brdf_table table = gonio::tabulate(glossy(), cells);
  const auto lighting = coarse_environment();
  const sphere_operator one(cells, lighting, 24, {1}), many(cells, lighting, 24, {5});
  CHECK((one.apply(table, {1}) == many.apply(table, {3})).all());
  const gonio::render::sphere_view view{.size = 24};
  CHECK(gonio::render::render_sphere(glossy(), lighting, view, {1}) ==
        gonio::render::render_sphere(glossy(), lighting, view, {5}));
}

TEST_CASE("a table over other cells is refused") {
  const sphere_operator op(valid_cells(gonio::grid({20, 15, 30})), headlight(), 8);
  CHECK_THROWS_WITH_AS((void)op.apply(brdf_table(valid_cells(gonio::grid({20, 15, 31})))),
                       doctest::Contains("other cells"), gonio::error);
  // Equal cells need not be the same object.
  CHECK((op.apply(brdf_table(valid_cells(gonio::grid({20, 15, 30})))) == 0.0).all());
}

TEST_CASE("operator images have the background around the sphere") {
  const valid_cells cells(gonio::grid({20, 15, 30}));
  const sphere_operator op(cells, headlight(), 12);
  const image picture = op.to_image(op.apply(gonio::tabulate(white_lambertian(), cells)), {0.5, 0.25, 2.0});
  CHECK((pixel(picture, 0, 0) == rgb(0.5, 0.25, 2.0)).all());
  CHECK(pixel(picture, 6, 6).x() == doctest::Approx(1.5).epsilon(0.02));  // the mean of the cosine over a disc is 2/3
}

TEST_CASE("a frame around an axis is orthonormal, and its tangent runs about the axis, even near the poles") {
  const direction axis = direction::UnitY();
  for (const direction& n : {direction(0.6, 0.0, 0.8), direction(0.1, -0.9, 0.42), direction(0, 1, 0),
                             direction(1e-9, 1.0, 0.0), direction(-0.95, 0.1, 0.29)}) {
    const direction normal = n.normalized();
    const auto frame = gonio::render::surface_frame::around(axis, normal);
    CHECK(frame.tangent.norm() == doctest::Approx(1.0));
    CHECK(frame.tangent.cross(frame.bitangent).dot(normal) == doctest::Approx(1.0));
    if (std::abs(normal.y()) < 0.999) CHECK(std::abs(frame.tangent.dot(axis)) < 1e-12);
    CHECK((frame.to_world(frame.to_local({0.2, 0.3, -0.4})) - direction(0.2, 0.3, -0.4)).norm() < 1e-12);
  }
}

TEST_CASE("grooves run about the vertical axis of a turned sphere; an isotropic sphere does not change") {
  // Smooth along its x axis, rough along y: the highlight is long across the grooves.
  const auto brushed = [](const direction& wi, const direction& wo) noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb(0.0, 0.0, 0.0);
    const direction h = (wi + wo).normalized();
    const double x = h.x() / h.z() / 0.1, y = h.y() / h.z() / 0.5;
    return rgb(rgb::Constant(std::exp(-x * x - y * y)));
  };
  const auto lights = light_from({0.0, 0.0, 1.0});
  const image turned = gonio::render::render_sphere(brushed, lights, {.size = 64, .is_turned = true});
  const auto brightness = [&](int row, int column) { return pixel(turned, row, column).y(); };
  CHECK(brightness(16, 32) > 10.0 * brightness(32, 48));  // up from the middle, and as far to the right
  for (const auto& [row, column] : {std::pair{20, 30}, {40, 25}, {32, 10}})
    CHECK(brightness(row, column) == doctest::Approx(brightness(row, 63 - column)).epsilon(1e-9));
  const image plain = gonio::render::render_sphere(glossy{}, lights, {.size = 32});
  const image also = gonio::render::render_sphere(glossy{}, lights, {.size = 32, .is_turned = true});
  for (int row = 0; row < 32; ++row)
    for (int column = 0; column < 32; ++column)
      CHECK((pixel(plain, row, column) - pixel(also, row, column)).abs().maxCoeff() < 1e-5);
}
