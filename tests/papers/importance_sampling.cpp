/// gonio-papers importance-sampling.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "papers_tool.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/render/environment_map.hpp>

#include <doctest/doctest.h>

#include <string>

namespace {

struct gold_and_sky {
  scratch::folder folder;
  std::string table = (folder / "gold.binary").string(), sky = (folder / "sky.hdr").string();

  gold_and_sky() {
    gonio::io::write_merl(table, gonio::tabulate(gonio::model::formula_material("gold-metal"), gonio::valid_cells()));
    gonio::io::write_hdr(sky, gonio::render::environment_map::of(gonio::render::formula_environment{}, 16).image());
  }
};

}  // namespace

TEST_CASE("gonio-papers importance-sampling: metal gains") {
  const gold_and_sky given;
  const auto result = gonio_papers("importance-sampling " + given.table + " --environment " + given.sky +
                                   " --points 200 --draws 100 --json");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto ratios = read_json(result.output)["gold"];
  for (const char* light : {"white", "formula", "sky"}) CHECK(ratios[light].get<double>() > 4.0);
  const auto table = gonio_papers("importance-sampling " + given.table + " --points 20 --draws 20");
  CHECK(table.output.find("| gold |") != std::string::npos);
}

TEST_CASE("gonio-papers importance-sampling: nothing to sample") {
  const auto none = gonio_papers("importance-sampling");
  CHECK(none.exit_code == 2);
  CHECK(none.output.find("--networks") != std::string::npos);
}
