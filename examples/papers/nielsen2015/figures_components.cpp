/// Nielsen et al. 2015, Tables 1 and 2, by the condition number of the first k components. The paper does not print k.

#include "papers/experiments.hpp"
#include "papers/nielsen2015/gradient_descent.hpp"
#include "papers/xu2016/figures.hpp"
#include <gonio/core/random.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/solve/householder_qr.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace papers::figures {

namespace {

/// Compares all pairs of images up to this number of components; more would take minutes.
constexpr Eigen::Index most_of_pairs = 100;

std::vector<Eigen::Index> swept(const options& given, const laboratory& lab) {
  auto numbers = given.swept_components({2, 3, 4, 5, 6, 7, 8, 10, 15, 20, 50, 100}, lab.prior().size());
  numbers.push_back(lab.prior().size());
  return numbers;
}

/// Returns R of a QR decomposition. The first k columns of R have the singular values of the first k columns of `rows`.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd rows) {
  const gonio::householder_qr decomposed(std::move(rows));
  const Eigen::Index n = std::min(decomposed.rows(), decomposed.cols());
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(n, decomposed.cols());
  for (Eigen::Index row = 0; row < n; ++row)
    for (Eigen::Index column = row; column < triangle.cols(); ++column)
      triangle(row, column) = decomposed.triangle(row, column);
  return triangle;
}

/// The condition number of images of a sphere with the first k components.
class sphere_conditions {
 public:
  sphere_conditions(const laboratory& lab, gonio::thread_count threads)
      : geometry_(lab.prior().cells()), triangles_(geometry_.size()), k_(lab.prior().size()) {
    gonio::for_each_index(
        geometry_.size(), 1,
        [&](Eigen::Index slice) {
          if (geometry_.allows(slice))
            triangles_[slice] =
                triangle_of(gonio::design::rows_at(lab.prior(), geometry_.directions(slice)).components);
        },
        threads);
  }

  void look_at(Eigen::Index k) noexcept { k_ = k; }
  [[nodiscard]] const gonio::design::sphere_geometry& geometry() const noexcept { return geometry_; }

  [[nodiscard]] double operator()(std::span<const Eigen::Index> slices) const {
    Eigen::Index n = 0;
    const auto height = [&](Eigen::Index slice) { return std::min(k_, triangles_[slice].rows()); };
    for (const Eigen::Index slice : slices) n += height(slice);
    Eigen::MatrixXd stacked(n, k_);
    n = 0;
    for (const Eigen::Index slice : slices) {
      stacked.middleRows(n, height(slice)) = triangles_[slice].topLeftCorner(height(slice), k_);
      n += height(slice);
    }
    return gonio::design::condition_number{}(stacked);
  }

 private:
  gonio::design::sphere_geometry geometry_;
  std::vector<Eigen::MatrixXd> triangles_;
  Eigen::Index k_;
};

using slices = std::vector<Eigen::Index>;

std::string printed(const gonio::design::sphere_geometry& geometry, slices chosen) {
  std::ranges::sort(chosen);
  std::string text;
  for (const Eigen::Index slice : chosen) {
    const auto [wi, wo] = geometry.centre(slice);
    const double theta_d = gonio::to_half_difference(wi, wo).theta_d;
    text += (text.empty() ? "" : ", ") + std::to_string(std::lround(gonio::degrees(theta_d)));
  }
  return text;
}

std::vector<double> values_of(const sphere_conditions& condition, const std::vector<slices>& sets,
                              gonio::thread_count threads) {
  std::vector<double> values(sets.size());
  gonio::for_each_index(
      std::ssize(sets), 16, [&](Eigen::Index i) { values[i] = condition(sets[i]); }, threads);
  return values;
}

/// Adds to a row the best of all sets of one size, and the rank of the published set.
void add_ranks(std::vector<json>& row, const sphere_conditions& condition, const std::vector<slices>& sets,
               const slices& published, gonio::thread_count threads) {
  const std::vector<double> values = values_of(condition, sets, threads);
  const auto best = std::ranges::min_element(values);
  const double reached = condition(published);
  row.emplace_back(printed(condition.geometry(), sets[best - values.begin()]));
  row.emplace_back(*best);
  row.emplace_back(reached);
  row.emplace_back(1 + std::ranges::count_if(values, [&](double value) { return value < reached; }));
}

/// Returns all sets of one slice, and all sets of two slices.
std::array<std::vector<slices>, 2> small_sets(const gonio::design::sphere_geometry& geometry) {
  std::array<std::vector<slices>, 2> sets;
  for (Eigen::Index a = 0; a < geometry.size(); ++a) {
    if (!geometry.allows(a)) continue;
    sets[0].push_back({a});
    for (Eigen::Index b = a + 1; b < geometry.size(); ++b)
      if (geometry.allows(b)) sets[1].push_back({a, b});
  }
  return sets;
}

/// Returns the best of several searches along the gradient.
gonio::design::capture_plan best_search(const sphere_conditions& condition, std::size_t n, const options& given) {
  std::vector<gonio::design::capture_plan> found(given.repetitions);
  gonio::for_each_index(
      given.repetitions, 1,
      [&](Eigen::Index r) { found[r] = grow_along_gradient(condition.geometry(), condition, n, given.seed + r); },
      given.threads);
  return std::ranges::min(found, {}, &gonio::design::capture_plan::value);
}

/// Returns the percentage of random sets of n directions with a condition number below `value`.
double percentage_below(const gonio::log_relative_pca& prior, std::size_t n, double value, const options& given) {
  constexpr Eigen::Index sets = 2000;
  std::vector<char> below(sets);
  gonio::for_each_index(
      sets, 16,
      [&](Eigen::Index i) {
        std::vector<gonio::half_difference> directions;
        for (const Eigen::Index cell : gonio::random_choice(prior.cells().size(), n, given.seed + i))
          directions.push_back(prior.cells().angles(cell));
        below[i] = gonio::design::condition_number{}(gonio::design::rows_at(prior, directions).components) < value;
      },
      given.threads);
  return 100.0 * static_cast<double>(std::ranges::count(below, 1)) / sets;
}

/// Returns the row for n points and the first k components: the published set, and the best of several searches.
std::vector<json> points_row(const laboratory& lab, const options& given, Eigen::Index k, std::size_t n) {
  const gonio::log_relative_pca prior = lab.prior().truncated(k);
  const gonio::design::point_geometry points(prior.cells());
  const gonio::design::criterion_of_plan condition{prior, points, gonio::design::condition_number{}};
  std::vector<gonio::design::capture_plan> found(given.repetitions);
  gonio::for_each_index(
      given.repetitions, 1,
      [&](Eigen::Index r) { found[r] = grow_along_gradient(points, condition, n, given.seed + r); }, given.threads);
  const auto best = std::ranges::min(found, {}, &gonio::design::capture_plan::value);
  const std::vector<gonio::half_difference> published = gonio::design::nielsen_directions(n);
  const double reached = gonio::design::condition_number{}(gonio::design::rows_at(prior, published).components);
  return {n,
          k,
          best.value,
          reached,
          percentage_below(prior, n, reached, given),
          lab.error(samples_of(points, best.candidates)),
          lab.error(published)};
}

}  // namespace

tables nielsen_table_1(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  table shown{"Table 1 by the condition number of the first k components; best of " +
                  std::to_string(given.repetitions) + " searches along the gradient",
              {{"n", 0},
               {"k", 0},
               {"best found", 2},
               {"published", 2},
               {"% of 2000 random sets below it", 1},
               {"mapped error of the best found"},
               {"of the published"}}};
  for (const std::size_t n : {2, 5, 10, 20})
    for (const Eigen::Index k : swept(given, lab)) {
      if (n > given.up_to(20)) continue;
      gonio::report(listener, "points, " + std::to_string(n),
                    static_cast<double>(k) / static_cast<double>(lab.prior().size()));
      shown.rows.push_back(points_row(lab, given, k, n));
    }
  return {std::move(shown)};
}

tables nielsen_table_2(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  sphere_conditions condition(lab, given.threads);
  const auto [singles, pairs] = small_sets(condition.geometry());
  const auto published = [&](Eigen::Index n) { return sphere_slices(condition.geometry(), "published", n); };
  table ranks{"Table 2 by the condition number of the first k components: all single images and all pairs (theta_d)",
              {{"k", 0},
               {"best image"},
               {"its condition", 2},
               {"of the published, 5", 2},
               {"its rank of " + std::to_string(singles.size()), 0},
               {"best two"},
               {"their condition", 2},
               {"of the published, 4 and 70", 2},
               {"their rank of " + std::to_string(pairs.size()), 0}}};
  table five{"Five images: the best of " + std::to_string(given.repetitions) + " searches along the gradient",
             {{"k", 0},
              {"found"},
              {"its condition", 2},
              {"of the published, 4 10 31 68 75", 2},
              {"mapped error"},
              {"of the published"}}};
  for (const Eigen::Index k : swept(given, lab)) {
    gonio::report(listener, "spheres", static_cast<double>(k) / static_cast<double>(lab.prior().size()));
    condition.look_at(k);
    auto& row = ranks.rows.emplace_back(std::vector<json>{k});
    add_ranks(row, condition, singles, published(1), given.threads);
    if (k <= most_of_pairs)
      add_ranks(row, condition, pairs, published(2), given.threads);
    else
      row.resize(ranks.columns.size());
    if (k > most_of_pairs) continue;
    const auto best = best_search(condition, 5, given);
    five.rows.push_back({k, printed(condition.geometry(), best.candidates), best.value, condition(published(5)),
                         lab.error(samples_of(condition.geometry(), best.candidates)),
                         lab.error(samples_of(condition.geometry(), published(5)))});
  }
  return {std::move(ranks), std::move(five)};
}

}  // namespace papers::figures
