/// The main job on the embedded default, as the README's first command runs it: measurements in, table out.

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/merl.hpp>
#include <gonio/io/samples.hpp>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace {

const std::string directions = std::string(GONIO_SOURCE_DIR) + "/examples/data/nielsen-20.csv";

void run(const std::string& arguments) {
  const auto result = gonio_tool(arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
}

}  // namespace

TEST_CASE("expand, sample, reconstruct, compare, render") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  run("expand --formula red-paint -o " + at("truth.binary"));
  run("sample " + at("truth.binary") + " --directions " + directions + " -o " + at("samples.csv"));
  CHECK(gonio::io::read_samples(at("samples.csv")).size() == 20);
  run("reconstruct " + at("samples.csv") + " -o " + at("estimate.binary") + " --image " + at("sphere.png"));
  CHECK(std::filesystem::file_size(at("estimate.binary")) == 34'992'012);
  run("render " + at("estimate.binary") + " " + at("truth.binary") + " -o " + at("spheres.png"));
  run("render " + at("truth.binary") + " --slices -o " + at("slices.png"));

  const auto compared = gonio_tool("compare --json " + at("estimate.binary") + " " + at("truth.binary"));
  REQUIRE(compared.exit_code == 0);
  const auto errors = nlohmann::json::parse(compared.output);
  // Measured: 0.244, 3.26 and 4.25. The mean material, which is what --eta 1e18 gives, has 1.16, 52.0 and 48.9.
  CHECK(errors["mapped_rms"].get<double>() < 0.3);
  CHECK(errors["delta_e_env"].get<double>() < 5.0);
  CHECK(errors["delta_e_lights"].get<double>() < 6.0);
  CHECK(errors["channels"]["peak_ratio"].size() == 3);

  const auto self =
      nlohmann::json::parse(gonio_tool("compare --json " + at("truth.binary") + " " + at("truth.binary")).output);
  CHECK(self["mapped_rms"] == 0.0);
  CHECK(self["delta_e_env"] == 0.0);
  CHECK(self["peak_ratio"] == 1.0);

  SUBCASE("the same seed gives the same file, another seed another") {
    const std::string measure = "sample " + at("truth.binary") + " --count 50 --outliers 0.2 --noise 0.02 --seed ";
    run(measure + "1 -o " + at("a.csv"));
    run(measure + "1 -o " + at("b.csv"));
    run(measure + "2 -o " + at("c.csv"));
    CHECK(scratch::get(at("a.csv")) == scratch::get(at("b.csv")));
    CHECK(scratch::get(at("a.csv")) != scratch::get(at("c.csv")));
  }
  SUBCASE("the number of threads does not change a byte") {
    run("reconstruct " + at("samples.csv") + " --threads 1 -o " + at("one.binary"));
    CHECK(scratch::get(at("one.binary")) == scratch::get(at("estimate.binary")));
  }
  SUBCASE("info knows each kind of file") {
    const auto kind = [&](const std::string& file) {
      return nlohmann::json::parse(gonio_tool("info --json " + file).output)["kind"];
    };
    CHECK(kind(at("truth.binary")) == "MERL table");
    CHECK(kind(at("samples.csv")) == "samples");
    CHECK(kind(std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior") == "prior");
  }
  SUBCASE("the prior expands to the materials it was learned from") {
    run("expand --name blue-rubber -o " + at("rubber.binary"));
    const auto rubber = gonio::io::read_merl(at("rubber.binary"));
    const auto [wi, wo] = gonio::to_directions({gonio::radians(50), gonio::radians(10), gonio::radians(90)});
    CHECK(rubber(wi, wo).z() > 1.5 * rubber(wi, wo).x());  // away from the highlight it is blue
  }
  SUBCASE("reconstruct says how the fit went") {
    const auto fit = nlohmann::json::parse(gonio_tool("reconstruct --json " + at("samples.csv")).output);
    CHECK(fit["samples"] == 20);
    CHECK(fit["certificate"][0].get<double>() < 1e-9);
  }
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
  CHECK(nlohmann::json::parse(gonio_tool("info --json " + prior).output)["components"] == 4);
  const auto without =
      gonio_tool("learn --merl " + folder.path().string() + " --exclude gold --components 2 -o " + prior);
  CHECK(without.exit_code == 0);
  CHECK(nlohmann::json::parse(gonio_tool("info --json " + prior).output)["names"] == nlohmann::json{"grey", "red"});
  const auto unknown = gonio_tool("learn --merl " + folder.path().string() + " --exclude silver -o " + prior);
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.output.find("'silver'") != std::string::npos);
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
    const auto fit = nlohmann::json::parse(result.output);
    for (const double certificate : fit["certificate"]) CHECK(certificate <= 1e-9);
    return fit;
  };
  for (const char* options :
       {"--metric lin --solver lasso --lambda 0.1", "--metric root --root 3 --solver tikhonov --eta loo",
        "--metric log-relative --solver tsvd --variance 0.999", "--metric root --solver ls"})
    CHECK(reconstruct(options)["samples"] == 300);

  // NNLS is the default, and the quadratic program finds the same.
  const auto own = reconstruct(""), qp = reconstruct("--metric log --solver qp");
  CHECK(own["non_zero_weights"] == qp["non_zero_weights"]);
  CHECK(own["mapped_residual_rms"][0].get<double>() == doctest::Approx(qp["mapped_residual_rms"][0].get<double>()));
  const auto compared =
      nlohmann::json::parse(gonio_tool("compare --json " + at("estimate.binary") + " " + at("truth.binary")).output);
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
