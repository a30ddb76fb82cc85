#include <iostream>

#include <hexhex/adapters/eigen.hpp>
#include <hexhex/extract.hpp>

// A unit cube of six tets around a diagonal, with its own coordinates as parameters.
int main() {
  Eigen::MatrixXd V(8, 3);
  for (int v = 0; v < 8; ++v) V.row(v) << (v & 1), (v >> 1 & 1), (v >> 2 & 1);
  Eigen::MatrixXi T(6, 4);
  T << 0, 1, 3, 7, 0, 3, 2, 7, 0, 2, 6, 7, 0, 6, 4, 7, 0, 4, 5, 7, 0, 5, 1, 7;
  Eigen::MatrixXd UVW(6, 12);
  for (int t = 0; t < 6; ++t) {
    for (int i = 0; i < 4; ++i) UVW.block(t, 3 * i, 1, 3) = V.row(T(t, i));
  }
  const hexhex::HexMesh mesh = hexhex::extract(hexhex::fromEigen(V, T, UVW), {.scale = 2});
  Eigen::MatrixXd points;
  Eigen::MatrixXi cells;
  hexhex::toEigen(mesh, points, cells);
  std::cout << cells.rows() << " hexahedra, " << points.rows() << " points\n";
  return cells.rows() == 8 && points.rows() == 27 && cells.maxCoeff() == 26 ? 0 : 1;
}
