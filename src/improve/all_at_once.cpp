#include <array>
#include <cstddef>

#include <base/vector3.hpp>
#include <improve/all_at_once.hpp>
#include <mesh/cell_measures.hpp>

#if defined(HEXHEX_HAS_UNTANGLE)
#include <untangle/untangle.hpp>

namespace hexhex::improvement {

namespace {

/// Weight of a corner's own edge lengths in its ideal ones; the rest is the cell's means. With the
/// cell's means alone, a good cell whose edges differ costs as much as one with bad angles; with
/// its own lengths alone, short edges get shorter.
constexpr double kOwnLength = 0.5;
/// Initial regularization: from any starting point, and if most cells are good and should stay so.
constexpr double kFolded = 1;
constexpr double kMostlyGood = 1e-3;
/// Maximum number of steps once no corner is folded. Tangents of the surface and ideal lengths hold
/// near where vertices are: with 60 steps, which take three times as long, minima and means are
/// lower.
constexpr int kPolishing = 12;

/// The unknowns of a problem: how far vertices move along their directions.
class Steps {
 public:
  /// @param canMove  called with a vertex
  template <class CanMove>
  Steps(const HexMesh& mesh, const VertexPlaces& places, std::span<const Index> vertices,
        const CanMove& canMove)
      : mesh_(mesh), rowOf_(mesh.points.size(), -1) {
    for (const Index v : vertices) {
      std::array<Vec3, 3> directions;
      const std::size_t count = canMove(v) ? places.directionsAt(v, directions) : 0;
      if (count == 0) continue;
      rowOf_[v] = static_cast<int>(3 * moving_.size());
      moving_.push_back(v);
      directions_.insert(directions_.end(), directions.begin(),
                         directions.begin() + static_cast<std::ptrdiff_t>(count));
      begins_.push_back(directions_.size());
    }
  }

  [[nodiscard]] untangle::Corner corner(Index v) const {
    untangle::Corner corner;
    corner.constant = mesh_.points[v];
    for (int k = 0; k < 3 && rowOf_[v] >= 0; ++k) {
      corner.unknown[static_cast<std::size_t>(k)] = rowOf_[v] + k;
      corner.sign[static_cast<std::size_t>(k)] = 1;
    }
    return corner;
  }

  /// Defines coordinates as sums of steps, which start at 0.
  void enter(untangle::Problem& problem) const {
    problem.x.assign(directions_.size(), 0.0);
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t u = begins_[i]; u < begins_[i + 1]; ++u) {
          if (directions_[u][k] == 0) continue;
          problem.sums.entries.push_back({static_cast<int>(u), directions_[u][k]});
        }
        problem.sums.begins.push_back(problem.sums.entries.size());
      }
    }
  }

  /// Calls use(vertex, point) with the new points of vertices.
  template <class Use>
  void take(const untangle::Problem& problem, const Use& use) const {
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      Vec3 point = mesh_.points[moving_[i]];
      for (std::size_t u = begins_[i]; u < begins_[i + 1]; ++u) {
        point = plus(point, times(problem.x[u], directions_[u]));
      }
      use(moving_[i], point);
    }
  }

 private:
  const HexMesh& mesh_;
  std::vector<int> rowOf_;  ///< per vertex: row of its first coordinate, or -1
  std::vector<Index> moving_;
  std::vector<Vec3> directions_;           ///< per unknown
  std::vector<std::size_t> begins_ = {0};  ///< per moving vertex: its first unknown
};

/// The element of the corner of a cell at a place, with its three edges.
/// @param own  weight of the corner's own lengths in ideal ones
untangle::Element cornerOf(const HexMesh& mesh, const Steps& steps, const Hex& cell,
                           const IdealBox& box, std::size_t place, double own) {
  const auto at = [&](std::size_t p) { return cell[mesh::kVtkCorner[p]]; };
  untangle::Element element;
  element.corners[0] = steps.corner(at(place));
  Vec3 lengths{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Index other = at(place ^ (std::size_t{1} << k));
    element.corners[k + 1] = steps.corner(other);
    const double edge = length(minus(mesh.points[other], mesh.points[at(place)]));
    lengths[k] = own * edge + (1 - own) * box[k];
  }
  const IdealBox ideal = idealBox(lengths);
  std::array<Vec3, 3> edges{};
  for (std::size_t k = 0; k < 3; ++k) edges[k][k] = (place >> k & 1U) != 0 ? -ideal[k] : ideal[k];
  element.gradients = untangle::tetGradients(edges);
  return element;
}

untangle::Problem problemOf(const HexMesh& mesh, const Steps& steps, const MovingCells& moving,
                            double own) {
  untangle::Problem problem;
  steps.enter(problem);
  problem.elements.reserve(8 * moving.cells.size());
  for (const Index cell : moving.cells) {
    for (std::size_t place = 0; place < 8; ++place) {
      problem.elements.push_back(
          cornerOf(mesh, steps, mesh.cells[cell], moving.boxes[cell], place, own));
    }
  }
  return problem;
}

}  // namespace

bool canMoveAtOnce() noexcept { return true; }

void spreadAtOnce(HexMesh& mesh, const VertexPlaces& places, const MovingCells& moving,
                  Stage& stage) {
  const Steps steps(mesh, places, moving.vertices,
                    [&](Index v) { return places.freedom[v] == Freedom::Free; });
  const Array<IdealBox> cubes(mesh.cells.size(), IdealBox{1, 1, 1});
  untangle::Problem problem = problemOf(mesh, steps, {moving.vertices, moving.cells, cubes}, 0);
  problem.matrices.emplace_back();  // target 0: edges as short as possible
  for (untangle::Element& element : problem.elements) element.target = 0;
  untangle::Solver(problem, stage, untangle::Inverse::GaussSeidel).start();
  steps.take(problem, [&](Index v, const Vec3& point) { mesh.points[v] = point; });
}

void moveAtOnce(HexMesh& mesh, VertexPlaces& places, const MovingCells& moving, bool isFolded,
                const std::vector<std::uint8_t>& isHeld, Stage& stage) {
  const Steps steps(mesh, places, moving.vertices, [&](Index v) { return isHeld[v] == 0; });
  untangle::Problem problem = problemOf(mesh, steps, moving, isFolded ? 0 : kOwnLength);
  const untangle::Options options{.epsilon = isFolded ? kFolded : kMostlyGood,
                                  .polishing = kPolishing};
  untangle::Solver solver(problem, stage, untangle::Inverse::GaussSeidel);
  static_cast<void>(solver.run(options));
  steps.take(problem, [&](Index v, const Vec3& point) {
    const SurfacePlace place = places.nearest(v, point);
    mesh.points[v] = place.point;
    places.simplex[v] = place.simplex;
  });
}

}  // namespace hexhex::improvement

#else

namespace hexhex::improvement {

bool canMoveAtOnce() noexcept { return false; }

void spreadAtOnce(HexMesh& /*mesh*/, const VertexPlaces& /*places*/, const MovingCells& /*moving*/,
                  Stage& /*stage*/) {}

void moveAtOnce(HexMesh& /*mesh*/, VertexPlaces& /*places*/, const MovingCells& /*moving*/,
                bool /*isFolded*/, const std::vector<std::uint8_t>& /*isHeld*/, Stage& /*stage*/) {}

}  // namespace hexhex::improvement
#endif
