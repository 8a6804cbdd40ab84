#include "../json.hpp"
#include <gonio/io/materials/networks.hpp>
#include <gonio/model/network_brdf.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

using gonio::direction;
using gonio::rgb;
using gonio::model::network_brdf;

namespace {

/// Random networks with values between 0 and a few sr^-1.
std::vector<network_brdf> random_networks(std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0.0f, 0.3f);
  std::vector<network_brdf> networks;
  for (std::size_t n = 0; n < count; ++n) {
    std::array<float, network_brdf::parameter_count> parameters;
    for (float& parameter : parameters) parameter = normal(random);
    networks.emplace_back(parameters);
  }
  return networks;
}

direction random_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return gonio::spherical_direction(std::acos(1e-3 + 0.999 * uniform(random)), 6.28 * uniform(random));
}

/// Compares to 1e-4; near zero, to the rounding of the exponent.
bool close(double value, double expected, double floor) {
  return std::abs(value - expected) <= std::max(1e-4 * expected, floor);
}

/// The network as its README defines it, index by index.
rgb spelled_out(const network_brdf& network, const gonio::half_difference& at) {
  const auto p = network.parameters();
  const std::array<double, 6> x{std::sin(at.theta_h),
                                0.0,
                                std::cos(at.theta_h),
                                std::sin(at.theta_d) * std::cos(at.phi_d),
                                std::sin(at.theta_d) * std::sin(at.phi_d),
                                std::cos(at.theta_d)};
  std::array<double, 21> a{}, b{};
  rgb y;
  for (std::size_t j = 0; j < 21; ++j) {
    a[j] = double{p[126 + j]};
    for (std::size_t i = 0; i < 6; ++i) a[j] += x[i] * double{p[21 * i + j]};
  }
  for (std::size_t j = 0; j < 21; ++j) {
    b[j] = double{p[588 + j]};
    for (std::size_t i = 0; i < 21; ++i) b[j] += std::max(a[i], 0.0) * double{p[147 + 21 * i + j]};
  }
  for (std::size_t j = 0; j < 3; ++j) {
    double sum = double{p[672 + j]};
    for (std::size_t i = 0; i < 21; ++i) sum += std::max(b[i], 0.0) * double{p[609 + 3 * i + j]};
    y[j] = std::max(std::exp(sum) - 1.0, 0.0);
  }
  return y;
}

}  // namespace

TEST_CASE("a network is evaluated as it is written down") {
  std::mt19937 random(1);
  for (const network_brdf& network : random_networks(5)) {
    for (int i = 0; i < 100; ++i) {
      const direction wi = random_direction(random), wo = random_direction(random);
      const rgb value = network(wi, wo), expected = spelled_out(network, gonio::to_half_difference(wi, wo));
      CHECK((value - expected).abs().maxCoeff() <= 1e-12 * (1.0 + expected.maxCoeff()));
      CHECK((network(wo, wi) - value).abs().maxCoeff() <= 1e-10 * (1.0 + expected.maxCoeff()));
    }
  }
}

TEST_CASE("a network is zero below the horizon and finite above") {
  const direction up(0.0, 0.0, 1.0), down(0.0, 0.6, -0.8), grazing(1.0, 0.0, 0.0);
  const network_brdf network = random_networks(1).front();
  for (const direction& bad : {down, grazing}) {
    CHECK((network(up, bad) == 0.0).all());
    CHECK((network(bad, up) == 0.0).all());
  }
  std::array<float, network_brdf::parameter_count> huge;
  huge.fill(1e6f);
  CHECK(network_brdf(huge)(up, up).isFinite().all());
}

TEST_CASE("the fast path agrees with the networks and does not depend on threads") {
  const gonio::valid_cells cells(gonio::grid({12, 11, 10}));
  const auto networks = random_networks(7);
  gonio::cell_matrix one, many;
  std::vector<double> fractions;
  gonio::model::tabulate_networks(networks, cells, one, {1},
                                  [&](std::string_view, double f) { fractions.push_back(f); });
  gonio::model::tabulate_networks(networks, cells, many, {5});
  REQUIRE(one.rows() == cells.size());
  REQUIRE(one.cols() == 21);
  REQUIRE(many.size() == one.size());
  CHECK(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)) == 0);
  CHECK(std::ranges::is_sorted(fractions));
  CHECK(fractions.back() == 1.0);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const auto [wi, wo] = gonio::to_directions(cells.angles(cell));
    for (std::size_t n = 0; n < networks.size(); ++n) {
      const rgb expected = networks[n](wi, wo);
      for (Eigen::Index c = 0; c < 3; ++c) REQUIRE(close(double{one(cell, 3 * n + c)}, expected[c], 1e-6));
    }
  }
}

TEST_CASE("no networks make an empty matrix") {
  gonio::cell_matrix values;
  gonio::model::tabulate_networks({}, gonio::valid_cells(gonio::grid({2, 2, 2})), values);
  CHECK(values.cols() == 0);
}

TEST_CASE("decoded materials have the reference's values") {
  const std::filesystem::path path = GONIO_SHARED_DATA "/measured-materials/merl_networks.npy";
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: " << path.string() << " is not here");
    return;
  }
  const gonio::model::named_networks all = gonio::io::read_networks(path);
  const auto spots = golden_json("decode_spots.json");
  REQUIRE(spots.size() > 10);
  const gonio::valid_cells cells;
  // The vectorised evaluation, for a few of the materials.
  gonio::model::named_networks few;
  for (std::size_t spot = 0; spot < 3; ++spot) {
    const std::string name = spots[spot]["material"];
    few.names.push_back(name);
    few.networks.push_back(all.networks[std::ranges::find(all.names, name) - all.names.begin()]);
  }
  const gonio::material_set tables = gonio::model::tabulate_networks(few, cells);
  CHECK(tables.names == few.names);

  for (const auto& spot : spots) {
    const auto found = std::ranges::find(all.names, spot["material"].get<std::string>());
    REQUIRE(found != all.names.end());
    const network_brdf& network = all.networks[found - all.names.begin()];
    const auto linear = spot["linear"].get<std::size_t>();
    REQUIRE(cells.contains(linear));
    const std::size_t cell = cells.representative(linear);
    const auto [wi, wo] = gonio::to_directions(cells.angles(cell));
    const rgb value = network(wi, wo);
    const auto known = std::ranges::find(few.names, *found);
    for (std::size_t c = 0; c < 3; ++c) {
      const double expected = spot["rgb"][c];
      CAPTURE(*found);
      CHECK(close(value[c], expected, 1e-7));
      if (known == few.names.end()) continue;
      const auto column = 3 * (known - few.names.begin()) + c;
      CHECK(close(double{tables.values(cell, column)}, expected, 1e-6));
    }
  }
}
