/// gonio check: a part and a reference; exit codes 0, 1 and 2.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace {

/// Files with some directions, each measured several times, of red paint times a factor.
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

/// Checks the exit code and the words in the output.
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
             {"GO: no difference found", "false alarms 1 %", "all directions together: red", "worst: theta_i"});
  check_says(files.write("red.csv", 3, {1.15, 1.0, 1.0}) + " --reference " + good, 1,
             {"NO-GO: the part differs (p ", "red +1"});
  const std::string spot = files.write("spot.csv", 4, gonio::rgb::Ones(), 1, 0.0, 0.02, 3);
  check_says(spot + " --reference " + good, 1, {"worst: theta_i ", " (line 5): ", " instead of "});
  check_says(spot + " --reference " + good + " --tolerance 0.7", 0, {"GO: no difference found", "tolerance 70 %"});
  check_says(spot + " --verbose --reference " + good, 1, {"known materials explain the part"});

  const auto result = gonio_tool("check " + spot + " --json --reference " + good);
  REQUIRE(result.exit_code == 1);
  const auto told = read_json(result.output);
  CHECK(told["conforms"] == false);
  CHECK(told["worst_sample"] == 4);
  CHECK(told["verdict"] == "NO-GO");
  CHECK(told["directions"][3]["line"] == 5);
  CHECK(told["directions"][3]["delta_e"].get<double>() > 1.0);
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
             {"no difference found", "measured more than once", "exchanged (36 degrees of freedom)"});
  check_says(files.write("red.csv", 3, {1.2, 1.0, 1.0}, 3) + " --reference " + good, 1, {"NO-GO"});
  const std::string turned = files.write("turned.csv", 4, gonio::rgb::Ones(), 1, 0.02);
  check_says(
      turned + " --noise 0.02 --reference " + good, 0,
      {"6 of 6 directions are not measured in the reference and are predicted", ", predicted from the reference"});
  const std::string nudged = files.write("nudged.csv", 5, gonio::rgb::Ones(), 1, 0.0005);
  check_says(nudged + " --noise 0.02 --reference " + good, 0, {", predicted from the reference"});
  const auto within = gonio_tool("check " + nudged + " --noise 0.02 --same-within 0.1 --reference " + good);
  CHECK(within.output.find("predicted") == std::string::npos);
}

TEST_CASE("gonio check: a verdict has at most five lines, and many parts are a table") {
  const checked_files files;
  const std::string reference = " --noise 0.02 --reference " + files.write("good.csv", 1, gonio::rgb::Ones());
  const std::string same = files.write("same.csv", 2, gonio::rgb::Ones());
  const std::string brighter = files.write("brighter.csv", 3, gonio::rgb::Constant(1.5));
  const auto result = gonio_tool("check " + brighter + reference);
  CHECK(result.exit_code == 1);
  CHECK(std::ranges::count(result.output, '\n') <= 5);
  CHECK(result.output.find("other directions differ (--verbose lists them)") != std::string::npos);
  const auto verbose = gonio_tool("check --verbose " + brighter + reference);
  CHECK(std::ranges::count(verbose.output, '\n') > 6);
  CHECK(verbose.output.find("differs: theta_i") != std::string::npos);

  const auto table = gonio_tool("check " + same + " " + brighter + reference);
  CHECK(table.exit_code == 1);
  CHECK(table.output.find("same.csv | GO | ") != std::string::npos);
  CHECK(table.output.find("brighter.csv | NO-GO | ") != std::string::npos);
  CHECK(gonio_tool("check " + same + " " + same + reference).exit_code == 0);
  const auto told = read_json(gonio_tool("check --json " + same + " " + brighter + reference).output);
  REQUIRE(told.size() == 2);
  CHECK(told[0]["verdict"] == "GO");
  CHECK(told[1]["verdict"] == "NO-GO");
  // A warning about the reference is printed once, although the reference is read with each part.
  scratch::put(files.folder / "gap.csv", scratch::get(files.folder / "good.csv") + "10,20,30,,,,1\n");
  const auto warned =
      gonio_tool("check " + same + " " + brighter + " --noise 0.02 --reference " + (files.folder / "gap.csv").string());
  const std::size_t first = warned.output.find("gap.csv: 1 of 7 rows is left out");
  CHECK(first != std::string::npos);
  CHECK(warned.output.find("gap.csv", first + 1) == std::string::npos);
  scratch::put(files.folder / "one.csv", "# quantity: brdf\ntheta_h,theta_d,phi_d,value\n10,20,30,.1\n");
  check_says((files.folder / "one.csv").string() + reference, 2, {"one.csv: has 1 channel", "good.csv has 3"});
  check_says(same + " " + brighter + reference + " --report " + (files.folder / "p.html").string(), 2,
             {"--report needs one part, not 2"});
}

TEST_CASE("gonio check: tolerances of channels, of the highlight and of Delta E") {
  const checked_files files;
  const std::string reference =
      " --noise 0.005 --reference " + files.write("good.csv", 1, gonio::rgb::Ones(), 1, 0.0, 0.005);
  const std::string red = files.write("red.csv", 3, {1.15, 1.0, 1.0}, 1, 0.0, 0.005);
  check_says(red + reference, 1, {"NO-GO", "Delta E "});
  check_says(red + reference + " --tolerance 0.2 0.01 0.01", 0, {"GO: ", "tolerance 20 %, 1 %, 1 %"});
  check_says(red + reference + " --tolerance 0.01 0.2 0.2", 1, {"NO-GO"});
  check_says(red + reference + " --delta-e 10", 0, {"GO: ", "tolerance Delta E of 10"});
  check_says(red + reference + " --delta-e 0.5", 1, {"NO-GO"});
  check_says(red + reference + " --peak-tolerance 0.5", 1, {"NO-GO", "tolerance 50 % near the mirror direction"});
  check_says(red + reference + " --delta-e 2 --tolerance 0.1", 2, {"a Delta E tolerance cannot be combined"});
  check_says(red + reference + " --tolerance 0.1 0.2", 2, {"one tolerance, or one for each of 3 channels, not 2"});
}

TEST_CASE("gonio check: angles are signed in the plane of incidence") {
  const scratch::folder folder;
  const auto scan = [&](const char* name, double factor) {
    std::string text = "theta_i;theta_o;brdf\n45;-45;" + std::to_string(0.9 * factor) + "\n";
    for (const int theta_o : {-60, -30, 0, 30}) text += "45;" + std::to_string(theta_o) + ";0.1\n";
    scratch::put(folder / name, text);
    return (folder / name).string();
  };
  check_says(scan("part.csv", 1.5) + " --noise 0.02 --theta-o-sign light --reference " + scan("good.csv", 1.0), 1,
             {"worst: theta_i 45.0, theta_o -45.0 (line 2): value 1.350 instead of 0.900"});
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
