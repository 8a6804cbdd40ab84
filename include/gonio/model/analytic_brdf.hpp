#pragma once
/// Analytic BRDFs whose lobes are chosen at run time, by a fit, a file or a command line.

#include <gonio/model/fresnel_lobe.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lafortune.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/phong.hpp>
#include <gonio/model/torrance_sparrow.hpp>
#include <gonio/model/ward.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::model {

/// The shape of a lobe behind function pointers. Each kind has one object in static memory.
class lobe_kind {
 public:
  static constexpr Eigen::Index most_parameters = 4;
  using values = std::array<double, most_parameters>;  ///< unused entries are zero

  /// Returns the kind of a shape that is known at compile time.
  template <template <class> class Shape>
  requires lobe_shape<Shape>
  [[nodiscard]] static const lobe_kind& of() {
    static_assert(parameter_count<Shape> <= most_parameters);
    constexpr bool is_anisotropic = requires { Shape<double>::is_anisotropic; };
    static const lobe_kind kind(Shape<double>::name, Shape<double>::parameters, is_anisotropic, &value_of<Shape>,
                                &slopes_of<Shape>);
    return kind;
  }

  [[nodiscard]] std::string_view name() const noexcept { return name_; }
  [[nodiscard]] std::span<const shape_parameter> parameters() const noexcept { return parameters_; }

  /// Returns true if the value changes when both directions are turned about the normal.
  [[nodiscard]] bool is_anisotropic() const noexcept { return is_anisotropic_; }

  /// Returns parameters from which a fit may start.
  [[nodiscard]] values typical() const noexcept {
    values start{};
    for (Eigen::Index i = 0; i < std::ssize(parameters_); ++i) start[i] = parameters_[i].typical;
    return start;
  }

  /// Returns the shape's value in sr^-1.
  [[nodiscard]] double value(const lobe_geometry& at, const values& p) const noexcept { return value_(at, p); }

  /// Returns the shape's value and writes its exact derivatives with respect to the parameters.
  double value_and_slopes(const lobe_geometry& at, const values& p, values& slopes) const noexcept {
    return slopes_(at, p, slopes);
  }

  friend bool operator==(const lobe_kind& a, const lobe_kind& b) noexcept { return &a == &b; }

 private:
  using value_function = double (*)(const lobe_geometry&, const values&);
  using slopes_function = double (*)(const lobe_geometry&, const values&, values&);

  lobe_kind(std::string_view name, std::span<const shape_parameter> parameters, bool is_anisotropic,
            value_function shape, slopes_function slopes)
      : name_(name), parameters_(parameters), is_anisotropic_(is_anisotropic), value_(shape), slopes_(slopes) {}

  template <template <class> class Shape>
  [[nodiscard]] static double value_of(const lobe_geometry& at, const values& p) {
    std::array<double, parameter_count<Shape>> own{};
    std::copy_n(p.begin(), own.size(), own.begin());
    return shape_from<Shape, double>(own)(at);
  }

  template <template <class> class Shape>
  [[nodiscard]] static double slopes_of(const lobe_geometry& at, const values& p, values& slopes) {
    constexpr Eigen::Index count = parameter_count<Shape>;
    if constexpr (count == 0) {
      return value_of<Shape>(at, p);
    } else {
      constexpr int size = static_cast<int>(count);
      using number = Eigen::AutoDiffScalar<Eigen::Matrix<double, size, 1>>;
      std::array<number, count> own;
      for (int i = 0; i < size; ++i) own[i] = number(p[i], size, i);
      const number found = shape_from<Shape, number>(own)(at);
      std::copy_n(found.derivatives().data(), count, slopes.begin());
      return found.value();
    }
  }

  std::string_view name_;
  std::span<const shape_parameter> parameters_;
  bool is_anisotropic_;
  value_function value_;
  slopes_function slopes_;
};

/// Returns this library's kinds, all isotropic.
[[nodiscard]] std::span<const lobe_kind* const> lobe_kinds();

/// All anisotropic kinds.
[[nodiscard]] std::span<const lobe_kind* const> anisotropic_lobe_kinds();

/// Returns the kind with this name, isotropic or anisotropic. If there is none, throws gonio::error that lists the
/// names.
[[nodiscard]] const lobe_kind& lobe_kind_named(std::string_view name);

/// One lobe of a BRDF: a kind, a colour and the parameters of the kind.
class analytic_lobe {
 public:
  /// Throws gonio::error for a parameter out of bounds (the message names the shape and the parameter), and for a
  /// negative or non-finite colour.
  analytic_lobe(const lobe_kind& kind, const rgb& colour, const lobe_kind::values& parameters);

  [[nodiscard]] const lobe_kind& kind() const noexcept { return *kind_; }
  [[nodiscard]] const rgb& colour() const noexcept { return colour_; }
  [[nodiscard]] const lobe_kind::values& parameters() const noexcept { return parameters_; }

  /// Converts to a lobe of a known shape, such as `ward`. Throws gonio::error if the lobe is of another kind.
  template <template <class> class Shape>
  [[nodiscard]] lobe<Shape> as() const {
    if (!(*kind_ == lobe_kind::of<Shape>()))
      refuse("a lobe is " + std::string(kind_->name()) + ", not " + std::string(Shape<double>::name));
    std::array<double, parameter_count<Shape>> own{};
    std::copy_n(parameters_.begin(), own.size(), own.begin());
    return lobe<Shape>(colour_, shape_from<Shape, double>(own));
  }

  [[nodiscard]] rgb operator()(const lobe_geometry& at) const noexcept {
    return (colour_ * std::min(kind_->value(at, parameters_), largest_reflectance)).min(largest_reflectance);
  }

 private:
  const lobe_kind* kind_;
  rgb colour_;
  lobe_kind::values parameters_;
};

/// A sum of lobes.
class analytic_brdf {
 public:
  explicit analytic_brdf(std::vector<analytic_lobe> lobes = {}) : lobes_(std::move(lobes)) {}

  [[nodiscard]] const std::vector<analytic_lobe>& lobes() const noexcept { return lobes_; }

  /// Returns true if a lobe is anisotropic.
  [[nodiscard]] bool is_anisotropic() const noexcept {
    return std::ranges::any_of(lobes_, [](const analytic_lobe& lobe) { return lobe.kind().is_anisotropic(); });
  }

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    rgb sum = rgb::Zero();
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return sum;
    const lobe_geometry at(wi, wo);
    for (const analytic_lobe& lobe : lobes_) sum += lobe(at);
    return sum;
  }

 private:
  std::vector<analytic_lobe> lobes_;
};

static_assert(brdf<analytic_brdf>);

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/analytic_brdf.ipp>
#endif
