// OpenFOAM's decomposed case: `processorK/constant/polyMesh` for each part, with the addresses that
// decomposePar writes.
#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/team.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/parts/face_numbers.hpp>
#include <io/parts/file_set.hpp>
#include <io/parts/parts.hpp>
#include <io/solvers/poly_mesh.hpp>

namespace hexhex::io {
namespace {

/// A face of a part that is not between two of its cells.
struct OuterFace {
  std::int32_t tag;
  std::uint64_t run;  ///< as of FaceRuns
  Index cell;
  std::uint8_t side;
};

/// Tags are in order, and faces without come last.
bool comesBefore(std::int32_t a, std::int32_t b) { return (a == 0) != (b == 0) ? b == 0 : a < b; }

/// Of a face that a part has, but whose smaller cell is in another.
constexpr std::uint64_t kOfOther = ~std::uint64_t{0};

/// What is left to be written of a part when all are known.
struct OpenPart {
  struct Border {
    std::uint32_t part;
    std::vector<std::uint64_t> faces;  ///< of `owned`, or kOfOther
  };
  std::uint32_t part = 0;
  FaceRuns owned;  ///< inner faces by their smaller cells, those of borders, too
  std::vector<std::pair<std::int32_t, FaceRuns>> patches;  ///< by tags, in order
  std::vector<Border> borders;
};

/// The faces of one part, as its polyMesh lists them.
class PartFaces {
 public:
  PartFaces(const MeshPart& part, Stage& stage)
      : part_(part), neighbours_(adjacency::findFaceNeighbours(part.mesh, stage)) {
    open.part = part.part;
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
    std::stable_sort(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) {
      return comesBefore(a.tag, b.tag);
    });
    for (const OuterFace& face : outer) {
      if (open.patches.empty() || open.patches.back().first != face.tag) {
        open.patches.emplace_back(face.tag, FaceRuns());
      }
      open.patches.back().second.add(face.run);
      add(face.cell, face.side);
    }
    for (const PartNeighbour& neighbour : part_.neighbours) addBorder(neighbour);
  }

  PolyMesh poly;
  OpenPart open;

 private:
  static std::uint64_t sideOf(std::size_t cell, std::size_t side) { return 8 * cell + side; }
  static Quad sorted(Quad quad) {
    std::sort(quad.begin(), quad.end());
    return quad;
  }
  void add(Index cell, std::size_t side) {
    Quad quad = adjacency::faceVertices(part_.mesh.cells[cell], side);
    poly.faces.push_back(quad);
    poly.owners.push_back(cell);
  }
  [[nodiscard]] std::int32_t tagOf(Index cell, std::size_t side) const {
    const Quad quad = sorted(adjacency::faceVertices(part_.mesh.cells[cell], side));
    const auto found =
        std::lower_bound(tags_.begin(), tags_.end(), std::pair(quad, std::int32_t{0}),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
    return found != tags_.end() && found->first == quad ? found->second : 0;
  }

  /// Inner faces to larger cells, in order of these; and faces that are not inside of the part.
  void addCell(Index cell, std::vector<OuterFace>& outer) {
    owned_.clear();
    const std::uint64_t number = part_.globalCells[cell];
    if (cell == 0 || number != part_.globalCells[cell - 1] + 1) run_ = number;
    for (std::uint8_t side = 0; side < 6; ++side) {
      const Index other = neighbours_[cell][side];
      const auto outside = other != kNone ? outside_.end() : outside_.find(sideOf(cell, side));
      if (other != kNone) {
        if (other > cell) owned_.push_back({part_.globalCells[other], side, other});
      } else if (outside == outside_.end()) {
        outer.push_back({tagOf(cell, side), run_, cell, side});
      } else if (outside->second > number) {
        owned_.push_back({outside->second, side, kNone});
      }
    }
    std::sort(owned_.begin(), owned_.end(), [](const Owned& a, const Owned& b) {
      return a.other != b.other ? a.other < b.other : a.side < b.side;
    });
    for (const Owned& face : owned_) {
      if (face.local == kNone) outerFaces_[sideOf(cell, face.side)] = open.owned.count();
      open.owned.add(run_);
      if (face.local == kNone) continue;
      add(cell, face.side);
      poly.neighbours.push_back(face.local);
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
      const auto owned = outerFaces_.find(sideOf(face.cell, face.side));
      border.faces.push_back(owned != outerFaces_.end() ? owned->second : kOfOther);
    }
  }

  /// A face of a cell, by the other one.
  struct Owned {
    std::uint64_t other;  ///< global
    std::uint8_t side;
    Index local;  ///< kNone if in another part
  };

  const MeshPart& part_;
  adjacency::FaceNeighbours neighbours_;
  std::vector<Owned> owned_;                           ///< of one cell
  std::uint64_t run_ = 0;                              ///< of that cell
  std::map<std::uint64_t, std::uint64_t> outside_;     ///< of faces between parts: the other cell
  std::map<std::uint64_t, std::uint64_t> outerFaces_;  ///< of those whose smaller cell is here
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
  OpenFoamSink(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : context_(context),
        file_(file),
        case_(lowerCaseExtension(file) == ".foam" ? file.parent_path() : file),
        team_(team) {
    if (case_ != file && isFirst(team)) marker_.emplace(file);
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
    for (const std::int32_t tag : info.quadTags) boundary_[tag];
    boundary_[0];
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
    numberFaces();
    for (std::size_t p = 0; p < open_.size(); ++p) {
      try {
        finishPart(open_[p], folders_[p], stage);
      } catch (const Error& error) {
        throw folders_[p].named(error);
      }
    }
    agree(team_);  // all parts are written
    nameAll();
  }

 private:
  [[nodiscard]] std::filesystem::path folderOf(std::uint32_t part) const {
    return case_ / ("processor" + std::to_string(part)) / "constant" / "polyMesh";
  }

  void writePart(const MeshPart& part, const OutputFolder& folder, Stage& stage) {
    PartFaces faces(part, stage);
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
    open_.push_back(std::move(faces.open));
  }

  void numberFaces() {
    for (const OpenPart& open : open_) {
      inner_.add(open.owned);
      for (const auto& [tag, faces] : open.patches) boundary_.at(tag).add(faces);
    }
    std::uint64_t next = inner_.finish(0, team_);
    for (auto& [tag, numbers] : boundary_) next = numbers.finish(next, team_);
    requireInt32(next, "OpenFOAM numbers faces");
    for (const OpenPart& open : open_) {
      for (const OpenPart::Border& border : open.borders) {
        std::vector<std::uint64_t>& numbers = borders_[{open.part, border.part}];
        for (const std::uint64_t face : border.faces) {
          numbers.push_back(face == kOfOther ? kOfOther : inner_.of(open.owned, face));
        }
      }
    }
    if (team_ != nullptr) exchangeBorders();
  }

  /// Takes the numbers of common faces from other processes.
  void exchangeBorders() {
    std::vector<std::uint64_t> mine;
    for (const auto& [parts, numbers] : borders_) {
      mine.insert(mine.end(), {parts.second, numbers.size()});
      mine.insert(mine.end(), numbers.begin(), numbers.end());
    }
    team_->showAll(mine, [&](std::uint32_t from, std::span<const std::uint64_t> theirs) {
      while (!theirs.empty()) {
        const std::span<const std::uint64_t> numbers = theirs.subspan(2, theirs[1]);
        if (theirs[0] == team_->rank()) {
          borders_[{from, team_->rank()}].assign(numbers.begin(), numbers.end());
        }
        theirs = theirs.subspan(2 + numbers.size());
      }
    });
  }

  /// What takes the numbers of all faces.
  void finishPart(const OpenPart& open, const OutputFolder& folder, Stage& stage) {
    std::vector<std::int64_t> addresses = innerAddresses(open);
    std::vector<PolyMesh::Patch> patches;
    std::vector<std::int64_t> patchAddresses;
    std::map<std::int32_t, std::string> names;
    std::vector<ElementGroup> groups;
    addMissingGroups(groups, info_.quadTags, true, "surface", "boundary");
    for (const ElementGroup& group : groups) names[group.tag] = group.name;
    auto own = open.patches.begin();
    for (const auto& [tag, numbers] : boundary_) {
      if (numbers.empty()) continue;
      const std::size_t begin = addresses.size();
      if (own != open.patches.end() && own->first == tag) {
        numbers.forEach(own->second,
                        [&](std::uint64_t number) { addresses.push_back(addressOf(number)); });
        ++own;
      }
      patchAddresses.push_back(static_cast<std::int64_t>(patches.size()));
      patches.push_back({names.at(tag), begin, addresses.size(), {}});
    }
    for (const OpenPart::Border& border : open.borders) {
      const std::size_t begin = addresses.size();
      const std::vector<std::uint64_t>& here = borders_.at({open.part, border.part});
      const std::vector<std::uint64_t>& there = borders_.at({border.part, open.part});
      for (std::size_t i = 0; i < here.size(); ++i) {
        addresses.push_back(here[i] != kOfOther ? addressOf(here[i]) : -addressOf(there[i]));
      }
      patchAddresses.push_back(-1);
      patches.push_back(
          {"procBoundary" + std::to_string(open.part) + "to" + std::to_string(border.part), begin,
           addresses.size(), processorPatch(open.part, border.part)});
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

  /// Of faces between two cells of the part.
  [[nodiscard]] std::vector<std::int64_t> innerAddresses(const OpenPart& open) const {
    std::vector<bool> isOuter(open.owned.count(), false);
    for (const OpenPart::Border& border : open.borders) {
      for (const std::uint64_t face : border.faces) {
        if (face != kOfOther) isOuter[face] = true;
      }
    }
    std::vector<std::int64_t> addresses;
    std::size_t face = 0;
    inner_.forEach(open.owned, [&](std::uint64_t number) {
      if (!isOuter[face++]) addresses.push_back(addressOf(number));
    });
    return addresses;
  }
  /// From 1 on, so that a sign can say that the face is turned around.
  static std::int64_t addressOf(std::uint64_t face) { return static_cast<std::int64_t>(face) + 1; }

  /// Gives all folders their names, and the marker, which comes last.
  void nameAll() {
    std::size_t done = 0;
    try {
      for (; done < folders_.size(); ++done) folders_[done].commit();
      agree(team_);
      if (marker_) marker_->commit();
      agree(team_);
    } catch (...) {
      // A marker that is there is only not yet safe on the disk; other processes cannot know.
      const bool isNamed = marker_ && marker_->isNamed();
      if (isNamed && team_ == nullptr) throw;
      std::error_code unknown;
      if (isNamed) std::filesystem::remove(file_, unknown);
      while (done-- > 0) folders_[done].takeBack();
      throw;
    }
  }

  struct Before {
    bool operator()(std::int32_t a, std::int32_t b) const { return comesBefore(a, b); }
  };

  Context& context_;
  std::filesystem::path file_;
  std::filesystem::path case_;
  ProcessTeam* team_;
  std::optional<OutputFile> marker_;  ///< of the first process
  PartsInfo info_;
  std::deque<OutputFolder> folders_;
  std::vector<OpenPart> open_;  ///< those of this process
  FaceNumbers inner_;
  std::map<std::int32_t, FaceNumbers, Before> boundary_;  ///< by tag
  /// From one part to another: numbers of their common faces, of those whose smaller cell the first
  /// has.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint64_t>> borders_;
};

}  // namespace

std::unique_ptr<PartSink> openOpenFoamPartSink(const std::filesystem::path& file,
                                               const WriteOptions& /*options*/, Context& context,
                                               ProcessTeam* team) {
  return std::make_unique<OpenFoamSink>(file, context, team);
}

}  // namespace hexhex::io
