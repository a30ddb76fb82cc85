// The adapter for Eigen.
#include <cstdint>

#include <gtest/gtest.h>

#include <hexhex/adapters/eigen.hpp>
#include <hexhex/hexhex.hpp>

#include "support/error_of.hpp"

namespace hexhex {
namespace {

/// The matrices of a map, in any storage order and scalars.
template <class MatrixV, class MatrixT>
struct Matrices {
  MatrixV points;
  MatrixT tets;
  MatrixV wide;  ///< parameters, m x 12
  MatrixV tall;  ///< parameters, 4m x 3

  explicit Matrices(const TetMap& map)
      : points(map.points.size(), 3),
        tets(map.tets.size(), 4),
        wide(map.tets.size(), 12),
        tall(4 * map.tets.size(), 3) {
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        points(v, k) = map.points[static_cast<std::size_t>(v)][static_cast<std::size_t>(k)];
      }
    }
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
      for (Eigen::Index i = 0; i < 12; ++i) {
        const auto tet = static_cast<std::size_t>(t);
        const auto corner = static_cast<std::size_t>(i / 3);
        using Scalar = typename MatrixT::Scalar;
        tets(t, i / 3) = static_cast<Scalar>(map.tets[tet][corner]);
        wide(t, i) = tall(4 * t + i / 3, i % 3) =
            map.parameters[tet][corner][static_cast<std::size_t>(i % 3)];
      }
    }
  }
};

template <class MatrixV, class MatrixT>
void expectSame(const TetMap& map) {
  const Matrices<MatrixV, MatrixT> m(map);
  for (const MatrixV& parameters : {m.wide, m.tall}) {
    const TetMap read = fromEigen(m.points, m.tets, parameters);
    EXPECT_EQ(read.points, map.points);
    EXPECT_EQ(read.tets, map.tets);
    EXPECT_EQ(read.parameters, map.parameters);
  }
}

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(EigenAdapter, ReadsMapsOfAnyLayout) {
  const TetMap map = generateSample(SampleKind::Tetrahedron).map;
  expectSame<Eigen::MatrixXd, Eigen::MatrixXi>(map);
  expectSame<RowMatrix, Eigen::Matrix<std::int64_t, Eigen::Dynamic, 4>>(map);
}

TEST(EigenAdapter, RefusesShapesAndIndices) {
  Matrices<Eigen::MatrixXd, Eigen::MatrixXi> m(generateSample(SampleKind::Box).map);
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(fromEigen(m.wide, m.tets, m.wide)); }),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(
      test::codeOf([&] { static_cast<void>(fromEigen(m.points, m.points.cast<int>(), m.wide)); }),
      ErrorCode::InvalidArgument);
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(fromEigen(m.points, m.tets, m.points)); }),
            ErrorCode::InvalidArgument);
  m.tets(3, 2) = -1;
  try {
    static_cast<void>(fromEigen(m.points, m.tets, m.wide));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::IndexOutOfRange);
    EXPECT_EQ(error.place().index, 3U);
  }
}

TEST(EigenAdapter, ShowsMeshesWithoutACopyAndCopiesThem) {
  const HexMesh mesh = extract(generateSample(SampleKind::Box).map);
  EXPECT_EQ(pointRows(mesh).data(), mesh.points[0].data());
  EXPECT_EQ(cellRows(mesh).data(), mesh.cells[0].data());
  Eigen::MatrixXd points;
  Eigen::MatrixXi cells;
  toEigen(mesh, points, cells);
  ASSERT_EQ(points.rows(), static_cast<Eigen::Index>(mesh.points.size()));
  ASSERT_EQ(cells.cols(), 8);
  EXPECT_EQ(points(5, 2), mesh.points[5][2]);
  EXPECT_EQ(cells(7, 3), static_cast<int>(mesh.cells[7][3]));
  EXPECT_EQ(pointRows(HexMesh{}).rows(), 0);
  Eigen::Matrix<std::int8_t, Eigen::Dynamic, 8> tooNarrow;
  EXPECT_EQ(test::codeOf([&] { toEigen(mesh, points, tooNarrow); }), ErrorCode::TooLarge);
}

}  // namespace
}  // namespace hexhex
