/// gonio render with an environment, and of tables stored as arrays.

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/exr.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/render/slice.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace {

struct rendered_folder {
  scratch::folder folder;
  std::string table = (folder / "gold.binary").string(), sky = (folder / "sky.hdr").string();

  rendered_folder() {
    REQUIRE(gonio_tool("expand --formula gold-metal -o " + table).exit_code == 0);
    gonio::io::write_hdr(sky, gonio::render::environment_map::of(gonio::render::formula_environment{}, 16).image());
  }
  [[nodiscard]] std::string at(const char* name) const { return (folder / name).string(); }
};

}  // namespace

TEST_CASE("gonio render --environment: a sphere among its surroundings, the same for any number of threads") {
  const rendered_folder given;
  const auto draw = [&](const std::string& options, const char* name) {
    const auto result = gonio_tool("render " + given.table + " --environment " + given.sky + " --quality 2 " + options +
                                   " -o " + given.at(name));
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    return scratch::get(given.at(name));
  };
  const auto one = draw("--threads 1", "one.png");
  CHECK(one == draw("--threads 3", "two.png"));
  CHECK(one != draw("--seed 2", "other.png"));
  CHECK(one.size() > 50'000u);
}

TEST_CASE("gonio render: bright spheres are not blown out, and all of an image are exposed alike") {
  const rendered_folder given;
  REQUIRE(gonio_tool("expand --formula red-paint -o " + given.at("red.binary")).exit_code == 0);
  const auto draw = [&](const std::string& arguments) {
    const auto result = gonio_tool("render --size 64 " + arguments + " -o " + given.at("spheres.png"));
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    return gonio::io::read_png(given.folder / "spheres.png");
  };
  // Returns the fraction of white pixels inside the margin.
  const auto blown_out = [](const gonio::image& image) {
    std::size_t white = 0;
    for (std::size_t row = 8; row < 72; ++row)
      for (std::size_t column = 8; column < 72; ++column)
        white += (gonio::pixel(image, row, column) > 0.999).any() ? 1u : 0u;
    return static_cast<double>(white) / (64.0 * 64.0);
  };
  const gonio::image both = draw(given.table + " " + given.at("red.binary"));
  CHECK(both.shape(0) == 80u);
  CHECK(both.shape(1) == 152u);
  CHECK(blown_out(both) < 0.015);
  CHECK(blown_out(draw("--exposure 1 " + given.table)) > 0.05);
  // The shared exposure makes the red sphere darker next to a bright one than alone.
  CHECK(gonio::pixel(both, 40, 112).x() < 0.9 * gonio::pixel(draw(given.at("red.binary")), 40, 40).x());
}

TEST_CASE("gonio render --light: lights of one's own") {
  const rendered_folder given;
  const auto draw = [&](const std::string& arguments) {
    run("render --size 64 --exposure 1 " + given.table + " " + arguments + " -o " + given.at("sphere.png"));
    return gonio::io::read_png(given.folder / "sphere.png");
  };
  // The first of the two lights is at [1, 1, 1]. The other one only reaches the lower left rim.
  const gonio::image both = draw(""), first = draw("--light 45,35.2644");
  CHECK(gonio::pixel(first, 32, 48).maxCoeff() > 0.1);
  CHECK(gonio::pixel(first, 61, 19).maxCoeff() < 0.5 * gonio::pixel(both, 61, 19).maxCoeff());
  // Lights at the left and the right give mirror images.
  const gonio::image left = draw("--light=-60,0"), right = draw("--light 60,0");
  CHECK((gonio::pixel(left, 40, 20) - gonio::pixel(right, 40, 59)).abs().maxCoeff() < 0.005);
  CHECK(gonio::pixel(left, 40, 20).maxCoeff() > 0.1);
  const gonio::image again = draw("--light 45,35.2644 --light=-161.5651,-17.5484");
  double worst = 0.0;
  for (std::size_t row = 0; row < 80; ++row)
    for (std::size_t column = 0; column < 80; ++column)
      worst = std::max(worst, (gonio::pixel(again, row, column) - gonio::pixel(both, row, column)).abs().maxCoeff());
  CHECK(worst < 0.01);
  for (const char* wrong : {"45", "45,35,1", "45,north", "181,0", "0,91", "nan,0", "''"}) {
    CAPTURE(wrong);
    refuses("render " + given.table + " -o " + given.at("x.png") + " --light " + wrong, {"--light"});
  }
  refuses("render " + given.table + " -o " + given.at("x.png") + " --slices --light 0,0", {"--light"});
}

TEST_CASE("gonio render --columns: a contact sheet, row by row; 512 pixels a side unless asked otherwise") {
  const rendered_folder given;
  const auto draw = [&](const std::string& arguments) {
    run("render --slices " + arguments + " -o " + given.at("sheet.png"));
    return gonio::io::read_png(given.folder / "sheet.png");
  };
  REQUIRE(gonio_tool("expand --formula red-paint -o " + given.at("red.binary")).exit_code == 0);
  const std::string gold = given.table, red = given.at("red.binary");
  const gonio::image sheet = draw("--size 32 --columns 2 " + gold + " " + gold + " " + red);
  const gonio::image row = draw("--size 32 " + gold + " " + red);
  REQUIRE(sheet.shape(0) == 88u);
  REQUIRE(sheet.shape(1) == 88u);
  REQUIRE(row.shape(0) == 48u);
  for (std::size_t y = 0; y < 32; ++y)
    for (std::size_t x = 0; x < 32; ++x) {
      CHECK((gonio::pixel(sheet, 8 + y, 48 + x) == gonio::pixel(row, 8 + y, 8 + x)).all());
      CHECK((gonio::pixel(sheet, 48 + y, 8 + x) == gonio::pixel(row, 8 + y, 48 + x)).all());
      CHECK((gonio::pixel(sheet, 48 + y, 48 + x) == 0.0).all());
    }
  CHECK(draw(gold).shape(0) == 528u);
}

TEST_CASE("gonio render --compare: the difference of two tables as a third image, with its scale") {
  const rendered_folder given;
  run("expand --formula red-paint -o " + given.at("red.binary"));
  const auto draw = [&](const std::string& arguments) {
    const std::string told = run("render --size 128 --compare " + arguments + " -o " + given.at("three.png"));
    return std::pair(told, gonio::io::read_png(given.folder / "three.png"));
  };
  const auto [none, same] = draw(given.table + " " + given.table);
  CHECK(none.find("Delta E of the images: 0.00") == 0);
  REQUIRE(same.shape(1) == 3u * 128 + 4 * 8);
  // The lit part of the sphere is light. The scale at the bottom ends dark and has numbers.
  const auto is = [](const gonio::rgb& pixel, double share) {
    return (pixel - gonio::render::sequential_colour(share)).abs().maxCoeff() < 0.01;  // 8 bits
  };
  CHECK(is(gonio::pixel(same, 8 + 40, 280 + 80), 0.0));
  CHECK(is(gonio::pixel(same, 8 + 128 - 16, 280 + 127), 1.0));
  double brightest = 0.0;
  for (std::size_t row = 8 + 128 - 10; row < 8 + 128; ++row)
    for (std::size_t column = 280; column < 280 + 40; ++column)
      brightest = std::max(brightest, double{gonio::pixel(same, row, column).y()});
  CHECK(brightest > 0.5);
  const auto [some, two] = draw(given.table + " " + given.at("red.binary"));
  CHECK(some.find("Delta E of the images: 0.00") == std::string::npos);
  CHECK_FALSE(is(gonio::pixel(two, 8 + 40, 280 + 80), 0.0));
  const auto [slices, drawn] = draw("--slices " + given.table + " " + given.at("red.binary"));
  CHECK(drawn.shape(1) == 3u * 128 + 4 * 8);
  refuses("render --compare " + given.table + " -o " + given.at("x.png"), {"--compare", "two tables"});
  refuses("render --compare " + given.table + " " + given.table + " -o " + given.at("x.exr"), {"--compare", ".png"});
  refuses("render --compare --size 63 " + given.table + " " + given.table + " -o " + given.at("x.png"),
          {"--compare", "--size", "64"});
  CHECK_FALSE(std::filesystem::exists(given.folder / "x.png"));
}

TEST_CASE("gonio render: --labels under each image, --caption under all") {
  const rendered_folder given;
  run("expand --formula red-paint -o " + given.at("red.binary"));
  const auto draw = [&](const std::string& arguments) {
    run("render --slices --size 200 " + arguments + " -o " + given.at("text.png"));
    return gonio::io::read_png(given.folder / "text.png");
  };
  // Returns the number of pixels in a region that are not black.
  const auto drawn = [](const gonio::image& image, std::size_t top, std::size_t left, std::size_t columns) {
    int count = 0;
    for (std::size_t row = top; row < std::min<std::size_t>(top + 14, image.shape(0)); ++row)
      for (std::size_t column = left; column < left + columns; ++column)
        count += (gonio::pixel(image, row, column) != 0.0).any();
    return count;
  };
  const std::string tables = given.table + " " + given.at("red.binary");
  const gonio::image plain = draw(tables), labelled = draw("--labels " + tables);
  REQUIRE(plain.shape(0) == 216u);
  REQUIRE(labelled.shape(0) == 230u);
  CHECK(drawn(labelled, 8 + 200, 8, 200) > 20);
  CHECK(drawn(labelled, 8 + 200, 216, 200) > 20);
  for (std::size_t row = 0; row < 200; row += 7)
    CHECK((gonio::pixel(labelled, 8 + row, 100) == gonio::pixel(plain, 8 + row, 100)).all());

  const gonio::image captioned = draw("--caption \"Two paints\" " + tables);
  REQUIRE(captioned.shape(0) == 230u);
  CHECK(drawn(captioned, 216, 8, 400) > 20);
  std::string words;
  for (int i = 0; i < 40; ++i) words += "word ";
  const gonio::image lines = draw("--caption \"" + words + "\" " + tables);
  CHECK(lines.shape(0) > 240u);
  CHECK(drawn(lines, lines.shape(0) - 14, 8, 200) > 20);
  CHECK(draw("--caption \"" + std::string(200, 'w') + "\" " + tables).shape(0) == 230u);
  refuses("render --labels " + tables + " -o " + given.at("x.exr"), {"--labels", ".png"});
}

#if defined(GONIO_HAS_EXR)
TEST_CASE("gonio render: an .exr image has the values themselves, and may be the environment") {
  const rendered_folder given;
  run("render --slices --size 64 " + given.table + " -o " + given.at("slice.exr"));
  const gonio::image slice = gonio::io::read_exr(given.at("slice.exr"));
  const gonio::brdf_table table = gonio::io::read_merl(given.table);
  const gonio::image expected = gonio::render::render_slice(table, {.rows = 64, .columns = 64});
  REQUIRE(slice.shape(0) == 80u);
  double worst = 0.0, brightest = 0.0;
  for (std::size_t row = 0; row < 64; ++row)
    for (std::size_t column = 0; column < 64; ++column) {
      const gonio::rgb value = gonio::pixel(slice, row + 8, column + 8);
      worst = std::max(worst, (value - gonio::pixel(expected, row, column)).abs().maxCoeff());
      brightest = std::max(brightest, value.maxCoeff());
    }
  CHECK(worst == 0.0);
  CHECK(brightest > 1.0);  // more than a PNG can hold
  const std::string sky = given.at("sky.exr");
  gonio::io::write_exr(sky, gonio::io::read_hdr(given.sky));
  const std::string rest = " --quality 2 --size 32 " + given.table + " -o " + given.at("s.exr");
  run("render --environment " + given.sky + rest);
  const std::string by_hdr = scratch::get(given.at("s.exr"));
  run("render --environment " + sky + rest);
  CHECK(scratch::get(given.at("s.exr")) == by_hdr);
}
#endif

TEST_CASE("a table as an array of numpy") {
  const rendered_folder given;
  REQUIRE(gonio_tool("expand --formula gold-metal -o " + given.at("gold.npy")).exit_code == 0);
  const auto array = gonio::io::read_npy<float, 4>(given.at("gold.npy"));
  const auto table = gonio::io::read_merl(given.table);
  CHECK(array.size() == 3u * 90 * 90 * 180);
  CHECK(array(3, 40, 90, 1) == table.at(table.cells().representative(table.cells().grid().linear({3, 40, 90})))[1]);
}

TEST_CASE("bad requests of images in an environment") {
  const rendered_folder given;
  const auto refuses = [&](const std::string& arguments, const std::string& word) {
    const auto result = gonio_tool("render " + given.table + " -o " + given.at("x.png") + " " + arguments);
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(result.output.find(word) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(given.at("x.png")));
  };
  refuses("--environment /no/such/sky.hdr", "/no/such/sky.hdr");
  refuses("--environment " + given.sky + " --quality 0", "--quality");
  refuses("--quality 4", "--environment");
  refuses("--environment " + given.sky + " --slices", "--slices");
  refuses("--exposure 0.5 --slices", "--slices");
  refuses("--exposure 0", "--exposure");
  refuses("--size 7", "--size");
  refuses("--columns 0", "--columns");
  refuses("--environment " + given.table, "gold.binary");
}
