/// gonio reconstruct --spectra, and commands that convert spectra to colours.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace {

/// A bluish paint at some wavelengths: a highlight over a diffuse part that falls with the wavelength. The value at the
/// last wavelength is multiplied by `brighter`.
gonio::sample_set measured_paint(std::vector<double> wavelengths, double brighter = 1.0) {
  gonio::sample_set samples{gonio::channels(wavelengths)};
  for (Eigen::Index i = 0; i < 18; ++i) {
    const double theta_h = 0.09 * static_cast<double>(i % 6), theta_d = 0.3 + 0.3 * static_cast<double>(i / 6);
    std::vector<double> values;
    for (const double wavelength : wavelengths)
      values.push_back(60.0 / wavelength + 0.5 * std::exp(-20.0 * theta_h * theta_h));
    values.back() *= brighter;
    samples.add({theta_h, theta_d, 1.0 + 0.1 * static_cast<double>(i)}, values);
  }
  return samples;
}

class measured_files {
 public:
  measured_files() {
    gonio::io::write_samples(folder_ / "spectra.csv", measured_paint({420, 480, 540, 600, 660}));
    gonio::io::write_samples(folder_ / "laser.csv", measured_paint({633}));
    gonio::io::write_samples(folder_ / "colours.csv", measured_paint({420, 480, 540, 600, 660}).colours());
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

 private:
  scratch::folder folder_;
};

}  // namespace

TEST_CASE("each wavelength is reconstructed, and written as spectra or as their colours") {
  const measured_files files;
  const auto told =
      read_json(run("reconstruct " + files.at("spectra.csv") + " --spectra --json -o " + files.at("a.bsdf")));
  CHECK(told["wavelengths_nm"].size() == 5);
  CHECK(told["mapped_residual_rms"].size() == 5);
  CHECK(told["illuminant"] == "D65");
  const auto material = gonio::io::read_rgl(files.at("a.bsdf"));
  REQUIRE(material.spectra);
  CHECK(material.spectra->wavelengths == std::vector<double>{420, 480, 540, 600, 660});
  CHECK(read_json(run("info --json " + files.at("a.bsdf")))["wavelengths_nm"].size() == 5);

  CHECK(run("reconstruct " + files.at("spectra.csv") + " --spectra -o " + files.at("d65.binary"))
            .find("5 wavelengths from 420 to 660 nm") != std::string::npos);
  run("reconstruct " + files.at("spectra.csv") + " --spectra --illuminant A -o " + files.at("a.binary"));
  const gonio::direction wi = gonio::spherical_direction(0.4, 0.0), wo = gonio::spherical_direction(0.7, 2.0);
  const gonio::rgb daylit = gonio::io::read_merl(files.at("d65.binary"))(wi, wo),
                   lamplit = gonio::io::read_merl(files.at("a.binary"))(wi, wo);
  CHECK(daylit.z() > 1.1 * daylit.x());
  CHECK(lamplit.y() < daylit.y());  // a lamp's light has less blue
  CHECK(((material.material(wi, wo) / daylit - 1.0).abs() < 0.05).all());
}

TEST_CASE("spectra are fitted by other penalties, by other solvers and by the materials themselves") {
  const measured_files files;
  for (const std::string options : {"--eta 40", "--discrepancy 0", "--misplaced 0.5 --noise 0.02", "--solver lasso",
                                    "--no-reject", "--method linear", "--method linear --solver tikhonov --eta 1",
                                    "--method rbf", "--method pull-push", "--method scattered"}) {
    CAPTURE(options);
    const std::string told =
        run("reconstruct " + files.at("spectra.csv") + " --spectra " + options + " -o " + files.at("t.binary"));
    CHECK(told.find("5 wavelengths") != std::string::npos);
  }
}

TEST_CASE("without --spectra, spectra are their colours wherever samples are read") {
  const measured_files files;
  run("reconstruct " + files.at("spectra.csv") + " -o " + files.at("from_spectra.binary"));
  run("reconstruct " + files.at("spectra.csv") + " --illuminant D65 -o " + files.at("from_d65.binary"));
  run("reconstruct " + files.at("colours.csv") + " -o " + files.at("from_colours.binary"));
  CHECK(scratch::get(files.at("from_spectra.binary")) == scratch::get(files.at("from_colours.binary")));
  CHECK(scratch::get(files.at("from_spectra.binary")) == scratch::get(files.at("from_d65.binary")));
  const auto facts = read_json(run("info --json " + files.at("spectra.csv")));
  CHECK(facts["samples"] == 18);
}

TEST_CASE("a header line of a thousand wavelengths is read by info, too") {
  const measured_files files;
  std::vector<double> wavelengths;
  for (double wavelength = 400.0; wavelength < 2200.0; wavelength += 1.5) wavelengths.push_back(wavelength);
  gonio::io::write_samples(files.at("wide.csv"), measured_paint(wavelengths));
  CHECK(read_json(run("info --json " + files.at("wide.csv")))["wavelengths_nm"].size() == wavelengths.size());
}

TEST_CASE("a .bsdf has the wavelengths of a file that names them, with --spectra and without") {
  const measured_files files;
  run("reconstruct " + files.at("spectra.csv") + " -o " + files.at("default.bsdf"));
  run("reconstruct " + files.at("spectra.csv") + " --spectra -o " + files.at("asked.bsdf"));
  REQUIRE(gonio::io::read_rgl(files.at("default.bsdf")).spectra);
  run("reconstruct " + files.at("spectra.csv") + " --illuminant A -o " + files.at("lamplit.bsdf"));
  CHECK(!gonio::io::read_rgl(files.at("lamplit.bsdf")).spectra);  // colours were requested
}

TEST_CASE("a .bsdf has those wavelengths between which spectra are straight, and says how many") {
  const measured_files files;
  std::vector<double> wavelengths;
  for (double wavelength = 400.0; wavelength <= 700.0; wavelength += 10.0) wavelengths.push_back(wavelength);
  gonio::io::write_samples(files.at("fine.csv"), measured_paint(wavelengths));
  const std::string reconstruct = "reconstruct " + files.at("fine.csv") + " -o ";
  const auto written = [&](const char* name) { return gonio::io::read_rgl(files.at(name)).spectra->wavelengths; };
  CHECK(run(reconstruct + files.at("few.bsdf"))
            .find("few.bsdf: " + std::to_string(written("few.bsdf").size()) +
                  " of 31 wavelengths written; the others are interpolated linearly, within 0.6 %") !=
        std::string::npos);
  CHECK(written("few.bsdf").size() < 16);
  CHECK(written("few.bsdf").back() == 700.0);
  CHECK(run(reconstruct + files.at("fewer.bsdf") + " --albedo-tolerance 0.05").find("within 5 %") != std::string::npos);
  CHECK(written("fewer.bsdf").size() < written("few.bsdf").size());
  CHECK(run(reconstruct + files.at("all.bsdf") + " --albedo-tolerance 0").find("interpolated") == std::string::npos);
  CHECK(written("all.bsdf") == wavelengths);
  const gonio::direction wi = gonio::spherical_direction(0.4, 0.0), wo = gonio::spherical_direction(0.7, 2.0);
  const gonio::rgb all = gonio::io::read_rgl(files.at("all.bsdf")).material(wi, wo),
                   few = gonio::io::read_rgl(files.at("few.bsdf")).material(wi, wo);
  CHECK(((few / all - 1.0).abs() < 0.006).all());
  refuses(reconstruct + files.at("t.binary") + " --albedo-tolerance 0.1", {"--albedo-tolerance needs", ".bsdf"});
  refuses("expand --formula red-paint --albedo-tolerance 0.1 -o " + files.at("t.npy"),
          {"--albedo-tolerance needs", ".bsdf"});
}

TEST_CASE("wavelengths that nobody sees are fitted and checked as such, and never made grey") {
  const measured_files files;
  const std::vector<double> near_infrared{905, 1064, 1550};
  gonio::io::write_samples(files.at("nir.csv"), measured_paint(near_infrared));
  const auto told = read_json(run("reconstruct " + files.at("nir.csv") + " --json -o " + files.at("nir.bsdf")));
  CHECK(told["wavelengths_nm"].size() == 3);
  CHECK(read_json(run("info --json " + files.at("nir.bsdf")))["wavelengths_nm"].size() == 3);
  for (const char* command : {"convert ", "properties "})
    refuses(command + files.at("nir.bsdf") + (command[0] == 'c' ? " " + files.at("nir.binary") : ""),
            {"nir.bsdf", "905 to 1550 nm", "no colour"});
  for (const char* command :
       {"reconstruct NIR -o OUT.binary", "reconstruct NIR --spectra -o OUT.binary",
        "reconstruct NIR --spectra -o OUT.bsdf --image OUT.png", "fit NIR --model ggx", "properties NIR",
        "design --given NIR -n 1 -o OUT.csv", "report NIR --noise 0.02 -o OUT.html", "convert NIR OUT.csv"}) {
    std::string line = command;
    line.replace(line.find("NIR"), 3, files.at("nir.csv"));
    for (std::size_t out = line.find("OUT"); out != std::string::npos; out = line.find("OUT"))
      line.replace(out, 3, files.at("written"));
    CAPTURE(line);
    refuses(line, {"visible"});
  }

  const std::string checked = "check " + files.at("part.csv") + " --reference " + files.at("nir.csv") + " --noise 0.02";
  gonio::io::write_samples(files.at("part.csv"), measured_paint(near_infrared));
  CHECK(run(checked).find("no difference found") != std::string::npos);
  gonio::io::write_samples(files.at("part.csv"), measured_paint(near_infrared, 3.0));
  const auto [exit_code, differs] = gonio_tool(checked);
  CHECK(exit_code == 1);
  CHECK(differs.find("905 nm +0.0 %, 1064 nm +0.0 %, 1550 nm +") != std::string::npos);
  CHECK(differs.find("): 1550 nm ") != std::string::npos);
}

TEST_CASE("interpolated spectra are those of three wavelengths at a time, which are the method's own colours") {
  const measured_files files;
  gonio::io::write_samples(files.at("three.csv"), [] {
    const gonio::sample_set all = measured_paint({420, 480, 540, 600, 660});
    gonio::sample_set three;
    for (Eigen::Index i = 0; i < std::ssize(all); ++i)
      three.push_back({all.directions(i), {all.values(i)[3], all.values(i)[4], all.values(i)[4]}});
    return three;
  }());
  run("reconstruct " + files.at("three.csv") + " --method scattered -o " + files.at("three.binary"));
  run("reconstruct " + files.at("spectra.csv") + " --spectra --method scattered -o " + files.at("all.bsdf"));
  const auto material = gonio::io::read_rgl(files.at("all.bsdf"));
  REQUIRE(material.spectra);
  const gonio::direction wi = gonio::spherical_direction(0.4, 0.0), wo = gonio::spherical_direction(0.7, 2.0);
  const gonio::rgb three = gonio::io::read_merl(files.at("three.binary"))(wi, wo);
  const gonio::sample_set found =
      gonio::io::sample_spectra(material, std::vector<gonio::sample_directions>{gonio::direction_pair{wi, wo}});
  CHECK(found.values(0)[3] == doctest::Approx(three.x()).epsilon(0.05));
  CHECK(found.values(0)[4] == doctest::Approx(three.y()).epsilon(0.05));
}

TEST_CASE("one wavelength is reconstructed as it is, with --spectra and without") {
  const measured_files files;
  const auto told =
      read_json(run("reconstruct " + files.at("laser.csv") + " --spectra --json -o " + files.at("spectral.binary")));
  CHECK(told["wavelength_nm"] == 633.0);
  CHECK(told["wavelengths_nm"].size() == 1);
  run("reconstruct " + files.at("laser.csv") + " -o " + files.at("grey.binary"));
  const gonio::direction wi = gonio::spherical_direction(0.4, 0.0), wo = gonio::spherical_direction(0.7, 2.0);
  const gonio::rgb one = gonio::io::read_merl(files.at("spectral.binary"))(wi, wo),
                   grey = gonio::io::read_merl(files.at("grey.binary"))(wi, wo);
  CHECK(one.x() == doctest::Approx(one.z()).epsilon(1e-5));
  CHECK(one.x() == doctest::Approx(grey.x()).epsilon(1e-5));
}

TEST_CASE("what has no spectra is refused") {
  const measured_files files;
  const std::string output = " -o " + files.at("t.binary");
  refuses("reconstruct " + files.at("colours.csv") + " --spectra" + output, {"colours.csv", "has no wavelengths"});
  refuses("reconstruct " + files.at("colours.csv") + " --illuminant A" + output,
          {"colours.csv", "needs at least two wavelengths"});
  refuses("reconstruct " + files.at("spectra.csv") + " --spectra --method correction --iterations 3" + output,
          {"--spectra", "correction"});
  refuses("reconstruct " + files.at("laser.csv") + " --spectra -o " + files.at("t.bsdf"),
          {"t.bsdf", "two wavelengths"});
  refuses("reconstruct " + files.at("spectra.csv") + " --illuminant B" + output, {"--illuminant"});
}

TEST_CASE("a spike at one wavelength is named and replaced, also before spectra become colours") {
  const scratch::folder folder;
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  std::vector<double> wavelengths;
  for (int nm = 400; nm <= 700; nm += 20) wavelengths.push_back(nm);
  gonio::sample_set samples = measured_paint(wavelengths);
  gonio::io::write_samples(at("right.csv"), samples);
  const double right = samples.values(4)[7];
  samples.set_value(4, 7, 6.0 * right);
  gonio::io::write_samples(at("spike.csv"), samples);
  for (const std::string how : {" --spectra", ""}) {
    CAPTURE(how);
    const auto told = gonio_tool("reconstruct " + at("spike.csv") + how + " -o " + at("spike.binary"));
    CHECK(told.exit_code == 0);
    CHECK(told.output.starts_with("gonio: warning: sample 5 at 540 nm: measured "));
    CHECK(told.output.find("but its neighbours and the other samples say ") != std::string::npos);
    const auto replaced = read_json(gonio_tool("reconstruct --json " + at("spike.csv") + how).output)["replaced"];
    REQUIRE(replaced.size() == 1);
    CHECK(replaced[0]["sample"] == 5);
    CHECK(replaced[0]["wavelength"] == 540);
    CHECK(replaced[0]["replaced_by"].get<double>() == doctest::Approx(right).epsilon(0.1));
    CHECK(read_json(gonio_tool("reconstruct --json " + at("right.csv") + how).output)["replaced"].empty());
    run("reconstruct " + at("right.csv") + how + " -o " + at("right.binary"));
    const auto difference = read_json(run("compare --json " + at("spike.binary") + " " + at("right.binary")));
    CHECK(difference["delta_e_env"].get<double>() < 0.1);
  }
  CHECK(gonio_tool("reconstruct " + at("spike.csv") + " --spectra --no-reject -o " + at("kept.binary"))
            .output.find("at 540 nm") == std::string::npos);
}
