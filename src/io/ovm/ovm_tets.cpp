// From a polyhedral mesh to a map on tets (see ovm_cells.hpp).
#include <algorithm>
#include <bit>
#include <cmath>

#include <hexhex/error.hpp>

#include <base/bits.hpp>
#include <base/parallel.hpp>
#include <io/ovm/ovm_cells.hpp>

namespace hexhex {
namespace {

/// Whether four different numbers from 0 to 3 are an even permutation.
bool isEven(const std::array<std::uint8_t, 4>& order) {
  int inversions = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j] ? 1 : 0;
  }
  return inversions % 2 == 0;
}

/// Makes tets out of a mesh's cells, with all that belongs to their corners and faces.
class TetReader {
 public:
  TetReader(OvmMesh&& mesh, const std::string& fileName, Stage& stage)
      : mesh_(std::move(mesh)),
        topology_(mesh_.topology),
        properties_(mesh_.properties),
        fileName_(fileName),
        stage_(stage),
        loops_(topology_, stage) {}

  TetMap read();
  TetCells readWithoutMap();

 private:
  void requireMap() const;
  void readTets();
  [[nodiscard]] bool readTet(std::size_t cell);
  [[nodiscard]] bool isFinite(std::size_t cell) const;
  void readRotations();
  [[nodiscard]] bool readRotationsOf(std::size_t cell);
  void readEdgeValences();
  void readFeatures();
  /// The corner that half-face s of a cell's list is opposite.
  [[nodiscard]] std::size_t opposite(std::size_t cell, std::size_t s) const {
    return (opposites_[cell] >> (2 * s)) & 3U;
  }

  OvmMesh mesh_;
  const OvmTopology& topology_;
  const OvmProperties& properties_;
  const std::string& fileName_;
  Stage& stage_;
  OvmLoops<3> loops_;
  Array<std::uint8_t> opposites_;  ///< per cell: two bits for each half-face
  TetMap map_;
};

TetMap TetReader::read() {
  requireProperCells(topology_, loops_, 4, fileName_, "tetrahedra", stage_);
  requireMap();
  map_.points.assign(mesh_.points.begin(), mesh_.points.end());
  readTets();
  if (!properties_[OvmInteger::Transition].empty()) readRotations();
  readEdgeValences();
  readFeatures();
  return std::move(map_);
}

TetCells TetReader::readWithoutMap() {
  requireProperCells(topology_, loops_, 4, fileName_, "tetrahedra", stage_);
  mesh_.properties.parametrization.clear();
  readTets();
  TetCells result;
  result.points = std::move(mesh_.points);
  result.cells.assign(map_.tets.begin(), map_.tets.end());
  return result;
}

void TetReader::requireMap() const {
  if (!properties_.parametrization.empty() || topology_.cells.size() == 0) return;
  const std::string name = "\"" + std::string(kParametrizationName) + "\"";
  throw Error(
      ErrorCode::FileUnsupported,
      fileName_ + ": the file holds " + std::to_string(topology_.cells.size()) +
          " tets, but no map: " +
          (mesh_.hasForeignParametrization
               ? "its property " + name +
                     " is not one of half-faces with three numbers each (3d, vec3d)."
               : "it has no property " + name + " of half-faces (3d, vec3d).") +
          " Save the map under this name, the value of a half-face being the parameters "
          "of the vertex opposite it in its cell, or save it as .hexex; or give the map as a "
          "second mesh (--polycube).");
}

bool TetReader::readTet(std::size_t cell) {
  const std::span<const Index> halfFaces = topology_.cells[cell];
  std::array<std::array<Index, 3>, 4> loops;
  for (std::size_t s = 0; s < 4; ++s) loops[s] = loops_.ofHalfFace(halfFaces[s]);
  OvmTet tet;
  if (!assembleTet(loops, tet)) return false;
  std::array<std::uint8_t, 4> order = kTetOrders[0];
  if (const auto& orders = properties_[OvmInteger::CornerOrder]; !orders.empty()) {
    if (orders[cell] < 0 || static_cast<std::size_t>(orders[cell]) >= kTetOrders.size()) {
      return false;
    }
    order = kTetOrders[static_cast<std::size_t>(orders[cell])];
  }
  std::array<std::uint8_t, 4> place{};  // of each assembled corner in the listed tet
  for (std::uint8_t i = 0; i < 4; ++i) {
    place[order[i]] = i;
    map_.tets[cell][i] = tet.corners[order[i]];
  }
  unsigned opposites = 0;
  for (std::size_t s = 0; s < 4; ++s) {
    const unsigned corner = place[tet.opposite[s]];
    opposites |= corner << (2 * s);
    if (properties_.parametrization.empty()) continue;  // only the tets are wanted
    map_.parameters[cell][corner] = properties_.parametrization[halfFaces[s]];
  }
  opposites_[cell] = static_cast<std::uint8_t>(opposites);
  return true;
}

bool TetReader::isFinite(std::size_t cell) const {
  const TetParameters& corners = map_.parameters[cell];
  return std::all_of(corners.begin(), corners.end(), [](const Vec3& corner) {
    return std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
  });
}

void TetReader::readTets() {
  const std::size_t cells = topology_.cells.size();
  map_.tets.resize(cells);
  map_.parameters.resize(cells);
  opposites_.resize(cells);
  const std::size_t fault = firstFault(
      stage_, cells, [this](std::size_t cell) { return readTet(cell) && isFinite(cell); });
  if (fault == cells) return;
  const Place place{PlaceKind::Tet, fault};
  if (readTet(fault)) {
    throw Error(ErrorCode::NotFinite,
                fileName_ + ": a parameter of tet " + std::to_string(fault) + " is not finite.",
                place);
  }
  throw Error(ErrorCode::FileSyntax,
              fileName_ + ": the half-faces of cell " + std::to_string(fault) +
                  " do not bound a tetrahedron, or its corner order is not from 0 to 23.",
              place);
}

bool TetReader::readRotationsOf(std::size_t cell) {
  const std::span<const Index> halfFaces = topology_.cells[cell];
  bool good = true;
  for (std::size_t s = 0; s < 4; ++s) {
    const std::int32_t rotation = properties_[OvmInteger::Transition][halfFaces[s]];
    const bool known = rotation >= -1 && rotation < 24;
    good = good && known;
    map_.rotations[cell][opposite(cell, s)] = static_cast<std::int8_t>(known ? rotation : -1);
  }
  return good;
}

/// Values beyond the 24 rotations are "unknown" at the boundary, where they mean nothing.
void TetReader::readRotations() {
  const std::size_t cells = topology_.cells.size();
  map_.rotations.resize(cells);
  std::size_t fault =
      firstFault(stage_, cells, [this](std::size_t cell) { return readRotationsOf(cell); });
  if (fault == cells) return;
  Array<char> used(2 * topology_.faces.size(), 0);
  for (const Index halfFace : topology_.cells.handles) used[halfFace] = 1;
  for (; fault < cells; ++fault) {
    for (const Index halfFace : topology_.cells[fault]) {
      const std::int32_t rotation = properties_[OvmInteger::Transition][halfFace];
      if ((rotation >= -1 && rotation < 24) || used[halfFace ^ 1U] == 0) continue;
      throw Error(ErrorCode::FileSyntax,
                  fileName_ + ": the rotation across half-face " + std::to_string(halfFace) +
                      " of tet " + std::to_string(fault) + " is " + std::to_string(rotation) +
                      ", but rotations are numbered from 0 to 23, or -1 if unknown.",
                  Place{PlaceKind::Tet, fault});
    }
  }
}

void TetReader::readEdgeValences() {
  const Array<std::int32_t>& offsets = properties_[OvmInteger::EdgeValence];
  for (std::size_t e = 0; e < offsets.size(); ++e) {
    if (offsets[e] == 0) continue;
    map_.edgeValences.push_back({topology_.edges[e][0], topology_.edges[e][1], offsets[e]});
  }
}

void TetReader::readFeatures() {
  const auto forEachTag = [this](OvmInteger property, const auto& add) {
    const Array<std::int32_t>& tags = properties_[property];
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] != 0) add(i, tags[i]);
    }
  };
  forEachTag(OvmInteger::FeatureVertices, [this](std::size_t v, std::int32_t tag) {
    map_.features.vertices.push_back({static_cast<Index>(v), tag});
  });
  forEachTag(OvmInteger::FeatureEdges, [this](std::size_t e, std::int32_t tag) {
    map_.features.edges.push_back({topology_.edges[e], tag});
  });
  forEachTag(OvmInteger::FeatureFaces, [this](std::size_t f, std::int32_t tag) {
    if (!loops_.isGood(f)) {
      throw Error(ErrorCode::FileSyntax,
                  fileName_ + ": face " + std::to_string(f) +
                      " is tagged as a feature, but is no closed loop of 3 half-edges.");
    }
    map_.features.faces.push_back({loops_.ofFace(f), tag});
  });
  const Array<std::int32_t>& regions = properties_[OvmInteger::Region];
  map_.regions.assign(regions.begin(), regions.end());
}

}  // namespace

bool assembleTet(const std::array<std::array<Index, 3>, 4>& loops, OvmTet& tet) noexcept {
  const std::array<Index, 3>& base = loops[0];
  const auto inBase = [&](Index v) { return std::find(base.begin(), base.end(), v) != base.end(); };
  const auto* const apex = std::find_if_not(loops[1].begin(), loops[1].end(), inBase);
  if (apex == loops[1].end()) return false;
  tet.corners = {base[0], base[1], base[2], *apex};
  if (base[0] == base[1] || base[1] == base[2] || base[2] == base[0]) return false;

  unsigned seen = 0;
  for (std::size_t s = 0; s < 4; ++s) {
    std::array<std::uint8_t, 4> order{};
    unsigned present = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto* const corner = std::find(tet.corners.begin(), tet.corners.end(), loops[s][i]);
      if (corner == tet.corners.end()) return false;
      order[i] = static_cast<std::uint8_t>(corner - tet.corners.begin());
      present |= 1U << order[i];
    }
    const unsigned missing = 15U & ~present;
    if (!hasOneBit(missing)) return false;
    order[3] = static_cast<std::uint8_t>(std::countr_zero(missing));
    // All half-faces run the same way round, seen from inside.
    if (!isEven(order)) return false;
    tet.opposite[s] = order[3];
    seen |= missing;
  }
  return seen == 15U;
}

TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage) {
  return TetReader(std::move(mesh), fileName, stage).read();
}

TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage) {
  return TetReader(std::move(mesh), fileName, stage).readWithoutMap();
}

}  // namespace hexhex
