/// Must not compile: the metric, basis or solver of a decomposition lacks a member, chosen by a macro.
/// incomplete_parts.cmake compiles it once for each member.

#include <gonio/estimate/decomposition.hpp>

#include <span>

struct half {
  double forward(double rho, const auto&) const noexcept { return rho / 2.0; }
#if !defined(WITHOUT_INVERSE)
  double inverse(double y, const auto&) const noexcept { return 2.0 * y; }
#endif
};

struct constant {
  gonio::valid_cells over;
  Eigen::Index size() const { return 1; }
  const gonio::valid_cells& cells() const { return over; }
  double offset(Eigen::Index) const { return 0.0; }
  half metric() const { return {}; }
#if !defined(WITHOUT_ROW)
  std::span<const float> row(Eigen::Index) const {
    static constexpr float one = 1;
    return {&one, 1};
  }
#endif
};

struct own_solver {
#if !defined(WITHOUT_SOLVE)
  gonio::solution solve(const gonio::least_squares_problem& problem) const;
#endif
};

auto fit(const constant& functions, const gonio::sample_set& samples) {
  return gonio::decomposition{functions, own_solver{}}.fit(samples);
}
