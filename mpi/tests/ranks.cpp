/// Runs in each rank of a job with any number of ranks: messages, gathering, agreement, sums and comparisons.

#include <gonio/core/error.hpp>
#include <gonio/mpi.hpp>

#include <doctest/doctest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace mpi = gonio::mpi;

namespace {

const mpi::ranks& all() {
  static const mpi::ranks ranks;
  return ranks;
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Returns the message with which this rank refuses work; empty if it does not.
std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const gonio::error& error) {
    return error.what();
  }
  return "";
}

std::string last_rank() { return "rank " + std::to_string(all().size() - 1); }

}  // namespace

TEST_CASE("ranks: rank 0 broadcasts its bytes to all ranks, and gathers the bytes of all ranks") {
  const std::string own(static_cast<std::size_t>(1000 * all().rank()), 'a');
  const auto gathered = all().gather(bytes_of(own));
  REQUIRE(std::ssize(gathered) == (all().is_first() ? all().size() : 0));
  for (std::size_t rank = 0; rank < gathered.size(); ++rank) CHECK(gathered[rank].size() == 1000 * rank);
  for (const char* text : {"", "prior"})
    CHECK(all().broadcast(bytes_of(all().is_first() ? text : "?")) == bytes_of(text));
}

TEST_CASE("ranks: sent messages and bytes are counted") {
  const auto sent = [](const mpi::traffic& before) {
    const mpi::traffic now = all().sent();
    return mpi::traffic{now.messages - before.messages, now.bytes - before.bytes};
  };
  mpi::traffic before = all().sent();
  static_cast<void>(all().gather(bytes_of("seven b")));
  CHECK(sent(before).bytes == (all().is_first() ? 0 : 7));
  CHECK(sent(before).messages == (all().is_first() ? 0 : 1));
  before = all().sent();
  static_cast<void>(all().broadcast(bytes_of("nine byte")));
  const auto counts = all().gather(mpi::bytes_of(sent(before)));
  std::uint64_t messages = 0, bytes = 0;
  for (const auto& count : counts) {
    messages += mpi::number_of<mpi::traffic>(count).messages;
    bytes += mpi::number_of<mpi::traffic>(count).bytes;
  }
  if (!all().is_first()) return;
  CHECK(messages == static_cast<std::uint64_t>(all().size() - 1));
  CHECK(bytes == 9 * messages);
}

TEST_CASE("ranks: if one rank throws, all ranks throw, and the message names that rank") {
  const int last = all().size() - 1;
  CHECK_NOTHROW(all().together([] {}));
  const std::string who = last == 0 ? "" : last_rank() + ": ";
  CHECK(refusal_of([&] {
          all().together([&] {
            if (all().rank() == last) gonio::refuse("no file");
          });
        }) == who + "no file");
  CHECK(refusal_of([] { all().together([] { gonio::refuse("no option"); }); }) == "no option");
  CHECK_THROWS_WITH_AS(all().together([&] {
    if (all().rank() == last) throw std::bad_alloc();
  }),
                       (who + "there is not enough memory").c_str(), std::runtime_error);
  CHECK(all().failed_together());
  // Nested calls, as in commands.
  CHECK(refusal_of([&] {
          all().together([&] {
            all().together([&] {
              if (all().rank() == last) gonio::refuse("no table");
            });
          });
        }) == who + "no table");
}

TEST_CASE("ranks: if the ranks read different inputs, all refuse them with the same sentence") {
  CHECK_NOTHROW(all().agree_on(7, "prior"));
  const auto own = static_cast<std::uint32_t>(all().rank() == all().size() - 1 ? 1 : 0);
  const std::string expected =
      all().size() == 1 ? "" : "the ranks read different inputs: " + last_rank() + "'s prior differs from rank 0's";
  CHECK(refusal_of([&] { all().agree_on(own, "prior"); }) == expected);
}

TEST_CASE("ranks: parts are taken in order, each computed once") {
  for (const Eigen::Index count : {0, 1, 2, 3, 50}) {
    Eigen::Index next = 3, computed = 0;
    mpi::gather_in_order(
        all(), {3, 3 + count},
        [&](Eigen::Index i) {
          ++computed;
          return std::vector<std::byte>(static_cast<std::size_t>(i % 7), std::byte(i));
        },
        [&](Eigen::Index i, const std::vector<std::byte>& part) {
          CHECK(all().is_first());
          CHECK(i == next++);
          CHECK(part == std::vector<std::byte>(static_cast<std::size_t>(i % 7), std::byte(i)));
        });
    if (all().is_first()) CHECK(next == 3 + count);
    const auto sum = mpi::sum_of_groups(all(), all().size(), [&](Eigen::Index) {
      return Eigen::MatrixXd::Constant(1, 1, static_cast<double>(computed));
    });
    CHECK(sum(0, 0) == static_cast<double>(count));
  }
}

TEST_CASE("ranks: a part that fails, computed or taken, ends the gathering in all ranks") {
  const auto part = [](Eigen::Index) { return std::vector<std::byte>(100000); };
  const auto take = [](Eigen::Index, const std::vector<std::byte>&) {};
  for (const Eigen::Index bad : {0, 1, 2, 17}) {
    Eigen::Index taken = 0;
    const auto bad_part = [&](Eigen::Index i) {
      if (i == bad) gonio::refuse({"image 3: band ", i});
      return part(i);
    };
    const std::string refusal = refusal_of([&] {
      mpi::gather_in_order(all(), {0, 40}, bad_part, [&](Eigen::Index, const std::vector<std::byte>&) { ++taken; });
    });
    CHECK(refusal.find("image 3: band " + std::to_string(bad)) != std::string::npos);
    if (all().is_first()) CHECK(taken == bad);
    const std::string full = refusal_of([&] {
      mpi::gather_in_order(all(), {0, 40}, part, [&](Eigen::Index i, const std::vector<std::byte>&) {
        if (i == bad) gonio::refuse("the disk is full");
      });
    });
    CHECK(full.find("the disk is full") != std::string::npos);
  }
  CHECK_NOTHROW(mpi::gather_in_order(all(), {0, 5}, part, take));  // the failures leave nothing behind
}

TEST_CASE("ranks: a sum of groups has the same bytes for any number of ranks") {
  const auto partial = [](Eigen::Index group) {
    return Eigen::MatrixXd::NullaryExpr(5, 3,
                                        [&](Eigen::Index i, Eigen::Index j) {
                                          return std::sin(static_cast<double>(1 + group * 15 + i * 3 + j)) *
                                                 std::pow(10.0, group % 9);
                                        })
        .eval();
  };
  // The same tree in one process.
  const std::function<Eigen::MatrixXd(Eigen::Index, Eigen::Index)> sum = [&](Eigen::Index begin, Eigen::Index end) {
    if (end - begin == 1) return partial(begin);
    Eigen::Index half = 1;
    while (2 * half < end - begin) half *= 2;
    return Eigen::MatrixXd(sum(begin, begin + half) + sum(begin + half, end));
  };
  for (const Eigen::Index groups : {1, 2, 3, 16, 37, 64})
    CHECK(mpi::sum_of_groups(all(), groups, partial) == sum(0, groups));
  CHECK(!refusal_of([&] { static_cast<void>(mpi::sum_of_groups(all(), 0, partial)); }).empty());
  const auto failing = [&](Eigen::Index group) {
    if (group == 11) gonio::refuse("block 11: is truncated");
    return partial(group);
  };
  CHECK(refusal_of([&] { static_cast<void>(mpi::sum_of_groups(all(), 16, failing)); }).find("block 11") !=
        std::string::npos);
}

TEST_CASE("ranks: a sum takes a message from each rank but the first, and its result as many") {
  if (16 % all().size() != 0) return;
  const mpi::traffic before = all().sent();
  static_cast<void>(mpi::sum_of_groups(all(), 16, [](Eigen::Index) { return Eigen::MatrixXd::Ones(100, 100).eval(); }));
  const double own = static_cast<double>(all().sent().bytes - before.bytes);
  const auto bytes = mpi::sum_of_groups(all(), all().size(),
                                        [&](Eigen::Index) { return Eigen::MatrixXd::Constant(1, 1, own).eval(); });
  CHECK(bytes(0, 0) == 2.0 * (all().size() - 1) * 80008.0);
}

TEST_CASE("ranks: the best candidate of all ranks, of equal ones the lowest number") {
  const auto best = [](double value, Eigen::Index number) { return mpi::best_of_ranks(all(), {value, number}).number; };
  const int rank = all().rank(), last = all().size() - 1;
  CHECK(best(rank == last ? -1.0 : 1.0, rank) == last);
  CHECK(best(2.0, 100 - rank) == 100 - last);
  CHECK(best(2.0, 100 + rank) == 100);
}

TEST_CASE("ranks: groups are shared out in order") {
  for (const int ranks : {1, 2, 3, 5})
    for (const Eigen::Index groups : {1, 4, 16}) {
      Eigen::Index next = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        const gonio::block own = mpi::groups_of(rank, ranks, groups);
        CHECK(own.begin == next);
        next = own.end;
      }
      CHECK(next == groups);
    }
}
