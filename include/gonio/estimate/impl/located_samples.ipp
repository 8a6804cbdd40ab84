#pragma once
/// Bodies of estimate/located_samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace gonio::detail {

GONIO_INLINE void locate_angles(located_samples& samples, const valid_cells& cells, thread_count threads) {
  for_each_index(
      samples.size(), 1024, [&](Eigen::Index i) { samples.locations[i] = locate(cells, samples.locations[i].angles); },
      threads);
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE channel_values located_samples::channels() const {
  channel_values transposed(3, values.rows());
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      transposed(channel, i) = static_cast<float>(values(i, channel));
  return transposed;
}

GONIO_INLINE located_samples in_colours(located_samples samples) {
  if (samples.kinds.are_colours()) return samples;
  if (samples.values.cols() != 1)
    refuse({"samples at ", samples.values.cols(), " wavelengths have no colours, which this estimator needs"});
  const Eigen::MatrixXd grey = samples.values;
  samples.values.resize(grey.rows(), 3);
  for (Eigen::Index c = 0; c < 3; ++c) std::copy_n(grey.data(), grey.rows(), &samples.values(0, c));
  samples.kinds = {};
  return samples;
}

GONIO_INLINE channel_values located_samples::channel_weights() const {
  channel_values transposed(3, weights.rows());
  for (Eigen::Index i = 0; i < weights.rows(); ++i)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      transposed(channel, i) = static_cast<float>(weights(i, weighs_channels_apart() ? channel : 0));
  return transposed;
}

GONIO_INLINE located_samples located_samples::in_three_channels() const {
  if (kinds.are_colours()) return *this;
  located_samples three{locations, Eigen::MatrixXd(values.rows(), 3), weights};
  std::vector<double> row(values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index c = 0; c < values.cols(); ++c) row[c] = values(i, c);
    const rgb here = kinds.three(row);
    for (Eigen::Index c = 0; c < 3; ++c) three.values(i, c) = here[c];
  }
  return three;
}

GONIO_INLINE std::optional<located_samples> located_samples::at_invisible_wavelengths() const {
  std::vector<Eigen::Index> columns;
  std::vector<double> wavelengths;
  for (Eigen::Index c = 0; c < std::ssize(kinds.wavelengths()); ++c) {
    if (is_visible(kinds.wavelengths()[c])) continue;
    columns.push_back(c);
    wavelengths.push_back(kinds.wavelengths()[c]);
  }
  if (columns.empty() || !kinds.have_colour() || !kinds.are_wavelengths()) return {};
  located_samples rest{locations, Eigen::MatrixXd(values.rows(), std::ssize(columns)), weights,
                       gonio::channels(std::move(wavelengths))};
  for (Eigen::Index c = 0; c < rest.values.cols(); ++c)
    std::copy_n(&values(0, columns[c]), values.rows(), &rest.values(0, c));
  return rest;
}

GONIO_INLINE located_samples located_samples::subset(const std::vector<Eigen::Index>& positions) const {
  const auto count = std::ssize(positions);
  located_samples some{std::vector<location>(positions.size()), Eigen::MatrixXd(count, values.cols()),
                       Eigen::MatrixXd(count, weights.cols()), kinds};
  for (Eigen::Index i = 0; i < std::ssize(positions); ++i) {
    const Eigen::Index to = i, from = positions[i];
    some.locations[i] = locations[positions[i]];
    for (Eigen::Index channel = 0; channel < values.cols(); ++channel) some.values(to, channel) = values(from, channel);
    for (Eigen::Index column = 0; column < weights.cols(); ++column) some.weights(to, column) = weights(from, column);
  }
  return some;
}

GONIO_INLINE located_samples locate_samples(const valid_cells& cells, const sample_set& samples, thread_count threads) {
  require_usable(samples);
  const std::vector<Eigen::Index> counting = counting_positions(samples);
  const gonio::channels& kinds = samples.channels();
  const bool apart = kinds.are_colours() && weigh_channels_apart(samples);
  const Eigen::Index count = std::ssize(counting);
  if (count == 0) refuse("all samples have weight zero");
  located_samples found{std::vector<location>(counting.size()), Eigen::MatrixXd(count, kinds.size()),
                        Eigen::MatrixXd(count, apart ? 3 : 1), kinds};
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const Eigen::Index from = counting[i];
    found.locations[i].angles = samples.directions(from).angles();
    for (Eigen::Index c = 0; c < kinds.size(); ++c) found.values(i, c) = samples.values(from)[c];
    const channel_weights& weight = samples.weight(from);
    for (Eigen::Index c = 0; c < found.weights.cols(); ++c)
      found.weights(i, c) = apart || weight.is_uniform() ? weight[c] : weight.mean();
  }
  detail::locate_angles(found, cells, threads);
  return found;
}

GONIO_INLINE located_samples locate_samples(const valid_cells& cells, const brdf_table& table, thread_count threads) {
  const bool own = table.cells() == cells;
  const Eigen::Index count = table.cells().size();
  located_samples found{std::vector<location>(table.cells().size()), Eigen::MatrixXd(count, 3),
                        Eigen::MatrixXd::Ones(count, 1)};
  for_each_index(
      found.size(), 4096,
      [&](Eigen::Index cell) {
        for (Eigen::Index channel = 0; channel < 3; ++channel) {
          const double value = double{table.values()[3 * cell + channel]};
          if (!std::isfinite(value)) refuse({"cell ", cell, " of a table is not finite"});
          found.values(cell, channel) = value;
        }
        found.locations[cell] = own ? locate_cell(cells, cell) : locate(cells, table.cells().angles(cell));
      },
      threads);
  return found;
}

}  // namespace gonio
