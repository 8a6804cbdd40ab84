#include "../synthetic_materials.hpp"
#include <gonio/basis/add_materials.hpp>

#include <doctest/doctest.h>

namespace {

const gonio::valid_cells& grid_of_test() {
  static const gonio::valid_cells cells(gonio::grid({18, 12, 18}));
  return cells;
}

/// Returns `count` of thirty materials, starting at `first`.
gonio::material_set materials(Eigen::Index first, Eigen::Index count) {
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < count; ++i) positions.push_back(first + i);
  return synthetic_materials(grid_of_test(), 30).subset(positions);
}

/// Returns the largest difference between the mapped values of the materials stored in two priors.
double largest_difference(const gonio::log_relative_pca& a, const gonio::log_relative_pca& b) {
  const auto mapped = [](const gonio::log_relative_pca& prior) {
    Eigen::MatrixXd all = prior.components().cast<double>() * prior.coefficients().cast<double>().transpose();
    for (Eigen::Index cell = 0; cell < all.rows(); ++cell) all.row(cell).array() += prior.offset(cell);
    return all;
  };
  return (mapped(a) - mapped(b)).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("materials added to a prior that keeps all make the prior of all together") {
  const auto old_set = materials(0, 20), new_set = materials(20, 10);
  const auto metric = gonio::log_relative::to_median_of(old_set);
  const auto old = gonio::learn_pca(old_set, metric, 60), together = gonio::learn_pca(materials(0, 30), metric, 60);
  for (const Eigen::Index exact_columns : {1024, 10}) {
    const auto added = gonio::add_materials(old, gonio::rows_of(new_set),
                                            {.components = together.size(), .exact_columns = exact_columns});
    CAPTURE(exact_columns);
    CHECK(added.exact == (exact_columns > 10));
    CHECK(added.prior.names() == together.names());
    const Eigen::Index size = std::min(added.prior.size(), together.size());
    const double largest = together.singular_values()[0];
    CHECK((added.prior.singular_values().head(size) - together.singular_values().head(size)).cwiseAbs().maxCoeff() <
          1e-5 * largest);
    CHECK(largest_difference(added.prior, together) < 1e-3);
    CHECK(added.prior.explained_variance() == doctest::Approx(together.explained_variance()).epsilon(1e-5));
    for (Eigen::Index cell = 0; cell < grid_of_test().size(); cell += 7)
      CHECK(added.prior.offset(cell) == doctest::Approx(together.offset(cell)).epsilon(1e-5));
    // Coefficients are those of U: orthonormal, and centred.
    const Eigen::MatrixXd u = added.prior.coefficients().leftCols(5).cast<double>();
    CHECK((u.transpose() * u).isIdentity(1e-5));
    CHECK(u.colwise().sum().cwiseAbs().maxCoeff() < 1e-4);
  }
}

TEST_CASE("variance that a prior did not keep counts as unexplained") {
  const auto old_set = materials(0, 20);
  const auto metric = gonio::log_relative::to_median_of(old_set);
  const auto old = gonio::learn_pca(old_set, metric, 6);
  const auto added = gonio::add_materials(old, gonio::rows_of(materials(20, 10)), {.components = 6});
  const auto together = gonio::learn_pca(materials(0, 30), metric, 6);
  CHECK(added.prior.explained_variance() <= together.explained_variance() + 1e-9);
  CHECK(added.prior.explained_variance() > together.explained_variance() - 0.01);
}

TEST_CASE("singular values of a thinned prior stay in the scale of the cells it was learned from") {
  const gonio::valid_cells coarse(gonio::grid({18, 4, 6}));
  const auto old_set = materials(0, 20);
  const auto old = gonio::thin(learn(old_set, 20), coarse);
  auto more = synthetic_materials(coarse, 2, 99);
  more.names = {"one", "other"};
  const auto added = gonio::add_materials(old, gonio::rows_of(more), {.components = 20});
  CHECK(added.prior.cells() == coarse);
  CHECK(added.prior.singular_values()[0] > 0.9 * old.singular_values()[0]);
  CHECK(added.prior.singular_values()[0] < 1.5 * old.singular_values()[0]);
}

TEST_CASE("spectra are added to spectra of the same wavelengths, and to no others") {
  const std::vector<double> wavelengths{400.0, 500.0, 600.0, 700.0};
  const auto old_rows = at_wavelengths(materials(0, 20), wavelengths);
  auto more = at_wavelengths(materials(20, 4), wavelengths);
  for (std::string& name : more.names) name = "new-" + name;
  const auto old = gonio::learn_streamed_pca(old_rows, {.components = 8}).prior;
  const auto all = gonio::add_materials(old, more, {.components = 8}).prior;
  CHECK(all.wavelengths() == wavelengths);
  CHECK(all.names().size() == 18);
  CHECK(all.coefficients().rows() == 72);
  const auto refuses = [&](const gonio::material_rows& rows, const char* what) {
    CHECK_THROWS_WITH_AS(gonio::add_materials(old, rows), doctest::Contains(what), gonio::error);
  };
  refuses(gonio::rows_of(materials(20, 4)),
          "the prior's materials are at 4 wavelengths, the materials to add are in RGB");
  more.wavelengths = {400.0, 500.0, 600.0, 690.0};
  refuses(more, "wavelength 4 of the materials to add is 690");
  CHECK_THROWS_WITH_AS(gonio::add_materials(learn(materials(0, 20), 8), old_rows),
                       doctest::Contains("the prior's materials are in RGB, the materials to add are at 4 wavelengths"),
                       gonio::error);
}

TEST_CASE("materials that cannot be added are refused") {
  const auto old = learn(materials(0, 5), 6);
  CHECK_THROWS_WITH_AS(gonio::add_materials(old, gonio::rows_of(materials(4, 3))),
                       doctest::Contains("named 'material-4' already"), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::add_materials(old, gonio::rows_of(synthetic_materials(small_cells(), 3))),
                       doctest::Contains("over the same cells"), gonio::error);
  CHECK_THROWS_AS(gonio::add_materials(old, {grid_of_test(), {}, {}}), gonio::error);
  auto missing = materials(6, 2);
  missing.values(9, 0) = std::nanf("");
  CHECK_THROWS_WITH_AS(gonio::add_materials(old, gonio::rows_of(missing)),
                       doctest::Contains("'material-6' is not finite at cell 9"), gonio::error);
}
