#include <algorithm>
#include <array>
#include <cgnslib.h>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex {
namespace {

/// An open file of the library.
class CgnsFile {
 public:
  explicit CgnsFile(const OutputFile& file) : file_(file) {
    require(cg_set_file_type(CG_FILE_HDF5));
    require(cg_open(file.temporary().c_str(), CG_MODE_WRITE, &number_));
    open_ = true;
  }
  ~CgnsFile() {
    if (open_) cg_close(number_);
  }
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;

  [[nodiscard]] int number() const noexcept { return number_; }
  void require(int status) const {
    if (status == CG_OK) return;
    file_.fail(std::string("the CGNS library says: ") + cg_get_error());
  }
  void close() {
    open_ = false;
    require(cg_close(number_));
  }

 private:
  const OutputFile& file_;
  int number_ = 0;
  bool open_ = false;
};

class CgnsWriter {
 public:
  CgnsWriter(const OutputFile& file, const HexMesh& mesh, Stage& stage)
      : file_(file), mesh_(mesh), progress_(stage, mesh.points.size() + mesh.cells.size()) {}

  void write(const MeshGroups& groups) {
    const std::array<cgsize_t, 3> size = {static_cast<cgsize_t>(mesh_.points.size()),
                                          static_cast<cgsize_t>(mesh_.cells.size()), 0};
    int base = 0;
    int zone = 0;
    file_.require(cg_base_write(file_.number(), "Base", 3, 3, &base));
    file_.require(
        cg_zone_write(file_.number(), base, "Zone", size.data(), CGNS_ENUMV(Unstructured), &zone));
    writePoints();
    for (const ElementGroup& group : groups.cells.groups) {
      writeSection(group, CGNS_ENUMV(HEXA_8),
                   [&](std::size_t i) -> const Hex& { return mesh_.cells[groups.cells.at(i)]; });
    }
    progress_.advance(mesh_.cells.size());
    const auto of = [](const auto& elements) {
      return [&elements](std::size_t i) -> const auto& { return elements[i]; };
    };
    for (const ElementGroup& group : groups.quads.groups) {
      const cgsize_t first = next_;
      writeSection(group, CGNS_ENUMV(QUAD_4), of(groups.quads.elements));
      writeBoundary(group, groups.quads, first);
    }
    for (const ElementGroup& group : groups.edges.groups) {
      writeSection(group, CGNS_ENUMV(BAR_2), of(groups.edges.elements));
    }
    for (const ElementGroup& group : groups.vertices.groups) {
      writeSection(group, CGNS_ENUMV(NODE), of(groups.vertices.elements));
    }
    file_.close();
  }

 private:
  static constexpr int kBase = 1;
  static constexpr int kZone = 1;

  void writePoints() {
    constexpr std::array<const char*, 3> kNames = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    Array<double> values(mesh_.points.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = mesh_.points[i][axis];
      int coordinate = 0;
      file_.require(cg_coord_write(file_.number(), kBase, kZone, CGNS_ENUMV(RealDouble),
                                   kNames[axis], values.data(), &coordinate));
    }
    progress_.advance(mesh_.points.size());
  }

  /// @param elementAt  the element at a place of the sorted list
  template <class F>
  void writeSection(const ElementGroup& group, CGNS_ENUMT(ElementType_t) type, const F& elementAt) {
    if (group.begin == group.end) return;
    Array<cgsize_t> vertices((group.end - group.begin) * elementAt(group.begin).size());
    cgsize_t* next = vertices.data();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      for (const Index vertex : elementAt(i)) *next++ = static_cast<cgsize_t>(vertex) + 1;
    }
    const cgsize_t first = next_;
    next_ += static_cast<cgsize_t>(group.end - group.begin);
    int section = 0;
    file_.require(cg_section_write(file_.number(), kBase, kZone, group.name.c_str(), type, first,
                                   next_ - 1, 0, vertices.data(), &section));
  }

  /// Quads inside the mesh are no boundary.
  void writeBoundary(const ElementGroup& group, const QuadGroups& quads, cgsize_t first) {
    const std::size_t count = quads.boundaryEnd(group) - group.begin;
    if (count == 0) return;
    const std::array<cgsize_t, 2> range = {first, first + static_cast<cgsize_t>(count) - 1};
    int condition = 0;
    file_.require(cg_boco_write(file_.number(), kBase, kZone, group.name.c_str(),
                                CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), 2,
                                range.data(), &condition));
    file_.require(cg_boco_gridlocation_write(file_.number(), kBase, kZone, condition,
                                             CGNS_ENUMV(FaceCenter)));
    nameFamily(group, condition);
  }

  /// The family of a boundary condition has its name.
  void nameFamily(const ElementGroup& group, int condition) {
    int family = 0;
    file_.require(cg_family_write(file_.number(), kBase, group.name.c_str(), &family));
    file_.require(
        cg_goto(file_.number(), kBase, "Zone_t", kZone, "ZoneBC_t", 1, "BC_t", condition, "end"));
    file_.require(cg_famname_write(group.name.c_str()));
  }

  CgnsFile file_;
  const HexMesh& mesh_;
  LoopProgress progress_;
  cgsize_t next_ = 1;  ///< number of the next element
};

void requireSmall(const HexMesh& mesh, const MeshGroups& groups) {
  const std::uint64_t elements = groups.elementCount();
  // The library counts the numbers of a section with the same integers.
  const auto largest =
      std::max<std::uint64_t>({mesh.points.size(), elements, 8 * mesh.cells.size()});
  if (largest <= static_cast<std::uint64_t>(std::numeric_limits<cgsize_t>::max())) return;
  throw Error(ErrorCode::TooLarge,
              "The CGNS library of this build numbers with " +
                  std::to_string(8 * sizeof(cgsize_t)) + " bits, which do not suffice for " +
                  std::to_string(mesh.cells.size()) + " cells. Choose another format.");
}

}  // namespace

void writeCgns(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context) {
  Stage stage(context, "write mesh");
  // First, so that a folder that is not writable shows at once.
  OutputFile target(file, OutputFile::Target::Regular);
  if (mesh.points.empty() || mesh.cells.empty()) {
    throw Error(ErrorCode::InvalidArgument,
                file.string() + ": the mesh is empty, which a CGNS file cannot hold.");
  }
  const MeshGroups groups(mesh, options.patchAngle, stage);
  requireSmall(mesh, groups);
  {
    const std::lock_guard lock(libraryLock());
    CgnsWriter(target, mesh, stage).write(groups);
  }
  target.commit();
}

}  // namespace hexhex
