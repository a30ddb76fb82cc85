// Writes CGNS files: a tree of nodes in HDF5, as the standard maps it ("SIDS-to-HDF"). A node is a
// group with its name, label, data type and data.
#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <deque>
#include <hdf5.h>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/hdf_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

/// CGNS element types by number of nodes, for orders 1 and 2.
constexpr std::int32_t elementType(std::size_t nodes) {
  constexpr std::array<std::pair<std::size_t, std::int32_t>, 7> kTypes = {
      {{1, 2}, {2, 3}, {3, 4}, {4, 7}, {8, 17}, {9, 9}, {27, 19}}};
  return std::find_if(kTypes.begin(), kTypes.end(),
                      [nodes](const auto& type) { return type.first == nodes; })
      ->second;
}

/// The nodes of order-2 cells, which replace the corners of straight ones.
struct QuadraticNodes {
  const LagrangeMesh& mesh;
  GroupNodes ofGroups;
  std::vector<std::uint32_t> order = quadraticOrder(kCgnsPlaces);
};

/// The data of a tree node; type "MT" if it has none.
struct CgnsData {
  const char* type = "MT";
  hid_t ofHdf = -1;
  const void* values = nullptr;
  std::initializer_list<hsize_t> shape = {};  ///< the last index varies fastest

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

/// A CGNS tree being written.
class CgnsFile {
 public:
  explicit CgnsFile(const OutputFile& output) : file_(output, HdfFile::Order::OfCreation) {
    describe(file_.root(), "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
    const std::string_view format =
        std::endian::native == std::endian::little ? "IEEE_LITTLE_32" : "IEEE_BIG_32";
    writeSet(file_.root(), " format", {format, {format.size() + 1}});
    std::array<unsigned, 3> version{};
    HDF5(H5get_libversion)(&version[0], &version[1], &version[2]);
    std::string text = concat("HDF5 Version ", version[0], ".", version[1], ".", version[2]);
    text.resize(kTextBytes);
    writeSet(file_.root(), " hdf5version", {text, {kTextBytes}});
  }

  [[nodiscard]] hid_t root() const noexcept { return file_.root(); }

  /// @param name  at most 32 characters, as is the label
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

/// Begins the tree. @return  the base, which holds the zones
HdfObject addBase(const CgnsFile& file) {
  constexpr float kVersion = 3.4F;
  constexpr std::array<std::int32_t, 2> kDimensions = {3, 3};
  static_cast<void>(
      file.add(file.root(), "CGNSLibraryVersion", "CGNSLibraryVersion_t", {&kVersion, {1}}));
  return file.add(file.root(), "Base", "CGNSBase_t", {kDimensions.data(), {2}});
}

/// @tparam Number  integer type for the 1-based numbers of vertices and elements
template <class Number>
class CgnsWriter {
 public:
  /// @param curved  null: cells are straight
  CgnsWriter(const CgnsFile& file, const HexMesh& mesh, Stage& stage,
             const QuadraticNodes* curved = nullptr)
      : file_(file),
        mesh_(mesh),
        curved_(curved),
        points_(curved != nullptr ? curved->mesh.points : mesh.points),
        progress_(stage, points_.size() + mesh.cells.size()) {}

  /// @param name  of the zone
  HdfObject writeZone(hid_t base, const std::string& name, const MeshGroups& groups) {
    const std::array<Number, 3> size = {static_cast<Number>(points_.size()),
                                        static_cast<Number>(groups.cells.groups.back().end), 0};
    HdfObject zone = file_.add(base, name, "Zone_t", {size.data(), {3, 1}});
    static_cast<void>(file_.addText(zone.id(), "ZoneType", "ZoneType_t", "Unstructured"));
    writePoints(zone.id());
    for (const ElementGroup& group : groups.cells.groups) {
      writeSection(zone.id(), group, curved_ != nullptr ? kCgnsPlaces.size() : 8,
                   [&](std::size_t i, std::size_t k) { return nodeOf(groups.cells.at(i), k); });
    }
    progress_.advance(mesh_.cells.size());
    const Number firstQuad = next_;
    // Writes corners of elements, or all nodes of curved ones.
    const auto writeAll = [&](const auto& ofKind, const Array<Index>* nodes) {
      for (const ElementGroup& group : ofKind.groups) {
        const std::size_t corners = std::tuple_size_v<std::decay_t<decltype(ofKind.elements[0])>>;
        const std::size_t each =
            nodes == nullptr ? corners : nodes->size() / ofKind.elements.size();
        writeSection(zone.id(), group, each, [&](std::size_t i, std::size_t k) {
          return nodes == nullptr ? ofKind.elements[i][k] : (*nodes)[i * each + k];
        });
      }
    };
    writeAll(groups.quads, curved_ != nullptr ? &curved_->ofGroups.quads : nullptr);
    writeBoundary(zone.id(), groups.quads, firstQuad);
    writeAll(groups.edges, curved_ != nullptr ? &curved_->ofGroups.edges : nullptr);
    writeAll(groups.vertices, nullptr);
    return zone;
  }

 private:
  /// Node k of a cell in CGNS order.
  [[nodiscard]] Index nodeOf(std::size_t cell, std::size_t k) const {
    if (curved_ == nullptr) return mesh_.cells[cell][k];
    return curved_->mesh.nodes[cell * kCgnsPlaces.size() + curved_->order[k]];
  }

  void writePoints(hid_t zone) {
    const HdfObject points = file_.add(zone, "GridCoordinates", "GridCoordinates_t");
    Array<double> values(points_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = points_[i][axis];
      static_cast<void>(file_.add(points.id(), concat("Coordinate", "XYZ"[axis]), "DataArray_t",
                                  {values.data(), {values.size()}}));
    }
    progress_.advance(points_.size());
  }

  /// @param each  nodes per element
  /// @param nodeAt  returns the k-th node of an element, given its position in the sorted list
  template <class F>
  void writeSection(hid_t zone, const ElementGroup& group, std::size_t each, const F& nodeAt) {
    if (group.begin == group.end) return;
    Array<Number> vertices((group.end - group.begin) * each);
    Number* place = vertices.data();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      for (std::size_t k = 0; k < each; ++k) *place++ = static_cast<Number>(nodeAt(i, k)) + 1;
    }
    const auto end = static_cast<Number>(next_ + static_cast<Number>(group.end - group.begin));
    const std::array<Number, 2> range = {next_, static_cast<Number>(end - 1)};
    next_ = end;
    const std::array<std::int32_t, 2> kind = {elementType(each), 0};
    const HdfObject section =
        file_.add(zone, group.name, "Elements_t", {kind.data(), {kind.size()}});
    static_cast<void>(
        file_.add(section.id(), "ElementRange", "IndexRange_t", {range.data(), {range.size()}}));
    static_cast<void>(file_.add(section.id(), "ElementConnectivity", "DataArray_t",
                                {vertices.data(), {vertices.size()}}));
  }

  /// Writes a boundary condition and a family for each group. Interior quads are not boundary.
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

  const CgnsFile& file_;
  const HexMesh& mesh_;
  const QuadraticNodes* curved_;
  const Array<Vec3>& points_;
  LoopProgress progress_;
  Number next_ = 1;  ///< number of the next element
};

/// Whether numbers need 64 bits; libraries use the same type for the sizes of sections.
bool needsWide(const HexMesh& mesh, const MeshGroups& groups,
               const QuadraticNodes* curved = nullptr) {
  const std::size_t nodes = curved != nullptr ? curved->mesh.nodes.size() : 8 * mesh.cells.size();
  const auto largest = std::max<std::uint64_t>({mesh.points.size(), groups.elementCount(), nodes});
  return largest > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
}

/// Writes a zone for each part. Connections between two zones are written once both are known.
class CgnsPartSink final : public PartSink {
 public:
  CgnsPartSink(const std::filesystem::path& path, Context& context)
      : context_(context), target_(path, OutputFile::Target::Regular) {}

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "Zones of CGNS files");
    file_.emplace(target_);
    base_.emplace(addBase(*file_));
    std::vector<ElementGroup> families;
    addMissingGroups(families, info.quadTags, true, "surface", "boundary");
    for (const ElementGroup& family : families) {
      static_cast<void>(file_->add(base_->id(), family.name, "Family_t"));
    }
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    std::optional<HdfObject>& zone = zones_.emplace_back();
    shared_.emplace_back();
    if (part.ownCells == 0) return;
    const MeshGroups groups = groupPart(part, info_, stage);
    if (needsWide(part.mesh, groups)) {
      throw Error(ErrorCode::TooLarge,
                  "A part is too large for a zone of a CGNS file. Ask for more parts.");
    }
    zone.emplace(CgnsWriter<std::int32_t>(*file_, part.mesh, stage)
                     .writeZone(base_->id(), nameOf(part.part), groups));
    for (const PartNeighbour& neighbour : part.neighbours) {
      std::vector<std::int32_t>& list = shared_.back()[neighbour.part];
      for (const Index v : neighbour.vertices) list.push_back(static_cast<std::int32_t>(v) + 1);
    }
    addGlobal(zone->id(), "GlobalNodeNumber", "Vertex", part.globalPoints,
              [](std::size_t i) { return i; });
    addGlobal(zone->id(), "GlobalCellNumber", "CellCenter", part.globalCells,
              [&groups](std::size_t i) { return groups.cells.at(i); });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    for (std::uint32_t p = 0; p < zones_.size(); ++p) {
      if (!shared_[p].empty()) connect(p);
    }
    zones_.clear();
    base_->close();
    file_->close();
    target_.commit();
  }

 private:
  [[nodiscard]] std::string nameOf(std::uint32_t part) const {
    return "Part_" + padded(part, info_.parts);
  }
  /// Writes global numbers, from 1 on, as a solution on the zone's vertices or cells.
  template <class At>
  void addGlobal(hid_t zone, const char* name, const char* location,
                 const Array<std::uint64_t>& numbers, const At& at) const {
    std::vector<std::int64_t> values;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      values.push_back(static_cast<std::int64_t>(numbers[at(i)]) + 1);
    }
    const HdfObject solution = file_->add(zone, name, "FlowSolution_t");
    static_cast<void>(file_->addText(solution.id(), "GridLocation", "GridLocation_t", location));
    static_cast<void>(
        file_->add(solution.id(), name, "DataArray_t", {values.data(), {values.size()}}));
  }
  void connect(std::uint32_t part) const {
    const HdfObject all =
        file_->add(zones_[part]->id(), "ZoneGridConnectivity", "ZoneGridConnectivity_t");
    for (const auto& [other, vertices] : shared_[part]) {
      const std::string donor = nameOf(other);
      const HdfObject to =
          file_->add(all.id(), "to_" + donor, "GridConnectivity_t", {donor, {donor.size()}});
      static_cast<void>(file_->addText(to.id(), "GridConnectivityType", "GridConnectivityType_t",
                                       "Abutting1to1"));
      static_cast<void>(file_->addText(to.id(), "GridLocation", "GridLocation_t", "Vertex"));
      const std::vector<std::int32_t>& there = shared_[other].at(part);
      static_cast<void>(file_->add(to.id(), "PointList", "IndexArray_t",
                                   {vertices.data(), {vertices.size(), 1}}));
      static_cast<void>(
          file_->add(to.id(), "PointListDonor", "IndexArray_t", {there.data(), {there.size(), 1}}));
    }
  }

  Context& context_;
  OutputFile target_;
  PartsInfo info_;
  std::optional<CgnsFile> file_;
  std::optional<HdfObject> base_;
  std::deque<std::optional<HdfObject>> zones_;                              ///< empty: no zone
  std::vector<std::map<std::uint32_t, std::vector<std::int32_t>>> shared_;  ///< by neighbour
};

/// @param curved  null: cells are straight
void writeBase(const OutputFile& target, const HexMesh& mesh, const MeshGroups& groups,
               Stage& stage, const QuadraticNodes* curved = nullptr) {
  CgnsFile tree(target);
  {
    const HdfObject base = addBase(tree);
    for (const ElementGroup& group : groups.quads.groups) {
      if (groups.quads.boundaryEnd(group) == group.begin) continue;
      static_cast<void>(tree.add(base.id(), group.name, "Family_t"));
    }
    if (needsWide(mesh, groups, curved)) {
      static_cast<void>(
          CgnsWriter<std::int64_t>(tree, mesh, stage, curved).writeZone(base.id(), "Zone", groups));
    } else {
      static_cast<void>(
          CgnsWriter<std::int32_t>(tree, mesh, stage, curved).writeZone(base.id(), "Zone", groups));
    }
  }
  tree.close();
}

void refuseEmpty(std::size_t cells, const OutputFile& output) {
  if (cells > 0) return;
  throw Error(ErrorCode::InvalidArgument,
              output.target().string() + ": the mesh is empty, which a CGNS file cannot hold.");
}

}  // namespace

void writeCgns(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage) {
  refuseEmpty(mesh.cells.size(), output);
  writeBase(output, mesh, MeshGroups(mesh, options, stage), stage);
}

void writeQuadraticCgns(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                        Stage& stage) {
  refuseEmpty(mesh.cellCount(), output);
  const HexMesh straight = straightMesh(mesh);
  const MeshGroups groups(straight, options, stage);
  const QuadraticNodes nodes = {mesh,
                                nodesOfGroups(mesh, straight, groups.edges, groups.quads, stage)};
  writeBase(output, straight, groups, stage, &nodes);
}

std::unique_ptr<PartSink> openCgnsPartSink(const std::filesystem::path& file, Context& context,
                                           ProcessTeam* /*team*/) {
  return std::make_unique<CgnsPartSink>(file, context);
}

}  // namespace hexhex::io
