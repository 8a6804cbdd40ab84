#pragma once
/// Synthetic ear canals: a smooth family of surfaces with known correspondences, for tests and teaching.
///
/// They follow the data described in "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016,
/// contribution C.V), section 1.1: left ears with a bowl at the outer end, two bends and the blunt tip of an
/// impression. Millimetres. The vertical axis is y, inwards is about -x, the back of the head is -z.

#include <gonio/core/error.hpp>
#include <gonio/core/random.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace synthetic {

/// Random numbers that are equal on every standard library.
class number_source {
 public:
  explicit number_source(std::uint64_t seed) : generator_(seed) {}

  /// In [0, 1).
  [[nodiscard]] double uniform() { return gonio::uniform_number(generator_); }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Returns a normal number of mean 0 and variance 1 (Box and Muller).
  [[nodiscard]] double normal() {
    const double length = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return length * std::cos(2.0 * std::numbers::pi * uniform());
  }

  /// Returns a normal number, redrawn until it is within this many standard deviations.
  [[nodiscard]] double normal_within(double limit) {
    double number = normal();
    while (std::abs(number) > limit) number = normal();
    return number;
  }

  /// Returns a seed for an independent source.
  [[nodiscard]] std::uint64_t seed() { return generator_(); }

 private:
  std::mt19937_64 generator_;
};

/// A local cavity (height < 0) or bump outside the family's statistics.
struct abnormality {
  double u, v;
  double height;  ///< mm
  double width;   ///< mm
};

/// The surface of one ear canal: a map from (u, v) to points. u runs from the outer open end, 0, to the tip, 1. v goes
/// around the canal in radians from "up" to "back". The bends are at the same u in all individuals, so equal (u, v)
/// correspond.
class ear_canal {
 public:
  /// The number of independent normal numbers of an individual.
  static constexpr std::size_t latent_count = 56;
  /// The surface continues a little outside u = 0, so that scans can be cut there.
  static constexpr double outermost = -0.05;
  /// The positions of the largest bends of the centre line.
  static constexpr double first_bend = 0.36, second_bend = 0.64;
  /// The beginning of the tip's cap.
  static constexpr double cap_begin = 0.84;

  /// Throws gonio::error unless there are `latent_count` finite latent numbers.
  explicit ear_canal(std::vector<double> latents, std::optional<abnormality> oddity = std::nullopt)
      : latents_(std::move(latents)), oddity_(oddity) {
    if (latents_.size() != latent_count)
      gonio::refuse("an ear canal was given " + std::to_string(latents_.size()) + " latent numbers, not " +
                    std::to_string(latent_count));
    if (!std::ranges::all_of(latents_, [](double z) { return std::isfinite(z); }))
      gonio::refuse("a latent number of an ear canal is not finite");
    read_latents();
    follow_centre_line();
  }

  [[nodiscard]] const std::vector<double>& latents() const noexcept { return latents_; }
  [[nodiscard]] const std::optional<abnormality>& oddity() const noexcept { return oddity_; }

  /// Returns the point at u in [outermost, 1] and any v.
  [[nodiscard]] Eigen::Vector3d at(double u, double v) const {
    const station here = station_at(u);
    const double turn = std::max(0.0, (u - cap_begin) / (1.0 - cap_begin)) * 0.5 * std::numbers::pi;
    // At the tip the cosine must be exactly 0.
    const double sine = std::sin(turn), cosine = u >= 1.0 ? 0.0 : std::cos(turn);
    const double radius = radius_at(u, v, cosine) * cosine * (1.0 + bluntness_ * sine * sine);
    const double c = std::cos(v), s = std::sin(v);
    const double along = cap_length_ * sine + (tilt_[0] * c + tilt_[1] * s) * radius * sine * sine;
    return here.centre + here.frame * Eigen::Vector3d(along, radius * c, radius * s);
  }

  /// Returns the outward unit normal.
  [[nodiscard]] Eigen::Vector3d normal(double u, double v) const {
    constexpr double step = 1e-4;
    if (u > 1.0 - 2.0 * step) {
      const double ring = 1.0 - 10.0 * step, quarter = 0.5 * std::numbers::pi;
      const Eigen::Vector3d first = at(ring, 0.0) - at(ring, 2.0 * quarter);
      const Eigen::Vector3d second = at(ring, quarter) - at(ring, 3.0 * quarter);
      return first.cross(second).normalized();
    }
    const double low = std::max(outermost, u - step);
    const Eigen::Vector3d along = at(u + step, v) - at(low, v), round = at(u, v + step) - at(u, v - step);
    return round.cross(along).normalized();
  }

  /// Returns the point of the centre line at u; in the cap, a point of its axis.
  [[nodiscard]] Eigen::Vector3d centre(double u) const {
    const station here = station_at(u);
    const double turn = std::max(0.0, (u - cap_begin) / (1.0 - cap_begin)) * 0.5 * std::numbers::pi;
    return here.centre + here.frame * Eigen::Vector3d(cap_length_ * std::sin(turn), 0.0, 0.0);
  }

  /// Returns a margin against folding, the smaller of two numbers: the smallest stretch of the surface along the canal
  /// relative to the centre line (1 in a straight tube, 0 if the wall reaches the centre of a bend), and the smallest
  /// radius in mm minus 1.
  [[nodiscard]] double regularity() const {
    double least = 1.0;
    for (int ring = 0; ring <= 60; ++ring) {
      const double u = outermost + (cap_begin - outermost) * ring / 60.0;
      const Eigen::Vector3d turning = turning_at(u) / speed_at(u);
      for (int sector = 0; sector < 24; ++sector) {
        const double v = 2.0 * std::numbers::pi * sector / 24.0, radius = radius_at(u, v, 1.0);
        // The second term is the component along the canal of the cross product of `turning` and the radius.
        const double stretch = 1.0 + radius * (turning[1] * std::sin(v) - turning[2] * std::cos(v));
        least = std::min({least, stretch, radius - 1.0});
      }
    }
    return least;
  }

 private:
  static constexpr int stations = 240;
  static constexpr double middle = 0.45;  // all individuals have the same frame here

  /// A point of the centre line. The frame's columns are inwards, up and back.
  struct station {
    Eigen::Vector3d centre;
    Eigen::Quaterniond frame;
  };

  /// A smooth bump of the wall: cos(k pi u) (a cos(m v) + b sin(m v)).
  struct wave {
    int k, m;
    double a, b;
  };

  /// Reads the latent numbers one by one, scaled; within each kind, the numbers with the largest effect come first.
  class latent_reader {
   public:
    explicit latent_reader(const std::vector<double>& all) : all_(all) {}
    [[nodiscard]] double next(double mean, double deviation) { return mean + deviation * all_[next_++]; }

   private:
    const std::vector<double>& all_;
    std::size_t next_ = 0;
  };

  void read_latents() {
    latent_reader read(latents_);
    constexpr double degree = std::numbers::pi / 180.0;
    for (int k = 0; k < 4; ++k) log_speed_[k] = read.next(0.0, 0.07 / (1 + k));
    bends_[0] = {first_bend, read.next(40.0, 7.0) * degree, 0.0, 0.0};
    bends_[1] = {second_bend, read.next(36.0, 7.0) * degree, 0.0, 0.0};
    bends_[0].plane = read.next(70.0, 12.0) * degree;    // backwards, a little up
    bends_[1].plane = read.next(-140.0, 14.0) * degree;  // forwards and down
    for (bend& one : bends_) one.width = 0.20 * std::exp(read.next(0.0, 0.06));
    twist_ = read.next(0.25, 0.15);
    for (int k = 0; k < 2; ++k)
      for (auto& axis : wander_) axis[k] = read.next(0.0, 0.16 / (1 + k));
    constexpr std::array<double, 5> calibre{1.33, 0.07, 0.03, 0.0, 0.0};
    for (std::size_t k = 0; k < 5; ++k) log_calibre_[k] = read.next(calibre[k], 0.075 / (1.0 + 0.8 * double(k)));
    constexpr std::array<double, 3> up{0.14, 0.04, -0.03}, aslant{0.03, -0.08, 0.02};
    for (std::size_t k = 0; k < 3; ++k) upright_[k] = read.next(up[k], 0.05 / (1.0 + double(k)));
    for (std::size_t k = 0; k < 3; ++k) slanted_[k] = read.next(aslant[k], 0.05 / (1.0 + double(k)));
    read_bowl_and_cap(read);
    read_waves(read);
  }

  void read_bowl_and_cap(latent_reader& read) {
    bowl_size_ = 4.6 * std::exp(read.next(0.0, 0.13));
    bowl_depth_ = read.next(0.24, 0.015);
    constexpr std::array<double, 3> cosines{-0.10, 0.22, 0.13}, sines{0.50, -0.12, -0.16};
    for (std::size_t m = 0; m < 3; ++m) lobe_cosine_[m] = read.next(cosines[m], 0.11 / (1.0 + 0.5 * double(m)));
    for (std::size_t m = 0; m < 3; ++m) lobe_sine_[m] = read.next(sines[m], 0.11 / (1.0 + 0.5 * double(m)));
    cap_length_ = 2.9 * std::exp(read.next(0.0, 0.12));
    bluntness_ = read.next(0.30, 0.10);
    for (double& slope : tilt_) slope = read.next(0.1, 0.10);
  }

  /// Small-scale anatomy. The common part makes locations on the wall distinguishable.
  void read_waves(latent_reader& read) {
    const std::array<wave, 9> common{{{0, 3, 0.10, -0.16},
                                      {1, 3, -0.14, 0.08},
                                      {2, 3, 0.12, 0.14},
                                      {3, 3, -0.12, 0.10},
                                      {0, 4, 0.05, 0.05},
                                      {1, 4, 0.08, -0.06},
                                      {2, 4, -0.07, 0.05},
                                      {0, 5, 0.04, -0.04},
                                      {1, 5, 0.03, 0.05}}};
    waves_ = common;
    for (wave& one : waves_) {
      const double deviation = 0.18 / (1.0 + 0.35 * one.k) * std::pow(3.0 / one.m, 1.5);
      one.a = read.next(one.a, deviation);
      one.b = read.next(one.b, deviation);
    }
  }

  [[nodiscard]] double speed_at(double u) const { return 29.0 * std::exp(cosine_sum(log_speed_, u)); }

  /// Returns the sum of c_k cos(k pi u).
  template <std::size_t Size>
  [[nodiscard]] static double cosine_sum(const std::array<double, Size>& factors, double u) {
    const double first = std::cos(std::numbers::pi * u);
    double sum = 0.0, before = first, now = 1.0;
    for (const double factor : factors) {
      sum += factor * now;
      before = std::exchange(now, 2.0 * first * now - before);
    }
    return sum;
  }

  /// Returns the rotation of the frame per unit of u, as a vector in the frame's axes.
  [[nodiscard]] Eigen::Vector3d turning_at(double u) const {
    Eigen::Vector3d turning(twist_, cosine_sum(wander_[0], u), cosine_sum(wander_[1], u));
    for (const bend& one : bends_) {
      const double offset = (u - one.u) / one.width;
      if (std::abs(offset) >= 1.0) continue;
      const double rate = one.angle * (1.0 + std::cos(std::numbers::pi * offset)) / (2.0 * one.width);
      turning += rate * Eigen::Vector3d(0.0, -std::sin(one.plane), std::cos(one.plane));
    }
    return turning;
  }

  void follow_centre_line() {
    constexpr double step = (cap_begin - outermost) / stations;
    line_.assign(stations + 1, {Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()});
    for (int i = 0; i < stations; ++i) {
      const double u = outermost + (i + 0.5) * step;
      const Eigen::Vector3d turning = turning_at(u);
      const double rate = turning.norm();
      const Eigen::Vector3d axis = rate > 0.0 ? Eigen::Vector3d(turning / rate) : Eigen::Vector3d::UnitX();
      const station& here = line_[i];
      const Eigen::Quaterniond half = here.frame * Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * rate * step, axis));
      line_[i + 1] = {here.centre + half * Eigen::Vector3d(speed_at(u) * step, 0.0, 0.0),
                      (here.frame * Eigen::Quaterniond(Eigen::AngleAxisd(rate * step, axis))).normalized()};
    }
    stand_upright();
  }

  /// Moves the line so that its middle is at the origin and runs inwards, with the frame's second axis up.
  void stand_upright() {
    Eigen::Matrix3d head;
    head << -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0;
    const station now = station_at(middle);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(head) * now.frame.conjugate();
    for (station& one : line_) one = {turn * (one.centre - now.centre), (turn * one.frame).normalized()};
  }

  [[nodiscard]] station station_at(double u) const {
    const double position = std::clamp((u - outermost) / (cap_begin - outermost), 0.0, 1.0) * stations;
    const auto first = static_cast<std::size_t>(std::min(position, stations - 1.0));
    const double share = position - static_cast<double>(first);
    const station &low = line_[first], &high = line_[first + 1];
    // Neighbouring frames are so close that any interpolation works.
    const Eigen::Vector4d frame = (1.0 - share) * low.frame.coeffs() + share * high.frame.coeffs();
    return {(1.0 - share) * low.centre + share * high.centre, Eigen::Quaterniond(frame.normalized())};
  }

  /// Returns the distance from the centre line to the wall without the cap. `fading` removes the bumps towards the tip.
  [[nodiscard]] double radius_at(double u, double v, double fading) const {
    std::array<double, 6> c{1.0, std::cos(v)}, s{0.0, std::sin(v)};
    for (std::size_t m = 2; m < c.size(); ++m) {
      c[m] = c[m - 1] * c[1] - s[m - 1] * s[1];
      s[m] = s[m - 1] * c[1] + c[m - 1] * s[1];
    }
    const double ellipse = cosine_sum(upright_, u) * c[2] + cosine_sum(slanted_, u) * s[2];
    double lobes = 0.0;
    for (std::size_t m = 0; m < 3; ++m) lobes += lobe_cosine_[m] * c[m + 1] + lobe_sine_[m] * s[m + 1];
    double bumps = 0.0;
    for (const wave& one : waves_) {
      const std::size_t m = one.m;
      bumps += std::cos(one.k * std::numbers::pi * u) * (one.a * c[m] + one.b * s[m]);
    }
    return std::exp(cosine_sum(log_calibre_, u) + ellipse) + bowl_at(u) * std::exp(lobes) +
           fading * fading * (bumps + oddness_at(u, v));
  }

  /// The bowl widens quickly where the canal opens, and less towards the rim.
  [[nodiscard]] double bowl_at(double u) const {
    constexpr double softness = 0.03;
    const double into = softness * std::log1p(std::exp((bowl_depth_ - u) / softness)) / bowl_depth_;
    return bowl_size_ * std::sin(1.2 * into);
  }

  [[nodiscard]] double oddness_at(double u, double v) const {
    if (!oddity_) return 0.0;
    constexpr double millimetres = 29.0, radius = 4.0;
    const double along = (u - oddity_->u) * millimetres / oddity_->width;
    const double round = 2.0 * (1.0 - std::cos(v - oddity_->v)) * std::pow(radius / oddity_->width, 2);
    return oddity_->height * std::exp(-along * along - round);
  }

  struct bend {
    double u, angle, plane, width;
  };

  std::vector<double> latents_;
  std::optional<abnormality> oddity_;
  std::array<double, 4> log_speed_{};
  std::array<bend, 2> bends_{};
  double twist_ = 0.0;
  std::array<std::array<double, 2>, 2> wander_{};
  std::array<double, 5> log_calibre_{};
  std::array<double, 3> upright_{}, slanted_{};
  double bowl_size_ = 0.0, bowl_depth_ = 0.0;
  std::array<double, 3> lobe_cosine_{}, lobe_sine_{};
  double cap_length_ = 0.0, bluntness_ = 0.0;
  std::array<double, 2> tilt_{};
  std::array<wave, 9> waves_{};
  std::vector<station> line_;
};

/// A distribution of ear canals.
class ear_canal_family {
 public:
  /// `variation` scales the latent numbers; `abnormal_share` is the probability of an `abnormality`. Throws
  /// gonio::error unless both are in [0, 1].
  explicit ear_canal_family(double variation = 1.0, double abnormal_share = 0.03)
      : variation_(variation), abnormal_share_(abnormal_share) {
    if (!(variation >= 0.0 && variation <= 1.0))
      gonio::refuse("an ear canal family's variation must be from 0 to 1, not " + std::to_string(variation));
    if (!(abnormal_share >= 0.0 && abnormal_share <= 1.0))
      gonio::refuse("a share of abnormal ear canals must be from 0 to 1, not " + std::to_string(abnormal_share));
  }

  /// Returns the individual of a seed. Draws latent numbers within 3 standard deviations, again and again until the
  /// surface is far enough from folding.
  [[nodiscard]] ear_canal draw(std::uint64_t seed) const {
    number_source numbers(seed);
    for (;;) {
      std::vector<double> latents(ear_canal::latent_count);
      for (double& z : latents) z = variation_ * numbers.normal_within(3.0);
      ear_canal drawn(std::move(latents), draw_oddity(numbers));
      if (drawn.regularity() > 0.15) return drawn;
    }
  }

  /// Returns the individual with zero latent numbers. It is not the mean shape: points are not linear in the numbers.
  [[nodiscard]] static ear_canal mean() { return ear_canal(std::vector<double>(ear_canal::latent_count, 0.0)); }

 private:
  [[nodiscard]] std::optional<abnormality> draw_oddity(number_source& numbers) const {
    const double chance = numbers.uniform();
    const double u = numbers.uniform(0.30, 0.75), v = numbers.uniform(0.0, 2.0 * std::numbers::pi);
    const double size = numbers.uniform(0.9, 1.8), sign = numbers.uniform() < 0.5 ? -1.0 : 1.0;
    const double width = numbers.uniform(1.8, 3.0);
    if (chance >= abnormal_share_) return std::nullopt;
    return abnormality{u, v, sign * size, width};
  }

  double variation_, abnormal_share_;
};

}  // namespace synthetic
