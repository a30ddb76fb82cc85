// A look at hex edges while the propeller engine follows them: who wants to know their ways need
// not follow them again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <lattice/direction.hpp>
#include <propeller/lattice_lines.hpp>

namespace hexhex {

/// A hex edge in the chart of a tet that it begins in.
struct FollowedEdge {
  std::array<Index, 2> ends;  ///< the hex vertices at its beginning and end
  Index tet;
  GridPoint z;  ///< where it begins
  Direction along;
  CornerMask begin;  ///< simplex of the tet that holds its beginning
  CornerMask end;    ///< simplex of the last tet on its way that holds its end
  bool jumps;        ///< from chart to chart, on its way
  Index faceBegin;   ///< its faces begin here, where those of the edge before end,
  Index faceEnd;     ///< and end here
};

/// A face that an edge crosses on its way, as seen from where it comes from.
struct FollowedFace {
  HalfFace halfFace;
  Index edge;   ///< its number in the block
  GridPoint z;  ///< where it begins, in the chart of the half-face's tet
  Direction along;
};

/// The edges of a block.
struct FollowedEdges {
  Array<FollowedEdge> edges;
  /// Where edges lie in faces or meet edges and vertices of the tets, these are of some tets that
  /// have parts of them.
  Array<FollowedFace> faces;

  void clear() noexcept {
    edges.clear();
    faces.clear();
  }
};

/// What a guest may rely on.
struct TraceSizes {
  std::uint64_t vertices;
  std::uint64_t edges;
  std::size_t batch;  ///< blocks in a batch, except for the last one
};

/// Sees every hex edge once. Edges come in blocks, which do not depend on the number of threads,
/// and these in batches (parallelBatches()).
class TraceGuest {
 public:
  TraceGuest() = default;
  TraceGuest(const TraceGuest&) = delete;
  TraceGuest& operator=(const TraceGuest&) = delete;
  TraceGuest(TraceGuest&&) = delete;
  TraceGuest& operator=(TraceGuest&&) = delete;
  virtual ~TraceGuest() = default;

  /// Before all edges, and again if the engine has to start over.
  /// @param lines  of all tets; they stay there until take()
  virtual void begin(const LatticeLines& lines, const TraceSizes& sizes, Stage& stage) = 0;
  /// Blocks of a batch in any order and in parallel.
  /// @param edges  stay there until place()
  virtual void add(std::size_t block, const FollowedEdges& edges) = 0;
  /// After the blocks of a batch.
  virtual void measure(std::size_t firstBlock, std::size_t endBlock) = 0;
  /// Then, of each of them, in parallel.
  virtual void place(std::size_t block) = 0;
  /// At the end.
  virtual void take(LatticeLines lines) = 0;
};

}  // namespace hexhex
