/// gonio learn --split and gonio reconstruct --method soft-specular.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/soft_specular_prior.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace {

const std::string nielsen_20 = std::string(GONIO_SOURCE_DIR) + "/examples/data/nielsen-20.csv";

}  // namespace

TEST_CASE("two priors are learned, and the samples choose one") {
  const scratch::folder folder;
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  std::filesystem::create_directory(folder / "tables");
  for (const char* formula : {"red-paint", "gold-metal", "grey-lambertian"})
    run("expand --formula " + std::string(formula) + " -o " + at("tables/" + std::string(formula) + ".binary"));
  for (const char* name : {"blue-rubber", "chrome-steel"})
    run("expand --name " + std::string(name) + " -o " + at("tables/" + std::string(name) + ".binary"));

  const std::string split = at("split.prior");
  const auto learned = gonio_tool("learn --split --thin 9 15 --components 4 --merl " + at("tables") + " -o " + split);
  REQUIRE_MESSAGE(learned.exit_code == 0, learned.output);
  CHECK(learned.output.find("kept 4 components of 2 soft of 5 materials of tables: ") != std::string::npos);
  CHECK(learned.output.find("kept 4 components of 3 specular of 5 materials of tables: ") != std::string::npos);
  const auto facts = read_json(gonio_tool("info --json " + split).output);
  CHECK(facts["kind"] == "soft and specular prior");
  CHECK(facts["soft"]["names"] == nlohmann::json{"blue-rubber", "grey-lambertian"});
  CHECK(facts["specular"]["materials"] == 3);
  const auto prior = gonio::io::read_soft_specular_prior(split);
  // A different scratch folder, memory limit and number of threads give the same bytes.
  run("learn --split --thin 9 15 --components 4 --merl " + at("tables") + " -o " + at("again.prior") + " --scratch " +
      at("tables") + " --memory 1 --threads 1");
  CHECK(scratch::get(at("again.prior")) == scratch::get(split));

  const auto reconstruct = [&](const std::string& material, const std::string& kind, const std::string& options) {
    run("sample " + at("tables/" + material + ".binary") + " --directions " + nielsen_20 + " -o " + at("s.csv"));
    const auto result = gonio_tool("reconstruct --json --method soft-specular " + at("s.csv") + " --prior " + split +
                                   " -o " + at("out.binary") + options);
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    const auto fit = read_json(result.output.substr(result.output.find('{')));  // after the warnings
    CHECK(fit["kind"] == kind);
    CHECK((fit["contrast"] < fit["threshold"]) == (kind == "soft"));
    return fit["eta"].get<double>();
  };
  CHECK(reconstruct("grey-lambertian", "soft", "") == doctest::Approx(16.0));
  CHECK(reconstruct("chrome-steel", "specular", " --eta 10") == doctest::Approx(6.0));
  // The table equals that of the library's estimator.
  const auto estimator = gonio::soft_specular_decomposition(prior, gonio::penalties_in_proportion(prior, 10.0));
  const auto expected = estimator.fit(gonio::io::read_samples(at("s.csv"))).tabulate(gonio::valid_cells());
  gonio::io::write_merl(at("expected.binary"), expected);
  CHECK(scratch::get(at("out.binary")) == scratch::get(at("expected.binary")));

  // Options for one kind of prior are refused with the other. Few samples cannot tell soft from specular.
  const std::string samples = at("s.csv"), out = " -o " + at("none.binary");
  const std::string shipped = std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior";
  const std::string either = "reconstruct --method soft-specular " + samples + out;
  refuses(either, {"--method soft-specular needs a --prior written by gonio learn --split", "materials.prior"});
  refuses(either + " --prior " + samples, {"s.csv: not a gonio soft and specular prior"});
  refuses("reconstruct " + samples + out + " --prior " + split, {"split.prior: has a soft and a specular prior"});
  refuses("design -n 2 -o " + at("none.csv") + " --prior " + split, {"split.prior: has a soft and a specular prior"});
  refuses(either + " --prior " + split + " --eta gcv", {"needs a number for --eta", "gcv"});
  refuses(either + " --prior " + split + " --eta -1", {"eta"});
  refuses(either + " --prior " + split + " --noise 0.02", {"--noise", "--method pca"});
  scratch::put(samples, "theta_h,theta_d,phi_d,r,g,b\n1,2,3,0.1,0.1,0.1\n");
  refuses(either + " --prior " + split, {"choice of soft or specular needs a sample", "theta_h up to 5.0"});
  CHECK_FALSE(std::filesystem::exists(folder / "none.binary"));
  std::filesystem::remove(folder / "tables/gold-metal.binary");
  std::filesystem::remove(folder / "tables/chrome-steel.binary");
  std::filesystem::remove(folder / "tables/red-paint.binary");
  std::filesystem::remove(folder / "tables/blue-rubber.binary");
  refuses("learn --split --merl " + at("tables") + " -o " + at("one.prior"), {"all 1 materials are specular"});
  CHECK_FALSE(std::filesystem::exists(folder / "one.prior"));
}
