/// gonio-papers directions on a few synthetic materials.

#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

TEST_CASE("sets of directions are judged, kept, and written") {
  const scratch::folder folder;
  std::vector<std::string> names = gonio::nielsen_test_materials();
  for (const char* name : {"a", "b", "c", "d"}) names.emplace_back(name);
  write_synthetic_networks(folder, names);
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const auto evaluate = [&](const std::string& arguments) {
    return gonio_papers("directions --thin 3 5 --networks " + at("n.npy") + " " + arguments);
  };

  const std::string points = "-n 5 --sets published industry random --state " + at("state");
  const auto table = evaluate(points + " --write " + at("sets"));
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  for (const char* set : {"published", "industry", "random"})
    CHECK(table.output.find("| 5 | " + std::string(set) + " |") != std::string::npos);
  CHECK(gonio::io::read_direction_pairs(folder / "sets" / "point-5-industry.csv").size() == 5);
  const auto kept = [&] {
    const std::string state = scratch::get(folder / "state");
    std::size_t count = 0;
    for (auto found = state.find("\"key\""); found != std::string::npos; found = state.find("\"key\"", found + 1))
      ++count;
    return count;
  };
  CHECK(kept() == 3);
  CHECK(evaluate(points).output == table.output);
  CHECK(kept() == 3);

  const auto again = evaluate("-n 7 --sets published --files " + at("sets/point-5-industry.csv"));
  REQUIRE_MESSAGE(again.exit_code == 0, again.output);
  CHECK(again.output.find("| 5 | point-5-industry.csv |") != std::string::npos);

  const auto rms = [](const std::string& output) {
    return read_json(output)[0]["result"]["errors"]["mapped_rms"].get<double>();
  };
  const auto clean = evaluate(points + " --json"),
             defects = evaluate("-n 5 --sets published --noise 0.05 --misplaced 2 --json");
  REQUIRE_MESSAGE(defects.exit_code == 0, defects.output);
  CHECK(rms(defects.output) != rms(clean.output));
  const auto automatic = evaluate("-n 5 --sets published --reconstruction-eta 40 --json");
  REQUIRE_MESSAGE(automatic.exit_code == 0, automatic.output);
  CHECK(rms(automatic.output) != rms(clean.output));

  const auto images =
      evaluate("--geometry near-field -n 1 --step 40 --sets expected-error --noise 0.02 --misplaced 0.5 --json");
  REQUIRE_MESSAGE(images.exit_code == 0, images.output);
  CHECK(read_json(images.output)[0]["result"]["samples"].get<int>() > 100);

  // A set that was written is what was found.
  const std::string found = "--geometry near-field -n 1 --step 40 --sets expected-error --json";
  const auto once = evaluate(found + " --write " + at("sets"));
  REQUIRE_MESSAGE(once.exit_code == 0, once.output);
  const auto from_file = evaluate("--geometry near-field --step 40 --sets published --json --files " +
                                  at("sets/near-field-25-1-expected-error.csv"));
  REQUIRE_MESSAGE(from_file.exit_code == 0, from_file.output);
  CHECK(rms(from_file.output) == rms(once.output));

  const std::string off = "-n 5 --sets published --misplaced 2 --json";
  const auto trusting = evaluate(off), expecting = evaluate(off + " --expected-misplacement 2");
  REQUIRE_MESSAGE(expecting.exit_code == 0, expecting.output);
  CHECK(rms(expecting.output) != rms(trusting.output));
  const auto searched = evaluate("-n 3 --sets expected-error --expected-misplacement 2 --json");
  REQUIRE_MESSAGE(searched.exit_code == 0, searched.output);
  const std::string shots = "--geometry near-field -n 1 --step 40 --sets expected-error --misplaced 2 --json";
  const auto refined = evaluate(shots + " --expected-misplacement 2");
  REQUIRE_MESSAGE(refined.exit_code == 0, refined.output);
  CHECK(rms(refined.output) != rms(evaluate(shots).output));

  for (const char* arguments : {"--geometry sphere --misplaced 1", "--geometry sphere --expected-misplacement 1",
                                "--reconstruction-eta gcv --expected-misplacement 1", "--files none.csv"}) {
    CAPTURE(arguments);
    const auto refused = evaluate(arguments);
    CHECK(refused.exit_code == 2);
    CHECK(std::ranges::count(refused.output, '\n') == 1);
  }
}
