// The conditions that make a map seamless, as integer equations: what translations and planes imply
// for the parameters of each vertex, and for each other.
#pragma once

#include <array>
#include <vector>

#include <quantize/seamless/cut_graph.hpp>
#include <quantize/seamless/integer_form.hpp>

namespace hexhex::quantization {

/// Triangles and edges that must be aligned with axes, other than the singular curves that charts
/// reveal.
struct Alignment {
  std::vector<std::uint8_t> axes;  ///< per half-face: the axis perpendicular to it, or kFree
  /// An edge along an axis of its tet's common chart.
  struct Edge {
    adjacency::TetEdge at;
    std::uint8_t axis;
  };
  std::vector<Edge> edges;
};
inline constexpr std::uint8_t kFree = 3;

/// Unknowns shared by many vertices: three for the translation across each piece of the cut, and
/// one for each plane that contains a part of the boundary or an aligned feature.
class SharedUnknowns {
 public:
  SharedUnknowns(const adjacency::TetTopology& topology, const adjacency::EdgeFans& edges,
                 const CutGraph& graph, const Alignment& alignment);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// A component of the translation across a half-face of the cut.
  [[nodiscard]] IntegerForm translation(adjacency::HalfFace halfFace, std::size_t axis) const;
  /// The plane that fixes a coordinate of a sector, or kNone.
  [[nodiscard]] Index plane(Index sector, std::size_t axis) const {
    return planes_[3 * sector + axis];
  }
  /// Equations between translations alone.
  [[nodiscard]] const std::vector<IntegerForm>& equations() const noexcept { return equations_; }
  /// A half-face of each piece of the cut, on both of its sides.
  [[nodiscard]] std::vector<adjacency::HalfFace> cutPieces() const;
  /// The mean values of all unknowns in the given map.
  [[nodiscard]] std::vector<double> measured() const;

 private:
  void numberCutPieces(const adjacency::EdgeFans& edges);
  void numberPlanes(const Alignment& alignment);

  const adjacency::TetTopology& topology_;
  const CutGraph& graph_;
  std::size_t size_ = 0;
  std::vector<adjacency::HalfFace> pieces_;  ///< per half-face of the cut: the first of its piece,
                                             ///< on its side
  std::vector<Index> first_;   ///< per first half-face of a piece: its first unknown, or kNone
  std::vector<Index> planes_;  ///< per sector and axis
  std::vector<IntegerForm> equations_;
};

/// The fixed coordinates of a vertex in the chart of its first sector, and the motions from there
/// to all sectors.
struct VertexConditions {
  /// factor * coordinate + rest = 0.
  struct Fixed {
    std::int64_t factor = 0;  ///< 0: the coordinate is free
    IntegerForm rest;
  };
  /// u = rotation(first sector's u) + translation
  struct Sector {
    Index sector = 0;
    lattice::Rotation rotation;
    std::array<IntegerForm, 3> translation;
  };
  std::vector<Sector> sectors;
  std::array<Fixed, 3> fixed;
};

/// @pre around each interior edge, charts agree or turn about an axis
/// @param[in,out] equations  conditions on shared unknowns are appended
[[nodiscard]] VertexConditions conditionsOf(Index vertex, const adjacency::TetTopology& topology,
                                            const CutGraph& graph, const SharedUnknowns& unknowns,
                                            std::vector<IntegerForm>& equations);

}  // namespace hexhex::quantization
