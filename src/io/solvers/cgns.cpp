// The tree of nodes that a CGNS file is, as the standard maps it to HDF5 ("SIDS-to-HDF"): a node is
// a group with its name, its label, the type of its data, and the data.
#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <hdf5.h>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/hdf_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex {
namespace {

/// The standard's numbers of elements with so many corners.
constexpr int elementType(std::size_t corners) {
  return corners == 8 ? 17 : corners == 4 ? 7 : corners == 2 ? 3 : 2;
}

/// Numbers of nodes; "MT" of those without.
struct CgnsData {
  const char* type = "MT";
  hid_t ofHdf = -1;
  const void* values = nullptr;
  std::initializer_list<hsize_t> shape = {};  ///< the last index runs fastest

  CgnsData() = default;
  CgnsData(std::string_view text, std::initializer_list<hsize_t> size)
      : type("C1"), ofHdf(HDF5(H5T_NATIVE_SCHAR_g)), values(text.data()), shape(size) {}
  template <class T>
  CgnsData(const T* numbers, std::initializer_list<hsize_t> size) : values(numbers), shape(size) {
    if constexpr (std::same_as<T, double>) {
      type = "R8", ofHdf = HDF5(H5T_NATIVE_DOUBLE_g);
    } else if constexpr (std::same_as<T, float>) {
      type = "R4", ofHdf = HDF5(H5T_NATIVE_FLOAT_g);
    } else if constexpr (std::same_as<T, std::int64_t>) {
      type = "I8", ofHdf = HDF5(H5T_NATIVE_INT64_g);
    } else {
      static_assert(std::same_as<T, std::int32_t>);
      type = "I4", ofHdf = HDF5(H5T_NATIVE_INT32_g);
    }
  }
};

/// A file of nodes.
class CgnsFile {
 public:
  explicit CgnsFile(const OutputFile& output) : file_(output, HdfFile::Order::OfCreation) {
    describe(file_.root(), "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
    const std::string_view format =
        std::endian::native == std::endian::little ? "IEEE_LITTLE_32" : "IEEE_BIG_32";
    writeSet(file_.root(), " format", {format, {format.size() + 1}});
    std::array<unsigned, 3> version{};
    HDF5(H5get_libversion)(&version[0], &version[1], &version[2]);
    std::string text = "HDF5 Version " + std::to_string(version[0]) + "." +
                       std::to_string(version[1]) + "." + std::to_string(version[2]);
    text.resize(kTextBytes);
    writeSet(file_.root(), " hdf5version", {text, {kTextBytes}});
  }

  [[nodiscard]] hid_t root() const noexcept { return file_.root(); }

  /// @param name  at most 32 characters, as the label
  HdfObject add(hid_t parent, const std::string& name, const char* label,
                const CgnsData& data = {}) const {
    constexpr std::int32_t kFlags = 1;
    HdfObject node = file_.group(parent, name);
    describe(node.id(), name, label, data.type);
    file_.writeAttribute(node.id(), "flags", HDF5(H5T_NATIVE_INT32_g), file_.space({1}), &kFlags);
    if (data.values != nullptr) writeSet(node.id(), " data", data);
    return node;
  }
  HdfObject addText(hid_t parent, const char* name, const char* label,
                    std::string_view text) const {
    return add(parent, name, label, {text, {text.size()}});
  }

  void close() { file_.close(); }

 private:
  static constexpr std::size_t kTextBytes = 33;

  void describe(hid_t node, std::string name, std::string label, std::string type) const {
    constexpr std::size_t kTypeBytes = 3;
    const auto write = [&](const char* attribute, std::string& text, std::size_t bytes) {
      text.resize(bytes);
      file_.writeAttribute(node, attribute, file_.text(bytes, H5T_STR_NULLTERM).id(),
                           file_.space({}), text.data());
    };
    write("name", name, kTextBytes);
    write("label", label, kTextBytes);
    write("type", type, kTypeBytes);
  }

  void writeSet(hid_t node, const char* name, const CgnsData& data) const {
    const HdfObject set = file_.dataset(node, name, data.ofHdf, file_.space(data.shape));
    set.require(HDF5(H5Dwrite)(set.id(), data.ofHdf, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.values));
  }

  HdfFile file_;
};

/// @tparam Number  numbers all vertices and elements from 1 on
template <class Number>
class CgnsWriter {
 public:
  CgnsWriter(const OutputFile& output, const HexMesh& mesh, Stage& stage)
      : file_(output), mesh_(mesh), progress_(stage, mesh.points.size() + mesh.cells.size()) {}

  void write(const MeshGroups& groups) {
    constexpr float kVersion = 3.4F;
    constexpr std::array<std::int32_t, 2> kDimensions = {3, 3};
    static_cast<void>(
        file_.add(file_.root(), "CGNSLibraryVersion", "CGNSLibraryVersion_t", {&kVersion, {1}}));
    {
      const HdfObject base =
          file_.add(file_.root(), "Base", "CGNSBase_t", {kDimensions.data(), {2}});
      for (const ElementGroup& group : groups.quads.groups) {
        if (groups.quads.boundaryEnd(group) == group.begin) continue;
        static_cast<void>(file_.add(base.id(), group.name, "Family_t"));
      }
      writeZone(base.id(), groups);
    }
    file_.close();
  }

 private:
  void writeZone(hid_t base, const MeshGroups& groups) {
    const std::array<Number, 3> size = {static_cast<Number>(mesh_.points.size()),
                                        static_cast<Number>(mesh_.cells.size()), 0};
    const HdfObject zone = file_.add(base, "Zone", "Zone_t", {size.data(), {3, 1}});
    static_cast<void>(file_.addText(zone.id(), "ZoneType", "ZoneType_t", "Unstructured"));
    writePoints(zone.id());
    for (const ElementGroup& group : groups.cells.groups) {
      writeSection(zone.id(), group,
                   [&](std::size_t i) -> const Hex& { return mesh_.cells[groups.cells.at(i)]; });
    }
    progress_.advance(mesh_.cells.size());
    const Number firstQuad = next_;
    const auto writeAll = [&](const auto& ofKind) {
      for (const ElementGroup& group : ofKind.groups) {
        writeSection(
            zone.id(), group, [&](std::size_t i) -> const auto& { return ofKind.elements[i]; });
      }
    };
    writeAll(groups.quads);
    writeBoundary(zone.id(), groups.quads, firstQuad);
    writeAll(groups.edges);
    writeAll(groups.vertices);
  }

  void writePoints(hid_t zone) {
    const HdfObject points = file_.add(zone, "GridCoordinates", "GridCoordinates_t");
    Array<double> values(mesh_.points.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = mesh_.points[i][axis];
      static_cast<void>(file_.add(points.id(), std::string("Coordinate") + "XYZ"[axis],
                                  "DataArray_t", {values.data(), {values.size()}}));
    }
    progress_.advance(mesh_.points.size());
  }

  /// @param elementAt  the element at a place of the sorted list
  template <class F>
  void writeSection(hid_t zone, const ElementGroup& group, const F& elementAt) {
    if (group.begin == group.end) return;
    const std::size_t corners = elementAt(group.begin).size();
    Array<Number> vertices((group.end - group.begin) * corners);
    Number* place = vertices.data();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      for (const Index vertex : elementAt(i)) *place++ = static_cast<Number>(vertex) + 1;
    }
    const auto end = static_cast<Number>(next_ + static_cast<Number>(group.end - group.begin));
    const std::array<Number, 2> range = {next_, static_cast<Number>(end - 1)};
    next_ = end;
    const std::array<std::int32_t, 2> kind = {elementType(corners), 0};
    const HdfObject section =
        file_.add(zone, group.name, "Elements_t", {kind.data(), {kind.size()}});
    static_cast<void>(
        file_.add(section.id(), "ElementRange", "IndexRange_t", {range.data(), {range.size()}}));
    static_cast<void>(file_.add(section.id(), "ElementConnectivity", "DataArray_t",
                                {vertices.data(), {vertices.size()}}));
  }

  /// A condition of each group, with a family of its name. Quads inside the mesh are no boundary.
  void writeBoundary(hid_t zone, const QuadGroups& quads, Number firstQuad) {
    const HdfObject conditions = file_.add(zone, "ZoneBC", "ZoneBC_t");
    for (const ElementGroup& group : quads.groups) {
      const std::size_t count = quads.boundaryEnd(group) - group.begin;
      if (count == 0) continue;
      const auto first = static_cast<Number>(firstQuad + static_cast<Number>(group.begin));
      const std::array<Number, 2> range = {
          first, static_cast<Number>(first + static_cast<Number>(count) - 1)};
      const HdfObject condition =
          file_.addText(conditions.id(), group.name.c_str(), "BC_t", "FamilySpecified");
      static_cast<void>(
          file_.add(condition.id(), "PointRange", "IndexRange_t", {range.data(), {2, 1}}));
      static_cast<void>(
          file_.addText(condition.id(), "GridLocation", "GridLocation_t", "FaceCenter"));
      static_cast<void>(file_.addText(condition.id(), "FamilyName", "FamilyName_t", group.name));
    }
  }

  CgnsFile file_;
  const HexMesh& mesh_;
  LoopProgress progress_;
  Number next_ = 1;  ///< number of the next element
};

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
  // Libraries count the numbers of a section with the same integers.
  const auto largest =
      std::max<std::uint64_t>({mesh.points.size(), groups.elementCount(), 8 * mesh.cells.size()});
  if (largest <= static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max())) {
    CgnsWriter<std::int32_t>(target, mesh, stage).write(groups);
  } else {
    CgnsWriter<std::int64_t>(target, mesh, stage).write(groups);
  }
  target.commit();
}

}  // namespace hexhex
