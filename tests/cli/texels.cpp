/// gonio texels: images, arrays and materials from a map.

#include "svbrdf_images.hpp"
#include "tool.hpp"
#include <gonio/core/half.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/table/image.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>

namespace {

/// Columns below 75 have one material, columns from 250 on another, and those between a third. Rows from 60 on are
/// outside the sample.
struct sample_of_three : images_folder {
  explicit sample_of_three(float last = 0.05f) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      std::mt19937 generator(static_cast<unsigned>(i));
      std::normal_distribution<float> noise(1.0f, 0.02f);
      auto image = images[i];
      for (std::size_t row = 0; row < 70; ++row)
        for (std::size_t column = 0; column < 375; ++column)
          for (std::size_t c = 0; c < 3; ++c)
            image(row, column, c) = row >= 60 ? std::nanf("")
                                              : noise(generator) * (of(column) == 1   ? 0.2f
                                                                    : of(column) == 2 ? last
                                                                                      : 0.4f);
      replace(i, image);
    }
    const std::string list = scratch::get(folder / "images.json");
    scratch::put(folder / "images.json", "{\"invalid\": \"skip\"," + list.substr(1));
  }

  /// Returns the number of a column's material, ordered by area.
  static int of(std::size_t column) { return column < 75 ? 3 : column < 250 ? 1 : 2; }
  [[nodiscard]] std::string file(const std::string& name) const { return (folder / name).string(); }
  [[nodiscard]] std::string texels(const std::string& arguments) const {
    return "texels " + file("map.gsv") + " --prior " + file("small.prior") + " " + arguments;
  }
};

/// Returns the bytes of an array of labels.
std::string labels_in(const std::string& file) {
  const std::string all = scratch::get(file);
  CHECK(all.find("'|u1'") != std::string::npos);
  return all.substr(all.size() - 70 * 375);
}

}  // namespace

TEST_CASE("texels: clusters are the materials, the largest first, and texels beside the sample are of none") {
  const sample_of_three given;
  run(given.command("map.gsv"));
  const std::string printed =
      run(given.texels("--clusters 3 --threads 1 --labels " + given.file("l.npy") + " --materials " +
                       given.file("m.npy") + " --tables " + given.file("tables")));
  CHECK(printed.find("cluster 1: 46.7 %") != std::string::npos);
  CHECK(printed.find("cluster 3: 20.0 %") != std::string::npos);
  const std::string labels = labels_in(given.file("l.npy"));
  int wrong = 0;
  for (std::size_t i = 0; i < labels.size(); ++i)
    wrong += labels[i] != (i / 375 >= 60 ? 0 : sample_of_three::of(i % 375)) ? 1 : 0;
  CHECK(wrong == 0);
  // Labels as an image, with another number of threads.
  run(given.texels("--clusters 3 --threads 3 --labels " + given.file("l.png")));
  const gonio::image drawn = gonio::io::read_png(given.file("l.png"));
  REQUIRE(drawn.shape(0) == 70);
  for (const std::size_t column : {7, 200, 350})
    CHECK((gonio::pixel(drawn, 5, column) - gonio::render::category_colour(sample_of_three::of(column) - 1))
              .abs()
              .maxCoeff() < 0.01);
  CHECK((gonio::pixel(drawn, 65, 7) == 0.0).all());
  run(given.texels("--clusters 3 --threads 3 --labels " + given.file("again.npy")));
  CHECK(scratch::get(given.file("again.npy")) == scratch::get(given.file("l.npy")));
  // The mean weights, and the tables that they represent.
  const auto means = gonio::io::read_npy<float, 3>(given.file("m.npy"));
  REQUIRE(means.shape(0) == 3);
  REQUIRE(means.shape(2) == 6);
  const gonio::io::svbrdf_map map(given.folder / "map.gsv");
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(6, 3);
  for (const Eigen::Index number : {0, 1})
    for (Eigen::Index row = 0; row < (number == 0 ? 43 : 17); ++row)
      for (Eigen::Index column = 0; column < 75; ++column)
        sum += gonio::io::weights_of_texel(map.header(), map.read_band(number), row * 375 + column) / 4500.0;
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index k = 0; k < 6; ++k)
      CHECK(double{means(2, c, k)} == doctest::Approx(sum(k, c)).epsilon(1e-3).scale(0.01));
  const auto table = gonio::io::read_merl(given.folder / "tables" / "material-3.binary");
  const auto expected = gonio::fitted_brdf(given.prior, sum).tabulate(table.cells());
  for (const Eigen::Index cell : {1000, 200'000, 900'000})
    CHECK(table.at(cell)[1] == doctest::Approx(expected.at(cell)[1]).epsilon(0.01));
}

TEST_CASE("texels: uncertainty and disagreement as images with a scale, and as arrays") {
  const sample_of_three given;
  run(given.command("map.gsv"));
  run("texels " + given.file("map.gsv") + " --uncertainty " + given.file("u.png") + " --disagreement " +
      given.file("d.npy"));
  const gonio::io::svbrdf_map map(given.folder / "map.gsv");
  const auto band = map.read_band(1);
  const gonio::image drawn = gonio::io::read_png(given.file("u.png"));
  REQUIRE(drawn.shape(1) == 375);
  REQUIRE(drawn.shape(0) > 70);  // a scale below
  const gonio::rgb expected = gonio::render::sequential_colour(
      gonio::render::logarithmic_position(gonio::from_half(band.uncertainty[2 * 375 + 9]), 0.1, 5.0));
  CHECK((gonio::pixel(drawn, 45, 9) - expected).abs().maxCoeff() < 0.01);
  CHECK((gonio::pixel(drawn, 62, 9) == 0.0).all());
  const auto disagreement = gonio::io::read_npy<float, 2>(given.file("d.npy"));
  CHECK(disagreement(45, 9) == gonio::from_half(band.disagreement[2 * 375 + 9]));
  CHECK(disagreement(62, 9) == 0.0f);
}

TEST_CASE("texels: Delta E of two maps") {
  const sample_of_three given;
  run(given.command("map.gsv"));
  {
    const sample_of_three other(0.06f);
    run(other.command("other.gsv"));
    scratch::put(given.folder / "other.gsv", scratch::get(other.folder / "other.gsv"));
  }
  const std::string compare = "--compare " + given.file("other.gsv") + " --light 20,10 --exposure 1 --delta-e ";
  CHECK(run(given.texels(compare + given.file("e.npy"))).find("Delta E of the maps") != std::string::npos);
  const auto found = gonio::io::read_npy<float, 2>(given.file("e.npy"));
  CHECK(found(5, 7) == 0.0f);
  CHECK(found(5, 350) > 1.0f);
  CHECK(found(65, 350) == 0.0f);
  run(given.texels(compare + given.file("e.png")));
  const gonio::image drawn = gonio::io::read_png(given.file("e.png"));
  const gonio::rgb expected = gonio::render::sequential_colour(0.1 * double{found(5, 350)});
  CHECK((gonio::pixel(drawn, 5, 350) - expected).abs().maxCoeff() < 0.01);
  // Compares with the images drawn by gonio render.
  const auto render = [&](const std::string& map, const std::string& image) {
    run("render " + given.file(map) + " --prior " + given.file("small.prior") + " --light 20,10 --exposure 1 -o " +
        given.file(image));
    return gonio::io::read_png(given.file(image));
  };
  const double seen = gonio::delta_e(gonio::pixel(render("map.gsv", "a.png"), 5, 350),
                                     gonio::pixel(render("other.gsv", "b.png"), 5, 350));
  CHECK(double{found(5, 350)} == doctest::Approx(seen).epsilon(0.1).scale(1));
}

TEST_CASE("texels: what cannot be done is refused") {
  const sample_of_three given;
  run(given.command("map.gsv"));
  refuses(given.texels(""), {"--uncertainty", "--clusters", "--compare"});
  refuses(given.texels("--clusters 9 --labels " + given.file("l.png")), {"--labels", "8 clusters", ".npy"});
  refuses(given.texels("--labels " + given.file("l.png")), {"--labels", "--clusters"});
  refuses("texels " + given.file("map.gsv") + " --clusters 3", {"map.gsv", "another prior"});
  refuses("texels " + given.file("small.prior") + " --uncertainty " + given.file("u.png"), {"small.prior"});
  gonio::io::write_npy(given.folder / "small.npy", xt::xtensor<float, 3>(std::array<std::size_t, 3>{2, 2, 3}, 0.1f));
  scratch::put(given.folder / "small.json",
               "{\"quantity\": \"brdf\", \"images\": [" + given.entry("small.npy", 0) + "]}");
  run(given.command("small.gsv", "small.json"));
  refuses(given.texels("--compare " + given.file("small.gsv") + " --delta-e " + given.file("e.png")),
          {"small.gsv: has 2 x 2 texels", "375 x 70"});
  const std::string small = "texels " + given.file("small.gsv") + " --prior " + given.file("small.prior");
  refuses(small + " --clusters 5", {"--clusters 5", "4 points differ"});
  run(small + " --uncertainty " + given.file("u.png"));  // the image is too small for a scale
  CHECK(gonio::io::read_png(given.file("u.png")).shape(0) == 2);
}
