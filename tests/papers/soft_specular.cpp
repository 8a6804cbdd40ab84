/// gonio-papers soft-specular on a few synthetic materials.

#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <doctest/doctest.h>

#include <string>

namespace {

/// A folder with networks of random weights: the ten test materials, and six to learn from.
class synthetic_database {
 public:
  synthetic_database() {
    std::vector<std::string> names = gonio::nielsen_test_materials();
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) names.emplace_back(name);
    write_synthetic_networks(folder_, names);
  }

  [[nodiscard]] auto evaluate(const std::string& arguments) const {
    return gonio_papers("soft-specular --thin 3 5 --networks " + (folder_ / "n.npy").string() + " " + arguments);
  }

 private:
  scratch::folder folder_;
};

std::size_t count_of(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("one prior against a soft and a specular one") {
  const synthetic_database database;
  const auto table = database.evaluate("--counts 1 2");
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(table.output.find("6 learned, eta = 40; by contrast 3 are soft (eta = 20.0) and 3 specular") !=
        std::string::npos);
  CHECK(count_of(table.output, "\n| 1 | ") == 6);  // one direction does not tell soft from specular
  CHECK(count_of(table.output, "\n| 2 | ") == 7);
  CHECK(count_of(table.output, "switch by the samples") == 1);

  const auto printed = database.evaluate("--counts 2 --json --eta-of-halves 40");
  REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
  const auto all = read_json(printed.output);
  CHECK(all["soft_materials"].size() == 3);
  CHECK(all["specular_materials"].size() == 3);
  const auto& rows = all["directions"]["2"];
  const auto rms = [&](const char* row) { return rows[row]["mean"]["mapped_rms"].get<double>(); };
  const auto seen = [&](const char* row) { return rows[row]["mean"]["delta_e_env"].get<double>(); };
  for (const char* row : {"soft prior", "specular prior", "switch by the samples", "switch by the whole table"}) {
    CHECK(rms("oracle: the better rms") <= rms(row));
    CHECK(seen("oracle: the better Delta E env") <= seen(row));
    CHECK(rows[row]["materials"].size() == 10);
  }

  const auto refused = database.evaluate("--threshold 1000");
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("all 6 materials are soft") != std::string::npos);
}
