#include <gonio/model/formula_materials.hpp>
#include <gonio/model/lobe_sampler.hpp>
#include <gonio/render/bsdf_view.hpp>
#include <gonio/render/half_vector_sampler.hpp>

#include <doctest/doctest.h>

#include <limits>

using gonio::render::bsdf_view;

namespace {

using gold_sampler = gonio::model::lobe_sampler<gonio::model::formula_brdf>;
static_assert(std::is_constructible_v<bsdf_view, const gold_sampler&>);
static_assert(!std::is_constructible_v<bsdf_view, gold_sampler>);  // it would view a destroyed temporary

template <class Real>
struct gold_in {
  Eigen::Array<Real, 3, 1> operator()(const Eigen::Matrix<Real, 3, 1>& wi,
                                      const Eigen::Matrix<Real, 3, 1>& wo) const noexcept {
    static const auto gold = gonio::model::formula_material("gold-metal");
    return gold(wi.template cast<double>(), wo.template cast<double>()).template cast<Real>();
  }
};

}  // namespace

TEST_CASE("bsdf view: it says what the material behind it says, in float or double") {
  const auto check = [](const auto& material) {
    const bsdf_view view(material);
    const bsdf_view::vector wo{0.6f, 0.0f, 0.8f};
    const auto drawn = view.sample(wo, 0.4f, 0.7f);
    CHECK(drawn.pdf > 0.0f);
    CHECK(drawn.pdf == doctest::Approx(view.eval_pdf(drawn.wi, wo)).epsilon(1e-3));
    const auto value = view.eval(drawn.wi, wo);
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(drawn.weight[c] * drawn.pdf == doctest::Approx(value[c] * drawn.wi[2]).epsilon(1e-3));
    const gonio::direction wi(drawn.wi[0], drawn.wi[1], drawn.wi[2]);
    CHECK(value[0] ==
          doctest::Approx(gonio::model::formula_material("gold-metal")(wi, {0.6, 0.0, 0.8})[0]).epsilon(1e-4));
  };
  check(gonio::render::half_vector_sampler<gold_in<double>, double>({}));
  check(gonio::render::half_vector_sampler<gold_in<float>, float>({}));
  check(gonio::model::lobe_sampler(gonio::model::formula_material("gold-metal")));
}

TEST_CASE("bsdf view: below the horizon and without a number it is black") {
  const gonio::render::half_vector_sampler<gold_in<double>, double> material({});
  const bsdf_view view(material);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const bsdf_view::vector& bad : {bsdf_view::vector{0.6f, 0.0f, -0.8f}, {0.0f, 0.0f, nan}}) {
    CHECK(view.eval({0.0f, 0.0f, 1.0f}, bad)[0] == 0.0f);
    CHECK(view.sample(bad, 0.5f, 0.5f).weight[0] == 0.0f);
    CHECK(view.sample(bad, 0.5f, 0.5f).pdf == 0.0f);
  }
}
