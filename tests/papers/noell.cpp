/// The experiments after Noell et al. 2014 on a few synthetic materials.

#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/io/images/image.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>

namespace {

/// A folder with five networks of random weights, named a to e.
class synthetic_database {
 public:
  synthetic_database() { write_synthetic_networks(folder_, {"a", "b", "c", "d", "e"}); }

  [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }

  /// What the tool prints.
  [[nodiscard]] std::string evaluate(const std::string& arguments) const {
    const auto result = gonio_papers("" + arguments + " --networks " + at("n.npy"));
    REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
    return result.output;
  }

 private:
  scratch::folder folder_;
};

std::vector<std::string> lines_with(const std::string& text, const std::string& word) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.find(word) != std::string::npos) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("noell-table1: a row for each setting, and what is done is not done again") {
  const synthetic_database database;
  const std::string state = database.at("state");
  const std::string arguments =
      "noell-table1 --materials b --methods our lc --data 40 --outliers 0 0.2 --seeds 1 2 --iterations 0 2 --state " +
      state;
  const std::string table = database.evaluate(arguments);
  CHECK(lines_with(table, "| our, 0 iterations | 40 |").size() == 2);
  CHECK(lines_with(table, "| our, 2 iterations | 40 |").size() == 2);
  CHECK(lines_with(table, "| lc | 40 | 0.2 |").size() == 1);
  CHECK(lines_with(table, "our, 2 iterations, data 40, outliers 0.2: at most ").size() == 1);
  // Two shares of outliers, two seeds, and 0 iterations, 2 iterations and lc.
  CHECK(lines_with(scratch::get(state), "result").size() == 12);

  // As if it had been killed while it wrote the last one.
  const std::string kept = scratch::get(state);
  scratch::put(state, kept.substr(0, kept.size() - 20));
  const auto rows = read_json(database.evaluate(arguments + " --json"));
  CHECK(lines_with(scratch::get(state), "\"result\"").size() == 13);
  REQUIRE(rows.size() == 6);
  CHECK(rows[1]["method"] == "our");
  CHECK(rows[1]["iterations"] == 2);
  CHECK(rows[4]["method"] == "lc");
  CHECK_FALSE(rows[4].contains("iterations"));
  REQUIRE(rows[4]["results"].size() == 2);
  CHECK(rows[4]["results"][1]["material"] == "b");
  CHECK(rows[4]["results"][1]["seed"] == 2);
  CHECK(rows[4]["results"][0]["delta_e_env"] != rows[4]["results"][1]["delta_e_env"]);
}

TEST_CASE("noell-table1: fewer materials to combine, and the time of an iteration") {
  const synthetic_database database;
  const std::string arguments = "noell-table1 --materials b --methods our rbf --data 40 --outliers 0 --iterations 0 2 ";
  const std::string table = database.evaluate(arguments + "--basis 2 4");
  CHECK(lines_with(table, "| our, 2 materials, 0 iterations | 40 |").size() == 1);
  CHECK(lines_with(table, "| our, 4 materials, 2 iterations | 40 |").size() == 1);
  CHECK(lines_with(table, "| our, 4 materials | 40 | 0.0 | ").size() == 1);  // seconds
  CHECK(lines_with(table, "| rbf | 40 |").size() == 1);

  // All four others are what is combined anyway.
  const auto error = [&](const std::string& basis, std::size_t row) {
    const auto rows = read_json(database.evaluate(arguments + "--json " + basis));
    return rows[row]["results"][0]["delta_e_env"].get<double>();
  };
  CHECK(error("--basis 4", 1) == error("", 1));
  CHECK(error("--basis 2", 1) != error("", 1));

  const auto refused =
      gonio_papers("noell-table1 --materials b --data 40 --basis 5 --networks " + database.at("n.npy"));
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("--basis 5 needs as many other materials, there are 4") != std::string::npos);
}

TEST_CASE("noell-measured: a spectral measurement is judged where it was not used") {
  const synthetic_database database;
  std::string text = "3\n450 550 650\n";
  for (int i = 0; i < 60; ++i) text += std::to_string(0.02 * i) + " 0 " + std::to_string(0.6) + " 2 .1 .2 .3\n";
  scratch::put(database.at("paint.brdf"), text);
  const std::string arguments = "noell-measured --data 0.5 --samples " + database.at("paint.brdf");
  const auto rows = read_json(database.evaluate(arguments + " --json"));
  REQUIRE(rows.size() == 6);
  CHECK(rows[0]["name"] == "paint");
  CHECK(rows[0]["method"] == "our");
  CHECK(rows[0]["samples"] == 30);
  CHECK(rows[3]["outlier_ratio"] == 0.2);
  CHECK(rows[4]["method"] == "printed");
  CHECK(rows[5]["method"] == "lc");
  for (const auto& row : rows) CHECK(row["log_error"].get<double>() < 2.0);

  const auto rivals = read_json(database.evaluate(arguments + " --json --outliers 0 --methods lc rbf pull-push"));
  REQUIRE(rivals.size() == 3);
  CHECK(rivals[0]["log_error"] == rows[2]["log_error"]);
  CHECK(rivals[1]["method"] == "rbf");
  CHECK(rivals[2]["method"] == "pull-push");
  for (const auto& row : rivals) CHECK(row["log_error"].get<double>() < 5.0);

  const auto everything = gonio_papers("noell-measured --data 1 --networks " + database.at("n.npy") + " --samples " +
                                       database.at("paint.brdf"));
  CHECK(everything.exit_code == 2);
  CHECK(everything.output.find("--data below 1") != std::string::npos);
}

TEST_CASE("noell-corrections: as printed and ours, by two solvers") {
  const std::string table = synthetic_database().evaluate("noell-corrections");
  CHECK(lines_with(table, "| as printed | NNLS |").size() == 1);
  CHECK(lines_with(table, "| gonio's default | least squares |").size() == 1);
}

TEST_CASE("noell-table1: radial basis functions have the same error whether cases share their equations or not") {
  const synthetic_database database;
  const auto rows_of = [&](const std::string& outliers) {
    return read_json(
        database.evaluate("noell-table1 --materials b --methods rbf --data 2000 --json --outliers " + outliers));
  };
  const auto both = rows_of("0 0.2"), alone = rows_of("0.2");
  const auto error = [](const auto& row) { return row["results"][0]["delta_e_env"].template get<double>(); };
  CHECK(error(both[1]) == doctest::Approx(error(alone[0])).epsilon(1e-6));
  CHECK(error(both[0]) < error(both[1]));
}

TEST_CASE("noell-gap: a row for each method and source of outliers, at two exposures") {
  const synthetic_database database;
  const std::string light = database.at("light.hdr");
  gonio::io::write_hdr(light, gonio::uniform_image(8, 16, gonio::rgb::Constant(0.5)));
  const std::string state = database.at("state"), arguments =
                                                      "noell-gap --materials b --methods lc pull-push "
                                                      "--data 0.001 --outliers 0.2 --environment " +
                                                      light + " --state " + state;
  const std::string table = database.evaluate(arguments);
  CHECK(lines_with(table, "| lc | outliers from random directions |").size() == 2);
  CHECK(lines_with(table, "| pull-push | samples and outliers of random angles |").size() == 2);
  CHECK(lines_with(table, "| lc | weights of any sign, outliers from valid cells |").size() == 2);

  // Six sources of outliers by two metrics, weights of any sign, and six sources of the other method.
  const std::string kept = scratch::get(state);
  CHECK(lines_with(kept, "result").size() == 19);
  CHECK(database.evaluate(arguments) == table);
  CHECK(lines_with(scratch::get(state), "result").size() == 19);
}

TEST_CASE("noell-figures: each is drawn") {
  const synthetic_database database;
  const std::string light = database.at("light.hdr"), image = database.at("figure.png");
  gonio::io::write_hdr(light, gonio::uniform_image(8, 16, gonio::rgb::Constant(0.5)));
  for (const std::string figure : {"2", "3"}) {
    const std::string printed = database.evaluate("noell-figures --data 0.002 --material b --environment " + light +
                                                  " --figure " + figure + " -o " + image);
    CHECK(lines_with(printed, "| 1 | a |").size() == (figure == "2" ? 1 : 0));
    CHECK(lines_with(printed, "| our | ").size() == (figure == "3" ? 1 : 0));
    REQUIRE(std::filesystem::exists(image));
    std::filesystem::remove(image);
  }
  const auto refused = gonio_papers("noell-figures --figure 5 --networks " + database.at("n.npy"));
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("--figure 5 needs --table FILE") != std::string::npos);
}
