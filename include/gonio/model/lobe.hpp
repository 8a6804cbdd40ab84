#pragma once
/// The lobes of analytic BRDFs: a colour times a shape with a few parameters.
/// J. B. Nielsen's thesis (2016), Sec. 2.2.4.

#include <gonio/core/brdf.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace gonio::model {

/// The arguments of a lobe's shape for a pair of directions above the horizon.
struct lobe_geometry {
  double cosine_i;    ///< between wi and the normal
  double cosine_o;    ///< between wo and the normal
  double cosine_d;    ///< between wi and the half vector, or wo and the half vector
  double tangential;  ///< the product of the tangential parts of wi and wo, x x' + y y'
  direction h;        ///< the half vector
  double x_i, y_i;    ///< the tangential part of wi
  double x_o, y_o;    ///< the tangential part of wo

  lobe_geometry(const direction& wi, const direction& wo) noexcept
      : cosine_i(wi.z()),
        cosine_o(wo.z()),
        tangential(wi.x() * wo.x() + wi.y() * wo.y()),
        x_i(wi.x()),
        y_i(wi.y()),
        x_o(wo.x()),
        y_o(wo.y()) {
    const direction sum = wi + wo;
    const double length = sum.norm();
    cosine_d = std::min(0.5 * length, 1.0);
    // Opposite directions have no half vector. Use the normal, the limit of the half vector in their plane.
    h = length > 0.0 ? direction(sum / length) : direction(0.0, 0.0, 1.0);
  }

  /// The cosine between the viewer and the mirrored light: wr . wo with wr = 2 (wi . n) n - wi.
  [[nodiscard]] double mirrored_cosine() const noexcept { return cosine_i * cosine_o - tangential; }
  /// tan^2 theta_h; infinite if the half vector lies in the surface.
  [[nodiscard]] double squared_tangent_h() const noexcept { return (h.x() * h.x() + h.y() * h.y()) / (h.z() * h.z()); }
};

/// A parameter of a shape: its name, unit and bounds.
struct shape_parameter {
  std::string_view name, unit;
  double lowest, highest;
  double typical;            ///< a value from which a fit may start
  bool logarithmic = false;  ///< a fit takes steps in the logarithm, as for a roughness or an exponent
  bool periodic = false;     ///< both bounds mean the same: a fit starts at four values
};

/// The rotation of the axes of an anisotropic shape.
inline constexpr shape_parameter axes_rotation{"rotation", "rad", -std::numbers::pi / 2, std::numbers::pi / 2, 0.0,
                                               false,      true};

/// Returns the squared length of (x, y) in axes that are rotated from x towards y, with x scaled by a and y by b.
template <class Real>
[[nodiscard]] Real scaled_square(double x, double y, const Real& rotation, const Real& a, const Real& b) {
  using std::cos, std::sin;
  const Real c = cos(rotation), s = sin(rotation);
  const Real along = (c * x + s * y) * a, beside = (c * y - s * x) * b;
  return along * along + beside * beside;
}

/// A struct of parameters whose call operator returns the shape of a lobe, in sr^-1. It is a template over the number
/// type, because a fit evaluates it with numbers that carry derivatives.
///
/// A model must keep rules that the compiler cannot check. `parameters` describes the `members` in their order. The
/// call operator does not throw. Its value is not negative, and finite unless a cosine underflows.
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
/// With a model of your own, fitted like any other:
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

/// The number of parameters of a shape.
template <template <class> class Shape>
inline constexpr Eigen::Index parameter_count =
    std::tuple_size_v<decltype(Shape<double>::members(std::declval<Shape<double>&>()))>;

/// Returns the parameters of a shape as an array.
template <template <class> class Shape, class Real>
[[nodiscard]] std::array<Real, parameter_count<Shape>> values_of(const Shape<Real>& shape) {
  return std::apply([](const auto&... value) { return std::array<Real, parameter_count<Shape>>{value...}; },
                    Shape<Real>::members(shape));
}

/// Returns the shape with the given parameters. Does not check them.
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

/// Throws gonio::error that names the shape, the parameter and its bounds unless the value is within them.
void require_within_bounds(std::string_view shape, const shape_parameter& parameter, double value);

/// Throws gonio::error that names the shape unless the colour is finite and not negative.
void require_usable_colour(std::string_view shape, const rgb& colour);

/// The upper limit of reflectance for models with a pole at grazing angles. Without the limit, infinity times zero
/// light would be NaN.
inline constexpr double largest_reflectance = 1e300;

/// A shape with a colour: f = colour * shape(wi, wo).
/// ```cpp
/// const gonio::model::ward varnish{gonio::rgb::Constant(0.1), {.roughness = 0.05}};
/// ```
template <template <class> class Shape>
requires lobe_shape<Shape>
class lobe {
 public:
  using shape_type = Shape<double>;

  /// Throws gonio::error for a parameter out of bounds (the message names the parameter), and for a negative or
  /// non-finite colour.
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
