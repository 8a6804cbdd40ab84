#include "../synthetic_materials.hpp"
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/evaluate/perceived_candidates.hpp>

#include <doctest/doctest.h>

#include <cmath>

static_assert(gonio::design::sweeping_objective<gonio::perceived_candidates>);

namespace {

/// Twelve materials of six families, two of each.
gonio::log_relative_pca prior_of_families() {
  auto materials = synthetic_materials(small_cells(), 12);
  for (std::size_t m = 0; m < materials.names.size(); ++m)
    materials.names[m] = "maker" + std::to_string(m / 2) + "_" + std::to_string(m);
  return learn(std::move(materials), 10);
}

/// Twelve materials of six families at four wavelengths, the first of which is invisible.
gonio::log_relative_pca prior_of_spectra() {
  auto spectra = at_wavelengths(synthetic_materials(small_cells(), 16), {300.0, 450.0, 550.0, 650.0});
  for (std::size_t m = 0; m < spectra.names.size(); ++m)
    spectra.names[m] = "maker" + std::to_string(m / 2) + "_" + std::to_string(m);
  return gonio::learn_streamed_pca(spectra, {.components = 10}).prior;
}

gonio::design::sequential_design<gonio::log_relative> cells_of(const gonio::log_relative_pca& prior) {
  gonio::design::apparatus with = gonio::design::usual_apparatus();
  with.constraint.smallest_separation = 0.0;
  return gonio::design::sequential_design(gonio::reconstruction{prior}, with, small_cells());
}

gonio::perceived_options options_of(double variance_share, Eigen::Index materials = 12) {
  return {.variance_share = variance_share, .most_materials = materials, .sphere_size = 4};
}

const std::vector<Eigen::Index> measured{20, 77, 150};

/// Returns mapped values of a prior's channels, minus its mean, converted to colours.
Eigen::MatrixXd in_colours(const gonio::design::sequential_design<gonio::log_relative>& cells,
                           const Eigen::MatrixXd& mapped) {
  const auto& prior = cells.estimator().prior();
  if (prior.wavelengths().empty()) return mapped;
  const gonio::spectral_colour colour(prior.wavelengths());
  Eigen::MatrixXd three(mapped.rows(), 3);
  for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
    const auto at = cells.locations()[i];
    std::vector<double> values;
    for (const double y : mapped.row(i)) values.push_back(prior.metric().inverse(y + cells.offsets()[i], at));
    const gonio::rgb seen = colour(values).max(0.0);
    for (Eigen::Index c = 0; c < 3; ++c) three(i, c) = prior.metric().forward(seen[c], at) - cells.offsets()[i];
  }
  return three;
}

/// Computes the value directly from the definition, with each material's family removed from the observations.
double naive_value(const gonio::log_relative_pca& prior, double variance_share, double power = 1.0) {
  const auto cells = cells_of(prior);
  const gonio::perceived_sensitivity perceived(small_cells(), 4);
  const Eigen::MatrixXd q = cells.rows().rows, all = prior.coefficients().cast<double>();
  const auto& model = cells.estimator().model();
  const Eigen::MatrixXd discrepancy =
      model.variance * gonio::discrepancy_covariance(cells.rows().angles, model.lengths);
  double sum = 0.0;
  for (Eigen::Index material = 0; material < 12; ++material) {
    const Eigen::Index left_out = 2 * prior.channels(),
                       first = left_out * (material / 2);  // observations of its family
    Eigen::MatrixXd others(all.rows() - left_out, all.cols());
    others << all.topRows(first), all.bottomRows(all.rows() - first - left_out);
    const Eigen::RowVectorXd mean = others.colwise().mean();
    others.rowwise() -= mean;
    const Eigen::MatrixXd covariance =
        q * (others.transpose() * others / static_cast<double>(others.rows())) * q.transpose() + discrepancy;
    const Eigen::MatrixXd own = in_colours(cells, q * prior.weights_of(material)),
                          off = own.colwise() - q * mean.transpose();
    const auto seen = perceived.at(prior.metric(), cells.locations(), own.colwise() + cells.offsets());
    Eigen::MatrixXd among(3, 3), with(off.rows(), 3), read(3, 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) among(i, j) = covariance(measured[i], measured[j]);
      among(i, i) += cells.error_variances()[measured[i]];
      with.col(i) = covariance.col(measured[i]);
      read.row(i) = off.row(measured[i]);
    }
    double seen_of_material = 0.0;
    const Eigen::MatrixXd inverse = among.inverse(), missed = off - with * inverse * read,
                          unknown = covariance - with * inverse * with.transpose();
    for (Eigen::Index point = 0; point < seen.weights.size(); ++point) {
      double square = 0.0;
      for (Eigen::Index c = 0; c < 3; ++c) {
        const Eigen::RowVectorXd slopes = seen.slopes.row(3 * point + c);
        square += (1.0 - variance_share) * std::pow(slopes.dot(missed.col(c)), 2) +
                  variance_share * slopes.dot(unknown * slopes.transpose());
      }
      seen_of_material += seen.weights[point] * std::sqrt(square);
    }
    sum += std::pow(seen_of_material, power);
  }
  return std::pow(sum / 12.0, 1.0 / power);
}

}  // namespace

TEST_CASE("what is seen of a design is the mean over materials, each reconstructed without its family") {
  const auto prior = prior_of_families();
  for (const double share : {0.0, 0.4, 1.0}) {
    CAPTURE(share);
    const gonio::perceived_candidates candidates(cells_of(prior), options_of(share));
    CHECK(candidates.materials() == 12);
    // The estimate leaves out a hundredth of the discrepancy's visible variance.
    CHECK(candidates(measured) == doctest::Approx(naive_value(prior, share)).epsilon(0.02));
  }
}

TEST_CASE("materials at wavelengths are seen in colours") {
  const auto prior = prior_of_spectra();
  REQUIRE(prior.channels() == 4);
  const gonio::perceived_candidates candidates(cells_of(prior), options_of(0.4));
  CHECK(candidates.materials() == 12);
  CHECK(candidates(measured) == doctest::Approx(naive_value(prior, 0.4)).epsilon(0.02));
}

TEST_CASE("a power mean over the materials is nearer to the worst") {
  const auto prior = prior_of_families();
  gonio::perceived_options options = options_of(0.4);
  const double mean = gonio::perceived_candidates(cells_of(prior), options)(measured);
  options.power = 8.0;
  const gonio::perceived_candidates candidates(cells_of(prior), options);
  CHECK(candidates(measured) == doctest::Approx(naive_value(prior, 0.4, 8.0)).epsilon(0.02));
  CHECK(candidates(measured) > 1.05 * mean);
  const std::vector<Eigen::Index> first(measured.begin(), measured.begin() + 2);
  CHECK(candidates.errors_with_each(first)[measured[2]] == doctest::Approx(candidates(measured)).epsilon(1e-3));
  options.power = 0.5;
  CHECK_THROWS_WITH_AS(gonio::perceived_candidates(cells_of(prior), options), doctest::Contains("at least 1, not 0.5"),
                       gonio::error);
}

TEST_CASE("a sweep tells what each candidate adds, in parts and on any number of threads") {
  const auto prior = prior_of_families();
  const gonio::perceived_candidates candidates(cells_of(prior), options_of(0.4)),
      alone(cells_of(prior), options_of(0.4), {1});
  const auto each = candidates.errors_with_each(measured);
  REQUIRE(std::ssize(each) == small_cells().size());
  CHECK(each == alone.errors_with_each(measured));
  Eigen::Index compared = 0;
  for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 13) {
    if (!candidates.geometry().allows(cell)) {
      CHECK(std::isinf(each[cell]));
      continue;
    }
    std::vector<Eigen::Index> more = measured;
    more.push_back(cell);
    if (std::ranges::find(measured, cell) == measured.end())
      CHECK(each[cell] == doctest::Approx(candidates(more)).epsilon(1e-3));
    ++compared;
  }
  CHECK(compared > 5);
  const gonio::block last{gonio::perceived_candidates::sweep_block, small_cells().size()};
  const auto part = candidates.errors_with_each(measured, last);
  CHECK(std::equal(part.begin(), part.end(), each.begin() + last.begin));
}

TEST_CASE("searches find directions that an apparatus can take, and more of them leave less to see") {
  const auto prior = prior_of_families();
  const gonio::perceived_candidates candidates(cells_of(prior), options_of(0.4, 6));
  CHECK(candidates.materials() == 6);
  const auto greedy = gonio::design::grow_greedily(candidates, 4);
  const auto better = gonio::design::exchange(candidates, greedy);
  CHECK(better.value <= greedy.value);
  CHECK(greedy.value < candidates(std::vector<Eigen::Index>{greedy.candidates.front()}));
  for (const Eigen::Index candidate : better.candidates) {
    const auto [wi, wo] = candidates.geometry().centre(candidate);
    CHECK(gonio::degrees(std::max(gonio::polar_angle(wi), gonio::polar_angle(wo))) <= 80.0);
  }
}

TEST_CASE("a prior of one family, and impossible options, are refused") {
  auto materials = synthetic_materials(small_cells(), 4);
  for (std::string& name : materials.names) name = "maker_" + name;
  const auto one = learn(std::move(materials), 3);
  CHECK_THROWS_WITH_AS(gonio::perceived_candidates(cells_of(one)),
                       doctest::Contains("a prior of at least two families"), gonio::error);
  const auto prior = prior_of_families();
  for (const gonio::perceived_options& wrong :
       {options_of(-0.1), options_of(1.1), options_of(0.5, 0), gonio::perceived_options{.sphere_size = 1}})
    CHECK_THROWS_AS(gonio::perceived_candidates(cells_of(prior), wrong), gonio::error);
}
