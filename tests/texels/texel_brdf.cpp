#include "../synthetic_materials.hpp"
#include <gonio/render/component_brdf.hpp>
#include <gonio/texels/texel_brdf.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace {

std::vector<std::uint16_t> halves_of(const Eigen::MatrixXd& weights) {
  std::vector<std::uint16_t> halves;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    halves.push_back(static_cast<Eigen::half>(static_cast<float>(weights.data()[i])).x);
  return halves;
}

}  // namespace

TEST_CASE("texels for renderers: each is the component BRDF of its weights") {
  const auto prior = learn(synthetic_materials(gonio::valid_cells(gonio::grid({12, 9, 10})), 8), 5);
  const gonio::render::shared_components<float> components(prior);
  std::vector<std::uint16_t> weights;
  for (const Eigen::Index material : {3, 0, 6})
    for (const std::uint16_t half : halves_of(prior.weights_of(material))) weights.push_back(half);
  const gonio::render::texel_brdf sample(components, weights);
  const gonio::render::texel_brdf<float, gonio::render::interpolation::nearest> nearest(components, weights);
  REQUIRE(sample.texels() == 3);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> cosine(0.05, 1.0), azimuth(0.0, 6.28);
  for (const Eigen::Index texel : {0, 1, 2}) {
    Eigen::MatrixXd rounded(5, 3);
    for (Eigen::Index i = 0; i < 15; ++i)
      rounded.data()[i] = static_cast<float>(
          Eigen::half(Eigen::half_impl::raw_uint16_to_half(weights[static_cast<std::size_t>(15 * texel + i)])));
    const gonio::render::component_brdf expected(components, rounded);
    const gonio::render::component_brdf<float, gonio::render::interpolation::nearest> expected_nearest(components,
                                                                                                       rounded);
    for (int i = 0; i < 200; ++i) {
      const gonio::direction wi = gonio::spherical_direction(std::acos(cosine(generator)), azimuth(generator));
      const gonio::direction wo = gonio::spherical_direction(std::acos(cosine(generator)), azimuth(generator));
      CHECK((sample(texel, wi, wo) == expected(wi, wo)).all());
      CHECK((nearest(texel, wi, wo) == expected_nearest(wi, wo)).all());
    }
    CHECK((sample(texel, gonio::direction(0, 0, 1), gonio::direction(0, 0, -1)) == 0.0).all());
  }
}

TEST_CASE("texels for renderers: one that is not of the sample is black") {
  const auto prior = learn(synthetic_materials(small_cells(), 8), 5);
  const gonio::render::shared_components<float> components(prior);
  std::vector<std::uint16_t> weights(30);
  weights[29] = 1;  // one non-zero weight is enough
  const gonio::render::texel_brdf sample(components, weights);
  const gonio::direction up(0, 0, 1);
  CHECK((sample(0, up, up) == 0.0).all());
  CHECK((sample(1, up, up) > 0.0).all());
}

TEST_CASE("texels for renderers: weights that are not of whole texels are refused") {
  const auto prior = learn(synthetic_materials(small_cells(), 8), 5);
  const gonio::render::shared_components<float> components(prior);
  const std::vector<std::uint16_t> weights(31);
  CHECK_THROWS_WITH_AS((gonio::render::texel_brdf<float>(components, weights)), doctest::Contains("31"), gonio::error);
}

TEST_CASE("texels for renderers: functions that combine components are the components with the combined weights") {
  const auto prior = learn(synthetic_materials(small_cells(), 8), 5);
  Eigen::MatrixXf combinations(5, 2);
  combinations << 0.5f, 0.25f, -1.0f, 0.125f, 0.0f, 2.0f, 0.75f, 0.0f, -0.5f, 1.0f;
  const gonio::render::shared_components<float> functions(prior, combinations), components(prior);
  Eigen::MatrixXd weights(2, 3);
  weights << 0.02, -0.05, 0.1, 0.04, 0.03, -0.06;
  const gonio::render::component_brdf combined(functions, weights);
  const gonio::render::component_brdf expected(components, combinations.cast<double>() * weights);
  for (const double theta : {0.1, 0.7, 1.2}) {
    const gonio::direction wi = gonio::spherical_direction(theta, 0.0), wo = gonio::spherical_direction(0.4, 2.5);
    CHECK(((combined(wi, wo) - expected(wi, wo)).abs() < 1e-4 * expected(wi, wo)).all());
  }
  CHECK_THROWS_WITH_AS((gonio::render::shared_components<float>(prior, combinations.topRows(3))),
                       doctest::Contains("have 3 rows"), gonio::error);
}
