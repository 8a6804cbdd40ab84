/// The record of the sweeps of an interrupted search.

#include "tool/files/sweep_record.hpp"

#include "../io/scratch.hpp"

#include <doctest/doctest.h>

#include <vector>

using cli::sweep_record;

namespace {

/// The result of a search among 100 candidates whose n-th sweep finds 10 n, and the number of sweeps that it ran
/// itself.
struct searched {
  std::vector<Eigen::Index> best;
  int sweeps = 0;
  std::size_t earlier = 0;
};

searched search(const scratch::fs::path& output, int count, std::uint32_t checksum = 1) {
  sweep_record record(output, checksum, cli::alone());
  searched found;
  found.earlier = record.earlier();
  for (int n = 0; n < count; ++n)
    found.best.push_back(record.next(
        [&] {
          ++found.sweeps;
          return Eigen::Index{10 * n};
        },
        100));
  return found;
}

}  // namespace

TEST_CASE("a search goes on behind the sweeps of an earlier one") {
  const scratch::folder folder;
  const auto output = folder / "six.csv", part = folder / "six.csv.part";
  CHECK(search(output, 0).earlier == 0);
  CHECK(folder.entries() == 0);  // nothing was found
  CHECK(search(output, 3).sweeps == 3);
  const searched again = search(output, 5);
  CHECK(again.earlier == 3);
  CHECK(again.sweeps == 2);
  CHECK(again.best == std::vector<Eigen::Index>{0, 10, 20, 30, 40});
  // An incomplete line is not counted as a sweep.
  const std::string whole = scratch::get(part);
  scratch::put(part, whole.substr(0, whole.size() - 2));
  CHECK(search(output, 4).earlier == 4);
  // A file that is not a record is started again.
  scratch::put(part, whole + "-4\n");
  CHECK(search(output, 2).sweeps == 2);
  CHECK(search(output, 2).earlier == 2);
  // A candidate that the search does not have.
  scratch::put(part, scratch::get(part) + "100\n");
  CHECK_THROWS_WITH_AS(search(output, 3), doctest::Contains("six.csv.part: names candidate 100, but the last"),
                       gonio::error);
}

TEST_CASE("sweeps of another search are refused, and those of a finished one removed") {
  const scratch::folder folder;
  const auto output = folder / "six.csv";
  static_cast<void>(search(output, 3));
  CHECK_THROWS_WITH_AS(search(output, 3, 2), doctest::Contains("six.csv.part"), gonio::error);
  sweep_record record(output, 1, cli::alone());
  record.remove();
  CHECK(folder.entries() == 0);
  CHECK(search(output, 1, 2).earlier == 0);
}

TEST_CASE("an output that is no file has no record") {
  static_cast<void>(search("/dev/null", 3));
  CHECK(search("/dev/null", 3).sweeps == 3);
  CHECK_FALSE(scratch::fs::exists("/dev/null.part"));
  CHECK_THROWS_WITH_AS(search("/no/such/folder/six.csv", 1), doctest::Contains("/no/such/folder"), gonio::error);
}
