#include <gonio/shape.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace {

/// Corners at the origin and on the three axes.
gonio::shape::point_columns tetrahedron(double x, double y, double z) {
  gonio::shape::point_columns vertices = gonio::shape::point_columns::Zero(3, 4);
  vertices.rightCols(3) = Eigen::Vector3d(x, y, z).asDiagonal();
  return vertices;
}

}  // namespace

// Learns a model, then calls what needs nanoflann (`describe`) and dlib (`match`), which must be more than found.
int main() {
  gonio::shape::triangle_columns triangles(3, 4);
  triangles << 1, 0, 0, 0,  //
      2, 3, 1, 2,           //
      3, 2, 3, 1;
  const std::vector<gonio::shape::point_columns> shapes{tetrahedron(3, 4, 5), tetrahedron(4, 4, 5),
                                                        tetrahedron(3, 5, 5), tetrahedron(3, 4, 6)};
  const std::vector<std::string> names{"small", "wide", "high", "deep"};
  const auto model = gonio::shape::learn_shape_model(shapes, names, triangles);

  // A shape that was learned from comes back, but for where it was.
  const gonio::shape::point_columns again = model.shape(model.basis().weights_of(1).col(0)).vertices;
  const double error = (gonio::shape::align(shapes[1], again)(shapes[1]) - again).cwiseAbs().maxCoeff();

  // Every point that can be described looks most like itself.
  const gonio::shape::shape_descriptors points = gonio::shape::describe(model.mean(), {0, 1, 2, 3});
  const std::vector<gonio::shape::shape_match> matches = gonio::shape::match(points, points);
  bool themselves = true;
  for (const gonio::shape::shape_match& found : matches) themselves = themselves && found.from == found.onto;

  std::printf("%g mm off, %zu points matched, %s\n", error, matches.size(),
              themselves ? "each to itself" : "some to others");
  return error < 1e-5 && matches.size() >= 3 && themselves ? 0 : 1;
}
