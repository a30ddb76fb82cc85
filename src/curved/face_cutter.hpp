// One hex face: all polygons in which it meets tets, and the points that they share.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <curved/owned_simplex.hpp>
#include <curved/patches.hpp>
#include <curved/simplex_star.hpp>
#include <curved/square_slice.hpp>

namespace hexhex {

/// Polygons of consecutive faces. Their inner points are numbered from the first number on that
/// inner points have.
struct PatchPieces {
  std::vector<std::uint32_t> cornerCounts;  ///< per polygon
  std::vector<OwnedSimplex> carriers;       ///< per polygon
  std::vector<Index> corners;
  std::vector<std::array<double, 2>> parameters;
  std::vector<Vec3> points;
  std::vector<OwnedSimplex> generators;

  void clear() {
    cornerCounts.clear();
    carriers.clear();
    corners.clear();
    parameters.clear();
    points.clear();
    generators.clear();
  }
};

/// Cuts one face after the other. One per thread.
///
/// A piece is what a tet's interior has of the open square, or what a triangle in the square's
/// plane has. Pieces are convex and meet along whole sides: a face of a tet separates two of them,
/// and so does an edge in the plane. From the piece at the centre, all others are reached across
/// sides inside the open square.
class FaceCutter {
 public:
  FaceCutter(const PatchInput& input, PatchPieces& pieces)
      : input_(input),
        topology_(input.map.topology),
        exact_(input.map.exact),
        star_(input.map.topology, input.map.exact),
        vertexCount_(input.vertices.count()),
        firstInnerPoint_(input.firstInnerPoint()),
        out_(pieces) {}

  struct Border {
    Quad vertices{};
    std::array<Index, 4> arcs{};
    std::uint8_t reversed = 0;
    std::uint32_t polygons = 0;
  };
  /// Appends a face's polygons.
  /// @param tet  owner of the face's centre
  [[nodiscard]] Border cut(Index tet, const Element& face);

 private:
  struct Piece {
    SimplexInTet carrier;
    LatticeTet seen;  ///< the tet in the square's frame
    Slice slice;
    int entered;              ///< face of the tet across which the piece was found, or -1
    std::size_t from;         ///< then: the piece on the other side
    std::size_t fromSide;     ///< and its side
    std::size_t next;         ///< piece of the same tet, or kLast
    std::size_t firstCorner;  ///< among the corners that are emitted
  };
  struct InnerPoint {
    Index end;                         ///< larger vertex of the edge, or the vertex itself
    std::array<LatticePoint, 2> seen;  ///< both ends in the square's frame
    std::array<double, 2> parameter;
    Index number;
    std::size_t next;  ///< of those with the same first vertex, or kLast
  };
  /// A list per key, by the number of a KeyTable.
  struct Lists {
    KeyTable keys;
    std::vector<std::size_t> first;

    void clear() {
      keys.clear();
      first.clear();
    }
    /// Where the list of a key begins.
    std::size_t& operator[](Index key);
  };
  static constexpr std::size_t kLast = ~std::size_t{0};

  [[nodiscard]] bool cutInsideOneTet(Index tet, const Frame& frame, Border& border);
  void collectPieces(const SimplexInTet& center);
  void addPiece(const SimplexInTet& carrier) { addPiece(carrier, -1, kLast, 0); }
  void addPiece(SimplexInTet carrier, int entered, std::size_t from, std::size_t fromSide);
  void addNeighbours(std::size_t piece);
  [[nodiscard]] LatticeTet see(const SimplexInTet& at) const {
    return at.frame.see(exact_.corners[at.tet], exact_.unit);
  }

  void findArcs(Border& border);
  [[nodiscard]] CornerMask simplexOfMidpoint(const LatticeTet& corners, std::size_t side) const;
  void setArc(Border& border, std::size_t side, const SimplexInTet& midpoint);
  static void setVertices(Border& border, const Arcs& arcs, Index tet);

  void emit(const Border& border, Piece& piece);
  void emitCorner(const Border& border, const Piece& piece, const SliceCorner& corner);
  void emitArcPoint(const Border& border, const Piece& piece, const SliceCorner& corner);
  void emitInnerPoint(const Piece& piece, const SliceCorner& corner);
  void put(std::uint64_t number, std::array<double, 2> parameter);

  const PatchInput& input_;
  const TetTopology& topology_;
  const ExactMap& exact_;
  SimplexStar star_;
  std::uint64_t vertexCount_;
  std::uint64_t firstInnerPoint_;
  PatchPieces& out_;
  std::array<LineHint, 4> vertexHints_;  ///< per corner of the square
  std::array<LineHint, 4> arcHints_;     ///< per side

  // Of the face at hand:
  std::vector<Piece> pieces_;
  Lists piecesOfTet_;
  std::vector<InnerPoint> inner_;
  Lists innerAtVertex_;
};

}  // namespace hexhex
