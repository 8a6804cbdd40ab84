/// A table as an xtensor array: changed in place, viewed along its angles, written for numpy and read back.

#include <gonio/io/bytes/npy.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/table/tensor_view.hpp>

#include <xtensor/xview.hpp>

#include <cmath>
#include <cstdio>

int main() {
  const gonio::valid_cells cells(gonio::grid({90, 30, 36}));
  gonio::brdf_table paint = gonio::tabulate(gonio::model::formula_material("red-paint"), cells);
  const auto show = [](const char* name, const gonio::brdf_table& table) {
    const auto [wi, wo] = gonio::to_directions({gonio::radians(10.0), gonio::radians(20.0), gonio::radians(90.0)});
    const gonio::rgb value = table(wi, wo);
    std::printf("%-9s %.3f %.3f %.3f sr^-1\n", name, value.x(), value.y(), value.z());
  };
  show("red", paint);

  // A view of the table's own memory, cells x 3: writing to the view changes the table.
  auto values = gonio::tensor_view(paint);
  std::printf("%zu cells x %zu channels\n", values.shape(0), values.shape(1));
  xt::view(values, xt::all(), 1) = xt::view(values, xt::all(), 0);  // copy red to green: yellow
  show("yellow", paint);

  // A copy along the angles, theta_h x theta_d x phi_d x 3, with NaN below the horizon.
  const xt::xtensor<float, 4> dense = gonio::dense_tensor(paint);
  for (const std::size_t theta_d : {0u, 15u, 25u}) {
    std::size_t below = 0;
    for (std::size_t theta_h = 0; theta_h < dense.shape(0); ++theta_h)
      below += std::isnan(dense(theta_h, theta_d, 0, 0));
    std::printf("theta_d %2.0f degrees: highlight %.2f sr^-1, %zu of %zu cells below the horizon\n",
                gonio::degrees(cells.grid().theta_d(static_cast<double>(theta_d))), dense(0, theta_d, 0, 0), below,
                dense.shape(0));
  }

  // Write a file for numpy.load, and read it back.
  gonio::io::write_npy("yellow.npy", xt::xtensor<float, 2>(values));
  const xt::xtensor<float, 2> stored = gonio::io::read_npy<float, 2>("yellow.npy");
  show("read back", gonio::brdf_table(cells, {stored.begin(), stored.end()}));
}
