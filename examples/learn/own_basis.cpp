/// A basis of your own: a constant and two lobes about the half vector, computed on demand.

#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <utility>

class lobes {
 public:
  explicit lobes(gonio::valid_cells cells) : cells_(std::move(cells)) {}

  Eigen::Index size() const { return 1 + std::ssize(exponents); }
  const gonio::valid_cells& cells() const { return cells_; }
  double offset(Eigen::Index /*cell*/) const { return 0.0; }
  gonio::log metric() const { return {}; }
  /// Returns the values of all functions at a location, in the metric's domain.
  void read_row(const gonio::location& at, gonio::function_row out) const {
    out[0] = 1.0;
    for (std::size_t i = 0; i < exponents.size(); ++i) out[i + 1] = std::pow(std::cos(at.angles.theta_h), exponents[i]);
  }

  static constexpr std::array<double, 2> exponents{20.0, 200.0};

 private:
  gonio::valid_cells cells_;
};
static_assert(gonio::computed_basis<lobes>);

int main() {
  const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
  const lobes basis{gonio::valid_cells(gonio::grid({90, 30, 36}))};
  const auto paint = gonio::decomposition{basis, gonio::nnls{}}.fit(samples);

  std::printf("function   red      green    blue\n");
  const Eigen::MatrixXd& weights = paint.weights();
  for (Eigen::Index i = 0; i < weights.rows(); ++i)
    std::printf("%-8ld %8.4f %8.4f %8.4f\n", static_cast<long>(i), weights(i, 0), weights(i, 1), weights(i, 2));
  for (const double degrees : {0.0, 10.0, 30.0, 60.0}) {
    const auto [wi, wo] = gonio::to_directions({gonio::radians(degrees), gonio::radians(20.0), gonio::radians(90.0)});
    std::printf("theta_h %2.0f degrees: red %.3f sr^-1\n", degrees, paint(wi, wo).x());
  }
}
