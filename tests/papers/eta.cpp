/// gonio-papers eta on a few synthetic materials.

#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <doctest/doctest.h>

#include <string>

TEST_CASE("chosen penalties against the best in hindsight") {
  const scratch::folder folder;
  std::vector<std::string> names = gonio::nielsen_test_materials();
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) names.emplace_back(name);
  write_synthetic_networks(folder, names);
  const std::string evaluate = "eta --thin 3 5 --networks " + (folder / "n.npy").string() + " ";

  const auto printed = gonio_papers(evaluate + "-n 5 --noise 0 0.3 --repetitions 2 --json");
  REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
  const auto rows = read_json(printed.output);
  REQUIRE(rows.size() == 4);  // two sets of directions, two noises
  for (const auto& row : rows) {
    CAPTURE(row.dump());
    const auto ratio = [&](const char* way) { return row[way]["ratio"].get<double>(); };
    CHECK(ratio("best_of_each") <= 1.0);
    for (const char* way : {"forty", "stated_noise", "unknown_noise", "unbounded_gcv"})
      CHECK(ratio(way) >= ratio("best_of_each") - 1e-3);  // but for what lies between the grid's etas
    CHECK(row["unknown_noise"]["eta"] >= 0.999 * row["plausible"][0].get<double>());
    CHECK(row["unknown_noise"]["eta"] <= 1.001 * row["plausible"][1].get<double>());
    CHECK(row["stated_noise"]["eta"].get<double>() ==
          doctest::Approx(row["plausible"][row["noise"] == 0.0 ? 0 : 1].get<double>()));
  }
  CHECK(rows[1]["best"]["rms"] > rows[0]["best"]["rms"]);

  const auto table = gonio_papers(evaluate + "-n 5 --noise 0.1 --sets published --repetitions 1");
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(table.output.find("\n| published | 5 | 10 % | ") != std::string::npos);
  const auto refused = gonio_papers(evaluate + "-n 21 --sets expected-error");
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("point-21-expected-error.csv") != std::string::npos);
}
