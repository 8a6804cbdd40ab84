/// gonio-papers figures on a few synthetic materials.

#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
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

  [[nodiscard]] tool_result evaluate(const std::string& arguments, const std::string& thinning = "3 5") const {
    return gonio_papers(arguments + " --thin " + thinning + " --networks " + (folder_ / "n.npy").string());
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// 400 measurements of a material in a file.
  [[nodiscard]] std::string measured(const std::string& name) const {
    const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");
    const gonio::valid_cells cells(gonio::grid({30, 30, 36}));
    gonio::sample_set samples;
    for (const Eigen::Index cell : gonio::random_cells(cells, 400, 1)) {
      const auto [wi, wo] = gonio::to_directions(cells.angles(cell));
      samples.push_back({cells.angles(cell), paint(wi, wo)});
    }
    gonio::io::write_samples(folder_ / name, samples);
    return at(name);
  }

  /// Every 5 degrees in the plane of incidence with the light at 45, of the same material.
  [[nodiscard]] std::string scanned(const std::string& name) const {
    const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");
    const gonio::direction wi = gonio::spherical_direction(gonio::radians(45.0), 0.0);
    gonio::sample_set samples;
    for (int view = -80; view <= 80; view += 5) {
      const gonio::direction wo =
          gonio::spherical_direction(gonio::radians(std::abs(view)), view < 0 ? 0.0 : std::numbers::pi);
      samples.push_back({gonio::direction_pair{wi, wo}, paint(wi, wo)});
    }
    gonio::io::write_samples(folder_ / name, samples);
    return at(name);
  }

  /// The tables of a figure.
  [[nodiscard]] json draw(const std::string& arguments, const std::string& thinning = "3 5") const {
    const auto result = evaluate("figures --json --figure " + arguments, thinning);
    REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
    return read_json(result.output)["tables"];
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
  const json tables = figures_database().draw("2015-5 --most 5 --repetitions 2 --components 3 400");
  REQUIRE(tables.size() == 3);  // of 3 components, of all, and by expected error
  CHECK(tables[0]["title"].get<std::string>().find("of the first 3 components") != std::string::npos);
  for (const std::size_t by_condition : {std::size_t{0}, std::size_t{1}}) {
    CHECK(tables[by_condition]["rows"].size() == 14);
    const auto along = rows_with(tables[by_condition], "search", "along the gradient (Nielsen et al.)");
    const auto swaps = rows_with(tables[by_condition], "search", "random swaps, five times the time");
    REQUIRE(along.size() == 2);
    REQUIRE(swaps.size() == 2);
    CHECK(swaps[1]["seconds"].get<double>() > along[1]["seconds"].get<double>());
  }
  for (const json& n : {json(2), json(5)}) {
    const auto rows = rows_with(tables[2], "n", n);
    REQUIRE(rows.size() == 5);
    CHECK(rows[3]["search"] == "greedy over all cells");
    CHECK(rows[4]["E, best"].get<double>() <= rows[3]["E, best"].get<double>() * (1.0 + 1e-6));
    for (const json& row : rows) CHECK(row["E, best"].get<double>() <= row["E, mean"].get<double>() * (1.0 + 1e-9));
  }
}

TEST_CASE("figure 2015-6: all pairs of a coarse grid bound what searches find on it") {
  const json tables = figures_database().draw("2015-6 --step 30 --repetitions 4 --components 2");
  REQUIRE(tables.size() == 5);
  const json& best = tables[0]["rows"];
  REQUIRE(best.size() == 7);
  // The exhaustive pairs are worth what their criterion says of them when it is asked again.
  const json& shares = tables[1]["rows"];
  CHECK(best[0]["condition"].get<double>() ==
        doctest::Approx(shares[0]["best of the grid"].get<double>()).epsilon(1e-6));
  CHECK(best[5]["E"].get<double>() == doctest::Approx(shares[3]["best of the grid"].get<double>()).epsilon(1e-4));
  CHECK(best[5]["E"].get<double>() <= best[0]["E"].get<double>() * (1.0 + 1e-4));
  for (const json& row : shares) {
    CHECK(row["lowest"].get<double>() <= row["median"].get<double>());
    CHECK(row["median"].get<double>() <= row["highest"].get<double>());
    CHECK(row["as good as the grid's"].get<int>() <= row["within 1 %"].get<int>());
  }
  CHECK(tables[2]["rows"].size() == 8);
  // Of all components it is the same pair and the same searches.
  const json& by_components = tables[4]["rows"];
  REQUIRE(by_components.size() == 2);
  CHECK(by_components[0]["k"] == 2);
  CHECK(by_components[1]["best of the grid"] == shares[0]["best of the grid"]);
  CHECK(by_components[1]["median"] == shares[0]["median"]);
  CHECK(by_components[1]["published pair"] == best[4]["condition"]);
}

TEST_CASE("figures 2015-table-1 and -2: the condition number of the first k components") {
  const figures_database database;
  const json points = database.draw("2015-table-1 --repetitions 3 --most 5 --components 2 3");
  REQUIRE(points[0]["rows"].size() == 6);
  for (const json& row : points[0]["rows"]) {
    CHECK(row["best found"].get<double>() >= 1.0);
    CHECK(row["% of 2000 random sets below it"].get<double>() <= 100.0);
  }
  CHECK(points[0]["rows"][0]["of the published"] == points[0]["rows"][2]["of the published"]);

  const json spheres = database.draw("2015-table-2 --repetitions 3 --components 3 5");
  REQUIRE(spheres.size() == 2);
  REQUIRE(spheres[0]["rows"].size() == 3);
  for (const json& row : spheres[0]["rows"]) {
    // JSON has no infinity: a singular set has null.
    const auto condition = [&](const char* column) {
      return row[column].is_null() ? std::numeric_limits<double>::infinity() : row[column].get<double>();
    };
    // No other image and no other pair is better than the best; the published ones have a rank among them.
    CHECK(condition("its condition") <= condition("of the published, 5") * (1.0 + 1e-9));
    CHECK(row["its rank of 30"].get<int>() >= 1);
    CHECK(row["their rank of 435"].get<int>() <= 435);
    CHECK(condition("their condition") <= condition("its condition") * (1.0 + 1e-9));
  }
  CHECK(spheres[1]["rows"].size() == 3);
}

TEST_CASE("figures: with either cosine weight, and with both side by side") {
  const figures_database database;
  const json both = database.draw("2016-3 --cosine-weight product larger", "9 15"),
             product = database.draw("2016-3", "9 15"), larger = database.draw("2016-3 --cosine-weight larger", "9 15");
  REQUIRE(both[0]["rows"].size() == 11);
  for (std::size_t m = 0; m < 11; ++m) {
    CHECK(both[0]["rows"][m]["material"] == product[0]["rows"][m]["material"]);
    CHECK(both[0]["rows"][m]["E_deviation, product"] == product[0]["rows"][m]["E_deviation"]);
    CHECK(both[0]["rows"][m]["E_deviation, larger"] == larger[0]["rows"][m]["E_deviation"]);
  }
  // Figures that reconstruct each material learn with the weight, too.
  const json one_by_one = database.draw("2016-15 --cosine-weight product larger", "9 15");
  CHECK(one_by_one[0]["rows"][0].contains("one image, product"));
  CHECK(one_by_one[0]["rows"][0]["one image, product"] != one_by_one[0]["rows"][0]["one image, larger"]);
  const auto refused = database.evaluate("figures --figure 2016-3 --cosine-weight larger larger");
  CHECK(refused.exit_code == 2);
}

TEST_CASE("figure 2015-10: a scan in the plane of incidence") {
  const figures_database database;
  const json tables = database.draw("2015-10 --samples " + database.scanned("scan.csv"), "9 15");
  REQUIRE(tables.size() == 2);
  REQUIRE(tables[0]["rows"].size() == 2);  // from the published directions, and from ours
  for (const json& row : tables[0]["rows"]) {
    CHECK(row["directions of the scan"] == 33);
    CHECK(row["rms of ln(f + 0.001)"].get<double>() > 0.0);
    CHECK(row["rms of ln(f + 0.001)"].get<double>() < 10.0);
  }
  REQUIRE(tables[1]["rows"].size() == 1);
  CHECK(tables[1]["rows"][0]["0"].get<std::string>().find(" / ") != std::string::npos);
  const auto nothing = database.evaluate("figures --figure 2015-10", "9 15");
  CHECK(nothing.exit_code != 0);
  CHECK(nothing.output.find("--samples") != std::string::npos);
}

TEST_CASE("figure 2015-penalties: the best penalties are no worse than the others") {
  const json tables = figures_database().draw("2015-penalties --most 5 --components 2 5");
  REQUIRE(tables.size() == 10);
  for (const std::size_t first : {std::size_t{0}, std::size_t{5}})
    for (const json& row : tables[first]["rows"]) {
      CHECK(row["ridge, the best eta"].get<double>() <= row["ridge, eta = 40"].get<double>());
      CHECK(row["weights not zero"].get<double>() <= row["n"].get<double>() + 1e-9);  // as the Lasso's solutions are
    }
  // The column of eta = 40 is that reconstruction.
  CHECK(tables[1]["rows"][0]["eta = 40"] == tables[0]["rows"][0]["ridge, eta = 40"]);
  CHECK(tables[5]["rows"][0]["eta = 0"] != tables[0]["rows"][0]["eta = 0"]);
  // With all components it is the same least squares and the same ridge.
  for (std::size_t set = 0; set < tables[0]["rows"].size(); ++set) {
    const json &squares = tables[3]["rows"][set], &ridge = tables[4]["rows"][set], &all = tables[0]["rows"][set];
    REQUIRE(squares.size() == 5);
    for (const auto& [column, value] : squares.items()) {
      if (!column.starts_with("k = ") || column == "k = 2" || column == "k = 5") continue;
      CHECK(value.get<double>() == doctest::Approx(all["eta = 0"].get<double>()));
      CHECK(ridge[column].get<double>() == doctest::Approx(all["ridge, eta = 40"].get<double>()));
    }
  }
}

TEST_CASE("figures 2015-2, 2015-12, 2016-2 and 2016-15: material by material") {
  const figures_database database;
  const std::string coarse = "9 15";  // spheres are drawn of many tables
  const json two = database.draw("2015-2 --most 2 --spheres " + database.at("spheres.png"), coarse);
  REQUIRE(two.size() == 3);
  REQUIRE(two[0]["rows"].size() == 11);
  for (const json& row : two[0]["rows"]) CHECK(row["all"].get<double>() <= row["expected-error 2"].get<double>());
  for (const json& row : two[1]["rows"]) CHECK(row["all"].get<double>() <= row["published 1"].get<double>() + 1.0);
  CHECK(std::filesystem::file_size(database.at("spheres.png")) > 1000);
  // The same reconstruction as without expanding tables, but for negative values, which are clamped there.
  const json seven = database.draw("2015-7 --most 2", coarse);
  REQUIRE(seven[0]["rows"].size() == 4);
  for (std::size_t set = 0; set < 4; ++set) {
    const json& row = seven[0]["rows"][set];
    const std::string column = row["set"].get<std::string>() + ' ' + std::to_string(row["n"].get<int>());
    CHECK(row["mapped error"].get<double>() == doctest::Approx(two[0]["rows"][10][column].get<double>()).epsilon(0.02));
    CHECK(row["in plane"].get<int>() <= row["n"].get<int>());
  }
  CHECK(seven[1]["rows"].size() == 6);

  const json spheres = database.draw("2015-11 --most 2", coarse);
  CHECK(spheres[0]["rows"].size() == 6);
  const json twelve = database.draw("2015-12 --most 2 --samples " + database.measured("paint.csv"), coarse);
  REQUIRE(twelve.size() == 4);
  // Here negative values are clamped, which brings them closer.
  CHECK(twelve[0]["rows"][10]["published 1"].get<double>() <= spheres[0]["rows"][0]["mapped error"].get<double>());
  CHECK(twelve[3]["rows"].size() == 6);
  for (const json& row : twelve[3]["rows"]) CHECK(row["samples used"].get<int>() + row["others"].get<int>() == 400);

  const json near = database.draw("2016-2", coarse), fixed = database.draw("2016-15", coarse);
  CHECK(near[0]["rows"][0]["one image"] == fixed[0]["rows"][0]["one image"]);
  CHECK(near[0]["rows"][0]["two images"] == fixed[0]["rows"][0]["two images, free"]);
}

TEST_CASE("figure 2016-3: errors of deviation and of reconstruction make up the error") {
  const figures_database database;
  const json three = database.draw("2016-3"), eight = database.draw("2015-8 --repetitions 1 --random-sets 1");
  REQUIRE(three[0]["rows"].size() == 11);
  for (std::size_t m = 0; m < 11; ++m) {
    const json& row = three[0]["rows"][m];
    const auto deviation = row["E_deviation"].get<double>(), missed = row["E_recon, 5 points, published"].get<double>();
    const auto error = eight[0]["rows"][m]["published"].get<double>();
    CHECK(deviation == doctest::Approx(eight[0]["rows"][m]["all"].get<double>()));
    // Channel by channel they are the sides of a right triangle.
    CHECK(error <= (deviation + missed) * (1.0 + 1e-9));
    CHECK(error >= std::max(deviation, missed) * (1.0 - 1e-9));
  }
}

TEST_CASE("figure 2016-17: several materials in one sample") {
  const figures_database database;
  const json tables = database.draw("2016-17 --most 3");
  REQUIRE(tables.size() == 3);
  CHECK(tables[0]["rows"][0]["pairs"] == 3);
  REQUIRE(tables[1]["rows"].size() == 2);
  for (const json& row : tables[1]["rows"]) {
    // Two of three networks may look alike; but pixels where two materials meet are never all told apart.
    CHECK(row["purity of as many clusters as materials"].get<double>() > 1.0 / 3.0);
    CHECK(row["purity of as many clusters as materials"].get<double>() < 1.0);
  }
  REQUIRE(tables[2]["rows"].size() == 6);
  for (const json& row : tables[2]["rows"]) CHECK(row["Delta E env: cluster"].get<double>() > 0.0);
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
  for (const json& set : read_json(whole.output))
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

TEST_CASE("figures 2016-5, 6, 7, 8 and 13: images from close by") {
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

  const json eight = database.draw("2016-8" + few);
  CHECK(eight[0]["rows"].size() == 3);
  CHECK(eight[1]["rows"][0]["two images"].get<double>() < eight[1]["rows"][0]["one image"].get<double>());

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
  const auto refused = figures_database().evaluate("figures --figure 2015-3");
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("2015-5") != std::string::npos);
  CHECK(std::ranges::count(refused.output, '\n') == 1);
}
