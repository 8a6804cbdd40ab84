#include <gonio/io/images/image.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/sphere.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <limits>
#include <set>

using gonio::direction;
using gonio::directional_light;
using gonio::image;
using gonio::rgb;
using gonio::render::directional_lighting;
using gonio::render::environment_map;

namespace {

constexpr double pi = std::numbers::pi;

struct white_everywhere {
  rgb operator()(const direction&) const noexcept { return rgb::Ones(); }
};

/// Smooth in every direction. The integrals of (2 + y, 3 + x, 4 - z) over the sphere are (8, 12, 16) pi.
struct affine_radiance {
  rgb operator()(const direction& d) const noexcept { return {2.0 + d.y(), 3.0 + d.x(), 4.0 - d.z()}; }
};

rgb sum_of_irradiance(const directional_lighting& lighting) {
  rgb sum = rgb::Zero();
  for (const directional_light& light : lighting.lights()) sum += light.irradiance;
  return sum;
}

/// Returns the irradiance of a surface with this normal.
rgb irradiance(const directional_lighting& lighting, const direction& normal) {
  rgb sum = rgb::Zero();
  for (const directional_light& light : lighting.lights())
    sum += light.irradiance * std::max(light.towards.dot(normal), 0.0);
  return sum;
}

image black(std::size_t rows) { return gonio::uniform_image(rows, 2 * rows); }

/// A small version of the closed-form environment.
const environment_map& windows() {
  static const environment_map map = environment_map::of(gonio::render::formula_environment{}, 64);
  return map;
}

/// Returns a glossy sphere under lights. Images are normalised; these values are proportional to the light.
std::vector<rgb> glossy_sphere(const directional_lighting& lighting) {
  const gonio::model::ggx gloss{.alpha = 0.3, .f0 = {1.0, 0.77, 0.34}};
  std::vector<rgb> colours;
  for (const auto& point : gonio::render::sphere_points(6)) {
    rgb sum = rgb::Zero();
    lighting.for_each_incident(point.normal, [&](const direction& wi, const direction& wo, const rgb& weight) {
      sum += gloss(wi, wo) * weight;
    });
    colours.push_back(sum);
  }
  return colours;
}

/// Returns the RMS difference of two spheres, relative to the RMS of the second.
double relative_difference(const std::vector<rgb>& a, const std::vector<rgb>& b) {
  double squares = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += (a[i] - b[i]).square().sum();
    scale += b[i].square().sum();
  }
  return std::sqrt(squares / scale);
}

}  // namespace

TEST_CASE("the image's centre is what the camera looks at, longitude runs to the camera's right, up is up") {
  const environment_map map(gonio::uniform_image(64, 128, rgb::Ones()));
  const auto near = [](const direction& a, const direction& b) { return (a - b).norm() < 0.06; };
  CHECK(near(map.towards(32, 64), {0.0, 0.0, -1.0}));
  CHECK(near(map.towards(32, 96), {1.0, 0.0, 0.0}));
  CHECK(near(map.towards(32, 32), {-1.0, 0.0, 0.0}));
  CHECK(near(map.towards(32, 0), {0.0, 0.0, 1.0}));
  CHECK(near(map.towards(32, 127), {0.0, 0.0, 1.0}));
  CHECK(near(map.towards(0, 17), {0.0, 1.0, 0.0}));
  CHECK(near(map.towards(63, 99), {0.0, -1.0, 0.0}));
}

TEST_CASE("the radiance from a pixel's direction is the pixel's") {
  image picture = black(9);
  for (std::size_t row = 0; row < 9; ++row)
    for (std::size_t column = 0; column < 18; ++column)
      gonio::set_pixel(picture, row, column, {1.0 + static_cast<double>(row), static_cast<double>(column), 0.5});
  const environment_map map(picture);
  CHECK(map.rows() == 9);
  CHECK(map.columns() == 18);
  CHECK(map.image() == picture);
  for (std::size_t row = 0; row < 9; ++row)
    for (std::size_t column = 0; column < 18; ++column) {
      CAPTURE(row);
      CAPTURE(column);
      CHECK(map.towards(row, column).norm() == doctest::Approx(1.0).epsilon(1e-15));
      CHECK((map(3.0 * map.towards(row, column)) == gonio::pixel(picture, row, column)).all());
    }
  // Directions at the borders of the image.
  CHECK(map({0.0, 1.0, 0.0}).x() == 1.0);
  CHECK(map({0.0, -1.0, 0.0}).x() == 9.0);
  CHECK(map({0.0, 0.0, 1.0}).y() == 17.0);
  CHECK(map({-0.0, 0.0, 1.0}).y() == 0.0);
}

TEST_CASE("a spot in the image's upper right shines from behind the camera, above on its right") {
  image picture = black(64);
  gonio::set_pixel(picture, 19, 111, {9.0, 9.0, 9.0});  // near direction (1, 1, 1)
  const gonio::model::ggx gloss{.alpha = 0.1, .f0 = {0.9, 0.9, 0.9}};
  const int size = 40;
  const image sphere = gonio::render::render_sphere(
      gloss, gonio::render::important_lights(environment_map(picture), 10, 1), {.size = size});
  const auto points = gonio::render::sphere_points(size);
  const auto brightest =
      std::ranges::max_element(points, {}, [&](const auto& p) { return gonio::pixel(sphere, p.row, p.column).y(); });
  // The highlight is at the normal halfway between light and camera.
  const direction half = (direction(1.0, 1.0, 1.0).normalized() + direction::UnitZ()).normalized();
  CHECK((brightest->normal - half).norm() < 0.08);
}

TEST_CASE("solid angles are exact: they add up to the sphere, and at the pole to a cap") {
  for (const std::size_t rows : {std::size_t{1}, std::size_t{7}, std::size_t{300}}) {
    const environment_map map(gonio::uniform_image(rows, 2 * rows, rgb::Ones()));
    double sum = 0.0;
    for (std::size_t row = 0; row < rows; ++row) sum += static_cast<double>(map.columns()) * map.solid_angle(row);
    CHECK(sum == doctest::Approx(4.0 * pi).epsilon(1e-13));
    const double half = std::sin(0.5 * pi / static_cast<double>(rows));
    CHECK(map.solid_angle(0) * static_cast<double>(map.columns()) == doctest::Approx(4.0 * pi * half * half));
  }
}

TEST_CASE("all lights together are the integral of the radiance") {
  const environment_map map = environment_map::of(affine_radiance{}, 64);
  const directional_lighting lights = gonio::render::all_lights(map);
  CHECK(lights.lights().size() == 64 * 128);
  const rgb sum = sum_of_irradiance(lights);
  // The integrals of x, y and z vanish by symmetry.
  CHECK(sum.x() == doctest::Approx(8.0 * pi).epsilon(1e-6));
  CHECK(sum.y() == doctest::Approx(12.0 * pi).epsilon(1e-6));
  CHECK(sum.z() == doctest::Approx(16.0 * pi).epsilon(1e-6));
  // The irradiance of a + b.d is pi a + (2/3) pi b.n. Radiance is constant within pixels of 2.8 degrees.
  const direction normal = direction(0.3, 0.5, 0.8).normalized();
  const rgb expected = pi * rgb(2.0, 3.0, 4.0) + 2.0 / 3.0 * pi * rgb(normal.y(), normal.x(), -normal.z());
  CHECK((irradiance(lights, normal) / expected - 1.0).abs().maxCoeff() < 1e-3);
}

TEST_CASE("white furnace: in a white environment every point of a white sphere is white") {
  const environment_map map = environment_map::of(white_everywhere{}, 48);
  for (const auto& lights : {gonio::render::all_lights(map), gonio::render::important_lights(map, 2000, 1)})
    for (const direction& normal : {direction(0.0, 0.0, 1.0), direction(0.0, 1.0, 0.0), direction(-0.6, 0.0, 0.8)}) {
      CAPTURE(normal);
      CHECK((irradiance(lights, normal) / pi - 1.0).abs().maxCoeff() < 0.01);
    }
}

TEST_CASE("a single bright pixel is one light, however many are asked for") {
  image picture = black(16);
  gonio::set_pixel(picture, 3, 5, {400.0, 0.0, 20.0});
  const environment_map map(picture);
  for (const auto& lighting : {gonio::render::all_lights(map), gonio::render::important_lights(map, 1, 7),
                               gonio::render::important_lights(map, 1000, 8)}) {
    REQUIRE(lighting.lights().size() == 1);
    const directional_light& light = lighting.lights().front();
    CHECK((light.towards - map.towards(3, 5)).norm() < 1e-15);
    CHECK(light.irradiance.x() == doctest::Approx(400.0 * map.solid_angle(3)).epsilon(1e-12));
    CHECK(light.irradiance.y() == 0.0);
    CHECK(light.irradiance.z() == doctest::Approx(20.0 * map.solid_angle(3)).epsilon(1e-12));
  }
}

TEST_CASE("the curve visits every pixel once, neighbours after one another") {
  for (const auto& [rows, columns] : {std::pair<std::size_t, std::size_t>{8, 16}, {5, 10}, {1, 2}, {16, 16}}) {
    std::set<std::pair<std::size_t, std::size_t>> seen;
    std::size_t jumps = 0, before_row = 0, before_column = 0;
    gonio::render::detail::for_each_along_hilbert_curve(rows, columns, [&](std::size_t row, std::size_t column) {
      CHECK(seen.insert({row, column}).second);
      const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
      if (seen.size() > 1 && apart(row, before_row) + apart(column, before_column) != 1) ++jumps;
      before_row = row;
      before_column = column;
    });
    CHECK(seen.size() == rows * columns);
    if (rows != 5) CHECK(jumps == 0);
  }
}

TEST_CASE("important lights share the luminance equally") {
  const std::size_t count = 300;
  const auto lighting = gonio::render::important_lights(windows(), count, 3);
  const double all = gonio::luminance(sum_of_irradiance(gonio::render::all_lights(windows())));
  CHECK(lighting.lights().size() <= count);
  CHECK(lighting.lights().size() > count / 2);
  CHECK(gonio::luminance(sum_of_irradiance(lighting)) == doctest::Approx(all).epsilon(1e-12));
  for (const directional_light& light : lighting.lights()) {
    const double share = gonio::luminance(light.irradiance) / all * static_cast<double>(count);
    CHECK(share == doctest::Approx(std::round(share)).epsilon(1e-9));
    CHECK(share > 0.5);
  }
}

TEST_CASE("important lights converge to all lights faster than independent ones would") {
  const std::vector<rgb> truth = glossy_sphere(gonio::render::all_lights(windows()));
  std::vector<double> errors;
  for (const std::size_t count : {64u, 256u, 1024u, 4096u}) {
    double squares = 0.0;
    constexpr int seeds = 6;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const double error =
          relative_difference(glossy_sphere(gonio::render::important_lights(windows(), count, seed)), truth);
      squares += error * error / seeds;
    }
    errors.push_back(std::sqrt(squares));
  }
  CAPTURE(errors);
  // Four times as many independent lights would halve the error.
  for (std::size_t i = 1; i < errors.size(); ++i) CHECK(errors[i] < 0.5 * errors[i - 1]);
  CHECK(errors.back() < 0.01);
}

TEST_CASE("important lights are unbiased") {
  const std::vector<rgb> truth = glossy_sphere(gonio::render::all_lights(windows()));
  constexpr int seeds = 400;
  std::vector<rgb> mean(truth.size(), rgb::Zero());
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const std::vector<rgb> one = glossy_sphere(gonio::render::important_lights(windows(), 32, seed));
    const double error = relative_difference(one, truth);
    squares += error * error / seeds;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += one[i] / seeds;
  }
  // The mean of 400 has a twentieth of the standard deviation of one.
  CHECK(std::sqrt(squares) > 0.05);
  CHECK(relative_difference(mean, truth) < 1.5 * std::sqrt(squares / seeds));
}

TEST_CASE("the same seed gives the same lights, another others") {
  const auto same = [](const directional_lighting& a, const directional_lighting& b) {
    return std::ranges::equal(a.lights(), b.lights(), [](const directional_light& p, const directional_light& q) {
      return p.towards == q.towards && (p.irradiance == q.irradiance).all();
    });
  };
  CHECK(same(gonio::render::important_lights(windows(), 100, 5), gonio::render::important_lights(windows(), 100, 5)));
  CHECK(!same(gonio::render::important_lights(windows(), 100, 5), gonio::render::important_lights(windows(), 100, 6)));
}

TEST_CASE("a map is an environment for the half-vector quadrature as well") {
  const gonio::render::environment_lighting by_map(30, 24,
                                                   environment_map::of(gonio::render::formula_environment{}, 256));
  const gonio::render::environment_lighting by_formula(30, 24);
  const gonio::model::ggx gloss{.alpha = 0.3, .f0 = {1.0, 0.77, 0.34}};
  const image a = gonio::render::render_sphere(gloss, by_map, {.size = 12});
  const image b = gonio::render::render_sphere(gloss, by_formula, {.size = 12});
  double squares = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += std::pow(a.data()[i] - b.data()[i], 2.0);
    scale += std::pow(b.data()[i], 2.0);
  }
  // Windows of 4 to 8 degrees in an image with pixels of 0.7 degrees.
  CHECK(std::sqrt(squares / scale) < 0.03);
  CHECK(squares > 0.0);
}

TEST_CASE("what is no environment is refused") {
  const auto refused = [](image picture, const char* words) {
    CHECK_THROWS_WITH_AS((void)environment_map(std::move(picture)), doctest::Contains(words), gonio::error);
  };
  refused(gonio::uniform_image(8, 8, rgb::Ones()), "(8, 8, 3)");  // for example an angular map
  refused(gonio::uniform_image(0, 0), "(0, 0, 3)");
  refused(xt::ones<float>({4, 8, 1}), "(4, 8, 1)");
  refused(black(4), "black");
  image picture = gonio::uniform_image(4, 8, rgb::Ones());
  picture(2, 7, 1) = -0.25f;
  refused(picture, "(row 2, column 7)");
  picture(2, 7, 1) = std::numeric_limits<float>::quiet_NaN();
  refused(picture, "nan");
  picture(2, 7, 1) = std::numeric_limits<float>::infinity();
  refused(picture, "inf");
  const auto darkness = [](const direction&) { return rgb(rgb::Zero()); };
  CHECK_THROWS_AS((void)environment_map::of(darkness), gonio::error);
  CHECK_THROWS_AS((void)environment_map::of(white_everywhere{}, 0), gonio::error);
  CHECK_THROWS_WITH_AS((void)gonio::render::important_lights(windows(), 0, 1), doctest::Contains("0 lights"),
                       gonio::error);
}

TEST_CASE("Grace Cathedral: bright at the windows, and a few lights stand for it") {
  const std::filesystem::path path = GONIO_SHARED_DATA "/environment/grace_probe_latlong.hdr";
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: " << path.string() << " is not here");
    return;
  }
  const environment_map grace(gonio::io::read_hdr(path));
  const rgb all = sum_of_irradiance(gonio::render::all_lights(grace));
  const auto lights = gonio::render::important_lights(grace, 1024, 1);
  CHECK((sum_of_irradiance(lights) / all - 1.0).abs().maxCoeff() < 0.05);
  const rgb up = irradiance(gonio::render::all_lights(grace), direction::UnitY());
  const rgb down = irradiance(gonio::render::all_lights(grace), -direction::UnitY());
  CHECK(gonio::luminance(up) > 2.0 * gonio::luminance(down));
}
