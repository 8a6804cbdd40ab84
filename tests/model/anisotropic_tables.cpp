/// Adaptive tables of anisotropic materials: look-up and tabulation.

#include "../io/scratch.hpp"
#include <gonio/model/clipped_brdf.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/tabulate_adaptively.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using gonio::direction;
using gonio::rgb;
using gonio::model::adaptive_brdf;
using gonio::model::adaptive_brdf_parts;
using gonio::model::anisotropic_resolution;
using gonio::model::unit_square_tables;

namespace {

constexpr double pi = std::numbers::pi;

direction random_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return gonio::spherical_direction(std::acos(1e-3 + 0.999 * uniform(random)), 6.28 * uniform(random));
}

/// A material whose tables have different sizes and random values.
adaptive_brdf_parts random_material(std::vector<double> phi_i, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.1f, 1.0f);
  const auto any = [&](Eigen::Index tables, Eigen::Index rows, Eigen::Index columns) {
    unit_square_tables all{tables, rows, columns, std::vector<float>(tables * rows * columns)};
    for (float& value : all.values) value = uniform(random);
    return all;
  };
  const Eigen::Index lights = 4 * std::ssize(phi_i);
  return {{0.0, 0.3, 0.9, pi / 2}, any(1, 3, 7),          any(1, 5, 6),
          any(lights, 5, 9),       any(3 * lights, 4, 3), std::move(phi_i)};
}

/// The BRDF as the header defines it, from the parts, by functions of the standard library.
class plain_evaluation {
 public:
  explicit plain_evaluation(const adaptive_brdf_parts& parts) : parts_(parts) {}

  rgb operator()(const direction& wi, const direction& wo) const {
    const direction h = (wi + wo).normalized();
    const double theta = std::acos(wi.z()), phi = std::atan2(wi.y(), wi.x());
    const double across = std::atan2(h.y(), h.x()) / (2.0 * pi) + 0.5, along = std::sqrt(std::acos(h.z()) / (pi / 2));
    const auto [u, v] = visible_position(theta, phi, across, along);
    const double area = value(parts_.projected_area, 0, phi / (2.0 * pi) + 0.5, std::sqrt(theta / (pi / 2)));
    rgb colour;
    for (Eigen::Index c = 0; c < 3; ++c)
      colour[c] = value(parts_.normals, 0, across, along) / (4.0 * area * wo.z()) *
                  between(theta, phi, [&](Eigen::Index t) { return value(parts_.reflectance, 3 * t + c, u, v); });
    return colour;
  }

 private:
  static double value(const unit_square_tables& tables, Eigen::Index table, double across, double along) {
    const double x = across * static_cast<double>(tables.rows - 1), y = along * static_cast<double>(tables.columns - 1);
    const Eigen::Index row = std::min(static_cast<Eigen::Index>(x), tables.rows - 2);
    const Eigen::Index column = std::min(static_cast<Eigen::Index>(y), tables.columns - 2);
    const float *low = tables.row(table, row) + column, *high = low + tables.columns;
    const double f = x - static_cast<double>(row), g = y - static_cast<double>(column);
    return (1.0 - f) * ((1.0 - g) * low[0] + g * low[1]) + f * ((1.0 - g) * high[0] + g * high[1]);
  }

  /// Returns the interval that contains a number, and the number's position in it, from 0 to 1.
  static std::pair<Eigen::Index, double> found(const std::vector<double>& among, double number) {
    Eigen::Index t = 0;
    while (t + 2 < std::ssize(among) && among[t + 1] <= number) ++t;
    return {t, std::clamp((number - among[t]) / (among[t + 1] - among[t]), 0.0, 1.0)};
  }

  /// Interpolates between two polar angles and two azimuths of the light.
  template <class Value>
  double between(double theta, double phi, const Value& value) const {
    const auto [angle, share] = found(parts_.theta_i, theta);
    const auto [turn, part] = found(parts_.phi_i, phi);
    const Eigen::Index n = std::ssize(parts_.theta_i), t = turn * n + angle;
    return std::lerp(std::lerp(value(t), value(t + 1), share), std::lerp(value(t + n), value(t + n + 1), share), part);
  }

  /// Returns the integral from 0 to `end` of a function that is linear between `nodes` nodes.
  template <class Value>
  static double integral(Eigen::Index nodes, double end, const Value& value) {
    const double step = 1.0 / static_cast<double>(nodes - 1);
    double sum = 0.0;
    for (Eigen::Index i = 0; i + 1 < nodes && static_cast<double>(i) * step < end; ++i) {
      const double from = static_cast<double>(i) * step, to = std::min(from + step, end);
      sum += 0.5 * (to - from) * (value(from) + value(to));
    }
    return sum;
  }

  /// Returns a half vector's position by the tables' cumulative densities: across the rows, and along the row.
  std::pair<double, double> visible_position(double theta, double phi, double across, double along) const {
    const unit_square_tables& visible = parts_.visible_normals;
    const auto row_of = [&](Eigen::Index t, double a, double end) {
      return integral(visible.columns, end, [&](double b) { return value(visible, t, a, b); });
    };
    const auto rows_of = [&](Eigen::Index t, double end) {
      return integral(visible.rows, end, [&](double a) { return row_of(t, a, 1.0); });
    };
    const auto row = [&](double end) {
      return between(theta, phi, [&](Eigen::Index t) { return row_of(t, across, end) / rows_of(t, 1.0); });
    };
    return {between(theta, phi, [&](Eigen::Index t) { return rows_of(t, across) / rows_of(t, 1.0); }),
            row(along) / row(1.0)};
  }

  const adaptive_brdf_parts& parts_;
};

const gonio::model::anisotropic_ggx& brushed() {
  static const gonio::model::anisotropic_ggx f(rgb(0.9, 0.6, 0.3),
                                               {.alpha_x = 0.15, .alpha_y = 0.4, .f0 = 0.8, .rotation = 0.5});
  return f;
}

/// Small tables of `brushed()`.
const adaptive_brdf& brushed_tables() {
  static const adaptive_brdf tables =
      tabulate_adaptively(brushed(), anisotropic_resolution{.phi_i = 25, .theta_i = 12, .values = 32, .normals = 64});
  return tables;
}

}  // namespace

TEST_CASE("anisotropic look-up agrees with what is written down from the definition") {
  std::mt19937 random(7);
  const adaptive_brdf material(random_material({-pi, -1.5, 0.2, 1.0, pi}, random));
  CHECK(material.is_anisotropic());
  CHECK(material.parts().lights() == 20);
  const plain_evaluation plain(material.parts());
  for (int i = 0; i < 2000; ++i) {
    const direction wi = random_direction(random), wo = random_direction(random);
    const rgb forth = plain(wi, wo), back = plain(wo, wi);
    CHECK((material.as_measured(wi, wo) / forth - 1.0).abs().maxCoeff() < 2e-5);
    CHECK((material(wi, wo) / (0.5 * (forth + back)) - 1.0).abs().maxCoeff() < 2e-5);
    CHECK((material(wi, wo) - material(wo, wi)).abs().maxCoeff() == 0.0);
  }
}

TEST_CASE("azimuths of half a turn or of a quarter stand for the others") {
  std::mt19937 random(8);
  const adaptive_brdf half(random_material({-pi, -1.5, -0.9, 0.0}, random));
  const adaptive_brdf quarter(random_material({-pi, -2.5, -1.8, -pi / 2}, random));
  const plain_evaluation of_half(half.parts()), of_quarter(quarter.parts());
  for (int i = 0; i < 500; ++i) {
    direction wi = random_direction(random), wo = random_direction(random);
    const rgb turned = half.as_measured(wi, wo), mirrored = quarter.as_measured(wi, wo);
    const direction first = wi;
    if (first.y() > 0.0) wi = {-wi.x(), -wi.y(), wi.z()}, wo = {-wo.x(), -wo.y(), wo.z()};
    CHECK((turned / of_half(wi, wo) - 1.0).abs().maxCoeff() < 2e-5);
    if (wi.x() > 0.0) wi.x() = -wi.x(), wo.x() = -wo.x();
    // The second plane of symmetry: a turn and a mirror image in x are a mirror image in y.
    CHECK((mirrored / of_quarter(wi, wo) - 1.0).abs().maxCoeff() < 2e-5);
  }
}

TEST_CASE("anisotropic tables are looked up within their edges, and below the horizon they are black") {
  std::mt19937 random(9);
  const adaptive_brdf material(random_material({-pi, 0.0, pi}, random));
  const direction up(0.0, 0.0, 1.0), side(1.0, 0.0, 1e-18), opposite(-1.0, 0.0, 1e-18), behind(-0.6, -1e-17, 0.8);
  for (const direction& wi : {up, side, opposite, behind})
    for (const direction& wo : {up, side, opposite, behind}) CHECK(material.as_measured(wi, wo).isFinite().all());
  CHECK((material(direction(0.6, 0.0, -0.8), up) == 0.0).all());
  CHECK((material.as_measured(up, direction(0.6, 0.0, -0.8)) == 0.0).all());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  static_cast<void>(material(direction(nan, 0.0, 1.0), up));  // a sanitizer would report an error
  static_cast<void>(material(direction(nan, nan, nan), direction(nan, 1.0, 1.0)));
}

TEST_CASE("azimuths that do not fit are refused") {
  const auto refused = [](std::vector<double> phi_i, std::initializer_list<std::string> words) {
    std::mt19937 random(1);
    adaptive_brdf_parts parts = random_material(std::move(phi_i), random);
    scratch::check_refused([&] { return adaptive_brdf(std::move(parts)); }, words);
  };
  refused({0.0, 1.0}, {"phi_i", "at least 3"});
  refused({-pi, 1.0, 0.0}, {"phi_i", "ascending"});
  refused({-pi, 0.0, 4.0}, {"from -pi to pi"});
  refused({-pi, std::numeric_limits<double>::quiet_NaN(), pi}, {"phi_i"});
  refused({-pi, -2.0, -1.0}, {"phi_i is from -3.14159", "half a turn"});
  refused({0.0, 1.5, pi}, {"phi_i is from 0", "to 0"});
  std::mt19937 random(1);
  adaptive_brdf_parts parts = random_material({-pi, 0.0, pi}, random);
  parts.phi_i.insert(parts.phi_i.begin() + 1, -1.0);
  scratch::check_refused([&] { return adaptive_brdf(std::move(parts)); }, {"needs 16 tables", "not 12"});
}

TEST_CASE("anisotropic tables agree with the GGX that they are made of") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> cosine(0.2, 1.0), turn(0.0, 2.0 * pi);
  std::vector<double> errors;
  double peak = 0.0, sum = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const direction wi = gonio::spherical_direction(std::acos(cosine(random)), turn(random)),
                    wo = gonio::spherical_direction(std::acos(cosine(random)), turn(random));
    const rgb truth = brushed()(wi, wo), found = brushed_tables().as_measured(wi, wo);
    errors.push_back(((found - truth).abs() / truth).maxCoeff());
    peak = std::max(peak, truth.maxCoeff());
    sum += (found - truth).abs().maxCoeff();
  }
  std::ranges::sort(errors);
  MESSAGE("median ", errors[2500], ", 99 % ", errors[4950], ", mean over peak ", sum / 5000.0 / peak);
  CHECK(errors[2500] < 0.02);
  CHECK(sum / 5000.0 < 0.002 * peak);
}

TEST_CASE("anisotropic tables of an isotropic material are isotropic, and any number of threads makes the same") {
  const gonio::model::ggx f{.alpha = 0.3, .f0 = rgb(0.9, 0.6, 0.3)};
  const anisotropic_resolution small{.phi_i = 9, .theta_i = 12, .values = 32, .visible_normals = 32, .normals = 32};
  const adaptive_brdf one = tabulate_adaptively(f, small, {1}), two = tabulate_adaptively(f, small, {3});
  CHECK(one.parts().reflectance.values == two.parts().reflectance.values);
  CHECK(one.parts().visible_normals.values == two.parts().visible_normals.values);
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    const direction wi = gonio::spherical_direction(0.9, 0.01 * i),
                    wo = gonio::spherical_direction(0.7, 0.01 * i + 2.5);
    CHECK((one(wi, wo) / f(wi, wo) - 1.0).abs().maxCoeff() < 0.05);
  }
}

TEST_CASE("a black anisotropic material has tables, and bad resolutions are refused") {
  const anisotropic_resolution tiny{.phi_i = 3, .theta_i = 2, .values = 2, .visible_normals = 8, .normals = 8};
  const auto black = [](const direction&, const direction&) noexcept { return rgb(rgb::Zero()); };
  CHECK((tabulate_adaptively(black, tiny)(direction(0.6, 0, 0.8), direction(0, 0, 1)) == 0.0).all());
  const auto refused = [&](const anisotropic_resolution& resolution, std::initializer_list<std::string> words) {
    scratch::check_refused([&] { return tabulate_adaptively(black, resolution); }, words);
  };
  refused({.phi_i = 2}, {"from 3 to 4096 azimuths", "not 2"});
  refused({.phi_i = 3, .theta_i = 1}, {"from 2 to 4096", "not 1"});
  refused({.phi_i = 3, .normals = 5000}, {"from 2 to 4096", "not 5000"});
  const auto not_a_number = [](const direction&, const direction&) noexcept {
    return rgb(rgb::Constant(std::numeric_limits<double>::quiet_NaN()));
  };
  scratch::check_refused([&] { return tabulate_adaptively(not_a_number, tiny); }, {"nan", "expected finite numbers"});
}

TEST_CASE("negative values of an anisotropic material are counted at all azimuths, and clipped") {
  const auto f = [](const direction& wi, const direction& wo) noexcept {
    return rgb(rgb::Constant(wi.z() > 0.0 && wo.z() > 0.0 ? 0.1 + 0.3 * wi.y() * wo.y() : 0.0));
  };
  const anisotropic_resolution small{.phi_i = 17, .theta_i = 8, .values = 16, .visible_normals = 16, .normals = 16};
  const adaptive_brdf tables = tabulate_adaptively(f, small);
  const direction wi = gonio::spherical_direction(1.0, pi / 2), wo = gonio::spherical_direction(1.0, -pi / 2);
  REQUIRE(tables(wi, wo).x() < -0.05);
  const gonio::valid_cells cells(gonio::grid({9, 9, 18}));
  CHECK(gonio::model::count_negative_values(tables, cells).cells > 10);
  const adaptive_brdf clipped = gonio::model::clipped(tables);
  CHECK(clipped.is_anisotropic());
  CHECK(clipped(wi, wo).x() > -0.01);
  CHECK(clipped(wi, gonio::spherical_direction(1.0, pi / 2)).x() ==
        doctest::Approx(tables(wi, gonio::spherical_direction(1.0, pi / 2)).x()).epsilon(1e-5));
}
