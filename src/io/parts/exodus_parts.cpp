// Exodus files of parts with Nemesis' maps, `NAME.e.N.K`: which nodes and cells are shared, and
// what the whole mesh has.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/parts/file_set.hpp>
#include <io/parts/part_groups.hpp>
#include <io/parts/parts.hpp>
#include <io/solvers/exodus_file.hpp>

namespace hexhex::io {
namespace {

std::vector<std::int32_t> fromOneAll(const Array<std::uint64_t>& numbers, std::size_t count) {
  std::vector<std::int32_t> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i) result.push_back(fromOne(numbers[i]));
  return result;
}

/// Numbers in a file that are sums over all parts.
struct GlobalCounts {
  std::uint64_t position;
  std::vector<std::uint64_t> ofPart;
};

class NemesisFile final : public ExodusFile {
 public:
  NemesisFile(const MeshPart& part, const PartsInfo& info, const MeshGroups& groups, Stage& stage)
      : ExodusFile(part.mesh, groups, stage, true), part_(part), groups_(groups) {
    addScalar("nem_ftype", 0);  // one file for each part
    addDimension("num_processors", info.parts);
    inFile_ = addDimension("num_procs_file", 1);
    addDimension("num_nodes_global", info.pointCount);
    addDimension("num_elems_global", info.cellCount);
    addGlobalSets();
    addMaps();
    addNodes();
    addCells();
  }

  /// Where the sizes of the mesh's blocks and sets stand, and what this part has of them; each
  /// node of a set counts where it is owned.
  [[nodiscard]] std::vector<GlobalCounts> globalCounts(std::uint64_t mostBytes) const {
    std::vector<GlobalCounts> counts;
    if (!blocks_.numbers.empty()) {
      counts.push_back({file_.positionOf("el_blk_cnt_global", mostBytes), blocks_.counts});
    }
    if (!sides_.numbers.empty()) {
      counts.push_back({file_.positionOf("ss_side_cnt_global", mostBytes), sides_.counts});
    }
    if (!nodes_.numbers.empty()) {
      counts.push_back({file_.positionOf("ns_node_cnt_global", mostBytes), ownedNodes()});
    }
    return counts;
  }

 private:
  [[nodiscard]] std::vector<std::uint64_t> ownedNodes() const {
    std::vector<std::uint64_t> counts;
    const auto add = [&](const auto& ofKind) {
      for (const ElementGroup& group : ofKind.groups) {
        const Array<Index> vertices = verticesOf(ofKind, group);
        counts.push_back(static_cast<std::uint64_t>(
            std::count_if(vertices.begin(), vertices.end(),
                          [this](Index v) { return part_.pointOwners[v] == part_.part; })));
      }
    };
    add(groups_.edges);
    add(groups_.vertices);
    return counts;
  }

  void addScalar(const std::string& name, std::int32_t number) {
    const Write write = [number](LineWriter& values) {
      const auto put = [number](char* place, std::size_t) { return putBigBytes(place, number); };
      values.write(1, sizeof(number), put, nullptr);
    };
    addVariable(name, NetcdfType::Int, {}, write);
  }
  /// A list, and its length as a dimension; nothing if it is empty, which is how NetCDF says that.
  void addListOf(const std::string& name, const std::string& dimension,
                 std::vector<std::int32_t> numbers) {
    if (numbers.empty()) return;
    const std::uint32_t length = addDimension(dimension, numbers.size());
    addNumbers(name, length, std::move(numbers));
  }
  void addStatus(const std::string& name, bool isThere) {
    addNumbers(name, inFile_, {isThere ? 1 : 0});
  }

  /// Blocks and sets of the whole mesh. How many elements they have is known when all parts are.
  void addGlobalSets() {
    addCounted("el_blk", "num_el_blk_global", blocks_, {"el_blk_cnt_global"});
    addCounted("ss", "num_ss_global", sides_, {"ss_side_cnt_global", "ss_df_cnt_global"});
    addCounted("ns", "num_ns_global", nodes_, {"ns_node_cnt_global", "ns_df_cnt_global"});
  }
  void addCounted(const std::string& prefix, const std::string& dimension, const ExodusList& list,
                  const std::vector<std::string>& counts) {
    if (list.numbers.empty()) return;
    const std::uint32_t length = addDimension(dimension, list.numbers.size());
    addNumbers(prefix + "_ids_global", length, list.numbers);
    for (const std::string& name : counts) {
      addNumbers(name, length, std::vector<std::int32_t>(list.numbers.size(), 0));
    }
  }

  /// Global numbers of nodes, and of cells in the order of the blocks.
  void addMaps() {
    if (part_.ownCells == 0) return;
    addNumbers("node_num_map", dimensionOf("num_nodes"),
               fromOneAll(part_.globalPoints, part_.ownPoints));
    std::vector<std::int32_t> cells;
    for (std::size_t i = 0; i < part_.ownCells; ++i) {
      cells.push_back(fromOne(part_.globalCells[groups_.cells.at(i)]));
    }
    addNumbers("elem_num_map", dimensionOf("num_elem"), std::move(cells));
  }

  /// Inner and shared nodes, and with whom each is shared.
  void addNodes() {
    std::vector<bool> shared(part_.ownPoints, false);
    std::vector<std::int32_t> ids;
    std::vector<std::int32_t> ends;
    std::vector<std::int32_t> nodes;
    std::vector<std::int32_t> parts;
    for (const PartNeighbour& neighbour : part_.neighbours) {
      ids.push_back(fromOne(ids.size()));
      for (const Index v : neighbour.vertices) {
        shared[v] = true;
        nodes.push_back(fromOne(v));
        parts.push_back(static_cast<std::int32_t>(neighbour.part));
      }
      ends.push_back(static_cast<std::int32_t>(nodes.size()));
    }
    std::vector<std::int32_t> inner;
    std::vector<std::int32_t> border;
    for (std::size_t v = 0; v < part_.ownPoints; ++v) {
      (shared[v] ? border : inner).push_back(fromOne(v));
    }
    addStatus("int_n_stat", !inner.empty());
    addStatus("bor_n_stat", !border.empty());
    addStatus("ext_n_stat", false);
    addListOf("node_mapi", "num_int_node", std::move(inner));
    addListOf("node_mapb", "num_bor_node", std::move(border));
    if (ids.empty()) return;
    const std::uint32_t maps = addDimension("num_n_cmaps", ids.size());
    const std::uint32_t all = addDimension("ncnt_cmap", nodes.size());
    addNumbers("n_comm_ids", maps, std::move(ids));
    addNumbers("n_comm_stat", maps, std::vector<std::int32_t>(part_.neighbours.size(), 1));
    addNumbers("n_comm_data_idx", maps, std::move(ends));
    addNumbers("n_comm_nids", all, std::move(nodes));
    addNumbers("n_comm_proc", all, std::move(parts));
  }

  /// Cells with and without a face to another part, and these faces.
  void addCells() {
    const Array<Index> places = placesOf(groups_.cells);
    std::vector<bool> atBorder(part_.ownCells, false);
    std::vector<std::int32_t> ids;
    std::vector<std::int32_t> ends;
    std::vector<std::int32_t> cells;
    std::vector<std::int32_t> sides;
    std::vector<std::int32_t> parts;
    for (const PartNeighbour& neighbour : part_.neighbours) {
      if (neighbour.faces.empty()) continue;
      ids.push_back(fromOne(ids.size()));
      for (const PartFace& face : neighbour.faces) {
        const std::size_t place = places.empty() ? face.cell : places[face.cell];
        atBorder[place] = true;
        cells.push_back(fromOne(place));
        sides.push_back(kExodusSides[face.side]);
        parts.push_back(static_cast<std::int32_t>(neighbour.part));
      }
      ends.push_back(static_cast<std::int32_t>(cells.size()));
    }
    std::vector<std::int32_t> inner;
    std::vector<std::int32_t> border;
    for (std::size_t c = 0; c < part_.ownCells; ++c) {
      (atBorder[c] ? border : inner).push_back(fromOne(c));
    }
    addStatus("int_e_stat", !inner.empty());
    addStatus("bor_e_stat", !border.empty());
    addListOf("elem_mapi", "num_int_elem", std::move(inner));
    addListOf("elem_mapb", "num_bor_elem", std::move(border));
    if (ids.empty()) return;
    const std::size_t count = ids.size();
    const std::uint32_t maps = addDimension("num_e_cmaps", count);
    const std::uint32_t all = addDimension("ecnt_cmap", cells.size());
    addNumbers("e_comm_ids", maps, std::move(ids));
    addNumbers("e_comm_stat", maps, std::vector<std::int32_t>(count, 1));
    addNumbers("e_comm_data_idx", maps, std::move(ends));
    addNumbers("e_comm_eids", all, std::move(cells));
    addNumbers("e_comm_proc", all, std::move(parts));
    addNumbers("e_comm_sids", all, std::move(sides));
  }

  const MeshPart& part_;
  const MeshGroups& groups_;
  std::uint32_t inFile_ = 0;
};

class ExodusSink final : public PartSink {
 public:
  ExodusSink(std::filesystem::path file, Context& context, ProcessTeam* team)
      : context_(context), file_(std::move(file)), team_(team), files_(team) {}

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "Exodus files");
    requireInt32(info.pointCount, "Exodus numbers vertices");
    requireInt32(info.cellCount, "Exodus numbers cells");
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    const MeshGroups groups = groupPart(part, info_, stage);
    const NemesisFile file(part, info_, groups, stage);
    file.write(files_.add(fileOf(part.part)), context_.threads(), kMostExodusBytes);
    files_.finishLast();
    counts_.push_back(file.globalCounts(kMostExodusBytes));
    for (std::size_t i = 0; i < counts_.back().size(); ++i) {
      const std::vector<std::uint64_t>& ofPart = counts_.back()[i].ofPart;
      if (sums_.size() <= i) sums_.emplace_back(ofPart.size(), 0);
      for (std::size_t k = 0; k < ofPart.size(); ++k) sums_[i][k] += ofPart[k];
    }
  }

  void end() override {
    Stage stage(context_, "write mesh");
    if (team_ != nullptr) addUp();
    files_.commit([&](std::size_t p, OutputFile& file) {
      for (std::size_t i = 0; i < counts_[p].size(); ++i) {
        std::string bytes(sizeof(std::int32_t) * sums_[i].size(), '\0');
        char* place = bytes.data();
        for (const std::uint64_t sum : sums_[i]) {
          place = putBigBytes(place, static_cast<std::int32_t>(sum));
        }
        file.writeBytesAt(counts_[p][i].position, bytes.data(), bytes.size());
      }
    });
  }

 private:
  /// Sums of all processes; their lists have the same lengths.
  void addUp() {
    std::vector<std::uint64_t> mine;
    for (const auto& sums : sums_) mine.insert(mine.end(), sums.begin(), sums.end());
    const GatheredNumbers all = team_->gather(mine);
    std::size_t next = 0;
    for (auto& sums : sums_) {
      for (std::uint64_t& sum : sums) {
        sum = 0;
        for (std::uint32_t r = 0; r < team_->size(); ++r) sum += all.of(r)[next];
        ++next;
      }
    }
  }
  [[nodiscard]] std::filesystem::path fileOf(std::uint32_t part) const {
    return file_.string() + '.' + std::to_string(info_.parts) + '.' + padded(part, info_.parts);
  }

  Context& context_;
  std::filesystem::path file_;
  ProcessTeam* team_;
  PartsInfo info_;
  FileSet files_;
  std::vector<std::vector<GlobalCounts>> counts_;  ///< per part
  std::vector<std::vector<std::uint64_t>> sums_;   ///< of all parts
};

}  // namespace

std::unique_ptr<PartSink> openExodusPartSink(const std::filesystem::path& file,
                                             const WriteOptions& /*options*/, Context& context,
                                             ProcessTeam* team) {
  return std::make_unique<ExodusSink>(file, context, team);
}

}  // namespace hexhex::io
