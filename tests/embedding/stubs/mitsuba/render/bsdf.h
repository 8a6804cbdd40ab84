#pragma once
// As core/fresolver.h.

#include <array>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#define NAMESPACE_BEGIN(name) namespace name {
#define NAMESPACE_END(name) }
#define MI_IMPORT_BASE(Name, ...)     \
  using Base = Name<Float, Spectrum>; \
  using Base::m_flags, Base::m_components;
#define MI_IMPORT_TYPES()                                           \
  using Mask = bool;                                                \
  using Vector3f = mitsuba::Vector3<Float>;                         \
  using Point2f = mitsuba::Point2<Float>;                           \
  using BSDFSample3f = mitsuba::BSDFSample3<Float>;                 \
  using SurfaceInteraction3f = mitsuba::SurfaceInteraction3<Float>; \
  using Frame3f = mitsuba::Frame3<Float>;
#define MI_MASKED_FUNCTION(phase, mask) static_cast<void>(mask)
#define MI_DECLARE_CLASS(Name)
#define MI_EXPORT_PLUGIN(Name) template class Name<float, Color3f>;
#define Throw(message) throw std::runtime_error(message)

namespace dr {

template <class T>
inline constexpr bool is_jit_v = false;
template <class T>
T zeros() {
  return {};
}

}  // namespace dr

namespace mitsuba {

/// Mitsuba's variants differ by these two; that of colours is the one that is compiled.
struct Color3f {
  std::array<float, 3> of{};
  Color3f(float all) : of{all, all, all} {}
  Color3f(float r, float g, float b) : of{r, g, b} {}
  Color3f operator*(float scale) const { return {scale * of[0], scale * of[1], scale * of[2]}; }
};
template <class T>
inline constexpr bool is_rgb_v = std::is_same_v<T, Color3f>;
template <class T>
inline constexpr bool is_polarized_v = false;

template <class Float>
class Vector3 {
 public:
  Vector3(Float x = 0, Float y = 0, Float z = 0) : of_{x, y, z} {}
  Float x() const { return of_[0]; }
  Float y() const { return of_[1]; }
  Float z() const { return of_[2]; }

 private:
  std::array<Float, 3> of_;
};
template <class Float>
struct Point2 {
  std::array<Float, 2> of{};
  Float x() const { return of[0]; }
  Float y() const { return of[1]; }
};
template <class Float>
struct Frame3 {
  static Float cos_theta(const Vector3<Float>& w) { return w.z(); }
};
template <class Float>
struct SurfaceInteraction3 {
  Vector3<Float> wi;
};
template <class Float>
struct BSDFSample3 {
  Vector3<Float> wo;
  Float pdf = 0, eta = 0;
  unsigned sampled_type = 0, sampled_component = 0;
};

enum class BSDFFlags : unsigned { GlossyReflection = 1, FrontSide = 2 };
constexpr unsigned operator|(BSDFFlags a, BSDFFlags b) { return static_cast<unsigned>(a) | static_cast<unsigned>(b); }
constexpr unsigned operator+(BSDFFlags a) { return static_cast<unsigned>(a); }
struct BSDFContext {
  bool is_enabled(BSDFFlags) const { return true; }
};
enum class ProfilerPhase { BSDFSample, BSDFEvaluate };

struct Properties;

template <class Float, class Spectrum>
class BSDF {
 public:
  explicit BSDF(const Properties&) {}
  virtual ~BSDF() = default;
  virtual std::pair<BSDFSample3<Float>, Spectrum> sample(const BSDFContext&, const SurfaceInteraction3<Float>&, Float,
                                                         const Point2<Float>&, bool) const = 0;
  virtual Spectrum eval(const BSDFContext&, const SurfaceInteraction3<Float>&, const Vector3<Float>&, bool) const = 0;
  virtual Float pdf(const BSDFContext&, const SurfaceInteraction3<Float>&, const Vector3<Float>&, bool) const = 0;
  virtual std::string to_string() const = 0;

 protected:
  unsigned m_flags = 0;
  std::vector<unsigned> m_components;
};

}  // namespace mitsuba
