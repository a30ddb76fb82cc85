// OpenFOAM's decomposed case: `processorK/constant/polyMesh` for each part, with the addresses that
// decomposePar writes.
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/parts/file_set.hpp>
#include <io/parts/parts.hpp>
#include <io/solvers/poly_mesh.hpp>

namespace hexhex {
namespace {

/// A face by one of its cells: 8 * the cell's global number + which one it is.
using FaceCode = std::uint64_t;

/// The numbers of faces in the mesh in one piece, as writeOpenFoam() lists them: inner ones by the
/// smaller of their cells, then by the larger; boundary ones by tag, cell and side. Known when all
/// parts are. A byte for each cell.
class FaceNumbers {
 public:
  void resize(std::uint64_t cells) { counts_.assign(cells, 0); }
  /// How many inner faces a cell has whose other cell is larger.
  void setOwned(std::uint64_t cell, std::size_t count) {
    counts_[cell] = static_cast<std::uint8_t>(count);
  }
  void addBoundary(std::int32_t tag, FaceCode face) { boundary_[tag].push_back(face); }
  /// When all are there.
  void finish() {
    for (std::size_t c = 0; c < counts_.size(); ++c) {
      if (c % kBlock == 0) before_.push_back(inner_);
      inner_ += counts_[c];
    }
    std::uint64_t first = inner_;
    for (auto& [tag, faces] : boundary_) {
      std::sort(faces.begin(), faces.end());
      begin_[tag] = first;
      first += faces.size();
    }
    total_ = first;
  }
  [[nodiscard]] std::uint64_t total() const noexcept { return total_; }
  /// All tags of boundary faces, in order: those without come last.
  [[nodiscard]] std::vector<std::int32_t> tags() const {
    std::vector<std::int32_t> tags;
    for (const auto& [tag, faces] : boundary_) tags.push_back(tag);
    return tags;
  }
  [[nodiscard]] std::uint64_t inner(FaceCode face) const {
    const std::uint64_t cell = face / 8;
    std::uint64_t number = before_[cell / kBlock] + face % 8;
    for (std::uint64_t c = cell / kBlock * kBlock; c < cell; ++c) number += counts_[c];
    return number;
  }
  [[nodiscard]] std::uint64_t boundary(std::int32_t tag, FaceCode face) const {
    const std::vector<FaceCode>& faces = boundary_.at(tag);
    const auto place = std::lower_bound(faces.begin(), faces.end(), face);
    return begin_.at(tag) + static_cast<std::uint64_t>(place - faces.begin());
  }

 private:
  static constexpr std::size_t kBlock = 64;
  struct UntaggedLast {
    bool operator()(std::int32_t a, std::int32_t b) const {
      return (a == 0) != (b == 0) ? b == 0 : a < b;
    }
  };
  std::vector<std::uint8_t> counts_;
  std::vector<std::uint64_t> before_;  ///< inner faces of cells before each block
  std::uint64_t inner_ = 0;
  std::uint64_t total_ = 0;
  std::map<std::int32_t, std::vector<FaceCode>, UntaggedLast> boundary_;
  std::map<std::int32_t, std::uint64_t> begin_;
};

/// A face of a part that is not between two of its cells.
struct OuterFace {
  std::int32_t tag;
  Index cell;
  std::uint8_t side;
};

/// What is left to be written of a part when all are known.
struct OpenPart {
  struct Border {
    std::uint32_t part;
    std::vector<FaceCode> faces;  ///< by the smaller cell; known to the part that has it
    std::vector<bool> isOwner;    ///< whether that is this part
  };
  std::size_t innerFaces = 0;
  std::vector<std::pair<std::int32_t, std::size_t>> patches;  ///< tags and faces, in order
  std::vector<Border> borders;
};

/// The faces of one part, as its polyMesh lists them.
class PartFaces {
 public:
  PartFaces(const MeshPart& part, FaceNumbers& numbers, Stage& stage)
      : part_(part), numbers_(numbers), neighbours_(findFaceNeighbours(part.mesh, stage)) {
    for (const PartNeighbour& neighbour : part.neighbours) {
      for (const PartFace& face : neighbour.faces) {
        outside_[sideOf(face.cell, face.side)] = face.otherCell;
      }
    }
    tags_.reserve(part.mesh.features.quads.size());
    for (const FeatureQuad& quad : part.mesh.features.quads) {
      tags_.emplace_back(sorted(quad.vertices), quad.tag);
    }
    std::sort(tags_.begin(), tags_.end());
  }

  void run() {
    std::vector<OuterFace> outer;
    for (std::size_t c = 0; c < part_.mesh.cells.size(); ++c) addCell(static_cast<Index>(c), outer);
    open.innerFaces = poly.faces.size();
    std::stable_sort(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) {
      return (a.tag == 0) != (b.tag == 0) ? b.tag == 0 : a.tag < b.tag;
    });
    for (const OuterFace& face : outer) {
      if (open.patches.empty() || open.patches.back().first != face.tag) {
        open.patches.emplace_back(face.tag, 0);
      }
      ++open.patches.back().second;
      add(face.cell, face.side);
      codes.push_back(8 * part_.globalCells[face.cell] + face.side);
      numbers_.addBoundary(face.tag, codes.back());
    }
    for (const PartNeighbour& neighbour : part_.neighbours) addBorder(neighbour);
  }

  PolyMesh poly;
  OpenPart open;
  std::vector<FaceCode> codes;  ///< of inner and boundary faces

 private:
  static std::uint64_t sideOf(std::size_t cell, std::size_t side) { return 8 * cell + side; }
  static Quad sorted(Quad quad) {
    std::sort(quad.begin(), quad.end());
    return quad;
  }
  void add(Index cell, std::size_t side) {
    Quad quad = faceVertices(part_.mesh.cells[cell], side);
    poly.faces.push_back(quad);
    poly.owners.push_back(cell);
  }
  [[nodiscard]] std::int32_t tagOf(Index cell, std::size_t side) const {
    const Quad quad = sorted(faceVertices(part_.mesh.cells[cell], side));
    const auto found =
        std::lower_bound(tags_.begin(), tags_.end(), std::pair(quad, std::int32_t{0}),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
    return found != tags_.end() && found->first == quad ? found->second : 0;
  }

  /// Inner faces to larger cells, in order of these; and faces that are not inside of the part.
  void addCell(Index cell, std::vector<OuterFace>& outer) {
    owned_.clear();
    const std::uint64_t number = part_.globalCells[cell];
    for (std::uint8_t side = 0; side < 6; ++side) {
      const Index other = neighbours_[cell][side];
      const auto outside = other != kNone ? outside_.end() : outside_.find(sideOf(cell, side));
      if (other != kNone) {
        if (other > cell) owned_.push_back({part_.globalCells[other], side, other});
      } else if (outside == outside_.end()) {
        outer.push_back({tagOf(cell, side), cell, side});
      } else if (outside->second > number) {
        owned_.push_back({outside->second, side, kNone});
      }
    }
    std::sort(owned_.begin(), owned_.end(), [](const Owned& a, const Owned& b) {
      return a.other != b.other ? a.other < b.other : a.side < b.side;
    });
    numbers_.setOwned(number, owned_.size());
    for (std::size_t i = 0; i < owned_.size(); ++i) {
      const FaceCode code = 8 * number + i;
      if (owned_[i].local == kNone) {
        outerCodes_[sideOf(cell, owned_[i].side)] = code;
        continue;
      }
      add(cell, owned_[i].side);
      poly.neighbours.push_back(owned_[i].local);
      codes.push_back(code);
    }
  }

  /// Faces as both parts list them: beginning at the same vertex, in opposite directions.
  void addBorder(const PartNeighbour& neighbour) {
    if (neighbour.faces.empty()) return;
    OpenPart::Border& border = open.borders.emplace_back();
    border.part = neighbour.part;
    for (const PartFace& face : neighbour.faces) {
      add(face.cell, face.side);
      Quad& quad = poly.faces.back();
      std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
      const auto code = outerCodes_.find(sideOf(face.cell, face.side));
      border.isOwner.push_back(code != outerCodes_.end());
      border.faces.push_back(code != outerCodes_.end() ? code->second : 0);
    }
  }

  /// A face of a cell, by the other one.
  struct Owned {
    std::uint64_t other;  ///< global
    std::uint8_t side;
    Index local;  ///< kNone if in another part
  };

  const MeshPart& part_;
  FaceNumbers& numbers_;
  FaceNeighbours neighbours_;
  std::vector<Owned> owned_;                        ///< of one cell
  std::map<std::uint64_t, std::uint64_t> outside_;  ///< of faces between parts: the other cell
  std::map<std::uint64_t, FaceCode> outerCodes_;    ///< of those whose smaller cell is here
  std::vector<std::pair<Quad, std::int32_t>> tags_;
};

std::string processorPatch(std::uint32_t here, std::uint32_t there) {
  return "        type            processor;\n        inGroups        1(processor);\n"
         "        matchTolerance  0.0001;\n        transform       unknown;\n"
         "        myProcNo        " +
         std::to_string(here) + ";\n        neighbProcNo    " + std::to_string(there) + ";\n";
}

class OpenFoamSink final : public PartSink {
 public:
  OpenFoamSink(const std::filesystem::path& file, Context& context)
      : context_(context), case_(lowerCaseExtension(file) == ".foam" ? file.parent_path() : file) {
    if (case_ != file) marker_.emplace(file);
  }

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "OpenFOAM's decomposed cases");
    requireInt32(info.pointCount, "OpenFOAM numbers vertices");
    // OpenFOAM counts folders to learn the number of parts.
    const std::filesystem::path next = case_ / ("processor" + std::to_string(info.parts));
    std::error_code unknown;
    if (std::filesystem::exists(next, unknown)) {
      throw Error(ErrorCode::FileWrite,
                  next.string() + " is there, of a case with more parts than " +
                      std::to_string(info.parts) + ". Remove the old processor folders first.");
    }
    numbers_.resize(info.cellCount);
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    folders_.emplace_back(folderOf(part.part));
    const OutputFolder& folder = folders_.back();
    try {
      withThreads(context_.threads(), [&] { writePart(part, folder, stage); });
    } catch (const Error& error) {
      throw folder.named(error);
    }
  }

  void end() override {
    Stage stage(context_, "write mesh");
    numbers_.finish();
    requireInt32(numbers_.total(), "OpenFOAM numbers faces");
    for (std::uint32_t p = 0; p < open_.size(); ++p) {
      try {
        finishPart(p, stage);
      } catch (const Error& error) {
        throw folders_[p].named(error);
      }
    }
    std::size_t done = 0;
    try {
      for (; done < folders_.size(); ++done) folders_[done].commit();
      if (marker_) marker_->commit();
    } catch (...) {
      const bool complete = marker_ && marker_->isNamed();
      while (!complete && done-- > 0) folders_[done].takeBack();
      throw;
    }
  }

 private:
  [[nodiscard]] std::filesystem::path folderOf(std::uint32_t part) const {
    return case_ / ("processor" + std::to_string(part)) / "constant" / "polyMesh";
  }
  static std::filesystem::path codesIn(const OutputFolder& folder) {
    return folder.temporary() / "faceCodes";
  }

  void writePart(const MeshPart& part, const OutputFolder& folder, Stage& stage) {
    PartFaces faces(part, numbers_, stage);
    faces.run();
    PolyMeshWriter writer(folder.temporary(), context_.threads());
    writer.write(part.mesh, faces.poly, stage);
    writer.writeZones(part.mesh.regions.empty() ? CellGroups{} : groupCells(part.mesh));
    const auto label = [](const Array<std::uint64_t>& labels) {
      return [&labels](char* place, std::size_t i) { return put(place, labels[i]); };
    };
    writer.writeLabels("pointProcAddressing", part.globalPoints.size(), stage,
                       label(part.globalPoints));
    writer.writeLabels("cellProcAddressing", part.globalCells.size(), stage,
                       label(part.globalCells));
    writer.commit();
    OutputFile codes(codesIn(folder));
    codes.writeBytes(faces.codes.data(), faces.codes.size() * sizeof(FaceCode));
    codes.commit();
    open_.push_back(std::move(faces.open));
  }

  /// What takes the numbers of all faces.
  void finishPart(std::uint32_t part, Stage& stage) {
    const OpenPart& open = open_[part];
    const OutputFolder& folder = folders_[part];
    const Array<char> bytes = readWholeFile(codesIn(folder), stage);
    std::vector<FaceCode> codes(bytes.size() / sizeof(FaceCode));
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(codes.data()));
    std::filesystem::remove(codesIn(folder));

    std::vector<std::int64_t> addresses;
    for (std::size_t i = 0; i < open.innerFaces; ++i) {
      addresses.push_back(addressOf(numbers_.inner(codes[i])));
    }
    std::vector<PolyMesh::Patch> patches;
    std::vector<std::int64_t> patchAddresses;
    std::map<std::int32_t, std::string> names;
    std::vector<ElementGroup> groups;
    addMissingGroups(groups, info_.quadTags, true, "surface", "boundary");
    for (const ElementGroup& group : groups) names[group.tag] = group.name;
    auto own = open.patches.begin();
    for (const std::int32_t tag : numbers_.tags()) {
      const bool has = own != open.patches.end() && own->first == tag;
      const std::size_t begin = addresses.size();
      const std::size_t count = has ? own->second : 0;
      for (std::size_t i = 0; i < count; ++i) {
        addresses.push_back(addressOf(numbers_.boundary(tag, codes[addresses.size()])));
      }
      if (has) ++own;
      patchAddresses.push_back(static_cast<std::int64_t>(patches.size()));
      patches.push_back({names.at(tag), begin, begin + count, {}});
    }
    for (const OpenPart::Border& border : open.borders) {
      const std::size_t begin = addresses.size();
      const OpenPart::Border& back = borderOf(border.part, part);
      for (std::size_t i = 0; i < border.faces.size(); ++i) {
        const bool isOwner = border.isOwner[i];
        const auto number = addressOf(numbers_.inner(isOwner ? border.faces[i] : back.faces[i]));
        addresses.push_back(isOwner ? number : -number);
      }
      patchAddresses.push_back(-1);
      patches.push_back({"procBoundary" + std::to_string(part) + "to" + std::to_string(border.part),
                         begin, addresses.size(), processorPatch(part, border.part)});
    }
    PolyMeshWriter writer(folder.temporary(), context_.threads());
    writer.writeBoundary(patches);
    const auto label = [](const std::vector<std::int64_t>& labels) {
      return [&labels](char* place, std::size_t i) {
        return put(place, static_cast<std::int32_t>(labels[i]));
      };
    };
    writer.writeLabels("faceProcAddressing", addresses.size(), stage, label(addresses));
    writer.writeLabels("boundaryProcAddressing", patchAddresses.size(), stage,
                       label(patchAddresses));
    writer.commit();
  }
  /// From 1 on, so that a sign can say that the face is turned around.
  static std::int64_t addressOf(std::uint64_t face) { return static_cast<std::int64_t>(face) + 1; }

  [[nodiscard]] const OpenPart::Border& borderOf(std::uint32_t part, std::uint32_t to) const {
    const std::vector<OpenPart::Border>& borders = open_[part].borders;
    return *std::find_if(borders.begin(), borders.end(),
                         [to](const OpenPart::Border& border) { return border.part == to; });
  }

  Context& context_;
  std::filesystem::path case_;
  std::optional<OutputFile> marker_;
  PartsInfo info_;
  FaceNumbers numbers_;
  std::deque<OutputFolder> folders_;
  std::vector<OpenPart> open_;
};

}  // namespace

std::unique_ptr<PartSink> openOpenFoamPartSink(const std::filesystem::path& file,
                                               const WriteOptions& /*options*/, Context& context,
                                               ProcessTeam* /*team*/) {
  return std::make_unique<OpenFoamSink>(file, context);
}

}  // namespace hexhex
