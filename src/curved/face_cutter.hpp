// One hex face: all polygons in which it meets tets, and the points they share (Section 5.5).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <curved/face_border.hpp>
#include <curved/patches.hpp>
#include <curved/simplex_star.hpp>
#include <curved/square_slice.hpp>

namespace hexhex::curved {

/// Cuts one face after another. One per thread.
///
/// A piece is the intersection of the open square with the interior of a tet, or with a triangle
/// that lies in the square's plane. Pieces are convex and meet along whole sides: two pieces are
/// separated by a face of a tet, or by an edge in the plane. All pieces are reached from the one at
/// the centre, across sides inside the open square. What two pieces share is computed once: the
/// corners of their tets, the points of their sections, and the points of their common side.
class FaceCutter {
 public:
  FaceCutter(const PatchInput& input, PatchPieces& pieces)
      : input_(input),
        topology_(input.map.topology),
        exact_(input.map.exact),
        unit_(static_cast<double>(input.map.exact.unit)),
        star_(input.map.topology, input.map.exact),
        border_(input),
        firstInnerPoint_(input.firstInnerPoint()),
        out_(pieces) {}

  /// Appends a face's polygons.
  /// @param tet  owner of the face's centre
  /// @return their number
  [[nodiscard]] std::size_t cut(Index tet, const Element& face);
  /// The border of the face cut last.
  [[nodiscard]] const FaceBorder& border() const noexcept { return border_; }

 private:
  struct Piece {
    SimplexInTet carrier;
    SeenTet seen;
    Section section;
    Slice slice;
    SectionCuts cuts;         ///< of the section
    std::size_t next;         ///< another piece of the same tet, or kLast
    std::size_t firstCorner;  ///< among the emitted corners
    std::size_t from;         ///< the piece across whose side it was found, or kLast
    std::size_t fromSide;     ///< and that side
    std::size_t entry;        ///< this piece's side there: of its section, then of its slice
  };
  struct InnerPoint {
    std::array<Index, 2> vertices;              ///< of the edge, ascending; a vertex twice
    std::array<lattice::LatticePoint, 2> seen;  ///< both in the square's frame
    PatchPoint point;
    std::size_t next;  ///< another one with the same key, or kLast
  };
  /// A list per key, indexed by the numbers of a KeyTable.
  struct Lists {
    adjacency::KeyTable keys;
    std::vector<std::size_t> first;

    void clear() {
      keys.clear();
      first.clear();
    }
    /// Head of the list of a key.
    std::size_t& operator[](Index key) {
      const Index number = keys.insert(key);
      if (number == first.size()) first.push_back(kLast);
      return first[number];
    }
  };
  static constexpr std::size_t kLast = ~std::size_t{0};

  void cutInsideOneTet(Index tet, lattice::CornerMask carrier);
  void addFirstPiece(const SimplexInTet& center, const SeenTet& seen);
  [[nodiscard]] SimplexInTet ownedCarrier(const SimplexInTet& carrier) const;
  void addPiece(const SimplexInTet& carrier, const SeenTet& seen);
  void addPieceAround(std::size_t from, std::size_t side, lattice::CornerMask edge);
  [[nodiscard]] bool addPieceAround(std::size_t from, std::size_t side, SimplexInTet edge, int face,
                                    std::int64_t height);
  void addPieceAtEdge(std::size_t from, std::size_t side, SimplexInTet edge,
                      lattice::CornerMask carrier);
  void addPieceBehind(std::size_t from, std::size_t side, int face);
  [[nodiscard]] bool isKnown(const SimplexInTet& carrier, std::size_t first) const;
  [[nodiscard]] Piece& newPiece(const SimplexInTet& carrier, std::size_t& first);
  void slice(Piece& piece, const KnownCut& known);
  void addNeighbours(std::size_t piece);
  [[nodiscard]] SeenTet see(const SimplexInTet& at) const {
    return {at.frame.see(exact_.corners[at.tet], exact_.unit), unit_};
  }

  void emit(Piece& piece);
  [[nodiscard]] PatchPoint pointAt(const Piece& piece, const SliceCorner& corner);
  [[nodiscard]] PatchPoint innerPoint(const Piece& piece, const SliceCorner& corner);
  void ownInnerPoint(const Piece& piece, const SliceCorner& corner, Index number);
  [[nodiscard]] PatchPoint newInnerPoint(const Piece& piece, const SliceCorner& corner);

  const PatchInput& input_;
  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  double unit_;
  SimplexStar star_;
  FaceBorder border_;
  std::uint64_t firstInnerPoint_;
  PatchPieces& out_;

  // The current face:
  std::vector<Piece> pieces_;
  std::size_t pieceCount_ = 0;  ///< used part of `pieces_`, which never shrinks
  Lists piecesOfTet_;
  std::vector<InnerPoint> inner_;
  Lists innerAtEdge_;
};

}  // namespace hexhex::curved
