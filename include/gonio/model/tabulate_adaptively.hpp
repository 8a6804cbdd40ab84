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
#include <functional>
#include <iterator>

namespace gonio::model {

/// The sizes of the tables. docs/results/renderers.md lists the error of each size.
struct adaptive_resolution {
  Eigen::Index theta_i = 32;           ///< polar angles of wi, uniform from 0 to pi/2
  Eigen::Index values = 96;            ///< rows and columns of the reflectance at each theta_i
  Eigen::Index visible_normals = 128;  ///< rows and columns of the density of visible normals at each theta_i
  Eigen::Index normals = 256;          ///< polar angles of the distribution of normals
};

namespace detail {

using brdf_function = std::function<rgb(const direction& wi, const direction& wo)>;

[[nodiscard]] adaptive_brdf_parts tabulated_adaptively(const brdf_function& f, const adaptive_resolution& resolution,
                                                       thread_count threads);
[[nodiscard]] unit_square_tables tabulated_over(const brdf_function& f, const adaptive_brdf_parts& normals,
                                                thread_count threads);

}  // namespace detail

/// Returns the tables of a BRDF. `as_measured(wi, wo)` of the result is f(wi, wo) at the nodes of all tables, and
/// interpolated between them. If wo is below the horizon, f(wi, wo) cos(theta_o) continues linearly, with negative
/// values. Cells that the horizon crosses are then interpolated without a bend.
///
/// Throws gonio::error for fewer than 2 or more than 4096 numbers along any axis, and for values that are not finite.
/// The bytes do not depend on the number of threads. O(theta_i values^2) evaluations of f.
template <brdf Brdf>
[[nodiscard]] adaptive_brdf tabulate_adaptively(const Brdf& f, const adaptive_resolution& resolution = {},
                                                thread_count threads = {}) {
  const auto evaluated = [&f](const direction& wi, const direction& wo) -> rgb { return f(wi, wo); };
  return adaptive_brdf(detail::tabulated_adaptively(evaluated, resolution, threads));
}

/// The default limit of the relative change of a material's albedo by its tables.
inline constexpr double usual_albedo_tolerance = 0.006;

/// Returns the largest relative difference between the albedos of a BRDF and of its tables as measured, at 0, 20, 40,
/// 60 and 80 degrees of wi. 800,000 evaluations of each.
template <brdf Brdf>
[[nodiscard]] double albedo_error(const Brdf& f, const adaptive_brdf& tables, thread_count threads = {}) {
  std::array<double, 5> errors{};
  for_each_index(
      std::ssize(errors), 1,
      [&](Eigen::Index i) {
        const double theta = radians(20.0 * static_cast<double>(i));
        // `directional_albedo` integrates over its first direction, so light and viewer are exchanged.
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

/// Returns a BRDF's tables at the default resolution if they keep its albedo within `tolerance`. Otherwise uses nearly
/// twice the angles, and if needed also half as many rows and columns again. Linear interpolation is too bright where a
/// narrow highlight grows towards grazing angles. A file of the tables has 7, 13 or 24 MB. Throws like
/// `tabulate_adaptively`.
template <brdf Brdf>
[[nodiscard]] adaptive_brdf tabulate_keeping_albedo(const Brdf& f, double tolerance = usual_albedo_tolerance,
                                                    thread_count threads = {}) {
  for (const adaptive_resolution& smaller : {adaptive_resolution{}, adaptive_resolution{.theta_i = 60}}) {
    adaptive_brdf found = tabulate_adaptively(f, smaller, threads);
    if (albedo_error(f, found, threads) <= tolerance) return found;
  }
  return tabulate_adaptively(f, {.theta_i = 60, .values = 144}, threads);
}

/// Returns the reflectance table of another BRDF over a material's own normals, for `adaptive_brdf_parts`: for example
/// three wavelengths of a material that is tabulated in colours. O(theta_i values^2) evaluations of f.
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
