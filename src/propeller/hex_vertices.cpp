#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <propeller/hex_vertices.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 512;

/// All proper simplices of a tet, by dimension, then mask: the order of generators of one owner.
constexpr std::array<CornerMask, 15> kSimplices = {1,  2,  4, 8,  3,  5,  6, 9,
                                                   10, 12, 7, 11, 13, 14, 15};

/// Number of grid points by simplex.
using SimplexCounts = std::array<Index, 16>;

/// What one block of tets yields; joined afterwards.
struct BlockRaster {
  std::vector<LatticeLines::Plane> planes;
  std::vector<LatticeLines::Line> lines;
  std::vector<Generator> generators;
  std::uint64_t points = 0;
  std::uint64_t vertices = 0;
  std::uint64_t incidences = 0;
};

/// Receives the lines of one tet.
class RasterSink {
 public:
  explicit RasterSink(BlockRaster& block) : block_(block) {}

  void plane(std::int32_t firstLine) {
    block_.planes.push_back({firstLine, static_cast<Index>(block_.lines.size())});
  }
  void line(const GridLine& line) {
    block_.lines.push_back(
        {line.first, static_cast<Index>(block_.points), line.left, line.inner, line.right});
    if (line.count == 0) return;
    block_.points += static_cast<std::uint64_t>(line.count);
    ++counts_[line.left];
    if (line.count > 1) ++counts_[line.right];
    if (line.count > 2) counts_[line.inner] += static_cast<Index>(line.count - 2);
    found_ = true;
  }

  [[nodiscard]] bool found() const noexcept { return found_; }
  [[nodiscard]] const SimplexCounts& counts() const noexcept { return counts_; }

 private:
  BlockRaster& block_;
  SimplexCounts counts_{};
  bool found_ = false;
};

/// First pass: lines of all tets, and which simplices are generators.
class Rasterization {
 public:
  Rasterization(const PreparedMap& map, double epsilon, HexVertices& result)
      : map_(map),
        epsilon_(epsilon),
        result_(result),
        blocks_(blockCount(map.topology.tetCount(), kGrain)) {}

  void run(Stage& stage) {
    const std::size_t tets = map_.topology.tetCount();
    result_.lines.sweeps.resize(tets);
    result_.lines.planeBegin.resize(tets + 1);
    result_.generatorBegin.resize(tets + 1);
    result_.incidenceBegin.resize(tets + 1);
    result_.lines.planeBegin[tets] = 0;
    result_.generatorBegin[tets] = 0;
    result_.incidenceBegin[tets] = 0;
    parallelBlocks(stage, tets, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
      for (std::size_t t = begin; t < end; ++t) {
        rasterize(static_cast<Index>(t), blocks_[block]);
      }
    });
    join(stage);
  }

 private:
  void rasterize(Index tet, BlockRaster& block) {
    const LatticeTet& corners = map_.exact.corners[tet];
    const GridBox box = gridBox(corners, map_.exact.unit);
    const std::size_t planesBefore = block.planes.size();
    const std::size_t linesBefore = block.lines.size();
    const std::size_t generatorsBefore = block.generators.size();
    Index incidences = 0;
    if (!box.empty()) {
      const SweepAxes axes = chooseSweepAxes(box);
      result_.lines.sweeps[tet] = {box.range[axes()[0]].first, axes};
      RasterSink sink(block);
      TetRasterizer(corners, map_.exact.unit, box, axes, epsilon_).run(sink);
      if (sink.found()) {
        incidences = listGenerators(tet, sink.counts(), block);
      } else {
        block.planes.resize(planesBefore);
        block.lines.resize(linesBefore);
      }
    }
    result_.lines.planeBegin[tet] = static_cast<Index>(block.planes.size() - planesBefore);
    result_.generatorBegin[tet] = static_cast<Index>(block.generators.size() - generatorsBefore);
    result_.incidenceBegin[tet] = incidences;
    block.incidences += incidences;
  }

  /// Appends the generators that the tet owns; returns the number of generators on its boundary.
  Index listGenerators(Index tet, const SimplexCounts& counts, BlockRaster& block) const {
    Index incidences = 0;
    for (const CornerMask simplex : kSimplices) {
      if (counts[simplex] == 0) continue;
      if (simplex != kWholeTet) ++incidences;
      if (!ownsSimplex(map_.topology, tet, simplex)) continue;
      block.generators.push_back({tet, 0, counts[simplex], simplex});
      block.vertices += counts[simplex];
    }
    return incidences;
  }

  static void requireFit(std::uint64_t count, const char* what) {
    if (count < kNone) return;
    throw Error(ErrorCode::TooLarge, "The mesh would have " + std::to_string(count) + " " + what +
                                         ", more than the 4,294,967,294 that 32-bit indices can "
                                         "number. Lower the scale.");
  }

  void join(Stage& stage) {
    exclusiveScan(std::span(result_.lines.planeBegin));
    exclusiveScan(std::span(result_.generatorBegin));
    exclusiveScan(std::span(result_.incidenceBegin));
    // Offsets of each block in the joined arrays.
    struct Offsets {
      std::uint64_t planes = 0;
      std::uint64_t lines = 0;
      std::uint64_t points = 0;
      std::uint64_t generators = 0;
      std::uint64_t vertices = 0;
      std::uint64_t incidences = 0;
    };
    std::vector<Offsets> offsets(blocks_.size() + 1);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Offsets& o = offsets[b];
      offsets[b + 1] = {
          o.planes + blocks_[b].planes.size(), o.lines + blocks_[b].lines.size(),
          o.points + blocks_[b].points,        o.generators + blocks_[b].generators.size(),
          o.vertices + blocks_[b].vertices,    o.incidences + blocks_[b].incidences};
    }
    const Offsets& total = offsets.back();
    requireFit(total.vertices, "vertices");
    requireFit(total.points, "vertex references in tets");
    requireFit(total.lines + 1, "lines of vertices in tets");
    LatticeLines& lines = result_.lines;
    lines.planes.resize(total.planes + 1);
    lines.lines.resize(total.lines + 1);
    lines.vertices.resize(total.points);
    result_.generators.resize(total.generators);
    result_.incidences.resize(total.incidences);
    result_.positions.resize(total.vertices);
    result_.generatorOf.resize(total.vertices);
    lines.planes[total.planes] = {0, static_cast<Index>(total.lines)};
    lines.lines[total.lines] = {0, static_cast<Index>(total.points), 0, 0, 0};
    parallelFor(stage, blocks_.size(), 1, [&](std::size_t b) {
      const Offsets& o = offsets[b];
      BlockRaster& block = blocks_[b];
      for (std::size_t i = 0; i < block.planes.size(); ++i) {
        LatticeLines::Plane plane = block.planes[i];
        plane.lineBegin += static_cast<Index>(o.lines);
        lines.planes[o.planes + i] = plane;
      }
      for (std::size_t i = 0; i < block.lines.size(); ++i) {
        LatticeLines::Line line = block.lines[i];
        line.pointBegin += static_cast<Index>(o.points);
        lines.lines[o.lines + i] = line;
      }
      std::uint64_t vertex = o.vertices;
      for (std::size_t i = 0; i < block.generators.size(); ++i) {
        Generator generator = block.generators[i];
        generator.firstVertex = static_cast<Index>(vertex);
        vertex += generator.vertexCount;
        result_.generators[o.generators + i] = generator;
      }
      block = BlockRaster();  // gives its memory back early
    });
  }

  const PreparedMap& map_;
  double epsilon_;
  HexVertices& result_;
  std::vector<BlockRaster> blocks_;
};

/// Second pass: numbers and positions.
class Numbering {
 public:
  Numbering(const PreparedMap& map, HexVertices& result) : map_(map), result_(result) {}

  void run(Stage& stage) {
    const std::size_t tets = map_.topology.tetCount();
    parallelFor(stage, tets, kGrain, [&](std::size_t t) { number(static_cast<Index>(t)); });
    // Points in faces of another owner: only now has the owner all its numbers.
    parallelFor(stage, tets, kGrain, [&](std::size_t t) { numberForeign(static_cast<Index>(t)); });
  }

 private:
  /// How the points of one simplex of a tet are numbered.
  struct Counter {
    Index generator = kNone;
    Index next = 0;
    bool known = false;
    bool owned = false;
    bool backward = false;  ///< the sweep runs against the order along an edge
    bool foreignFace = false;
  };

  [[nodiscard]] Index findGenerator(Index owner, CornerMask simplex) const {
    const Index end = result_.generatorBegin[owner + 1];
    for (Index g = result_.generatorBegin[owner]; g < end; ++g) {
      if (result_.generators[g].simplex == simplex) return g;
    }
    throw MissingVertex{owner};  // the owner overlooked what its neighbour saw
  }

  [[nodiscard]] Counter makeCounter(Index tet, CornerMask simplex) const {
    const Index owner = ownerTet(map_.topology, tet, simplex);
    Counter counter;
    counter.known = true;
    counter.owned = owner == tet;
    counter.generator = findGenerator(owner, map_.topology.translated(simplex, tet, owner));
    counter.next = result_.generators[counter.generator].firstVertex;
    counter.foreignFace = !counter.owned && dimension(simplex) == 2;
    if (dimension(simplex) == 1 && sweepsBackward(tet, simplex)) {
      counter.backward = true;
      counter.next += result_.generators[counter.generator].vertexCount - 1;
    }
    return counter;
  }

  /// Whether the tet's sweep meets the points of an edge from the larger vertex to the smaller.
  [[nodiscard]] bool sweepsBackward(Index tet, CornerMask edge) const {
    const std::size_t a = firstCorner(edge);
    const std::size_t b = lastCorner(edge);
    const LatticeTet& corners = map_.exact.corners[tet];
    LatticePoint along = corners[b] - corners[a];
    if (map_.topology.tets[tet][a] > map_.topology.tets[tet][b]) along = corners[a] - corners[b];
    for (const std::uint8_t axis : result_.lines.sweeps[tet].axes()) {
      if (along[axis] != 0) return along[axis] < 0;
    }
    return false;
  }

  void number(Index tet) {
    if (result_.lines.empty(tet)) return;
    std::array<Counter, 16> counters{};
    Index incidence = result_.incidenceBegin[tet];
    const TetPositions positions(map_, tet, gridBox(map_.exact.corners[tet], map_.exact.unit),
                                 result_.lines.sweeps[tet].axes);
    result_.lines.forEachPoint(tet, [&](const GridPoint& z, CornerMask simplex, Index point) {
      Counter& counter = counters[simplex];
      if (!counter.known) {
        counter = makeCounter(tet, simplex);
        if (simplex != kWholeTet) {
          GeneratorIncidence& entry = result_.incidences[incidence++];
          entry.generator = counter.generator;
          entry.simplex = simplex;
          entry.propeller.fill(kNoPropeller);
        }
      }
      if (counter.foreignFace) return;
      const Index vertex = counter.backward ? counter.next-- : counter.next++;
      const Generator& generator = result_.generators[counter.generator];
      if (vertex - generator.firstVertex >= generator.vertexCount) throw MissingVertex{tet};
      result_.lines.vertices[point] = vertex;
      if (!counter.owned) return;
      result_.generatorOf[vertex] = counter.generator;
      result_.positions[vertex] = positions.at(simplex, z);
    });
  }

  void numberForeign(Index tet) {
    for (Index i = result_.incidenceBegin[tet]; i < result_.incidenceBegin[tet + 1]; ++i) {
      const GeneratorIncidence& incidence = result_.incidences[i];
      const Index owner = result_.generators[incidence.generator].tet;
      if (dimension(incidence.simplex) != 2 || owner == tet) continue;
      const int face = oppositeCorner(incidence.simplex);
      const Transition& toOwner = map_.exact.transitions.across(halfFaceOf(tet, face));
      result_.lines.forEachPoint(tet, [&](const GridPoint& z, CornerMask simplex, Index point) {
        if (simplex != incidence.simplex) return;
        result_.lines.vertices[point] = result_.lines.find(owner, toOwner(z));
      });
    }
  }

  const PreparedMap& map_;
  HexVertices& result_;
};

}  // namespace

HexVertices extractVertices(const PreparedMap& map, double epsilon, Stage& stage) {
  HexVertices result;
  Rasterization(map, epsilon, result).run(stage);
  Numbering(map, result).run(stage);
  return result;
}

}  // namespace hexhex
