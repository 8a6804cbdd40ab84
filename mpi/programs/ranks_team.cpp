#include "ranks_team.hpp"

#include <gonio/core/error.hpp>
#include <gonio/mpi/best_of_ranks.hpp>
#include <gonio/mpi/gather_in_order.hpp>
#include <gonio/mpi/sum_of_groups.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

namespace cli {

namespace {

void copy_numbers(std::span<const std::byte> bytes, std::span<float> to) {
  if (bytes.size() != to.size_bytes())
    gonio::refuse({"a rank sent ", bytes.size(), " bytes, expected ", to.size_bytes()});
  if (!bytes.empty()) std::memcpy(to.data(), bytes.data(), bytes.size());
}

}  // namespace

gonio::thread_count ranks_team::threads(gonio::thread_count asked) const {
  if (asked.value != 0) return asked;
  return {std::max(1u, asked.resolve() / static_cast<unsigned>(ranks_.on_this_machine()))};
}

void ranks_team::together(const std::function<void()>& work) const {
  ranks_.together([&] {
    work();
    ranks_.wait();  // until the posted messages are received
  });
}

gonio::block ranks_team::share_of(Eigen::Index count, Eigen::Index block_size) const {
  const auto blocks = gonio::mpi::groups_of(ranks_.rank(), ranks_.size(), (count + block_size - 1) / block_size);
  return {std::min(count, blocks.begin * block_size), std::min(count, blocks.end * block_size)};
}

Eigen::Index ranks_team::best(double value, Eigen::Index number) const {
  return gonio::mpi::best_of_ranks(ranks_, {value, number}).number;
}

Eigen::Index ranks_team::subtrees() const {
  return std::min(gonio::row_groups, static_cast<Eigen::Index>(std::bit_floor(static_cast<unsigned>(ranks_.size()))));
}

gonio::block ranks_team::groups_of(int rank) const {
  const gonio::block own = gonio::mpi::groups_of(rank, ranks_.size(), subtrees());
  const Eigen::Index each = gonio::row_groups / subtrees();
  return {own.begin * each, own.end * each};
}

std::span<float> ranks_team::part_of(int rank, std::span<float> numbers, Eigen::Index rows) const {
  const gonio::block own = gonio::rows_of_groups(rows, groups_of(rank));
  const std::size_t each = numbers.size() / static_cast<std::size_t>(rows);
  return numbers.subspan(each * static_cast<std::size_t>(own.begin), each * static_cast<std::size_t>(own.size()));
}

std::vector<std::vector<float>> ranks_team::exchange_rows(std::vector<float> own, Eigen::Index rows) const {
  for (int other = 0; other < ranks_.size(); ++other) {
    if (other == ranks_.rank()) continue;
    const auto bytes = std::as_bytes(part_of(other, own, rows));
    ranks_.post(other, {bytes.begin(), bytes.end()});
  }
  std::vector<std::vector<float>> all(size(), std::vector<float>(own.size()));
  for (int other = 0; other < ranks_.size(); ++other)
    if (other != ranks_.rank())
      copy_numbers(ranks_.receive(other), part_of(ranks_.rank(), all[static_cast<std::size_t>(other)], rows));
  ranks_.wait();
  all[number()] = std::move(own);
  return all;
}

gonio::shared_groups ranks_team::groups() const {
  const auto sum = [this](const gonio::shared_groups::sum_of& of_groups) {
    return gonio::mpi::sum_of_groups(ranks_, subtrees(),
                                     [&](Eigen::Index) { return of_groups(groups_of(ranks_.rank())); });
  };
  const auto complete = [this](std::span<float> numbers, Eigen::Index rows) {
    gonio::mpi::gather_in_order(
        ranks_, {0, ranks_.size()},
        [&](Eigen::Index rank) {
          const auto bytes = std::as_bytes(part_of(static_cast<int>(rank), numbers, rows));
          return part(bytes.begin(), bytes.end());
        },
        [&](Eigen::Index rank, const part& bytes) {
          copy_numbers(bytes, part_of(static_cast<int>(rank), numbers, rows));
        });
  };
  return {groups_of(ranks_.rank()), sum, complete};
}

Eigen::Index ranks_team::number_of_writer(Eigen::Index number) const {
  return gonio::mpi::number_of<Eigen::Index>(ranks_.broadcast(gonio::mpi::bytes_of(number)));
}

std::optional<team::part> ranks_team::compute_in_turn(std::size_t turn, const std::function<part()>& compute) const {
  const auto whose = static_cast<int>(turn % size());
  if (whose != ranks_.rank()) {
    if (!writes()) return std::nullopt;
    return ranks_.receive(whose);
  }
  part computed = compute();
  if (!writes()) ranks_.post(0, computed);
  return computed;
}

void ranks_team::compute_in_order(gonio::block range, const std::function<part(Eigen::Index)>& compute,
                                  const std::function<void(Eigen::Index, part)>& take) const {
  gonio::mpi::gather_in_order(ranks_, range, compute, take);
}

}  // namespace cli
