/// Nielsen et al. 2015, Fig. 6: whether the search finds the best two directions, compared with all pairs of a coarse
/// grid.

#include "papers/experiments.hpp"
#include "papers/nielsen2015/gradient_descent.hpp"
#include "papers/xu2016/figures.hpp"
#include <gonio/core/random.hpp>
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/published_directions.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

namespace papers::figures {

namespace {

using angles = std::vector<gonio::half_difference>;

/// Two cells, and the value of a criterion for this pair.
struct cell_pair {
  std::array<Eigen::Index, 2> cells{};
  double value = std::numeric_limits<double>::infinity();
};

void sort(std::vector<cell_pair>& pairs) {
  std::ranges::sort(pairs, {}, [](const cell_pair& pair) { return std::tuple(pair.value, pair.cells); });
}

/// Returns the cells nearest to the cells of a coarse grid, with `step` degrees in theta_d and phi_d.
std::vector<Eigen::Index> coarse_cells(const gonio::valid_cells& cells, double step) {
  const auto along = [&](double all) { return std::max(1, static_cast<int>(std::lround(all / step))); };
  const gonio::valid_cells coarse(gonio::grid({along(90.0), along(90.0), along(180.0)}));
  std::vector<Eigen::Index> found;
  for (Eigen::Index cell = 0; cell < coarse.size(); ++cell)
    found.push_back(cells.representative(cells.grid().linear(cells.grid().nearest(coarse.angles(cell)))));
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

angles angles_of(const laboratory& lab, const std::array<Eigen::Index, 2>& cells) {
  return {lab.prior().cells().angles(cells[0]), lab.prior().cells().angles(cells[1])};
}

Eigen::MatrixXd components_at(const laboratory& lab, const std::vector<Eigen::Index>& cells) {
  Eigen::MatrixXd rows(std::ssize(cells), lab.prior().size());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = lab.prior().components().row(cells[i]).cast<double>();
  return rows;
}

/// Returns the condition number of two rows from their squared norms and scalar product.
double condition_of_pair(double first, double second, double product) {
  const double mean = 0.5 * (first + second), radius = std::hypot(0.5 * (first - second), product);
  return radius < mean ? std::sqrt((mean + radius) / (mean - radius)) : std::numeric_limits<double>::infinity();
}

/// Returns pairs of cells, the best first: the best pair of each cell, and all pairs with a value of at most `limit`.
/// `values(i)`, called from several threads, returns the values of the pairs of cell i and each later cell.
template <class Values>
std::vector<cell_pair> best_pairs(const std::vector<Eigen::Index>& cells, double limit, Values&& values,
                                  gonio::thread_count threads) {
  std::vector<std::vector<cell_pair>> kept(cells.size());
  gonio::for_each_index(
      std::ssize(cells) - 1, 16,
      [&](Eigen::Index i) {
        const Eigen::ArrayXd of_pairs = values(i);
        Eigen::Index best = 0;
        of_pairs.minCoeff(&best);
        for (Eigen::Index j = 0; j < of_pairs.size(); ++j)
          if (j == best || of_pairs[j] <= limit) kept[i].push_back({{cells[i], cells[i + 1 + j]}, of_pairs[j]});
      },
      threads);
  std::vector<cell_pair> all;
  for (const auto& some : kept) all.insert(all.end(), some.begin(), some.end());
  sort(all);
  return all;
}

/// The condition number up to which all pairs are kept.
constexpr double good_condition = 1.01;

/// Returns pairs ordered by the condition number of the first k components: the best pair of each cell, and all pairs
/// up to `good_condition`.
std::vector<cell_pair> pairs_by_condition(const laboratory& lab, const options& given, Eigen::Index k,
                                          const std::vector<Eigen::Index>& cells) {
  const Eigen::MatrixXd rows = components_at(lab, cells).leftCols(k);
  const Eigen::VectorXd squares = rows.rowwise().squaredNorm();
  return best_pairs(
      cells, good_condition,
      [&](Eigen::Index i) -> Eigen::ArrayXd {
        const Eigen::Index others = rows.rows() - 1 - i;
        Eigen::ArrayXd condition = rows.bottomRows(others) * rows.row(i).transpose();
        for (Eigen::Index j = 0; j < others; ++j)
          condition[j] = condition_of_pair(squares[i], squares[i + 1 + j], condition[j]);
        return condition;
      },
      given.threads);
}

std::vector<cell_pair> pairs_by_expected_error(const laboratory& lab, const options& given,
                                               const std::vector<Eigen::Index>& cells) {
  using sweep = gonio::design::extended_error<float>;
  const gonio::design::expected_error criterion = criterion_of(lab, given);
  const Eigen::MatrixXd rows = components_at(lab, cells);
  const gonio::design::expected_error::rows all = criterion.prepare(rows);
  const sweep::matrix materials = all.materials().cast<float>(), weighted = all.weighted().cast<float>();
  const sweep::column none = sweep::column::Zero(rows.rows());
  return best_pairs(
      cells, 0.0,
      [&](Eigen::Index i) -> Eigen::ArrayXd {
        const Eigen::Index others = rows.rows() - 1 - i;
        const sweep with_one(criterion, criterion.prepare(rows.row(i)));
        return with_one(materials.bottomRows(others), weighted.bottomRows(others), none.tail(others)).cast<double>();
      },
      given.threads);
}

/// Searches from successive seeds. Returns the pairs found, the best first. A pair's first direction has the smaller
/// theta_h.
template <gonio::design::design_criterion Criterion, class Search>
std::vector<cell_pair> searched(const gonio::log_relative_pca& prior, const options& given, const Criterion& criterion,
                                const Search& search) {
  const gonio::design::point_geometry points(prior.cells());
  const gonio::design::criterion_of_plan objective{prior, points, criterion};
  std::vector<cell_pair> found(given.repetitions);
  gonio::for_each_index(
      given.repetitions, 1,
      [&](Eigen::Index r) {
        const gonio::design::capture_plan plan = search(points, objective, given.seed + r);
        found[r] = {{plan.candidates[0], plan.candidates[1]}, plan.value};
        std::ranges::sort(found[r].cells);  // cells are in the order of theta_h
      },
      given.threads);
  sort(found);
  return found;
}

/// Returns a search that starts from the best of `tries` random candidates and moves to the best neighbour.
auto to_best_neighbour(Eigen::Index tries) {
  return [tries](const auto& points, const auto& objective, std::uint64_t seed) {
    return gonio::design::grow_and_descend(points, objective, 2, tries, seed);
  };
}

/// The search along the gradient, as printed in the paper.
constexpr auto along_gradient = [](const auto& points, const auto& objective, std::uint64_t seed) {
  return grow_along_gradient(points, objective, 2, seed);
};

std::string printed(const gonio::half_difference& at) {
  const auto rounded = [](double radians) { return std::to_string(std::lround(gonio::degrees(radians))); };
  return rounded(at.theta_h) + ' ' + rounded(at.theta_d) + ' ' + rounded(at.phi_d);
}

/// Returns the row of one pair: its name, both criteria, the mean error of the ten materials, and its two directions.
std::vector<json> row_of(const laboratory& lab, const options& given, const std::string& name, const angles& pair) {
  const Eigen::MatrixXd rows = gonio::design::rows_at(lab.prior(), pair).components;
  return {name,
          gonio::design::condition_number{}(rows),
          expected_of(lab, given, pair),
          lab.error(pair),
          printed(pair[0]),
          printed(pair[1])};
}

/// Compares the values that the searches reach with the best pair of the grid.
std::vector<json> reached(const std::string& name, const std::vector<cell_pair>& found, double best, double scale) {
  const auto within = [&](double factor) {
    return std::ranges::count_if(found, [&](const cell_pair& pair) { return pair.value <= factor * best; });
  };
  return {name,
          best / scale,
          found.front().value / scale,
          found[found.size() / 2].value / scale,
          found.back().value / scale,
          within(1.0),
          within(1.01)};
}

/// Adds the interquartile ranges of the directions where the searches end.
void add_ends(table& shown, const std::string& name, const laboratory& lab, const std::vector<cell_pair>& found) {
  for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
    std::vector<double> heights, differences;
    for (const cell_pair& pair : found) {
      const gonio::half_difference at = lab.prior().cells().angles(pair.cells[which]);
      heights.push_back(gonio::degrees(at.theta_h));
      differences.push_back(gonio::degrees(at.theta_d));
    }
    std::ranges::sort(heights);
    std::ranges::sort(differences);
    const std::size_t quarter = found.size() / 4, last = found.size() - 1 - quarter;
    shown.rows.push_back({name, which == 0 ? "first" : "second", heights[quarter], heights[last], differences[quarter],
                          differences[last]});
  }
}

/// Tabulates the reconstruction errors of pairs with nearly the best condition number.
table errors_by_condition(const laboratory& lab, const options& given, const std::vector<cell_pair>& pairs) {
  constexpr Eigen::Index judged = 200;
  table shown{"Pairs of the grid up to a condition number: the mapped errors of as many as 200 of them, at random",
              {{"condition at most", 4}, {"pairs", 0}, {"lowest"}, {"median"}, {"highest"}}};
  for (const double limit : {1.0001, 1.001, good_condition}) {
    const Eigen::Index count = std::ranges::count_if(pairs, [&](const cell_pair& p) { return p.value <= limit; });
    if (count == 0) continue;
    std::vector<double> errors;
    for (const Eigen::Index i : gonio::random_choice(count, judged, given.seed))
      errors.push_back(lab.error(angles_of(lab, pairs[i].cells)));
    std::ranges::sort(errors);
    shown.rows.push_back({limit, count, errors.front(), errors[errors.size() / 2], errors.back()});
  }
  return shown;
}

/// Tabulates for each k the best pair by the condition number of the first k components, and the rank of the published
/// pair (Table 1).
table pairs_by_components(const laboratory& lab, const options& given, const std::vector<Eigen::Index>& cells) {
  const std::string repeated = std::to_string(given.repetitions);
  table shown{"By condition number of the first k components: all pairs of the grid, and " + repeated +
                  " searches along the gradient",
              {{"k", 0},
               {"best of the grid", 5},
               {"first"},
               {"second"},
               {"searches: lowest", 5},
               {"median", 5},
               {"within 1 %", 0},
               {"published pair", 3},
               {"pairs up to 1.01", 0},
               {"mapped error of the best"}}};
  std::vector<Eigen::Index> swept = given.swept_components({2, 3, 4, 5, 10, 20}, lab.prior().size());
  swept.push_back(lab.prior().size());
  for (const Eigen::Index k : swept) {
    const gonio::log_relative_pca prior = lab.prior().truncated(k);
    const std::vector<cell_pair> pairs = pairs_by_condition(lab, given, k, cells);
    const auto found = searched(prior, given, gonio::design::condition_number{}, along_gradient);
    const angles best = angles_of(lab, pairs.front().cells);
    const auto below = [](const std::vector<cell_pair>& some, double limit) {
      return std::ranges::count_if(some, [&](const cell_pair& pair) { return pair.value <= limit; });
    };
    shown.rows.push_back({k, pairs.front().value, printed(best[0]), printed(best[1]), found.front().value,
                          found[found.size() / 2].value, below(found, 1.01 * pairs.front().value),
                          gonio::design::condition_number{}(
                              gonio::design::rows_at(prior, gonio::design::nielsen_directions(2)).components),
                          below(pairs, good_condition), lab.error(best)});
  }
  return shown;
}

}  // namespace

tables nielsen_6(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const std::vector<Eigen::Index> cells = coarse_cells(lab.prior().cells(), given.step);
  if (cells.size() < 2) gonio::refuse("--step leaves a single cell: figure 2015-6 needs at least two");
  gonio::report(listener, "all pairs", 0.2);
  const auto by_condition = pairs_by_condition(lab, given, lab.prior().size(), cells);
  const auto by_error = pairs_by_expected_error(lab, given, cells);
  gonio::report(listener, "searches", 0.6);
  const auto along = searched(lab.prior(), given, gonio::design::condition_number{}, along_gradient);
  const auto once = searched(lab.prior(), given, gonio::design::condition_number{}, to_best_neighbour(1));
  const auto guessed = searched(lab.prior(), given, gonio::design::condition_number{}, to_best_neighbour(500));
  const auto expected = searched(lab.prior(), given, criterion_of(lab, given), to_best_neighbour(500));

  const std::string all = "all " + std::to_string(cells.size() * (cells.size() - 1) / 2) + " pairs of the grid";
  const std::string times = "best of " + std::to_string(given.repetitions);
  table best{"The best two directions (theta_h, theta_d, phi_d in degrees)",
             {{"found by"}, {"condition", 5}, {"E", 4}, {"mapped error"}, {"first"}, {"second"}}};
  const auto add = [&](const std::string& name, const angles& pair) {
    best.rows.push_back(row_of(lab, given, name, pair));
  };
  add("condition: " + all, angles_of(lab, by_condition.front().cells));
  add("condition: " + times + " along the gradient", angles_of(lab, along.front().cells));
  add("condition: " + times + " to the best neighbour", angles_of(lab, once.front().cells));
  add("condition: " + times + " from the best of 500", angles_of(lab, guessed.front().cells));
  add("published (Table 1)", gonio::design::nielsen_directions(2));
  add("E: " + all, angles_of(lab, by_error.front().cells));
  add("E: " + times + " from the best of 500", angles_of(lab, expected.front().cells));

  const std::string repeated = std::to_string(given.repetitions);
  table shares{"What " + repeated + " searches reach, by their criterion",
               {{"search"},
                {"best of the grid", 5},
                {"lowest", 5},
                {"median", 5},
                {"highest", 5},
                {"as good as the grid's", 0},
                {"within 1 %", 0}},
               {reached("condition: along the gradient", along, by_condition.front().value, 1.0),
                reached("condition: to the best neighbour", once, by_condition.front().value, 1.0),
                reached("condition: from the best of 500", guessed, by_condition.front().value, 1.0),
                reached("E: from the best of 500", expected, by_error.front().value, 1.0 / lab.expected(1.0))}};
  table ends{"Where they end: the middle half of " + repeated + ", in degrees",
             {{"search"}, {"direction"}, {"theta_h from", 1}, {"to", 1}, {"theta_d from", 1}, {"to", 1}}};
  add_ends(ends, "condition: along the gradient", lab, along);
  add_ends(ends, "condition: to the best neighbour", lab, once);
  add_ends(ends, "condition: from the best of 500", lab, guessed);
  add_ends(ends, "E: from the best of 500", lab, expected);
  return {std::move(best), std::move(shares), std::move(ends), errors_by_condition(lab, given, by_condition),
          pairs_by_components(lab, given, cells)};
}

}  // namespace papers::figures
