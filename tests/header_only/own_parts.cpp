// A reader's own metric, basis and solver in one program, which knows nothing of the library but the heart. It is built
// against the headers alone and against gonio::compiled, and cmake/compile_times.cmake measures what it costs a
// compiler. Returns the number of checks that failed.

#include <gonio/estimate/decomposition.hpp>

#include <cmath>
#include <cstdio>

namespace {

/// Reflectance to the power of 1/3, which is how bright it looks.
struct cube_root {
  double forward(double rho, const auto&) const noexcept { return std::cbrt(rho); }
  double inverse(double y, const auto&) const noexcept { return y * y * y; }
};
static_assert(gonio::error_metric<cube_root>);

/// A constant, and two lobes about the normal, of cos theta_h to the powers of 10 and 100. They are computed where they
/// are asked for.
class two_lobes {
 public:
  explicit two_lobes(gonio::valid_cells cells) : cells_(std::move(cells)) {}

  Eigen::Index size() const { return 3; }
  const gonio::valid_cells& cells() const { return cells_; }
  double offset(Eigen::Index) const { return 0.0; }
  cube_root metric() const { return {}; }
  void read_row(const gonio::location& at, gonio::function_row out) const {
    const double cosine = std::cos(at.angles.theta_h);
    out[0] = 1.0;
    out[1] = std::pow(cosine, 10.0);
    out[2] = std::pow(cosine, 100.0);
  }

 private:
  gonio::valid_cells cells_;
};
static_assert(gonio::basis<two_lobes>);

/// The optimum over one weight after the other (Gauss and Seidel).
struct relaxation {
  gonio::solution solve(const gonio::least_squares_problem& problem) const {
    const gonio::normal_equations& normal = problem.normal();
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(normal.unknowns(), normal.right_hand_sides());
    for (int sweep = 0; sweep < 2000; ++sweep)
      for (Eigen::Index column = 0; column < x.cols(); ++column)
        for (Eigen::Index j = 0; j < x.rows(); ++j) {
          double slope = -normal.rhs()(j, column);
          for (Eigen::Index i = 0; i < x.rows(); ++i) slope += normal.gram()(j, i) * x(i, column);
          x(j, column) -= slope / normal.gram()(j, j);
        }
    return {x, {problem.residual(x), normal.objective(x), gonio::stationarity(normal, x), 2000}};
  }
};
static_assert(gonio::solver<relaxation>);

int failures = 0;

void check(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::printf("failed: %s\n", what);
}

/// What the two lobes can say exactly.
double truth(double theta_h) {
  const double root = 0.3 + 0.2 * std::pow(std::cos(theta_h), 10.0) + 0.9 * std::pow(std::cos(theta_h), 100.0);
  return root * root * root;
}

}  // namespace

int main() {
  const gonio::valid_cells cells(gonio::grid({30, 30, 36}));
  gonio::sample_set samples;
  for (int i = 0; i < 24; ++i) {
    const gonio::half_difference angles{gonio::radians(3.0 * i), gonio::radians(15.0), gonio::radians(90.0)};
    const double rho = truth(angles.theta_h);
    samples.push_back({angles, {rho, rho / 8.0, 0.0}, 1.0});
  }
  const gonio::decomposition estimator{two_lobes(cells), relaxation{}};
  static_assert(gonio::estimator<decltype(estimator)>);
  const auto fit = estimator.fit(samples);

  check(fit.report()->kkt_residual.maxCoeff() < 1e-9, "the weights are optimal");
  check(std::abs(fit.weights()(2, 0) - 0.9) < 1e-6, "the narrow lobe's weight in red is .9");
  check(std::abs(fit.weights()(2, 1) - 0.45) < 1e-6, "half of it in green, whose values are an eighth");
  const gonio::rgb above = fit({0, 0, 1}, {0, 0, 1});
  check(std::abs(above.x() - truth(0.0)) < 1e-6 && std::abs(above.z()) < 1e-9, "the value at the normal");
  check((fit({0, 0, 1}, {0, 0, -1}) == 0.0).all(), "nothing below the horizon");
  const gonio::brdf_table table = fit.tabulate(cells);
  double worst = 0.0;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
    worst = std::max(worst, std::abs(table.at(cell).x() - truth(cells.angles(cell).theta_h)));
  check(worst < 1e-5, "the table is the truth everywhere");
  return failures;
}
