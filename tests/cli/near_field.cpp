/// Simulated images of a flat sample are converted to samples, and these to a table.

#include "../io/scratch.hpp"
#include "lab/near_field_lab.hpp"
#include "lab/white_material.hpp"
#include "tool.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/near_field_setup.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace {

const std::string camera =
    "size 48 40\nfocal_length 95 100\nprincipal_point 25 20\nposition 0.7 0.1 0.6\ntarget 0 0 0\n";
const std::string first = camera + "light_angles 50 190\nirradiance 3\nregion 0.2\n";
const std::string second = camera + "light -0.5 1 0.8\nirradiance 3\nregion 0.2\nblock 2\n";

/// Two images of red paint and their set-ups in a folder.
class two_shots {
 public:
  two_shots() {
    for (const auto& [name, text] : {std::pair{"first", first}, std::pair{"second", second}}) {
      scratch::put(at(name) + ".txt", text);
      const auto setup = gonio::io::read_near_field_setup(text, name);
      gonio::io::write_hdr(at(name) + ".hdr", lab::photograph(paint, {.radius = 0.5}, setup));
    }
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string shot(const std::string& name) const { return at(name) + ".hdr " + at(name) + ".txt "; }
  [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");

 private:
  scratch::folder folder_;
};

}  // namespace

TEST_CASE("images become samples of the paint, and these a table") {
  const two_shots shots;
  const auto one = gonio_tool("near-field " + shots.shot("first") + "-o " + shots.at("one.csv"));
  REQUIRE_MESSAGE(one.exit_code == 0, one.output);
  const auto samples = gonio::io::read_samples(shots.at("one.csv"));
  CHECK(samples.size() > 300);
  CHECK(one.output == shots.at("first.hdr") + ": " + std::to_string(samples.size()) + " samples\n");
  for (const gonio::sample& s : samples) {
    const auto [wi, wo] = s.directions.pair();
    const gonio::rgb truth = shots.paint(wi, wo);
    // The format shares one exponent among three 8-bit channels.
    REQUIRE((s.value - truth).abs().maxCoeff() <= truth.maxCoeff() / 256.0);
  }

  const auto both =
      gonio_tool("near-field " + shots.shot("first") + shots.shot("second") + "-o " + shots.at("two.csv"));
  REQUIRE_MESSAGE(both.exit_code == 0, both.output);
  const auto more = gonio::io::read_samples(shots.at("two.csv"));
  CHECK(more.size() > samples.size() + 150);
  CHECK(more.size() < samples.size() + 300);
  CHECK(std::ranges::any_of(more, [](const gonio::sample& s) { return s.weight.mean() < 1.0; }));

  const auto table = gonio_tool("reconstruct " + shots.at("two.csv") + " -o " + shots.at("paint.binary"));
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(shots.has("paint.binary"));
}

TEST_CASE("light and camera that are off are found, and samples are where they were") {
  const two_shots shots;
  for (const auto& [name, text, seed] : {std::tuple{"first", first, 1u}, std::tuple{"second", second, 2u}}) {
    const auto setup = gonio::io::read_near_field_setup(text, name);
    gonio::io::write_hdr(shots.at(name) + ".hdr", lab::photograph(shots.paint, {.radius = 0.5}, setup,
                                                                  {.misalignment = gonio::radians(1.0)}, seed));
  }
  const std::string images = shots.shot("first") + shots.shot("second");
  const auto plain = gonio_tool("near-field " + images + "-o " + shots.at("plain.csv"));
  REQUIRE_MESSAGE(plain.exit_code == 0, plain.output);
  const auto found = gonio_tool("near-field " + images + "--misplaced 1 -o " + shots.at("found.csv"));
  REQUIRE_MESSAGE(found.exit_code == 0, found.output);
  CHECK(found.output.find("light corrected by ") != std::string::npos);
  CHECK(found.output.find("second.hdr: light corrected by ") != std::string::npos);

  // Returns the residual of the samples against the paint, whose logarithm is steep in these directions.
  const auto misfit = [&](const char* file) {
    double sum = 0.0;
    const auto samples = gonio::io::read_samples(shots.at(file));
    for (const gonio::sample& s : samples) {
      const auto [wi, wo] = s.directions.pair();
      sum += (s.value / shots.paint(wi, wo)).log().square().mean();
    }
    return sum / static_cast<double>(samples.size());
  };
  CHECK(gonio::io::read_samples(shots.at("found.csv")).size() == gonio::io::read_samples(shots.at("plain.csv")).size());
  CHECK(misfit("found.csv") < misfit("plain.csv"));

  // With a reference in place, a wrong light direction leaves the values unchanged. Otherwise they scale by the cosine.
  const auto by_reference =
      gonio_tool("near-field " + images + "--misplaced 1 --reference-in-place -o " + shots.at("reference.csv"));
  REQUIRE_MESSAGE(by_reference.exit_code == 0, by_reference.output);
  const auto same_values = [&](const char* file) {
    return std::ranges::equal(
        gonio::io::read_samples(shots.at(file)), gonio::io::read_samples(shots.at("plain.csv")),
        [](const gonio::sample& a, const gonio::sample& b) { return (a.value == b.value).all(); });
  };
  CHECK(same_values("reference.csv"));
  CHECK_FALSE(same_values("found.csv"));
  const auto useless = gonio_tool("near-field " + images + "--reference-in-place -o " + shots.at("no.csv"));
  CHECK(useless.exit_code == 2);
  CHECK(useless.output.find("--reference-in-place needs --misplaced") != std::string::npos);

  const auto refused = gonio_tool("near-field " + images + "--misplaced -1 -o " + shots.at("no.csv"));
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("the deviation of light and camera must be from 0 to 45 degrees, not -1") !=
        std::string::npos);
  CHECK_FALSE(shots.has("no.csv"));
}

TEST_CASE("samples that may be off their directions count less where that matters") {
  const two_shots shots;
  const auto run = [&](const std::string& arguments) {
    return gonio_tool("reconstruct " + shots.at("s.csv") + arguments);
  };
  REQUIRE(gonio_tool("near-field " + shots.shot("first") + "-o " + shots.at("s.csv")).exit_code == 0);
  const auto trusting = run(" --json"), expecting = run(" --misplaced 1 --json");
  REQUIRE_MESSAGE(expecting.exit_code == 0, expecting.output);
  CHECK(expecting.output != trusting.output);
  // The uncertainty is printed as it is without the angle, but larger.
  const auto known_to = [](const std::string& output) {
    const std::string key = "\"known_to\": ";
    return std::stod(output.substr(output.find(key) + key.size()));
  };
  CHECK(known_to(expecting.output) > known_to(trusting.output));
  const auto everything = run(" --misplaced 1 --residuals " + shots.at("r.csv") + " --uncertainty " +
                              shots.at("u.binary") + " --report " + shots.at("r.html") + " -o " + shots.at("o.binary"));
  CHECK_MESSAGE(everything.exit_code == 0, everything.output);
  for (const char* written : {"r.csv", "u.binary", "r.html", "o.binary"}) CHECK(shots.has(written));
  for (const auto& [arguments, words] :
       {std::pair{" --misplaced 1 --eta gcv", "--noise or a number for --eta"},
        std::pair{" --misplaced 1 --solver lasso", "--solver tikhonov"},
        std::pair{" --misplaced -2", "0 to 45 degrees, not -2"},
        std::pair{" --misplaced 1 --method linear", "--misplaced needs --method pca"}}) {
    CAPTURE(arguments);
    const auto refused = run(arguments);
    CHECK(refused.exit_code == 2);
    CHECK(refused.output.find(words) != std::string::npos);
  }
}

TEST_CASE("two materials in one image get a file each, and a map of where they are") {
  const two_shots shots;
  const gonio::model::formula_brdf other = gonio::model::formula_material("blue-rubber");
  for (const auto& [name, text] : {std::pair{"first", first}, std::pair{"second", second}}) {
    const auto setup = gonio::io::read_near_field_setup(text, name);
    gonio::image image = gonio::io::read_hdr(shots.at(name) + ".hdr");
    const gonio::image patch = lab::photograph(other, {.radius = 0.5}, setup);
    for (std::size_t row = 0; row < 40; ++row)
      for (std::size_t column = 0; column < 18; ++column)
        gonio::set_pixel(image, row, column, gonio::pixel(patch, row, column));
    gonio::io::write_hdr(shots.at(name) + ".hdr", image);
  }
  const auto result = gonio_tool("near-field " + shots.shot("first") + shots.shot("second") +
                                 "--clusters auto --labels " + shots.at("map.png") + " -o " + shots.at("m.csv"));
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  CHECK_FALSE(shots.has("m-3.csv"));
  CHECK(shots.has("map.png"));
  const auto agrees = [&](const std::string& file, const gonio::model::formula_brdf& material) {
    const auto samples = gonio::io::read_samples(shots.at(file));
    CHECK(samples.size() > 50);
    return std::ranges::all_of(samples, [&](const gonio::sample& s) {
      if (s.weight != 1.0) return true;  // a block at the border
      const auto [wi, wo] = s.directions.pair();
      const gonio::rgb truth = material(wi, wo);
      return (s.value - truth).abs().maxCoeff() <= 0.05 * truth.maxCoeff();
    });
  };
  CHECK(agrees("m-1.csv", shots.paint));
  CHECK(agrees("m-2.csv", other));
  CHECK_FALSE(agrees("m-2.csv", shots.paint));
}

TEST_CASE("two materials in one image were under one light: one pose for both") {
  // Blue rubber alone does not determine the light's position. Red paint next to it has a highlight, which does.
  const two_shots shots;
  const gonio::model::formula_brdf other = gonio::model::formula_material("blue-rubber");
  for (const auto& [name, text, seed] : {std::tuple{"first", first, 1u}, std::tuple{"second", second, 2u}}) {
    const auto setup = gonio::io::read_near_field_setup(text, name);
    const lab::near_field_defects defects{.misalignment = gonio::radians(1.0)};
    gonio::image image = lab::photograph(shots.paint, {.radius = 0.5}, setup, defects, seed);
    const gonio::image patch = lab::photograph(other, {.radius = 0.5}, setup, defects, seed);
    for (std::size_t row = 0; row < 40; ++row)
      for (std::size_t column = 0; column < 18; ++column)
        gonio::set_pixel(image, row, column, gonio::pixel(patch, row, column));
    gonio::io::write_hdr(shots.at(name) + ".hdr", image);
  }
  const auto result = gonio_tool("near-field " + shots.shot("first") + shots.shot("second") +
                                 "--clusters 2 --misplaced 1 -o " + shots.at("m.csv"));
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto occurrences = [&](const std::string& words) {
    std::size_t count = 0;
    for (std::size_t at = result.output.find(words); at != std::string::npos; at = result.output.find(words, at + 1))
      ++count;
    return count;
  };
  CAPTURE(result.output);
  CHECK(occurrences("first.hdr: light corrected by ") == 1);
  CHECK(occurrences("second.hdr: light corrected by ") == 1);
  CHECK(occurrences("m-1.csv, ") == 1);
  CHECK(occurrences("m-2.csv, ") == 1);
  CHECK(occurrences(" samples\n") == 4);
}

TEST_CASE("a white image and a calibration make samples of images by an uneven lamp and a distorting lens") {
  const two_shots shots;
  const std::string pose = "position 0.7 0.1 0.6\ntarget 0 0 0\n", lens = "distortion -0.2 0.05 0.001 0.002\n";
  const std::string scene = "lamp 1 1 3\nintensity 30 20 10\nregion 0.2\nwhite_reflectance 0.9\n";
  const auto setup =
      gonio::io::read_near_field_setup("size 48 40\nfocal_length 95 100\n" + lens + pose + scene, "lamp");
  scratch::put(shots.at("lamp.txt"), pose + "lamp 1 1 3\nregion 0.2\nwhite_reflectance 0.9\n");
  scratch::put(shots.at("camera.yml"),
               "%YAML:1.0\n---\nimage_width: 48\nimage_height: 40\ncamera_matrix: !!opencv-matrix\n   rows: 3\n"
               "   cols: 3\n   dt: d\n   data: [ 95., 0., 23.5, 0., 100., 19.5, 0., 0., 1. ]\n"
               "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n"
               "   data: [ -0.2, 0.05, 0.001, 0.002 ]\n");
  gonio::io::write_npy(shots.at("lamp.npy"), lab::photograph(shots.paint, {.radius = 0.5}, setup));
  gonio::io::write_npy(shots.at("white.npy"), lab::photograph(lab::white_material{0.9}, {.radius = 0.5}, setup));
  const std::string given = "near-field " + shots.at("lamp.npy") + " " + shots.at("lamp.txt") + " -o " +
                            shots.at("lamp.csv") + " --calibration " + shots.at("camera.yml");
  const auto run = gonio_tool(given + " --white " + shots.at("white.npy"));
  REQUIRE_MESSAGE(run.exit_code == 0, run.output);
  const auto samples = gonio::io::read_samples(shots.at("lamp.csv"));
  CHECK(samples.size() > 300);
  for (const gonio::sample& s : samples) {
    const auto [wi, wo] = s.directions.pair();
    REQUIRE((s.value / shots.paint(wi, wo) - 1.0).abs().maxCoeff() < 1e-4);
  }
  const auto bare = gonio_tool(given);
  CHECK(bare.exit_code == 2);
  CHECK(bare.output.find("'white_reflectance' needs --white") != std::string::npos);
  const auto twice = gonio_tool(given + " --white " + shots.at("white.npy") + " " + shots.at("white.npy"));
  CHECK(twice.exit_code == 2);
  CHECK(twice.output.find("--white needs an image for each photograph: 1, not 2") != std::string::npos);
}

TEST_CASE("bad images and set-ups get exit code 2, one line, and no file") {
  const two_shots shots;
  const auto refused = [&](const std::string& arguments, std::initializer_list<std::string> words) {
    const auto result = gonio_tool("near-field " + arguments + " -o " + shots.at("out.csv"));
    CAPTURE(arguments);
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(std::ranges::count(result.output, '\n') == 1);
    for (const std::string& word : words) CHECK(result.output.find(word) != std::string::npos);
    CHECK_FALSE(shots.has("out.csv"));
  };
  const auto with_setup = [&](const std::string& text) {
    scratch::put(shots.at("bad.txt"), text);
    return shots.at("first.hdr") + " " + shots.at("bad.txt");
  };
  refused("", {"images"});
  refused(shots.at("first.hdr"), {"images"});
  refused(shots.shot("first") + shots.at("second.hdr"), {"second.hdr needs its set-up"});
  refused(shots.at("first.hdr") + " /no/such.txt", {"/no/such.txt"});
  refused("/no/such.hdr " + shots.at("first.txt"), {"/no/such.hdr"});
  refused(shots.at("first.txt") + " " + shots.at("first.txt"),
          {"first.txt", "not an image of linear radiance", ".hdr, .npy or .exr"});
  refused(with_setup(first + "lamps 3\n"), {"bad.txt, line 9", "lamps"});
  refused(with_setup(camera + "light 0 0 1\n"), {"bad.txt", "'region' or 'window' is missing"});
  refused(with_setup("size 40 48" + first.substr(10)), {"first.hdr", "bad.txt", "48 x 40", "40 x 48"});
  refused(with_setup(first + "saturation 1e-6\n"), {"first.hdr", "saturated"});
  refused(shots.shot("first") + "--labels x.png", {"--labels", "--clusters"});
  refused(shots.shot("first") + "--clusters many", {"--clusters", "many"});
  refused(shots.shot("first") + "--clusters 0", {"--clusters", "0"});
  scratch::put(shots.at("moved.txt"),
               "size 48 40\nfocal_length 95 100\nposition 0.7 0 0.6\ntarget 0 0 0\nlight 0 0 1\nregion 0.2\n");
  refused(shots.shot("first") + shots.at("second.hdr") + " " + shots.at("moved.txt") + " --clusters 2",
          {"moved.txt", "a fixed camera"});
  refused(with_setup(camera + "light 0 0 1\nregion 0.01 5 5\n"), {"first.hdr", "does not show the sample"});
}
