/// A path tracer on one page: ten materials reconstructed from 20 samples each (front row) and their true BRDFs (back
/// row), as spheres on a floor in one environment. Like a renderer it uses gonio/render.hpp to evaluate and sample a
/// BRDF. The true BRDFs are ten materials of a prior; the reconstructions use a prior learned from its other materials.
/// Usage: example_path_tracer materials.prior spheres.png [ENVIRONMENT.hdr] [SAMPLES]

#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/random.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/render.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <random>

namespace {

using gonio::direction;
using gonio::rgb;
using material = gonio::render::half_vector_sampler<gonio::render::lookup_table<Eigen::half>>;

struct sphere {
  direction centre;
  double radius;
  const material* made_of;
};

/// A ray's intersection with a surface.
struct hit {
  double distance = 1e30;
  direction normal = direction::UnitY();
  const material* made_of = nullptr;  // null for the floor, which is grey
};

struct scene {
  std::vector<sphere> spheres;
  gonio::render::environment_sampler light;

  /// Returns the nearest surface along a ray: a sphere, or the floor y = 0.
  [[nodiscard]] std::optional<hit> meet(const direction& from, const direction& towards) const {
    hit nearest;
    for (const sphere& ball : spheres) {
      const direction apart = from - ball.centre;
      const double b = apart.dot(towards), inside = b * b - apart.squaredNorm() + ball.radius * ball.radius;
      if (inside < 0.0) continue;
      const double distance = -b - std::sqrt(inside);
      if (distance < 1e-6 || distance > nearest.distance) continue;
      nearest = {distance, (apart + distance * towards) / ball.radius, ball.made_of};
    }
    if (towards.y() < 0.0 && -from.y() / towards.y() > 1e-6 && -from.y() / towards.y() < nearest.distance)
      nearest = {-from.y() / towards.y(), direction::UnitY(), nullptr};
    if (nearest.distance == 1e30) return {};
    return nearest;
  }
};

constexpr double floor_albedo = 0.25;

/// BRDF, density and sampling of a surface: a sphere or the floor.
rgb reflectance(const hit& at, const direction& wi, const direction& wo) {
  return at.made_of ? rgb(at.made_of->brdf()(wi, wo)) : rgb(rgb::Constant(floor_albedo * std::numbers::inv_pi));
}
double density(const hit& at, const direction& wi, const direction& wo) {
  return at.made_of ? at.made_of->pdf(wi, wo) : gonio::cosine_weighted_pdf(wi);
}
gonio::sampled_direction draw(const hit& at, const direction& wo, double u1, double u2) {
  if (at.made_of) return at.made_of->sample(wo, u1, u2);
  const direction wi = gonio::cosine_weighted_direction(u1, u2);
  return {wi, rgb::Constant(floor_albedo), gonio::cosine_weighted_pdf(wi)};
}

/// Returns the radiance from a direction. At each surface, one sample of the environment and one of the material are
/// combined by the balance heuristic; the path continues along the material's sample.
template <class Number>
rgb radiance(const scene& world, direction from, direction towards, Number& number) {
  rgb sum = rgb::Zero(), carried = rgb::Ones();
  double density_of_ray = 0.0;  // a camera ray sees the environment directly
  for (int bounce = 0; bounce < 8; ++bounce) {
    const auto met = world.meet(from, towards);
    if (!met) {
      const double share = bounce == 0 ? 1.0 : density_of_ray / (density_of_ray + world.light.pdf(towards));
      return sum + carried * share * world.light.map()(towards);
    }
    from += met->distance * towards;
    const gonio::render::surface_frame surface(met->normal);
    const direction wo = surface.to_local(-towards);

    const double u1 = number(), u2 = number(), u3 = number(), u4 = number();
    const auto lamp = world.light.sample(u1, u2);
    const direction wi = surface.to_local(lamp.towards);
    if (wi.z() > 0.0 && !world.meet(from, lamp.towards))
      sum += carried * reflectance(*met, wi, wo) * lamp.radiance * (wi.z() / (lamp.pdf + density(*met, wi, wo)));

    const auto drawn = draw(*met, wo, u3, u4);
    if (!(drawn.wi.z() > 0.0 && (drawn.weight > 0.0).any())) return sum;
    carried *= drawn.weight;
    density_of_ray = drawn.pdf;
    towards = surface.to_world(drawn.wi);
  }
  return sum;
}

gonio::image render(const scene& world, std::size_t rows, std::size_t columns, int samples) {
  const direction eye(0.0, 8.0, 13.0), ahead = (direction(0.0, 0.2, 0.0) - eye).normalized();
  const direction right = direction(1.0, 0.0, 0.0), up = right.cross(ahead).normalized();
  gonio::image image = gonio::uniform_image(rows, columns);
  std::atomic<std::size_t> done = 0;
  gonio::for_each_block(rows, 1, [&](gonio::block range) {
    std::mt19937_64 generator(range.begin + 1);
    auto number = [&] { return gonio::uniform_number(generator); };
    for (std::size_t column = 0; column < columns; ++column) {
      rgb sum = rgb::Zero();
      for (int i = 0; i < samples; ++i) {
        const double x = (static_cast<double>(column) + number()) / static_cast<double>(columns) - 0.5;
        const double y = 0.5 - (static_cast<double>(range.begin) + number()) / static_cast<double>(rows);
        const double height = static_cast<double>(rows) / static_cast<double>(columns);
        sum += radiance(world, eye, direction(ahead + 0.94 * x * right + 0.94 * height * y * up).normalized(), number);
      }
      gonio::set_pixel(image, range.begin, column, sum / samples);
    }
    std::fprintf(stderr, "\r%3zu %%", 100 * ++done / rows);
  });
  std::fputc('\n', stderr);
  return image;
}

/// Returns truth and estimate, alternating, for the ten test materials of Nielsen et al. 2015.
std::vector<material> measured_and_reconstructed(const std::filesystem::path& prior_file) {
  const auto all = gonio::expand(gonio::io::read_prior(prior_file));
  std::vector<Eigen::Index> tested, others;
  for (std::size_t i = 0; i < all.names.size(); ++i)
    (std::ranges::count(gonio::nielsen_test_materials(), all.names[i]) != 0 ? tested : others).push_back(i);
  gonio::material_set learned = all.subset(others);
  const auto metric = gonio::log_relative::to_median_of(learned);
  const gonio::decomposition estimator{gonio::learn_pca(std::move(learned), metric, 60), gonio::tikhonov{40.0}};

  std::vector<material> materials;
  for (const Eigen::Index i : tested) {
    const gonio::brdf_table truth = all.table(i);
    gonio::sample_set samples;
    for (const auto& angles : gonio::design::nielsen_directions(20)) {
      const auto [wi, wo] = gonio::to_directions(angles);
      samples.push_back({angles, truth(wi, wo)});
    }
    materials.emplace_back(gonio::render::lookup_table<Eigen::half>::of(truth));
    materials.emplace_back(
        gonio::render::lookup_table<Eigen::half>::of(estimator.fit(samples).tabulate(truth.cells())));
  }
  return materials;
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 3) gonio::refuse("usage: example_path_tracer materials.prior spheres.png [ENVIRONMENT.hdr] [SAMPLES]");
  const int samples = count > 4 ? std::atoi(arguments[4]) : 64;
  if (samples < 1) gonio::refuse("the samples for each pixel are a number, at least 1");
  const auto made_of = measured_and_reconstructed(arguments[1]);
  scene world{{},
              gonio::render::environment_sampler(
                  count > 3 ? gonio::render::environment_map(gonio::io::read_hdr(arguments[3]))
                            : gonio::render::environment_map::of(gonio::render::formula_environment{}))};
  for (std::size_t i = 0; i < made_of.size(); ++i)
    world.spheres.push_back(
        {{1.25 * (static_cast<double>(i / 2) - 4.5), 0.55, i % 2 == 0 ? -1.2 : 0.9}, 0.55, &made_of[i]});
  gonio::io::write_png(arguments[2], render(world, 300, 1080, samples));
} catch (const gonio::error& refused) {
  std::fprintf(stderr, "%s\n", refused.what());
  return 2;
}
