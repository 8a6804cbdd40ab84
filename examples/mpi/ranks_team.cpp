#include "ranks_team.hpp"

#include <gonio/mpi/best_of_ranks.hpp>
#include <gonio/mpi/gather_in_order.hpp>
#include <gonio/mpi/sum_of_groups.hpp>

#include <algorithm>

namespace cli {

gonio::thread_count ranks_team::threads(gonio::thread_count asked) const {
  if (asked.value != 0) return asked;
  return {std::max(1u, asked.resolve() / static_cast<unsigned>(ranks_.on_this_machine()))};
}

gonio::block ranks_team::share_of(Eigen::Index count, Eigen::Index block_size) const {
  const auto blocks = gonio::mpi::groups_of(ranks_.rank(), ranks_.size(), (count + block_size - 1) / block_size);
  return {std::min(count, blocks.begin * block_size), std::min(count, blocks.end * block_size)};
}

Eigen::Index ranks_team::best(double value, Eigen::Index number) const {
  return gonio::mpi::best_of_ranks(ranks_, {value, number}).number;
}

Eigen::Index ranks_team::number_of_writer(Eigen::Index number) const {
  return gonio::mpi::detail::number_of<Eigen::Index>(ranks_.broadcast(gonio::mpi::detail::bytes_of(number)));
}

void ranks_team::compute_in_order(gonio::block range, const std::function<part(Eigen::Index)>& compute,
                                  const std::function<void(Eigen::Index, part)>& take) const {
  gonio::mpi::gather_in_order(ranks_, range, compute, take);
}

}  // namespace cli
