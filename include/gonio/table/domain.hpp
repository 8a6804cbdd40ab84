#pragma once
/// The concept of a domain, over which the functions of a basis are defined.

#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <concepts>
#include <iterator>
#include <vector>

namespace gonio {

/// `size()` locations, numbered from 0: the valid cells of a grid for BRDFs, the coordinates of vertices for shapes.
///
/// Requirements that the compiler cannot check: copies are cheap; equal domains number the same locations in the same
/// way; `locate_cell(locations, i)`, found by argument-dependent lookup, returns the `location` that reads only the
/// value of location i. Observations over a domain have three channels of colour, unless the domain declares otherwise:
/// `static constexpr int channels = 1;`.
///
/// ```cpp
/// struct wavelengths {
///   std::vector<double> nanometres;
///   static constexpr int channels = 1;
///   Eigen::Index size() const { return nanometres.size(); }
///   bool operator==(const wavelengths&) const = default;
/// };
/// gonio::location locate_cell(const wavelengths&, Eigen::Index i) { return gonio::location_of(i); }
/// static_assert(gonio::domain<wavelengths>);
/// ```
template <class Domain>
concept domain = std::copyable<Domain> && std::equality_comparable<Domain> &&
    requires(const Domain& locations, Eigen::Index i) {
  { locations.size() } -> std::convertible_to<Eigen::Index>;
  { locate_cell(locations, i) } -> std::same_as<location>;
};

static_assert(domain<valid_cells>);

/// The number of channels of an observation over a domain.
template <domain Domain>
inline constexpr int channels_over = 3;

template <domain Domain>
requires requires { Domain::channels; }
inline constexpr int channels_over<Domain> = Domain::channels;

/// Returns the number of channels of an observation: the number of wavelengths or, if there are none, `channels_over`.
template <domain Domain>
[[nodiscard]] Eigen::Index channels_at(const std::vector<double>& wavelengths) noexcept {
  return wavelengths.empty() ? channels_over<Domain> : std::ssize(wavelengths);
}

}  // namespace gonio
