#pragma once
/// The lobes that analytic BRDFs are sums of: a colour times a shape with a few parameters.
/// J. B. Nielsen's thesis (2016), Sec. 2.2.4.

#include <gonio/core/brdf.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace gonio::model {

/// What the lobes of analytic models depend on, of a pair of directions above the horizon.
struct lobe_geometry {
  double cosine_i;    ///< of wi with the normal
  double cosine_o;    ///< of wo with the normal
  double cosine_d;    ///< of wi, or wo, with the half vector
  double tangential;  ///< the product of wi and wo within the surface, x x' + y y'
  direction h;        ///< the half vector

  lobe_geometry(const direction& wi, const direction& wo) noexcept
      : cosine_i(wi.z()), cosine_o(wo.z()), tangential(wi.x() * wo.x() + wi.y() * wo.y()) {
    const direction sum = wi + wo;
    const double length = sum.norm();
    cosine_d = std::min(0.5 * length, 1.0);
    // Directions that are opposite up to rounding leave no half vector; the normal is the limit within the plane.
    h = length > 0.0 ? direction(sum / length) : direction(0.0, 0.0, 1.0);
  }

  /// The cosine between the viewer and the mirrored light: wr . wo with wr = 2 (wi . n) n - wi.
  [[nodiscard]] double mirrored_cosine() const noexcept { return cosine_i * cosine_o - tangential; }
  /// tan^2 of the half angle; infinite where the half vector lies in the surface.
  [[nodiscard]] double squared_tangent_h() const noexcept { return (h.x() * h.x() + h.y() * h.y()) / (h.z() * h.z()); }
};

/// A parameter of a shape: what it may be, and in what unit.
struct shape_parameter {
  std::string_view name, unit;
  double lowest, highest;
  double typical;            ///< where a fit may start
  bool logarithmic = false;  ///< steps are factors: a roughness, an exponent
};

/// The shape of a lobe, in sr^-1: a struct of parameters that is a template of their number type, because a fit
/// evaluates it with numbers that carry derivatives.
///
/// What the compiler cannot check, and a model must keep: `parameters` describes the `members`, in their order; the
/// value is not negative, and finite unless a cosine underflows; it does not throw.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/model/phong.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::model::lobe<gonio::model::phong_shape> gloss{gonio::rgb::Constant(0.2), {.shininess = 50}};
///   std::printf("%g sr^-1\n", gloss({0.6, 0, 0.8}, {-0.6, 0, 0.8}).x());
/// }
/// ```
/// With a model of your own, fitted as any other is:
/// ```cpp
/// #include <gonio/io/measurements/samples.hpp>
/// #include <gonio/metric/log.hpp>
/// #include <gonio/model/fit_model.hpp>
///
/// #include <cstdio>
///
/// template <class Real>
/// struct retroreflection_shape {
///   Real exponent = Real(10);
///
///   static constexpr std::string_view name = "retroreflection";
///   static constexpr std::array<gonio::model::shape_parameter, 1> parameters{{{"exponent", "", 1, 1e4, 10, true}}};
///   static auto members(auto& self) { return std::tie(self.exponent); }
///   Real operator()(const gonio::model::lobe_geometry& at) const {
///     using std::exp;
///     return exp(Real(exponent * std::log(at.cosine_d)));
///   }
/// };
/// static_assert(gonio::model::lobe_shape<retroreflection_shape>);
///
/// int main() {
///   const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
///   const std::vector kinds{&gonio::model::lobe_kind::of<retroreflection_shape>()};
///   const auto fit = gonio::model::fit_model(kinds, gonio::model::fit_observations(samples), gonio::log{});
///   std::printf("loss %g\n", fit.loss);
/// }
/// ```
template <template <class> class Shape>
concept lobe_shape = requires(Shape<double>& shape, const Shape<double>& constant, const lobe_geometry& at) {
  { Shape<double>::name } -> std::convertible_to<std::string_view>;
  { Shape<double>::parameters.size() } -> std::same_as<std::size_t>;
  Shape<double>::members(shape);
  { constant(at) } -> std::convertible_to<double>;
};

/// How many parameters a shape has.
template <template <class> class Shape>
inline constexpr Eigen::Index parameter_count =
    std::tuple_size_v<decltype(Shape<double>::members(std::declval<Shape<double>&>()))>;

/// The parameters of a shape as an array.
template <template <class> class Shape, class Real>
[[nodiscard]] std::array<Real, parameter_count<Shape>> values_of(const Shape<Real>& shape) {
  return std::apply([](const auto&... value) { return std::array<Real, parameter_count<Shape>>{value...}; },
                    Shape<Real>::members(shape));
}

/// The shape with some parameters, which are taken as they are.
template <template <class> class Shape, class Real>
[[nodiscard]] Shape<Real> shape_from(const std::array<Real, parameter_count<Shape>>& values) {
  Shape<Real> shape;
  std::apply(
      [&](auto&... member) {
        Eigen::Index i = 0;
        ((member = values[i++]), ...);
      },
      Shape<Real>::members(shape));
  return shape;
}

/// Throws gonio::error naming the shape, the parameter and its bound unless the value is within.
void require_within_bounds(std::string_view shape, const shape_parameter& parameter, double value);

/// Throws gonio::error naming the shape unless the colour is finite and not negative.
void require_usable_colour(std::string_view shape, const rgb& colour);

/// Reflectance is held below this where a model has a pole at grazing angles: infinity times no light would be no
/// number.
inline constexpr double largest_reflectance = 1e300;

/// A shape in a colour: f = colour * shape(wi, wo).
/// ```cpp
/// const gonio::model::ward varnish{gonio::rgb::Constant(0.1), {.roughness = 0.05}};
/// ```
template <template <class> class Shape>
requires lobe_shape<Shape>
class lobe {
 public:
  using shape_type = Shape<double>;

  /// Throws gonio::error naming what is out of bounds; a colour must be finite and not negative.
  explicit lobe(rgb colour = rgb::Ones(), const shape_type& shape = {}) : colour_(std::move(colour)), shape_(shape) {
    require_usable_colour(shape_type::name, colour_);
    const auto values = values_of<Shape, double>(shape_);
    for (Eigen::Index i = 0; i < std::ssize(values); ++i)
      require_within_bounds(shape_type::name, shape_type::parameters[i], values[i]);
  }

  [[nodiscard]] const rgb& colour() const noexcept { return colour_; }
  [[nodiscard]] const shape_type& shape() const noexcept { return shape_; }

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    return (colour_ * std::min(shape_(lobe_geometry(wi, wo)), largest_reflectance)).min(largest_reflectance);
  }

 private:
  rgb colour_;
  shape_type shape_;
};

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/lobe.ipp>
#endif
