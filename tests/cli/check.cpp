/// gonio check: a part and a reference, exit codes 0, 1 and 2.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

namespace {

/// Some directions, each measured so often, of red paint times a factor.
struct checked_files {
  scratch::folder folder;

  std::string write(const std::string& name, unsigned seed, const gonio::rgb& factor, int repeats = 1,
                    double turned = 0.0, double noise = 0.02, int wrong = -1) const {
    const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    gonio::sample_set samples;
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (int i = 0; i < 6; ++i) {
        const gonio::half_difference angles{0.1 + 0.11 * i + turned, 0.9 - 0.12 * i, 0.5 * i + turned};
        const auto [wi, wo] = gonio::to_directions(angles);
        gonio::rgb value = factor * paint(wi, wo) * (i == wrong ? 1.5 : 1.0);
        for (Eigen::Index c = 0; c < 3; ++c) value[c] *= 1.0 + noise * normal(random);
        samples.push_back({angles, value, 1.0});
      }
    const std::string path = (folder / name).string();
    gonio::io::write_samples(path, samples);
    return path;
  }
};

/// What is checked ends with this exit code, and with these words.
void check_says(const std::string& arguments, int exit_code, std::initializer_list<std::string> words) {
  const auto result = gonio_tool("check " + arguments);
  CAPTURE(result.output);
  CHECK(result.exit_code == exit_code);
  for (const std::string& word : words) {
    CAPTURE(word);
    CHECK(result.output.find(word) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("gonio check: alike, shifted, and wrong in one direction") {
  const checked_files files;
  const std::string good = files.write("good.csv", 1, gonio::rgb::Ones()) + " --noise 0.02";
  check_says(files.write("same.csv", 2, gonio::rgb::Ones()) + " --reference " + good, 0,
             {"no difference found", "false alarms 1 %", "in all directions: red", "known materials explain the part"});
  check_says(files.write("red.csv", 3, {1.15, 1.0, 1.0}) + " --reference " + good, 1, {"differs (p = ", "red +1"});
  const std::string spot = files.write("spot.csv", 4, gonio::rgb::Ones(), 1, 0.0, 0.02, 3);
  check_says(spot + " --reference " + good, 1, {"differs most at sample 4 (theta_i ", "the reference says "});
  check_says(spot + " --reference " + good + " --tolerance 0.7", 0, {"no difference found", "tolerance 70 %"});

  const auto result = gonio_tool("check " + spot + " --json --reference " + good);
  REQUIRE(result.exit_code == 1);
  const auto told = read_json(result.output);
  CHECK(told["conforms"] == false);
  CHECK(told["worst_sample"] == 4);
  CHECK(told["predicted"] == 0);
  CHECK(told["noise_degrees_of_freedom"].is_null());
  REQUIRE(told["directions"].size() == 6);
  CHECK(told["directions"][3]["adjusted_p_value"].get<double>() < 1e-6);
  CHECK(told["directions"][3]["reference_samples"] == 1);
  CHECK(told["p_value"].get<double>() <= 3.0 * told["worst_p_value"].get<double>());
}

TEST_CASE("gonio check: repeats tell the noise, and other directions are predicted") {
  const checked_files files;
  const std::string good = files.write("good.csv", 1, gonio::rgb::Ones(), 3);
  check_says(files.write("same.csv", 2, gonio::rgb::Ones()) + " --reference " + good, 0,
             {"no difference found", "estimated from repeats with 36 degrees of freedom"});
  check_says(files.write("red.csv", 3, {1.2, 1.0, 1.0}, 3) + " --reference " + good, 1, {"differs"});
  const std::string turned = files.write("turned.csv", 4, gonio::rgb::Ones(), 1, 0.02);
  check_says(turned + " --noise 0.02 --reference " + good, 0,
             {"6 of 6 directions are not in the reference, which predicts them", "the reference predicts "});
  const std::string nudged = files.write("nudged.csv", 5, gonio::rgb::Ones(), 1, 0.0005);
  check_says(nudged + " --noise 0.02 --reference " + good, 0, {"the reference predicts "});
  check_says(nudged + " --noise 0.02 --same-within 0.1 --reference " + good, 0, {"the reference says "});
}

TEST_CASE("gonio check: what is wrong is exit code 2, and a sentence") {
  const checked_files files;
  const std::string good = files.write("good.csv", 1, gonio::rgb::Ones());
  const std::string same = files.write("same.csv", 2, gonio::rgb::Ones());
  check_says(same + " --reference " + good, 2, {"check needs --noise", "measured more than once"});
  check_says(same + " --reference-noise 0.02 --reference " + good, 2, {"--reference-noise needs --noise"});
  check_says(same + " --noise 0 --reference " + good, 2, {"--noise"});
  check_says(same + " --noise 0.02 --tolerance -1 --reference " + good, 2, {"--tolerance"});
  check_says(same + " --noise 0.02 --reference absent.csv", 2, {"absent.csv"});
  check_says(same + " --noise 0.02", 2, {"--reference"});
  scratch::put(files.folder / "bad.csv", std::string("theta_h,theta_d,phi_d,r,g,b\n9,12,69,nan,.3,.3\n"));
  check_says((files.folder / "bad.csv").string() + " --noise 0.02 --reference " + good, 2, {"line 2", "not finite"});
  scratch::put(files.folder / "dark.csv", std::string("theta_h,theta_d,phi_d,r,g,b\n9,12,69,-0.001,.3,.3\n"));
  const std::string dark = (files.folder / "dark.csv").string();
  check_says(dark + " --noise 0.02 --reference " + dark, 0,
             {"2 values are negative and count as zero", "--dark-noise"});
}
