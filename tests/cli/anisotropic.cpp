/// Anisotropic materials in the tool: written, drawn and measured, and refused where only isotropic ones will do.

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/utia.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/zemax_table.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

namespace {

const gonio::model::anisotropic_ggx& metal() {
  static const gonio::model::anisotropic_ggx f(gonio::rgb(0.9, 0.6, 0.3),
                                               {.alpha_x = 0.15, .alpha_y = 0.4, .f0 = 0.8, .rotation = 0.3});
  return f;
}

/// A folder with a small file of it.
struct brushed_files {
  scratch::folder here;

  brushed_files() {
    static const gonio::io::rgl_material material{
        gonio::model::tabulate_adaptively(
            metal(),
            gonio::model::anisotropic_resolution{
                .phi_i = 17, .theta_i = 10, .values = 24, .visible_normals = 24, .normals = 48}),
        "brushed",
        {}};
    gonio::io::write_rgl(here / "brushed.bsdf", material);
    gonio::io::write_merl(here / "t.binary",
                          gonio::tabulate(gonio::model::ggx{}, gonio::valid_cells(gonio::grid({30, 15, 30}))));
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (here / name).string(); }
};

}  // namespace

TEST_CASE("an anisotropic material is described, and converted to itself and to spectra") {
  const brushed_files files;
  const std::string facts = run("info " + files.path("brushed.bsdf"));
  for (const char* words : {"kind: RGL material", "directions_of_light: 170", "phi_i: [-180", "180"})
    CHECK(facts.find(words) != std::string::npos);
  CHECK(run("convert --keep-negative " + files.path("brushed.bsdf") + " " + files.path("again.bsdf")).empty());
  CHECK(scratch::get(files.here / "again.bsdf") == scratch::get(files.here / "brushed.bsdf"));
  run("convert --spectra " + files.path("brushed.bsdf") + " " + files.path("spectra.bsdf"));
  const auto spectral = gonio::io::read_rgl(files.path("spectra.bsdf"));
  CHECK(spectral.spectra);
  CHECK(spectral.material.is_anisotropic());
}

TEST_CASE("a measurement of an anisotropic material has azimuths") {
  const brushed_files files;
  run("sample --count 100 --seed 3 " + files.path("brushed.bsdf") + " -o " + files.path("s.csv"));
  CHECK(scratch::get(files.here / "s.csv").starts_with("theta_i,phi_i,theta_o,phi_o,r,g,b"));
  const gonio::sample_set samples = gonio::io::read_samples(files.path("s.csv"));
  REQUIRE(samples.size() == 100);
  const auto material = gonio::io::read_rgl(files.path("brushed.bsdf")).material;
  for (const gonio::sample& s : samples)
    CHECK((s.value / material(s.directions.pair().wi, s.directions.pair().wo) - 1.0).abs().maxCoeff() < 1e-6);
  scratch::put(files.here / "d.csv", std::string("theta_i,phi_i,theta_o,phi_o\n30,20,30,200\n30,110,30,290\n"));
  run("sample --directions " + files.path("d.csv") + " " + files.path("brushed.bsdf") + " -o " + files.path("two.csv"));
  const gonio::sample_set two = gonio::io::read_samples(files.path("two.csv"));
  REQUIRE(two.size() == 2);
  CHECK(gonio::azimuth(two[1].directions.pair().wi) == doctest::Approx(gonio::radians(110.0)));
  CHECK(two[0].value.x() != doctest::Approx(two[1].value.x()).epsilon(0.01));
}

TEST_CASE("an anisotropic sphere is drawn with its grooves about the vertical axis, alone and beside a table") {
  const brushed_files files;
  run("render --size 32 " + files.path("brushed.bsdf") + " -o " + files.path("one.png"));
  run("render --size 32 " + files.path("brushed.bsdf") + " " + files.path("t.binary") + " --light 0,0 -o " +
      files.path("two.png"));
  const gonio::image image = gonio::io::read_png(files.here / "two.png");
  CHECK(image.shape(1) > 64);
  run("render --size 64 --compare " + files.path("brushed.bsdf") + " " + files.path("brushed.bsdf") + " -o " +
      files.path("same.png"));
  gonio::io::write_hdr(files.here / "sky.hdr", gonio::uniform_image(8, 16, gonio::rgb::Ones()));
  run("render --size 24 --quality 4 --environment " + files.path("sky.hdr") + " " + files.path("brushed.bsdf") +
      " -o " + files.path("sky.png"));
  CHECK(std::filesystem::exists(files.here / "sky.png"));
  refuses("render --slices " + files.path("brushed.bsdf") + " -o " + files.path("s.png"),
          {"brushed.bsdf: is anisotropic", "isotropic"});
}

TEST_CASE("an anisotropic material is refused where only an isotropic one will do, by name") {
  const brushed_files files;
  const std::string brushed = files.path("brushed.bsdf");
  for (const char* name : {"new.binary", "new.npy", "new.mbsdf", "new_brdf.xompt"}) {
    refuses("convert " + brushed + " " + files.path(name), {name, "anisotropic", ".bsdf"});
    CHECK(!std::filesystem::exists(files.here / name));
  }
  refuses("convert " + brushed + " " + files.path("new.csv"), {"new.csv", "'gonio sample'"});
  refuses("compare " + files.path("t.binary") + " " + brushed, {"brushed.bsdf: is anisotropic"});
  refuses("fit --model ggx " + brushed, {"brushed.bsdf: is anisotropic"});
  refuses("properties " + brushed, {"brushed.bsdf: is anisotropic"});
  std::filesystem::create_directory(files.here / "rgl");
  std::filesystem::copy_file(brushed, files.here / "rgl" / "brushed.bsdf");
  refuses("learn --rgl " + files.path("rgl") + " -o " + files.path("p.prior"), {"brushed.bsdf: is anisotropic"});
  refuses("learn --spectra --rgl " + files.path("rgl") + " -o " + files.path("p.prior"), {"brushed.bsdf: is"});
}

TEST_CASE("an anisotropic model is fitted to samples with azimuths, written for renderers and drawn") {
  const brushed_files files;
  run("sample --count 200 --noise 0.02 --seed 3 " + files.path("brushed.bsdf") + " -o " + files.path("s.csv"));
  const std::string said = run("fit " + files.path("s.csv") + " --model ggx-anisotropic -o " + files.path("fit.bsdf") +
                               " --image " + files.path("fit.png") + " --size 24");
  for (const char* words : {"ggx-anisotropic: colour", "alpha_x 0.", "(slope)", "rotation", "(rad)", "largest albedo"})
    CHECK(said.find(words) != std::string::npos);
  CHECK(gonio::io::read_rgl(files.here / "fit.bsdf").material.is_anisotropic());
  CHECK(std::filesystem::exists(files.here / "fit.png"));
  const std::string fit = "fit --model ggx-anisotropic " + files.path("s.csv");
  refuses(fit + " -o " + files.path("fit.binary"), {"fit.binary: cannot hold the anisotropic", ".bsdf"});
  refuses(fit + " --pbrt " + files.path("fit.pbrt"), {"ggx or torrance-sparrow, not ggx-anisotropic"});
  refuses("fit --model ward-anisotropic " + files.path("t.binary"), {"t.binary", "needs samples with azimuths"});
  scratch::put(files.here / "plane.csv",
               "# quantity: brdf\n# theta-o-sign: "
               "light\ntheta_i,theta_o,value\n45,-45,2\n45,-30,.3\n30,-10,.4\n45,0,.1\n45,60,.1\n");
  refuses("fit --model ggx-anisotropic " + files.path("plane.csv"),
          {"plane.csv", "all half vectors have the same azimuth", "several azimuths"});
}

TEST_CASE("a table of Zemax with rotations is written, described without suspicion, drawn and converted back") {
  const brushed_files files;
  run("convert --zemax " + files.path("brushed.bsdf") + " " + files.path("z.bsdf"));
  CHECK(scratch::get(files.here / "z.bsdf").find("Symmetry ASymmetrical4D") != std::string::npos);
  const std::string facts = run("info " + files.path("z.bsdf"));
  CHECK(facts.find("format: Zemax BSDF") != std::string::npos);
  CHECK(facts.find("same directions") == std::string::npos);
  run("render --size 24 " + files.path("z.bsdf") + " -o " + files.path("z.png"));
  run("convert " + files.path("z.bsdf") + " " + files.path("z.csv"));
  CHECK(scratch::get(files.here / "z.csv").starts_with("theta_i,phi_i,theta_o,phi_o,r,g,b"));
  run("convert " + files.path("z.bsdf") + " " + files.path("back.bsdf"));
  const auto back = gonio::io::read_rgl(files.here / "back.bsdf").material;
  CHECK(back.is_anisotropic());
  const auto wi = gonio::spherical_direction(0.5, 0.4), wo = gonio::spherical_direction(0.6, 3.3);
  CHECK((back(wi, wo) / metal()(wi, wo) - 1.0).abs().maxCoeff() < 0.1);
  run("convert --zemax " + files.path("t.binary") + " " + files.path("isotropic.bsdf"));
  CHECK(scratch::get(files.here / "isotropic.bsdf").find("PlaneSymmetrical") != std::string::npos);
  run("convert " + files.path("isotropic.bsdf") + " " + files.path("t2.binary"));
  refuses("convert " + files.path("z.bsdf") + " " + files.path("new.binary"), {"new.binary", "anisotropic"});
  refuses("convert --zemax " + files.path("t.binary") + " " + files.path("new.npy"), {"--zemax needs", ".bsdf"});
}

TEST_CASE("negative values are clipped in a table of Zemax, too") {
  const brushed_files files;
  gonio::brdf_table table = gonio::io::read_merl(files.path("t.binary"));
  for (float& value : table.values()) value -= 0.01F;
  gonio::io::write_merl(files.path("dark.binary"), table);
  const std::string convert = "convert --zemax " + files.path("dark.binary") + " ";
  CHECK(run(convert + files.path("z.bsdf")).find("cells have a negative value, written as 0. That adds") !=
        std::string::npos);
  CHECK(scratch::get(files.here / "z.bsdf").find(" -") == std::string::npos);
  CHECK(run("convert --keep-negative --zemax " + files.path("dark.binary") + " " + files.path("kept.bsdf")).empty());
  CHECK(scratch::get(files.here / "kept.bsdf").find(" -") != std::string::npos);
}

TEST_CASE("a material of UTIA's database is described, drawn, measured and converted") {
  const brushed_files files;
  gonio::model::angle_grid grid = gonio::io::utia_grid();
  for (Eigen::Index node = 0; node < grid.size(); ++node) {
    const auto [wi, wo] = gonio::model::directions_of(grid, node);
    for (const double value : metal()(wi, wo)) grid.values.push_back(static_cast<float>(value));
  }
  gonio::io::write_atomically(files.here / "m.bin", gonio::io::write_utia(grid));
  const std::string facts = run("info " + files.path("m.bin"));
  for (const char* words : {"kind: UTIA material", "directions_of_light: 288", "theta_i: [0.0,75.0]"})
    CHECK(facts.find(words) != std::string::npos);
  run("render --size 24 " + files.path("m.bin") + " -o " + files.path("m.png"));
  run("sample --count 20 " + files.path("m.bin") + " -o " + files.path("s.csv"));
  run("convert " + files.path("m.bin") + " " + files.path("m.bsdf"));
  const auto material = gonio::io::read_rgl(files.here / "m.bsdf").material;
  const auto wi = gonio::spherical_direction(gonio::radians(45.0), gonio::radians(22.5)),
             wo = gonio::spherical_direction(gonio::radians(30.0), gonio::radians(195.0));
  // The database's steps of 15 degrees are coarse beside this highlight.
  CHECK((material(wi, wo) / metal()(wi, wo) - 1.0).abs().maxCoeff() < 0.2);
  refuses("compare " + files.path("m.bin") + " " + files.path("t.binary"), {"m.bin: is anisotropic"});
  scratch::put(files.here / "short.bin", std::string("abc"));
  refuses("render " + files.path("short.bin") + " -o " + files.path("s.png"), {"short.bin: has 3 bytes", "288 x 288"});
}
