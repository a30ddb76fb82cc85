// Gmsh's files of Lagrange cells.
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <base/parallel.hpp>
#include <io/core/output_file.hpp>
#include <io/curved/lagrange_elements.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/curved/lagrange_order.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/gmsh_types.hpp>
#include <io/gmsh/msh41_writer.hpp>

namespace hexhex {
namespace {

// Gmsh's types of elements of order 1 to 9.
constexpr std::array<unsigned, kMaxOrder> kLines = {1, 8, 26, 27, 28, 62, 63, 64, 65};
constexpr std::array<unsigned, kMaxOrder> kQuads = {3, 10, 36, 37, 38, 47, 48, 49, 50};
constexpr std::array<unsigned, kMaxOrder> kHexahedra = {5, 12, 92, 93, 94, 95, 96, 97, 98};

/// Elements whose nodes lie one after the other.
class NodeRows {
 public:
  NodeRows(std::span<const Index> nodes, std::size_t each) : nodes_(nodes), each_(each) {}

  [[nodiscard]] std::size_t size() const { return nodes_.size() / each_; }
  [[nodiscard]] std::span<const Index> operator[](std::size_t i) const {
    return nodes_.subspan(i * each_, each_);
  }
  [[nodiscard]] NodeRows subspan(std::size_t begin, std::size_t count) const {
    return {nodes_.subspan(begin * each_, count * each_), each_};
  }

 private:
  std::span<const Index> nodes_;
  std::size_t each_;
};

/// The nodes of a cell in the order of a file.
class CellInOrder {
 public:
  class Iterator {
   public:
    Iterator(const Index* nodes, const std::uint32_t* at) : nodes_(nodes), at_(at) {}
    Index operator*() const { return nodes_[*at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const Index* nodes_;
    const std::uint32_t* at_;
  };

  CellInOrder(const Index* nodes, std::span<const std::uint32_t> order)
      : nodes_(nodes), order_(order) {}
  [[nodiscard]] std::size_t size() const { return order_.size(); }
  [[nodiscard]] Iterator begin() const { return {nodes_, order_.data()}; }
  [[nodiscard]] Iterator end() const { return {nodes_, order_.data() + order_.size()}; }

 private:
  const Index* nodes_;
  std::span<const std::uint32_t> order_;
};

/// All cells, sorted by region.
class CellsInOrder {
 public:
  CellsInOrder(const LagrangeMesh& mesh, const CellGroups& groups,
               std::span<const std::uint32_t> order)
      : mesh_(&mesh), groups_(&groups), order_(order), count_(mesh.cellCount()) {}

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] CellInOrder operator[](std::size_t i) const {
    return {mesh_->nodes.data() + groups_->at(begin_ + i) * order_.size(), order_};
  }
  [[nodiscard]] CellsInOrder subspan(std::size_t begin, std::size_t count) const {
    CellsInOrder part = *this;
    part.begin_ += begin;
    part.count_ = count;
    return part;
  }

 private:
  const LagrangeMesh* mesh_;
  const CellGroups* groups_;
  std::span<const std::uint32_t> order_;
  std::size_t begin_ = 0;
  std::size_t count_;
};

/// A mesh of higher order as Gmsh sees it.
struct LagrangeContent {
  const LagrangeMesh& mesh;
  std::span<const Vec3> points;
  GmshGroups groups;
  Array<Index> lines;  ///< nodes of edges, and of quads
  Array<Index> quads;
  std::vector<std::uint32_t> cellOrder;

  LagrangeContent(const LagrangeMesh& mesh_, const WriteOptions& options, Stage& stage)
      : LagrangeContent(mesh_, straightMesh(mesh_), options, stage) {}

  [[nodiscard]] std::size_t perEdge() const { return static_cast<std::size_t>(mesh.order) + 1; }
  [[nodiscard]] std::size_t elementCount() const {
    return groups.vertices.elements.size() + groups.edges.elements.size() +
           groups.quads.elements.size() + mesh.cellCount();
  }
  template <class F>
  void forEachKind(const F& f) const {
    const std::size_t type = perEdge() - 2;
    f(0U, kGmshPoint, std::span(groups.vertices.elements));
    f(1U, kLines[type], NodeRows(lines, perEdge()));
    f(2U, kQuads[type], NodeRows(quads, perEdge() * perEdge()));
    f(3U, kHexahedra[type], CellsInOrder(mesh, groups.cells, cellOrder));
  }

 private:
  LagrangeContent(const LagrangeMesh& mesh_, const HexMesh& straight, const WriteOptions& options,
                  Stage& stage)
      : mesh(mesh_),
        points(mesh_.points),
        groups(straight, options.patchAngle, stage),
        lines(edgeNodes(mesh_, straight, groups.edges, gmshEdgeOrder(mesh_.order), stage)),
        quads(quadNodes(mesh_, straight, groups.quads, gmshQuadOrder(mesh_.order), stage)),
        cellOrder(gmshNodeOrder(mesh_.order)) {}
};

}  // namespace

void writeLagrangeGmsh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  std::optional<LagrangeContent> content;
  withThreads(context.threads(), [&] { content.emplace(mesh, options, stage); });
  Msh41Writer<TextNumbers, LagrangeContent>(output, *content, stage, context.threads()).write();
  output.commit();
}

}  // namespace hexhex
