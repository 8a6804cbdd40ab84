/// gonio-papers design on networks and materials that are made up.

#include "measured_database.hpp"

#include <doctest/doctest.h>

#include <string>

TEST_CASE("design: materials measured in designed, random and adaptive directions") {
  const measured_database database;
  const std::string options = "design -n 1 3 --first 2 --sets 2 " + database.options() + " --methods random ";
  const std::string state = " --state " + database.at("state");
  const auto table = gonio_papers(options + "designed worst-case adaptive" + state);
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(table.output.find("over 3 materials") != std::string::npos);
  for (const char* row :
       {"| 1 | random | ", "| 1 | designed | ", "| 3 | random | ", "| 3 | designed | ", "| 3 | worst-case | ",
        "| 3 | adaptive | ", "| 3 | criterion chosen by the other families | "})
    CHECK_MESSAGE(table.output.find(row) != std::string::npos, row, " is not in ", table.output);
  // An adaptive scan of two first directions has no row for one.
  CHECK(table.output.find("| 1 | adaptive |") == std::string::npos);
  CHECK(table.output.find("nan") == std::string::npos);

  // What is done is read again, and is the same when it is computed again with one thread.
  CHECK(gonio_papers(options + "designed worst-case adaptive" + state).output == table.output);
  const auto alone = gonio_papers(options + "designed --threads 1");
  const auto row_of = [](const std::string& output) {
    const auto begin = output.find("| 3 | designed |");
    return output.substr(begin, output.find('\n', begin) - begin);
  };
  CHECK(row_of(alone.output) == row_of(table.output));

  check_refusal(gonio_papers("design -n 1 3 --first 4 " + database.options()), {"--first", "--counts"});
  check_refusal(gonio_papers("design -n 0 " + database.options()), {"--counts", "at least 1"});
}
