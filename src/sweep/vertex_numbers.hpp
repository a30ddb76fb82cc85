// The canonical numbers of hex vertices: by owner tet (the smallest around the generator); then by
// generator, in order of dimension, then corners; then by position: along an edge from its smaller
// vertex on, otherwise in the order of the owner's sweep.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <sweep/tet_lines.hpp>

namespace hexhex::sweep {

/// A simplex with hex vertices on the boundary of its owner.
struct BoundaryGenerator {
  Index count;  ///< hex vertices
  lattice::CornerMask simplex;
};

struct VertexNumbers {
  Array<std::uint64_t> begin;           ///< per tet (+1): the first hex vertex that it owns
  Array<Index> generatorBegin;          ///< per tet (+1): its range in `generators`
  Array<BoundaryGenerator> generators;  ///< owned, in order
  std::array<std::uint64_t, 4> generatorCounts{};  ///< simplices with hex vertices, by kind
  std::array<std::uint64_t, 4> vertexCounts{};     ///< hex vertices, by kind of generator

  [[nodiscard]] std::uint64_t count() const noexcept { return begin.back(); }

  /// The first hex vertex in the interior of a simplex, by its owner and corners there.
  /// @throws Error Internal if the owner has none
  [[nodiscard]] std::uint64_t firstOf(Index owner, lattice::CornerMask simplex) const;
};

/// What a block of tets owns; collected during the sweep.
class VertexCounter {
 public:
  VertexCounter(const igm::PreparedMap& map, VertexNumbers& numbers);

  /// Counts one tet's lines; tets of a block in order, blocks in any order and in parallel.
  void count(std::size_t block, Index tet, std::span<const lattice::SweptLine> lines) {
    countNothing(tet);
    if (!lines.empty()) countSome(block, tet, lines);
  }
  /// The same for a tet without lines.
  void countNothing(Index tet) noexcept {
    numbers_.begin[tet] = 0;
    numbers_.generatorBegin[tet] = 0;
  }
  /// Turns counts into numbers.
  void finish();

 private:
  struct Block {
    std::vector<BoundaryGenerator> generators;
    std::array<std::uint64_t, 4> generatorCounts{};
    std::array<std::uint64_t, 4> vertexCounts{};
  };
  void countSome(std::size_t block, Index tet, std::span<const lattice::SweptLine> lines);
  void countBoundary(Block& block, Index tet, std::span<const lattice::SweptLine> lines);

  const igm::PreparedMap& map_;
  VertexNumbers& numbers_;
  std::vector<Block> blocks_;
};

/// All hex vertices, swept and numbered.
struct SweptVertices {
  TetLines lines;
  VertexNumbers numbers;
};

/// Sees the tets while they are swept for vertices, and may sweep them for other points. (With a
/// separate sweep for the midpoints of edges, arcs and an extraction together take 4 to 8 %
/// longer.)
class SweepObserver {
 public:
  SweepObserver() = default;
  SweepObserver(const SweepObserver&) = delete;
  SweepObserver& operator=(const SweepObserver&) = delete;
  SweepObserver(SweepObserver&&) = delete;
  SweepObserver& operator=(SweepObserver&&) = delete;
  virtual ~SweepObserver() = default;

  /// Tets of a block of kSweepBlock in order, blocks in any order and in parallel.
  virtual void add(std::size_t block, Index tet, lattice::TetRasterizer& rasterizer) = 0;
  /// Called at the end.
  virtual void take(SweptVertices vertices) = 0;
};

/// Sweeps all tets for vertices, and numbers these.
/// @param observer  sees every tet, if not null; the caller must hand it the result
/// @param epsilon   as in TetRasterizer
[[nodiscard]] SweptVertices sweepVertices(const igm::PreparedMap& map, Stage& stage,
                                          SweepObserver* observer = nullptr, double epsilon = 0);

/// Consecutive points of one line in the interior of one simplex, with consecutive numbers.
struct VertexRun {
  const lattice::SweptLine* line;
  std::uint32_t offset;  ///< of the first point in the line
  std::uint32_t count;
  lattice::CornerMask simplex;
  bool owned;           ///< by the tet
  std::uint64_t first;  ///< number of the first point
};

/// Numbers the vertices of one tet, except those in faces that another tet owns.
class TetNumbering {
 public:
  TetNumbering(const igm::PreparedMap& map, const VertexNumbers& numbers, Index tet,
               lattice::SweepAxes axes) noexcept
      : map_(map), numbers_(numbers), tet_(tet), axes_(axes) {}

  /// Calls visit(VertexRun) in sweep order.
  template <class Visit>
  void run(std::span<const lattice::SweptLine> lines, const Visit& visit) {
    Counter& inside = counter(lattice::kWholeTet);
    for (const lattice::SweptLine& line : lines) {
      if (line.allInside()) {
        visit(VertexRun{&line, 0, line.count, lattice::kWholeTet, true, inside.next});
        inside.next += line.count;
        continue;
      }
      piece(line, 0, 1, line.left, visit);
      if (line.count > 2) piece(line, 1, line.count - 2, line.inner(), visit);
      if (line.count > 1) piece(line, line.count - 1, 1, line.right, visit);
    }
  }

  /// Faces with hex vertices that another tet owns: a set of opposite corners. Known after run().
  [[nodiscard]] unsigned foreignFaces() const noexcept { return foreignFaces_; }

 private:
  struct Counter {
    std::uint64_t next = 0;
    bool known = false;
    bool owned = false;
    bool backward = false;  ///< the sweep runs against the order along an edge
    bool foreignFace = false;
  };

  Counter& counter(lattice::CornerMask simplex) {
    Counter& counter = counters_[simplex];
    if (!counter.known) start(counter, simplex);
    return counter;
  }
  void start(Counter& counter, lattice::CornerMask simplex);
  [[nodiscard]] bool sweepsBackward(lattice::CornerMask edge) const noexcept;

  template <class Visit>
  void piece(const lattice::SweptLine& line, std::uint32_t offset, std::uint32_t count,
             lattice::CornerMask simplex, const Visit& visit) {
    Counter& c = counter(simplex);
    if (c.foreignFace) return;
    if (!c.backward) {
      visit(VertexRun{&line, offset, count, simplex, c.owned, c.next});
      c.next += count;
      return;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      visit(VertexRun{&line, offset + i, 1, simplex, c.owned, c.next--});
    }
  }

  const igm::PreparedMap& map_;
  const VertexNumbers& numbers_;
  Index tet_;
  lattice::SweepAxes axes_;
  unsigned foreignFaces_ = 0;
  std::array<Counter, 16> counters_{};
};

}  // namespace hexhex::sweep
