// Writes MFEM meshes (see formats.hpp): straight cells, Lagrange cells, and parts.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/curved.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

/// Writes the sections common to all files.
class MfemWriter {
 public:
  MfemWriter(OutputFile& output, int threads) : output_(output), lines_(output, threads) {}

  /// Writes cells and quads with their attributes.
  /// @param regions  of the cells; empty: all are 1
  /// @param progress  may be null
  void writeElements(std::string_view version, std::span<const Hex> cells,
                     std::span<const std::uint32_t> regions, const QuadGroups& quads,
                     LoopProgress* progress) {
    output_.write("MFEM mesh ").write(version).write("\n\ndimension\n3\n\nelements\n");
    output_.write(cells.size()).write('\n');
    const auto cell = [&](char* place, std::size_t i) {
      place = put(put(place, regions.empty() ? 1U : regions[i]), " 5 ");  // 5: cube
      return put(putNumbers(place, cells[i]), '\n');
    };
    lines_.write(cells.size(), 10 * (kNumberRoom + 1), cell, progress);
    output_.write("\nboundary\n").write(quads.elements.size()).write('\n');
    for (const ElementGroup& group : quads.groups) {
      const auto quad = [&](char* place, std::size_t i) {
        place = put(put(place, group.number), " 3 ");  // 3: square
        return put(putNumbers(place, quads.elements[group.begin + i]), '\n');
      };
      lines_.write(group.end - group.begin, 6 * (kNumberRoom + 1), quad, progress);
    }
    output_.write("\nvertices\n");
  }
  /// @param pointAt  returns the i-th of n points
  template <class F>
  void writePoints(std::size_t n, const F& pointAt, LoopProgress* progress) {
    const auto point = [&](char* place, std::size_t i) {
      return put(putNumbers(place, pointAt(i)), '\n');
    };
    lines_.write(n, 3 * (kNumberRoom + 1), point, progress);
  }

 private:
  OutputFile& output_;
  LineWriter lines_;
};

QuadGroups quadsOfWhole(const HexMesh& mesh, const WriteOptions& options, Stage& stage) {
  QuadGroups quads;
  withThreads(stage.context().threads(),
              [&] { quads = groupQuads(mesh, options.patchAngle, stage); });
  return quads;
}

/// A set of parts that share something, ascending; at least two.
using PartGroup = std::vector<std::uint32_t>;

/// What the parts of a group share, as local vertices; in the same order in all these parts.
struct SharedElements {
  std::vector<Index> vertices;
  std::vector<std::array<Index, 2>> edges;
  std::vector<Quad> faces;
};

class SharedByGroup {
 public:
  explicit SharedByGroup(const MeshPart& part) : part_(part) {
    addVertices();
    addEdges();
    addFaces();
  }
  [[nodiscard]] const std::map<PartGroup, SharedElements>& groups() const noexcept {
    return groups_;
  }

 private:
  void addVertices() {
    parts_.resize(part_.ownPoints);
    for (const PartNeighbour& neighbour : part_.neighbours) {
      for (const Index v : neighbour.vertices) parts_[v].push_back(neighbour.part);
    }
    // Local numbers of own vertices are in order of global ones.
    for (Index v = 0; v < parts_.size(); ++v) {
      if (parts_[v].empty()) continue;
      groups_[withOwn(parts_[v])].vertices.push_back(v);
    }
  }

  /// Finds shared edges: another part has an edge if one of its cells does, found among the first
  /// layer of ghosts.
  void addEdges() {
    std::map<std::array<Index, 2>, PartGroup> edges;
    for (std::size_t c = 0; c < part_.mesh.cells.size(); ++c) {
      const std::uint32_t owner =
          c < part_.ownCells ? part_.part : part_.ghostParts[c - part_.ownCells];
      for (const auto& ends : adjacency::kHexEdges) {
        std::array<Index, 2> edge = {part_.mesh.cells[c][ends[0]], part_.mesh.cells[c][ends[1]]};
        if (!isShared(edge[0]) || !isShared(edge[1])) continue;
        std::sort(edge.begin(), edge.end());
        edges[edge].push_back(owner);
      }
    }
    for (auto& [edge, owners] : edges) {
      sortUnique(owners);
      const bool isOwn = std::binary_search(owners.begin(), owners.end(), part_.part);
      if (isOwn && owners.size() > 1) groups_[owners].edges.push_back(edge);
    }
  }

  /// Orients faces from the smallest vertex to its smaller neighbour.
  void addFaces() {
    for (const PartNeighbour& neighbour : part_.neighbours) {
      for (const PartFace& face : neighbour.faces) {
        Quad quad = adjacency::faceVertices(part_.mesh.cells[face.cell], face.side);
        std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
        if (quad[3] < quad[1]) std::swap(quad[1], quad[3]);
        groups_[withOwn({neighbour.part})].faces.push_back(quad);
      }
    }
  }

  [[nodiscard]] bool isShared(Index v) const { return v < parts_.size() && !parts_[v].empty(); }
  [[nodiscard]] PartGroup withOwn(PartGroup others) const {
    others.insert(std::lower_bound(others.begin(), others.end(), part_.part), part_.part);
    return others;
  }

  const MeshPart& part_;
  std::vector<PartGroup> parts_;  ///< per own vertex: the other parts that have it
  std::map<PartGroup, SharedElements> groups_;
};

/// Writes a serial mesh for each part, followed by the vertices, edges and faces that it shares,
/// grouped by the set of parts that share them.
class MfemSink final : public PartSink {
 public:
  MfemSink(std::filesystem::path file, Context& context, ProcessTeam* team)
      : context_(context), file_(std::move(file)), files_(team) {}

  [[nodiscard]] std::uint32_t neededGhostLayers() const override { return 1; }

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "MFEM's files");
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    constexpr std::size_t kDigits = 6;
    std::string number = std::to_string(part.part);
    number.insert(0, kDigits - std::min(kDigits, number.size()), '0');
    OutputFile& output = files_.add(file_.string() + '.' + number);
    writeSerial(output, part, stage);
    writeShared(output, SharedByGroup(part).groups(), part.part);
    files_.finishLast();
  }
  void end() override { files_.commit(); }

 private:
  void writeSerial(OutputFile& output, const MeshPart& part, Stage& stage) const {
    const MeshGroups groups = groupPart(part, info_, stage);
    const Array<std::uint32_t> numbers = groupNumbers(groups.cells.groups);
    std::vector<std::uint32_t> regions(part.ownCells, 1);
    for (std::size_t i = 0; i < numbers.size(); ++i) regions[groups.cells.at(i)] = numbers[i];
    MfemWriter writer(output, context_.threads());
    writer.writeElements("v1.2", std::span<const Hex>(part.mesh.cells).first(part.ownCells),
                         regions, groups.quads, nullptr);
    output.write(part.ownPoints).write("\n3\n");
    writer.writePoints(
        part.ownPoints, [&](std::size_t i) -> const Vec3& { return part.mesh.points[i]; }, nullptr);
    output.write("\nmfem_serial_mesh_end\n");
  }

  static void writeShared(OutputFile& output, const std::map<PartGroup, SharedElements>& groups,
                          std::uint32_t part) {
    output.write("\ncommunication_groups\nnumber_of_groups ").write(groups.size() + 1);
    output.write("\n\n# number of entities in each group, followed by ranks in group\n1 ");
    output.write(part).write('\n');
    std::array<std::size_t, 3> totals{};
    for (const auto& [parts, shared] : groups) {
      output.write(parts.size());
      for (const std::uint32_t each : parts) output.write(' ').write(each);
      output.write('\n');
      totals[0] += shared.vertices.size();
      totals[1] += shared.edges.size();
      totals[2] += shared.faces.size();
    }
    output.write("\ntotal_shared_vertices ").write(totals[0]);
    output.write("\ntotal_shared_edges ").write(totals[1]);
    output.write("\ntotal_shared_faces ").write(totals[2]).write('\n');
    std::size_t number = 0;
    for (const auto& [parts, shared] : groups) {
      output.write("\n# group ").write(++number);
      output.write("\nshared_vertices ").write(shared.vertices.size()).write('\n');
      for (const Index v : shared.vertices) output.write(v).write('\n');
      output.write("\nshared_edges ").write(shared.edges.size()).write('\n');
      for (const auto& edge : shared.edges) {
        output.write(edge[0]).write(' ').write(edge[1]).write('\n');
      }
      output.write("\nshared_faces ").write(shared.faces.size()).write('\n');
      for (const Quad& face : shared.faces) {
        output.write('3');  // square
        for (const Index v : face) output.write(' ').write(v);
        output.write('\n');
      }
    }
    output.write("\nmfem_mesh_end\n");
  }

  Context& context_;
  std::filesystem::path file_;
  PartsInfo info_;
  FileSet files_;
};

}  // namespace

void writeMfem(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage) {
  MfemWriter writer(output, stage.context().threads());
  const QuadGroups quads = quadsOfWhole(mesh, options, stage);
  LoopProgress progress(stage, mesh.cells.size() + quads.elements.size() + mesh.points.size());
  writer.writeElements("v1.0", mesh.cells, cellReferences(mesh), quads, &progress);
  output.write(mesh.points.size()).write("\n3\n");
  writer.writePoints(
      mesh.points.size(), [&](std::size_t i) -> const Vec3& { return mesh.points[i]; }, &progress);
}

void writeLagrangeMfem(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                       Stage& stage) {
  MfemWriter writer(output, stage.context().threads());
  const HexMesh straight = straightMesh(mesh);
  const QuadGroups quads = quadsOfWhole(straight, options, stage);
  LoopProgress progress(stage, straight.cells.size() + quads.elements.size() + mesh.nodes.size());
  writer.writeElements("v1.0", straight.cells, cellReferences(straight), quads, &progress);
  // L2_T4: per-cell polynomials given by values at equidistant nodes, x fastest: the order of
  // LagrangeMesh. Ordering 1: the coordinates of a node are consecutive.
  output.write(straight.points.size());
  output.write("\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T4_3D_P");
  output.write(static_cast<unsigned>(mesh.order)).write("\nVDim: 3\nOrdering: 1\n\n");
  writer.writePoints(
      mesh.nodes.size(), [&](std::size_t i) -> const Vec3& { return mesh.points[mesh.nodes[i]]; },
      &progress);
}

std::unique_ptr<PartSink> openMfemPartSink(const std::filesystem::path& file, Context& context,
                                           ProcessTeam* team) {
  return std::make_unique<MfemSink>(file, context, team);
}

}  // namespace hexhex::io
