/// gonio-papers directions-measured on synthetic materials.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/networks.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace {

/// Networks a to g; a table of a material that they do not have; a paint that was measured at 60 places.
class synthetic_measurements {
 public:
  synthetic_measurements() {
    write_synthetic_networks(folder_, {"a", "b", "c", "d", "e", "f", "g"});
    std::filesystem::create_directories(folder_ / "tables");
    const auto networks = gonio::io::read_networks(folder_ / "n.npy");
    gonio::io::write_merl(folder_ / "tables" / "g.binary",
                          gonio::model::tabulate_networks(networks, gonio::valid_cells()).table(6));
    std::string text = "3\n450 550 650\n";
    for (int i = 0; i < 60; ++i) text += std::to_string(0.02 * i) + " 0 0.6 2 .1 .2 .3\n";
    scratch::put(folder_ / "paint.brdf", text);
  }

  [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }
  [[nodiscard]] tool_result evaluate(const std::string& arguments) const {
    return gonio_papers("directions-measured --networks " + at("n.npy") + " " + arguments);
  }

 private:
  scratch::folder folder_;
};

}  // namespace

TEST_CASE("real measurements are reconstructed from published, optimal and random directions") {
  const synthetic_measurements synthetic;
  const std::string arguments = "--tables " + synthetic.at("tables") + " --samples " + synthetic.at("paint.brdf") +
                                " -n 5 20 --sets published expected-error random --repetitions 2 --state " +
                                synthetic.at("state");
  const auto table = synthetic.evaluate(arguments);
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(table.output.find("| mean of 1 | 20 | expected-error |") != std::string::npos);

  // What is done is kept.
  const std::string kept = scratch::get(synthetic.at("state"));
  const auto printed = synthetic.evaluate(arguments + " --json");
  const std::string again = scratch::get(synthetic.at("state"));
  CHECK(again.starts_with(kept));
  CHECK(again.find_first_not_of('\n', kept.size()) == std::string::npos);
  REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
  const auto all = read_json(printed.output);
  REQUIRE(all["tables"].size() == 6);
  REQUIRE(all["scattered"].size() == 6);
  const auto figure = [](const nlohmann::json& rows, int count, const std::string& set, const char* key) {
    const auto row = std::ranges::find_if(rows, [&](const auto& r) { return r["count"] == count && r["set"] == set; });
    REQUIRE(row != rows.end());
    return (*row)["result"][key].get<double>();
  };
  // The network is among those that are learned, so that 20 measurements tell more of it than five.
  CHECK(figure(all["tables"], 20, "expected-error", "mapped_rms") <
        figure(all["tables"], 5, "expected-error", "mapped_rms"));
  CHECK(figure(all["scattered"], 5, "published", "degrees_worst") > 5.0);
  CHECK(figure(all["scattered"], 5, "random", "degrees_worst") == 0.0);
  CHECK(figure(all["scattered"], 20, "random", "judged_by") == 40);
}

TEST_CASE("directions-measured: nothing to reconstruct, and nothing left to judge by") {
  const synthetic_measurements synthetic;
  const auto nothing = synthetic.evaluate("");
  CHECK(nothing.exit_code == 2);
  CHECK(nothing.output.find("give --tables or --samples") != std::string::npos);
  const auto unknown = synthetic.evaluate("--sets beauty -n 5 --samples " + synthetic.at("paint.brdf"));
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.output.find("there is no set 'beauty'") != std::string::npos);
  CHECK(synthetic.evaluate("--eta -1 -n 5 --samples " + synthetic.at("paint.brdf")).exit_code == 2);
  const auto all = synthetic.evaluate("-n 60 --sets random --samples " + synthetic.at("paint.brdf"));
  CHECK(all.exit_code == 2);
  CHECK(all.output.find("no sample is left for the comparison") != std::string::npos);
}
