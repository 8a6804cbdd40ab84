#pragma once
/// Bodies of basis/learn_streamed_pca.hpp.

#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/row_groups.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

namespace gonio::detail {

/// Returns how many threads to use: together, they need at most a quarter of the permitted memory.
[[nodiscard]] GONIO_INLINE thread_count threads_within(const streaming_options& options, double bytes_each) {
  const double room = 0.25 * static_cast<double>(options.memory) / bytes_each;
  const unsigned threads = options.threads.resolve();
  return {room < threads ? std::max(1u, static_cast<unsigned>(room)) : threads};
}

/// Returns the same rows. Reading them also reports the progress.
[[nodiscard]] GONIO_INLINE row_source counted(const row_source& rows, const std::string& stage,
                                              const progress& listener) {
  if (!listener) return rows;
  struct count {
    std::mutex mutex;
    Eigen::Index read = 0;
  };
  return {rows.rows, rows.columns,
          [rows, stage, listener, all = std::make_shared<count>()](block range, row_block out) {
            rows.read(range, out);
            const std::scoped_lock lock(all->mutex);
            all->read += range.size();
            report(listener, stage, static_cast<double>(all->read) / static_cast<double>(rows.rows));
          }};
}

/// Finds the components through the Gram matrix.
[[nodiscard]] GONIO_INLINE streamed_components exact_components(const row_source& first, const row_source& again,
                                                                const streaming_options& options,
                                                                const progress& listener) {
  const auto columns = static_cast<double>(first.columns);
  const thread_count threads = threads_within(options, 16.0 * columns * (columns + 128.0));
  const Eigen::MatrixXd products =
      options.share.sum_over_all([&](block groups) { return gram(counted(first, "gram", listener), groups, threads); });
  report(listener, "eigenvalues", 0.0);
  // Centred observations have one component fewer than columns. Rounding of the mean may seem to add the missing one.
  const Eigen::Index most = std::min(options.components, first.columns - 1);
  streamed_components found{decompose_leading(products, most, "the Gram matrix of the materials"), {}, true};
  if (found.pairs.values.size() == 0) return found;
  found.scaled.resize(first.rows, found.pairs.values.size());
  for_each_product(counted(again, "components", listener), found.pairs.vectors, options.share.own, threads,
                   [&](block range, const Eigen::MatrixXd& product) {
                     found.scaled.middleRows(range.begin, range.size()) = product.cast<float>();
                   });
  return found;
}

/// Finds the components in a random subspace.
[[nodiscard]] GONIO_INLINE streamed_components subspace_components(const row_source& first, const row_source& again,
                                                                   const streaming_options& options,
                                                                   const progress& listener) {
  const Eigen::Index most = std::min(options.components, first.columns - 1);
  const Eigen::Index width = std::min(first.columns, most + options.subspace.oversampling);
  const double bytes_each = 8.0 * static_cast<double>(first.columns) * static_cast<double>(2 * width + 3 * 128);
  const thread_count threads = threads_within(options, bytes_each);
  cell_matrix along(first.rows, width);  // A times the subspace
  const auto keep = [&](block range, const Eigen::MatrixXd& product) {
    along.middleRows(range.begin, range.size()) = product.cast<float>();
  };
  int done = 0;
  const auto times = [&](const Eigen::MatrixXd& vectors, bool last) {
    const row_source& rows = done++ == 0 ? first : again;
    const std::string stage = message_of({"subspace ", done, " of ", options.subspace.products});
    return options.share.sum_over_all([&](block groups) {
      return gram_times(counted(rows, stage, listener), vectors, groups, threads,
                        last ? product_writer(keep) : product_writer());
    });
  };
  subspace_eigenpairs pairs = iterate_leading(first.columns, most, options.subspace, times);
  report(listener, "components", 0.0);
  streamed_components found{std::move(pairs.pairs), cell_matrix(first.rows, pairs.combination.cols()), false};
  const block own = rows_of_groups(first.rows, options.share.own);
  for_each_block(
      first.rows, 1024,
      [&](block range) {
        const Eigen::Index begin = range.begin, rows = range.size();
        if (range.end <= own.begin || begin >= own.end) return;
        found.scaled.middleRows(begin, rows) =
            product(along.middleRows(begin, rows).cast<double>(), pairs.combination).cast<float>();
      },
      options.threads);
  return found;
}

GONIO_INLINE void complete_rows(const shared_groups& share, const mapped_materials& mapped) {
  for (const std::span<float> found : {mapped.reference(), mapped.mean(), mapped.variation()})
    share.complete_rows(found, std::ssize(found));
}

GONIO_INLINE streamed_components components_of(const row_source& first, const row_source& again,
                                               const streaming_options& options, const progress& listener) {
  if (options.components < 1) refuse("at least one principal component must be kept");
  streamed_components found = first.columns <= options.exact_columns
                                  ? exact_components(first, again, options, listener)
                                  : subspace_components(first, again, options, listener);
  if (found.pairs.values.size() == 0) refuse("the materials do not differ: there is nothing to learn");
  options.share.complete_rows({found.scaled.data(), static_cast<std::size_t>(found.scaled.size())}, first.rows);
  report(listener, "components", 1.0);
  return found;
}

/// Learns from mapped materials that have not been read.
[[nodiscard]] GONIO_INLINE streamed_pca learn_mapped(const mapped_materials& mapped, const streaming_options& options,
                                                     const progress& listener) {
  streamed_components found = components_of(mapped.first_pass(), mapped.rows(), options, listener);
  complete_rows(options.share, mapped);
  const double variance = mapped.total_variation();
  const auto& [values, vectors, residual] = found.pairs;
  return {log_relative_pca({mapped.materials().cells,
                            mapped.metric(),
                            mapped.materials().names,
                            values.cwiseSqrt(),
                            std::move(found.scaled),
                            {mapped.mean().begin(), mapped.mean().end()},
                            vectors.cast<float>(),
                            values.sum() / variance,
                            {},
                            mapped.materials().wavelengths}),
          found.exact, residual / variance};
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE streamed_pca learn_streamed_pca(material_rows materials, const streaming_options& options,
                                             const progress& listener) {
  return detail::learn_mapped(mapped_materials(std::move(materials), options.weighting), options, listener);
}

GONIO_INLINE streamed_pca learn_streamed_pca(material_rows materials, const log_relative& reference,
                                             const streaming_options& options, const progress& listener) {
  return detail::learn_mapped(mapped_materials(std::move(materials), reference), options, listener);
}

}  // namespace gonio
