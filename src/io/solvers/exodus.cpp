// The library defines an array when it is told of a block or a set, which lengthens the file's
// head; netCDF then moves all arrays behind it. So room for the head is set aside at once, and
// everything is defined before the first long array is written; those go in slices that stay in the
// cache.
#include <algorithm>
#include <array>
#include <cstdint>
#include <exodusII.h>
#include <limits>
#include <mutex>
#include <netcdf.h>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/version.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex {
namespace {

/// Points or cells of a slice: a few hundred kilobytes, so that it is in the cache when netCDF
/// turns its bytes round.
constexpr std::size_t kSlice = std::size_t{1} << 13;

/// Exodus' numbers of the faces of kHexFaces.
constexpr std::array<int, 6> kSideNumbers = {4, 2, 1, 3, 5, 6};

/// An open file of the library.
class ExodusFile {
 public:
  ExodusFile(const OutputFile& file, int mode) : file_(file) {
    int wordInMemory = sizeof(double);
    int wordInFile = sizeof(double);
    ex_opts(0);  // print nothing
    id_ = ex_create(file.temporary().c_str(), EX_CLOBBER | mode, &wordInMemory, &wordInFile);
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
  const OutputFile& file_;
  int id_ = -1;
};

/// The sides of one group of boundary quads.
struct SideSet {
  const ElementGroup* group;
  std::size_t end;  ///< in the group's list; behind it, quads inside the mesh
};

std::vector<SideSet> sideSets(const QuadGroups& quads) {
  std::vector<SideSet> sets;
  for (const ElementGroup& group : quads.groups) {
    const std::size_t end = quads.boundaryEnd(group);
    if (end > group.begin) sets.push_back({&group, end});
  }
  return sets;
}

struct NodeSet {
  std::string name;
  std::vector<int> vertices;  ///< from 1 on, ascending
};

template <class Groups>
void addNodeSets(const Groups& groups, std::vector<NodeSet>& sets) {
  for (const ElementGroup& group : groups.groups) {
    NodeSet& set = sets.emplace_back(NodeSet{group.name, {}});
    for (const Index vertex : verticesOf(groups, group)) {
      set.vertices.push_back(static_cast<int>(vertex) + 1);
    }
  }
}

class ExodusWriter {
 public:
  ExodusWriter(const OutputFile& file, int mode, const HexMesh& mesh, Stage& stage)
      : file_(file, mode), mesh_(mesh), progress_(stage, mesh.points.size() + mesh.cells.size()) {}

  void write(const MeshGroups& groups) {
    const CellGroups& cells = groups.cells;
    const std::vector<SideSet> sides = sideSets(groups.quads);
    std::vector<NodeSet> nodeSets;
    addNodeSets(groups.edges, nodeSets);
    addNodeSets(groups.vertices, nodeSets);
    reserveHead(cells.groups.size() + nodeSets.size() + sides.size());
    define(cells, sides, nodeSets);
    writePoints();
    for (const ElementGroup& group : cells.groups) writeCells(cells, group);
    const Array<Index> places = placesOf(cells);
    for (const SideSet& set : sides) writeSides(set, groups.quads, places);
    for (std::size_t i = 0; i < nodeSets.size(); ++i) {
      file_.require(
          ex_put_set(file_.id(), EX_NODE_SET, size(i + 1), nodeSets[i].vertices.data(), nullptr));
    }
    file_.close();
  }

 private:
  static std::int64_t size(std::size_t number) { return static_cast<std::int64_t>(number); }

  /// Sets room for the head aside, which netCDF does only where there is a variable: the text.
  void reserveHead(std::size_t groups) {
    // What Exodus puts there takes half as much.
    constexpr std::size_t kBytes = 8192;
    constexpr std::size_t kBytesOfGroup = 1024;
    constexpr std::size_t kAlignment = 4;
    std::string text = std::string("by hexhex ") + version();
    char* line = text.data();
    file_.require(ex_put_info(file_.id(), 1, &line));
    requireNetcdf(nc_redef(file_.id()));
    requireNetcdf(
        nc__enddef(file_.id(), kBytes + groups * kBytesOfGroup, kAlignment, 0, kAlignment));
  }
  void requireNetcdf(int status) const { file_.require(status == NC_NOERR ? 0 : -1); }

  /// Everything but the long arrays.
  void define(const CellGroups& cells, const std::vector<SideSet>& sides,
              const std::vector<NodeSet>& nodeSets) {
    file_.require(ex_put_init(file_.id(), "hexahedral mesh by hexhex", 3, size(mesh_.points.size()),
                              size(mesh_.cells.size()), size(cells.groups.size()),
                              size(nodeSets.size()), size(sides.size())));
    for (const ElementGroup& group : cells.groups) {
      file_.require(ex_put_block(file_.id(), EX_ELEM_BLOCK, group.number, "HEX8",
                                 size(group.end - group.begin), 8, 0, 0, 0));
      file_.require(ex_put_name(file_.id(), EX_ELEM_BLOCK, group.number, group.name.c_str()));
    }
    for (const auto& [group, end] : sides) {
      defineSet(EX_SIDE_SET, group->number, end - group->begin, group->name);
    }
    for (std::size_t i = 0; i < nodeSets.size(); ++i) {
      defineSet(EX_NODE_SET, size(i + 1), nodeSets[i].vertices.size(), nodeSets[i].name);
    }
  }
  void defineSet(ex_entity_type type, std::int64_t number, std::size_t count,
                 const std::string& name) {
    file_.require(ex_put_set_param(file_.id(), type, number, size(count), 0));
    file_.require(ex_put_name(file_.id(), type, number, name.c_str()));
  }

  /// Calls f(begin, count) for slices of n elements.
  template <class F>
  void forEachSlice(std::size_t n, const F& f) {
    for (std::size_t begin = 0; begin < n; begin += kSlice) {
      const std::size_t count = std::min(kSlice, n - begin);
      f(begin, count);
      progress_.advance(count);
    }
  }

  void writePoints() {
    std::array<Array<double>, 3> values;
    for (Array<double>& ofAxis : values) ofAxis.resize(std::min(kSlice, mesh_.points.size()));
    forEachSlice(mesh_.points.size(), [&](std::size_t begin, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          values[axis][i] = mesh_.points[begin + i][axis];
      }
      file_.require(ex_put_partial_coord(file_.id(), size(begin + 1), size(count), values[0].data(),
                                         values[1].data(), values[2].data()));
    });
  }

  void writeCells(const CellGroups& cells, const ElementGroup& group) {
    const std::size_t cellCount = group.end - group.begin;
    Array<int> vertices(8 * std::min(kSlice, cellCount));
    forEachSlice(cellCount, [&](std::size_t begin, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        const Hex& cell = mesh_.cells[cells.at(group.begin + begin + i)];
        for (std::size_t k = 0; k < 8; ++k) vertices[8 * i + k] = static_cast<int>(cell[k]) + 1;
      }
      file_.require(ex_put_n_elem_conn(file_.id(), group.number, size(begin + 1), size(count),
                                       vertices.data()));
    });
  }

  /// Where each cell stands in the order of the blocks; empty: as they are.
  static Array<Index> placesOf(const CellGroups& cells) {
    Array<Index> places(cells.order.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[cells.at(i)] = static_cast<Index>(i);
    return places;
  }

  void writeSides(const SideSet& set, const QuadGroups& quads, const Array<Index>& places) {
    std::vector<int> elements;
    std::vector<int> sides;
    for (std::size_t i = set.group->begin; i < set.end; ++i) {
      const std::size_t cell = quads.places[i] / 8;
      elements.push_back(static_cast<int>(places.empty() ? cell : places[cell]) + 1);
      sides.push_back(kSideNumbers[quads.places[i] % 8]);
    }
    file_.require(
        ex_put_set(file_.id(), EX_SIDE_SET, set.group->number, elements.data(), sides.data()));
  }

  ExodusFile file_;
  const HexMesh& mesh_;
  LoopProgress progress_;
};

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
  // First, so that a folder that is not writable shows at once.
  OutputFile target(file, OutputFile::Target::Regular);
  requireInt32(mesh.points.size(), "An Exodus file numbers vertices");
  requireInt32(mesh.cells.size(), "An Exodus file numbers cells");
  const MeshGroups groups(mesh, options.patchAngle, stage);
  {
    const std::lock_guard lock(libraryLock());
    ExodusWriter(target, modeFor(mesh), mesh, stage).write(groups);
  }
  target.commit();
}

}  // namespace hexhex
