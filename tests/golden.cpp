#include "golden.hpp"

#include "json.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

namespace {

std::ifstream open(const std::string& name) {
  std::ifstream file(std::string(GONIO_TEST_DATA) + "/" + name);
  REQUIRE_MESSAGE(file.good(), "missing test data ", name);
  return file;
}

}  // namespace

golden_columns golden_csv(const std::string& name) {
  std::ifstream file = open(name);
  std::string line, field;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::istringstream fields(line); std::getline(fields, field, ',');) names.push_back(field);
  golden_columns columns;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    for (const std::string& column : names) {
      REQUIRE(std::getline(fields, field, ','));
      columns[column].push_back(std::stod(field));
    }
  }
  return columns;
}

nlohmann::json read_json(const std::string& text) {
  std::size_t begin = 0;
  while (text.compare(begin, 16, "gonio: warning: ") == 0) begin = text.find('\n', begin) + 1;
  return nlohmann::json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end());
}

nlohmann::json golden_json(const std::string& name) {
  std::ifstream file = open(name);
  return nlohmann::json::parse(file);
}
