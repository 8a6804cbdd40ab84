/// gonio convert: between all kinds of files; refuses other files.

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/materials/mbsdf.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/table_npy.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace {

/// A folder with a small table, and the material tabulated in it.
struct small_files {
  scratch::folder here;
  gonio::model::ggx metal{.alpha = 0.3, .f0 = gonio::rgb(0.9, 0.6, 0.3)};

  small_files() {
    gonio::io::write_merl(path("t.binary"), gonio::tabulate(metal, gonio::valid_cells(gonio::grid({30, 15, 30}))));
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (here / name).string(); }
  void convert(const std::string& from, const std::string& to) const { run("convert " + path(from) + " " + path(to)); }
};

}  // namespace

TEST_CASE("convert: a table becomes a material for renderers, and that a table again") {
  const small_files files;
  files.convert("t.binary", "t.bsdf");
  const auto [material, description, spectra] = gonio::io::read_rgl(files.path("t.bsdf"));
  CHECK(description == "t");
  const gonio::direction wi(0.6, 0, 0.8), wo(-0.48, 0.2, std::sqrt(1.0 - 0.48 * 0.48 - 0.04));
  CHECK((material(wi, wo) / files.metal(wi, wo) - 1.0).abs().maxCoeff() < 0.03);
  files.convert("t.bsdf", "again.bsdf");
  CHECK(scratch::get(files.here / "again.bsdf") == scratch::get(files.here / "t.bsdf"));
  run("convert --spectra " + files.path("t.bsdf") + " " + files.path("spectral.bsdf"));
  const auto spectral = gonio::io::read_rgl(files.path("spectral.bsdf"));
  REQUIRE(spectral.spectra);
  CHECK((spectral.material(wi, wo) / material(wi, wo) - 1.0).abs().maxCoeff() < 1e-4);
  files.convert("t.bsdf", "table.binary");
  const gonio::brdf_table table = gonio::io::read_merl(files.path("table.binary"));
  CHECK(table.cells().grid().extents() == gonio::grid_extents{});
  CHECK((table(wi, wo) / material(wi, wo) - 1.0).abs().maxCoeff() < 0.01);
}

TEST_CASE("commands that read a table accept a renderer's material: its values at the cells of MERL's grid") {
  const small_files files;
  files.convert("t.binary", "t.bsdf");
  files.convert("t.bsdf", "table.binary");
  // Each command does the same to the material and to the table made of it.
  const auto same = [&](const std::string& command, const std::string& output) {
    for (const std::string name : {"t.bsdf", "table.binary"})
      run(command + " " + files.path(name) + " -o " + files.path(name + output));
    CHECK(scratch::get(files.here / ("t.bsdf" + output)) == scratch::get(files.here / ("table.binary" + output)));
  };
  same("sample --count 50 --seed 3", ".csv");
  same("render --size 32", ".png");
  same("fit --model lambert", ".fit.binary");
  run("compare " + files.path("t.bsdf") + " " + files.path("table.binary"));
  refuses("sample --count 5 " + files.path("t.bsdf.csv") + " -o " + files.path("new.csv"),
          {"t.bsdf.csv: holds samples, expected a whole material", "gonio reconstruct"});
}

TEST_CASE("convert: tables and arrays of numpy become one another, by their first bytes") {
  const small_files files;
  files.convert("t.binary", "t.npy");
  files.convert("t.npy", "again.binary");
  CHECK(scratch::get(files.here / "again.binary") == scratch::get(files.here / "t.binary"));
  std::filesystem::rename(files.here / "t.npy", files.here / "misnamed.binary");
  files.convert("misnamed.binary", "third.binary");
  CHECK(scratch::get(files.here / "third.binary") == scratch::get(files.here / "t.binary"));
}

TEST_CASE("convert: a table becomes a measurement of MDL, with the steps that it has or that are asked for") {
  const small_files files;
  files.convert("t.binary", "t.mbsdf");
  const gonio::io::mbsdf_material same = gonio::io::read_mbsdf(files.path("t.mbsdf"));
  CHECK(same.reflection.grid() == gonio::model::polar_grid{15, 30});
  CHECK(same.metadata.at("name") == "t");
  run("convert --polar-steps 40 " + files.path("t.binary") + " " + files.path("fine.mbsdf"));
  const gonio::io::mbsdf_material fine = gonio::io::read_mbsdf(files.path("fine.mbsdf"));
  CHECK(fine.reflection.grid() == gonio::model::polar_grid{40, 80});
  const gonio::direction wi(0.6, 0, 0.8), wo(-0.48, 0.2, std::sqrt(1.0 - 0.48 * 0.48 - 0.04));
  CHECK((fine.reflection(wi, wo) / files.metal(wi, wo) - 1.0).abs().maxCoeff() < 0.03);
  files.convert("fine.mbsdf", "again.mbsdf");
  CHECK(scratch::get(files.here / "again.mbsdf") == scratch::get(files.here / "fine.mbsdf"));
  files.convert("fine.mbsdf", "table.binary");
  const gonio::brdf_table table = gonio::io::read_merl(files.path("table.binary"));
  CHECK((table(wi, wo) / files.metal(wi, wo) - 1.0).abs().maxCoeff() < 0.03);
  const std::string said = run("info " + files.path("fine.mbsdf"));
  for (const char* words : {"kind: MDL measurement", "grid: [40,40,80]", "channels: 3", "\"name\":\"fine\""})
    CHECK(said.find(words) != std::string::npos);
}

TEST_CASE("convert: tables for renderers are as fine as the albedo needs, or as is asked for") {
  const scratch::folder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  run("expand --formula red-paint -o " + at("t.binary"));
  run("convert " + at("t.binary") + " " + at("usual.bsdf"));
  run("convert --albedo-tolerance 0.0001 " + at("t.binary") + " " + at("fine.bsdf"));
  CHECK(std::filesystem::file_size(at("usual.bsdf")) < 7'000'000);
  CHECK(std::filesystem::file_size(at("fine.bsdf")) > 23'000'000);
  refuses("convert --albedo-tolerance 0.1 " + at("t.binary") + " " + at("t.npy"),
          {"--albedo-tolerance needs", ".bsdf"});
}

TEST_CASE("convert: a file for renderers has no negative value unless that is asked for") {
  const small_files files;
  // Red is negative away from the highlight, like a colour outside the gamut.
  gonio::brdf_table table = gonio::io::read_merl(files.path("t.binary"));
  for (float* red = table.values().data(); red < table.values().data() + table.values().size(); red += 3) *red -= 0.1F;
  gonio::io::write_merl(files.path("silk.binary"), table);
  const gonio::direction wi(0.6, 0, 0.8), wo(0.48, 0.2, std::sqrt(1.0 - 0.48 * 0.48 - 0.04));
  REQUIRE(table(wi, wo)[0] < -0.01);
  const auto read = [&](const std::string& name) -> gonio::rgb {
    const std::string path = files.path(name);
    return name.ends_with(".bsdf") ? gonio::io::read_rgl(path).material(wi, wo)
                                   : gonio::io::read_mbsdf(path).reflection(wi, wo);
  };
  for (const std::string kind : {".bsdf", ".mbsdf"}) {
    CAPTURE(kind);
    const std::string said = run("convert " + files.path("silk.binary") + " " + files.path("clipped" + kind));
    CHECK(said.find("cells have a negative value, written as 0. That adds") != std::string::npos);
    CHECK(said.find("--keep-negative") != std::string::npos);
    CHECK(read("clipped" + kind)[0] == doctest::Approx(0.0).epsilon(1e-4));
    CHECK(read("clipped" + kind)[1] == doctest::Approx(table(wi, wo)[1]).epsilon(0.05));
    CHECK(run("convert --keep-negative " + files.path("silk.binary") + " " + files.path("kept" + kind)).empty());
    CHECK(read("kept" + kind)[0] == doctest::Approx(table(wi, wo)[0]).epsilon(0.05));
    // A file of the same kind with negative values is clipped as well; all other values stay.
    run("convert " + files.path("kept" + kind) + " " + files.path("again" + kind));
    CHECK(read("again" + kind)[0] == doctest::Approx(0.0).epsilon(1e-4));
    CHECK(read("again" + kind)[1] == doctest::Approx(read("kept" + kind)[1]).epsilon(1e-5));
    CHECK(run("convert " + files.path("again" + kind) + " " + files.path("third" + kind)).empty());
    CHECK(scratch::get(files.here / ("third" + kind)) == scratch::get(files.here / ("again" + kind)));
  }
  run("convert " + files.path("silk.binary") + " " + files.path("silk_brdf.xompt"));
  CHECK(scratch::get(files.here / "silk_brdf.xompt").find(": -") == std::string::npos);
  // A table keeps its measured values.
  CHECK(run("convert " + files.path("silk.binary") + " " + files.path("silk.npy")).empty());
  refuses("convert --keep-negative " + files.path("silk.binary") + " " + files.path("silk.npy"),
          {"--keep-negative needs", ".bsdf or .mbsdf or .xompt"});
}

TEST_CASE("convert: arrays of half floats are half as large") {
  const small_files files;
  files.convert("t.binary", "t.npy");
  run("convert --half " + files.path("t.binary") + " " + files.path("h.npy"));
  CHECK(2 * (std::filesystem::file_size(files.here / "h.npy") - 128) ==
        std::filesystem::file_size(files.here / "t.npy") - 128);
  files.convert("h.npy", "again.binary");
  const gonio::brdf_table table = gonio::io::read_merl(files.path("again.binary"));
  const gonio::direction wi(0.6, 0, 0.8), wo(-0.48, 0.2, std::sqrt(1.0 - 0.48 * 0.48 - 0.04));
  CHECK((table(wi, wo) / gonio::io::read_merl(files.path("t.binary"))(wi, wo) - 1.0).abs().maxCoeff() < 1e-3);
  CHECK(run("info " + files.path("h.npy")).find("bytes_of_each: 2") != std::string::npos);
  refuses("convert --half " + files.path("t.binary") + " " + files.path("new.bsdf"), {"--half needs", ".npy"});
}

TEST_CASE("convert: a table becomes one of OpenMATERIAL, which is read as samples") {
  const small_files files;
  run("convert --polar-steps 4 " + files.path("t.binary") + " " + files.path("t_brdf.xompt"));
  CHECK(scratch::get(files.here / "t_brdf.xompt").find("\"name\": \"t\"") != std::string::npos);
  files.convert("t_brdf.xompt", "s.csv");
  CHECK(gonio::io::read_samples(files.path("s.csv")).size() == 1 + 3 + 3 + 3 * 3 * 8);
  CHECK(run("info " + files.path("t_brdf.xompt")).find("format: OpenMATERIAL") != std::string::npos);
  refuses("convert " + files.path("t.binary") + " " + files.path("t.xompt"), {"t.xompt", "_brdf.xompt"});
  refuses("convert " + files.path("s.csv") + " " + files.path("s_brdf.xompt"),
          {"complete them with 'gonio reconstruct'"});
}

TEST_CASE("convert: spectral samples become samples in RGB") {
  const small_files files;
  scratch::put(files.here / "s.brdf", std::string("3\n450 550 650\n0.1 0 0.2 1 0.5 0.5 0.5\n"));
  files.convert("s.brdf", "s.csv");
  const gonio::sample_set samples = gonio::io::read_samples(files.path("s.csv"));
  REQUIRE(samples.size() == 1);
  CHECK((samples[0].value - 0.5).abs().maxCoeff() < 1e-6);
}

TEST_CASE("convert: what cannot be is refused in one sentence, and nothing is written") {
  const small_files files;
  const auto refused = [&](const std::string& from, const std::string& to, std::initializer_list<const char*> words) {
    refuses("convert " + files.path(from) + " " + files.path(to), words);
    CHECK(!std::filesystem::exists(files.here / to));
  };
  scratch::put(files.here / "notes.doc", std::string("root:x:0:0"));
  scratch::put(files.here / "s.csv", std::string("theta_h,theta_d,phi_d,r,g,b\n1,2,3,1,1,1\n"));
  refused("notes.doc", "new.bsdf", {"notes.doc: unknown kind of file", "RGL material (.bsdf)", "samples (.csv)"});
  refused("t.binary", "new.txt", {"new.txt: unknown kind of output", "MERL table (.binary)"});
  refused("t.binary", "new.brdf", {"new.brdf: unknown kind of output"});
  refused("s.csv", "new.bsdf", {"new.bsdf", "complete them with 'gonio reconstruct'"});
  refused("t.binary", "new.csv", {"new.csv", "'gonio sample'"});
  refused("absent.binary", "new.bsdf", {"absent.binary", "No such file"});
  refuses("convert --spectra " + files.path("t.binary") + " " + files.path("new.npy"), {"--spectra needs", ".bsdf"});
  refuses("convert --polar-steps 9 " + files.path("t.binary") + " " + files.path("new.npy"),
          {"--polar-steps needs", ".mbsdf"});
  refuses("convert --polar-steps 0 " + files.path("t.binary") + " " + files.path("new.mbsdf"), {"--polar-steps"});
  refuses("convert " + files.path("t.binary") + " " + files.path("t.binary"), {"would overwrite the input"});
}

TEST_CASE("what completes samples writes materials for renderers, too") {
  const small_files files;
  run("fit " + files.path("t.binary") + " --model ggx -o " + files.path("fit.bsdf"));
  const auto material = gonio::io::read_rgl(files.path("fit.bsdf")).material;
  const gonio::direction up(0, 0, 1);
  CHECK((material(up, up) / files.metal(up, up) - 1.0).abs().maxCoeff() < 0.1);
}
