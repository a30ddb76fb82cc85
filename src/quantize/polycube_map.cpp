// The seamless map of a polycube: boundary triangles say by labels which way they are to face.
//
// All vertices of a connected piece of boundary with one axis share a coordinate along it. Those
// coordinates come from a map that turns each tet as the labels around it ask for (a Poisson
// problem per axis, as in Gregson et al. 2011), improved by local and global steps (Liu et al.
// 2008); then the tets are bent onto these planes without flips.
#include <string>

#include <hexhex/quantize.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <Eigen/SparseCore>
#include <quantize/bend.hpp>
#include <quantize/polycube_borders.hpp>

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#endif

namespace hexhex::quantization {

#if defined(HEXHEX_HAS_QUANTIZE)
namespace {

using Matrix33 = Eigen::Matrix3d;
using Matrix = Eigen::SparseMatrix<double>;
using Rotations = std::vector<Matrix33>;

/// Planes lie on a grid of so many lines or more along the object's longest side.
constexpr double kGridLines = 0x1p20;
/// Of a boundary vertex: how much it resists to being turned where labels leave that open.
constexpr double kInertia = 0.2;
/// Local and global steps; more move planes by less than a hundredth of the object.
constexpr int kRounds = 6;
/// Tets may be split until there are so many times as many: labels over-constrain those that touch
/// the boundary with several faces.
constexpr double kMostGrowth = 2;

/// The rotation nearest to a matrix.
Matrix33 nearestRotation(const Matrix33& matrix) {
  const Eigen::JacobiSVD<Matrix33> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix33 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return u * svd.matrixV().transpose();
}

Eigen::Vector3d asEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// How the coordinates of a tet's points depend on its corners.
struct TetShape {
  Eigen::Matrix<double, 4, 3> gradients;
  double volume = 0;
};

std::vector<TetShape> measureShapes(const LabelledMesh& mesh) {
  std::vector<TetShape> shapes(mesh.topology.tetCount());
  for (Index t = 0; t < shapes.size(); ++t) {
    Matrix33 edges;
    for (int i = 0; i < 3; ++i) {
      edges.col(i) = asEigen(minus(mesh.point(t, i + 1), mesh.point(t, 0)));
    }
    shapes[t].volume = edges.determinant() / 6;
    shapes[t].gradients.bottomRows<3>() = edges.inverse();
    shapes[t].gradients.row(0) = -shapes[t].gradients.bottomRows<3>().colwise().sum();
  }
  return shapes;
}

/// A Poisson problem over the vertices, some of which share their values or have them.
class PoissonProblem {
 public:
  /// @param unknownOf  per vertex: its unknown, or -1 if its value is known
  PoissonProblem(const adjacency::TetTopology& topology, const std::vector<TetShape>& shapes,
                 std::vector<int> unknownOf, int count)
      : topology_(topology),
        shapes_(shapes),
        unknownOf_(std::move(unknownOf)),
        matrix_(count, count) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index t = 0; t < shapes.size(); ++t) {
      const Eigen::Matrix4d local =
          shapes[t].volume * shapes[t].gradients * shapes[t].gradients.transpose();
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
          if (at(t, i) >= 0 && at(t, j) >= 0) entries.emplace_back(at(t, i), at(t, j), local(i, j));
        }
      }
    }
    // A little more on the diagonal keeps objects without known values where they are.
    double sum = 0;
    for (const auto& entry : entries) sum += entry.row() == entry.col() ? entry.value() : 0;
    for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 1e-9 * sum / count);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    solver_.setTolerance(1e-8);
    solver_.compute(matrix_);
  }

  /// The values whose gradients are nearest to those wanted.
  /// @param values  per vertex: known, or where to begin
  template <class Gradient>
  void solve(const Gradient& wanted, std::vector<double>& values) const {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix_.rows());
    Eigen::VectorXd x = right;
    for (Index t = 0; t < shapes_.size(); ++t) {
      Eigen::Vector3d rest = wanted(t);
      for (int i = 0; i < 4; ++i) {
        if (at(t, i) < 0) rest -= values[vertex(t, i)] * shapes_[t].gradients.row(i).transpose();
      }
      for (int i = 0; i < 4; ++i) {
        if (at(t, i) < 0) continue;
        right[at(t, i)] += shapes_[t].volume * shapes_[t].gradients.row(i).dot(rest);
        x[at(t, i)] = values[vertex(t, i)];
      }
    }
    right += 1e-9 * matrix_.diagonal().mean() * x;
    x = solver_.solveWithGuess(right, x);
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (unknownOf_[v] >= 0) values[v] = x[unknownOf_[v]];
    }
  }

 private:
  [[nodiscard]] Index vertex(Index tet, int corner) const {
    return topology_.tets[tet][static_cast<std::size_t>(corner)];
  }
  [[nodiscard]] int at(Index tet, int corner) const { return unknownOf_[vertex(tet, corner)]; }

  const adjacency::TetTopology& topology_;
  const std::vector<TetShape>& shapes_;
  std::vector<int> unknownOf_;
  Matrix matrix_;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver_;
};

/// How tets have to turn for the boundary to face where its labels say: harmonic between rotations
/// of boundary vertices, which fit the labels around them.
Rotations turnToLabels(const LabelledMesh& mesh, const std::vector<TetShape>& shapes) {
  const adjacency::TetTopology& topology = mesh.topology;
  Rotations ofVertices(topology.pointCount, Matrix33::Zero());
  for (adjacency::HalfFace h = 0; h < mesh.flags.size(); ++h) {
    if (!mesh.isLabelled(h)) continue;
    const lattice::Direction label = mesh.label(h);
    const auto& face = lattice::kFaceCorners[h % 4];
    const auto corner = [&](std::size_t k) {
      return asEigen(mesh.point(adjacency::tetOf(h), face[k]));
    };
    // Corners of a face are in the order that looks inwards.
    const Eigen::Vector3d normal = (corner(2) - corner(0)).cross(corner(1) - corner(0));
    const Matrix33 fit = lattice::signOf(label) * Eigen::Vector3d::Unit(lattice::axisOf(label)) *
                             normal.transpose() +
                         kInertia * normal.norm() * Matrix33::Identity();
    for (const int k : face)
      ofVertices[topology.tets[adjacency::tetOf(h)][static_cast<std::size_t>(k)]] += fit;
  }
  std::vector<int> unknownOf(topology.pointCount, -1);
  int count = 0;
  for (Index v = 0; v < topology.pointCount; ++v) {
    if (!ofVertices[v].isZero(0)) {
      ofVertices[v] = nearestRotation(ofVertices[v]);
    } else if (!topology.isIsolated(v)) {
      unknownOf[v] = count++;
      ofVertices[v] = Matrix33::Identity();
    }
  }
  if (count > 0) {
    const PoissonProblem problem(topology, shapes, std::move(unknownOf), count);
    std::vector<double> values(topology.pointCount);
    for (int entry = 0; entry < 9; ++entry) {
      for (std::size_t v = 0; v < values.size(); ++v)
        values[v] = ofVertices[v](entry / 3, entry % 3);
      problem.solve([](Index) { return Eigen::Vector3d::Zero(); }, values);
      for (std::size_t v = 0; v < values.size(); ++v)
        ofVertices[v](entry / 3, entry % 3) = values[v];
    }
  }
  Rotations rotations(topology.tetCount());
  for (Index t = 0; t < rotations.size(); ++t) {
    Matrix33 sum = Matrix33::Zero();
    for (const Index v : topology.tets[t]) sum += ofVertices[v];
    rotations[t] = nearestRotation(sum);
  }
  return rotations;
}

/// Positions of vertices, such that all of a connected piece of one axis share that coordinate.
class PlaneFinder {
 public:
  PlaneFinder(const LabelledMesh& mesh, const std::vector<TetShape>& shapes)
      : mesh_(mesh), shapes_(shapes) {
    const std::size_t n = mesh.topology.pointCount;
    for (int axis = 0; axis < 3; ++axis) {
      DisjointSets planes(n);
      for (adjacency::HalfFace h = 0; h < mesh.flags.size(); ++h) {
        if (!mesh.isLabelled(h) || lattice::axisOf(mesh.label(h)) != axis) continue;
        const Tet& tet = mesh.topology.tets[adjacency::tetOf(h)];
        const auto& c = lattice::kFaceCorners[h % 4];
        for (std::size_t k = 1; k < 3; ++k) {
          planes.unite(tet[static_cast<std::size_t>(c[0])], tet[static_cast<std::size_t>(c[k])]);
        }
      }
      std::vector<int> unknownOf(n, -1);
      int count = 0;
      for (Index v = 0; v < n; ++v) {
        if (mesh.topology.isIsolated(v)) continue;
        const Index first = planes.find(v);
        unknownOf[v] = first == v ? count++ : unknownOf[first];
      }
      problems_.push_back(
          std::make_unique<PoissonProblem>(mesh.topology, shapes, unknownOf, count));
      const auto k = static_cast<std::size_t>(axis);
      for (const Vec3& p : mesh.input.view.points) positions_[k].push_back(p[k]);
    }
  }

  /// Turns tets by these rotations, and then by what the outcome suggests.
  void run(Rotations& rotations, Stage& stage) {
    for (int round = 0; round < kRounds; ++round) {
      stage.context().throwIfCancelled();
      for (int axis = 0; axis < 3; ++axis) {
        problems_[static_cast<std::size_t>(axis)]->solve(
            [&](Index t) -> Eigen::Vector3d { return rotations[t].row(axis).transpose(); },
            positions_[static_cast<std::size_t>(axis)]);
      }
      for (Index t = 0; t < rotations.size(); ++t) rotations[t] = nearestRotation(jacobian(t));
    }
  }

  /// Along an axis: of the plane, if the vertex is in one.
  [[nodiscard]] double coordinate(int axis, Index vertex) const {
    return positions_[static_cast<std::size_t>(axis)][vertex];
  }

 private:
  [[nodiscard]] Matrix33 jacobian(Index t) const {
    Eigen::Matrix<double, 3, 4> corners;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 4; ++i) {
        corners(static_cast<int>(axis), static_cast<int>(i)) =
            positions_[axis][mesh_.topology.tets[t][i]];
      }
    }
    return corners * shapes_[t].gradients;
  }

  const LabelledMesh& mesh_;
  const std::vector<TetShape>& shapes_;
  std::vector<std::unique_ptr<PoissonProblem>> problems_;
  std::array<std::vector<double>, 3> positions_;
};

/// Lines of the grid per unit of space.
double gridScale(const TetMapView& view) {
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] =
        std::minmax_element(view.points.begin(), view.points.end(),
                            [k](const Vec3& a, const Vec3& b) { return a[k] < b[k]; });
    size = std::max(size, (*high)[k] - (*low)[k]);
  }
  return std::exp2(std::ceil(std::log2(kGridLines / std::max(size, 1e-300))));
}

/// @throws Error FlippedTet if the planes leave no room for a polycube
BendProblem problemOf(const LabelledMesh& mesh, const PolycubeBorders& borders,
                      const Rotations& rotations, const PlaneFinder& planes, double scale) {
  const TetMapView& view = mesh.input.view;
  const auto planeAt = [&](int axis, Index vertex) {
    return static_cast<std::int32_t>(std::llround(scale * planes.coordinate(axis, vertex)));
  };
  BendProblem problem;
  problem.points.assign(view.points.begin(), view.points.end());
  problem.tets.assign(view.tets.begin(), view.tets.end());
  problem.reference.resize(problem.tets.size());
  for (Index t = 0; t < problem.tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d u = scale * (rotations[t] * asEigen(mesh.point(t, i)));
      problem.reference[t][static_cast<std::size_t>(i)] = {u[0], u[1], u[2]};
    }
  }
  problem.transitions.resize(mesh.flags.size());
  problem.planes.resize(mesh.flags.size());
  for (adjacency::HalfFace h = 0; h < mesh.flags.size(); ++h) {
    if (!mesh.isLabelled(h)) continue;
    const int axis = lattice::axisOf(mesh.label(h));
    const auto corner = static_cast<std::size_t>(lattice::kFaceCorners[h % 4][0]);
    problem.planes[h] = {static_cast<std::int8_t>(axis),
                         planeAt(axis, mesh.topology.tets[adjacency::tetOf(h)][corner])};
  }
  problem.irregularEdges = borders.turns(planeAt);
  return problem;
}

/// Labels have a sign, which planes have not.
void requireSigns(const LabelledMesh& mesh, const std::vector<BoundaryPlane>& planes,
                  const BentMap& bent) {
  for (std::size_t t = 0; t < bent.tets.size(); ++t) {
    for (std::size_t face = 0; face < 4; ++face) {
      const auto h = static_cast<adjacency::HalfFace>(4 * bent.parentTet[t] + face);
      if (!mesh.isLabelled(h)) continue;
      const auto axis = static_cast<std::size_t>(lattice::axisOf(mesh.label(h)));
      const double plane = planes[h].coordinate;
      const bool isWhole = std::all_of(
          lattice::kFaceCorners[face].begin(), lattice::kFaceCorners[face].end(),
          [&](int k) { return bent.parameters[t][static_cast<std::size_t>(k)][axis] == plane; });
      if (!isWhole || lattice::signOf(mesh.label(h)) * (plane - bent.parameters[t][face][axis]) > 0)
        continue;
      refuseFlag(mesh, h,
                 "The labels are those of no polycube: in the only map that fits them, a boundary "
                 "triangle faces the other way than its label says.");
    }
  }
}

[[noreturn]] void failToBend(const BentMap& bent) {
  const bool isContradictory = !bent.contradictions.empty();
  const std::string what =
      isContradictory ? std::to_string(bent.contradictions.size()) + " vertices have no place."
                      : std::to_string(bent.flippedTets.size()) +
                            (bent.isWound ? " tets overlap around edges, though none is flipped."
                                          : " tets stay flipped.");
  throw Error(ErrorCode::FlippedTet,
              "The tets cannot be bent to a polycube that fits the labels: " + what +
                  " Look at the labels there, or refine the tets where the object is thin.",
              isContradictory ? Place{PlaceKind::Vertex, bent.contradictions.front()}
                              : Place{PlaceKind::Tet, bent.parentTet[bent.flippedTets.front()]});
}

TetMap polycubeMap(const TetMesh& tets, std::span<const FaceFlags> flags, Stage& stage) {
  const LabelledMesh mesh = readLabels(tets, flags, stage);
  const PolycubeBorders borders(mesh);
  const std::vector<TetShape> shapes = measureShapes(mesh);
  Rotations rotations = turnToLabels(mesh, shapes);
  PlaneFinder planes(mesh, shapes);
  planes.run(rotations, stage);
  const double scale = gridScale(mesh.input.view);
  BendProblem problem = problemOf(mesh, borders, rotations, planes, scale);
  const std::vector<BoundaryPlane> wanted = problem.planes;
  BentMap bent = bend(std::move(problem), {.maxGrowth = kMostGrowth}, stage);
  if (!bent.isValid()) failToBend(bent);
  requireSigns(mesh, wanted, bent);
  TetMap map;
  map.points = std::move(bent.points);
  map.tets = std::move(bent.tets);
  map.parameters = std::move(bent.parameters);
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) {
      for (double& x : u) x /= scale;
    }
  }
  return map;
}

}  // namespace

}  // namespace hexhex::quantization

namespace hexhex {

TetMap mapFromFlags(const TetMesh& tets, std::span<const FaceFlags> flags, Context& context) {
  Stage stage(context, "polycube");
  TetMap map;
  withThreads(context.threads(), [&] { map = quantization::polycubeMap(tets, flags, stage); });
  return map;
}
#else
TetMap mapFromFlags(const TetMesh& /*tets*/, std::span<const FaceFlags> /*flags*/,
                    Context& /*context*/) {
  throw Error(ErrorCode::InvalidArgument,
              "This build of hexhex cannot make maps of labels. Install Eigen (libeigen3-dev) and "
              "build it anew.");
}
#endif

}  // namespace hexhex::quantization
