// Writes arcs and patches as polyhedral meshes (see formats.hpp).
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/corner_range.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

namespace {

using EdgeEnds = std::array<Index, 2>;
using Integers = Array<std::int32_t>;

[[noreturn]] void failAboutMap() {
  throw Error(
      ErrorCode::InvalidArgument,
      "The arcs and patches do not lie in the tets of this map. Give the map that they were "
      "extracted from: after a repair, the repaired one.");
}

/// Numbers the simplices of the tets that generators refer to, as in the `.ovm` or `.ovmb` file of
/// their map.
class TetSimplices {
 public:
  TetSimplices(const TetMapView& map, Stage& stage)
      : tets_(requireInRange(map, stage)),
        topology_(ovmTopologyOf(map.points, map.tets, stage)),
        edges_(topology_.vertexCount, topology_.edges) {}

  /// The index of a simplex among those of its dimension.
  /// @throws Error InvalidArgument if there is no such tet
  [[nodiscard]] Index index(Index tet, CornerSet corners) const {
    if (tet >= tets_.size()) failAboutMap();
    const auto vertexOf = [&](unsigned set) {
      return tets_[tet][static_cast<std::size_t>(std::countr_zero(set))];
    };
    switch (generatorKind(corners)) {
      case GeneratorKind::Vertex:
        return vertexOf(corners);
      case GeneratorKind::Edge:
        return edges_.find(vertexOf(corners), vertexOf(corners & (corners - 1U)));
      case GeneratorKind::Face:
        return faceWithout(tet, vertexOf(15U & ~unsigned{corners}));
      case GeneratorKind::Cell:
        break;
    }
    return tet;
  }

  /// Translates a simplex from corners of one tet to corners of another that shares it.
  /// @throws Error InvalidArgument if the other tet does not have it
  [[nodiscard]] CornerSet translated(CornerSet corners, Index from, Index to) const {
    if (from == to) return corners;
    if (from >= tets_.size() || to >= tets_.size()) failAboutMap();
    unsigned result = 0;
    for (unsigned i = 0; i < 4; ++i) {
      if ((corners >> i & 1U) == 0) continue;
      const auto found = std::find(tets_[to].begin(), tets_[to].end(), tets_[from][i]);
      if (found == tets_[to].end()) failAboutMap();
      result |= 1U << static_cast<unsigned>(found - tets_[to].begin());
    }
    return static_cast<CornerSet>(result);
  }

 private:
  static std::span<const Tet> requireInRange(const TetMapView& map, Stage& stage) {
    adjacency::requireCornersInRange(map, stage);
    return map.tets;
  }

  [[nodiscard]] Index faceWithout(Index tet, Index vertex) const {
    for (const Index halfFace : topology_.cells[tet]) {
      const std::array<Index, 3> loop = loopOfFace<3>(topology_, halfFace / 2);
      if (std::find(loop.begin(), loop.end(), vertex) == loop.end()) return halfFace / 2;
    }
    return kNone;
  }

  std::span<const Tet> tets_;
  OvmTopology topology_;
  OvmEdgeFinder edges_;
};

/// Collects the simplices that contain elements, as properties.
class CarrierProperties {
 public:
  /// @param simplices  null: indices are left out
  CarrierProperties(OvmEntity entity, std::string_view typeName, std::string_view indexName,
                    const TetSimplices* simplices)
      : entity_(entity), typeName_(typeName), indexName_(indexName), simplices_(simplices) {}

  void add(Index tet, CornerSet corners) {
    types_.push_back(static_cast<std::int32_t>(generatorKind(corners)));
    if (simplices_ != nullptr) {
      indices_.push_back(static_cast<std::int32_t>(simplices_->index(tet, corners)));
    }
    tets_.push_back(static_cast<std::int32_t>(tet));
    corners_.push_back(corners);
  }
  void add(std::span<const Index> tets, std::span<const CornerSet> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) add(tets[i], corners[i]);
  }
  /// Adds an element whose simplex is unknown.
  void addUnknown() {
    for (Integers* const values : {&types_, &tets_, &corners_}) values->push_back(-1);
  }
  /// The simplex of an element, as corners of a tet that has it.
  [[nodiscard]] CornerSet simplexIn(Index tet, std::size_t element) const {
    return simplices_->translated(static_cast<CornerSet>(corners_[element]),
                                  static_cast<Index>(tets_[element]), tet);
  }

  void moveTo(std::vector<OvmProperty>& properties) {
    properties.push_back({entity_, typeName_, std::move(types_)});
    if (simplices_ != nullptr) properties.push_back({entity_, indexName_, std::move(indices_)});
    properties.push_back({entity_, "hexhex::generator_tet", std::move(tets_)});
    properties.push_back({entity_, "hexhex::generator_corners", std::move(corners_)});
  }

 private:
  OvmEntity entity_;
  std::string_view typeName_;
  std::string_view indexName_;
  const TetSimplices* simplices_;
  Integers types_;
  Integers indices_;
  Integers tets_;
  Integers corners_;
};

/// An edge: its ends in ascending order, and its number.
struct KnownEdge {
  EdgeEnds ends;
  Index number;
  [[nodiscard]] bool operator<(const KnownEdge& other) const { return ends < other.ends; }
};

EdgeEnds ascending(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Collects the content of a file and writes it.
class PiecewiseWriter {
 public:
  /// @param map  the source of the mesh, or null
  PiecewiseWriter(const PiecewiseLinearMesh& mesh, const TetMapView* map, Stage& stage)
      : mesh_(mesh),
        stage_(stage),
        simplices_(map == nullptr ? nullptr : std::make_unique<TetSimplices>(*map, stage)),
        pointCarriers_(OvmEntity::Vertex, "v_tet_generator_type", "v_tet_generator_index",
                       simplices_.get()),
        edgeCarriers_(OvmEntity::Edge, "e_tet_generator_type", "e_tet_generator_index",
                      simplices_.get()) {}

  void write(PiecewiseLinearParts parts, OutputFile& output) {
    const bool withPatches = parts == PiecewiseLinearParts::ArcsAndPatches;
    addPoints(withPatches);
    addSegments();
    if (withPatches) addPolygons();
    pointCarriers_.moveTo(content_.properties);
    content_.properties.push_back({OvmEntity::Edge, "e_linear_hex_edge", std::move(hexEdges_)});
    edgeCarriers_.moveTo(content_.properties);
    if (withPatches) addPolygonProperties();
    content_.points = points_;
    content_.topology.vertexCount = points_.size();
    content_.hasWideHandles = true;
    writeOvmb(content_, output, stage_);
  }

 private:
  [[nodiscard]] Array<EdgeEnds>& edges() { return content_.topology.edges; }

  void addPoints(bool withPatches) {
    Integers types;
    Array<std::array<double, 2>> uv;
    const auto add = [&](const auto& part, std::int32_t type) {
      points_.insert(points_.end(), part.points.begin(), part.points.end());
      types.resize(points_.size(), type);
      uv.resize(points_.size(), {0, 0});
      pointCarriers_.add(part.generatorTet, part.generatorCorners);
    };
    add(mesh_.mesh, 0);
    add(mesh_.arcs, 1);
    const std::size_t vertices = mesh_.mesh.points.size();
    const std::size_t shared = points_.size();
    for (std::size_t i = 0; i < mesh_.arcs.parameters.size(); ++i) {
      uv[vertices + i] = {mesh_.arcs.parameters[i], 0};
    }
    if (withPatches) {
      add(mesh_.patches, 2);
      for (std::size_t i = 0; i < mesh_.patches.corners.size(); ++i) {
        const Index point = mesh_.patches.corners[i];
        if (point >= shared) uv[point] = mesh_.patches.parameters[i];
      }
    }
    content_.properties.push_back({OvmEntity::Vertex, "v_type", std::move(types)});
    content_.properties.push_back({OvmEntity::Vertex, "v_igm_uv", std::move(uv)});
  }

  void addSegments() {
    const Arcs& arcs = mesh_.arcs;
    const auto vertices = static_cast<Index>(mesh_.mesh.points.size());
    for (std::size_t e = 0; e < arcs.count(); ++e) {
      Index from = arcs.ends[e][0];
      for (std::uint64_t i = arcs.pointBegin[e]; i < arcs.pointBegin[e + 1]; ++i) {
        const Index to = vertices + static_cast<Index>(i);
        edges().push_back({from, to});
        from = to;
      }
      edges().push_back({from, arcs.ends[e][1]});
      hexEdges_.resize(edges().size(), static_cast<std::int32_t>(e));
    }
    edgeCarriers_.add(arcs.segmentTet, arcs.segmentCorners);
  }

  void addPolygons() {
    const Patches& patches = mesh_.patches;
    for (std::size_t f = 0; f < patches.count(); ++f) addFace(f);
    if (!patches.polygonTet.empty()) content_.topology.faces.offsets = patches.cornerBegin;
  }

  void addPolygonProperties() {
    const Patches& patches = mesh_.patches;
    Integers tets(patches.polygonTet.size());
    std::transform(patches.polygonTet.begin(), patches.polygonTet.end(), tets.begin(),
                   [](Index tet) { return static_cast<std::int32_t>(tet); });
    Integers faces;
    for (std::size_t f = 0; f < patches.count(); ++f) {
      faces.resize(patches.polygonBegin[f + 1], static_cast<std::int32_t>(f));
    }
    content_.properties.push_back({OvmEntity::Face, "f_linear_hex_face", std::move(faces)});
    content_.properties.push_back({OvmEntity::Face, "f_intersected_tet_index", std::move(tets)});
  }

  /// Adds a side inside a face, of a polygon in this tet. By convexity, it lies in the smallest
  /// simplex that has the generators of both ends.
  Index addInnerSide(const EdgeEnds& ends, Index tet) {
    edges().push_back(ends);
    hexEdges_.push_back(-1);
    if (simplices_) {
      edgeCarriers_.add(tet, static_cast<CornerSet>(pointCarriers_.simplexIn(tet, ends[0]) |
                                                    pointCarriers_.simplexIn(tet, ends[1])));
    } else {
      edgeCarriers_.addUnknown();
    }
    return static_cast<Index>(edges().size() - 1);
  }

  /// Calls visit(from, to, polygon) for all sides of a face's polygons.
  template <class Visit>
  void forEachSide(std::size_t face, const Visit& visit) const {
    const Patches& patches = mesh_.patches;
    for (std::uint64_t p = patches.polygonBegin[face]; p < patches.polygonBegin[face + 1]; ++p) {
      const std::uint64_t begin = patches.cornerBegin[p];
      const std::uint64_t size = patches.cornerBegin[p + 1] - begin;
      for (std::uint64_t i = 0; i < size; ++i) {
        visit(patches.corners[begin + i], patches.corners[begin + (i + 1) % size], p);
      }
    }
  }

  /// Adds the polygons of a face, and the sides that are not on arcs.
  void addFace(std::size_t face) {
    const Patches& patches = mesh_.patches;
    known_.clear();
    for (const Index arc : patches.arcs[face]) {
      for (std::uint64_t s = mesh_.arcs.firstSegment(arc);
           s < mesh_.arcs.firstSegment(std::size_t{arc} + 1); ++s) {
        const EdgeEnds& ends = edges()[s];
        known_.push_back({ascending(ends[0], ends[1]), static_cast<Index>(s)});
      }
    }
    std::sort(known_.begin(), known_.end());
    const std::size_t border = known_.size();
    forEachSide(face, [&](Index a, Index b, std::uint64_t polygon) {
      const KnownEdge side{ascending(a, b), kNone};
      // Sides inside the face occur twice, once in each direction.
      const auto bordering = std::span(known_).first(border);
      if (a > b || std::binary_search(bordering.begin(), bordering.end(), side)) return;
      known_.push_back({side.ends, addInnerSide(side.ends, patches.polygonTet[polygon])});
    });
    std::sort(known_.begin(), known_.end());
    forEachSide(face, [&](Index a, Index b, std::uint64_t /*polygon*/) {
      const auto edge =
          std::lower_bound(known_.begin(), known_.end(), KnownEdge{ascending(a, b), kNone});
      const bool along = edges()[edge->number][0] == a;
      content_.topology.faces.handles.push_back(2 * edge->number + (along ? 0 : 1));
    });
  }

  const PiecewiseLinearMesh& mesh_;
  Stage& stage_;
  std::unique_ptr<const TetSimplices> simplices_;
  CarrierProperties pointCarriers_;
  CarrierProperties edgeCarriers_;
  std::vector<Vec3> points_;
  OvmOutput content_;
  Integers hexEdges_;
  std::vector<KnownEdge> known_;  ///< edges of the current face
};

/// @param most  upper bound on the number of elements of any kind
void write(const PiecewiseLinearMesh& mesh, const TetMapView* map, PiecewiseLinearParts parts,
           std::uint64_t most, OutputFile& output, Stage& stage) {
  requireInt32(most, "OpenVolumeMesh files number elements", "lower the scale, or write .vtu");
  withThreads(stage.context().threads(),
              [&] { PiecewiseWriter(mesh, map, stage).write(parts, output); });
}

}  // namespace

void writeArcsOvmb(const PiecewiseLinearMesh& mesh, const TetMapView* map, OutputFile& output,
                   Stage& stage) {
  // Arcs have more segments than inner points.
  const std::uint64_t most =
      std::max(mesh.mesh.points.size() + mesh.arcs.points.size(), mesh.arcs.segmentTet.size());
  write(mesh, map, PiecewiseLinearParts::Arcs, 2 * most, output, stage);
}

void writePatchesOvmb(const PiecewiseLinearMesh& mesh, const TetMapView* map, OutputFile& output,
                      Stage& stage) {
  write(mesh, map, PiecewiseLinearParts::ArcsAndPatches, 2 * mesh.patches.corners.size(), output,
        stage);
}

}  // namespace hexhex::io
