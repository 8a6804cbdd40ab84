#include "../io/scratch.hpp"
#include <gonio/model/physical_properties.hpp>
#include <gonio/model/sufficient_wavelengths.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

using Eigen::Index;
using gonio::model::sufficient_wavelengths;
using positions = std::vector<Index>;

namespace {

const gonio::valid_cells& cells() {
  static const gonio::valid_cells small(gonio::grid({30, 15, 12}));
  return small;
}

std::vector<double> wavelengths(double first, double step, Index count) {
  std::vector<double> all;
  for (Index i = 0; i < count; ++i) all.push_back(first + step * static_cast<double>(i));
  return all;
}

/// Returns a table of spectra from `value(cell, nanometres)`.
gonio::spectral_table table_of(const std::vector<double>& at, const std::function<double(Index, double)>& value) {
  gonio::spectral_table table(cells(), at);
  for (Index cell = 0; cell < cells().size(); ++cell)
    for (Index band = 0; band < table.bands(); ++band)
      table.values()(cell, band) = static_cast<float>(value(cell, at[static_cast<std::size_t>(band)]));
  return table;
}

double both_cosines(Index cell) {
  const gonio::cosine_pair cosine = gonio::cosines(cells().angles(cell));
  return cosine.i * cosine.o;
}

/// Two pigments under a clear coat: no spectrum is a multiple of another.
gonio::spectral_table smooth_paint() {
  return table_of(wavelengths(400.0, 1.0, 301), [](Index cell, double nanometres) {
    const gonio::half_difference angles = cells().angles(cell);
    const double share = angles.theta_d / std::numbers::pi;
    return share * (0.15 + 0.1 * std::sin(nanometres / 60.0)) +
           (1.0 - share) * (0.2 + 0.1 * std::cos(nanometres / 90.0)) +
           2.0 * std::exp(-angles.theta_h * angles.theta_h / 0.02);
  });
}

/// Returns the table with the values between the chosen wavelengths interpolated linearly.
gonio::spectral_table linear_between(const gonio::spectral_table& table, const positions& chosen) {
  gonio::spectral_table read = table;
  const std::vector<double>& at = table.wavelengths();
  for (std::size_t k = 1; k < chosen.size(); ++k)
    for (Index band = chosen[k - 1]; band <= chosen[k]; ++band) {
      const double share = (at[band] - at[chosen[k - 1]]) / (at[chosen[k]] - at[chosen[k - 1]]);
      read.values().col(band) = static_cast<float>(1.0 - share) * table.values().col(chosen[k - 1]) +
                                static_cast<float>(share) * table.values().col(chosen[k]);
    }
  return read;
}

double albedo(const gonio::spectral_table& table, Index band, double degrees) {
  const gonio::brdf_table one = table.at_wavelength(band);
  return gonio::model::directional_albedo(one, gonio::radians(degrees), 100).x();
}

positions all_of(const gonio::spectral_table& table) {
  positions all;
  for (Index band = 0; band < table.bands(); ++band) all.push_back(band);
  return all;
}

}  // namespace

TEST_CASE("a few wavelengths of smooth spectra suffice, and what is linear between them is within the tolerance") {
  const gonio::spectral_table table = smooth_paint();
  std::size_t before = 302;
  for (const double tolerance : {0.0005, 0.006, 0.02}) {
    CAPTURE(tolerance);
    const positions chosen = sufficient_wavelengths(table, tolerance);
    CHECK(chosen.size() < before);
    before = chosen.size();
    CHECK(chosen.front() == 0);
    CHECK(chosen.back() == 300);
    const gonio::spectral_table read = linear_between(table, chosen);
    double worst = 0.0;
    for (Index band = 0; band < table.bands(); ++band) {
      const double diffuser = albedo(table, band, 0.0) / std::numbers::pi;
      for (Index cell = 0; cell < cells().size(); ++cell) {
        const double value = table.values()(cell, band), off = std::abs(double{read.values()(cell, band)} - value);
        worst = std::max(worst, off / std::max(value, 0.1 * diffuser / both_cosines(cell)));
      }
    }
    CHECK(worst < 1.001 * tolerance);
    CHECK(worst > 0.8 * tolerance);  // no more wavelengths than needed
    for (Index band = 0; band < table.bands(); band += 10)
      for (const double degrees : {0.0, 30.0, 80.0})
        CHECK(albedo(read, band, degrees) == doctest::Approx(albedo(table, band, degrees)).epsilon(1.001 * tolerance));
  }
  CHECK(sufficient_wavelengths(table).size() < 20);
  CHECK(sufficient_wavelengths(table, 0.006, gonio::thread_count{3}) == sufficient_wavelengths(table));
}

TEST_CASE("a narrow line keeps its neighbours, be it in one cell alone") {
  const std::vector<double> at = wavelengths(400.0, 10.0, 31);
  CHECK(sufficient_wavelengths(table_of(at, [](Index, double nanometres) {
          return nanometres == 550.0 ? 0.1 : 0.2;
        })) == positions{0, 14, 15, 16, 30});
  const Index one = cells().size() / 3;
  REQUIRE(both_cosines(one) > 0.3);
  CHECK(sufficient_wavelengths(table_of(at, [&](Index cell, double nanometres) {
          return nanometres == 550.0 && cell == one ? 0.21 : 0.2;
        })) == positions{0, 14, 15, 16, 30});
}

TEST_CASE("the farthest wavelength is found behind one that is too far") {
  // The line to the third point is too steep for the second; the line to the fourth is close to both.
  const gonio::spectral_table table = table_of({400.0, 410.0, 420.0, 430.0}, [](Index, double nanometres) {
    return nanometres < 420.0 ? 0.2 : nanometres == 420.0 ? 0.205 : 0.20525;
  });
  CHECK(sufficient_wavelengths(table, 0.01) == positions{0, 3});
}

TEST_CASE("what reflects next to nothing and what grazes counts by the albedo alone") {
  const auto with_line = [](const std::function<bool(Index)>& dark, double factor) {
    return table_of({500.0, 550.0, 600.0}, [&, factor](Index cell, double nanometres) {
      return dark(cell) ? factor * (nanometres == 550.0 ? 1.1 : 1.0) : 0.2;
    });
  };
  const Index one = cells().size() / 3;
  REQUIRE(both_cosines(one) > 0.3);
  CHECK(sufficient_wavelengths(with_line([&](Index cell) { return cell == one; }, 1e-4)) == positions{0, 2});
  CHECK(sufficient_wavelengths(with_line([&](Index cell) { return cell == one; }, 0.2)) == positions{0, 1, 2});
  CHECK(sufficient_wavelengths(with_line([](Index cell) { return both_cosines(cell) < 0.01; }, 0.01)) ==
        positions{0, 2});
  // So dark towards grazing angles that no cell counts, but the albedo for light at 80 degrees shows the line.
  const gonio::spectral_table falling = table_of({500.0, 550.0, 600.0}, [](Index cell, double nanometres) {
    const gonio::cosine_pair cosine = gonio::cosines(cells().angles(cell));
    const bool grazes = std::min(cosine.i, cosine.o) < 0.25;
    return 0.3 * std::pow(cosine.i * cosine.o, 4) * (grazes && nanometres == 550.0 ? 1.05 : 1.0);
  });
  CHECK(sufficient_wavelengths(falling) == positions{0, 1, 2});
}

TEST_CASE("the first and the last of visible wavelengths are kept, so that there is a colour") {
  const auto grey = [](Index, double) { return 0.2; };
  CHECK(sufficient_wavelengths(table_of(wavelengths(300.0, 50.0, 20), grey)) == positions{0, 2, 10, 19});
  CHECK(sufficient_wavelengths(table_of(wavelengths(400.0, 50.0, 8), grey)) == positions{0, 7});
  CHECK(sufficient_wavelengths(table_of(wavelengths(900.0, 50.0, 8), grey)) == positions{0, 7});
  CHECK(sufficient_wavelengths(table_of(wavelengths(550.0, 50.0, 2), grey)) == positions{0, 1});
}

TEST_CASE("a tolerance of zero keeps all wavelengths, and one below zero is refused") {
  const gonio::spectral_table grey = table_of(wavelengths(400.0, 10.0, 31), [](Index, double) { return 0.2; });
  CHECK(sufficient_wavelengths(grey, 0.0) == all_of(grey));
  for (const double tolerance : {-0.1, std::numeric_limits<double>::quiet_NaN()})
    scratch::check_refused([&] { return sufficient_wavelengths(grey, tolerance); }, {"tolerance"});
}
