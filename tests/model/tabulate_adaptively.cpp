#include "../io/scratch.hpp"
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/model/tabulate_adaptively.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using gonio::direction;
using gonio::rgb;
using gonio::model::adaptive_brdf;
using gonio::model::adaptive_resolution;
using gonio::model::tabulate_adaptively;

namespace {

/// Errors of a table, relative to the largest value for light from the same angle.
struct table_error {
  double mean = 0.0;
  double high = 0.0;  ///< exceeded by 1 % of the directions
};

/// Viewers are uniform over the hemisphere, up to 84 degrees.
template <class Brdf>
table_error error_of(const adaptive_brdf& table, const Brdf& f, double theta) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> cosine(0.1, 1.0), turn(0.0, 2.0 * std::numbers::pi);
  const direction wi = gonio::spherical_direction(theta, 0.3);
  const direction mirrored(-wi.x(), -wi.y(), wi.z());
  std::vector<double> errors;
  double peak = f(wi, mirrored).maxCoeff();
  for (int i = 0; i < 5000; ++i) {
    const direction wo = gonio::spherical_direction(std::acos(cosine(random)), turn(random));
    const rgb truth = f(wi, wo);
    peak = std::max(peak, truth.maxCoeff());
    errors.push_back((table.as_measured(wi, wo) - truth).abs().maxCoeff());
  }
  std::ranges::sort(errors);
  double sum = 0.0;
  for (const double error : errors) sum += error;
  return {sum / static_cast<double>(errors.size()) / peak, errors[errors.size() * 99 / 100] / peak};
}

}  // namespace

TEST_CASE("adaptive tables are within half a per cent of the peak of what they were made of") {
  const auto check = [](const auto& f) {
    const adaptive_brdf table = tabulate_adaptively(f);
    for (const double degrees : {0.0, 20.0, 43.0, 61.0, 75.0, 83.0}) {
      CAPTURE(degrees);
      const direction wi = gonio::spherical_direction(gonio::radians(degrees), 0.3), mirrored(-wi.x(), -wi.y(), wi.z());
      const table_error error = error_of(table, f, gonio::radians(degrees));
      CHECK(error.mean < 0.0025);
      CHECK(error.high < 0.025);
      CHECK(std::abs(table.as_measured(wi, mirrored).x() / f(wi, mirrored).x() - 1.0) < 0.06);
    }
  };
  check(gonio::model::lambertian{.albedo = rgb(0.2, 0.5, 0.8)});
  check(gonio::model::ggx{.alpha = 0.3});
  check(gonio::model::ggx{.alpha = 0.1, .f0 = rgb(0.9, 0.6, 0.3)});
  check(gonio::model::ggx{.alpha = 0.02});
}

TEST_CASE("adaptive tables are exact where they asked for values") {
  const gonio::model::ggx f{.alpha = 0.4, .f0 = rgb(0.1, 0.2, 0.3)};
  std::vector<gonio::direction_pair> asked;
  const auto recorded = [&](const direction& wi, const direction& wo) noexcept {
    asked.push_back({wi, wo});
    return f(wi, wo);
  };
  const adaptive_resolution coarse{.theta_i = 5, .values = 7, .visible_normals = 9, .normals = 12};
  const adaptive_brdf table = tabulate_adaptively(recorded, coarse, {1});
  CHECK(table.parts().theta_i.back() == doctest::Approx(std::numbers::pi / 2.0));
  int compared = 0;
  for (const auto& [wi, wo] : asked) {
    // Skip retroreflection, which determines the normals, and directions that stand for the horizon.
    if (wi == wo || wi.z() < 0.05 || wo.z() < 0.05) continue;
    CHECK(((table.as_measured(wi, wo) - f(wi, wo)).abs() < 1e-4 * f(wi, wo)).all());
    ++compared;
  }
  CHECK(compared > 60);
}

TEST_CASE("the normals of adaptive tables are normalised, and positive") {
  const adaptive_brdf table = tabulate_adaptively(gonio::model::ggx{.alpha = 0.2});
  const gonio::model::unit_square_tables& normals = table.parts().normals;
  double area = 0.0;
  for (Eigen::Index i = 0; i < normals.columns; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(normals.columns - 1);
    const double theta = 0.5 * std::numbers::pi * along * along;
    area += 2.0 * std::numbers::pi * double{normals.values[i]} * std::cos(theta) * std::sin(theta) * std::numbers::pi *
            along / static_cast<double>(normals.columns - 1);
    CHECK(normals.values[i] > 0.0f);
  }
  CHECK(area == doctest::Approx(1.0).epsilon(1e-3));
  CHECK(table.parts().projected_area.values.front() == doctest::Approx(1.0).epsilon(1e-3));
  // A rough conductor's highlight is as wide as its distribution of normals: half the peak value at half the distance.
  const gonio::model::ggx truth{.alpha = 0.2};
  const double known =
      truth.distribution(gonio::spherical_direction(gonio::radians(6.0), 0.0)) / truth.distribution(direction(0, 0, 1));
  const auto at = static_cast<Eigen::Index>(std::lround(std::sqrt(6.0 / 90.0) * 255.0));
  CHECK(double{normals.values[at]} / double{normals.values[0]} == doctest::Approx(known).epsilon(0.05));
}

TEST_CASE("adaptive tables keep the albedo, and any number of threads makes the same") {
  const gonio::model::ggx f{.alpha = 0.2, .f0 = rgb(0.9, 0.6, 0.3)};
  const adaptive_brdf one = tabulate_adaptively(f, {}, {1}), two = tabulate_adaptively(f, {}, {3});
  CHECK(one.parts().reflectance.values == two.parts().reflectance.values);
  CHECK(one.parts().visible_normals.values == two.parts().visible_normals.values);
  for (const double theta : {0.1, 0.7, 1.2})
    CHECK(((gonio::model::directional_albedo(one, theta) / gonio::model::directional_albedo(f, theta) - 1.0).abs() <
           0.005)
              .all());
}

TEST_CASE("a black material has adaptive tables, too") {
  const adaptive_brdf black = tabulate_adaptively(gonio::model::lambertian{.albedo = rgb::Zero()});
  CHECK((black(direction(0.6, 0, 0.8), direction(0, 0, 1)) == 0.0).all());
}

TEST_CASE("bad values and resolutions of adaptive tables are refused") {
  const auto not_a_number = [](const direction&, const direction&) noexcept {
    return rgb::Constant(std::numeric_limits<double>::quiet_NaN());
  };
  scratch::check_refused([&] { return tabulate_adaptively(not_a_number); }, {"nan", "expected finite numbers"});
  const gonio::model::lambertian grey;
  const auto refused = [&](const adaptive_resolution& resolution, const char* number) {
    scratch::check_refused([&] { return tabulate_adaptively(grey, resolution); }, {"from 2 to 4096", number});
  };
  refused({.theta_i = 1}, "not 1");
  refused({.values = -3}, "not -3");
  refused({.visible_normals = 0}, "not 0");
  refused({.normals = 5000}, "not 5000");
}

TEST_CASE("finer tables keep the albedo of narrow highlights, others stay as small as they are") {
  const gonio::model::ggx narrow{.alpha = 0.1, .f0 = rgb::Constant(0.04)}, wide{.alpha = 0.4};
  const double usual = gonio::model::albedo_error(narrow, tabulate_adaptively(narrow));
  const adaptive_brdf kept = gonio::model::tabulate_keeping_albedo(narrow, 0.001);
  CHECK(usual > 0.004);
  CHECK(gonio::model::albedo_error(narrow, kept) < 0.6 * usual);
  CHECK(kept.parts().reflectance.rows == 144);
  CHECK(gonio::model::albedo_error(narrow, kept, {1}) == gonio::model::albedo_error(narrow, kept, {3}));
  const adaptive_brdf between = gonio::model::tabulate_keeping_albedo(narrow, 0.7 * usual);
  CHECK(between.parts().theta_i.size() == 60);
  CHECK(between.parts().reflectance.rows == 96);
  CHECK(gonio::model::albedo_error(narrow, between) < 0.7 * usual);
  const adaptive_brdf small = gonio::model::tabulate_keeping_albedo(wide);
  CHECK(small.parts().theta_i.size() == 32);
  CHECK(small.parts().reflectance.rows == 96);
  CHECK(gonio::model::albedo_error(wide, small) < 0.004);
}
