/// The experiments on simulated photographs and on scattered readings, with materials of two families.

#include "measured_database.hpp"

#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

namespace {

const std::string directions = std::string(GONIO_SOURCE_DIR) + "/examples/data/directions/";

/// What an experiment on photographs of one of its materials prints.
std::string photograph(const measured_database& database, const std::string& arguments) {
  const auto result = gonio_papers(arguments + " --names second_2 " + database.options());
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
  return result.output;
}

/// The numbers of the first row that names a material, none of its cells that hold something else.
std::vector<double> numbers_of(const std::string& table, const std::string& material) {
  const auto begin = table.find("| " + material + " |");
  REQUIRE_MESSAGE(begin != std::string::npos, material, " is not in ", table);
  std::istringstream line(table.substr(begin, table.find('\n', begin) - begin));
  std::vector<double> numbers;
  for (std::string cell; std::getline(line, cell, '|');) {
    std::istringstream text(cell);
    if (double number = 0.0; text >> number) numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

TEST_CASE("near-field-photographs: raw frames of a flat sample to a BRDF, and what is done is not done again") {
  const measured_database database;
  const std::string arguments = "near-field-photographs --pixels 32 --block 8 --directions " + directions +
                                "near-field-25-2-expected-error.csv --state " + database.at("state");
  const std::string table = photograph(database, arguments);
  // Samples, two errors in percent, four Delta E, the last over the first; then the coverage of 68 and 95 % intervals.
  const auto numbers = numbers_of(table, "second_2");
  REQUIRE(numbers.size() == 13);
  CHECK(numbers[11] <= numbers[12]);
  CHECK(numbers[0] > 10.0);
  CHECK(numbers[1] < 50.0);
  CHECK(numbers[6] == doctest::Approx(numbers[7] * numbers[3]).epsilon(0.03));
  CHECK(numbers[7] < 3.0);
  const std::string kept = scratch::get(database.at("state"));
  CHECK(photograph(database, arguments) == table);
  CHECK(scratch::get(database.at("state")).find("\"second_2\"", kept.size()) == std::string::npos);

  const auto refused = gonio_papers("near-field-photographs --names third_1 --directions " + directions +
                                    "near-field-25-2-expected-error.csv " + database.options());
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("has no material third_1") != std::string::npos);
}

TEST_CASE("sphere-photograph: photographs of a sphere under published lights to a BRDF") {
  const measured_database database;
  const std::string table = photograph(database, "sphere-photograph --pixels 80 --published 2");
  // Photographs, pixels, samples, by how many pixels the centre is off, an error in percent, two Delta E and their
  // ratio.
  const auto numbers = numbers_of(table, "second_2");
  REQUIRE(numbers.size() == 13);
  CHECK(numbers[11] <= numbers[12]);
  CHECK(numbers[0] == 2.0);
  CHECK(numbers[2] <= numbers[1]);
  CHECK(numbers[3] < 1.5);
  CHECK(numbers[6] == doctest::Approx(numbers[7] * numbers[5]).epsilon(0.03));
}

TEST_CASE("scattered-samples: weights of neighbours, judged by samples that are left out") {
  const measured_database database;
  const auto result =
      gonio_papers("scattered-samples --random 50 --left-out 40 --materials " + database.at("measured"));
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto row = result.output.find("| a 1.0, b 0.15 |");
  REQUIRE(row != std::string::npos);
  const double error = std::stod(result.output.substr(row + 17));
  CHECK(error > 0.0);
  CHECK(error < 5.0);
}
