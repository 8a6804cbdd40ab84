/// Files of UTIA's BRDF database.

#include "scratch.hpp"
#include <gonio/io/materials/utia.hpp>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

using gonio::degrees;
using gonio::direction;
using gonio::rgb;
using gonio::io::read_utia;
using scratch::check_refused;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t side = 288, plane = side * side;

/// Three planes of random numbers, some of them negative.
const std::vector<double>& planes() {
  static const std::vector<double> all = [] {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-0.1, 1.0);
    std::vector<double> numbers(3 * plane);
    for (double& number : numbers) number = uniform(random);
    return numbers;
  }();
  return all;
}

template <class Number>
std::vector<std::byte> bytes_of(const std::vector<Number>& numbers) {
  std::vector<std::byte> bytes(numbers.size() * sizeof(Number));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// A colour by the database's documentation: steps of 15 and 7.5 degrees, linear in each angle; above 75 degrees the
/// line through 60 and 75 continues.
rgb looked_up(const direction& wi, const direction& wo) {
  const auto polar = [](const direction& w) {
    const double steps = degrees(std::acos(w.z())) / 15.0;
    const int first = std::min(static_cast<int>(steps), 4);
    return std::pair(first, steps - first);
  };
  const auto around = [](const direction& w) {
    double turn = degrees(std::atan2(w.y(), w.x()));
    if (turn < 0.0) turn += 360.0;
    const int first = static_cast<int>(turn / 7.5) % 48;
    return std::pair(first, turn / 7.5 - static_cast<int>(turn / 7.5));
  };
  const auto [ti, ti_share] = polar(wi);
  const auto [to, to_share] = polar(wo);
  const auto [pi_, pi_share] = around(wi);
  const auto [po, po_share] = around(wo);
  rgb sum = rgb::Zero();
  for (int corner = 0; corner < 16; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2 & 1, d = corner >> 3;
    const double weight = (a ? ti_share : 1 - ti_share) * (b ? to_share : 1 - to_share) *
                          (c ? pi_share : 1 - pi_share) * (d ? po_share : 1 - po_share);
    const std::size_t row = 48 * (ti + a) + (pi_ + c) % 48, column = 48 * (to + b) + (po + d) % 48;
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      sum[channel] += weight * planes()[static_cast<std::size_t>(channel) * plane + side * row + column];
  }
  return sum;
}

}  // namespace

TEST_CASE("UTIA: values agree with the documentation's look-up, in float64 and in float32") {
  const auto material = read_utia(bytes_of(planes()), "m.bin");
  const auto in_float = read_utia(bytes_of(std::vector<float>(planes().begin(), planes().end())), "m.bin");
  CHECK(material.is_anisotropic());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> cosine(0.02, 1.0), turn(-pi, pi);
  for (int i = 0; i < 2000; ++i) {
    const direction wi = gonio::spherical_direction(std::acos(cosine(random)), turn(random)),
                    wo = gonio::spherical_direction(std::acos(cosine(random)), turn(random));
    const rgb expected = looked_up(wi, wo);
    CHECK((material.as_measured(wi, wo) - expected).abs().maxCoeff() < 1e-6);
    CHECK((in_float.as_measured(wi, wo) - expected).abs().maxCoeff() < 1e-6);
    CHECK((material(wi, wo) - material(wo, wi)).abs().maxCoeff() == 0.0);
  }
  CHECK((material(direction(0.6, 0.0, -0.8), direction(0, 0, 1)) == 0.0).all());
}

TEST_CASE("UTIA: golden numbers fix the file's order: phi_o fastest, then theta_o, phi_i, theta_i, plane") {
  std::vector<double> numbers(3 * plane);
  numbers[1 * plane + (48 * 2 + 5) * side + 48 * 3 + 7] = 8.0;  // green, 30 and 37.5 degrees, 45 and 52.5 degrees
  const auto material = read_utia(bytes_of(numbers), "m.bin");
  const auto at = [](double theta, double phi) {
    return gonio::spherical_direction(gonio::radians(theta), gonio::radians(phi));
  };
  CHECK((material.as_measured(at(30.0, 37.5), at(45.0, 52.5)) - rgb(0.0, 8.0, 0.0)).abs().maxCoeff() < 1e-6);
  CHECK(material.as_measured(at(37.5, 37.5), at(45.0, 56.25)).y() == doctest::Approx(2.0));
  CHECK(material(at(30.0, 37.5), at(45.0, 52.5)).y() == doctest::Approx(4.0));
}

TEST_CASE("UTIA: a file is read and written again number for number") {
  const auto material = read_utia(bytes_of(std::vector<float>(planes().begin(), planes().end())), "m.bin");
  const std::vector<std::byte> written = gonio::io::write_utia(material.grid());
  CHECK(written.size() == 8 * 3 * plane);
  CHECK(read_utia(written, "again").grid().values == material.grid().values);
  gonio::model::angle_grid other = material.grid();
  other.theta_i.back() += 0.1;
  check_refused([&] { return gonio::io::write_utia(other); }, {"directions of a file of UTIA's database"});
}

TEST_CASE("UTIA: stated numbers of directions are read, others are refused") {
  const gonio::io::utia_directions few{.polar = 3, .polar_step = 30.0, .azimuths = 4};
  const std::vector<float> numbers(3 * 144, 0.25f);
  CHECK(read_utia(bytes_of(numbers), "m.bin", few)(direction(0.6, 0, 0.8), direction(0, 0, 1)).x() ==
        doctest::Approx(0.25));
  check_refused([&] { return read_utia(bytes_of(numbers), "m.bin"); }, {"m.bin: has 1728 bytes", "288 x 288"});
  check_refused([&] { return read_utia({}, "m.bin"); }, {"m.bin", "has 0 bytes"});
  std::vector<double> bad = planes();
  bad[5] = std::numeric_limits<double>::quiet_NaN();
  check_refused([&] { return read_utia(bytes_of(bad), "m.bin"); }, {"m.bin: ", "nan", "finite"});
  bad[5] = 1e300;
  check_refused([&] { return read_utia(bytes_of(bad), "m.bin"); }, {"m.bin: ", "inf", "finite"});
  check_refused([&] { return gonio::io::utia_grid({.polar = 1}); }, {"from 2 to 360 polar angles", "not 1"});
  check_refused([&] { return gonio::io::utia_grid({.polar = 8}); }, {"up to 90 degrees", "not 8"});
  check_refused([&] { return gonio::io::utia_grid({.azimuths = 2}); }, {"and 2"});
  scratch::check_refuses_non_files([](const auto& path) { return read_utia(path); });
}
