#include "../io/scratch.hpp"
#include <gonio/model/adaptive_brdf.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using gonio::direction;
using gonio::rgb;
using gonio::model::adaptive_brdf;
using gonio::model::adaptive_brdf_parts;
using gonio::model::unit_square_tables;

namespace {

constexpr double half_pi = std::numbers::pi / 2.0;

/// Tables with the value `value(table, across, along)` at each node.
template <class Value>
unit_square_tables tabulated(Eigen::Index tables, Eigen::Index rows, Eigen::Index columns, const Value& value) {
  unit_square_tables all{tables, rows, columns, {}};
  for (Eigen::Index t = 0; t < tables; ++t)
    for (Eigen::Index row = 0; row < rows; ++row)
      for (Eigen::Index column = 0; column < columns; ++column)
        all.values.push_back(static_cast<float>(value(t, static_cast<double>(row) / static_cast<double>(rows - 1),
                                                      static_cast<double>(column) / static_cast<double>(columns - 1))));
  return all;
}

/// A material whose normals all have the same weight, seen from any direction.
adaptive_brdf_parts even_material() {
  const auto all = [](double number) { return [number](Eigen::Index, double, double) { return number; }; };
  return {{0.0, 0.7, half_pi},
          tabulated(1, 2, 3, all(0.5)),
          tabulated(1, 2, 3, all(2.0)),
          tabulated(3, 5, 4, all(1.0)),
          tabulated(9, 2, 2, [](Eigen::Index t, double, double) { return 0.1 * static_cast<double>(t % 3 + 1); })};
}

direction random_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return gonio::spherical_direction(std::acos(1e-3 + 0.999 * uniform(random)), 6.28 * uniform(random));
}

/// Returns a half vector's position in the unit square as the database defines it: azimuth across, polar angle along.
std::pair<double, double> square_of(const direction& wi, const direction& wo) {
  const direction h = (wi + wo).normalized();
  const double turns = (std::atan2(h.y(), h.x()) - std::atan2(wi.y(), wi.x())) / (2.0 * std::numbers::pi) + 0.5;
  return {turns - std::floor(turns), std::sqrt(std::acos(h.z()) / half_pi)};
}

}  // namespace

TEST_CASE("alike normals leave reflectance over four areas and the cosine") {
  const adaptive_brdf material(even_material());
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const direction wi = random_direction(random), wo = random_direction(random);
    const rgb measured = rgb(0.1, 0.2, 0.3) * 0.5 / (4.0 * 2.0 * wo.z());
    CHECK((material.as_measured(wi, wo) / measured - 1.0).abs().maxCoeff() < 1e-6);
    const rgb swapped = measured * wo.z() / wi.z();
    CHECK((material(wi, wo) / (0.5 * (measured + swapped)) - 1.0).abs().maxCoeff() < 1e-6);
    CHECK((material(wi, wo) - material(wo, wi)).abs().maxCoeff() == 0.0);
  }
  CHECK((material(direction(0, 0, 1), direction(1, 0, 0)) == 0.0).all());
  CHECK((material(direction(0.6, 0, -0.8), direction(0, 0, 1)) == 0.0).all());
}

TEST_CASE("reflectance is looked up where the visible normals' cumulative distribution maps the half vector") {
  // The density (1 + a)(1 + b) has the distribution function (a + a^2 / 2) / 1.5 in both directions.
  adaptive_brdf_parts parts = even_material();
  parts.visible_normals =
      tabulated(3, 4, 6, [](Eigen::Index, double across, double along) { return (1.0 + across) * (1.0 + along); });
  // Red is the position across, green the position along.
  parts.reflectance =
      tabulated(9, 2, 2, [](Eigen::Index t, double across, double along) { return t % 3 == 0 ? across : along; });
  const adaptive_brdf material(std::move(parts));
  const auto cumulative = [](double x) { return (x + 0.5 * x * x) / 1.5; };
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    const direction wi = random_direction(random), wo = random_direction(random);
    const rgb position = material.as_measured(wi, wo) * (4.0 * 2.0 * wo.z() / 0.5);
    const auto [across, along] = square_of(wi, wo);
    CHECK(position.x() == doctest::Approx(cumulative(across)).epsilon(1e-5));
    CHECK(position.y() == doctest::Approx(cumulative(along)).epsilon(1e-5));
  }
}

TEST_CASE("between two angles of the light, densities and their sums are interpolated") {
  // Seen from above, all normals have the same weight. Seen from the side, more of them are inclined.
  adaptive_brdf_parts parts = even_material();
  parts.theta_i = {0.0, half_pi};
  parts.visible_normals =
      tabulated(2, 4, 6, [](Eigen::Index t, double, double along) { return t == 0 ? 7.0 : 1.0 + along; });
  parts.reflectance = tabulated(6, 2, 2, [](Eigen::Index, double, double along) { return along; });
  const adaptive_brdf material(std::move(parts));
  const direction wi = gonio::spherical_direction(0.25 * half_pi, 1.0), wo = gonio::spherical_direction(0.9, -0.4);
  const double x = square_of(wi, wo).second;
  const double expected = 0.75 * x + 0.25 * (x + 0.5 * x * x) / 1.5;
  CHECK(material.as_measured(wi, wo).y() * (4.0 * 2.0 * wo.z() / 0.5) == doctest::Approx(expected).epsilon(1e-6));
}

namespace {

/// The BRDF as the class docstring defines it, from the parts, by functions of the standard library.
class plain_adaptive_brdf {
 public:
  explicit plain_adaptive_brdf(const adaptive_brdf_parts& parts) : parts_(parts) {}

  rgb operator()(const direction& wi, const direction& wo) const {
    const auto [across, along] = square_of(wi, wo);
    const double theta = std::acos(wi.z());
    const auto [u, v] = visible_position(theta, across, along);
    const double light = std::sqrt(theta / half_pi);
    const double factor =
        value(parts_.normals, 0, across, along) / (4.0 * value(parts_.projected_area, 0, 0.5, light) * wo.z());
    rgb colour;
    for (Eigen::Index c = 0; c < 3; ++c)
      colour[c] = factor * between(theta, [&](Eigen::Index t) { return value(parts_.reflectance, 3 * t + c, u, v); });
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

  /// Interpolates between two theta_i.
  template <class Value>
  double between(double theta, const Value& value) const {
    const std::vector<double>& angles = parts_.theta_i;
    Eigen::Index t = 0;
    while (t + 2 < std::ssize(angles) && angles[t + 1] <= theta) ++t;
    return std::lerp(value(t), value(t + 1), (theta - angles[t]) / (angles[t + 1] - angles[t]));
  }

  /// Returns the integral from 0 to `end` of a function that is linear between `nodes` nodes.
  template <class Value>
  static double integral(Eigen::Index nodes, double end, const Value& value) {
    const double step = 1.0 / static_cast<double>(nodes - 1);
    double sum = 0.0;
    for (double from = 0.0; from < end - 1e-12; from += step) {
      const double to = std::min(from + step, end);
      sum += 0.5 * (to - from) * (value(from) + value(to));
    }
    return sum;
  }

  std::pair<double, double> visible_position(double theta, double across, double along) const {
    const unit_square_tables& visible = parts_.visible_normals;
    const auto row = [&](double a, double end) {
      return between(theta, [&](Eigen::Index t) {
        return integral(visible.columns, end, [&](double b) { return value(visible, t, a, b); });
      });
    };
    const auto rows = [&](double end) { return integral(visible.rows, end, [&](double a) { return row(a, 1.0); }); };
    return {rows(across) / rows(1.0), row(across, along) / row(across, 1.0)};
  }

  const adaptive_brdf_parts& parts_;
};

/// A material whose tables have different sizes and random values.
adaptive_brdf_parts random_material(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  const auto any = [&](Eigen::Index, double, double) { return uniform(random); };
  return {{0.0, 0.2, 0.7, 0.9, 1.3, half_pi},
          tabulated(1, 3, 7, any),
          tabulated(1, 5, 6, any),
          tabulated(6, 5, 9, any),
          tabulated(18, 4, 3, any)};
}

}  // namespace

TEST_CASE("look-up agrees with what is written down from the definition") {
  std::mt19937 random(7);
  const adaptive_brdf material(random_material(random));
  const plain_adaptive_brdf plain(material.parts());
  for (int i = 0; i < 2000; ++i) {
    const direction wi = random_direction(random), wo = random_direction(random);
    const rgb forth = plain(wi, wo), back = plain(wo, wi);
    CHECK((material.as_measured(wi, wo) / forth - 1.0).abs().maxCoeff() < 1e-5);
    CHECK((material(wi, wo) / (0.5 * (forth + back)) - 1.0).abs().maxCoeff() < 1e-5);
    CHECK((material(wi, wo) - material(wo, wi)).abs().maxCoeff() == 0.0);
  }
}

TEST_CASE("directions at the edges of the tables, and such as are none, are looked up within them") {
  std::mt19937 random(9);
  const adaptive_brdf material(random_material(random));
  const direction up(0.0, 0.0, 1.0), side(1.0, 0.0, 1e-18), opposite(-1.0, 0.0, 1e-18);
  for (const direction& wi : {up, side, opposite})
    for (const direction& wo : {up, side, opposite}) CHECK(material.as_measured(wi, wo).isFinite().all());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const direction& none : {direction(nan, 0.0, 1.0), direction(0.0, nan, 0.5), direction(nan, nan, 1.0)}) {
    static_cast<void>(material(none, up));  // a sanitizer would report an error
    static_cast<void>(material(up, none));
  }
}

TEST_CASE("parts of a material that do not fit are refused") {
  const auto refused = [](auto&& change, std::initializer_list<std::string> words) {
    adaptive_brdf_parts parts = even_material();
    change(parts);
    scratch::check_refused([&] { return adaptive_brdf(std::move(parts)); }, words);
  };
  refused([](auto& p) { p.theta_i = {0.0}; }, {"theta_i", "at least 2 ascending angles"});
  refused([](auto& p) { p.theta_i = {0.0, 0.0, 1.0}; }, {"theta_i", "ascending"});
  refused([](auto& p) { p.theta_i = {0.0, 1.0, 1.6}; }, {"theta_i", "pi/2"});
  refused([](auto& p) { p.theta_i[1] = std::numeric_limits<double>::quiet_NaN(); }, {"theta_i"});
  refused([](auto& p) { p.theta_i = {0.0, 1.0}; }, {"visible normals", "needs 2 tables", "not 3 tables of 5 x 4"});
  refused([](auto& p) { p.normals.rows = 1; }, {"distribution of normals", "at least 2 x 2", "1 x 3"});
  refused([](auto& p) { p.projected_area.values.pop_back(); }, {"projected area", "5 numbers"});
  refused([](auto& p) { p.reflectance.tables = 3; }, {"reflectance", "needs 9 tables"});
  refused([](auto& p) { p.reflectance.values[7] = std::numeric_limits<float>::infinity(); }, {"reflectance", "inf"});
  refused([](auto& p) { p.visible_normals.values[3] = -1.0f; }, {"visible normals", "-1", "at least 0"});
  refused([](auto& p) { std::fill_n(p.visible_normals.values.begin() + 20, 20, 0.0f); },
          {"no normals are visible", "number 1"});
}
