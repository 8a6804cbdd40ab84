#include "../sampler_checks.hpp"
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/lookup_table.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <filesystem>

using gonio::direction;
using gonio::rgb;
using gonio::render::half_vector_sampler;

namespace {

/// A Lambertian plus a lobe around the half vector.
struct shiny {
  double diffuse = 0.2, height = 3.0, exponent = 200.0;

  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const double lobe = height * std::pow((wi + wo).normalized().z(), exponent);
    return rgb(diffuse, 0.5 * diffuse, 0.1) * std::numbers::inv_pi + lobe;
  }
};
static_assert(gonio::brdf<shiny>);
static_assert(gonio::direction_sampler<half_vector_sampler<shiny>>);

constexpr shiny satin{0.3, 0.5, 20.0};

const std::array seen_at{0.0, 30.0, 60.0, 80.0, 89.0};

direction viewer(double theta) { return gonio::spherical_direction(gonio::radians(theta), 0.7); }

struct named_table {
  std::string name;
  gonio::render::lookup_table<> table;
};

/// The ten test materials of Nielsen et al. 2015 on a grid coarser than MERL's. If their networks are missing, ten
/// formulas.
const std::vector<named_table>& ten_materials() {
  static const auto all = [] {
    const gonio::valid_cells cells(gonio::grid({90, 30, 60}));
    std::vector<named_table> made;
    const std::filesystem::path file = GONIO_SHARED_DATA "/measured-materials/merl_networks.npy";
    if (std::filesystem::exists(file)) {
      const auto networks = gonio::io::read_networks(file);
      for (std::size_t i = 0; i < networks.names.size(); ++i)
        if (std::ranges::count(gonio::nielsen_test_materials(), networks.names[i]) != 0)
          made.push_back({networks.names[i], gonio::render::lookup_table<>::of(tabulate(networks.networks[i], cells))});
      return made;
    }
    for (int i = 0; i < 10; ++i) {
      const gonio::model::sum_of_lobes material{
          gonio::model::lambertian{rgb::Constant(0.08 * i)},
          gonio::model::ggx{.alpha = 0.6 * std::exp(-0.4 * i), .f0 = rgb::Constant(0.05)}};
      made.push_back(
          {"formula " + std::to_string(i), gonio::render::lookup_table<>::tabulated(material, cells.grid())});
    }
    return made;
  }();
  return all;
}

}  // namespace

TEST_CASE("half-vector sampler: the weight times pdf is f times the cosine") {
  const half_vector_sampler sampler(satin);
  CHECK(rc::check("of every direction drawn", [&] {
    const auto number = [] { return *rc::gen::inRange(0, 1'000'000) / 1e6; };
    const direction wo = viewer(*rc::gen::inRange(0, 90));
    const auto drawn = sampler.sample(wo, number(), number());
    RC_ASSERT(std::abs(drawn.wi.norm() - 1.0) < 1e-12);
    RC_ASSERT(drawn.pdf > 0.0 || drawn.wi.z() <= 1e-6);
    RC_ASSERT(drawn.pdf == sampler.pdf(drawn.wi, wo));
    const rgb expected = drawn.wi.z() > 0.0 ? rgb(satin(drawn.wi, wo) * drawn.wi.z()) : rgb(rgb::Zero());
    RC_ASSERT(((drawn.weight * drawn.pdf - expected).abs() <= 1e-12 * expected).all());
    RC_ASSERT((drawn.weight <= 10.0001 * std::numbers::pi * satin(drawn.wi, wo)).all());
  }));
}

TEST_CASE("half-vector sampler: ten materials, five angles: chi-square, integral, albedo and variance") {
  const int tests = static_cast<int>(ten_materials().size() * seen_at.size());
  double least_p = 1.0, worst_integral = 0.0, worst_albedo = 0.0;
  std::uint64_t seed = 1;
  for (const auto& [name, table] : ten_materials()) {
    const gonio::brdf_view f(table);
    const half_vector_sampler sampler(f);
    for (const double theta : seen_at) {
      INFO(name << " at " << theta << " degrees");
      const direction wo = viewer(theta);
      const double p = sampler_checks::chi_square_p_value(sampler, wo, 100'000, ++seed);
      CHECK(p > sampler_checks::sidak(0.01, tests));
      least_p = std::min(least_p, p);

      const double integral = sampler_checks::integral_of_pdf(sampler, wo);
      CHECK(integral == doctest::Approx(1.0).epsilon(0.005));
      worst_integral = std::max(worst_integral, std::abs(integral - 1.0));

      const auto sampled = sampler_checks::albedo_by_sampling(sampler, wo, 20'000, seed);
      const double albedo = sampler_checks::albedo_by_quadrature(f, wo);
      const double off = (sampled.mean - albedo) / sampled.standard_error;
      CHECK(std::abs(off) < 3.0);
      worst_albedo = std::max(worst_albedo, std::abs(off));
      CHECK(sampled.variance < 1.3 * sampler_checks::albedo_by_cosine(f, wo, 20'000, seed).variance);
    }
  }
  MESSAGE(tests << " tests: least p value " << least_p << " (" << sampler_checks::sidak(0.01, tests)
                << " would fail), integral of pdf off by at most " << worst_integral << ", albedo by at most "
                << worst_albedo << " standard errors");
}

TEST_CASE("half-vector sampler: much less variance than cosine-weighted directions have where the surface shines") {
  const shiny metal{0.02, 20.0, 1000.0};
  const half_vector_sampler sampler(metal);
  double variance = 0.0, variance_of_cosines = 0.0;
  for (const double theta : seen_at) {
    variance += sampler_checks::albedo_by_sampling(sampler, viewer(theta), 40'000, 9).variance;
    variance_of_cosines += sampler_checks::albedo_by_cosine(metal, viewer(theta), 40'000, 9).variance;
  }
  MESSAGE("variance of cosines " << variance_of_cosines / variance << " times ours");
  CHECK(variance < variance_of_cosines / 4.0);
}

TEST_CASE("half-vector sampler: in float it draws what it draws in double") {
  struct in_float {
    shiny f;
    Eigen::Array3f operator()(const Eigen::Vector3f& wi, const Eigen::Vector3f& wo) const noexcept {
      return f(wi.cast<double>(), wo.cast<double>()).cast<float>();
    }
  };
  const half_vector_sampler exact(satin);
  const half_vector_sampler<in_float, float> sampler(in_float{satin});
  sampler_checks::uniform_numbers number(3);
  int other = 0;
  for (int i = 0; i < 2'000; ++i) {
    const direction wo = viewer(5.0 + 80.0 * number());
    const auto u1 = static_cast<float>(number()), u2 = static_cast<float>(number());
    const auto expected = exact.sample(wo, u1, u2);
    const auto found = sampler.sample(wo.cast<float>(), u1, u2);
    CHECK(found.pdf == sampler.pdf(found.wi, wo.cast<float>()));
    // Rounding may select another bin.
    const bool is_same = (found.wi.cast<double>() - expected.wi).norm() < 1e-3 &&
                         std::abs(found.pdf - expected.pdf) < 1e-3 * expected.pdf;
    other += is_same ? 0 : 1;
  }
  CHECK(other < 20);
}

TEST_CASE("half-vector sampler: below the horizon nothing is drawn") {
  const half_vector_sampler sampler(satin);
  for (const direction& wo : {direction(0.0, 0.6, -0.8), direction(1.0, 0.0, 0.0), direction(0.0, 0.0, std::nan(""))}) {
    CHECK((sampler.sample(wo, 0.3, 0.3).weight == 0.0).all());
    CHECK(sampler.pdf(direction::UnitZ(), wo) == 0.0);
  }
}
