/// Experiments that leave out each material's family, on synthetic networks and materials.

#include "measured_database.hpp"

#include <doctest/doctest.h>

#include <string>

namespace {

/// Returns the number in a column of the row that begins with `name`.
double number_in(const std::string& output, const std::string& name, int column) {
  std::size_t at = output.find("| " + name + " |");
  REQUIRE_MESSAGE(at != std::string::npos, name, " is not in ", output);
  for (int i = 0; i <= column; ++i) at = output.find('|', at + 1);
  return std::stod(output.substr(at + 1));
}

}  // namespace

TEST_CASE("real-materials: priors can also learn random materials") {
  const measured_database database;
  const std::string options =
      "real-materials --methods default --designed 5 --random 5 --repetitions 1 " + database.options();
  const auto measured = gonio_papers(options), both = gonio_papers(options + " --random-materials 3");
  REQUIRE_MESSAGE(measured.exit_code == 0, measured.output);
  REQUIRE_MESSAGE(both.exit_code == 0, both.output);
  CHECK(both.output.find("priors that also learned 3 random materials") != std::string::npos);
  CHECK(number_in(measured.output, "5 designed", 1) != number_in(both.output, "5 designed", 1));
}

TEST_CASE("model-from-weights: a model is fitted without expanding the reconstruction") {
  const measured_database database;
  const auto table = gonio_papers("model-from-weights --evaluated 200 " + database.options());
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(table.output.find("nan") == std::string::npos);
  const double all = number_in(table.output, "model: fitted to all cells of the reconstruction", 0);
  CHECK(number_in(table.output, "model: fitted to 200 cells of the reconstruction", 0) ==
        doctest::Approx(all).epsilon(0.5));
  // Three components and five networks describe no paint, but the model does.
  CHECK(number_in(table.output, "model: fitted to all cells of the truth", 0) < all);
  CHECK(number_in(table.output, "model: parameters from 8 weights", 0) > 0.0);
}
