#pragma once
// As much of pbrt-v4 as the recipe of docs/learn/renderer.md uses, so that it is compiled. Names are pbrt's.

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace pstd {
using std::optional;
}

using Float = float;
struct Vector3f {
  Float x = 0, y = 0, z = 0;
  Vector3f(Float x_, Float y_, Float z_) : x(x_), y(y_), z(z_) {}
};
struct Point2f {
  std::array<Float, 2> of{};
  Float operator[](int i) const { return of[i]; }
};
inline bool SameHemisphere(const Vector3f& w, const Vector3f& wp) { return w.z * wp.z > 0; }

struct SampledWavelengths {};
struct SampledSpectrum {
  explicit SampledSpectrum(Float value_ = 0) : value(value_) {}
  Float value;
};
struct RGB {
  RGB(Float r_, Float g_, Float b_) : r(r_), g(g_), b(b_) {}
  Float r, g, b;
};
struct RGBColorSpace {
  static const RGBColorSpace* sRGB;
};
inline const RGBColorSpace only_colour_space;
inline const RGBColorSpace* RGBColorSpace::sRGB = &only_colour_space;
struct RGBUnboundedSpectrum {
  RGBUnboundedSpectrum(const RGBColorSpace&, const RGB& rgb_) : rgb(rgb_) {}
  SampledSpectrum Sample(const SampledWavelengths&) const { return SampledSpectrum((rgb.r + rgb.g + rgb.b) / 3); }
  RGB rgb;
};

enum class TransportMode { Radiance, Importance };
enum class BxDFReflTransFlags { Unset = 0, Reflection = 1, Transmission = 2, All = 3 };
inline int operator&(BxDFReflTransFlags a, BxDFReflTransFlags b) { return static_cast<int>(a) & static_cast<int>(b); }
enum class BxDFFlags { GlossyReflection };
struct BSDFSample {
  BSDFSample(SampledSpectrum f_, Vector3f wi_, Float pdf_, BxDFFlags flags_)
      : f(f_), wi(wi_), pdf(pdf_), flags(flags_) {}
  SampledSpectrum f;
  Vector3f wi;
  Float pdf;
  BxDFFlags flags;
};

struct FloatTexture {};
struct Image {};
struct Allocator {};
struct MaterialEvalContext {};
