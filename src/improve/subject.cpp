#include <algorithm>
#include <array>

#include <improve/curved_cells.hpp>
#include <improve/subject.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex::improvement {

namespace {

class StraightCells final : public ImprovedCells {
 public:
  StraightCells(const HexMesh& mesh, const adjacency::VertexCells& around)
      : ImprovedCells(mesh::CellMeasures::kMost), mesh_(mesh), around_(around) {}

  [[nodiscard]] CellPoints points() const override {
    static_assert(sizeof(Hex) == 8 * sizeof(Index));
    return {{reinterpret_cast<const Index*>(mesh_.cells.data()), 8 * mesh_.cells.size()},
            8,
            around_,
            mesh_.points.size()};
  }

  [[nodiscard]] Hex cornersOf(std::size_t cell) const override { return mesh_.cells[cell]; }

  void addTerms(const Array<Vec3>& points, std::span<const Index> cells, Index moving,
                const Array<IdealBox>& boxes, TermKind kind, Scratch& scratch,
                EnergyTerms& terms) const override {
    scratch.straight.clear();
    for (const Index cell : cells) {
      std::array<const Vec3*, 8> corners;
      std::size_t at = 0;
      for (std::size_t place = 0; place < 8; ++place) {
        const Index corner = mesh_.cells[cell][mesh::kVtkCorner[place]];
        corners[place] = &points[corner];
        if (corner == moving) at = place;
      }
      scratch.straight.push_back(movingCell(corners, at, boxes[cell]));
    }
    terms.addCells(scratch.straight, kind);
  }

 private:
  void measureSome(const Array<Vec3>& points, std::span<const Index> cells, Scratch& /*scratch*/,
                   std::span<double> qualities) const override {
    static const mesh::MeasureCells widest = mesh::measuresOfCells().back();
    mesh::CellMeasures measures;
    std::array<Hex, mesh::CellMeasures::kMost> corners;
    for (std::size_t i = 0; i < cells.size(); ++i) corners[i] = mesh_.cells[cells[i]];
    widest(points.data(), std::span(corners).first(cells.size()), measures);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool certified = measures.inRange[i] != 0 && measures.least[i] > measures.errorOf(i);
      qualities[i] = certified ? measures.scaled[i] : kNotCertified;
    }
  }

  const HexMesh& mesh_;
  const adjacency::VertexCells& around_;
};

}  // namespace

std::size_t Subject::parts() const {
  if (!isCurved()) return 1;
  const auto order = static_cast<std::size_t>(curved->order);
  return order * order * order;
}

std::unique_ptr<const ImprovedCells> Subject::cells(const adjacency::VertexCells& around,
                                                    Stage& stage) const {
  if (isCurved()) return std::make_unique<CurvedCells>(*curved, stage);
  return std::make_unique<StraightCells>(mesh, around);
}

Certificate Subject::certifyNow(Context& context) const {
  if (!isCurved()) return certify(mesh, context);
  std::copy(mesh.points.begin(), mesh.points.end(), curved->points.begin());
  return certify(*curved, context);
}

void Subject::putBack(const Array<Vec3>& points) const {
  std::copy(points.begin(), points.end(), mesh.points.begin());
  if (isCurved()) std::copy(points.begin(), points.end(), curved->points.begin());
}

}  // namespace hexhex::improvement
