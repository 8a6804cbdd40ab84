#include "scratch.hpp"
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using scratch::check_refused;

namespace {

const gonio::valid_cells& cells() {
  static const gonio::valid_cells small(gonio::grid({30, 15, 12}));
  return small;
}

/// A diffuse material that reflects more at longer wavelengths.
gonio::spectral_table diffuse_table() {
  gonio::spectral_table table(cells(), {420.0, 500.0, 580.0, 660.0});
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell) table.values().row(cell) << 0.05f, 0.1f, 0.2f, 0.3f;
  return table;
}

}  // namespace

TEST_CASE("a spectral table is written as a spectral material, and its spectra are read back") {
  const scratch::folder here;
  gonio::spectral_table table = diffuse_table();
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell) {
    const double theta_h = cells().angles(cell).theta_h;
    table.values().row(cell).array() += static_cast<float>(0.4 * std::exp(-theta_h * theta_h / 0.1));
  }
  const auto path = here / "paint.bsdf";
  gonio::io::write_rgl(path, gonio::io::tabulate_adaptively(table, 0.0, "paint"));
  const auto read = gonio::io::read_rgl(path);
  REQUIRE(read.spectra);
  CHECK(read.description == "paint");
  CHECK(read.spectra->wavelengths == table.wavelengths());

  std::vector<gonio::sample_directions> directions;
  for (const double theta_h : {0.05, 0.3, 0.6})
    for (const double theta_d : {0.1, 0.5}) directions.push_back({theta_h, theta_d, 1.2});
  const gonio::sample_set samples = gonio::io::sample_spectra(read, directions);
  CHECK(samples.channels().wavelengths() == table.wavelengths());
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const auto& [wi, wo] = directions[i].pair();
    const Eigen::ArrayXf expected = table(wi, wo);
    for (Eigen::Index band = 0; band < 4; ++band)
      CHECK(samples.values(i)[static_cast<std::size_t>(band)] == doctest::Approx(double{expected[band]}).epsilon(0.02));
  }
}

TEST_CASE("tabulating a material's colours over its own directions gives its tables") {
  const gonio::spectral_table table = diffuse_table();
  const auto material = gonio::io::tabulate_adaptively(table, 0.0);
  const auto again = gonio::model::tabulate_over(material.material, table.colours());
  const std::vector<float>& expected = material.material.parts().reflectance.values;
  REQUIRE(again.values.size() == expected.size());
  double worst = 0.0, largest = 0.0;  // scaling densities to 1 rounds
  for (std::size_t i = 0; i < expected.size(); ++i) {
    worst = std::max(worst, std::abs(double{again.values[i]} - double{expected[i]}));
    largest = std::max(largest, std::abs(double{expected[i]}));
  }
  CHECK(worst < 1e-3 * largest);
  const auto same = gonio::io::tabulate_adaptively(table, 0.0, "gonio", gonio::thread_count{3});
  CHECK(same.spectra->values.values == material.spectra->values.values);
}

TEST_CASE("spectra over cells equal those in the cells' directions") {
  gonio::spectral_table table = diffuse_table();
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell)
    table.values().row(cell).array() += static_cast<float>(0.1 * cells().angles(cell).theta_h);
  const auto material = gonio::io::tabulate_adaptively(table, 0.0);
  const gonio::valid_cells coarse(gonio::grid({7, 5, 6}));
  const auto found = gonio::io::tabulate_spectra(material, coarse);
  CHECK(found.wavelengths() == table.wavelengths());
  std::vector<gonio::sample_directions> directions;
  for (Eigen::Index cell = 0; cell < coarse.size(); ++cell) {
    const auto angles = coarse.angles(cell);
    directions.push_back({angles.theta_h, angles.theta_d, angles.phi_d});
  }
  const gonio::sample_set samples = gonio::io::sample_spectra(material, directions);
  for (Eigen::Index cell = 0; cell < coarse.size(); ++cell)
    for (Eigen::Index band = 0; band < 4; ++band)
      CHECK(std::abs(double{found.values()(cell, band)} - samples.values(cell)[static_cast<std::size_t>(band)]) < 1e-5);
  CHECK(found.values() == gonio::io::tabulate_spectra(material, coarse, gonio::thread_count{3}).values());
}

TEST_CASE("spectra at other wavelengths are interpolated linearly") {
  const auto material = gonio::io::tabulate_adaptively(diffuse_table(), 0.0);
  const gonio::io::rgl_spectra& known = *material.spectra;
  const auto same = gonio::io::at_wavelengths(known, known.wavelengths);
  CHECK(same.values.values == known.values.values);
  const auto other = gonio::io::at_wavelengths(known, {420.0, 440.0, 640.0, 660.0});
  CHECK(other.wavelengths == std::vector<double>{420.0, 440.0, 640.0, 660.0});
  const Eigen::Index size = known.values.rows * known.values.columns, angles = known.values.tables / 4;
  REQUIRE(other.values.tables == 4 * angles);
  for (Eigen::Index angle = 0; angle < angles; ++angle)
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto of = [&](const gonio::io::rgl_spectra& all, Eigen::Index band) {
        return double{all.values.values[(angle * 4 + band) * size + i]};
      };
      CHECK(of(other, 0) == of(known, 0));
      CHECK(of(other, 1) == doctest::Approx(0.75 * of(known, 0) + 0.25 * of(known, 1)).epsilon(1e-6));
      CHECK(of(other, 2) == doctest::Approx(0.25 * of(known, 2) + 0.75 * of(known, 3)).epsilon(1e-6));
      CHECK(of(other, 3) == of(known, 3));
    }
  check_refused(
      [&] {
        return gonio::io::at_wavelengths(known, {410.0, 500.0});
      },
      {"from 420 to 660 nm", "from 410 to"});
  check_refused([&] { return gonio::io::at_wavelengths(known, {500.0, 661.0}); }, {"to 661 nm"});
  check_refused([&] { return gonio::io::at_wavelengths(known, {500.0, 500.0}); }, {"wavelength 2"});
}

TEST_CASE("interpolation between the written wavelengths is within the tolerance") {
  std::vector<double> wavelengths;
  for (double nanometres = 400.0; nanometres <= 700.0; nanometres += 5.0) wavelengths.push_back(nanometres);
  gonio::spectral_table table(cells(), wavelengths);
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell)
    for (Eigen::Index band = 0; band < table.bands(); ++band)
      table.values()(cell, band) = static_cast<float>((0.2 + 0.1 * std::sin(wavelengths[band] / 80.0)) *
                                                      (1.5 - cells().angles(cell).theta_h / 2.0));
  const auto written = gonio::io::tabulate_adaptively(table), whole = gonio::io::tabulate_adaptively(table, 0.0);
  CHECK(whole.spectra->wavelengths == wavelengths);
  CHECK(written.spectra->wavelengths.size() < 20);
  CHECK(written.spectra->wavelengths.back() == 700.0);
  const auto read = gonio::io::at_wavelengths(*written.spectra, wavelengths);
  const std::vector<float>&expected = whole.spectra->values.values, &found = read.values.values;
  REQUIRE(found.size() == expected.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i)
    worst = std::max(worst, std::abs(double{found[i]} - double{expected[i]}) / std::abs(double{expected[i]}));
  CHECK(worst < 1.001 * gonio::model::usual_albedo_tolerance);
  CHECK(worst > 0.5 * gonio::model::usual_albedo_tolerance);
}

TEST_CASE("a single wavelength and materials in RGB are refused") {
  const gonio::spectral_table laser(cells(), {633.0});
  check_refused([&] { return gonio::io::tabulate_adaptively(laser); }, {"two wavelengths"});
  const gonio::io::rgl_material in_rgb{
      gonio::model::tabulate_adaptively(gonio::model::lambertian{.albedo = gonio::rgb::Constant(0.5)}, {4, 8, 8, 8}),
      "",
      {}};
  check_refused([&] { return gonio::io::sample_spectra(in_rgb, {}); }, {"in RGB"});
  check_refused([&] { return gonio::io::tabulate_spectra(in_rgb, cells()); }, {"in RGB"});
}

TEST_CASE("invisible wavelengths are written unchanged") {
  gonio::spectral_table unseen(cells(), {905.0, 1550.0});
  unseen.values().col(0).setConstant(0.1f);
  unseen.values().col(1).setConstant(0.3f);
  const auto made = gonio::io::tabulate_adaptively(unseen);
  REQUIRE(made.spectra);
  CHECK(made.spectra->wavelengths == std::vector<double>{905.0, 1550.0});
  const std::vector<gonio::sample_directions> one{{0.2, 0.4, 1.0}};
  const auto sampled = gonio::io::sample_spectra(made, one);
  CHECK(sampled.values(0)[0] == doctest::Approx(0.1).epsilon(0.02));
  CHECK(sampled.values(0)[1] == doctest::Approx(0.3).epsilon(0.02));
  const scratch::folder here;
  gonio::io::write_rgl(here / "ir.bsdf", made);
  const auto read = gonio::io::read_rgl(here / "ir.bsdf");
  REQUIRE(read.spectra);
  CHECK(read.spectra->wavelengths == made.spectra->wavelengths);
  CHECK(gonio::io::sample_spectra(read, one).values(0)[1] == doctest::Approx(sampled.values(0)[1]).epsilon(1e-5));
  check_refused([&] { return gonio::io::colours_of(read, "ir.bsdf"); }, {"ir.bsdf", "905 to 1550 nm", "no colour"});
}
