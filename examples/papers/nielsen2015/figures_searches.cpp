/// Nielsen et al. 2015, Fig. 5: their search along the gradient, our search to the best neighbour and the search of Xu
/// et al. 2016, each compared with random swaps in the same time.

#include "papers/experiments.hpp"
#include "papers/nielsen2015/gradient_descent.hpp"
#include "papers/xu2016/figures.hpp"
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/criterion_of_plan.hpp>

#include <algorithm>
#include <chrono>

namespace papers::figures {

namespace {

/// Exchanging more points than this over all cells would take minutes.
constexpr Eigen::Index most_exchanged_points = 10;

struct timed_plan {
  gonio::design::capture_plan plan;
  double seconds = 0.0;
};

template <class Search>
timed_plan timed(Search&& search) {
  const auto start = std::chrono::steady_clock::now();
  gonio::design::capture_plan plan = search();
  return {std::move(plan), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

/// Swaps at random for about `seconds`. Each run's time determines the number of swaps of the next run.
template <class Objective>
timed_plan swaps_within(double seconds, const Objective& objective, std::size_t n, std::uint64_t seed) {
  Eigen::Index count = 300;
  timed_plan run;
  for (int round = 0; round < 3; ++round) {
    run = timed([&] { return gonio::design::swap_at_random(objective.geometry(), objective, n, count, seed); });
    const double share = seconds / std::max(run.seconds, 1e-6);
    count = std::max<std::size_t>(1, std::llround(share * static_cast<double>(count)));
  }
  return run;
}

/// The results of a search, one per seed.
struct record {
  std::string search;
  std::vector<timed_plan> found = {};
};

/// Adds a row: the best result, the mean, and the time.
template <class Objective>
void add_row(table& shown, std::size_t n, const record& searched, const Objective& objective, const laboratory& lab,
             double scale) {
  double sum = 0.0, seconds = 0.0;
  const auto times = static_cast<double>(searched.found.size());
  for (const timed_plan& run : searched.found) {
    sum += run.plan.value / times;
    seconds += run.seconds / times;
  }
  const auto best = std::ranges::min_element(searched.found, {}, [](const auto& run) { return run.plan.value; });
  shown.rows.push_back({n, searched.search, searched.found.size(), seconds, sum / scale, best->plan.value / scale,
                        lab.error(samples_of(objective.geometry(), best->plan.candidates))});
}

template <class Search>
record timed_record(const char* name, const options& given, const Search& search) {
  record timings{name};
  for (Eigen::Index r = 0; r < given.repetitions; ++r)
    timings.found.push_back(timed([&] { return search(given.seed + r); }));
  return timings;
}

/// Runs a search from several seeds. Then runs random swaps for the same time, and for five times that time.
template <class Objective, class Search>
std::vector<record> race(const std::string& name, const Objective& objective, std::size_t n, const options& given,
                         Search&& search) {
  std::vector<record> records{{name}, {"random swaps, the same time"}, {"random swaps, five times the time"}};
  for (Eigen::Index r = 0; r < given.repetitions; ++r) {
    const std::uint64_t seed = given.seed + r;
    records[0].found.push_back(timed([&] { return search(seed); }));
    const double seconds = records[0].found.back().seconds;
    records[1].found.push_back(swaps_within(seconds, objective, n, seed));
    records[2].found.push_back(swaps_within(5.0 * seconds, objective, n, seed));
  }
  return records;
}

std::vector<Eigen::Index> race_counts(const options& given) {
  std::vector<Eigen::Index> counts{2, 5, 10, 15, 20};
  std::erase_if(counts, [&](std::size_t n) { return n > given.up_to(20); });
  if (counts.empty()) gonio::refuse("--most needs at least 2: searches are compared from two measurements on");
  return counts;
}

/// Compares searches that use the first k components. The errors are for reconstructions with all components.
table race_by_condition(const laboratory& lab, const options& given, Eigen::Index k, const gonio::progress& listener) {
  table shown{"By condition number of the first " + std::to_string(k) +
                  " components (the figure's): reached from "
                  "several seeds",
              {{"n", 0},
               {"search"},
               {"seeds", 0},
               {"seconds", 2},
               {"condition, mean", 2},
               {"condition, best", 2},
               {"mapped error of the best"}}};
  const gonio::design::point_geometry points(lab.prior().cells());
  const gonio::design::criterion_of_plan condition{lab.prior().truncated(k), points, gonio::design::condition_number{}};
  for (const Eigen::Index n : race_counts(given)) {
    gonio::report(listener, "searches of " + std::to_string(n), 0.0);
    auto records = race("along the gradient (Nielsen et al.)", condition, n, given,
                        [&](std::uint64_t seed) { return grow_along_gradient(points, condition, n, seed); });
    records.push_back(timed_record("along the gradient, steps of 1", given, [&](std::uint64_t seed) {
      return grow_along_gradient(points, condition, n, seed, {1});
    }));
    records.push_back(timed_record("along the gradient, steps of 9, 3, 1", given, [&](std::uint64_t seed) {
      return grow_along_gradient(points, condition, n, seed, {9, 3, 1});
    }));
    for (const Eigen::Index tries : {1, 500})
      records.push_back(timed_record(
          tries == 1 ? "to the best neighbour (ours)" : "to the best neighbour from the best of 500", given,
          [&](std::uint64_t seed) { return gonio::design::grow_and_descend(points, condition, n, tries, seed); }));
    for (const record& searched : records) add_row(shown, n, searched, condition, lab, 1.0);
  }
  return shown;
}

table race_by_expected_error(const laboratory& lab, const options& given, const gonio::progress& listener) {
  table shown{"By expected error",
              {{"n", 0},
               {"search"},
               {"seeds", 0},
               {"seconds", 2},
               {"E, mean", 4},
               {"E, best", 4},
               {"mapped error of the best"}}};
  const gonio::design::cell_candidates candidates(lab.prior(), criterion_of(lab, given), {}, given.threads);
  const double scale = std::sqrt(static_cast<double>(lab.prior().cells().size()));
  for (const Eigen::Index n : race_counts(given)) {
    gonio::report(listener, "searches of " + std::to_string(n), 0.5);
    auto records = race("to the best neighbour from the best of 500", candidates, n, given, [&](std::uint64_t seed) {
      return gonio::design::grow_and_descend(candidates.geometry(), candidates, n, 500, seed);
    });
    records.push_back({"greedy over all cells", {timed([&] { return gonio::design::grow_greedily(candidates, n); })}});
    const auto [greedy, seconds] = records.back().found.front();
    if (n <= most_exchanged_points) {
      timed_plan exchanged = timed([&] { return gonio::design::exchange(candidates, greedy); });
      exchanged.seconds += seconds;
      records.push_back({"greedy and exchange over all cells", {std::move(exchanged)}});
    }
    for (const record& searched : records) add_row(shown, n, searched, candidates, lab, scale);
  }
  return shown;
}

}  // namespace

tables nielsen_5(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  tables shown;
  for (const Eigen::Index k : given.swept_components({5, 10, 20}, lab.prior().size()))
    shown.push_back(race_by_condition(lab, given, k, listener));
  shown.push_back(race_by_condition(lab, given, lab.prior().size(), listener));
  shown.push_back(race_by_expected_error(lab, given, listener));
  return shown;
}

}  // namespace papers::figures
