#pragma once
/// Squared errors of materials that are left out of the basis which reconstructs them: symmetric 3 x 3 matrices X and L
/// of each (`expected_error`), as six numbers, or as six arrays of them for several candidates side by side.

namespace gonio::design::detail {

/// The rows and columns of a symmetric 3 x 3 matrix that six numbers are.
inline constexpr int block_rows[6] = {0, 1, 2, 0, 0, 1}, block_columns[6] = {0, 1, 2, 1, 2, 2};

/// The diagonal of L^-1 X L^-1 of symmetric 3 x 3 matrices, by the adjugate of L.
template <class Number>
inline void left_out_squares(const Number (&x)[6], const Number (&l)[6], Number (&squares)[3]) {
  const Number a00 = l[1] * l[2] - l[5] * l[5], a01 = l[4] * l[5] - l[3] * l[2], a02 = l[3] * l[5] - l[4] * l[1],
               a11 = l[0] * l[2] - l[4] * l[4], a12 = l[3] * l[4] - l[0] * l[5], a22 = l[0] * l[1] - l[3] * l[3],
               scale = 1 / (l[0] * a00 + l[3] * a01 + l[4] * a02);
  const auto square = [&](const Number& p, const Number& q, const Number& r) -> Number {
    return (p * (p * x[0] + 2 * (q * x[3] + r * x[4])) + q * (q * x[1] + 2 * r * x[5]) + r * r * x[2]) * scale * scale;
  };
  squares[0] = square(a00, a01, a02);
  squares[1] = square(a01, a11, a12);
  squares[2] = square(a02, a12, a22);
}

}  // namespace gonio::design::detail
