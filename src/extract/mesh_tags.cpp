// Tags of hex edges and faces, found where these begin (holder and casing, Sections 5.3.2 and
// 5.3.3).
#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <vector>

#include <base/sorted.hpp>
#include <extract/mesh_tags.hpp>
#include <sweep/cell_order.hpp>
#include <sweep/cell_tracer.hpp>

namespace hexhex::extraction {

namespace {

constexpr std::size_t kFeaturesGrain = std::size_t{1} << 14;

/// Tagged edges or triangles of the tet mesh, found by their vertices.
/// @tparam n  vertices of a simplex: 2 or 3
template <std::size_t n>
class TagTable {
 public:
  /// @param features  those with tag 0 are ignored
  template <class Feature>
  explicit TagTable(std::span<const Feature> features) {
    for (const Feature& feature : features) {
      if (feature.tag != 0) entries_.push_back({sorted(feature.vertices), feature.tag});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.simplex != b.simplex ? a.simplex < b.simplex : a.tag < b.tag;
    });
  }

  /// The tag of a tet's simplex; 0 if it has none, or another number of corners.
  [[nodiscard]] std::int32_t find(const Tet& tet, lattice::CornerMask simplex) const {
    if (lattice::dimension(simplex) != static_cast<int>(n) - 1) return 0;
    Simplex wanted{};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (lattice::contains(simplex, static_cast<int>(i))) wanted[k++] = tet[i];
    }
    wanted = sorted(wanted);
    const auto found = std::lower_bound(
        entries_.begin(), entries_.end(), wanted,
        [](const Entry& entry, const Simplex& key) { return entry.simplex < key; });
    return found != entries_.end() && found->simplex == wanted ? found->tag : 0;
  }

  /// @throws Error InvalidArgument if a simplex has two tags
  void requireOne() const {
    const auto twice = std::adjacent_find(
        entries_.begin(), entries_.end(),
        [](const Entry& a, const Entry& b) { return a.simplex == b.simplex && a.tag != b.tag; });
    if (twice == entries_.end()) return;
    std::string vertices;
    for (const Index v : twice->simplex) {
      if (!vertices.empty()) vertices += '-';
      vertices += std::to_string(v);
    }
    throw Error(ErrorCode::InvalidArgument,
                std::string(n == 2 ? "The edge " : "The triangle ") + vertices +
                    " is tagged twice, " + std::to_string(twice->tag) + " and " +
                    std::to_string((twice + 1)->tag) + ". Give it one tag.");
  }

 private:
  using Simplex = std::array<Index, n>;
  struct Entry {
    Simplex simplex;
    std::int32_t tag;
  };

  std::vector<Entry> entries_;  ///< ascending
};

/// A hex vertex may be the beginning of a tagged edge, or the corner of a tagged face.
using Mark = std::uint8_t;
constexpr Mark kAtEdges = 1;
constexpr Mark kAtFaces = 2;

/// Per hex vertex: whether all vertices of its generator belong to tagged edges, or faces. A ray or
/// quarter plane that leads into a simplex begins at a vertex in the closure of that simplex.
class Marks {
 public:
  Marks(const TetMapView& given, const HexMesh& mesh, Stage& stage)
      : ofPoint_(given.points.size(), Mark{0}), ofVertex_(mesh.points.size()) {
    for (const FeatureEdge& edge : given.features.edges) mark(edge.vertices, edge.tag, kAtEdges);
    for (const FeatureFace& face : given.features.faces) mark(face.vertices, face.tag, kAtFaces);
    parallelFor(stage, mesh.points.size(), kFeaturesGrain, [&](std::size_t v) {
      const CornerSet corners = mesh.generatorCorners[v];
      ofVertex_[v] = corners == lattice::kWholeTet
                         ? Mark{0}
                         : common(given.tets[mesh.generatorTet[v]], corners);
    });
  }

  [[nodiscard]] Mark operator[](Index vertex) const noexcept { return ofVertex_[vertex]; }

 private:
  template <class Vertices>
  void mark(const Vertices& vertices, std::int32_t tag, Mark bit) {
    if (tag == 0) return;
    for (const Index v : vertices) ofPoint_[v] = static_cast<Mark>(ofPoint_[v] | bit);
  }
  [[nodiscard]] Mark common(const Tet& tet, CornerSet corners) const noexcept {
    Mark common = kAtEdges | kAtFaces;
    for (std::size_t i = 0; i < 4; ++i) {
      if (lattice::contains(corners, static_cast<int>(i))) {
        common = static_cast<Mark>(common & ofPoint_[tet[i]]);
      }
    }
    return common;
  }

  std::vector<Mark> ofPoint_;
  Array<Mark> ofVertex_;
};

/// What the cells of a block of tets see; elements shared by several cells occur repeatedly.
struct Seen {
  /// An edge from its smaller vertex to its larger one, and the end from which its tag was seen.
  struct Edge {
    std::array<Index, 2> vertices;
    bool fromLarger;
    std::int32_t tag;
  };
  std::vector<Edge> edges;
  std::vector<FeatureQuad> quads;
};

/// Position of the corner at an offset in kCellCorners: its inverse.
constexpr std::array<std::uint8_t, 8> kCornerAt = {0, 1, 3, 2, 4, 5, 7, 6};

constexpr std::size_t cornerAt(const lattice::GridPoint& offset) noexcept {
  const std::int32_t code = offset[0] + 2 * offset[1] + 4 * offset[2];
  assert(code >= 0 && code < 8);
  return kCornerAt[static_cast<std::size_t>(code)];
}

constexpr std::size_t neighbour(std::size_t corner, std::size_t axis) noexcept {
  lattice::GridPoint offset = lattice::kCellCorners[corner];
  offset[axis] = 1 - offset[axis];
  return cornerAt(offset);
}

/// Examines one cell after the other. One per thread.
class CellViewer {
 public:
  CellViewer(const TetMapView& given, const igm::PreparedMap& prepared, const HexMesh& mesh,
             const TagTable<2>& edgeTags, const TagTable<3>& faceTags, const Marks& marks)
      : given_(given),
        prepared_(prepared),
        mesh_(mesh),
        edgeTags_(edgeTags),
        faceTags_(faceTags),
        marks_(marks),
        tracer_(prepared) {}

  /// @param tet, z, generator  as for CellTracer::enter()
  void view(const Hex& cell, Index tet, const lattice::GridPoint& z, lattice::CornerMask generator,
            Seen& seen) {
    Mark any = 0;
    for (const Index vertex : cell) any = static_cast<Mark>(any | marks_[vertex]);
    if (any == 0) return;
    tracer_.enter(tet, z, generator);
    if ((any & kAtEdges) != 0) viewEdges(cell, seen);
    if ((any & kAtFaces) != 0) viewFaces(cell, seen);
  }

 private:
  void viewEdges(const Hex& cell, Seen& seen) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (std::uint8_t axis = 0; axis < 3; ++axis) {
        const std::size_t other = neighbour(corner, axis);
        if (cell[corner] > cell[other]) continue;
        std::int32_t tag = edgeTag(cell, corner, axis);
        const bool fromLarger = tag == 0;
        if (fromLarger) tag = edgeTag(cell, other, axis);
        if (tag != 0) seen.edges.push_back({{cell[corner], cell[other]}, fromLarger, tag});
      }
    }
  }

  /// The tag of the edge along an axis, seen from a corner.
  std::int32_t edgeTag(const Hex& cell, std::size_t corner, std::uint8_t axis) {
    if ((marks_[cell[corner]] & kAtEdges) == 0) return 0;
    const auto second = static_cast<std::uint8_t>((axis + 1) % 3);
    const auto third = static_cast<std::uint8_t>((axis + 2) % 3);
    const Beginning at = begin(cell, corner, {axis, second, third});
    return edgeTags_.find(prepared_.topology.tets[at.tet],
                          lattice::holder(at.signs, at.simplex, at.first));
  }

  void viewFaces(const Hex& cell, Seen& seen) {
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      for (std::int32_t side = 0; side < 2; ++side) {
        lattice::GridPoint offset{};
        offset[axis] = side;
        viewFace(cell, axis, cornerAt(offset), seen);
      }
    }
  }

  /// @param normal  axis of the face; @param corner  any of its corners
  void viewFace(const Hex& cell, std::uint8_t normal, std::size_t corner, Seen& seen) {
    const auto u = static_cast<std::uint8_t>((normal + 1) % 3);
    const auto v = static_cast<std::uint8_t>((normal + 2) % 3);
    const std::size_t next = neighbour(corner, u);
    std::array<std::size_t, 4> corners = {corner, next, neighbour(next, v), neighbour(corner, v)};
    const auto bySmaller = [&cell](std::size_t a, std::size_t b) { return cell[a] < cell[b]; };
    const auto smallest = std::min_element(corners.begin(), corners.end(), bySmaller);
    std::rotate(corners.begin(), smallest, corners.end());
    if (cell[corners[3]] < cell[corners[1]]) std::swap(corners[1], corners[3]);
    const Quad quad = {cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]]};
    std::sort(corners.begin(), corners.end(), bySmaller);
    for (const std::size_t at : corners) {
      if ((marks_[cell[at]] & kAtFaces) == 0) continue;
      const bool uFirst = cell[neighbour(at, u)] < cell[neighbour(at, v)];
      std::int32_t tag = faceTag(cell, at, {uFirst ? u : v, uFirst ? v : u, normal});
      if (tag == 0) tag = faceTag(cell, at, {uFirst ? v : u, uFirst ? u : v, normal});
      if (tag == 0) continue;
      seen.quads.push_back({quad, tag});
      return;
    }
  }

  /// The tag of the face across the third axis, seen from a corner beside the edge along the first.
  std::int32_t faceTag(const Hex& cell, std::size_t corner, const sweep::TiltOrder& axes) {
    const Beginning at = begin(cell, corner, axes);
    return faceTags_.find(prepared_.topology.tets[at.tet],
                          lattice::casing(at.signs, at.simplex, at.first, at.second));
  }

  /// Where an edge and a face of the cell begin, in a tet that contains both beginnings.
  struct Beginning {
    Index tet;
    lattice::NormalSigns signs;
    lattice::CornerMask simplex;  ///< generator of the hex vertex
    lattice::Direction first;
    lattice::Direction second;
  };

  Beginning begin(const Hex& cell, std::size_t corner, const sweep::TiltOrder& axes) {
    const lattice::GridPoint& offset = lattice::kCellCorners[corner];
    const sweep::CornerPlace place = tracer_.trace(offset, axes);
    const auto into = [&](std::uint8_t axis) {
      return place.rotation(lattice::direction(axis, 1 - 2 * offset[axis]));
    };
    return {place.tet, lattice::NormalSigns(prepared_.exact.corners[place.tet]),
            generatorIn(place.tet, cell[corner]), into(axes[0]), into(axes[1])};
  }

  [[nodiscard]] lattice::CornerMask generatorIn(Index tet, Index vertex) const {
    const Tet& owner = given_.tets[mesh_.generatorTet[vertex]];
    lattice::CornerMask simplex = lattice::kNoSimplex;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!lattice::contains(mesh_.generatorCorners[vertex], static_cast<int>(i))) continue;
      simplex = static_cast<lattice::CornerMask>(
          simplex | lattice::cornerBit(prepared_.topology.localCorner(tet, owner[i])));
    }
    return simplex;
  }

  const TetMapView& given_;
  const igm::PreparedMap& prepared_;
  const HexMesh& mesh_;
  const TagTable<2>& edgeTags_;
  const TagTable<3>& faceTags_;
  const Marks& marks_;
  sweep::CellTracer tracer_;
};

std::vector<FeatureVertex> tagVertices(const TetMapView& given, const HexMesh& mesh, Stage& stage) {
  std::vector<std::int32_t> tagOf(given.points.size(), 0);
  for (const FeatureVertex& feature : given.features.vertices) {
    tagOf[feature.vertex] = feature.tag;
  }
  return collectFromBlocks<FeatureVertex>(
      stage, mesh.points.size(), kFeaturesGrain,
      [&](std::size_t begin, std::size_t end, std::vector<FeatureVertex>& tagged) {
        for (std::size_t v = begin; v < end; ++v) {
          const CornerSet corners = mesh.generatorCorners[v];
          if (lattice::dimension(corners) != 0) continue;
          const Tet& tet = given.tets[mesh.generatorTet[v]];
          const std::int32_t tag = tagOf[tet[lattice::firstCorner(corners)]];
          if (tag != 0) tagged.push_back({static_cast<Index>(v), tag});
        }
      });
}

/// One entry per edge: the one seen from the smaller vertex, if there is one.
std::vector<FeatureEdge> uniqueEdges(std::vector<Seen::Edge> seen) {
  std::sort(seen.begin(), seen.end(), [](const Seen::Edge& a, const Seen::Edge& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.fromLarger < b.fromLarger;
  });
  std::vector<FeatureEdge> edges;
  for (const Seen::Edge& edge : seen) {
    if (!edges.empty() && edges.back().vertices == edge.vertices) continue;
    edges.push_back({edge.vertices, edge.tag});
  }
  return edges;
}

/// Both cells at a face see the same tag.
std::vector<FeatureQuad> uniqueQuads(std::vector<FeatureQuad> quads) {
  std::sort(quads.begin(), quads.end(),
            [](const FeatureQuad& a, const FeatureQuad& b) { return a.vertices < b.vertices; });
  quads.erase(std::unique(quads.begin(), quads.end()), quads.end());
  return quads;
}

void tagEdgesAndQuads(const TetMapView& given, const igm::PreparedMap& prepared,
                      const TaggedCells& cells, HexMesh& mesh, Stage& stage) {
  const TagTable<2> edgeTags(given.features.edges);
  const TagTable<3> faceTags(given.features.faces);
  const Marks marks(given, mesh, stage);
  std::vector<std::vector<Seen::Edge>> edges(blockCount(cells.groups, sweep::kSweepBlock));
  std::vector<std::vector<FeatureQuad>> quads(edges.size());
  parallelBlocks(stage, cells.groups, sweep::kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   CellViewer viewer(given, prepared, mesh, edgeTags, faceTags, marks);
                   Seen seen;
                   for (std::size_t group = begin; group < end; ++group) {
                     cells.forEach(group,
                                   [&](std::uint64_t cell, Index tet, const lattice::GridPoint& z,
                                       lattice::CornerMask simplex) {
                                     viewer.view(mesh.cells[cell], tet, z, simplex, seen);
                                   });
                   }
                   edges[block] = std::move(seen.edges);
                   quads[block] = std::move(seen.quads);
                 });
  mesh.features.edges = uniqueEdges(joined<Seen::Edge>(edges));
  mesh.features.quads = uniqueQuads(joined<FeatureQuad>(quads));
}

/// All cells, by tet.
TaggedCells allCells(const igm::PreparedMap& prepared, const sweep::CellCenters& centers) {
  return {prepared.topology.tetCount(), [&](std::size_t t, const TaggedCells::Visit& visit) {
            const auto tet = static_cast<Index>(t);
            std::uint64_t cell = centers.begin[t];
            if (cell == centers.begin[t + 1]) return;
            sweep::forEachOwnedCenter(prepared.topology, tet, centers.lines->of(tet),
                                      [&](const lattice::SweptLine& line, std::uint32_t i) {
                                        visit(cell++, tet, line.point(i), line.simplex(i));
                                      });
          }};
}

void fillRegions(const TetMapView& given, const sweep::CellCenters& centers, HexMesh& mesh,
                 Stage& stage) {
  mesh.regions.resize(mesh.cells.size());
  parallelFor(stage, given.tets.size(), kFeaturesGrain, [&](std::size_t t) {
    std::fill(mesh.regions.begin() + static_cast<std::ptrdiff_t>(centers.begin[t]),
              mesh.regions.begin() + static_cast<std::ptrdiff_t>(centers.begin[t + 1]),
              given.regions[t]);
  });
}

void requireValidVertices(const TetMapView& map) {
  std::vector<FeatureVertex> tagged;
  for (const FeatureVertex& feature : map.features.vertices) {
    if (feature.tag != 0) tagged.push_back(feature);
  }
  std::sort(tagged.begin(), tagged.end(),
            [](const FeatureVertex& a, const FeatureVertex& b) { return a.vertex < b.vertex; });
  const auto conflict = std::adjacent_find(tagged.begin(), tagged.end(),
                                           [](const FeatureVertex& a, const FeatureVertex& b) {
                                             return a.vertex == b.vertex && a.tag != b.tag;
                                           });
  if (conflict == tagged.end()) return;
  throw Error(ErrorCode::InvalidArgument,
              "Vertex " + std::to_string(conflict->vertex) + " is tagged twice, " +
                  std::to_string(conflict->tag) + " and " + std::to_string((conflict + 1)->tag) +
                  ". Give each vertex one tag.",
              {PlaceKind::Vertex, conflict->vertex});
}

}  // namespace

void requireValidTags(const TetMapView& map) {
  requireValidVertices(map);
  TagTable<2>(map.features.edges).requireOne();
  TagTable<3>(map.features.faces).requireOne();
}

void carryTags(const TetMapView& given, const igm::PreparedMap& prepared, HexMesh& mesh,
               Context& context) {
  const bool byCells = !given.features.edges.empty() || !given.features.faces.empty();
  if (given.features.empty() && given.regions.empty()) return;
  Stage stage(context, "features");
  mesh.features.names.assign(given.features.names.begin(), given.features.names.end());
  if (!given.features.vertices.empty()) mesh.features.vertices = tagVertices(given, mesh, stage);
  if (!byCells && given.regions.empty()) return;
  const sweep::CellCenters centers = sweep::findCells(prepared, stage);
  if (byCells) tagEdgesAndQuads(given, prepared, allCells(prepared, centers), mesh, stage);
  if (!given.regions.empty()) fillRegions(given, centers, mesh, stage);
}

void carryFeatures(const TetMapView& given, const igm::PreparedMap& prepared,
                   const TaggedCells& cells, HexMesh& mesh, Stage& stage) {
  if (!given.features.vertices.empty()) mesh.features.vertices = tagVertices(given, mesh, stage);
  if (given.features.edges.empty() && given.features.faces.empty()) return;
  tagEdgesAndQuads(given, prepared, cells, mesh, stage);
}

}  // namespace hexhex::extraction
