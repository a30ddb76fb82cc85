#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <Eigen/SparseCore>
#include <quantize/polycube/field.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Number of alternations between smoothing the field and aligning it with labels at the boundary.
constexpr int kRounds = 4;
/// Weight of a boundary rotation in edge lengths; the weight of a neighbour is about 1.
constexpr double kInsistence = 20;
/// Lower bound on the distance between centroids of neighbours, in edge lengths: smaller ones would
/// weld the two tets together.
constexpr double kLeastDistance = 0.1;
/// Small regularization that keeps the global rotation at the identity where labels do not
/// determine it.
constexpr double kInertia = 1e-2;

Vector3d asEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

Matrix3d nearestRotation(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return u * svd.matrixV().transpose();
}

/// Composes a rotation with the smallest one that then aligns a normal with its label.
Matrix3d turnedTo(lattice::Direction label, const Vector3d& normal, const Matrix3d& rotation) {
  return Eigen::Quaterniond::FromTwoVectors(rotation * normal, vectorOf(label)).toRotationMatrix() *
         rotation;
}

/// Per tet its labelled triangle, the largest one if there are several, or kNone.
std::vector<adjacency::HalfFace> labelledFaces(const LabelledMesh& mesh) {
  std::vector<adjacency::HalfFace> faces(mesh.topology.tetCount(), kNone);
  for (adjacency::HalfFace h = 0; h < mesh.flags.size(); ++h) {
    if (!mesh.isLabelled(h)) continue;
    adjacency::HalfFace& best = faces[adjacency::tetOf(h)];
    if (best == kNone || outwardNormal(mesh, h).norm() > outwardNormal(mesh, best).norm()) best = h;
  }
  return faces;
}

/// The global rotation that aligns normals with labels best, weighted by area.
Matrix3d turnOfAll(const LabelledMesh& mesh, const std::vector<adjacency::HalfFace>& faces) {
  Matrix3d sum = Matrix3d::Zero();
  double area = 0;
  for (const adjacency::HalfFace h : faces) {
    if (h == kNone) continue;
    const Vector3d normal = outwardNormal(mesh, h);
    sum += vectorOf(mesh.label(h)) * normal.transpose();
    area += normal.norm();
  }
  return nearestRotation(sum + kInertia * area * Matrix3d::Identity());
}

/// The Laplacian of the dual graph, with weights area / distance, plus a diagonal term that ties
/// boundary tets to their rotations.
Eigen::SparseMatrix<double> dualLaplacian(const LabelledMesh& mesh, double length,
                                          const std::vector<adjacency::HalfFace>& faces) {
  const adjacency::TetTopology& topology = mesh.topology;
  std::vector<Vector3d> middles(topology.tetCount(), Vector3d::Zero());
  for (Index t = 0; t < middles.size(); ++t) {
    for (int i = 0; i < 4; ++i) middles[t] += 0.25 * asEigen(mesh.point(t, i));
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(topology.mate.size() * 2);
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.isBoundary(h)) continue;
    const Index here = adjacency::tetOf(h);
    const Index there = adjacency::tetOf(topology.mate[h]);
    const double distance =
        std::max((middles[here] - middles[there]).norm(), kLeastDistance * length);
    const double weight = 0.5 * outwardNormal(mesh, h).norm() / distance;
    entries.emplace_back(here, here, weight);
    entries.emplace_back(here, there, -weight);
  }
  for (Index t = 0; t < faces.size(); ++t) {
    if (faces[t] != kNone) entries.emplace_back(t, t, kInsistence * length);
  }
  const auto n = static_cast<Eigen::Index>(topology.tetCount());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

Vector3d outwardNormal(const LabelledMesh& mesh, adjacency::HalfFace h) {
  // Corners of a face are counterclockwise as seen from inside.
  const auto& face = lattice::kFaceCorners[h % 4];
  const Vec3& first = mesh.point(adjacency::tetOf(h), face[0]);
  return asEigen(cross(minus(mesh.point(adjacency::tetOf(h), face[2]), first),
                       minus(mesh.point(adjacency::tetOf(h), face[1]), first)));
}

double edgeLength(const LabelledMesh& mesh) {
  double volume = 0;
  for (Index t = 0; t < mesh.topology.tetCount(); ++t) {
    const auto edge = [&](int i) { return minus(mesh.point(t, i), mesh.point(t, 0)); };
    volume += tripleProduct(edge(1), edge(2), edge(3));
  }
  return std::cbrt(volume / static_cast<double>(mesh.topology.tetCount()));
}

std::vector<Matrix3d> rotationField(const LabelledMesh& mesh, Stage& stage) {
  const std::vector<adjacency::HalfFace> faces = labelledFaces(mesh);
  const double length = edgeLength(mesh);
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-4);
  solver.setMaxIterations(400);
  const Eigen::SparseMatrix<double> matrix = dualLaplacian(mesh, length, faces);
  solver.compute(matrix);

  const auto n = static_cast<Eigen::Index>(faces.size());
  std::vector<Matrix3d> rotations(faces.size(), turnOfAll(mesh, faces));
  const auto follow = [&] {
    for (std::size_t t = 0; t < faces.size(); ++t) {
      if (faces[t] == kNone) continue;
      rotations[t] = turnedTo(mesh.label(faces[t]), outwardNormal(mesh, faces[t]), rotations[t]);
    }
  };
  follow();
  // Matrix entries are smoothed, not quaternions, whose signs would disagree where the rotation
  // exceeds half a turn.
  Eigen::Matrix<double, Eigen::Dynamic, 9> entries(n, 9);
  const auto row = [&](std::size_t t) { return entries.row(static_cast<Eigen::Index>(t)); };
  for (std::size_t t = 0; t < faces.size(); ++t) row(t) = rotations[t].reshaped().transpose();
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index entry = 0; entry < 9; ++entry) {
      stage.context().throwIfCancelled();
      Eigen::VectorXd wanted = Eigen::VectorXd::Zero(n);
      for (std::size_t t = 0; t < faces.size(); ++t) {
        if (faces[t] == kNone) continue;
        wanted[static_cast<Eigen::Index>(t)] =
            kInsistence * length * rotations[t].reshaped()[entry];
      }
      entries.col(entry) = solver.solveWithGuess(wanted, entries.col(entry));
    }
    for (std::size_t t = 0; t < faces.size(); ++t) {
      rotations[t] = nearestRotation(row(t).reshaped(3, 3));
    }
    follow();
  }
  return rotations;
}

}  // namespace hexhex::quantization
