#include "../sampler_checks.hpp"
#include "physical.hpp"
#include <gonio/model/lobe_sampler.hpp>

#include <limits>
#include <string>
#include <vector>

using gonio::direction;
using gonio::rgb;
using gonio::model::analytic_brdf;
using gonio::model::analytic_lobe;
using gonio::model::analytic_sampler;
using gonio::model::lobe_kind;
using gonio::model::lobe_sampler;

namespace {

const std::array angles_of_view{0.0, 30.0, 60.0, 80.0, 89.0};

direction seen_from(double theta) { return gonio::spherical_direction(gonio::radians(theta), 0.7); }

analytic_lobe white(const lobe_kind& kind, const lobe_kind::values& parameters) {
  return {kind, rgb::Ones(), parameters};
}
analytic_lobe white(std::string_view name, const lobe_kind::values& parameters) {
  return white(gonio::model::lobe_kind_named(name), parameters);
}

template <template <class> class Shape>
analytic_lobe brushed(double along_x, double along_y) {
  return white(lobe_kind::of<Shape>(), {along_x, along_y});
}

using gonio::model::detail::ward_normalisation;
template <ward_normalisation Normalisation>
constexpr auto brushed_ward = brushed<gonio::model::detail::anisotropic_ward<Normalisation>::template shape>;

/// Returns lobes of every kind, rough and sharp.
const std::vector<analytic_lobe>& single_lobes() {
  static const std::vector<analytic_lobe> all{white("lambert", {}),
                                              white("phong", {0.5}),
                                              white("phong", {2000.0}),
                                              white("blinn-phong", {5.0}),
                                              white("blinn-phong", {2000.0}),
                                              white("phong-blinn", {0.5, 0.4}),
                                              white("phong-blinn", {200.0, 0.6}),
                                              white("phong-fresnel", {100.0, 1.5}),
                                              white("ward", {0.05}),
                                              white("ward", {0.6}),
                                              white("ward-duer", {0.03}),
                                              white("ward-duer", {0.4}),
                                              white("ward-bounded", {0.01}),
                                              white("ward-bounded", {0.5}),
                                              brushed_ward<ward_normalisation::geometric_mean>(0.03, 0.3),
                                              brushed_ward<ward_normalisation::product>(0.1, 0.05),
                                              brushed_ward<ward_normalisation::bounded>(0.5, 0.1),
                                              white("lafortune", {0.7, 3.0}),
                                              white("lafortune", {0.9, 200.0}),
                                              white("lafortune", {-0.7, 50.0}),
                                              white("torrance-sparrow", {0.03, 0.1}),
                                              white("torrance-sparrow", {0.5, 0.9}),
                                              white("ggx", {0.01, 0.1}),
                                              white("ggx", {0.2, 0.04}),
                                              white("ggx", {1.0, 1.0}),
                                              white("ward-anisotropic", {0.05, 0.4, 0.6}),
                                              white("ggx-anisotropic", {0.05, 0.4, 0.04, -0.6}),
                                              white("ggx-anisotropic", {0.6, 0.3, 0.9, 1.2})};
  return all;
}

/// Returns the single lobes, a sum like those that fits return, and a BRDF without lobes.
std::vector<analytic_brdf> models() {
  std::vector<analytic_brdf> all;
  for (const analytic_lobe& lobe : single_lobes()) all.push_back(analytic_brdf({lobe}));
  all.push_back(analytic_brdf({{gonio::model::lobe_kind_named("lambert"), {0.5, 0.2, 0.1}, {}},
                               {gonio::model::lobe_kind_named("ward"), rgb::Constant(0.2), {0.05}},
                               {gonio::model::lobe_kind_named("ggx"), {0.2, 0.3, 0.4}, {0.3, 0.2}}}));
  all.emplace_back();
  return all;
}

std::string name_of(const analytic_brdf& f) {
  std::string name;
  for (const analytic_lobe& lobe : f.lobes()) {
    name += std::string(name.empty() ? "" : " + ") + std::string(lobe.kind().name());
    for (std::size_t i = 0; i < lobe.kind().parameters().size(); ++i)
      name += ' ' + std::to_string(lobe.parameters()[i]);
  }
  return name;
}

/// From 0 up to 1.
double any_number() { return 0.999999 * any_fraction(); }

/// Draws the directions of one sampler and returns the densities of another.
template <class Drawn, class Told>
struct mismatched {
  Drawn drawn;
  Told told;
  double factor = 1.0;

  gonio::sampled_direction sample(const direction& wo, double u1, double u2) const noexcept {
    return drawn.sample(wo, u1, u2);
  }
  double pdf(const direction& wi, const direction& wo) const noexcept { return factor * told.pdf(wi, wo); }
};

}  // namespace

namespace someone {

/// A shape that the library does not have, similar to Phong's.
template <class Real>
struct narrow_shape {
  static constexpr std::string_view name = "narrow";
  static constexpr std::array<gonio::model::shape_parameter, 0> parameters{};
  static auto members(auto& /*self*/) { return std::tie(); }
  Real operator()(const gonio::model::lobe_geometry& at) const {
    return gonio::model::detail::cosine_power(at.mirrored_cosine(), 80.0);
  }
};

gonio::model::sampling_techniques techniques_of(const narrow_shape<double>& /*shape*/) {
  return {{gonio::model::power_cosine_directions{.exponent = 80.0}, 1.0}};
}

}  // namespace someone

TEST_CASE("lobe sampler: what is drawn is what pdf says (chi-square), and pdf integrates to 1 over the sphere") {
  const auto all = models();
  const double least = sampler_checks::sidak(0.01, static_cast<int>(all.size() * angles_of_view.size()));
  std::uint64_t seed = 100;
  for (const analytic_brdf& f : all) {
    const analytic_sampler sampler(f);
    for (const double theta : angles_of_view) {
      INFO(name_of(f) << " at " << theta << " degrees");
      const direction wo = seen_from(theta);
      const auto shares = sampler_checks::shares_of_bins(sampler, wo);
      CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == doctest::Approx(1.0).epsilon(0.001));
      CHECK(sampler_checks::chi_square_p_value(sampler, wo, shares, 100'000, ++seed) > least);
    }
  }
}

TEST_CASE("lobe sampler: a white furnace is as bright by sampling as by quadrature, within three standard errors") {
  std::uint64_t seed = 1000;
  for (const analytic_brdf& f : models()) {
    const analytic_sampler sampler(f);
    for (const double theta : angles_of_view) {
      INFO(name_of(f) << " at " << theta << " degrees");
      const direction wo = seen_from(theta);
      const auto [mean, variance, error] = sampler_checks::albedo_by_sampling(sampler, wo, 20'000, ++seed);
      const double albedo = sampler_checks::albedo_by_quadrature(f, wo);
      CHECK(std::abs(mean - albedo) <= 3.0 * error + 3e-4 * albedo);
    }
  }
}

TEST_CASE("lobe sampler: the weight times pdf is f times the cosine") {
  std::vector<analytic_sampler> samplers;
  for (const analytic_brdf& f : models()) samplers.emplace_back(f);
  CHECK(rc::check("of every direction drawn", [&] {
    const direction wo = any_direction();
    RC_PRE(wo.z() > 0.0);
    const double u1 = any_number();
    const double u2 = any_number();
    for (const analytic_sampler& sampler : samplers) {
      const auto drawn = sampler.sample(wo, u1, u2);
      RC_ASSERT(std::abs(drawn.wi.norm() - 1.0) < 1e-12);
      RC_ASSERT(drawn.pdf == sampler.pdf(drawn.wi, wo));
      RC_ASSERT(std::isfinite(drawn.pdf) && drawn.pdf >= 0.0);
      const rgb expected = drawn.wi.z() > 0.0 ? rgb(sampler.brdf()(drawn.wi, wo) * drawn.wi.z()) : rgb(rgb::Zero());
      RC_ASSERT(((drawn.weight * drawn.pdf - expected).abs() <= 1e-12 * expected).all());
    }
  }));
}

TEST_CASE("lobe sampler: weights are bounded as the form of the lobe has it") {
  const auto worst_weight = [](const analytic_lobe& lobe) {
    const analytic_sampler sampler(analytic_brdf({lobe}));
    sampler_checks::uniform_numbers number(3);
    double worst = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      const direction wo = gonio::cosine_weighted_direction(number(), 0.0);
      const double u1 = number();
      const double u2 = number();
      worst = std::max(worst, sampler.sample(wo, u1, u2).weight.maxCoeff());
    }
    return worst;
  };
  for (const double roughness : {0.005, 0.1, 1.0}) {
    CAPTURE(roughness);
    CHECK(worst_weight(white("ggx", {roughness, 1.0})) < 1.0 + 1e-6);
    CHECK(worst_weight(white("ward-bounded", {roughness})) < 2.0 + 1e-6);
    CHECK(worst_weight(white("torrance-sparrow", {roughness, 1.0})) < 2.0 + 1e-6);
  }
  for (const double exponent : {1.0, 30.0, 10'000.0}) {
    const double share = exponent / (exponent + 1.0);  // of the directions that are not cosine-weighted
    CAPTURE(exponent);
    CHECK(worst_weight(white("phong", {exponent})) < (exponent + 2.0) / (exponent + 1.0) / share);
    CHECK(worst_weight(white("blinn-phong", {exponent})) < (exponent + 8.0) / (exponent + 1.0) / share);
    CHECK(worst_weight(white("lafortune", {0.7, exponent})) < 2.0 * pi / (exponent + 1.0) / share * (1.0 + 1e-9));
  }
}

TEST_CASE("lobe sampler: weights of sharp lobes vary much less than those of cosine-weighted directions") {
  for (const analytic_lobe& lobe :
       {white("phong", {2000.0}), white("blinn-phong", {500.0}), white("phong-blinn", {200.0, 0.5}),
        white("ward", {0.05}), white("ward-duer", {0.05}), white("ward-bounded", {0.05}),
        white("lafortune", {0.9, 200.0}), white("torrance-sparrow", {0.05, 0.1}), white("ggx", {0.05, 0.1})}) {
    const analytic_brdf f({lobe});
    const analytic_sampler sampler(f);
    for (const double theta : {0.0, 30.0, 60.0}) {
      INFO(name_of(f) << " at " << theta << " degrees");
      const direction wo = seen_from(theta);
      CHECK(sampler_checks::albedo_by_sampling(sampler, wo, 5'000, 5).variance <
            0.05 * sampler_checks::albedo_by_cosine(f, wo, 50'000, 6).variance);
    }
  }
}

TEST_CASE("lobe sampler: a sum draws each lobe as often as its albedo is of the sum's") {
  const gonio::model::ward sharp(rgb::Constant(0.3), {.roughness = 0.02});
  const lobe_sampler both{gonio::model::sum_of_lobes{gonio::model::lambertian{rgb::Constant(0.1)}, sharp}};
  const lobe_sampler alone{sharp};
  const direction wo = seen_from(20.0), mirror(-wo.x(), -wo.y(), wo.z());
  // Near the mirror direction the diffuse lobe's own density is negligible.
  const double share = both.pdf(mirror, wo) / alone.pdf(mirror, wo);
  const double albedo = sampler_checks::albedo_by_quadrature(sharp, wo);
  CHECK(share == doctest::Approx(albedo / (albedo + 0.1)).epsilon(0.02));
}

TEST_CASE("lobe sampler: a model of known type is drawn as the same chosen at run time") {
  const auto check_same = [](const auto& f, const std::vector<analytic_lobe>& lobes) {
    const lobe_sampler known{f};
    const analytic_sampler chosen{analytic_brdf(lobes)};
    sampler_checks::uniform_numbers number(8);
    for (int i = 0; i < 50; ++i) {
      const direction wo = gonio::spherical_direction(1.5 * number(), 1.0);
      const double u1 = number();
      const double u2 = number();
      const auto a = known.sample(wo, u1, u2), b = chosen.sample(wo, u1, u2);
      CHECK((a.wi - b.wi).norm() < 1e-12);
      CHECK(a.pdf == doctest::Approx(b.pdf).epsilon(1e-9));
      CHECK(a.weight.mean() == doctest::Approx(b.weight.mean()).epsilon(1e-9));
    }
  };
  check_same(gonio::model::lambertian{}, {white("lambert", {})});
  check_same(gonio::model::phong(rgb::Ones(), {20.0}), {white("phong", {20.0})});
  check_same(gonio::model::blinn_phong_fresnel(rgb::Ones(), {{30.0}, 1.4}),
             {white("blinn-phong-fresnel", {30.0, 1.4})});
  check_same(gonio::model::ward_duer(rgb::Ones(), {0.1}), {white("ward-duer", {0.1})});
  check_same(gonio::model::anisotropic_ward(rgb::Ones(), {0.1, 0.4}),
             {brushed_ward<ward_normalisation::geometric_mean>(0.1, 0.4)});
  check_same(gonio::model::ggx_lobe(rgb::Ones(), {0.3, 0.2}), {white("ggx", {0.3, 0.2})});
  check_same(gonio::model::anisotropic_ggx(rgb::Ones(), {0.1, 0.4, 0.2, 0.3}),
             {white("ggx-anisotropic", {0.1, 0.4, 0.2, 0.3})});
  check_same(gonio::model::ggx{0.3, rgb::Constant(0.2)}, {white("ggx", {0.3, 0.2})});
  check_same(gonio::model::sum_of_lobes{gonio::model::sum_of_lobes{gonio::model::lambertian{}},
                                        gonio::model::ggx{0.3, rgb::Constant(0.2)}},
             {white("lambert", {}), white("ggx", {0.3, 0.2})});
  check_same(gonio::model::formula_material("blue-rubber"),
             {{gonio::model::lobe_kind_named("lambert"), {0.03, 0.07, 0.28}, {}}, white("ggx", {0.5, 0.03})});
  check_same(gonio::model::sum_of_lobes<>{}, {});
}

TEST_CASE("lobe sampler: a shape of one's own is drawn by its techniques; a kind that only has a name, by cosines") {
  const gonio::model::lobe<someone::narrow_shape> f;
  const lobe_sampler own{f};
  const analytic_sampler named(analytic_brdf({white(lobe_kind::of<someone::narrow_shape>(), {})}));
  for (const double theta : {0.0, 60.0}) {
    const direction wo = seen_from(theta);
    const double albedo = sampler_checks::albedo_by_quadrature(f, wo);
    const auto by_own = sampler_checks::albedo_by_sampling(own, wo, 20'000, 1);
    const auto by_name = sampler_checks::albedo_by_sampling(named, wo, 20'000, 2);
    CHECK(std::abs(by_own.mean - albedo) < 3.0 * by_own.standard_error);
    CHECK(std::abs(by_name.mean - albedo) < 3.0 * by_name.standard_error);
    CHECK(by_own.variance < 0.1 * by_name.variance);
  }
}

TEST_CASE("lobe sampler: below the horizon, and of what is no direction, nothing is drawn") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const analytic_brdf& f : models()) {
    const analytic_sampler sampler(f);
    for (const direction& wo : {direction(0.0, 0.6, -0.8), direction(1.0, 0.0, 0.0), direction(0.0, 0.0, nan),
                                direction(nan, 0.0, 1.0), direction(nan, nan, nan)}) {
      const auto drawn = sampler.sample(wo, 0.3, 0.3);
      CHECK((drawn.weight == 0.0).all());
      CHECK(drawn.pdf == 0.0);
      CHECK(sampler.pdf(direction::UnitZ(), wo) == 0.0);
    }
    // At the edge of the horizon, and with the smallest and largest random numbers.
    for (const direction& wo : {direction(1.0, 0.0, 1e-300), direction(1.0, 0.0, 1e-12), seen_from(0.0)})
      for (const double u1 : {0.0, 1.0 - 0x1p-53})
        for (const double u2 : {0.0, 1.0 - 0x1p-53}) {
          const auto drawn = sampler.sample(wo, u1, u2);
          CHECK(drawn.wi.allFinite());
          CHECK((drawn.pdf >= 0.0 && std::isfinite(drawn.pdf)));
          CHECK((drawn.weight >= 0.0).all());
          CHECK(drawn.weight.isFinite().all());
        }
  }
}

TEST_CASE("sampler checks: p values of a correct sampler are uniform, and slightly wrong ones are noticed") {
  const auto ward_of = [](double roughness) { return lobe_sampler{gonio::model::ward(rgb::Ones(), {roughness})}; };
  using sampler = decltype(ward_of(0.1));
  for (const double theta : {0.0, 60.0, 89.0}) {
    CAPTURE(theta);
    const direction wo = seen_from(theta);
    const mismatched<sampler, sampler> right{ward_of(0.1), ward_of(0.1)}, rougher{ward_of(0.1), ward_of(0.103)},
        larger{ward_of(0.1), ward_of(0.1), 1.03};
    const auto shares = sampler_checks::shares_of_bins(right, wo);
    std::array<int, 4> quarters{};
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const double p = sampler_checks::chi_square_p_value(right, wo, shares, 20'000, seed);
      ++quarters[std::min<std::size_t>(3, static_cast<std::size_t>(4.0 * p))];
    }
    // About ten of 40; outside of 2 to 20 with a probability of 0.002.
    for (const int count : quarters) CHECK((count >= 2 && count <= 20));
    // With the significance level of one of 150 tests.
    CHECK(sampler_checks::chi_square_p_value(rougher, wo, 100'000, 1) < sampler_checks::sidak(0.01, 150));
    CHECK(sampler_checks::chi_square_p_value(larger, wo, 100'000, 1) < 0.01);
    CHECK(sampler_checks::integral_of_pdf(larger, wo) == doctest::Approx(1.03).epsilon(0.001));
    CHECK(sampler_checks::integral_of_pdf(rougher, wo) == doctest::Approx(1.0).epsilon(0.001));
  }
}

TEST_CASE("sampler checks: the tail of the chi-square distribution") {
  // Closed forms: Q(1, x) = exp(-x), Q(1/2, x) = erfc(sqrt x), Q(3, x) = exp(-x) (1 + x + x^2 / 2).
  for (const double x : {0.01, 0.5, 1.9, 3.0, 20.0}) {
    CHECK(sampler_checks::upper_gamma(1.0, x) == doctest::Approx(std::exp(-x)).epsilon(1e-12));
    CHECK(sampler_checks::upper_gamma(0.5, x) == doctest::Approx(std::erfc(std::sqrt(x))).epsilon(1e-12));
    CHECK(sampler_checks::upper_gamma(3.0, x) == doctest::Approx(std::exp(-x) * (1 + x + x * x / 2)).epsilon(1e-12));
  }
  CHECK(sampler_checks::upper_gamma(150.0, 150.0) == doctest::Approx(0.4891).epsilon(0.001));
  CHECK(sampler_checks::sidak(0.01, 1) == doctest::Approx(0.01));
  CHECK(sampler_checks::sidak(0.01, 100) == doctest::Approx(1.00498e-4).epsilon(1e-4));
}
