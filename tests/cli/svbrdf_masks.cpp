/// gonio svbrdf: texels outside the sample.

#include "svbrdf_images.hpp"
#include "tool.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/table/image.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace {

/// Writes a list of all images with additional entries.
void write_list(const images_folder& given, const std::string& name, const std::string& more) {
  const std::string list = scratch::get(given.folder / "images.json");
  scratch::put(given.folder / name, "{" + more + "," + list.substr(1));
}

/// Row 45, and columns 100 to 199 of all rows, are black.
gonio::image mask_of() {
  gonio::image mask = gonio::uniform_image(70, 375, gonio::rgb(0.0, 0.3, 0.0));
  for (std::size_t row = 0; row < 70; ++row)
    for (std::size_t column = 0; column < 375; ++column)
      if (row == 45 || (column >= 100 && column < 200)) gonio::set_pixel(mask, row, column, gonio::rgb::Zero());
  return mask;
}

bool is_zero(const gonio::io::svbrdf_band& band, std::size_t texel) {
  const auto first = band.weights.begin() + static_cast<std::ptrdiff_t>(12 * texel);
  return std::all_of(first, first + 12, [](auto each) { return each == 0; }) && band.uncertainty[texel] == 0 &&
         band.disagreement[texel] == 0;
}

}  // namespace

TEST_CASE("svbrdf: texels beside the mask have no material, and all others are as without it") {
  const images_folder given;
  run(given.command("whole.gsv"));
  gonio::io::write_png(given.folder / "mask.png", mask_of());
  write_list(given, "masked.json", "\"mask\": \"mask.png\"");
  // Values outside the mask do not matter; they may even be NaN or infinite.
  auto image = given.images[2];
  image(45, 7, 1) = std::numeric_limits<float>::quiet_NaN();
  image(3, 150, 0) = std::numeric_limits<float>::infinity();
  given.replace(2, image);
  run(given.command("masked.gsv", "masked.json"));
  const gonio::io::svbrdf_map whole(given.folder / "whole.gsv"), masked(given.folder / "masked.gsv");
  for (const Eigen::Index number : {0, 1}) {
    const auto expected = whole.read_band(number), found = masked.read_band(number);
    Eigen::Index outside = 0, wrong = 0;
    for (Eigen::Index i = 0; i < masked.header().texels_of_band(number); ++i) {
      const Eigen::Index row = 43 * number + i / 375, column = i % 375;
      const bool is_outside = row == 45 || (column >= 100 && column < 200);
      const auto texel = static_cast<std::size_t>(i);
      outside += is_outside ? 1 : 0;
      wrong += found.has_material(i) == is_outside || is_zero(found, texel) != is_outside ? 1 : 0;
      if (!is_outside)
        wrong += std::equal(found.weights.begin() + 12 * i, found.weights.begin() + 12 * (i + 1),
                            expected.weights.begin() + 12 * i) &&
                         found.uncertainty[texel] == expected.uncertainty[texel] &&
                         found.disagreement[texel] == expected.disagreement[texel]
                     ? 0
                     : 1;
    }
    CHECK(outside == (number == 0 ? 4300 : 2975));
    CHECK(wrong == 0);
  }
  run(given.command("one.gsv", "masked.json") + " --threads 1");
  CHECK(scratch::get(given.folder / "one.gsv") == scratch::get(given.folder / "masked.gsv"));
  const std::string facts = run("info " + (given.folder / "masked.gsv").string());
  CHECK(facts.find("0.72") != std::string::npos);
  // Masked texels are drawn black.
  const std::string drawing = (given.folder / "map.png").string();
  run("render " + (given.folder / "masked.gsv").string() + " --prior " + (given.folder / "small.prior").string() +
      " --light 20,10 --exposure 0.5 -o " + drawing);
  const gonio::image drawn = gonio::io::read_png(drawing);
  CHECK((gonio::pixel(drawn, 45, 7) == 0.0).all());
  CHECK((gonio::pixel(drawn, 44, 7) > 0.0).all());
}

TEST_CASE("svbrdf: texels with values that are not finite are skipped where the list says so") {
  const images_folder given;
  auto image = given.images[2];
  image(50, 7, 1) = std::numeric_limits<float>::quiet_NaN();
  given.replace(2, image);
  image = given.images[0];
  image(2, 3, 2) = -std::numeric_limits<float>::infinity();
  given.replace(0, image);
  write_list(given, "skip.json", "\"invalid\": \"skip\"");
  write_list(given, "refuse.json", "\"invalid\": \"refuse\"");
  refuses(given.command("map.gsv", "refuse.json"), {"image-0.npy", "row 2, column 3", "\"invalid\": \"skip\""});
  run(given.command("map.gsv", "skip.json"));
  const gonio::io::svbrdf_map map(given.folder / "map.gsv");
  Eigen::Index outside = 0;
  for (const Eigen::Index number : {0, 1}) {
    const auto band = map.read_band(number);
    for (Eigen::Index i = 0; i < map.header().texels_of_band(number); ++i) outside += band.has_material(i) ? 0 : 1;
    CHECK(!band.has_material(number == 0 ? 2 * 375 + 3 : 7 * 375 + 7));
  }
  CHECK(outside == 2);
}

TEST_CASE("svbrdf: masks that do not fit, and lists that say something else, are refused") {
  const images_folder given;
  gonio::io::write_png(given.folder / "mask.png", gonio::uniform_image(70, 374, gonio::rgb::Ones()));
  write_list(given, "list.json", "\"mask\": \"mask.png\"");
  refuses(given.command("map.gsv", "list.json"), {"mask.png: has 374 x 70 pixels", "375 x 70"});
  write_list(given, "list.json", "\"mask\": \"absent.png\"");
  refuses(given.command("map.gsv", "list.json"), {"absent.png", "No such file"});
  write_list(given, "list.json", "\"mask\": 3");
  refuses(given.command("map.gsv", "list.json"), {"list.json", "'mask'"});
  write_list(given, "list.json", "\"invalid\": \"zero\"");
  refuses(given.command("map.gsv", "list.json"), {"list.json", "'invalid'", "zero"});
  CHECK(!scratch::fs::exists(given.folder / "map.gsv.part"));
}
