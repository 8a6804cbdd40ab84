#include <gonio/render/bsdf_view.hpp>

#if __cplusplus >= 202002L || defined(EIGEN_CORE_H)
#error "this test is about C++17 and the standard library alone"
#endif

float brightness(const gonio::render::bsdf_view& material, const gonio::render::bsdf_view::vector& wo);

float brightness(const gonio::render::bsdf_view& material, const gonio::render::bsdf_view::vector& wo) {
  const gonio::render::bsdf_view::sampled drawn = material.sample(wo, 0.5f, 0.5f);
  return drawn.pdf > 0.0f ? material.eval(drawn.wi, wo)[1] * material.eval_pdf(drawn.wi, wo) : 0.0f;
}
