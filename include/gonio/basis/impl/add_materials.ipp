#pragma once
/// Bodies of basis/add_materials.hpp.

#include <gonio/basis/add_materials.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Columns for the update: the old components Q, the new observations minus their own mean, and the difference of the
/// means. The columns are scaled: the sum of their outer products equals that of all observations minus their mean.
struct appended_columns {
  log_relative_pca prior;
  mapped_materials added;
  double old_count, new_count;  ///< numbers of observations

  [[nodiscard]] Eigen::Index columns() const { return prior.size() + added.materials().columns() + 1; }
  [[nodiscard]] double scale() const { return std::sqrt(old_count * new_count / (old_count + new_count)); }
  [[nodiscard]] double difference(Eigen::Index cell) const { return prior.offset(cell) - double{added.mean()[cell]}; }

  [[nodiscard]] row_source rows(const row_source& of_added) const {
    return {of_added.rows, columns(), [*this, of_added](block range, row_block out) {
              const Eigen::Index k = prior.size(), last = columns() - 1;
              of_added.read(range, out.middleCols(k, of_added.columns));
              for (Eigen::Index i = 0; i < range.size(); ++i) {
                const Eigen::Index cell = range.begin + i;
                const std::span<const float> row = prior.row(cell);
                for (Eigen::Index j = 0; j < k; ++j) out(i, j) = row[j];
                out(i, last) = scale() * difference(cell);
              }
            }};
  }

  /// Returns the coefficients of all observations minus their common mean. Each observation is a combination of the
  /// columns; its coefficients are this combination's factors times `u`.
  [[nodiscard]] Eigen::MatrixXf coefficients(const Eigen::MatrixXd& u) const {
    const Eigen::Index k = prior.size(), old = prior.coefficients().rows(), added_columns = added.materials().columns();
    const double all = old_count + new_count;
    Eigen::MatrixXd rows(old + added_columns, u.cols());
    rows.topRows(old) = product(prior.coefficients().cast<double>(), u.topRows(k));
    rows.bottomRows(added_columns) = u.middleRows(k, added_columns);
    const Eigen::RowVectorXd last = u.row(u.rows() - 1) / (all * scale());
    rows.topRows(old).rowwise() += new_count * last;
    rows.bottomRows(added_columns).rowwise() -= old_count * last;
    return rows.cast<float>();
  }

  [[nodiscard]] std::vector<float> mean() const {
    std::vector<float> all(added.mean().size());
    for (Eigen::Index cell = 0; cell < std::ssize(all); ++cell)
      all[cell] = static_cast<float>(prior.offset(cell) - new_count / (old_count + new_count) * difference(cell));
    return all;
  }

  /// Return squared norms: of the old components over the cells, and of all observations minus their common mean.
  [[nodiscard]] double old_variation() const { return prior.components().cast<double>().squaredNorm(); }
  [[nodiscard]] double variation() const {
    double between = 0.0;
    for (Eigen::Index cell = 0; cell < prior.cells().size(); ++cell) between += difference(cell) * difference(cell);
    return old_variation() / prior.explained_variance() + added.total_variation() + scale() * scale() * between;
  }

  void require_same_channels() const {
    const auto described = [](const std::vector<double>& wavelengths) {
      return wavelengths.empty() ? std::string("in RGB") : message_of({"at ", wavelengths.size(), " wavelengths"});
    };
    const std::vector<double>&known = prior.wavelengths(), &given = added.materials().wavelengths;
    if (known.size() != given.size())
      refuse({"the prior's materials are ", described(known), ", the materials to add are ", described(given)});
    for (std::size_t i = 0; i < known.size(); ++i)
      if (known[i] != given[i])
        refuse({"wavelength ", i + 1, " of the materials to add is ", given[i], " nm, the prior's is ", known[i]});
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all = prior.names();
    for (const std::string& name : added.materials().names) {
      if (std::ranges::find(prior.names(), name) != prior.names().end())
        refuse({"the prior contains a material named '", name, "' already"});
      all.push_back(name);
    }
    return all;
  }
};

}  // namespace detail

GONIO_INLINE streamed_pca add_materials(const log_relative_pca& prior, material_rows materials,
                                        const streaming_options& options, const progress& listener) {
  const auto new_count = static_cast<double>(materials.columns());
  const detail::appended_columns all{prior, mapped_materials(std::move(materials), prior.metric()),
                                     prior.observations(), new_count};
  all.require_same_channels();
  std::vector<std::string> names = all.names();
  detail::streamed_components found =
      detail::components_of(all.rows(all.added.first_pass()), all.rows(all.added.rows()), options, listener);
  detail::complete_rows(options.share, all.added);
  const double variation = all.variation();
  const double scale = prior.singular_values().norm() / std::sqrt(all.old_variation());
  const auto& [values, vectors, residual] = found.pairs;
  return {log_relative_pca({prior.cells(),
                            prior.metric(),
                            std::move(names),
                            scale * values.cwiseSqrt(),
                            std::move(found.scaled),
                            all.mean(),
                            all.coefficients(vectors),
                            values.sum() / variation,
                            {},
                            prior.wavelengths()}),
          found.exact, residual / variation};
}

}  // namespace gonio
