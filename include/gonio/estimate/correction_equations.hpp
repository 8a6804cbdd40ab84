#pragma once
/// The least-squares problems of correction factors at measurements: Noell, Koehler and Stricker 2014, Eq. 7-10 with
/// Psi = C_i and the linear metric (Eq. 16). The same rows are used in every round, only weights and factors change.

#include <gonio/basis/basis.hpp>
#include <gonio/solve/gram.hpp>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

/// The rows of a channelwise basis at given locations. Rows at cells are read where they are; rows between cells are
/// interpolated once and kept.
template <channelwise_basis Corrections>
class correction_equations {
 public:
  correction_equations(const Corrections& corrections, const std::vector<location>& places, thread_count threads = {})
      : columns_(columns_of(corrections)),
        unknowns_(static_cast<Eigen::Index>(corrections.size())),
        channels_{corrections.channel(0), corrections.channel(1), corrections.channel(2)},
        rows_(3, std::vector<const float*>(places.size())),
        threads_(threads) {
    const auto between =
        std::ranges::count_if(places, [](const location& at) { return at.count > 1; });
    interpolated_.resize(3 * between, unknowns_);
    Eigen::Index next = 0;
    std::vector<Eigen::Index> slot(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) slot[i] = places[i].count > 1 ? std::exchange(next, next + 3) : 0;
    for_each_block(
        places.size(), 1024,
        [&](block range) {
          Eigen::RowVectorXd row(unknowns_);
          for (std::size_t i = range.begin; i < range.end; ++i)
            for (std::size_t c = 0; c < 3; ++c) {
              if (places[i].count == 1) {
                rows_[c][i] = channels_[c].row(places[i].cell[0]).data();
                continue;
              }
              auto own = interpolated_.row(slot[i] + static_cast<Eigen::Index>(c));
              read_row_at(channels_[c], places[i], row);
              own = row.template cast<float>();
              rows_[c][i] = own.data();
            }
        },
        threads_);
  }

  [[nodiscard]] std::size_t samples() const noexcept { return rows_[0].size(); }
  /// All functions of the basis, those that are left out included.
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return unknowns_; }
  /// The functions that take part.
  [[nodiscard]] const std::vector<Eigen::Index>& columns() const noexcept { return columns_; }

  /// Q = C'VC and m = C'V sigma of one channel. Rows of weight zero cost nothing. Products are float, summed over 128
  /// rows, and these sums are added in double: 2 n k^2 operations at most.
  template <class Weights, class Factors>
  [[nodiscard]] normal_equations normal(std::size_t channel, const Weights& weights, const Factors& factors) const {
    using sum_type = detail::product_sum<float>;
    const sum_type zero(unknowns_ + 1);
    const Eigen::MatrixXd all = sum_over_blocks(
                                    samples(), sum_type::block_rows, zero,
                                    [&](sum_type& sum, block range) {
                                      auto out = sum.rows(static_cast<Eigen::Index>(range.size()));
                                      Eigen::Index count = 0;
                                      for (std::size_t i = range.begin; i < range.end; ++i) {
                                        const auto at = static_cast<Eigen::Index>(i);
                                        const float weight = weights[at];
                                        if (!(weight > 0.0f)) continue;
                                        const float root = std::sqrt(weight);
                                        out.row(count).head(unknowns_) = root * row(channel, i);
                                        out(count++, unknowns_) = root * factors[at];
                                      }
                                      sum.add(count);
                                    },
                                    threads_)
                                    .symmetric();
    return {all.topLeftCorner(unknowns_, unknowns_), all.topRightCorner(unknowns_, 1), all.diagonal().tail(1)};
  }

  /// C beta at all samples of one channel.
  [[nodiscard]] Eigen::ArrayXf apply(std::size_t channel, const Eigen::VectorXd& beta) const {
    const Eigen::VectorXf weights = beta.cast<float>();
    Eigen::ArrayXf sigma(static_cast<Eigen::Index>(samples()));
    for_each_block(
        samples(), 4096,
        [&](block range) {
          for (std::size_t i = range.begin; i < range.end; ++i)
            sigma[static_cast<Eigen::Index>(i)] = row(channel, i).dot(weights);
        },
        threads_);
    return sigma;
  }

 private:
  [[nodiscard]] Eigen::Map<const Eigen::RowVectorXf> row(std::size_t channel, std::size_t sample) const noexcept {
    return {rows_[channel][sample], unknowns_};
  }

  using channel_type = decltype(std::declval<const Corrections&>().channel(0));
  std::vector<Eigen::Index> columns_;
  Eigen::Index unknowns_;
  std::array<channel_type, 3> channels_;  // keep the basis alive
  std::vector<std::vector<const float*>> rows_;
  cell_matrix interpolated_;
  thread_count threads_;
};

}  // namespace gonio
