#include "lab/sphere_lab.hpp"
#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using gonio::capture::samples_of;
using gonio::capture::surface_of;

namespace {

const gonio::capture::placed_sphere photographed_sphere{{0.02, -0.01, 0.0}, 1.0};
const gonio::capture::point_lamp photograph_lamp{{8.0, 2.0, 9.0}, {500.0, 400.0, 300.0}};

gonio::lens_camera photograph_camera() {
  return {gonio::pinhole_camera::look_at({96, 112, 430.0, 430.0, 56.0, 48.0}, {0.0, 0.0, 12.0}, {0.0, 0.0, 0.0},
                                         {0.0, 1.0, 0.0}),
          {.k1 = -0.2, .k2 = 0.05, .p1 = 0.001, .p2 = 0.001}};
}

const gonio::model::formula_brdf photographed_paint = gonio::model::formula_material("red-paint");

gonio::image take(const lab::camera_defects& defects = {}, std::uint64_t seed = 0) {
  return lab::photograph(photographed_paint, photographed_sphere, photograph_camera(), photograph_lamp, defects, seed);
}

gonio::image take_white(const lab::camera_defects& defects = {}, std::uint64_t seed = 1) {
  return lab::photograph(lab::white_material{0.9}, photographed_sphere, photograph_camera(), photograph_lamp, defects,
                         seed);
}

/// Returns the median relative error of the samples' green channel.
double median_error(const gonio::sample_set& samples) {
  std::vector<double> all;
  for (const gonio::sample& s : samples) {
    const auto [wi, wo] = s.directions.pair();
    all.push_back(std::abs(s.value.y() / photographed_paint(wi, wo).y() - 1.0));
  }
  std::ranges::nth_element(all, all.begin() + std::ssize(all) / 2);
  return all[all.size() / 2];
}

template <class Act>
void refused_with(const Act& act, const std::string& why) {
  CAPTURE(why);
  try {
    act();
    FAIL("was not refused");
  } catch (const gonio::error& refusal) {
    CAPTURE(refusal.what());
    CHECK(std::string(refusal.what()).find(why) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("a photograph of a sphere under a lamp gives the paint's values") {
  const auto surface = surface_of(photographed_sphere, photograph_camera());
  const auto found = samples_of(take(), surface, photograph_camera(), photograph_lamp);
  CHECK(found.samples.size() > 500);
  CHECK(found.pixels > std::ssize(found.samples));
  CHECK(median_error(found.samples) < 0.004);
}

TEST_CASE("a pixel's receiver blurs half vectors as the sphere's normals within it do") {
  // In the middle of the sphere, the normal turns by one pixel divided by the radius of 430 / 11 pixels.
  const auto surface = surface_of(photographed_sphere, photograph_camera());
  auto lamp = photograph_lamp;
  lamp.radius = 0.2;
  double nearest = 1.0, receiver = 0.0, source = 0.0;
  for (const gonio::sample& s : samples_of(take(), surface, photograph_camera(), lamp).samples)
    if (const double off = 1.0 - s.directions.pair().wo.z(); off < nearest) {
      nearest = off;
      receiver = s.aperture.receiver;
      source = s.aperture.source;
    }
  CHECK(receiver == doctest::Approx(2.0 / std::sqrt(3.0) * 11.0 / 430.0).epsilon(0.1));
  CHECK(source == doctest::Approx(0.2 / (photograph_lamp.position.norm() - 0.7)).epsilon(0.05));
}

TEST_CASE("a white image removes vignetting and falloff, which corrupt a photograph alone") {
  const auto surface = surface_of(photographed_sphere, photograph_camera());
  const lab::camera_defects dark{.vignetting = true};
  const gonio::image picture = take(dark);
  const auto alone = samples_of(picture, surface, photograph_camera(), photograph_lamp);
  CHECK(median_error(alone.samples) > 0.02);
  const gonio::capture::white_reference white{take_white(dark), 0.9, {}};
  const auto relative = samples_of(picture, surface, photograph_camera(), photograph_lamp, white);
  CHECK(median_error(relative.samples) < 0.004);
  // A reference whose shape is given leads to the same result.
  const gonio::capture::white_reference shaped{white.photograph, 0.9, surface};
  const auto same = samples_of(picture, surface, photograph_camera(), photograph_lamp, shaped);
  REQUIRE(same.samples.size() == relative.samples.size());
  for (std::size_t i = 0; i < same.samples.size(); ++i)
    REQUIRE((same.samples[i].value / relative.samples[i].value - 1.0).abs().maxCoeff() < 1e-12);
}

TEST_CASE("noise is averaged in a cell, and stated") {
  const auto surface = surface_of(photographed_sphere, photograph_camera());
  const auto found = samples_of(take({.noise = 0.05}), surface, photograph_camera(), photograph_lamp, {},
                                {.cells = gonio::grid({12, 90, 18})});
  CHECK(found.pixel_deviation.y() > 0.04);
  const auto single = samples_of(take({.noise = 0.05}), surface, photograph_camera(), photograph_lamp, {},
                                 {.cells = gonio::grid({900, 90, 1800})});
  CHECK(median_error(found.samples) < 0.7 * median_error(single.samples));
}

TEST_CASE("a map of a sphere's normals and positions gives the sphere's samples") {
  const gonio::lens_camera camera = photograph_camera();
  const auto surface = surface_of(photographed_sphere, camera);
  gonio::capture::vector_map normals({96, 112, 3}), positions({96, 112, 3});
  for (Eigen::Index i = 0; i < surface.normals.cols(); ++i)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      normals.data()[3 * i + axis] = static_cast<float>(3.0 * surface.normals(axis, i));
      positions.data()[3 * i + axis] = static_cast<float>(surface.positions(axis, i));
    }
  const auto mapped = gonio::capture::surface_of_maps(normals, "normals.npy", camera, positions);
  CHECK((mapped.normals - surface.normals).cwiseAbs().maxCoeff() < 1e-6);
  const auto found = samples_of(take(), mapped, camera, photograph_lamp);
  CHECK(median_error(found.samples) < 0.004);
  // Without positions, a distant light is accepted and a lamp is refused.
  const auto bare = gonio::capture::surface_of_maps(normals, "normals.npy", camera);
  CHECK_NOTHROW(samples_of(take(), bare, camera, gonio::directional_light{gonio::direction(0.6, 0.0, 0.8)}));
  refused_with([&] { static_cast<void>(samples_of(take(), bare, camera, photograph_lamp)); },
               "needs the positions of the surface");
  gonio::capture::vector_map small = xt::xtensor<float, 3>::from_shape({95, 112, 3});
  small.fill(0.0F);
  refused_with([&] { static_cast<void>(gonio::capture::surface_of_maps(small, "normals.npy", camera)); },
               "normals.npy: has 112 x 95 pixels, but its camera 112 x 96");
  normals.data()[3 * (112 * 5 + 7)] = std::numeric_limits<float>::quiet_NaN();
  refused_with([&] { static_cast<void>(gonio::capture::surface_of_maps(normals, "normals.npy", camera)); },
               "normals.npy: pixel (row 5, column 7) is not finite");
}

TEST_CASE("bad photographs are refused") {
  const gonio::lens_camera camera = photograph_camera();
  const auto surface = surface_of(photographed_sphere, camera);
  const auto refuses = [&](const gonio::image& picture, const gonio::capture::surface_light& light,
                           const gonio::capture::photograph_options& options, const std::string& why) {
    refused_with([&] { static_cast<void>(samples_of(picture, surface, camera, light, {}, options)); }, why);
  };
  refuses(gonio::uniform_image(96, 111), photograph_lamp, {},
          "the photograph has 111 x 96 pixels, but its camera 112 x 96");
  refuses(take(), gonio::capture::point_lamp{photographed_sphere.centre}, {}, "behind or inside");
  refuses(take(), gonio::directional_light{gonio::direction(0.0, 0.0, -1.0)}, {}, "the light is behind");
  refuses(take(), photograph_lamp, {.saturation = 1e-9}, "is saturated");
  // A surface with only one pixel that has neighbours on all sides.
  gonio::capture::vector_map normals = xt::xtensor<float, 3>::from_shape({96, 112, 3});
  normals.fill(0.0F);
  for (std::size_t row = 47; row < 50; ++row)
    for (std::size_t column = 55; column < 58; ++column) normals(row, column, 2) = 1.0F;
  const auto patch = gonio::capture::surface_of_maps(normals, "normals.npy", camera);
  const gonio::directional_light distant{gonio::direction(0.6, 0.0, 0.8)};
  const auto refuses_patch = [&](const gonio::capture::photograph_options& options, const std::string& why) {
    refused_with([&] { static_cast<void>(samples_of(take(), patch, camera, distant, {}, options)); }, why);
  };
  refuses_patch({.saturation = 1e-9}, "every pixel of the surface is saturated");
  refuses_patch({.smallest_cosine = 0.9}, "the photograph shows no lit part of the surface");
  gonio::image broken = take();
  gonio::set_pixel(broken, 48, 56, gonio::rgb::Constant(std::numeric_limits<double>::quiet_NaN()));
  refuses(broken, photograph_lamp, {}, "the photograph: pixel (row 48, column 56) is not a number");
  refused_with(
      [&] {
        static_cast<void>(surface_of(gonio::capture::placed_sphere{{0, 0, 11.5}, 1.0}, camera));
      },
      "the camera is inside the sphere");
  const gonio::capture::white_reference small{gonio::uniform_image(3, 3), 0.9, {}};
  refused_with([&] { static_cast<void>(samples_of(take(), surface, camera, photograph_lamp, small)); },
               "the white image has 3 x 3 pixels");
}
