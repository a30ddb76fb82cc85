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

#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <igm/defects.hpp>
#include <igm/input.hpp>
#endif

namespace hexhex {

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

constexpr std::size_t axisOfFlag(std::int8_t flag) noexcept {
  return static_cast<std::size_t>(flag) / 2;
}
constexpr int signOfFlag(std::int8_t flag) noexcept { return flag % 2 == 0 ? 1 : -1; }

/// The rotation nearest to a matrix.
Matrix33 nearestRotation(const Matrix33& matrix) {
  const Eigen::JacobiSVD<Matrix33> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix33 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return u * svd.matrixV().transpose();
}

Eigen::Vector3d asEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// A tet mesh with labels, positive in space.
struct LabelledMesh {
  OrientedMap input;  ///< whose parameters are positions
  TetTopology topology;
  std::vector<std::int8_t> flags;  ///< per half-face

  [[nodiscard]] const Vec3& point(Index tet, int corner) const {
    return input.view.points[topology.tets[tet][static_cast<std::size_t>(corner)]];
  }
};

[[noreturn]] void refuseFlag(const LabelledMesh& mesh, HalfFace h, const std::string& sentence) {
  throw Error(ErrorCode::InvalidArgument, sentence,
              {PlaceKind::Face, tetOf(h),
               static_cast<std::uint64_t>(mesh.input.callersCorner(static_cast<int>(h % 4)))});
}

LabelledMesh readLabels(const TetMesh& tets, std::span<const FaceFlags> flags, Stage& stage) {
  if (flags.size() != tets.tets.size()) {
    throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(flags.size()) +
                                                " labels of four faces, but " +
                                                std::to_string(tets.tets.size()) + " tets.");
  }
  std::vector<TetParameters> positions;
  positions.reserve(tets.tets.size());
  for (const Tet& tet : tets.tets) {
    TetParameters& corners = positions.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      if (tet[i] < tets.points.size()) corners[i] = tets.points[tet[i]];
    }
  }
  DefectCollector defects;
  LabelledMesh mesh;
  mesh.input = readInput({tets.points, tets.tets, positions}, stage, defects);
  defects.throwIfAny();
  mesh.topology = buildTopology(mesh.input.view, stage, defects);
  defects.throwIfAny();
  addStars(mesh.topology, stage);
  // The positions of the caller's tets, which readInput() may have copied.
  mesh.input.view.parameters = {};
  mesh.flags.resize(mesh.topology.mate.size());
  for (HalfFace h = 0; h < mesh.flags.size(); ++h) {
    const auto face = static_cast<std::size_t>(mesh.input.callersCorner(static_cast<int>(h % 4)));
    const std::int8_t flag = mesh.flags[h] = flags[tetOf(h)][face];
    const bool isBoundary = mesh.topology.isBoundary(h);
    if (flag < -1 || flag > 5) {
      refuseFlag(mesh, h,
                 "A label is " + std::to_string(flag) +
                     "; labels are 0 to 5 for +x -x +y -y +z -z, and -1 inside.");
    }
    if (isBoundary && flag < 0) {
      refuseFlag(mesh, h, "A boundary triangle has no label; each needs one from 0 to 5.");
    }
    if (!isBoundary && flag >= 0) {
      refuseFlag(mesh, h, "A triangle inside of the object has a label; only the boundary has.");
    }
  }
  return mesh;
}

/// How the coordinates of a tet's points depend on its corners.
struct TetShape {
  Eigen::Matrix<double, 4, 3> gradients;
  double volume = 0;
};

std::vector<TetShape> measureShapes(const LabelledMesh& mesh) {
  std::vector<TetShape> shapes(mesh.topology.tetCount());
  DefectCollector defects;
  defects.setCornersReversed(mesh.input.cornersReversed);
  for (Index t = 0; t < shapes.size(); ++t) {
    Matrix33 edges;
    for (int i = 0; i < 3; ++i) {
      edges.col(i) = asEigen(minus(mesh.point(t, i + 1), mesh.point(t, 0)));
    }
    shapes[t].volume = edges.determinant() / 6;
    if (!(shapes[t].volume > 0)) {
      defects.add(ErrorCode::FlippedTet, {PlaceKind::Tet, t}, -shapes[t].volume);
      continue;
    }
    shapes[t].gradients.bottomRows<3>() = edges.inverse();
    shapes[t].gradients.row(0) = -shapes[t].gradients.bottomRows<3>().colwise().sum();
  }
  defects.throwIfAny();
  return shapes;
}

/// A Poisson problem over the vertices, some of which share their values or have them.
class PoissonProblem {
 public:
  /// @param unknownOf  per vertex: its unknown, or -1 if its value is known
  PoissonProblem(const TetTopology& topology, const std::vector<TetShape>& shapes,
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

  const TetTopology& topology_;
  const std::vector<TetShape>& shapes_;
  std::vector<int> unknownOf_;
  Matrix matrix_;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver_;
};

/// How tets have to turn for the boundary to face where its labels say: harmonic between rotations
/// of boundary vertices, which fit the labels around them.
Rotations turnToLabels(const LabelledMesh& mesh, const std::vector<TetShape>& shapes) {
  const TetTopology& topology = mesh.topology;
  Rotations ofVertices(topology.pointCount, Matrix33::Zero());
  for (HalfFace h = 0; h < mesh.flags.size(); ++h) {
    const std::int8_t flag = mesh.flags[h];
    if (flag < 0) continue;
    const auto& face = kFaceCorners[h % 4];
    const auto corner = [&](std::size_t k) { return asEigen(mesh.point(tetOf(h), face[k])); };
    // Corners of a face are in the order that looks inwards.
    const Eigen::Vector3d normal = (corner(2) - corner(0)).cross(corner(1) - corner(0));
    const Matrix33 fit = signOfFlag(flag) *
                             Eigen::Vector3d::Unit(static_cast<int>(axisOfFlag(flag))) *
                             normal.transpose() +
                         kInertia * normal.norm() * Matrix33::Identity();
    for (const int k : face)
      ofVertices[topology.tets[tetOf(h)][static_cast<std::size_t>(k)]] += fit;
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
    for (std::size_t axis = 0; axis < 3; ++axis) {
      DisjointSets planes(n);
      for (HalfFace h = 0; h < mesh.flags.size(); ++h) {
        if (mesh.flags[h] < 0 || axisOfFlag(mesh.flags[h]) != axis) continue;
        const Tet& tet = mesh.topology.tets[tetOf(h)];
        const auto& c = kFaceCorners[h % 4];
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
      for (const Vec3& p : mesh.input.view.points) positions_[axis].push_back(p[axis]);
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

  /// Of the plane of a half-face with a label.
  [[nodiscard]] double coordinate(HalfFace h) const {
    const auto corner = static_cast<std::size_t>(kFaceCorners[h % 4][0]);
    return positions_[axisOfFlag(mesh_.flags[h])][mesh_.topology.tets[tetOf(h)][corner]];
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

BendProblem problemOf(const LabelledMesh& mesh, const Rotations& rotations,
                      const PlaneFinder& planes, double scale) {
  const TetMapView& view = mesh.input.view;
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
  for (HalfFace h = 0; h < mesh.flags.size(); ++h) {
    if (mesh.flags[h] < 0) continue;
    problem.planes[h] = {static_cast<std::int8_t>(axisOfFlag(mesh.flags[h])),
                         static_cast<std::int32_t>(std::llround(scale * planes.coordinate(h)))};
  }
  return problem;
}

/// Labels have a sign, which planes have not.
void requireSigns(const LabelledMesh& mesh, const std::vector<BoundaryPlane>& planes,
                  const BentMap& bent) {
  for (std::size_t t = 0; t < bent.tets.size(); ++t) {
    for (std::size_t face = 0; face < 4; ++face) {
      const auto h = static_cast<HalfFace>(4 * bent.parentTet[t] + face);
      if (mesh.flags[h] < 0) continue;
      const std::size_t axis = axisOfFlag(mesh.flags[h]);
      const double plane = planes[h].coordinate;
      const bool isWhole = std::all_of(
          kFaceCorners[face].begin(), kFaceCorners[face].end(),
          [&](int k) { return bent.parameters[t][static_cast<std::size_t>(k)][axis] == plane; });
      if (!isWhole || signOfFlag(mesh.flags[h]) * (plane - bent.parameters[t][face][axis]) > 0)
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
                      : std::to_string(bent.flippedTets.size()) + " tets stay flipped.";
  throw Error(ErrorCode::FlippedTet,
              "The tets cannot be bent to a polycube that fits the labels: " + what +
                  " Look at the labels there, or refine the tets where the object is thin.",
              isContradictory ? Place{PlaceKind::Vertex, bent.contradictions.front()}
                              : Place{PlaceKind::Tet, bent.parentTet[bent.flippedTets.front()]});
}

TetMap polycubeMap(const TetMesh& tets, std::span<const FaceFlags> flags, Stage& stage) {
  const LabelledMesh mesh = readLabels(tets, flags, stage);
  const std::vector<TetShape> shapes = measureShapes(mesh);
  Rotations rotations = turnToLabels(mesh, shapes);
  PlaneFinder planes(mesh, shapes);
  planes.run(rotations, stage);
  const double scale = gridScale(mesh.input.view);
  BendProblem problem = problemOf(mesh, rotations, planes, scale);
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

TetMap mapFromFlags(const TetMesh& tets, std::span<const FaceFlags> flags, Context& context) {
  Stage stage(context, "polycube");
  TetMap map;
  withThreads(context.threads(), [&] { map = polycubeMap(tets, flags, stage); });
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

}  // namespace hexhex
