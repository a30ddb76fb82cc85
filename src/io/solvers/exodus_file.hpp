// What an Exodus file is: dimensions, attributes and variables of a NetCDF file that have the names
// by which its library knows them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/version.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/solvers/netcdf.hpp>

namespace hexhex::io {

/// Exodus' numbers of the faces of kHexFaces.
inline constexpr std::array<std::int32_t, 6> kExodusSides = {4, 2, 1, 3, 5, 6};

/// Bytes of a name; the last one is 0.
inline constexpr std::size_t kExodusNameBytes = 33;
inline constexpr std::size_t kExodusLineBytes = 81;

/// Of an array in the layout that all readers know: 4 GB.
inline constexpr std::uint64_t kMostExodusBytes = 0xffff'fff0;

/// Exodus counts from 1 on.
constexpr std::int32_t fromOne(std::size_t i) { return static_cast<std::int32_t>(i) + 1; }

/// Where each cell stands in the order of the blocks; empty: as they are.
inline Array<Index> placesOf(const CellGroups& cells) {
  Array<Index> places(cells.order.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[cells.at(i)] = static_cast<Index>(i);
  return places;
}

/// What is said of all blocks, or all sets of a kind.
struct ExodusList {
  std::vector<std::int32_t> numbers;
  std::vector<std::string> names;
  std::vector<std::uint64_t> counts;  ///< of elements; without any it has no variables

  /// @return  the end of the names of its variables
  std::string add(std::int32_t number, const std::string& name, std::uint64_t count) {
    numbers.push_back(number);
    names.push_back(name);
    counts.push_back(count);
    return std::to_string(names.size());
  }
};

class ExodusFile {
 public:
  /// @param allGroups  whether there are sets for groups without elements, too
  ExodusFile(const HexMesh& mesh, const MeshGroups& groups, Stage& stage, bool allGroups = false)
      : mesh_(mesh),
        groups_(groups),
        allGroups_(allGroups),
        progress_(stage, 3 * mesh.points.size() + mesh.cells.size()) {
    describe();
    if (!mesh.points.empty()) addPoints();
    if (groups.cells.groups.back().end > 0 || allGroups) addBlocks();
    addSideSets();
    addNodeSets();
    addVariable("time_whole", NetcdfType::Double, {addDimension("time_step", 0)}, {});
  }

  void write(OutputFile& output, int threads, std::uint64_t mostBytes) const {
    file_.write(output, threads, mostBytes);
  }

 protected:
  using Write = std::function<void(LineWriter&)>;

  /// The place of a dimension that there is.
  [[nodiscard]] std::uint32_t dimensionOf(const std::string& name) const {
    const auto found =
        std::find_if(file_.dimensions.begin(), file_.dimensions.end(),
                     [&name](const NetcdfDimension& dimension) { return dimension.name == name; });
    return static_cast<std::uint32_t>(found - file_.dimensions.begin());
  }
  /// @return  its place
  std::uint32_t addDimension(const std::string& name, std::size_t length) {
    file_.dimensions.push_back({name, length});
    return static_cast<std::uint32_t>(file_.dimensions.size() - 1);
  }
  /// @param text  of an attribute, if there is one
  void addVariable(const std::string& name, NetcdfType type, std::vector<std::uint32_t> dimensions,
                   Write write, const char* attribute = nullptr, const std::string& text = {}) {
    file_.variables.push_back({name, type, std::move(dimensions), {}, std::move(write)});
    if (attribute == nullptr) return;
    file_.variables.back().attributes.push_back({attribute, text + '\0'});
  }
  void addNumbers(const std::string& name, std::uint32_t dimension,
                  std::vector<std::int32_t> numbers, const char* attribute = nullptr) {
    const Write write = [numbers = std::move(numbers)](LineWriter& values) {
      const auto put = [&](char* place, std::size_t i) { return putBigBytes(place, numbers[i]); };
      values.write(numbers.size(), sizeof(std::int32_t), put, nullptr);
    };
    addVariable(name, NetcdfType::Int, {dimension}, write, attribute, "ID");
  }
  void addTexts(const std::string& name, std::uint32_t dimension, std::uint32_t ofBytes,
                std::size_t bytes, std::vector<std::string> texts) {
    for (std::string& text : texts) text.resize(bytes);
    const Write write = [texts = std::move(texts), bytes](LineWriter& values) {
      const auto copy = [&](char* place, std::size_t i) { return put(place, texts[i]); };
      values.write(texts.size(), bytes, copy, nullptr);
    };
    addVariable(name, NetcdfType::Char, {dimension, ofBytes}, write);
  }
  /// @param prefix  of the variables' names
  void addList(const std::string& prefix, const char* dimension, const ExodusList& list) {
    if (list.names.empty()) return;
    const std::uint32_t length = addDimension(dimension, list.names.size());
    std::vector<std::int32_t> isThere;
    for (const std::uint64_t count : list.counts) isThere.push_back(count > 0 ? 1 : 0);
    addNumbers(prefix + "_status", length, std::move(isThere));
    addNumbers(prefix + "_prop1", length, list.numbers, "name");
    addTexts(prefix + "_names", length, ofNames_, kExodusNameBytes, list.names);
  }

  void describe() {
    constexpr float kVersion = 6.02F;
    file_.attributes = {{"api_version", kVersion},
                        {"version", kVersion},
                        {"floating_point_word_size", std::int32_t{sizeof(double)}},
                        {"file_size", std::int32_t{1}},  // each axis is a variable
                        {"maximum_name_length", std::int32_t{kExodusNameBytes - 1}},
                        {"int64_status", std::int32_t{0}},  // integers have 32 bits
                        {"title", std::string("hexahedral mesh by hexhex") + '\0'}};
    ofNames_ = addDimension("len_name", kExodusNameBytes);
    addTexts("coor_names", addDimension("num_dim", 3), ofNames_, kExodusNameBytes, {"x", "y", "z"});
    addTexts("info_records", addDimension("num_info", 1),
             addDimension("len_line", kExodusLineBytes), kExodusLineBytes,
             {std::string("by hexhex ") + version()});
  }

  void addPoints() {
    const std::uint32_t length = addDimension("num_nodes", mesh_.points.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Write write = [this, axis](LineWriter& values) {
        const auto put = [&](char* place, std::size_t i) {
          return putBigBytes(place, mesh_.points[i][axis]);
        };
        values.write(mesh_.points.size(), sizeof(double), put, &progress_);
      };
      addVariable(
          std::string("coord") + "xyz" [axis], NetcdfType::Double, { length }, write);
    }
  }

  void addBlocks() {
    if (const std::size_t all = groups_.cells.groups.back().end; all > 0) {
      addDimension("num_elem", all);
    }
    ExodusList& blocks = blocks_;
    for (const ElementGroup& group : groups_.cells.groups) {
      const std::size_t count = group.end - group.begin;
      const std::string n = blocks.add(static_cast<std::int32_t>(group.number), group.name, count);
      if (count == 0) continue;
      const Write write = [this, &group, count](LineWriter& values) {
        const auto put = [&](char* place, std::size_t i) {
          for (const Index vertex : mesh_.cells[groups_.cells.at(group.begin + i)]) {
            place = putBigBytes(place, fromOne(vertex));
          }
          return place;
        };
        values.write(count, 8 * sizeof(std::int32_t), put, &progress_);
      };
      const std::uint32_t length = addDimension("num_el_in_blk" + n, count);
      addVariable("connect" + n, NetcdfType::Int, {length, addDimension("num_nod_per_el" + n, 8)},
                  write, "elem_type", "HEX8");
    }
    addList("eb", "num_el_blk", blocks);
  }

  /// The sides of each group of boundary quads.
  void addSideSets() {
    const Array<Index> places = placesOf(groups_.cells);
    ExodusList& sets = sides_;
    for (const ElementGroup& group : groups_.quads.groups) {
      std::vector<std::int32_t> cells;
      std::vector<std::int32_t> sides;
      const std::size_t end = groups_.quads.boundaryEnd(group);  // behind it, quads inside the mesh
      for (std::size_t i = group.begin; i < end; ++i) {
        const std::size_t cell = groups_.quads.places[i] / 8;
        cells.push_back(fromOne(places.empty() ? cell : places[cell]));
        sides.push_back(kExodusSides[groups_.quads.places[i] % 8]);
      }
      if (cells.empty() && !allGroups_) continue;
      const std::string n =
          sets.add(static_cast<std::int32_t>(group.number), group.name, cells.size());
      if (cells.empty()) continue;
      const std::uint32_t length = addDimension("num_side_ss" + n, cells.size());
      addNumbers("elem_ss" + n, length, std::move(cells));
      addNumbers("side_ss" + n, length, std::move(sides));
    }
    addList("ss", "num_side_sets", sets);
  }

  /// The vertices of each group of edges and of vertices.
  void addNodeSets() {
    ExodusList& sets = nodes_;
    const auto add = [&](const auto& ofKind) {
      for (const ElementGroup& group : ofKind.groups) {
        std::vector<std::int32_t> vertices;
        for (const Index vertex : verticesOf(ofKind, group)) vertices.push_back(fromOne(vertex));
        const std::string n = sets.add(fromOne(sets.names.size()), group.name, vertices.size());
        if (vertices.empty()) continue;
        const std::uint32_t length = addDimension("num_nod_ns" + n, vertices.size());
        addNumbers("node_ns" + n, length, std::move(vertices));
      }
    };
    add(groups_.edges);
    add(groups_.vertices);
    addList("ns", "num_node_sets", sets);
  }

  const HexMesh& mesh_;
  const MeshGroups& groups_;
  bool allGroups_;
  mutable LoopProgress progress_;
  NetcdfFile file_;
  std::uint32_t ofNames_ = 0;  ///< the dimension of their bytes
  ExodusList blocks_;
  ExodusList sides_;
  ExodusList nodes_;
};

}  // namespace hexhex::io
