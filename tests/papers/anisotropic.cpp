/// gonio-papers anisotropic.

#include "../json.hpp"
#include "papers_tool.hpp"

#include <doctest/doctest.h>

TEST_CASE(
    "gonio-papers anisotropic: a brushed GGX is recovered from 200 noisy samples, an isotropic one looks different") {
  const auto result = gonio_papers("anisotropic --draws 3 --samples 200 --models ggx-anisotropic ggx --json");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto rows = read_json(result.output);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0]["slopes"]["worst"].get<double>() < 0.05);
  CHECK(rows[0]["rotation"]["worst"].get<double>() < 3.0);
  CHECK(rows[0]["delta_e"]["worst"].get<double>() < 1.0);
  CHECK(rows[1]["delta_e"]["median"].get<double>() > 3.0 * rows[0]["delta_e"]["median"].get<double>());
  const auto table = gonio_papers("anisotropic --draws 1 --samples 50 --models ward-anisotropic");
  CHECK(table.output.find("| ward-anisotropic | 50 | | |") != std::string::npos);
  const auto refused = gonio_papers("anisotropic --models brushed --draws 1");
  CHECK(refused.exit_code == 2);
  CHECK(refused.output.find("no lobe named 'brushed'") != std::string::npos);
}
