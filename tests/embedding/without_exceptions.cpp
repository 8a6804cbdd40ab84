// A renderer's point of view: gonio/render.hpp alone, compiled with -fno-exceptions -fno-rtti. Returns the number of
// checks that failed. With the argument `refuse` it hands over what is refused, which ends the program.

#include <gonio/render.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>
#include <vector>

#if defined(__cpp_exceptions) || defined(__cpp_rtti)
#error "this test is about a program without exceptions and run-time type information"
#endif

namespace {

std::atomic<long> allocations = 0;
int failures = 0;

void check(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "failed: %s\n", what);
  ++failures;
}

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  std::abort();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

template <class Real, class Brdf>
void check_material(const Brdf& table) {
  using vector = Eigen::Matrix<Real, 3, 1>;
  const gonio::render::half_vector_sampler<gonio::brdf_view<Brdf>, Real> material{gonio::brdf_view(table)};
  const gonio::render::bsdf_view view(material);
  const vector wo(Real(0.6), 0, Real(0.8)), below(Real(0.6), 0, Real(-0.8));
  const long before = allocations;
  Real albedo = 0;
  constexpr int side = 64;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const auto drawn = material.sample(wo, (Real(i) + Real(0.5)) / side, (Real(j) + Real(0.5)) / side);
      albedo += drawn.weight.mean() / (side * side);
    }
  check(std::abs(albedo - Real(0.5)) < Real(0.01), "the albedo of a grey Lambertian");
  check(std::abs(Real(view.eval({0.0f, 0.0f, 1.0f}, {0.6f, 0.0f, 0.8f})[1]) - Real(0.5 * std::numbers::inv_pi)) <
            Real(1e-3),
        "its value");
  check((table(below, wo) == 0).all() && material.pdf(wo, below) == 0, "black below the horizon");
  check(allocations == before, "no allocation after construction");
}

}  // namespace

int main(int count, char**) {
  const gonio::grid cells({30, 30, 60});
  // The planes of a MERL file: a grey Lambertian of albedo 0.5.
  const auto plane = static_cast<std::size_t>(cells.size());
  std::vector<double> planes(3 * plane);
  const std::array scales{1500.0, 1500.0 / 1.15, 1500.0 / 1.66};
  for (std::size_t i = 0; i < planes.size(); ++i) planes[i] = 0.5 * std::numbers::inv_pi * scales[i / plane];
  if (count > 1) planes.pop_back();

  const auto table = gonio::render::lookup_table<Eigen::half>::from_merl(planes, cells);
  const auto nearest =
      gonio::render::lookup_table<float, gonio::render::interpolation::nearest>::from_merl(planes, cells);
  check_material<double>(table);
  check_material<float>(table);
  check_material<double>(nearest);
  check_material<float>(nearest);

  // Any number of threads may read.
  const Eigen::Vector3f up(0, 0, 1);
  std::atomic<int> other = 0;
  std::vector<std::thread> readers;
  for (int t = 0; t < 4; ++t)
    readers.emplace_back([&] {
      for (int i = 1; i < 1000; ++i) {
        const Eigen::Vector3f wi(0, 0.5f, static_cast<float>(i) / 1000.0f);
        if (std::abs(table(wi, up)[0] - 0.159155f) > 1e-3f) ++other;
      }
    });
  for (std::thread& reader : readers) reader.join();
  check(other == 0, "the same for every thread");

  std::array<float, 5> x{}, y{}, z, red{}, green{}, blue{};
  z.fill(1.0f);
  table.evaluate<float>({x, y, z}, {x, y, z}, {red, green, blue});
  check(std::abs(blue[4] - 0.159155f) < 1e-3f, "many at once");
  return failures;
}
