/// gonio-papers streamed-learning, of fewer materials.

#include "../io/scratch.hpp"
#include "papers_tool.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// The numbers of the line of a table that starts with a number of materials.
std::vector<double> numbers_of(const std::string& output, const std::string& materials) {
  const std::size_t begin = output.find("\n| " + materials + " |");
  REQUIRE(begin != std::string::npos);
  std::istringstream line(output.substr(begin + 1, output.find('\n', begin + 1) - begin - 1));
  std::vector<double> numbers;
  for (std::string bar; line >> bar;)
    if (double number = 0.0; line >> number)
      numbers.push_back(number);
    else
      break;
  return numbers;
}

}  // namespace

TEST_CASE("many materials are learned in less memory than their tables take") {
  const scratch::folder here;
  const auto result = gonio_papers(
      "streamed-learning --materials 20 --materials 2000 --compared 20 --grown 20 --scratch " + here.path().string());
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  CHECK(result.output.find("nan") == std::string::npos);
  CHECK(result.output.find("expanded to 300 columns") != std::string::npos);
  const auto few = numbers_of(result.output, "20"), many = numbers_of(result.output, "2000");
  REQUIRE(few.size() == 7);
  REQUIRE(many.size() == 7);
  CHECK(many[1] > 800.0);     // MB of tables
  CHECK(many[2] == many[1]);  // all in the scratch file
  CHECK(few[2] == 0.0);
  CHECK(many[6] < 700.0);  // MB of memory at most
  CHECK(result.output.find("in a random subspace") != std::string::npos);
  CHECK(std::filesystem::is_empty(here.path()));
}
