#include "../synthetic_materials.hpp"
#include <gonio/basis/learn_streamed_pca.hpp>

#include <doctest/doctest.h>

namespace {

/// Returns the largest relative difference between two priors' components, means and references.
double difference(const gonio::log_relative_pca& a, const gonio::log_relative_pca& b) {
  REQUIRE(a.size() == b.size());
  REQUIRE(a.names() == b.names());
  const auto of_spans = [](std::span<const float> x, std::span<const float> y) {
    const Eigen::Map<const Eigen::VectorXf> left(x.data(), std::ssize(x)), right(y.data(), std::ssize(y));
    return double{(left - right).cwiseAbs().maxCoeff() / right.cwiseAbs().maxCoeff()};
  };
  const double components =
      (a.components() - b.components()).cwiseAbs().maxCoeff() / b.components().cwiseAbs().maxCoeff();
  return std::max({components, of_spans(a.mean(), b.mean()), of_spans(a.metric().reference(), b.metric().reference())});
}

gonio::streamed_pca learn_streamed(gonio::material_set set, Eigen::Index components, gonio::thread_count threads = {},
                                   Eigen::Index exact_columns = 1024) {
  return gonio::learn_streamed_pca(gonio::rows_of(std::move(set)),
                                   {.components = components, .exact_columns = exact_columns, .threads = threads});
}

}  // namespace

TEST_CASE("streamed components are those of tables in memory") {
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 12, 18})), 20);
  const auto streamed = learn_streamed(set, 10);
  const auto known = learn(set, 10);
  CHECK(streamed.exact);
  CHECK(streamed.residual == 0.0);
  CHECK(difference(streamed.prior, known) < 1e-5);
  CHECK((streamed.prior.coefficients() - known.coefficients()).cwiseAbs().maxCoeff() < 1e-5);
  CHECK(streamed.prior.singular_values().isApprox(known.singular_values(), 1e-9));
  CHECK(streamed.prior.explained_variance() == doctest::Approx(known.explained_variance()).epsilon(1e-6));
}

TEST_CASE("wavelengths are columns as colours are: how many belong to a material changes nothing in the components") {
  const auto set = synthetic_materials(small_cells(), 12);
  const auto colours = gonio::learn_streamed_pca(gonio::rows_of(set), {.components = 8}).prior;
  CHECK(colours.channels() == 3);
  CHECK(colours.wavelengths().empty());
  for (const std::vector<double>& wavelengths :
       {std::vector<double>{633.0}, {450.0, 550.0, 650.0}, {400.0, 500.0, 600.0, 700.0}}) {
    const auto spectra = gonio::learn_streamed_pca(at_wavelengths(set, wavelengths), {.components = 8}).prior;
    CHECK(spectra.wavelengths() == wavelengths);
    CHECK(spectra.channels() == std::ssize(wavelengths));
    CHECK(std::ssize(spectra.names()) == 36 / std::ssize(wavelengths));
    CHECK(spectra.components() == colours.components());
    CHECK(spectra.coefficients() == colours.coefficients());
    CHECK(spectra.singular_values() == colours.singular_values());
    CHECK(spectra.weights_of(2) ==
          spectra.coefficients().middleRows(2 * spectra.channels(), spectra.channels()).transpose().cast<double>());
    CHECK(spectra.truncated(3).wavelengths() == wavelengths);
    CHECK(spectra.with_source("here").wavelengths() == wavelengths);
    CHECK(gonio::thin(spectra, gonio::valid_cells(gonio::grid({5, 5, 5}))).wavelengths() == wavelengths);
  }
}

TEST_CASE("streaming gives the same bytes for any number of threads") {
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 12, 18})), 20);
  for (const Eigen::Index exact_columns : {100, 10}) {
    const auto one = learn_streamed(set, 6, {1}, exact_columns), three = learn_streamed(set, 6, {3}, exact_columns);
    CHECK(one.exact == (exact_columns == 100));
    CHECK(one.prior.components() == three.prior.components());
    CHECK(one.prior.mean() == three.prior.mean());
    CHECK(one.prior.coefficients() == three.prior.coefficients());
    CHECK(one.prior.singular_values() == three.prior.singular_values());
  }
}

TEST_CASE("components found in a random subspace are close to the exact ones, as they say") {
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 12, 18})), 40);
  const auto exact = learn_streamed(set, 8), found = learn_streamed(set, 8, {}, 10);
  CHECK_FALSE(found.exact);
  CHECK(found.residual > 0.0);
  CHECK(found.residual < 1e-6);
  const double variance = exact.prior.singular_values().squaredNorm() / exact.prior.explained_variance();
  const Eigen::VectorXd off = exact.prior.singular_values().cwiseAbs2() - found.prior.singular_values().cwiseAbs2();
  CHECK(off.cwiseAbs().maxCoeff() <= found.residual * variance + 1e-12 * variance);
  CHECK(found.prior.explained_variance() == doctest::Approx(exact.prior.explained_variance()).epsilon(1e-6));
}

TEST_CASE("passes whose subtrees are summed elsewhere give the same bytes") {
  const auto set = synthetic_materials(small_cells(), 12);
  for (const Eigen::Index exact_columns : {1024, 10}) {
    gonio::streaming_options options{.components = 6, .exact_columns = exact_columns};
    const auto alone = gonio::learn_streamed_pca(gonio::rows_of(set), options);
    Eigen::Index completed = 0;
    options.share.sum = [](const gonio::shared_groups::sum_of& of_groups) {
      std::vector<Eigen::MatrixXd> sums;
      for (Eigen::Index begin = 0; begin < gonio::row_groups; begin += 4) sums.push_back(of_groups({begin, begin + 4}));
      return gonio::sum_of_subtrees(std::move(sums));
    };
    options.share.complete = [&](std::span<float> numbers, Eigen::Index rows) {
      completed += std::ssize(numbers) / rows;
    };
    const auto shared = gonio::learn_streamed_pca(gonio::rows_of(set), options);
    CHECK(shared.prior.components() == alone.prior.components());
    CHECK(shared.prior.singular_values() == alone.prior.singular_values());
    CHECK(completed == shared.prior.size() + 3);  // components, reference, mean and variation
  }
}

TEST_CASE("materials that cannot be streamed are refused") {
  auto spectra = synthetic_materials(small_cells(), 12);
  spectra.values(5, 9) = std::nanf("");
  CHECK_THROWS_WITH_AS(gonio::learn_streamed_pca(at_wavelengths(spectra, {400.0, 500.0, 600.0, 700.0})),
                       doctest::Contains("'spectra-2' is not finite at cell 5"), gonio::error);
  CHECK_THROWS_WITH_AS(
      gonio::learn_streamed_pca(at_wavelengths(synthetic_materials(small_cells(), 12), {400.0, 600.0, 500.0, 700.0})),
      doctest::Contains("wavelength 3 of a spectrum is not above the one before"), gonio::error);
  auto set = synthetic_materials(small_cells(), 3);
  CHECK_THROWS_WITH_AS(learn_streamed(set, 0), doctest::Contains("at least one"), gonio::error);
  CHECK_THROWS_AS(gonio::learn_streamed_pca({small_cells(), {}, {}}), gonio::error);
  auto same = set;
  same.values.setConstant(0.25f);
  CHECK_THROWS_WITH_AS(learn_streamed(same, 3), doctest::Contains("do not differ"), gonio::error);
  auto missing = set;
  missing.values(5, 4) = std::nanf("");
  CHECK_THROWS_WITH_AS(learn_streamed(missing, 3), doctest::Contains("'material-1' is not finite at cell 5"),
                       gonio::error);
  missing.values(5, 4) = -std::numeric_limits<float>::infinity();  // the metric would count it as zero
  CHECK_THROWS_AS(learn_streamed(missing, 3), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::learn_streamed_pca({small_cells(), set.names,
                                                  [](gonio::block range, gonio::cell_rows out) {
                                                    out.setZero();
                                                    if (range.begin > 0) gonio::refuse("the second block is gone");
                                                  }}),
                       "the second block is gone", gonio::error);
}
