#pragma once
/// The ranks of an MPI job as the processes of a command.

#include "tool/options/team.hpp"
#include <gonio/mpi/ranks.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cli {

class ranks_team : public team {
 public:
  /// `ranks` must outlive this object.
  explicit ranks_team(const gonio::mpi::ranks& ranks) : ranks_(ranks) {}

  [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(ranks_.size()); }
  [[nodiscard]] std::size_t number() const override { return static_cast<std::size_t>(ranks_.rank()); }
  [[nodiscard]] bool writes() const override { return ranks_.is_first(); }
  [[nodiscard]] gonio::thread_count threads(gonio::thread_count asked) const override;
  void together(const std::function<void()>& work) const override;
  void agree_on(std::uint32_t checksum, const std::string& what) const override { ranks_.agree_on(checksum, what); }
  [[nodiscard]] gonio::block share_of(Eigen::Index count, Eigen::Index block_size) const override;
  [[nodiscard]] Eigen::Index best(double value, Eigen::Index number) const override;
  [[nodiscard]] gonio::shared_groups groups() const override;
  [[nodiscard]] std::vector<std::vector<float>> exchange_rows(std::vector<float> own, Eigen::Index rows) const override;
  [[nodiscard]] Eigen::Index number_of_writer(Eigen::Index number) const override;
  [[nodiscard]] std::string text_of_writer(std::string text) const override {
    return text_of(ranks_.broadcast(bytes_of(text)));
  }
  [[nodiscard]] std::optional<part> compute_in_turn(std::size_t turn,
                                                    const std::function<part()>& compute) const override;
  void compute_in_order(gonio::block range, const std::function<part(Eigen::Index)>& compute,
                        const std::function<void(Eigen::Index, part)>& take) const override;

 private:
  /// Returns the number of equal subtrees of the groups, a power of two: as many ranks as possible own one each.
  [[nodiscard]] Eigen::Index subtrees() const;
  [[nodiscard]] gonio::block groups_of(int rank) const;
  /// Returns the part of `numbers` that belongs to the rows of a rank's groups. Each row has the same count of numbers.
  [[nodiscard]] std::span<float> part_of(int rank, std::span<float> numbers, Eigen::Index rows) const;

  const gonio::mpi::ranks& ranks_;
};

}  // namespace cli
