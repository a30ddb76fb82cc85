// The library defines an array when it is told of a block or a set, which lengthens the file's
// head; netCDF then moves all arrays behind it. So room for the head is set aside at once, and
// everything is defined before the first long array is written; those go in slices that stay in the
// cache.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <exodusII.h>
#include <limits>
#include <mutex>
#include <netcdf.h>
#include <new>
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
/// reverses the order of its bytes.
constexpr std::size_t kSlice = std::size_t{1} << 13;

/// Exodus' numbers of the faces of kHexFaces.
constexpr std::array<int, 6> kSideNumbers = {4, 2, 1, 3, 5, 6};

/// An open file of the library.
class ExodusFile {
 public:
  ExodusFile(const OutputFile& file, int mode) : file_(file) {
    int wordInMemory = sizeof(double);
    int wordInFile = sizeof(double);
    requireSpareMemory();
    ex_opts(0);  // print nothing
    errno = 0;
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
    // It goes on, and leaves out what it had no memory for.
    if (errno == ENOMEM) throw std::bad_alloc();
  }
  void close() { require(ex_close(std::exchange(id_, -1))); }

 private:
  const OutputFile& file_;
  int id_ = -1;
};

/// A set of vertices or of sides of cells.
struct ExodusSet {
  ex_entity_type type;
  std::int64_t number;
  std::string name;
  std::vector<int> elements;  ///< vertices or cells, from 1 on
  std::vector<int> sides;     ///< of the cells
};

/// Where each cell stands in the order of the blocks; empty: as they are.
Array<Index> placesOf(const CellGroups& cells) {
  Array<Index> places(cells.order.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[cells.at(i)] = static_cast<Index>(i);
  return places;
}

/// The sides of each group of boundary quads, and the vertices of those of edges and vertices.
std::vector<ExodusSet> findSets(const MeshGroups& groups) {
  std::vector<ExodusSet> sets;
  const Array<Index> places = placesOf(groups.cells);
  for (const ElementGroup& group : groups.quads.groups) {
    ExodusSet set{EX_SIDE_SET, group.number, group.name, {}, {}};
    const std::size_t end = groups.quads.boundaryEnd(group);  // behind it, quads inside the mesh
    for (std::size_t i = group.begin; i < end; ++i) {
      const std::size_t cell = groups.quads.places[i] / 8;
      set.elements.push_back(static_cast<int>(places.empty() ? cell : places[cell]) + 1);
      set.sides.push_back(kSideNumbers[groups.quads.places[i] % 8]);
    }
    if (!set.elements.empty()) sets.push_back(std::move(set));
  }
  std::int64_t number = 0;
  const auto addNodeSets = [&](const auto& ofKind) {
    for (const ElementGroup& group : ofKind.groups) {
      sets.push_back({EX_NODE_SET, ++number, group.name, {}, {}});
      for (const Index vertex : verticesOf(ofKind, group)) {
        sets.back().elements.push_back(static_cast<int>(vertex) + 1);
      }
    }
  };
  addNodeSets(groups.edges);
  addNodeSets(groups.vertices);
  return sets;
}

class ExodusWriter {
 public:
  ExodusWriter(const OutputFile& file, int mode, const HexMesh& mesh, Stage& stage)
      : file_(file, mode), mesh_(mesh), progress_(stage, mesh.points.size() + mesh.cells.size()) {}

  void write(const MeshGroups& groups) {
    const CellGroups& cells = groups.cells;
    const std::vector<ExodusSet> sets = findSets(groups);
    reserveHead(cells.groups.size() + sets.size());
    define(cells, sets);
    writePoints();
    for (const ElementGroup& group : cells.groups) writeCells(cells, group);
    for (const ExodusSet& set : sets) {
      file_.require(ex_put_set(file_.id(), set.type, set.number, set.elements.data(),
                               set.sides.empty() ? nullptr : set.sides.data()));
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
  void define(const CellGroups& cells, const std::vector<ExodusSet>& sets) {
    const std::int64_t nodeSets = std::count_if(
        sets.begin(), sets.end(), [](const ExodusSet& set) { return set.type == EX_NODE_SET; });
    file_.require(ex_put_init(file_.id(), "hexahedral mesh by hexhex", 3, size(mesh_.points.size()),
                              size(mesh_.cells.size()), size(cells.groups.size()), nodeSets,
                              size(sets.size()) - nodeSets));
    for (const ElementGroup& group : cells.groups) {
      file_.require(ex_put_block(file_.id(), EX_ELEM_BLOCK, group.number, "HEX8",
                                 size(group.end - group.begin), 8, 0, 0, 0));
      file_.require(ex_put_name(file_.id(), EX_ELEM_BLOCK, group.number, group.name.c_str()));
    }
    for (const ExodusSet& set : sets) {
      file_.require(
          ex_put_set_param(file_.id(), set.type, set.number, size(set.elements.size()), 0));
      file_.require(ex_put_name(file_.id(), set.type, set.number, set.name.c_str()));
    }
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
