#include "synthetic_candidates.hpp"
#include <gonio/design/error_sweep.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <array>
#include <utility>

namespace {

using gonio::design::error_sweep;

/// Returns the tiles of some cells of the basis.
error_sweep::tiles tiles_of(const gonio::design::expected_error& criterion, Eigen::Index first, Eigen::Index cells) {
  const Eigen::Index columns = error_sweep::columns(criterion.coefficients().rows());
  error_sweep::tiles tiles = error_sweep::tiles::Zero(2 * error_sweep::width, cells / error_sweep::width * columns);
  const auto rows = criterion.prepare(candidate_basis().components().middleRows(first, cells).cast<double>().eval());
  for (Eigen::Index cell = 0; cell < cells; ++cell)
    for (Eigen::Index i = 0; i < criterion.coefficients().rows(); ++i) {
      auto column = tiles.col(cell / error_sweep::width * columns + i);
      column[cell % error_sweep::width] = static_cast<float>(rows.materials()(cell, i));
      column[error_sweep::width + cell % error_sweep::width] = static_cast<float>(rows.weighted()(cell, i));
    }
  return tiles;
}

}  // namespace

TEST_CASE("eight candidates side by side have the errors of each by itself, as extended_error has them") {
  for (const auto& [basis, leave_out] : {std::pair{&candidate_basis(), false}, std::pair{&candidate_basis(), true},
                                         std::pair{&spectral_candidate_basis(), true}})
    for (const double common_shift : {0.0, 0.3}) {
      const gonio::design::expected_error criterion(*basis,
                                                    {.eta = 2.0, .common_shift = common_shift, .leave_out = leave_out});
      CHECK(rc::check([&] {
        const auto n = *rc::gen::inRange<Eigen::Index>(0, 11);
        Eigen::MatrixXd measured(n, candidate_basis().size());
        for (Eigen::Index j = 0; j < n; ++j)
          measured.row(j) = candidate_basis()
                                .components()
                                .row(*rc::gen::inRange<Eigen::Index>(0, small_cells().size()))
                                .cast<double>();
        auto rows = criterion.prepare(measured);
        for (double& penalty : rows.sample_noise_penalty) penalty = 0.1 * static_cast<double>(*rc::gen::inRange(0, 30));
        constexpr Eigen::Index tiles = 2, cells = tiles * error_sweep::width;
        const auto first = *rc::gen::inRange<Eigen::Index>(0, small_cells().size() - cells);
        std::array<error_sweep::lanes, tiles> penalties{error_sweep::lanes::LinSpaced(0.0f, 3.0f),
                                                        error_sweep::lanes::Constant(0.5f)},
            found;
        error_sweep(criterion, rows)(tiles_of(criterion, first, cells), 0, penalties, found);
        const gonio::design::extended_error<double> one_by_one(criterion, rows);
        for (Eigen::Index cell = 0; cell < cells; ++cell) {
          const auto candidate =
              criterion.prepare(candidate_basis().components().row(first + cell).cast<double>().eval());
          const double penalty = double{penalties[cell / error_sweep::width][cell % error_sweep::width]};
          const double expected =
              one_by_one(candidate.materials(), candidate.weighted(), Eigen::ArrayXd::Constant(1, penalty))[0];
          RC_ASSERT(std::abs(found[cell / error_sweep::width][cell % error_sweep::width] - expected) <=
                    1e-4 * expected);
        }
      }));
    }
}
