/// gonio info --components and gonio expand --weights: drawings of components, and materials of given weights.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "../synthetic_materials.hpp"
#include "tool.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/prior.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace {

const std::string shipped = std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior";

/// Returns three --weights options with the weights that `gonio info --weights-of` prints.
std::string weight_options(const nlohmann::json& weights) {
  std::string options;
  for (const char* channel : {"r", "g", "b"}) {
    options += " --weights ";
    for (const auto& weight : weights[channel]) options += weight.dump() + ',';
    options.pop_back();
  }
  return options;
}

/// Returns red minus blue of the pixel at relative position (x, y) of a slice. Slices have 64 pixels, margins 8.
double redness(const gonio::image& figure, std::size_t slice, double x, double y) {
  const auto pixel =
      gonio::pixel(figure, 8 + static_cast<std::size_t>(y * 63), 8 + 72 * slice + static_cast<std::size_t>(x * 63));
  return pixel.x() - pixel.z();
}

}  // namespace

TEST_CASE("the weights of a material given by hand give its table, byte for byte") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const auto facts = read_json(gonio_tool("info --json " + shipped + " --weights-of blue-rubber").output);
  REQUIRE(facts["weights"]["g"].size() == 100);
  run("expand --name blue-rubber -o " + at("named.binary"));
  run("expand" + weight_options(facts["weights"]) + " -o " + at("by_hand.binary"));
  CHECK(scratch::get(at("named.binary")) == scratch::get(at("by_hand.binary")));

  // Weights are added to those of a named material, so the difference leads from one material to the other.
  const auto other = read_json(gonio_tool("info --json " + shipped + " --weights-of red-plastic").output);
  nlohmann::json difference = facts["weights"];
  for (const char* channel : {"r", "g", "b"})
    for (std::size_t j = 0; j < 100; ++j)
      difference[channel][j] = facts["weights"][channel][j].get<double>() - other["weights"][channel][j].get<double>();
  run("expand --name red-plastic" + weight_options(difference) + " -o " + at("edited.binary"));
  CHECK(scratch::get(at("named.binary")) == scratch::get(at("edited.binary")));
}

TEST_CASE("one list is for all channels, and counts in deviations if it is asked to") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  run("expand --weights 0 -o " + at("mean.binary"));
  run("expand --weights 0,-2 --in-deviations -o " + at("bright.binary"));
  const double deviation =
      read_json(gonio_tool("info --json --count 2 --size 8 --components " + at("c.png") + ' ' + shipped)
                    .output)["deviations_of_weights"][1];
  run("expand --weights 0," + std::to_string(-2.0 * deviation) + " -o " + at("same.binary"));
  const auto mean = gonio::io::read_merl(at("mean.binary")), bright = gonio::io::read_merl(at("bright.binary")),
             same = gonio::io::read_merl(at("same.binary"));
  const auto [wi, wo] = gonio::to_directions({gonio::radians(50), gonio::radians(10), gonio::radians(90)});
  const gonio::rgb grey = mean(wi, wo);
  CHECK(grey.maxCoeff() == grey.minCoeff());
  CHECK(bright(wi, wo).y() > 3.0 * grey.y());  // the second component is the brightness off the highlight
  CHECK(bright(wi, wo).y() == doctest::Approx(same(wi, wo).y()).epsilon(1e-3));
}

TEST_CASE("the figure shows what the paper says of the components") {
  const scratch::folder folder;
  const std::string slices = (folder / "slices.png").string(), spheres = (folder / "spheres.png").string();
  const auto result = gonio_tool("info --json --count 3 --size 64 --components " + slices + " --component-spheres " +
                                 spheres + ' ' + shipped);
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto facts = read_json(result.output);
  CHECK(facts["pure_red_stands_for"].size() == 3);
  CHECK(facts["shares_of_variance"][0].get<double>() > facts["shares_of_variance"][1].get<double>());
  const gonio::image figure = gonio::io::read_png(slices);
  CHECK(figure.shape(0) > 64 + 16 + 2 * 14);  // a label, and a caption of a line or more
  CHECK(figure.shape(1) == 4 * 64 + 5 * 8);
  CHECK(std::abs(redness(figure, 0, 0.5, 0.5)) < 0.02);  // the reference is grey
  // The first component contrasts the specular peak, at theta_h near 0, with the rest; the second is the brightness off
  // the peak.
  CHECK(redness(figure, 1, 0.0, 0.7) > 0.6);
  CHECK(redness(figure, 1, 0.5, 0.7) < 0.0);
  CHECK(std::abs(redness(figure, 2, 0.5, 0.7)) > 0.3);
  CHECK(redness(figure, 2, 0.5, 0.7) * redness(figure, 2, 0.2, 0.3) > 0.0);
  CHECK(std::abs(redness(figure, 2, 0.5, 0.7)) > 3.0 * std::abs(redness(figure, 2, 0.5, 0.0)));  // except at grazing
  // The third narrows or widens the peak: the peak and the ring around it have opposite signs.
  CHECK(redness(figure, 3, 0.0, 0.7) * redness(figure, 3, 0.3, 0.7) < 0.0);

  const gonio::image tiles = gonio::io::read_png(spheres);
  CHECK(tiles.shape(0) > 5 * 64);
  CHECK(tiles.shape(1) > 3 * 64);
  const auto brightness = [&](std::size_t row) {
    return gonio::luminance(gonio::pixel(tiles, 8 + 86 * row + 40, 8 + 24));
  };
  for (std::size_t row = 1; row < 5; ++row) CHECK(brightness(row) < brightness(row - 1));
}

TEST_CASE("bad weights, and what is no prior") {
  const scratch::folder folder;
  const std::string table = (folder / "out.binary").string(), image = (folder / "out.png").string();
  const std::string small = (folder / "small.prior").string();
  gonio::io::write_prior(small, learn(synthetic_materials(small_cells(), 5), 10));
  const std::string expand = "expand --prior " + small + " -o " + table + ' ';
  refuses(expand + "--weights 0.5,nan", {"--weights: number 2", "'nan'", "not finite"});
  refuses(expand + "--weights 0.5,,1", {"--weights: number 2", "not a number"});
  refuses(expand + "--weights ''", {"--weights"});
  refuses(expand + "--weights 1 --weights 2", {"one list for all channels, or three", "not 2"});
  refuses("expand --weights 1e6 -o " + table, {"--weights are too large"});
  refuses(expand + "--weights 0,0,0,0,0,0,0,0,0,0,0", {"11 numbers", "10 components of ", "small.prior"});
  refuses(expand + "--in-deviations --name material-1", {"--in-deviations", "--weights"});
  refuses(expand + "--weights 1 --formula red-paint", {"--formula", "--weights"});
  refuses("info " + small + " --weights-of no-such-stone", {"small.prior", "no-such-stone"});
  refuses("info " + small + " --count 11 --components " + image, {"--count 11", "10 components"});
  refuses("info " + small + " --count 3", {"--count and --size need --components"});
  refuses("info " + small + " --count 0 --components " + image, {"--count"});
  const std::string samples = (folder / "samples.csv").string();
  scratch::put(samples, "theta_h,theta_d,phi_d,r,g,b\n1,2,3,0.1,0.1,0.1\n");
  refuses("info " + samples + " --components " + image, {"samples.csv", "not a gonio prior"});
  CHECK(folder.entries() == 2);
}
