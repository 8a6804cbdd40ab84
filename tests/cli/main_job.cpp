/// The main job with the embedded default prior, as in the README's first command: measurements in, table out.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// The paint, 20 samples of it and their reconstruction. Made once; tests add their own files.
class measured_paint {
 public:
  measured_paint() {
    run("expand --formula red-paint -o " + at("truth.binary"));
    run("sample " + at("truth.binary") + " --directions " + GONIO_SOURCE_DIR + "/examples/data/nielsen-20.csv -o " +
        at("samples.csv"));
    run("reconstruct " + at("samples.csv") + " -o " + at("estimate.binary") + " --image " + at("sphere.png"));
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

 private:
  scratch::folder folder_;
};

std::string at(const std::string& name) {
  static const measured_paint made;
  return made.at(name);
}

}  // namespace

TEST_CASE("expand, sample, reconstruct, compare, render") {
  CHECK(gonio::io::read_samples(at("samples.csv")).size() == 20);
  CHECK(std::filesystem::file_size(at("estimate.binary")) == 34'992'012);
  run("render " + at("estimate.binary") + " " + at("truth.binary") + " -o " + at("spheres.png"));
  run("render " + at("truth.binary") + " --slices -o " + at("slices.png"));

  const auto compared = gonio_tool("compare --json " + at("estimate.binary") + " " + at("truth.binary"));
  REQUIRE(compared.exit_code == 0);
  const auto errors = read_json(compared.output);
  // Measured: 0.244, 3.26 and 4.25. The mean material, the result of --eta 1e18, has 1.16, 52.0 and 48.9.
  CHECK(errors["mapped_rms"].get<double>() < 0.3);
  CHECK(errors["delta_e_env"].get<double>() < 5.0);
  CHECK(errors["delta_e_lights"].get<double>() < 6.0);
  CHECK(errors["channels"]["peak_ratio"].size() == 3);

  const auto self = read_json(gonio_tool("compare --json " + at("truth.binary") + " " + at("truth.binary")).output);
  CHECK(self["mapped_rms"] == 0.0);
  CHECK(self["delta_e_env"] == 0.0);
  CHECK(self["peak_ratio"] == 1.0);
  CHECK(self["readings"]["estimate"] == self["readings"]["truth"]);
  CHECK(compared.output.find("\"gloss\"") != std::string::npos);
  CHECK_FALSE(self.contains("delta_e_natural"));

  // Under a uniform sky. Its colour does not matter for equal tables.
  gonio::io::write_hdr(at("sky.hdr"), gonio::uniform_image(8, 16, gonio::rgb(1.0, 2.0, 3.0)));
  const std::string under = "compare --environment " + at("sky.hdr") + " ";
  const auto natural =
      read_json(gonio_tool(under + "--json " + at("estimate.binary") + " " + at("truth.binary")).output);
  CHECK(natural["delta_e_natural"].get<double>() > 0.0);
  CHECK(natural["delta_e_natural"].get<double>() < 5.0);
  CHECK(gonio_tool(under + at("truth.binary") + " " + at("truth.binary")).output.find("Delta E, natural  0.00") !=
        std::string::npos);
}

TEST_CASE("reconstruct says where no file is written") {
  const std::string nothing = "no file is written";
  CHECK(gonio_tool("reconstruct " + at("samples.csv")).output.find(nothing) != std::string::npos);
  for (const std::string& file : {"-o " + at("once.binary"), "--image " + at("once.png"), std::string("--json")})
    CHECK(gonio_tool("reconstruct " + at("samples.csv") + " " + file).output.find(nothing) == std::string::npos);
}

TEST_CASE("the same seed gives the same file, another seed another") {
  const std::string measure = "sample " + at("truth.binary") + " --count 50 --outliers 0.2 --noise 0.02 --seed ";
  run(measure + "1 -o " + at("a.csv"));
  run(measure + "1 -o " + at("b.csv"));
  run(measure + "2 -o " + at("c.csv"));
  CHECK(scratch::get(at("a.csv")) == scratch::get(at("b.csv")));
  CHECK(scratch::get(at("a.csv")) != scratch::get(at("c.csv")));
}

TEST_CASE("the number of threads does not change a byte") {
  run("reconstruct " + at("samples.csv") + " --threads 1 -o " + at("one.binary"));
  CHECK(scratch::get(at("one.binary")) == scratch::get(at("estimate.binary")));
}

TEST_CASE("info knows each kind of file") {
  const auto kind = [&](const std::string& file) {
    return read_json(gonio_tool("info --json " + file).output)["kind"];
  };
  CHECK(kind(at("truth.binary")) == "MERL table");
  CHECK(kind(at("samples.csv")) == "samples");
  scratch::put(at("spectra.brdf"), "2\n450 650\n0.5 0 0.4 3 .1 .2\n0.1 0 0.4 2 .1 .2\n");
  CHECK(kind(at("spectra.brdf")) == "samples");
  CHECK(gonio_tool("reconstruct " + at("spectra.brdf") + " -o " + at("red.binary")).output.find("\n2 samples,") !=
        std::string::npos);
  CHECK(kind(std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior") == "prior");
}

TEST_CASE("the prior expands to the materials it was learned from") {
  run("expand --name blue-rubber -o " + at("rubber.binary"));
  const auto rubber = gonio::io::read_merl(at("rubber.binary"));
  const auto [wi, wo] = gonio::to_directions({gonio::radians(50), gonio::radians(10), gonio::radians(90)});
  CHECK(rubber(wi, wo).z() > 1.5 * rubber(wi, wo).x());  // blue away from the highlight
}

TEST_CASE("a sample that the others contradict is named and left out") {
  auto samples = gonio::io::read_samples(at("samples.csv"));
  const double truth = samples[5].value.y();
  samples[5].value *= 10.0;
  scratch::put(at("wrong.csv"), gonio::io::write_samples(samples));
  const std::string files = " --residuals " + at("residuals.csv") + " -o " + at("without.binary");
  const auto told = gonio_tool("reconstruct " + at("wrong.csv") + files);
  CHECK(told.exit_code == 0);
  CHECK(told.output.starts_with("gonio: warning: sample 6 disagrees and is left out: measured "));
  const std::string residuals = scratch::get(at("residuals.csv"));
  CHECK(std::ranges::count(residuals, '\n') == 21);
  CHECK(residuals.find("\n6,") != std::string::npos);
  const std::string output = gonio_tool("reconstruct --json " + at("wrong.csv")).output;
  const auto fit = read_json(output);
  REQUIRE(fit["left_out"].size() == 1);
  CHECK(fit["left_out"][0]["probability_wrong"].get<double>() > 0.75);
  CHECK(fit["left_out"][0]["sample"] == 6);
  CHECK(fit["left_out"][0]["others"][1].get<double>() == doctest::Approx(truth).epsilon(0.3));
  CHECK(read_json(gonio_tool("reconstruct --json " + at("samples.csv")).output)["left_out"].empty());
  // The message names the channel that is wrong.
  auto red = gonio::io::read_samples(at("samples.csv"));
  red[5].value.x() = -0.133;
  scratch::put(at("red.csv"), gonio::io::write_samples(red));
  const std::string of_red = run("reconstruct " + at("red.csv"));
  CHECK_MESSAGE(of_red.find(": measured -0.133") != std::string::npos, of_red);
  CHECK(of_red.find(", red)") != std::string::npos);
  const auto kept = gonio_tool("reconstruct --no-reject " + at("wrong.csv") + " -o " + at("with.binary"));
  CHECK(kept.output.starts_with("20 samples,"));
  const auto error = [&](const char* file) {
    return read_json(gonio_tool("compare --json " + at(file) + ' ' + at("truth.binary")).output)["mapped_rms"]
        .get<double>();
  };
  CHECK(error("without.binary") < 0.7 * error("with.binary"));
}

TEST_CASE("reconstruct says how sure it is far from all samples") {
  std::string near = "theta_h,theta_d,phi_d,r,g,b\n";
  for (int i = 0; i < 12; ++i) near += std::to_string(i + 1) + ',' + std::to_string(5 * i) + ",30,0.1,0.1,0.1\n";
  scratch::put(at("near.csv"), near);
  const std::string output = gonio_tool("reconstruct --json " + at("near.csv")).output;
  CHECK(output.find("the half vectors of all samples are within 12 degrees of the normal: farther away, half of "
                    "all directions are known to ") != std::string::npos);
  const auto fit = read_json(output);
  CHECK(fit["known_to_outside_the_samples"].get<double>() > fit["known_to"].get<double>());
  CHECK_FALSE(
      read_json(gonio_tool("reconstruct --json " + at("samples.csv")).output).contains("known_to_outside_the_samples"));
}

TEST_CASE("reconstruct says how sure it is") {
  const auto known = [&](const std::string& noise) {
    const auto result = gonio_tool("reconstruct --json " + at("samples.csv") + noise);
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    return read_json(result.output);
  };
  const auto fit = known(" --uncertainty " + at("known.binary"));
  CHECK(fit["known_to"].get<double>() < fit["known_to_beyond_80_degrees"].get<double>());
  CHECK(fit["known_to"].get<double>() < known(" --noise 0.3")["known_to"].get<double>());
  const auto table = gonio::io::read_merl(at("known.binary"));
  std::vector<float> values(table.values().begin(), table.values().end());
  CHECK(std::ranges::min(values) > 0.0f);
  CHECK(gonio::median(values) == doctest::Approx(fit["known_to"].get<double>()).epsilon(0.15));
  // The sphere becomes darker as the uncertainty grows.
  const auto lightness = [&](const std::string& noise) {
    known(noise + " --uncertainty-image " + at("known.png"));
    const gonio::image sphere = gonio::io::read_png(at("known.png"));
    gonio::rgb sum = gonio::rgb::Zero();
    for (std::size_t row = 0; row < sphere.shape(0); ++row)
      for (std::size_t column = 0; column < sphere.shape(1); ++column) sum += gonio::pixel(sphere, row, column);
    return gonio::luminance(sum);
  };
  CHECK(lightness(" --noise 0.3") < lightness(""));
}

TEST_CASE("reconstruct says how the fit went") {
  const auto fit = read_json(gonio_tool("reconstruct --json " + at("samples.csv")).output);
  CHECK(fit["samples"] == 20);
  CHECK(fit["kkt_residual"][0].get<double>() < 1e-9);
  const auto eta = [&](const std::string& noise) {
    const auto result = gonio_tool("reconstruct --json --discrepancy 0 " + at("samples.csv") + noise);
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    return read_json(result.output)["eta"].get<double>();
  };
  CHECK(eta(" --noise 0") < eta(" --noise 0.1"));
  CHECK(eta(" --noise 0.1") < eta(" --noise 0.3"));
  CHECK(eta("") >= eta(" --noise 0"));
  CHECK(eta("") <= eta(" --noise 0.3"));
  CHECK_FALSE(read_json(gonio_tool("reconstruct --json --eta 40 " + at("samples.csv")).output).contains("eta"));
}

TEST_CASE("learning from a folder of tables") {
  const scratch::folder folder;
  run("expand --formula red-paint -o " + (folder / "red.binary").string());
  run("expand --formula gold-metal -o " + (folder / "gold.binary").string());
  run("expand --formula grey-lambertian -o " + (folder / "grey.binary").string());
  const std::string prior = (folder / "three.prior").string();
  const auto learned = gonio_tool("learn --merl " + folder.path().string() + " --components 4 -o " + prior);
  CHECK(learned.exit_code == 0);
  CHECK(learned.output.find("3 materials") != std::string::npos);
  const auto weight = [&](const std::string& arguments) {
    const auto made = gonio_tool("learn --merl " + folder.path().string() + " --components 4 -o " + prior + arguments);
    REQUIRE_MESSAGE(made.exit_code == 0, made.output);
    return read_json(gonio_tool("info --json " + prior).output)["cosine_weight"];
  };
  CHECK(weight(" --cosine-weight larger") == "larger");
  CHECK(weight("") == "product");
  CHECK(read_json(gonio_tool("info --json " + prior).output)["components"] == 4);
  const auto without =
      gonio_tool("learn --merl " + folder.path().string() + " --exclude gold --components 2 -o " + prior);
  CHECK(without.exit_code == 0);
  CHECK(read_json(gonio_tool("info --json " + prior).output)["names"] == nlohmann::json{"grey", "red"});
  const auto unknown = gonio_tool("learn --merl " + folder.path().string() + " --exclude silver -o " + prior);
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.output.find("'silver'") != std::string::npos);
}

TEST_CASE("learning from tables and materials of the RGL database together") {
  const scratch::folder folder;
  run("expand --formula red-paint -o " + (folder / "red.binary").string());
  run("expand --formula grey-lambertian -o " + (folder / "grey.binary").string());
  std::filesystem::create_directory(folder / "rgl");
  std::filesystem::copy(std::string(GONIO_SOURCE_DIR) + "/tests/fuzz/seeds/rgl/one.bsdf", folder / "rgl/paint.bsdf");
  const std::string prior = (folder / "mixed.prior").string();
  const std::string learn =
      "learn --components 3 -o " + prior + " --merl " + folder.path().string() + " --rgl " + (folder / "rgl").string();
  run(learn);
  CHECK(read_json(gonio_tool("info --json " + prior).output)["names"] == nlohmann::json{"grey", "red", "paint"});
  run(learn + " --exclude red");
  CHECK(read_json(gonio_tool("info --json " + prior).output)["names"] == nlohmann::json{"grey", "paint"});
  std::filesystem::copy(folder / "rgl/paint.bsdf", folder / "rgl/grey.bsdf");
  const auto twice = gonio_tool(learn);
  CHECK(twice.exit_code == 2);
  CHECK(twice.output.find("two materials of --networks, --merl and --rgl are named 'grey'") != std::string::npos);
}

TEST_CASE("every metric and solver of the linear method reconstructs, and says how") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  run("expand --name red-plastic -o " + at("truth.binary"));
  run("sample " + at("truth.binary") + " --count 300 -o " + at("samples.csv"));
  const auto reconstruct = [&](const std::string& options) {
    const auto result = gonio_tool("reconstruct " + at("samples.csv") + " --method linear --exclude red-plastic " +
                                   options + " --json -o " + at("estimate.binary"));
    REQUIRE_MESSAGE(result.exit_code == 0, options, ": ", result.output);
    const auto fit = read_json(result.output.substr(result.output.find('{')));  // after the warning
    for (const double kkt_residual : fit["kkt_residual"]) CHECK(kkt_residual <= 1e-9);
    return fit;
  };
  for (const char* options :
       {"--metric lin --solver lasso --lambda 0.1", "--metric root --root 3 --solver tikhonov --eta loo",
        "--metric log-relative --solver tsvd --variance 0.999", "--metric root --solver ls"})
    CHECK(reconstruct(options)["samples"] == 300);

  // NNLS is the default; the quadratic program finds the same weights.
  const auto own = reconstruct(""), qp = reconstruct("--metric log --solver qp");
  CHECK(own["non_zero_weights"] == qp["non_zero_weights"]);
  CHECK(own["mapped_residual_rms"][0].get<double>() == doctest::Approx(qp["mapped_residual_rms"][0].get<double>()));
  const auto compared =
      read_json(gonio_tool("compare --json " + at("estimate.binary") + " " + at("truth.binary")).output);
  CHECK(compared["delta_e_env"].get<double>() < 15.0);
}

TEST_CASE("principal components take any solver whose weights have any sign") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  run("expand --formula red-paint -o " + at("truth.binary"));
  run("sample " + at("truth.binary") + " --count 100 -o " + at("samples.csv"));
  for (const char* solver : {"tikhonov --eta gcv", "ls"})
    run("reconstruct " + at("samples.csv") + " --solver " + solver + " -o " + at("estimate.binary"));
}

namespace {

/// Root mean square of the difference of ln(rho + 0.01) between two tables.
double log_rms(const gonio::brdf_table& a, const gonio::brdf_table& b) {
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < a.cells().size(); ++cell)
    sum += ((a.at(cell) + 0.01).log() - (b.at(cell) + 0.01).log()).square().mean();
  return std::sqrt(sum / static_cast<double>(a.cells().size()));
}

/// 400 samples of red plastic, a fifth of them outliers. Reconstructions exclude this material from the prior.
class corrected_plastic {
 public:
  corrected_plastic() {
    run("expand --name red-plastic -o " + at("truth.binary"));
    run("sample " + at("truth.binary") + " --count 400 --outliers 0.2 --seed 1 -o " + at("samples.csv"));
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  [[nodiscard]] nlohmann::json reconstruct(const std::string& options) const {
    const auto result =
        gonio_tool("reconstruct " + at("samples.csv") + " " + options + " --json -o " + at("out.binary"));
    REQUIRE_MESSAGE(result.exit_code == 0, options, ": ", result.output);
    return read_json(result.output.substr(result.output.find('{')));  // after the warnings
  }

  [[nodiscard]] double error() const {
    return log_rms(gonio::io::read_merl(at("out.binary")), gonio::io::read_merl(at("truth.binary")));
  }

 private:
  scratch::folder folder_;
};

const std::string correction = "--method correction --exclude red-plastic ";

}  // namespace

TEST_CASE("corrections find the outliers, which the other methods believe") {
  const corrected_plastic plastic;
  const auto found = plastic.reconstruct(correction + "--history " + plastic.at("history.csv"));
  const std::string table = scratch::get(plastic.at("out.binary"));
  const double automatic = plastic.error();
  CHECK(found["samples"] == 400);
  CHECK(found["outliers"].get<double>() == doctest::Approx(0.2).epsilon(0.2));  // measured: 0.185
  CHECK(automatic < 0.15);

  // The history has a line for each round; the last one agrees with the output.
  std::istringstream history(scratch::get(plastic.at("history.csv")));
  std::vector<std::string> lines;
  for (std::string line; std::getline(history, line);) lines.push_back(line);
  const auto rounds = found["rounds"].get<std::size_t>();
  REQUIRE(lines.size() == 1 + rounds);
  CHECK(lines.front() == "round,error,change,down_weighted");
  CHECK(lines.back() == std::to_string(rounds) + "," + found["error"].dump() + "," + found["change"].dump() + "," +
                            found["down_weighted"].dump());

  // The number of threads does not change a byte.
  static_cast<void>(plastic.reconstruct(correction + "--threads 1"));
  CHECK(scratch::get(plastic.at("out.binary")) == table);

  // The paper's weights help as well. Without weights, outliers pull the fit.
  const auto paper = plastic.reconstruct(correction + "--gamma 3 --iterations 4");
  const double published = plastic.error();
  CHECK(paper["rounds"] == 4);
  CHECK_FALSE(paper.contains("outliers"));
  CHECK(paper["down_weighted"].get<double>() > 0.1);
  CHECK(published < 0.3);
  CHECK(plastic.reconstruct(correction + "--gamma 0 --metric root --iterations 2")["down_weighted"] == 0.0);
  CHECK(plastic.error() > 2.0 * published);

  // The other methods interpolate the outliers.
  CHECK(plastic.reconstruct("--method rbf --metric root")["samples"] == 400);
  CHECK(plastic.error() > 5.0 * automatic);
  CHECK(plastic.reconstruct("--method pull-push")["samples"] == 400);
  CHECK(plastic.error() > 5.0 * automatic);
}

TEST_CASE("the story of a correction has a tile for each stage, and the differences to the truth") {
  const corrected_plastic plastic;
  const auto told = plastic.reconstruct(correction + "--iterations 1 --iteration-figure " + plastic.at("a/story") +
                                        " --truth " + plastic.at("truth.binary"));
  REQUIRE(told["delta_e_env"].size() == 2);
  CHECK(told["delta_e_env"][0]["round"] == 0);
  CHECK(told["delta_e_env"][1]["round"] == 1);
  CHECK(told["delta_e_env"][1]["mean"].get<double>() < 0.5 * told["delta_e_env"][0]["mean"].get<double>());
  CHECK(scratch::get(plastic.at("a/story/history.csv")).starts_with("round,error,change,down_weighted\n1,"));

  // Columns: truth and input, start, correction, corrected. 4 columns and 3 rows of 144 pixels, with labels of 14 and
  // margins of 6; a row of scales and a line of text.
  const auto image = gonio::io::read_png(plastic.at("a/story/iterations.png"));
  REQUIRE(image.shape(0) == 6 + 3 * 164 + 36 + 14);
  REQUIRE(image.shape(1) == 6 + 4 * 150);
  const auto mean_of_tile = [&](std::size_t column, std::size_t row) {
    gonio::rgb sum = gonio::rgb::Zero();
    for (std::size_t y = 0; y < 144; ++y)
      for (std::size_t x = 0; x < 144; ++x) sum += gonio::pixel(image, 6 + 164 * row + y, 6 + 150 * column + x);
    return gonio::rgb(sum / (144.0 * 144.0));
  };
  const gonio::rgb input = mean_of_tile(0, 2), before = mean_of_tile(1, 2), after = mean_of_tile(3, 2);
  CHECK(std::abs(input.y() - 0.35) < 0.15);  // 400 samples leave most of it grey
  CHECK(after.y() > before.y() + 0.2);       // from dark differences to light ones
}
