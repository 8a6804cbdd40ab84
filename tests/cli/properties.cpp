/// gonio properties of tables and samples.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/io/materials/merl.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

using gonio::rgb;

namespace {

/// Returns a file's properties by name.
auto properties(const std::filesystem::path& file, const std::string& options = "") {
  const auto result = gonio_tool("properties --json " + file.string() + options);
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  return read_json(result.output);
}

gonio::brdf_table grey_table(double albedo) {
  return gonio::tabulate(gonio::model::lambertian{.albedo = rgb::Constant(albedo)}, gonio::valid_cells());
}

bool says(const std::string& arguments, const char* words) {
  return gonio_tool("properties " + arguments).output.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("a table that keeps all, and one that breaks what a table can break") {
  const scratch::folder folder;
  const auto file = folder / "t.binary";
  gonio::brdf_table table = grey_table(0.5);
  gonio::io::write_merl(file, table);
  const auto kept = properties(file);
  CHECK(kept["kind"] == "MERL table");
  CHECK(kept["energy"]["kept"] == true);
  CHECK(kept["energy"]["largest_albedo"].get<double>() == doctest::Approx(0.5).epsilon(0.01));
  CHECK(kept["energy"]["by_angle"].size() == 19);
  CHECK(kept["negative"]["cells"] == 0);
  CHECK(kept["tails"]["largest_rise"].get<double>() < 1e-3);
  CHECK(kept["reciprocity"]["kept_by"] == "the format");
  CHECK(says(file.string(), "| energy | kept: an albedo of up to 0.50"));
  // A grey diffuser reflects the same in all directions.
  CHECK(kept["readings"]["luminous_reflectance_8"].get<double>() == doctest::Approx(0.5).epsilon(0.01));
  CHECK(kept["readings"]["gloss"]["60"].get<double>() == doctest::Approx(1.2426).epsilon(0.005));
  for (const auto& each : kept["readings"]["colours"])
    CHECK(each["L"].get<double>() == doctest::Approx(76.07).epsilon(1e-3));
  CHECK(says(file.string(), "| gloss at 20, 60, 85 degrees (ISO 2813) | 0.6, 1.2, 0.0 |"));

  table = grey_table(1.1);
  const gonio::grid& over = table.cells().grid();
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) {
    const auto index = over.cell(table.cells().linear(cell));
    if (index.theta_h == 0) table.set(cell, 3.0 * table.at(cell));
    if (index.theta_h == 50 && index.theta_d == 10) table.set(cell, 2.0 * table.at(cell));
  }
  table.set(1000, rgb(0.1, -0.5, 0.1));
  gonio::io::write_merl(file, table);
  const auto broken = properties(file);
  CHECK(broken["energy"]["kept"] == false);
  CHECK(broken["energy"]["largest_albedo"].get<double>() > 1.09);
  CHECK(broken["negative"]["cells"] == 1);
  CHECK(broken["negative"]["lowest"].get<double>() == doctest::Approx(-0.5));
  CHECK(broken["tails"]["largest_rise"].get<double>() == doctest::Approx(1.0).epsilon(0.01));
  CHECK(broken["tails"]["theta_d"].get<double>() == doctest::Approx(10.5));
  CHECK(says(file.string(), "| energy | broken: an albedo of up to 1.1"));
  CHECK(says(file.string(), "| negative values | 1 of "));
}

TEST_CASE("samples that break reciprocity and isotropy, and by how much") {
  const scratch::folder folder;
  const auto file = folder / "s.csv";
  scratch::put(file,
               "theta_i,phi_i,theta_o,phi_o,r,g,b\n"
               "30,0,50,180,1,1,1\n"
               "50,0,30,180,1,0.9,1\n"   // light and viewer exchanged, and rotated
               "30,90,50,270,1,1,0.8\n"  // rotated
               "30,0,50,180,1,1,0.99\n"  // repeated
               "10,0,70,30,-0.1,1,1\n");
  const auto found = properties(file);
  CHECK(found["kind"] == "samples");
  CHECK(found["negative"]["samples"] == 1);
  CHECK(found["negative"]["sample"] == 5);
  CHECK(found["repeats"]["pairs"] == 1);
  CHECK(found["repeats"]["worst"].get<double>() == doctest::Approx(0.01));
  CHECK(found["reciprocity"]["pairs"] == 3);
  CHECK(found["reciprocity"]["worst"].get<double>() == doctest::Approx(0.2));
  CHECK(found["isotropy"]["pairs"] == 2);
  CHECK(found["isotropy"]["worst"].get<double>() == doctest::Approx(0.2));
  CHECK(found["isotropy"]["samples"][0] == 1);
  CHECK(found["isotropy"]["samples"][1] == 3);
  CHECK(says(file.string(), "| isotropy | 2 pairs turned about the normal, off by"));
  CHECK(says(file.string(), "| energy | not known"));

  // The tolerance decides which samples form a pair.
  scratch::put(file, "theta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,50,180,1,1,1\n51,0,30,180,1,1,1\n");
  CHECK(properties(file)["reciprocity"]["pairs"] == 0);
  CHECK(properties(file, " --tolerance 1.5")["reciprocity"]["pairs"] == 1);
  CHECK(says(file.string(), "| reciprocity | no samples with light and viewer swapped |"));
}

TEST_CASE("files of laboratories") {
  const std::filesystem::path shared(GONIO_SHARED_DATA);
  if (!std::filesystem::exists(shared / "cornell/garnet_red.brdf")) {
    MESSAGE("skipped: no ../shared/data");
    return;
  }
  // Its directions are irregular, so only a wide tolerance finds pairs.
  CHECK(properties(shared / "cornell/garnet_red.brdf")["reciprocity"]["pairs"] == 0);
  CHECK(properties(shared / "cornell/garnet_red.brdf", " --tolerance 2")["reciprocity"]["pairs"].get<int>() > 20);
  const auto rgl = properties(shared / "rgl-bsdf/cardboard.bsdf");
  CHECK(rgl["kind"] == "RGL material");
  CHECK(rgl["energy"]["kept"] == true);
  CHECK(rgl["reciprocity"]["median"].get<double>() > 0.01);  // real measurements are not exactly reciprocal
}

TEST_CASE("what has no properties is refused in one line") {
  const scratch::folder folder;
  scratch::put(folder / "t.binary", "no table");
  scratch::put(folder / "s.csv", "theta_h,theta_d,phi_d,r,g,b\n1,2,3,nan,1,1\n");
  for (const std::string& arguments :
       std::vector<std::string>{(folder / "t.binary").string(), (folder / "s.csv").string(),
                                (folder / "none.bsdf").string(), "--tolerance 0 x.csv", "--tolerance 1 x.bsdf"}) {
    CAPTURE(arguments);
    const auto result = gonio_tool("properties " + arguments);
    CHECK(result.exit_code == 2);
    CHECK(std::ranges::count(result.output, '\n') == 1);
  }
}
