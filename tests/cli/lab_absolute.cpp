/// gonio lab calibrate: the absolute method beside the relative one, and the cone of a lens.

#include "laboratory.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/table/image.hpp>

#include <cmath>
#include <numbers>
#include <string>

namespace {

/// Scans of red paint, of the white reference and of the lamp through a filter of transmittance 0.001.
struct three_scans : laboratory {
  explicit three_scans(const std::string& options) {
    run("lab plan " + directions + " -o " + at("plan.csv"));
    const std::string scan = "lab scan " + at("plan.csv") + options;
    run(scan + " --white -o " + at("white.scan"));
    run(scan + material + "-o " + at("paint.scan"));
    const std::string told = run(scan + " --lamp --filter-transmittance 0.001 -o " + at("lamp.scan"));
    CHECK(told.find("the lamp's solid angle is 7.85") != std::string::npos);
  }

  [[nodiscard]] gonio::sample_set samples(const std::string& options) const {
    run("lab calibrate " + at("paint.scan") + options + " -o " + at("samples.csv"));
    return gonio::io::read_samples(at("samples.csv"));
  }
};

/// The median over samples and channels of |a / b - 1|.
double median_difference(const gonio::sample_set& a, const gonio::sample_set& b) {
  REQUIRE(a.size() == 20);
  REQUIRE(b.size() == 20);
  std::vector<double> all;
  for (Eigen::Index i = 0; i < 20; ++i)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      all.push_back(std::abs(a[i].value[channel] / b[i].value[channel] - 1.0));
  std::ranges::nth_element(all, all.begin() + 30);
  return all[30];
}

const std::string solid_angle = " --lamp-solid-angle 7.853981634e-05 ", filter = " --filter-transmittance 0.001 ";
const std::string known_camera = " --gamma 1 --read-noise 0 --shot-noise 0 --flicker 0 ";

}  // namespace

TEST_CASE("lab: without defects the absolute method measures the material itself") {
  const three_scans room(" --ideal");
  const gonio::brdf_table truth = gonio::io::read_merl(room.at("truth.binary"));
  const std::string lamp = " --lamp " + room.at("lamp.scan") + solid_angle + known_camera;
  const auto check_samples = [&](const std::string& options, double factor) {
    const auto samples = room.samples(options);
    REQUIRE(samples.size() == 20);
    for (const gonio::sample& each : samples) {
      const auto [wi, wo] = each.directions.pair();
      const gonio::rgb expected = factor * truth(wi, wo);
      CHECK(((each.value - expected).abs() < 1e-3 * expected).all());
    }
  };
  check_samples(lamp + filter, 1.0);
  // A wrong transmittance or solid angle is a factor.
  check_samples(lamp + " --filter-transmittance 0.0005 ", 0.5);
  check_samples(lamp, 1000.0);
  const auto warned = gonio_tool("lab calibrate " + room.at("paint.scan") + lamp + " -o " + room.at("samples.csv"));
  CHECK(warned.output.find("gonio: warning: 20 of 20 samples are brighter than a perfect white: are "
                           "--lamp-solid-angle and --filter-transmittance right?") != std::string::npos);
  // A photograph of the lamp, merged. Linear cameras have exposure 1 at the middle count: white under the lamp at the
  // normal saturates in 0.04 s, and the lamp is 1 / (solid angle) times as bright as E, white 1 / pi.
  const double exposure = 0.001 * std::numbers::pi / 7.853981634e-05 / 0.04 * 2.0;
  gonio::io::write_npy(room.at("lamp.npy"), gonio::uniform_image(4, 6, gonio::rgb::Constant(exposure)));
  check_samples(" --lamp " + room.at("lamp.npy") + solid_angle + filter + known_camera, 1.0);
}

TEST_CASE("lab: with all defects both methods give the same samples within the noise") {
  const three_scans room(" --camera gamma --misaligned 0");
  const auto relative = room.samples(" --reference " + room.at("white.scan"));
  const auto absolute = room.samples(" --lamp " + room.at("lamp.scan") + solid_angle + filter);
  const double same = median_difference(absolute, relative);
  CHECK(same > 0.0);
  CHECK(same < 0.01);
  const auto wrong = room.samples(" --lamp " + room.at("lamp.scan") + solid_angle + " --filter-transmittance 0.0012 ");
  CHECK(median_difference(wrong, relative) > 0.17);
}

TEST_CASE("lab: the cone of the lens, and the light that it receives") {
  const three_scans room(" --ideal");
  const std::string lens = " --reference " + room.at("white.scan") + known_camera + "--lens ";
  const std::string told =
      run("lab calibrate " + room.at("white.scan") + lens + "25,4,350 -o " + room.at("samples.csv"));
  // The half angle is that of 3.125 mm at 350 mm. White reflects 0.99 Omega cos(theta_o) / pi.
  CHECK(
      told.find("lens: half angle 0.512 degrees (gonio reconstruct --receiver-half-angle), solid angle 0.00025 sr; it "
                "receives ") != std::string::npos);
  const auto numbers = told.substr(told.find("receives ") + 9);
  const double most = std::stod(numbers.substr(numbers.find(" to ") + 4));
  CHECK(most < 0.99 * 0.0002505 / std::numbers::pi);
  CHECK(most > 0.5 * 0.99 * 0.0002505 / std::numbers::pi);
  std::filesystem::remove(room.at("samples.csv"));
  for (const auto& [wrong, words] :
       {std::pair{"25,4", "--lens 25,4: expected FOCAL,F_NUMBER,DISTANCE"},
        std::pair{"25,0,350", "must be positive, not 0.0"}, std::pair{"25,f,350", "--lens: number 2 of a list, 'f'"}})
    refuses("lab calibrate " + room.at("white.scan") + lens + wrong + " -o " + room.at("samples.csv"), words);
  CHECK(!std::filesystem::exists(room.at("samples.csv")));
}

TEST_CASE("lab: the options of one method are refused with the other by name") {
  const scratch::folder folder;
  const std::string scan = (folder / "a.scan").string(), to = " -o " + (folder / "s.csv").string();
  scratch::put(scan, std::string("nothing is read"));
  const std::string by_lamp = "lab calibrate " + scan + " --lamp " + scan + to,
                    by_white = "lab calibrate " + scan + " --reference " + scan + to;
  for (const std::string option : {"--reflectance 0.9", "--nearest-reference", "--brighter"})
    refuses(by_lamp + solid_angle + option, option.substr(0, option.find(' ')) + " needs --reference, not --lamp");
  for (const std::string option : {"--lamp-solid-angle 0.01", "--filter-transmittance 0.5"})
    refuses(by_white + ' ' + option, option.substr(0, option.find(' ')) + " needs --lamp, not --reference");
  refuses(by_lamp, "--lamp needs --lamp-solid-angle");
  refuses(by_lamp + " --reference " + scan + solid_angle, "--lamp");
  refuses("lab calibrate " + scan + to, "--reference");
  refuses(by_lamp + " --lamp-solid-angle 7", "--lamp-solid-angle");
  refuses(by_lamp + solid_angle + "--filter-transmittance 1.5", "--filter-transmittance");
  const std::string plan = "lab scan " + directions + " -o " + (folder / "b.scan").string();
  refuses(plan + " --white --filter-transmittance 0.5", "--filter-transmittance needs --lamp");
  refuses(plan + " --white --lamp", "--lamp");
  refuses(plan + " --lamp --adaptive --reference " + scan, "--adaptive needs --material, not --lamp");
  CHECK(!std::filesystem::exists(folder / "s.csv"));
  CHECK(!std::filesystem::exists(folder / "b.scan"));
}

TEST_CASE("lab: a lamp that saturates the camera needs a darker filter") {
  const laboratory room;
  run("lab plan " + directions + " -o " + room.at("plan.csv"));
  run("lab scan " + room.at("plan.csv") + room.material + "-o " + room.at("paint.scan"));
  run("lab scan " + room.at("plan.csv") + " --lamp -o " + room.at("lamp.scan"));
  const std::string calibrate =
      "lab calibrate " + room.at("paint.scan") + solid_angle + " --gamma 1 -o " + room.at("s.csv") + " --lamp ";
  refuses(calibrate + room.at("lamp.scan"),
          "lamp.scan: reading 1 is saturated in every exposure (a lamp needs a filter of another density)");
  gonio::io::write_npy(room.at("black.npy"), gonio::uniform_image(4, 6));
  refuses(calibrate + room.at("black.npy"), "black.npy: expected a photograph of the lamp, positive and finite");
  CHECK(!std::filesystem::exists(room.at("s.csv")));
}
