#pragma once
/// Tables like those of the RGL database, computed from any BRDF: `tabulate_adaptively(f)`.
///
/// Dupuy and Jakob 2018 (doi:10.1145/3272127.3275059; see model/adaptive_brdf.hpp). The distribution of normals is
/// computed from the retroreflection: D(m) = f(m, m) cos(m) sigma(m) up to a factor, where sigma is the projected area
/// of D itself. Power iterations find this fixed point (Dupuy, Heitz, Iehl, Poulin, Ostromoukhov, "Extracting
/// Microfacet-based BRDF Parameters from Arbitrary Materials with Power Iterations", EGSR 2015, doi:10.1111/cgf.12675).

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/physical_properties.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <functional>
#include <iterator>

namespace gonio::model {

/// The sizes of the tables. docs/results/renderers.md lists the error of each size.
struct adaptive_resolution {
  Eigen::Index theta_i = 32;           ///< polar angles of wi, uniform from 0 to pi/2
  Eigen::Index values = 96;            ///< rows and columns of each reflectance table at each theta_i
  Eigen::Index visible_normals = 128;  ///< rows and columns of the density of visible normals at each theta_i
  Eigen::Index normals = 256;          ///< polar angles of the distribution of normals
};

/// The sizes of the tables of an anisotropic material.
struct anisotropic_resolution {
  Eigen::Index phi_i = 33;            ///< azimuths of wi, uniform from -pi to pi, both included; at least 3
  Eigen::Index theta_i = 24;          ///< polar angles of wi, uniform from 0 to pi/2
  Eigen::Index values = 48;           ///< rows and columns of the reflectance at each wi
  Eigen::Index visible_normals = 48;  ///< rows and columns of the density of visible normals at each wi
  Eigen::Index normals = 128;         ///< azimuths and polar angles of the distribution of normals
};

namespace detail {

using brdf_function = std::function<rgb(const direction& wi, const direction& wo)>;

[[nodiscard]] adaptive_brdf_parts tabulated_adaptively(const brdf_function& f, const adaptive_resolution& resolution,
                                                       thread_count threads);
[[nodiscard]] adaptive_brdf_parts tabulated_adaptively(const brdf_function& f, const anisotropic_resolution& resolution,
                                                       thread_count threads);
[[nodiscard]] unit_square_tables tabulated_over(const brdf_function& f, const adaptive_brdf_parts& normals,
                                                thread_count threads);

}  // namespace detail

/// Returns the tables of an isotropic BRDF. At the nodes of the tables, `as_measured(wi, wo)` of the result is f(wi,
/// wo); between them it is interpolated. At nodes with wo below the horizon, f(wi, wo) cos(theta_o) is extrapolated
/// linearly to negative values, so that cells that the horizon crosses are interpolated without a bend.
///
/// Throws gonio::error for fewer than 2 or more than 4096 numbers along any axis, and for values that are not finite.
/// The bytes do not depend on the number of threads. O(theta_i values^2) evaluations of f.
template <brdf Brdf>
[[nodiscard]] adaptive_brdf tabulate_adaptively(const Brdf& f, const adaptive_resolution& resolution = {},
                                                thread_count threads = {}) {
  const auto evaluated = [&f](const direction& wi, const direction& wo) -> rgb { return f(wi, wo); };
  return adaptive_brdf(detail::tabulated_adaptively(evaluated, resolution, threads));
}

/// Returns the tables of an anisotropic BRDF, also over the azimuths of the light:
/// `tabulate_adaptively(f, anisotropic_resolution{})`. A template, so that `{}` means the isotropic overload.
template <brdf Brdf, std::same_as<anisotropic_resolution> Resolution>
[[nodiscard]] adaptive_brdf tabulate_adaptively(const Brdf& f, const Resolution& resolution,
                                                thread_count threads = {}) {
  const auto evaluated = [&f](const direction& wi, const direction& wo) -> rgb { return f(wi, wo); };
  return adaptive_brdf(detail::tabulated_adaptively(evaluated, resolution, threads));
}

/// The default limit of the relative albedo error of a material's tables.
inline constexpr double usual_albedo_tolerance = 0.006;

/// Returns the largest relative difference between the albedo of a BRDF and the albedo of its tables as measured, at 0,
/// 20, 40, 60 and 80 degrees of wi. Evaluates each 800,000 times.
template <brdf Brdf>
[[nodiscard]] double albedo_error(const Brdf& f, const adaptive_brdf& tables, thread_count threads = {}) {
  std::array<double, 5> errors{};
  for_each_index(
      std::ssize(errors), 1,
      [&](Eigen::Index i) {
        const double theta = radians(20.0 * static_cast<double>(i));
        // `directional_albedo` integrates over its first direction, so exchange light and viewer.
        const auto exchanged = [&f](const direction& wo, const direction& wi) noexcept -> rgb { return f(wi, wo); };
        const auto measured = [&tables](const direction& wo, const direction& wi) noexcept -> rgb {
          return tables.as_measured(wi, wo);
        };
        const rgb expected = directional_albedo(exchanged, theta), found = directional_albedo(measured, theta);
        errors[static_cast<std::size_t>(i)] = ((found - expected).abs() / expected.max(1e-6)).maxCoeff();
      },
      threads);
  return *std::ranges::max_element(errors);
}

/// Returns a BRDF's tables at the default resolution if their albedo differs by at most `tolerance` (`albedo_error`).
/// Otherwise uses nearly twice as many theta_i, and if needed also 1.5 times as many rows and columns. With too few,
/// the tables are too bright where a narrow highlight grows towards grazing angles. A file of the tables has 7, 13 or
/// 24 MB. Throws like `tabulate_adaptively`.
template <brdf Brdf>
[[nodiscard]] adaptive_brdf tabulate_keeping_albedo(const Brdf& f, double tolerance = usual_albedo_tolerance,
                                                    thread_count threads = {}) {
  for (const adaptive_resolution& smaller : {adaptive_resolution{}, adaptive_resolution{.theta_i = 60}}) {
    adaptive_brdf found = tabulate_adaptively(f, smaller, threads);
    if (albedo_error(f, found, threads) <= tolerance) return found;
  }
  return tabulate_adaptively(f, {.theta_i = 60, .values = 144}, threads);
}

/// Returns the reflectance tables of another BRDF over a material's own normals, for `adaptive_brdf_parts`: for example
/// at three wavelengths, for a material that is tabulated in colours. O(theta_i values^2) evaluations of f.
template <brdf Brdf>
[[nodiscard]] unit_square_tables tabulate_over(const adaptive_brdf& material, const Brdf& f,
                                               thread_count threads = {}) {
  const auto evaluated = [&f](const direction& wi, const direction& wo) -> rgb { return f(wi, wo); };
  return detail::tabulated_over(evaluated, material.parts(), threads);
}

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/tabulate_adaptively.ipp>
#endif
