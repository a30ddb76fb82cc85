// From and to Eigen matrices as libigl passes them: one row per element. Needs Eigen 3.3 or later;
// the CMake target is hexhex::eigen.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>

#include <Eigen/Core>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

namespace detail {

template <class Derived>
void requireColumns(const Eigen::MatrixBase<Derived>& matrix, Eigen::Index columns,
                    const char* name) {
  if (matrix.cols() == columns) return;
  throw Error(ErrorCode::InvalidArgument, std::string("The matrix ") + name + " has " +
                                              std::to_string(matrix.cols()) + " columns, not " +
                                              std::to_string(columns) + ".");
}

template <class Scalar>
[[nodiscard]] Index toIndex(Scalar value, std::size_t tet) {
  // Negative numbers become large thereby, and too large ones stay it.
  const auto wide = static_cast<std::make_unsigned_t<Scalar>>(value);
  if (wide < kNone) return static_cast<Index>(wide);
  throw Error(ErrorCode::IndexOutOfRange, "A tet names a vertex that does not exist.",
              {PlaceKind::Tet, tet});
}

}  // namespace detail

/// A map from matrices. Copies.
/// @param V    n x 3: positions
/// @param T    m x 4 of integers: tets
/// @param UVW  m x 12: u, v, w of corner 0, then of corner 1, 2, 3 of each tet; or 4m x 3: the four
///             corners of tet 0, then of tet 1 ...
/// @throws Error InvalidArgument for other shapes, IndexOutOfRange for negative indices
template <class DerivedV, class DerivedT, class DerivedP>
[[nodiscard]] TetMap fromEigen(const Eigen::MatrixBase<DerivedV>& V,
                               const Eigen::MatrixBase<DerivedT>& T,
                               const Eigen::MatrixBase<DerivedP>& UVW) {
  static_assert(std::is_integral_v<typename DerivedT::Scalar>);
  detail::requireColumns(V, 3, "V");
  detail::requireColumns(T, 4, "T");
  const bool wide = UVW.rows() == T.rows() && UVW.cols() == 12;
  if (!wide && (UVW.rows() != 4 * T.rows() || UVW.cols() != 3)) {
    throw Error(ErrorCode::InvalidArgument,
                "The matrix UVW has " + std::to_string(UVW.rows()) + " rows and " +
                    std::to_string(UVW.cols()) + " columns. For " + std::to_string(T.rows()) +
                    " tets, give as many rows and 12 columns, or 4 times as many and 3.");
  }
  TetMap map;
  map.points.resize(static_cast<std::size_t>(V.rows()));
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      map.points[static_cast<std::size_t>(v)][static_cast<std::size_t>(k)] =
          static_cast<double>(V(v, k));
    }
  }
  map.tets.resize(static_cast<std::size_t>(T.rows()));
  map.parameters.resize(map.tets.size());
  for (Eigen::Index t = 0; t < T.rows(); ++t) {
    const auto tet = static_cast<std::size_t>(t);
    for (Eigen::Index i = 0; i < 4; ++i) {
      const auto corner = static_cast<std::size_t>(i);
      map.tets[tet][corner] = detail::toIndex(T(t, i), tet);
      for (Eigen::Index k = 0; k < 3; ++k) {
        map.parameters[tet][corner][static_cast<std::size_t>(k)] =
            static_cast<double>(wide ? UVW(t, 3 * i + k) : UVW(4 * t + i, k));
      }
    }
  }
  return map;
}

/// Rows of positions and cells (VTK_HEXAHEDRON order) of a mesh, without a copy: valid as long as
/// the mesh is, and its arrays are not resized.
using PointRows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;
using CellRows = Eigen::Map<const Eigen::Matrix<Index, Eigen::Dynamic, 8, Eigen::RowMajor>>;

[[nodiscard]] inline PointRows pointRows(const HexMesh& mesh) {
  return {mesh.points.empty() ? nullptr : mesh.points[0].data(),
          static_cast<Eigen::Index>(mesh.points.size()), 3};
}
[[nodiscard]] inline CellRows cellRows(const HexMesh& mesh) {
  return {mesh.cells.empty() ? nullptr : mesh.cells[0].data(),
          static_cast<Eigen::Index>(mesh.cells.size()), 8};
}

/// Copies into matrices of any scalar and storage order, as libigl's functions return them.
template <class DerivedV, class DerivedH>
void toEigen(const HexMesh& mesh, Eigen::PlainObjectBase<DerivedV>& V,
             Eigen::PlainObjectBase<DerivedH>& H) {
  using IndexScalar = typename DerivedH::Scalar;
  if (mesh.points.size() > static_cast<std::size_t>(std::numeric_limits<IndexScalar>::max())) {
    throw Error(ErrorCode::TooLarge,
                "The mesh has more vertices than the matrix of cells can number. Give a matrix of "
                "wider integers.");
  }
  V = pointRows(mesh).template cast<typename DerivedV::Scalar>();
  H = cellRows(mesh).template cast<IndexScalar>();
}

}  // namespace hexhex
