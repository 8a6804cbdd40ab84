#include "../solve/hard_problems_check.hpp"

#include <doctest/doctest.h>

#include <cstdio>

TEST_CASE("16 families x 6,300 random problems: every solver is right from the rows, or refuses") {
  for (int what = 0; what < hard_problems::families; ++what) {
    std::map<std::string, hard_problems::tally> tallies;
    for (unsigned seed = 0; seed < 6300; ++seed)
      hard_problems::check(static_cast<hard_problems::family>(what), seed, tallies);
    for (const auto& [solver, sum] : tallies) {
      CAPTURE(solver);
      CAPTURE(sum.first_wrong);
      CHECK(sum.wrong == 0);
      std::printf("%-26s %-32s refused %5d  wrong %5d  violation %8.1e  objectives apart %8.1e  %s\n",
                  hard_problems::names[static_cast<std::size_t>(what)], solver.c_str(), sum.refused, sum.wrong,
                  sum.violation, sum.disagreement, sum.wrong + sum.refused > 0 ? sum.first_wrong.c_str() : "");
    }
  }
}
