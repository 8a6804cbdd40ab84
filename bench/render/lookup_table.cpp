/// BRDF look-up at scattered pairs of directions. Compares the obvious way with arc functions, as in a renderer's
/// reader of MERL tables, with `lookup_table` one by one and many at once, and `component_brdf`. "far" tables use all
/// their memory; "near" tables stay in the cache, so the difference is the wait for memory. "reading" reads the same
/// memory at precomputed positions: the limit. Counters: bytes are the memory of a material.

#include "../limit.hpp"
#include <gonio/io/materials/prior.hpp>
#include <gonio/render.hpp>

#include <benchmark/benchmark.h>

#include <cstring>
#include <random>

namespace {

using gonio::render::interpolation;

template <class Real>
struct pairs_of {
  static constexpr std::size_t count = 1 << 16;
  std::array<std::vector<Real>, 6> arrays;
  std::vector<Eigen::Matrix<Real, 3, 1>> wi, wo;

  /// Draws pairs above the horizon, uniform in solid angle.
  pairs_of() {
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(1e-3, 1.0);
    const auto any = [&] {
      const double theta = std::acos(uniform(generator)), phi = 6.28 * uniform(generator);
      return gonio::spherical_direction(theta, phi);
    };
    for (std::size_t i = 0; i < count; ++i) {
      const gonio::direction a = any(), b = any();
      wi.push_back(a.cast<Real>());
      wo.push_back(b.cast<Real>());
      for (std::size_t k = 0; k < 3; ++k) {
        arrays[k].push_back(wi.back()[k]);
        arrays[3 + k].push_back(wo.back()[k]);
      }
    }
  }
};

template <class Real>
const pairs_of<Real>& pairs() {
  static const pairs_of<Real> all;
  return all;
}

/// A material with varying values: nothing is predictable.
struct some_material {
  gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return gonio::rgb(0.1 + wi.z() * wo.z(), 0.2, 0.3 + std::pow((wi + wo).normalized().z(), 50));
  }
};

/// Half vector, rotation by its angles, acos and atan2, and the three planes of a MERL file in double: the direct
/// implementation of the definition.
class obvious_lookup {
 public:
  obvious_lookup() : planes_(3 * cells_.size()) {
    for (Eigen::Index i = 0; i < cells_.size(); ++i) {
      const auto [wi, wo] = gonio::to_directions(cells_.angles(cells_.cell(i)));
      const gonio::rgb value = some_material{}(wi, wo);
      for (std::size_t c = 0; c < 3; ++c) planes_[c * cells_.size() + i] = value[c] * 1500.0;
    }
  }

  gonio::rgb operator()(const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) const {
    const std::size_t i = cell(wi, wo), plane = cells_.size();
    return {planes_[i] / 1500.0, planes_[plane + i] * (1.15 / 1500.0), planes_[2 * plane + i] * (1.66 / 1500.0)};
  }

  [[nodiscard]] std::size_t memory() const { return planes_.size() * sizeof(double); }

 private:
  static std::size_t cell(const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
    const Eigen::Vector3d h = (wi + wo).normalized();
    const double theta_h = std::acos(h.z()), phi_h = std::atan2(h.y(), h.x());
    const double c = std::cos(-phi_h), s = std::sin(-phi_h);
    const Eigen::Vector3d turned(c * wi.x() - s * wi.y(), s * wi.x() + c * wi.y(), wi.z());
    const double ct = std::cos(-theta_h), st = std::sin(-theta_h);
    const Eigen::Vector3d d(ct * turned.x() + st * turned.z(), turned.y(), ct * turned.z() - st * turned.x());
    const double theta_d = std::acos(std::min(d.z(), 1.0));
    double phi_d = std::atan2(d.y(), d.x());
    if (phi_d < 0.0) phi_d += std::numbers::pi;
    const auto index = [](double share, int extent) {
      return static_cast<std::size_t>(std::clamp(static_cast<int>(share * extent), 0, extent - 1));
    };
    constexpr double half_pi = std::numbers::pi / 2.0;
    return (index(std::sqrt(theta_h / half_pi), 90) * 90 + index(theta_d / half_pi, 90)) * 180 +
           index(phi_d / std::numbers::pi, 180);
  }

  gonio::grid cells_;
  std::vector<double> planes_;
};

template <class Real, class Brdf>
void look_up_all(benchmark::State& state, const Brdf& f) {
  const auto& all = pairs<Real>();
  for (auto _ : state) {
    Eigen::Array<Real, 3, 1> sum = Eigen::Array<Real, 3, 1>::Zero();
    for (std::size_t i = 0; i < all.count; ++i) sum += Eigen::Array<Real, 3, 1>(f(all.wi[i], all.wo[i]));
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.count));
  state.counters["bytes"] = static_cast<double>(f.memory());
}

void with_arc_functions(benchmark::State& state) {
  static const obvious_lookup table;
  look_up_all<double>(state, table);
}

template <class Stored, interpolation Interpolation>
const gonio::render::lookup_table<Stored, Interpolation>& far_table() {
  static const auto table = gonio::render::lookup_table<Stored, Interpolation>::tabulated(some_material{});
  return table;
}

/// Returns the name of the benchmark that only reads the same table.
template <class Stored, interpolation Interpolation>
std::string reading_of() {
  return std::string("reading_alone<") + (sizeof(Stored) == 2 ? "Eigen::half" : "float") +
         (Interpolation == interpolation::nearest ? ", nearest>" : ", trilinear>");
}

template <class Stored, interpolation Interpolation, class Real>
void one_by_one(benchmark::State& state) {
  look_up_all<Real>(state, far_table<Stored, Interpolation>());
  limited_by(state, reading_of<Stored, Interpolation>());
}

/// The same work on a grid that fits into the first cache: only computation remains.
template <class Stored, interpolation Interpolation, class Real>
void one_by_one_near(benchmark::State& state) {
  static const auto table =
      gonio::render::lookup_table<Stored, Interpolation>::tabulated(some_material{}, gonio::grid({9, 6, 12}));
  look_up_all<Real>(state, table);
}

/// Finds the nearest value for one pair at a time with the polynomials used for many at once.
class polynomial_lookup {
 public:
  polynomial_lookup() : values_(3 * index_.size(), 0.5f) {}

  Eigen::Array3f operator()(const Eigen::Vector3f& wi, const Eigen::Vector3f& wo) const {
    const std::size_t cell =
        index_.nearest(gonio::render::to_grid_coordinates(wi.x(), wi.y(), wi.z(), wo.x(), wo.y(), wo.z()));
    return {values_[3 * cell], values_[3 * cell + 1], values_[3 * cell + 2]};
  }

  [[nodiscard]] std::size_t memory() const { return values_.size() * sizeof(float) + index_.memory(); }

 private:
  gonio::render::horizon_index index_;
  std::vector<float> values_;
};

void one_by_one_by_polynomials(benchmark::State& state) {
  static const polynomial_lookup table;
  look_up_all<float>(state, table);
}

template <class Table, class Real>
void evaluate_all(benchmark::State& state, const Table& table) {
  const auto& all = pairs<Real>();
  std::array<std::vector<Real>, 3> out;
  for (auto& array : out) array.resize(all.count);
  for (auto _ : state) {
    table.template evaluate<Real>({all.arrays[0], all.arrays[1], all.arrays[2]},
                                  {all.arrays[3], all.arrays[4], all.arrays[5]}, {out[0], out[1], out[2]});
    benchmark::DoNotOptimize(out[0].data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.count));
  state.counters["bytes"] = static_cast<double>(table.memory());
}

template <class Stored, interpolation Interpolation, class Real>
void many_at_once(benchmark::State& state) {
  evaluate_all<gonio::render::lookup_table<Stored, Interpolation>, Real>(state, far_table<Stored, Interpolation>());
  limited_by(state, reading_of<Stored, Interpolation>());
}

template <class Stored, interpolation Interpolation, class Real>
void many_at_once_near(benchmark::State& state) {
  static const auto table =
      gonio::render::lookup_table<Stored, Interpolation>::tabulated(some_material{}, gonio::grid({9, 6, 12}));
  evaluate_all<gonio::render::lookup_table<Stored, Interpolation>, Real>(state, table);
}

/// Reads as a look-up does for a pair, in memory of the table's size: one cell, or four rows of two neighbours.
template <class Stored, interpolation Interpolation>
class reading {
 public:
  reading() : values_(3 * cells_.size() + 2, static_cast<Stored>(0.5f)) {
    const auto& all = pairs<float>();
    for (std::size_t i = 0; i < all.count; ++i) {
      const auto& wi = all.wi[i];
      const auto& wo = all.wo[i];
      const auto at = gonio::render::to_grid_coordinates(wi[0], wi[1], wi[2], wo[0], wo[1], wo[2]);
      positions_.push_back(
          3 * Eigen::Index{Interpolation == interpolation::nearest ? cells_.nearest(at) : cells_.around(at).number});
    }
  }

  [[nodiscard]] auto sum() const {
    using numbers = Eigen::Array<std::conditional_t<sizeof(Stored) == 2, std::int16_t, std::int32_t>,
                                 Interpolation == interpolation::nearest ? 4 : 8, 1>;
    numbers sum = numbers::Zero();
    const Eigen::Index h = 3 * cells_.step_h(), d = 3 * cells_.step_d();
    for (const Eigen::Index position : positions_)
      for (const Eigen::Index row : {position, position + d, position + h, position + h + d}) {
        numbers read;
        std::memcpy(read.data(), values_.data() + row, sizeof read);
        sum += read;
        if (Interpolation == interpolation::nearest) break;
      }
    return sum;
  }

  [[nodiscard]] std::size_t memory() const { return values_.size() * sizeof(Stored); }

 private:
  gonio::render::padded_grid cells_;
  std::vector<Stored, gonio::huge_page_allocator<Stored>> values_;
  std::vector<Eigen::Index> positions_;
};

template <class Stored, interpolation Interpolation>
void reading_alone(benchmark::State& state) {
  static const reading<Stored, Interpolation> memory;
  for (auto _ : state) {
    auto sum = memory.sum();
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs<float>().count));
  state.counters["bytes"] = static_cast<double>(memory.memory());
}

/// Uses the shipped prior's own grid, which is coarser than MERL's. Enlarging it would give another prior.
template <class Stored, interpolation Interpolation>
void by_components(benchmark::State& state) {
  static const auto prior = gonio::io::read_prior(GONIO_SOURCE_PRIOR);
  static const gonio::render::shared_components<Stored> components(prior, 20);
  const gonio::render::component_brdf<Stored, Interpolation> f(components, prior.weights_of(0).topRows(20));
  look_up_all<double>(state, f);
  state.counters["shared bytes"] = static_cast<double>(components.memory());
}

void draw_directions(benchmark::State& state) {
  static const gonio::render::half_vector_sampler material(gonio::render::lookup_table<>::tabulated(some_material{}));
  const auto& all = pairs<double>();
  std::mt19937_64 generator(2);
  std::vector<double> numbers(2 * all.count);
  for (double& number : numbers) number = static_cast<double>(generator() >> 11) * 0x1p-53;
  for (auto _ : state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < all.count; ++i)
      sum += material.sample(all.wo[i], numbers[2 * i], numbers[2 * i + 1]).pdf;
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.count));
}

void construct_sampler(benchmark::State& state) {
  for (auto _ : state) {
    const gonio::render::half_vector_sampler material(gonio::brdf_view(far_table<float, interpolation::trilinear>()));
    benchmark::DoNotOptimize(&material);
  }
}

constexpr auto nearest = interpolation::nearest, trilinear = interpolation::trilinear;

BENCHMARK(with_arc_functions);
BENCHMARK(reading_alone<float, nearest>);
BENCHMARK(reading_alone<Eigen::half, nearest>);
BENCHMARK(reading_alone<float, trilinear>);
BENCHMARK(reading_alone<Eigen::half, trilinear>);
BENCHMARK(one_by_one<float, nearest, double>);
BENCHMARK(one_by_one<float, nearest, float>);
BENCHMARK(one_by_one_by_polynomials);
BENCHMARK(one_by_one_near<float, nearest, float>);
BENCHMARK(one_by_one<Eigen::half, nearest, float>);
BENCHMARK(many_at_once<float, nearest, float>);
BENCHMARK(many_at_once_near<float, nearest, float>);
BENCHMARK(many_at_once<Eigen::half, nearest, float>);
BENCHMARK(many_at_once<float, nearest, double>);
BENCHMARK(one_by_one<float, trilinear, float>);
BENCHMARK(one_by_one_near<float, trilinear, float>);
BENCHMARK(many_at_once<float, trilinear, float>);
BENCHMARK(many_at_once_near<float, trilinear, float>);
BENCHMARK(one_by_one<Eigen::half, trilinear, float>);
BENCHMARK(many_at_once<Eigen::half, trilinear, float>);
BENCHMARK(by_components<float, nearest>);
BENCHMARK(by_components<Eigen::half, nearest>);
BENCHMARK(by_components<Eigen::half, trilinear>);
BENCHMARK(draw_directions);
BENCHMARK(construct_sampler)->Unit(benchmark::kMillisecond);

}  // namespace
