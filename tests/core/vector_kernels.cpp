#include <gonio/core/vector_kernels.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

constexpr double largest = std::numeric_limits<double>::max(), smallest = std::numeric_limits<double>::denorm_min();

}  // namespace

TEST_CASE("products and scaled sums are those of plain loops") {
  CHECK(rc::check([](const std::vector<std::int16_t>& integers) {
    // Integers below 2^16: their products and sums are exact in double.
    const std::vector<double> a(integers.begin(), integers.end()), b(integers.rbegin(), integers.rend());
    const auto count = std::ssize(a);
    double product = 0.0;
    std::vector<double> sum = b;
    for (std::size_t i = 0; i < a.size(); ++i) {
      product += a[i] * b[i];
      sum[i] += 3.0 * a[i];
    }
    RC_ASSERT(gonio::dot(a.data(), b.data(), count) == product);
    std::vector<double> found = b;
    gonio::add_scaled(3.0, a.data(), found.data(), count);
    RC_ASSERT(found == sum);
    std::vector<float> floats(b.begin(), b.end());
    const std::vector<float> a_float(a.begin(), a.end());
    gonio::add_scaled(3.0f, a_float.data(), floats.data(), count);
    RC_ASSERT(std::vector<double>(floats.begin(), floats.end()) == sum);
  }));
}

TEST_CASE("a norm neither overflows nor vanishes") {
  for (const double size : {1.0, largest / 8, smallest}) {
    const std::vector<double> numbers{3 * size, -4 * size};
    CHECK(gonio::norm(numbers.data(), 2) == doctest::Approx(std::hypot(numbers[0], numbers[1])));
  }
  CHECK(gonio::norm(nullptr, 0) == 0.0);
}

TEST_CASE("exponentials are within two units of the last place, wherever they stand") {
  std::vector<float> numbers;
  for (float x = -80.0f; x < 80.0f; x += 0.37f) numbers.push_back(x);
  for (const std::size_t start : {0, 1, 2, 3, 5}) {
    std::vector<float> found(numbers.begin() + start, numbers.end());
    gonio::exponentiate(found.data(), std::ssize(found));
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double exact = std::exp(double{numbers[start + i]});
      const double unit = std::ldexp(1.0, std::ilogb(exact) - 23);
      CHECK(std::abs(found[i] - exact) <= 2.0 * unit);
      float alone = numbers[start + i];
      gonio::exponentiate(&alone, 1);
      CHECK(alone == found[i]);
    }
  }
}

TEST_CASE("a float copy is rounded to nearest") {
  const Eigen::MatrixXd numbers = Eigen::MatrixXd::Random(7, 5);
  CHECK(gonio::to_float(numbers) == numbers.cast<float>());
}

TEST_CASE("vector kernels: three dot products at once are each one's own") {
  for (const Eigen::Index rows : {0, 1, 7, 15, 16, 17, 20, 32, 61, 100}) {
    const Eigen::VectorXf a = Eigen::VectorXf::Random(rows);
    const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(rows, 3);
    const auto found = gonio::three_columns(columns).dot_each(a.data());
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double expected = a.cast<double>().dot(columns.col(k));
      CHECK(std::abs(found[k] - expected) <= 1e-6 * static_cast<double>(rows));
    }
  }
}
