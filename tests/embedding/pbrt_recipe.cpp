// The recipe for pbrt-v4 of docs/learn/renderer.md, compiled as C++17 against stubs of pbrt's types.

#include "stubs/pbrt/pbrt.hpp"

#include <measured_paint.hpp>
#include <renderer/pbrt/bxdfs.h>

class GonioMaterial {
 public:
#include <renderer/pbrt/materials.h>

 private:
  FloatTexture displacement;
  Image* normalMap;
};

pstd::optional<BSDFSample> draw(const GonioMaterial& material, Vector3f wo, SampledWavelengths lambda) {
  const GonioBxDF bxdf = material.GetBxDF(0, MaterialEvalContext{}, lambda);
  auto drawn = bxdf.Sample_f(wo, 0.5f, Point2f{}, TransportMode::Radiance);
  if (drawn) drawn->pdf = bxdf.PDF(wo, drawn->wi, TransportMode::Radiance);
  if (drawn) drawn->f = bxdf.f(wo, drawn->wi, TransportMode::Radiance);
  return drawn;
}
