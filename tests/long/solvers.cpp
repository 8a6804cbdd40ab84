#include "../solve/hard_problems_check.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

TEST_CASE("16 families x 6,300 random problems: every solver is right from the rows, or refuses") {
  std::printf("| family | worst KKT residual | objectives apart | refused: NNLS | least squares | others |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (int what = 0; what < hard_problems::families; ++what) {
    std::map<std::string, hard_problems::tally> tallies;
    for (unsigned seed = 0; seed < 6300; ++seed)
      hard_problems::check(static_cast<hard_problems::family>(what), seed, tallies);
    double violation = 0.0, apart = 0.0;
    int others = 0;
    for (const auto& [solver, sum] : tallies) {
      CAPTURE(solver);
      CAPTURE(sum.first_wrong);
      CHECK(sum.wrong == 0);
      violation = std::max(violation, sum.violation);
      apart = std::max(apart, sum.disagreement);
      const bool shown = solver.starts_with("nnls") || solver == "quadratic_program" ||
                         solver == "non_negative_lasso, no penalty" || solver == "least_squares";
      if (!shown) others += sum.refused;
    }
    std::printf("| %s | %.0e | %.0e | %d | %d | %d |\n", hard_problems::names[static_cast<std::size_t>(what)],
                violation, apart, tallies["nnls"].refused, tallies["least_squares"].refused, others);
    std::fflush(stdout);
  }
}
