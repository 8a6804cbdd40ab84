/// Analytic models fitted to samples and tables; written as numbers, images and renderers' materials.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <fstream>
#include <random>
#include <string>

namespace {

using json = nlohmann::json;

/// Writes samples of red paint, a sum of Lambert and GGX, times a brightness factor.
std::string write_samples(const scratch::folder& folder, std::size_t count, double factor = 1.0) {
  const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  gonio::sample_set samples;
  while (samples.size() < count) {
    const gonio::half_difference angles{uniform(random) * uniform(random), 1.4 * uniform(random),
                                        3.0 * uniform(random)};
    const auto [wi, wo] = gonio::to_directions(angles);
    if (wi.z() > 0.05 && wo.z() > 0.05) samples.push_back({angles, factor * paint(wi, wo), 1.0});
  }
  const std::string path = (folder / "samples.csv").string();
  gonio::io::write_samples(path, samples);
  return path;
}

json fitted(const std::string& arguments) {
  const auto result = gonio_tool("fit " + arguments + " --json");
  CAPTURE(result.output);
  REQUIRE(result.exit_code == 0);
  return read_json(result.output);
}

}  // namespace

TEST_CASE("a fit reflects at most what falls in, or what is asked for, and says how much that is") {
  const scratch::folder folder;
  const std::string bright = write_samples(folder, 60, 4.0);
  const auto albedo = [&](const std::string& options) {
    return fitted(bright + options)["energy"]["largest_albedo"].get<double>();
  };
  CHECK(albedo("") == doctest::Approx(1.0).epsilon(0.003));
  CHECK(albedo(" --largest-albedo 0.8") == doctest::Approx(0.8).epsilon(0.003));
  CHECK(albedo(" --largest-albedo 100") > 1.5);
  const auto told = gonio_tool("fit " + bright + " --largest-albedo 100");
  CHECK(told.output.find("of light at 88 degrees: more light than comes in") != std::string::npos);
  CHECK(gonio_tool("fit " + bright + " --largest-albedo 0").exit_code == 2);
}

TEST_CASE("samples of a model give its parameters back") {
  const scratch::folder folder;
  const std::string samples = write_samples(folder, 60);
  const json fit = fitted(samples + " --model ggx");
  CHECK(fit["measurements"] == 60);
  CHECK(fit["converged"] == true);
  REQUIRE(fit["lobes"].size() == 2);
  CHECK(fit["lobes"][0]["lobe"] == "lambert");
  CHECK(fit["lobes"][0]["colour"][0].get<double>() == doctest::Approx(0.42).epsilon(1e-4));
  CHECK(fit["lobes"][1]["parameters"]["alpha"].get<double>() == doctest::Approx(0.15).epsilon(1e-4));
  // Colour and f0 of the model are parts of its Fresnel factor, f0 + (1 - f0) (1 - cosine)^5.
  CHECK(fit["lobes"][1]["parameters"]["f0"].get<double>() == doctest::Approx(0.04).epsilon(1e-3));
  CHECK(fit["lobes"][1]["colour"][2].get<double>() == doctest::Approx(1.0).epsilon(1e-3));
  for (const char* other :
       {"--loss l1", "--loss l2 --metric lin --no-cosine-weight", "--metric cubic --cosine-weighted"}) {
    CAPTURE(other);
    CHECK(fitted(samples + " --model ggx " + other)["lobes"][1]["parameters"]["alpha"].get<double>() ==
          doctest::Approx(0.15).epsilon(1e-3));
  }
}

TEST_CASE("models are named, summed, and multiplied by Fresnel's factor") {
  const scratch::folder folder;
  const std::string samples = write_samples(folder, 60);
  CHECK(fitted(samples + " --model lambert")["lobes"].size() == 1);
  const json sum = fitted(samples + " --model sum:lambert+ward+ward --starts 2 --seed 5");
  REQUIRE(sum["lobes"].size() == 3);
  CHECK(sum["lobes"][1]["parameters"] != sum["lobes"][2]["parameters"]);
  CHECK(fitted(samples + " --model phong-blinn --fresnel")["lobes"][1]["lobe"] == "phong-blinn-fresnel");
}

TEST_CASE("a table, an image beside the measurement, and materials of renderers") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  REQUIRE(gonio_tool("expand --formula red-paint -o " + at("paint.binary")).exit_code == 0);
  const auto result = gonio_tool("fit " + at("paint.binary") + " --model ggx -o " + at("fit.binary") + " --image " +
                                 at("both.png") + " --pbrt " + at("paint.pbrt") + " --mitsuba " + at("paint.xml"));
  CAPTURE(result.output);
  REQUIRE(result.exit_code == 0);
  CHECK(result.output.find("ggx: colour 1.0000 1.0000 1.0000, alpha 0.1500 (slope), f0 0.0400") != std::string::npos);
  const auto compared =
      read_json(gonio_tool("compare " + at("fit.binary") + " " + at("paint.binary") + " --json").output);
  CHECK(compared["delta_e_env"].get<double>() < 0.01);
  CHECK(gonio::io::read_png(at("both.png")).shape(1) == 2 * 256 + 3 * 8);
  std::string pbrt, mitsuba;
  std::getline(std::ifstream(at("paint.pbrt")), pbrt);
  std::getline(std::ifstream(at("paint.xml")), mitsuba);
  CHECK(pbrt == "Material \"coateddiffuse\"");
  CHECK(mitsuba == "<bsdf type=\"blendbsdf\">");
}

TEST_CASE("what cannot be fitted is refused in one line, and nothing is written") {
  const scratch::folder folder;
  const std::string samples = write_samples(folder, 60);
  const auto refuses = [&](const std::string& arguments, const char* words) {
    const auto result = gonio_tool("fit " + arguments);
    CAPTURE(arguments);
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(std::ranges::count(result.output, '\n') == 1);
    CHECK(result.output.find(words) != std::string::npos);
  };
  refuses(samples + " --model plastic", "no lobe named 'plastic'");
  refuses(samples + " --model sum:lambert+", "no lobe named ''");
  refuses(samples + " --model ward --fresnel", "ward: --fresnel needs phong");
  refuses(samples + " --loss l3", "--loss");
  refuses(samples + " --cosine-weighted --no-cosine-weight", "--no-cosine-weight");
  refuses(samples + " --model phong --pbrt " + (folder / "x.pbrt").string(), "not phong");
  CHECK(!std::filesystem::exists(folder / "x.pbrt"));
  scratch::put((folder / "two.csv").string(), "theta_h,theta_d,phi_d,r,g,b\n1,2,3,.1,.1,.1\n4,5,6,.1,.1,.1\n");
  refuses((folder / "two.csv").string() + " --model ggx", "2 samples of three channels are too few for 8 parameters");
  scratch::put((folder / "dark.csv").string(), "theta_h,theta_d,phi_d,r,g,b\n1,2,3,0,0,0\n4,5,6,0,0,0\n7,5,6,0,0,0\n");
  refuses((folder / "dark.csv").string() + " --model ggx", "all measurements are zero");
  refuses((folder / "missing.csv").string(), "missing.csv");
}
