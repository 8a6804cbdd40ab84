#include "../synthetic_materials.hpp"
#include <gonio/core/random.hpp>
#include <gonio/estimate/reconstruction.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace {

using gonio::direction;

const gonio::reconstruction<gonio::log_relative>& spectral_estimator() {
  static const gonio::valid_cells cells(gonio::grid({18, 9, 12}));
  static const gonio::reconstruction all{learn(synthetic_materials(cells, 60), 80)};
  return all;
}

std::vector<double> visible_wavelengths() {
  std::vector<double> all;
  for (int nm = 400; nm <= 700; nm += 10) all.push_back(nm);
  return all;
}

/// A feature of a material's spectra, in addition to a smooth diffuse colour and a gloss.
enum class feature { none, absorption_line, fringes };

double spectral_value(const direction& wi, const direction& wo, double nm, feature with) {
  const direction half = (wi + wo).normalized();
  const double roughness = 0.3, cosine = half.z(), square = roughness * roughness,
               lobe = square / (std::numbers::pi * std::pow(cosine * cosine * (square - 1.0) + 1.0, 2));
  double diffuse = (0.1 + 0.4 / (1.0 + std::exp((580.0 - nm) / 20.0))) / std::numbers::pi,
         gloss = 0.05 * lobe / std::max(wi.z(), wo.z());
  if (with == feature::absorption_line) diffuse *= 1.0 - 0.85 * std::exp(-std::pow((nm - 540.0) / 6.0, 2));
  if (with == feature::fringes) gloss *= 1.0 + 0.6 * std::cos(4.0 * std::numbers::pi * 3000.0 * wi.dot(half) / nm);
  return diffuse + gloss;
}

/// Samples in random directions, every fifth near the mirror direction, with a noise of 1 %.
gonio::sample_set spectra(Eigen::Index count, feature with = feature::none,
                          const std::vector<double>& wavelengths = visible_wavelengths()) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> noise;
  const auto number = [&] { return gonio::uniform_number(generator); };
  gonio::sample_set samples{gonio::channels(wavelengths)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double theta_i = 1.3 * std::sqrt(number());
    const bool mirrors = i % 5 == 0;
    const double theta_o = mirrors ? theta_i + 0.1 * number() : 1.3 * std::sqrt(number()),
                 phi = std::numbers::pi * (mirrors ? 1.0 : 2.0 * number());
    const direction wi(std::sin(theta_i), 0.0, std::cos(theta_i)),
        wo(std::sin(theta_o) * std::cos(phi), std::sin(theta_o) * std::sin(phi), std::cos(theta_o));
    Eigen::ArrayXd values(std::ssize(wavelengths));
    for (Eigen::Index c = 0; c < values.size(); ++c)
      values[c] = spectral_value(wi, wo, wavelengths[c], with) * (1.0 + 0.01 * noise(generator));
    samples.add(gonio::direction_pair{wi, wo}, values);
  }
  return samples;
}

/// Returns the samples with one value multiplied by a factor.
gonio::sample_set with_spike(const gonio::sample_set& samples, Eigen::Index number, Eigen::Index channel,
                             double factor) {
  gonio::sample_set changed(samples.channels());
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    Eigen::ArrayXd values = Eigen::Map<const Eigen::ArrayXd>(samples.values(i).data(), samples.channels().size());
    if (i == number) values[channel] *= factor;
    changed.add(samples.directions(i), values);
  }
  return changed;
}

}  // namespace

TEST_CASE("a spike of one wavelength is replaced, and named with its right value") {
  const gonio::sample_set right = spectra(20);
  for (const double factor : {5.0, 0.2, 0.0}) {
    CAPTURE(factor);
    const auto fit = spectral_estimator().fit(with_spike(right, 7, 12, factor));
    REQUIRE(fit.spikes().size() == 1);
    const gonio::spectral_spike& found = fit.spikes().front();
    CHECK(found.number == 7);
    CHECK(found.channel == 12);
    CHECK(found.measured == doctest::Approx(factor * right.values(7)[12]));
    CHECK(found.replaced_by == doctest::Approx(right.values(7)[12]).epsilon(0.1));
    CHECK(found.probability > 0.99);
    CHECK(fit.rejected().empty());
    // The answer is that of the right samples.
    const auto& [wi, wo] = right.directions(7).pair();
    const Eigen::ArrayXd expected = spectral_estimator().fit(right).values(wi, wo);
    CHECK((fit.values(wi, wo) / expected - 1.0).abs().maxCoeff() < 0.1);
  }
}

TEST_CASE("spikes of three neighbouring wavelengths, and of one wavelength in two samples, are replaced") {
  gonio::sample_set wrong = spectra(20);
  for (const Eigen::Index channel : {20, 21, 22}) wrong = with_spike(wrong, 3, channel, 4.0);
  wrong = with_spike(with_spike(wrong, 11, 5, 4.0), 12, 5, 4.0);
  const auto fit = spectral_estimator().fit(wrong);
  CHECK(fit.spikes().size() == 5);
  for (const gonio::spectral_spike& each : fit.spikes()) {
    CAPTURE(each.number);
    CHECK((each.number == 3 ? each.channel >= 20 && each.channel <= 22 : each.channel == 5));
    CHECK(each.replaced_by == doctest::Approx(each.measured / 4.0).epsilon(0.15));
  }
}

TEST_CASE("right spectra keep their values: smooth ones, absorption lines, and fringes that shift with the angle") {
  for (const feature with : {feature::none, feature::absorption_line, feature::fringes})
    for (const Eigen::Index count : {5, 20, 60}) {
      CAPTURE(static_cast<int>(with));
      CAPTURE(count);
      CHECK(spectral_estimator().fit(spectra(count, with)).spikes().empty());
    }
}

TEST_CASE("a spike beside an absorption line is found, and the line stays") {
  const gonio::sample_set right = spectra(20, feature::absorption_line);
  const auto fit = spectral_estimator().fit(with_spike(right, 4, 14, 30.0));  // 540 nm: absorbed in all samples
  REQUIRE(fit.spikes().size() == 1);
  CHECK(fit.spikes().front().replaced_by == doctest::Approx(right.values(4)[14]).epsilon(0.2));
}

TEST_CASE("spikes are found by groups if there are many samples") {
  gonio::sample_set samples = with_spike(with_spike(spectra(1100), 50, 30, 5.0), 1001, 0, 5.0);
  const auto found = spectral_estimator().replace_spikes(samples);
  REQUIRE(found.size() == 2);
  for (const gonio::spectral_spike& each : found) {
    CHECK(each.channel == (each.number == 50 ? 30 : 0));
    CHECK(samples.values(each.number)[each.channel] == each.replaced_by);
  }
}

TEST_CASE("values are kept if nothing is rejected, and where fewer than four wavelengths cannot tell") {
  const gonio::sample_set wrong = with_spike(spectra(20), 7, 12, 5.0);
  CHECK(spectral_estimator().keeping_all().fit(wrong).spikes().empty());
  const gonio::sample_set few = with_spike(spectra(20, feature::none, {450.0, 550.0, 650.0}), 7, 1, 1.5);
  CHECK(spectral_estimator().fit(few).spikes().empty());
  CHECK(spectral_estimator().fit(spectra(2)).spikes().empty());
}

TEST_CASE("a spike is reported by its number in the caller's samples") {
  gonio::sample_set wrong = with_spike(spectra(20), 7, 12, 5.0);
  gonio::sample_set weighted(wrong.channels());
  for (Eigen::Index i = 0; i < std::ssize(wrong); ++i)
    weighted.add(wrong.directions(i),
                 Eigen::ArrayXd(Eigen::Map<const Eigen::ArrayXd>(wrong.values(i).data(), wrong.channels().size())),
                 i == 2 ? 0.0 : 1.0);
  const auto fit = spectral_estimator().fit(weighted);
  REQUIRE(fit.spikes().size() == 1);
  CHECK(fit.spikes().front().number == 7);
}

TEST_CASE("a sample that is wrong at invisible wavelengths alone is rejected, and reported by their names") {
  std::vector<double> wavelengths = visible_wavelengths();
  for (int nm = 900; nm <= 1700; nm += 100) wavelengths.push_back(nm);
  const gonio::sample_set right = spectra(20, feature::none, wavelengths);
  CHECK(spectral_estimator().fit(right).rejected().empty());
  gonio::sample_set wrong = right;
  for (Eigen::Index c = 31; c < std::ssize(wavelengths); ++c) wrong.set_value(7, c, 8.0 * right.values(7)[c]);
  const auto fit = spectral_estimator().fit(wrong);
  CHECK(fit.spikes().empty());
  REQUIRE(fit.rejected() == std::vector<Eigen::Index>{7});
  REQUIRE(fit.contradicted().size() == 1);
  const gonio::outlying_sample& told = fit.contradicted().front();
  CHECK(told.number == 7);
  CHECK(told.channel_names == std::array<std::string, 3>{"900 to 1100 nm", "1200 to 1400 nm", "1500 to 1700 nm"});
  CHECK(told.measured[2] > 5.0 * told.predicted[2]);
  CHECK(spectral_estimator().keeping_all().fit(wrong).rejected().empty());
}

TEST_CASE("a sample that is wrong at visible and at invisible wavelengths is reported once") {
  std::vector<double> wavelengths = visible_wavelengths();
  for (int nm = 900; nm <= 1700; nm += 100) wavelengths.push_back(nm);
  gonio::sample_set wrong = spectra(20, feature::none, wavelengths);
  for (Eigen::Index c = 0; c < std::ssize(wavelengths); ++c) wrong.set_value(7, c, 8.0 * wrong.values(7)[c]);
  const auto fit = spectral_estimator().fit(wrong);
  CHECK(fit.rejected() == std::vector<Eigen::Index>{7});
  REQUIRE(fit.contradicted().size() == 1);
  CHECK(fit.contradicted().front().channel_names[0] == "red");
}
