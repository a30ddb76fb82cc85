#include <algorithm>
#include <array>
#include <cstdint>
#include <exodusII.h>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/exodus.hpp>
#include <io/library_file.hpp>
#include <io/mesh_groups.hpp>

namespace hexhex {
namespace {

/// Exodus' numbers of the faces of kHexFaces.
constexpr std::array<int, 6> kSideNumbers = {4, 2, 1, 3, 5, 6};

/// An open file of the library.
class ExodusFile {
 public:
  ExodusFile(const LibraryFile& file, int mode) : file_(file) {
    int wordInMemory = sizeof(double);
    int wordInFile = sizeof(double);
    ex_opts(0);  // print nothing
    id_ = ex_create(file.name().c_str(), EX_CLOBBER | mode, &wordInMemory, &wordInFile);
    require(id_);
  }
  ~ExodusFile() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  [[nodiscard]] int id() const noexcept { return id_; }
  /// @param status  of a call: negative if it failed; positive values are warnings
  void require(int status) const {
    if (status < 0) file_.fail("the Exodus library could not write it; perhaps the disk is full");
  }
  void close() { require(ex_close(std::exchange(id_, -1))); }

 private:
  const LibraryFile& file_;
  int id_ = -1;
};

/// The sides of one group of boundary quads.
struct SideSet {
  const ElementGroup* group;
  std::size_t end;  ///< in the group's list; behind it, quads inside the mesh
};

struct NodeSet {
  std::string name;
  std::vector<int> vertices;  ///< from 1 on, ascending
};

template <class Groups>
void addNodeSets(const Groups& groups, std::vector<NodeSet>& sets) {
  for (const ElementGroup& group : groups.groups) {
    NodeSet set{group.name, {}};
    for (std::size_t i = group.begin; i < group.end; ++i) {
      for (const Index vertex : groups.elements[i]) {
        set.vertices.push_back(static_cast<int>(vertex) + 1);
      }
    }
    std::sort(set.vertices.begin(), set.vertices.end());
    set.vertices.erase(std::unique(set.vertices.begin(), set.vertices.end()), set.vertices.end());
    sets.push_back(std::move(set));
  }
}

std::vector<SideSet> sideSets(const QuadGroups& quads) {
  std::vector<SideSet> sets;
  for (const ElementGroup& group : quads.groups) {
    const auto begin = quads.places.begin();
    const auto end = std::find(begin + static_cast<std::ptrdiff_t>(group.begin),
                               begin + static_cast<std::ptrdiff_t>(group.end), kNoPlace);
    const auto size = static_cast<std::size_t>(end - begin);
    if (size > group.begin) sets.push_back({&group, size});
  }
  return sets;
}

class ExodusWriter {
 public:
  ExodusWriter(const LibraryFile& file, int mode, const HexMesh& mesh, Stage& stage)
      : file_(file, mode), mesh_(mesh), progress_(stage, mesh.points.size() + mesh.cells.size()) {}

  void write(const CellGroups& cells, const QuadGroups& quads,
             const std::vector<NodeSet>& nodeSets) {
    const std::vector<SideSet> sides = sideSets(quads);
    file_.require(ex_put_init(file_.id(), "hexahedral mesh by hexhex", 3, size(mesh_.points.size()),
                              size(mesh_.cells.size()), size(cells.groups.size()),
                              size(nodeSets.size()), size(sides.size())));
    writePoints();
    for (const ElementGroup& group : cells.groups) writeBlock(cells, group);
    const Array<int> numbers = elementNumbers(cells);
    for (const SideSet& set : sides) writeSideSet(set, quads, numbers);
    for (std::size_t i = 0; i < nodeSets.size(); ++i) writeNodeSet(nodeSets[i], size(i + 1));
    file_.close();
  }

 private:
  static std::int64_t size(std::size_t number) { return static_cast<std::int64_t>(number); }

  void writePoints() {
    std::array<Array<double>, 3> values;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[axis].resize(mesh_.points.size());
      for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
        values[axis][i] = mesh_.points[i][axis];
      }
    }
    file_.require(ex_put_coord(file_.id(), values[0].data(), values[1].data(), values[2].data()));
    progress_.advance(mesh_.points.size());
  }

  void writeBlock(const CellGroups& cells, const ElementGroup& group) {
    const std::size_t count = group.end - group.begin;
    file_.require(
        ex_put_block(file_.id(), EX_ELEM_BLOCK, group.number, "HEX8", size(count), 8, 0, 0, 0));
    file_.require(ex_put_name(file_.id(), EX_ELEM_BLOCK, group.number, group.name.c_str()));
    Array<int> vertices(8 * count);
    for (std::size_t i = 0; i < count; ++i) {
      const Hex& cell = mesh_.cells[cells.at(group.begin + i)];
      for (std::size_t k = 0; k < 8; ++k) vertices[8 * i + k] = static_cast<int>(cell[k]) + 1;
    }
    if (count > 0) {
      file_.require(
          ex_put_conn(file_.id(), EX_ELEM_BLOCK, group.number, vertices.data(), nullptr, nullptr));
    }
    progress_.advance(count);
  }

  /// The number of each cell in the order of the blocks.
  [[nodiscard]] Array<int> elementNumbers(const CellGroups& cells) const {
    Array<int> numbers(mesh_.cells.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[cells.at(i)] = static_cast<int>(i) + 1;
    return numbers;
  }

  void writeSideSet(const SideSet& set, const QuadGroups& quads, const Array<int>& numbers) {
    std::vector<int> elements;
    std::vector<int> sides;
    for (std::size_t i = set.group->begin; i < set.end; ++i) {
      elements.push_back(numbers[quads.places[i] / 8]);
      sides.push_back(kSideNumbers[quads.places[i] % 8]);
    }
    const std::int64_t number = set.group->number;
    file_.require(ex_put_set_param(file_.id(), EX_SIDE_SET, number, size(elements.size()), 0));
    file_.require(ex_put_set(file_.id(), EX_SIDE_SET, number, elements.data(), sides.data()));
    file_.require(ex_put_name(file_.id(), EX_SIDE_SET, number, set.group->name.c_str()));
  }

  void writeNodeSet(const NodeSet& set, std::int64_t number) {
    file_.require(ex_put_set_param(file_.id(), EX_NODE_SET, number, size(set.vertices.size()), 0));
    file_.require(ex_put_set(file_.id(), EX_NODE_SET, number, set.vertices.data(), nullptr));
    file_.require(ex_put_name(file_.id(), EX_NODE_SET, number, set.name.c_str()));
  }

  ExodusFile file_;
  const HexMesh& mesh_;
  LoopProgress progress_;
};

void requireSmall(std::size_t count, const char* what) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (count <= kMost) return;
  throw Error(ErrorCode::TooLarge, "An Exodus file numbers " + std::string(what) +
                                       " with 31 bits, which do not suffice for " +
                                       std::to_string(count) + "; choose another format.");
}

/// With 64-bit offsets an array takes at most 4 GB.
int modeFor(const HexMesh& mesh) {
  constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max() - 8;
  const std::size_t largest =
      std::max(mesh.points.size() * sizeof(double), mesh.cells.size() * 8 * sizeof(std::int32_t));
  return largest > kMostBytes ? EX_NETCDF4 : EX_LARGE_MODEL;
}

}  // namespace

void writeExodus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  LibraryFile target(file);  // first, so that a folder that is not writable shows at once
  requireSmall(mesh.points.size(), "vertices");
  requireSmall(mesh.cells.size(), "cells");
  std::vector<NodeSet> nodeSets;
  addNodeSets(groupEdges(mesh), nodeSets);
  addNodeSets(groupVertices(mesh), nodeSets);
  QuadGroups quads;
  withThreads(context.threads(), [&] { quads = groupQuads(mesh, options.patchAngle, stage); });
  {
    const std::lock_guard lock(libraryLock());
    ExodusWriter(target, modeFor(mesh), mesh, stage).write(groupCells(mesh), quads, nodeSets);
  }
  target.commit();
}

}  // namespace hexhex
