#include "../synthetic_materials.hpp"
#include <gonio/core/rgb.hpp>
#include <gonio/estimate/mirror_envelope.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

using gonio::mirror_envelope, gonio::radians, gonio::rgb;

namespace {

const gonio::valid_cells& merl_cells() {
  static const gonio::valid_cells cells;
  return cells;
}

/// A lobe of 4 degrees times a colour, with a dip of width 1 degree and this depth.
rgb dipping(const gonio::half_difference& at, double depth) {
  const double h = gonio::degrees(at.theta_h);
  return rgb(0.8, 0.5, 0.2) * (0.1 + std::exp(-h * h / 16.0) * (1.0 - depth * std::exp(-h * h)));
}

gonio::brdf_table dipping_table(double depth) {
  gonio::brdf_table table(merl_cells());
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    table.set(cell, dipping(table.cells().angles(cell), depth));
  return table;
}

}  // namespace

TEST_CASE("brightness does not fall towards the mirror direction, and keeps the brightest value") {
  CHECK(rc::check([] {
    const auto values = *rc::gen::container<std::vector<double>>(
        rc::gen::map(rc::gen::inRange(0, 1000), [](int value) { return value / 100.0; }));
    const double theta_d = radians(*rc::gen::inRange(0, 90));
    mirror_envelope<rgb> envelope(theta_d);
    double most = 0.0;
    for (const double value : values) {
      const rgb filled = envelope.next(rgb::Constant(value), value);
      most = std::max(most, value);
      const double share = mirror_envelope<rgb>::share_at(theta_d);
      RC_ASSERT(std::abs(filled[0] - (value + share * (most - value))) < 1e-12);
    }
  }));
  CHECK(mirror_envelope<rgb>::share_at(radians(70.0)) == 1.0);
  CHECK(mirror_envelope<rgb>::share_at(radians(75.0)) == doctest::Approx(0.5));
  CHECK(mirror_envelope<rgb>::share_at(radians(80.0)) == 0.0);
}

TEST_CASE("dips of a table are filled in its own colour, and nothing else is touched") {
  const gonio::brdf_table dip = dipping_table(0.6);
  gonio::brdf_table filled = dip;
  gonio::fill_mirror_dips(filled, gonio::thread_count(2));
  const auto& cells = merl_cells();
  const double brightest = [&] {
    double most = 0.0;
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) most = std::max(most, gonio::luminance(rgb(dip.at(cell))));
    return most;
  }();
  int raised = 0;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const auto at = cells.angles(cell);
    const rgb before = dip.at(cell), after = filled.at(cell);
    if (at.theta_h >= radians(8.0) || at.theta_d >= radians(80.0)) {
      REQUIRE((before == after).all());
      continue;
    }
    raised += (after > before).all() ? 1 : 0;
    REQUIRE((after >= before).all());
    REQUIRE((after * before[0] / after[0] - before).abs().maxCoeff() < 1e-6 * before[0]);
    if (at.theta_h < radians(0.5) && at.theta_d <= radians(70.0))
      REQUIRE(gonio::luminance(after) == doctest::Approx(brightest).epsilon(1e-6));
  }
  CHECK(raised > 10'000);
  gonio::brdf_table one_thread = dip;
  gonio::fill_mirror_dips(one_thread, gonio::thread_count(1));
  CHECK(std::ranges::equal(one_thread.values(), filled.values()));
}

TEST_CASE("a lobe without a dip, and one that is zero, keep their bytes") {
  for (const double depth : {0.0, 1.0}) {
    const gonio::brdf_table lobe = depth == 0.0 ? dipping_table(0.0) : gonio::brdf_table(merl_cells());
    gonio::brdf_table filled = lobe;
    gonio::fill_mirror_dips(filled);
    CHECK(std::ranges::equal(filled.values(), lobe.values()));
  }
}

TEST_CASE("the colours of filled spectra are filled colours; invisible ones are filled by their mean") {
  const gonio::valid_cells cells(gonio::grid({40, 6, 4}));
  for (const double first : {450.0, 1450.0}) {
    const gonio::channels kinds({first, first + 80.0, first + 160.0, first + 200.0});
    gonio::spectral_table spectra(cells, kinds.wavelengths());
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
      const Eigen::Array3f value = dipping(cells.angles(cell), 0.7).cast<float>();
      spectra.values().row(cell) << value[0], value[1], value[2], value[1];
    }
    const gonio::spectral_table before = spectra;
    gonio::fill_mirror_dips(spectra, kinds);
    const Eigen::Index mirror = cells.representative(cells.grid().linear({0, 1, 1}));
    CHECK(spectra.values().row(mirror).mean() > 1.5F * before.values().row(mirror).mean());
    if (!kinds.have_colour()) continue;
    gonio::brdf_table colours = before.colours();
    gonio::fill_mirror_dips(colours);
    const gonio::brdf_table filled = spectra.colours();
    for (Eigen::Index i = 0; i < std::ssize(colours.values()); ++i)
      REQUIRE(colours.values()[i] == doctest::Approx(filled.values()[i]).epsilon(1e-4));
  }
}
