/// The experiments on shapes on one synthetic ear and a model of few.

#include "papers_tool.hpp"

#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

namespace {

/// The cells of the first row that begins with a name.
std::vector<std::string> row_of(const std::string& table, const std::string& name) {
  const std::string start = "| " + name + " | ";
  const auto begin = table.find(start);
  REQUIRE_MESSAGE(begin != std::string::npos, name, " is not in ", table);
  std::istringstream line(table.substr(begin + start.size(), table.find('\n', begin) - begin - start.size()));
  std::vector<std::string> cells;
  for (std::string cell; std::getline(line, cell, '|');) cells.push_back(cell);
  return cells;
}

}  // namespace

TEST_CASE("shape-fields: holes filled by a random field, a membrane, a thin plate and gonio") {
  const auto result = gonio_papers("shape-fields --shapes 12 --ears 1 --spacing 1");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto means = row_of(result.output, "mean of absolute");
  REQUIRE(means.size() == 4);
  // The hole is some 10 mm wide.
  for (const std::string& mean : means) {
    CHECK(std::stod(mean) > 0.01);
    CHECK(std::stod(mean) < 1.0);
  }
  // The mean of one ear is that ear's.
  CHECK(row_of(result.output, "1")[1].find(means[1]) != std::string::npos);
}

TEST_CASE("shape-poses: a pose that is held costs what it is off, one that is fitted does not") {
  const auto result = gonio_papers("shape-poses --shapes 12 --ears 1");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto right = row_of(result.output, "0 degrees, 0 mm"), off = row_of(result.output, "4 degrees, 1 mm"),
             far_off = row_of(result.output, "16 degrees, 4 mm");
  REQUIRE(right.size() == 5);
  // recover: held, fitted. Algorithm 1: held.
  CHECK(std::stod(off[0]) > 1.4 * std::stod(right[0]));
  CHECK(std::stod(off[1]) == doctest::Approx(std::stod(right[1])).epsilon(0.02));
  CHECK(std::stod(off[2]) > 1.4 * std::stod(right[2]));
  // A pose far off is refused where it is held.
  CHECK(far_off[0].find("1 refused") != std::string::npos);
  CHECK(std::stod(far_off[1]) == doctest::Approx(std::stod(right[1])).epsilon(0.02));
}

TEST_CASE("shape-causes: ten rounds of Algorithm 1 end before they converge") {
  const auto result = gonio_papers(
      "shape-causes --shapes 60 --ears 2 --rows 'ten rounds' 'until convergence' 'true positions of the "
      "seen vertices' gonio");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  CHECK(result.output.find("smoothed") == std::string::npos);
  // Signed and absolute in the hole, then of all vertices.
  const auto ten = row_of(result.output, "ten rounds"), converged = row_of(result.output, "until convergence"),
             known = row_of(result.output, "true positions of the seen vertices"),
             ours = row_of(result.output, "gonio");
  REQUIRE(ten.size() == 4);
  CHECK(std::stod(converged[3]) < 0.5 * std::stod(ten[3]));
  CHECK(std::stod(known[0]) < 0.5 * std::stod(ten[0]));
  CHECK(std::stod(ours[1]) < std::stod(converged[1]));
}
