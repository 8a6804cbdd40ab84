#include "papers/xu2016/mapped_errors.hpp"

#include <gonio/basis/pca.hpp>
#include <gonio/basis/project.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <utility>

namespace papers {

mapped_errors::mapped_errors(gonio::log_relative_pca prior, const gonio::material_set& truths, double eta,
                             gonio::thread_count threads)
    : prior_(std::move(prior)), names_(truths.names), eta_(eta) {
  const auto columns = 3 * std::ssize(names_);
  centred_.resize(std::ssize(prior_.cells()), columns);
  projected_.resize(prior_.size(), columns);
  missed_.resize(columns);
  for (std::size_t m = 0; m < names_.size(); ++m) {
    const gonio::brdf_table truth = truths.table(m);
    const Eigen::Index first = 3 * m;
    projected_.middleCols(first, 3) = gonio::project(prior_, truth, threads);
    for (Eigen::Index cell = 0; cell < truth.cells().size(); ++cell) {
      const gonio::rgb value = truth.at(cell);
      for (Eigen::Index channel = 0; channel < 3; ++channel)
        centred_(cell, first + channel) =
            static_cast<float>(prior_.metric().forward(value[channel], cell) - prior_.offset(cell));
    }
  }
  const Eigen::MatrixXd known = prior_.singular_values().asDiagonal() * projected_;
  for (Eigen::Index column = 0; column < columns; ++column)
    missed_[column] =
        std::max(centred_.col(column).cast<double>().squaredNorm() - known.col(column).squaredNorm(), 0.0);
}

gonio::least_squares_problem mapped_errors::problem_of(std::span<const gonio::half_difference> directions) const {
  const gonio::valid_cells& cells = prior_.cells();
  gonio::row_matrix rows(std::ssize(directions), prior_.size());
  Eigen::MatrixXd values(std::ssize(directions), centred_.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto& angles = directions[i];
    const std::size_t cell = cells.representative(cells.grid().linear(cells.grid().nearest(angles)));
    rows.row(i) = prior_.components().row(cell).cast<double>();
    values.row(i) = centred_.row(cell).cast<double>();
  }
  return {std::move(rows), std::move(values)};
}

Eigen::ArrayX3d mapped_errors::from(std::span<const gonio::half_difference> directions) const {
  return of_weights(gonio::tikhonov(eta_).solve(problem_of(directions)).weights);
}

Eigen::ArrayX3d mapped_errors::of_weights(const Eigen::MatrixXd& weights) const {
  const Eigen::MatrixXd off = prior_.singular_values().asDiagonal() * (weights - projected_);
  return root_mean_square(missed_ + off.colwise().squaredNorm().transpose().array());
}

gonio::sample_set mapped_errors::measured(std::size_t material,
                                          std::span<const gonio::half_difference> directions) const {
  gonio::sample_set samples;
  for (const Eigen::Index cell : gonio::cells_at(prior_.cells(), directions)) {
    gonio::sample seen{prior_.cells().angles(cell), {}, 1.0};
    for (Eigen::Index channel = 0; channel < 3; ++channel) {
      const double mapped = double{centred_(cell, (3 * material) + channel)} + prior_.offset(cell);
      seen.value[channel] = prior_.metric().inverse(mapped, cell);
    }
    samples.push_back(seen);
  }
  return samples;
}

Eigen::ArrayX3d mapped_errors::of(const std::vector<gonio::model::analytic_brdf>& estimates,
                                  gonio::thread_count threads) const {
  const Eigen::ArrayXd squares = gonio::sum_over_blocks(
      prior_.cells().size(), 1024, Eigen::ArrayXd::Zero(3 * std::ssize(names_)).eval(),
      [&](Eigen::ArrayXd& sum, gonio::block range) {
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
          const auto [wi, wo] = gonio::to_directions(prior_.cells().angles(cell));
          for (std::size_t m = 0; m < estimates.size(); ++m) {
            const gonio::rgb value = estimates[m](wi, wo);
            for (Eigen::Index channel = 0; channel < 3; ++channel) {
              const Eigen::Index column = (3 * m) + channel;
              const double off =
                  prior_.metric().forward(value[channel], cell) - prior_.offset(cell) - double{centred_(cell, column)};
              sum[column] += off * off;
            }
          }
        }
      },
      threads);
  return root_mean_square(squares);
}

Eigen::ArrayX3d mapped_errors::from_all() const { return root_mean_square(missed_); }

Eigen::ArrayX3d mapped_errors::from_nothing() const {
  const Eigen::MatrixXd known = prior_.singular_values().asDiagonal() * projected_;
  return root_mean_square(missed_ + known.colwise().squaredNorm().transpose().array());
}

Eigen::ArrayX3d mapped_errors::root_mean_square(const Eigen::ArrayXd& squares) const {
  Eigen::ArrayX3d errors(std::ssize(names_), 3);
  for (Eigen::Index m = 0; m < errors.rows(); ++m)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      errors(m, channel) = std::sqrt(squares[3 * m + channel] / static_cast<double>(prior_.cells().size()));
  return errors;
}

}  // namespace papers
