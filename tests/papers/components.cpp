/// gonio-papers components on a few synthetic materials.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/io/images/image.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

TEST_CASE("components, mapped and not: shares of the variance, where they are, and how they look") {
  const scratch::folder folder;
  write_synthetic_networks(folder, {"a", "b", "c", "d", "e", "f"});
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const std::string components = "components --thin 9 20 --count 3 --networks " + at("n.npy");
  const auto printed = gonio_papers(components + " --json --size 16 --image " + at("slices.png"));
  REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
  const auto result = read_json(printed.output);
  CHECK(result["materials"] == 6);
  CHECK(result["cells_in_peak"].get<double>() > 0.0);
  CHECK(result["cells_in_peak"].get<double>() < 0.5);
  for (const char* way : {"mapped", "as it is"}) {
    const auto& shares = result[way]["shares_of_variance"];
    REQUIRE(shares.size() == 3);
    CHECK(std::is_sorted(shares.rbegin(), shares.rend()));
    CHECK(shares[0].get<double>() + shares[1].get<double>() + shares[2].get<double>() <= 1.0 + 1e-9);
    for (const double share : result[way]["shares_in_peak"]) {
      CHECK(share >= 0.0);
      CHECK(share <= 1.0);
    }
  }
  const gonio::image slices = gonio::io::read_png(at("slices.png"));
  CHECK(slices.shape(0) > 2 * (16 + 2 * 8 + 14));
  CHECK(slices.shape(1) == 4 * 16 + 5 * 8);

  const auto table = gonio_papers(components);
  REQUIRE_MESSAGE(table.exit_code == 0, table.output);
  CHECK(table.output.find("Principal components of 6 materials x 3 channels") != std::string::npos);
  CHECK(table.output.find("\n| 3 | ") != std::string::npos);
  CHECK(gonio_papers("components --count 0 --networks " + at("n.npy")).exit_code == 2);
}
