/// gonio-papers figures on a few synthetic materials.

#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using nlohmann::json;

/// A folder with networks of random weights: the ten test materials, and six to learn from.
class figures_database {
 public:
  figures_database() {
    std::vector<std::string> names = gonio::nielsen_test_materials();
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) names.emplace_back(name);
    write_synthetic_networks(folder_, names);
  }

  [[nodiscard]] tool_result evaluate(const std::string& arguments) const {
    return gonio_papers("" + arguments + " --thin 3 5 --networks " + (folder_ / "n.npy").string());
  }

  /// The tables of a figure.
  [[nodiscard]] json draw(const std::string& arguments) const {
    const auto result = evaluate("figures --json --figure " + arguments);
    REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
    return parse_json(result.output)["tables"];
  }

 private:
  scratch::folder folder_;
};

std::vector<json> rows_with(const json& table, const char* column, const json& value) {
  std::vector<json> found;
  for (const json& row : table["rows"])
    if (row[column] == value) found.push_back(row);
  return found;
}

}  // namespace

TEST_CASE("figure 2015-5: searches in the same time") {
  const json tables = figures_database().draw("2015-5 --most 5 --repetitions 2");
  REQUIRE(tables.size() == 2);
  CHECK(tables[0]["rows"].size() == 8);
  const auto descent = rows_with(tables[0], "search", "descent (Nielsen et al.)");
  const auto swaps = rows_with(tables[0], "search", "random swaps, five times the time");
  REQUIRE(descent.size() == 2);
  REQUIRE(swaps.size() == 2);
  CHECK(swaps[1]["seconds"].get<double>() > descent[1]["seconds"].get<double>());
  for (const json& n : {json(2), json(5)}) {
    const auto rows = rows_with(tables[1], "n", n);
    REQUIRE(rows.size() == 5);
    CHECK(rows[3]["search"] == "greedy over all cells");
    CHECK(rows[4]["E, best"].get<double>() <= rows[3]["E, best"].get<double>() * (1.0 + 1e-6));
    for (const json& row : rows) CHECK(row["E, best"].get<double>() <= row["E, mean"].get<double>() * (1.0 + 1e-9));
  }
}

TEST_CASE("figures 2015-8, 2015-9 and 2016-19: points and spheres") {
  const figures_database database;
  const json eight = database.draw("2015-8 --repetitions 1 --random-sets 2");
  REQUIRE(eight[0]["rows"].size() == 11);
  for (const json& row : eight[0]["rows"]) CHECK(row["all"].get<double>() <= row["expected error"].get<double>());
  CHECK(eight[1]["rows"].size() == 3);

  // The same reconstruction as the whole pipeline's, whose negative values are clamped.
  const auto whole = database.evaluate("directions --sets published industry -n 5 --reconstruction-eta 40 --json");
  REQUIRE_MESSAGE(whole.exit_code == 0, whole.output);
  const json mean = eight[0]["rows"].back();
  for (const json& set : parse_json(whole.output))
    CHECK(mean[set["set"].get<std::string>()].get<double>() ==
          doctest::Approx(set["result"]["errors"]["mapped_rms"].get<double>()).epsilon(0.02));

  const json nine = database.draw("2015-9 --most 2 --repetitions 1 --random-sets 2");
  REQUIRE(nine[0]["rows"].size() == 2);
  for (const json& row : nine[0]["rows"])
    CHECK(row["E: expected error"].get<double>() < row["E: condition"].get<double>());
  CHECK(nine[1]["rows"].size() == 2);
  CHECK(nine[1]["rows"][1]["published"].is_number());

  const json nineteen = database.draw("2016-19 --most 2 --repetitions 1 --random-sets 2");
  CHECK(nineteen[0] == nine[0]);
  CHECK(rows_with(nineteen[3], "criterion", "expected error")[0]["steps"] == 1);
}

TEST_CASE("figures 2016-5, 6, 7 and 13: images from close by") {
  const figures_database database;
  const std::string few = " --step 40 --fov 25 --most 2";
  const json five = database.draw("2016-5" + few);
  REQUIRE(five[0]["rows"].size() == 2);
  CHECK(five[0]["rows"][0]["25 degrees, expected error"].is_number());
  CHECK(five[1]["rows"].size() == 2);

  const json six = database.draw("2016-6" + few);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(six[0]["rows"][i]["25 degrees"] == five[0]["rows"][i]["25 degrees, expected error"]);
  CHECK(six[2]["rows"].size() == 3);

  const json seven = database.draw("2016-7 --step 40 --most 6");
  REQUIRE(seven[0]["rows"].size() == 1);
  CHECK(seven[0]["rows"][0]["materials"] == 6);

  const json thirteen = database.draw("2016-13" + few);
  // One image can be taken wherever camera and light are fixed.
  const json& one = thirteen[0]["rows"][0];
  CHECK(one["fixed camera"].get<double>() == doctest::Approx(one["free"].get<double>()));
  const auto angles = rows_with(thirteen[1], "set", "fixed camera");
  REQUIRE(angles.size() == 2);
  CHECK(angles[0]["camera's polar angle"] == angles[1]["camera's polar angle"]);
}

TEST_CASE("figures: one that does not exist is refused") {
  const auto refused = figures_database().evaluate("figures --figure 2015-6");
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("2015-5") != std::string::npos);
  CHECK(std::ranges::count(refused.output, '\n') == 1);
}
