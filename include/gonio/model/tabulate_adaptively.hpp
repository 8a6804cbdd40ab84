#pragma once
/// Tables of the RGL database's kind, made of any BRDF: `tabulate_adaptively(f)`.
///
/// Dupuy and Jakob 2018 (doi:10.1145/3272127.3275059; see model/adaptive_brdf.hpp). The distribution of normals comes
/// from what the material reflects back to the light: D(m) = f(m, m) cos(m) sigma(m) up to a factor, where sigma is the
/// projected area of D itself; the fixed point is found by power iterations (Dupuy, Heitz, Iehl, Poulin, Ostromoukhov,
/// "Extracting Microfacet-based BRDF Parameters from Arbitrary Materials with Power Iterations", EGSR 2015,
/// doi:10.1111/cgf.12675).

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/adaptive_brdf.hpp>

#include <Eigen/Core>

#include <functional>

namespace gonio::model {

/// How many numbers the tables have. docs/results/renderers.md has what is lost by which.
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

/// A BRDF's tables. `as_measured(wi, wo)` of the result is f(wi, wo) at the nodes of all tables, and interpolated
/// between them. Where wo is below the horizon, f(wi, wo) cos(theta_o) is continued linearly and so less than zero:
/// cells that the horizon crosses are interpolated without a bend.
///
/// Throws gonio::error for fewer than 2 numbers along any axis, and for values that are not finite. Same bytes for any
/// number of threads. O(theta_i values^2) evaluations of f.
template <brdf Brdf>
[[nodiscard]] adaptive_brdf tabulate_adaptively(const Brdf& f, const adaptive_resolution& resolution = {},
                                                thread_count threads = {}) {
  const auto evaluated = [&f](const direction& wi, const direction& wo) -> rgb { return f(wi, wo); };
  return adaptive_brdf(detail::tabulated_adaptively(evaluated, resolution, threads));
}

/// The reflectance of another BRDF over a material's own normals, as `adaptive_brdf_parts` has it: three wavelengths of
/// a material, say, that is tabulated in colours. O(theta_i values^2) evaluations of f.
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
