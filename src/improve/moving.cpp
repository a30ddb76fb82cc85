#include <algorithm>
#include <optional>
#include <utility>

#include <adjacency/hex_topology.hpp>

#include <improve/curved_cells.hpp>
#include <improve/moving.hpp>
#include <improve/sweeps.hpp>
#include <improve/untangling.hpp>

namespace hexhex::improvement {

namespace {

/// Cells that lost their certificate, or whose scaled Jacobian fell below the least there was.
std::vector<Index> worsened(const ImproveReport& report) {
  std::vector<Index> cells;
  for (Index c = 0; c < report.after.validity.size(); ++c) {
    const bool isLost = report.before.validity[c] == Validity::Positive &&
                        report.after.validity[c] != Validity::Positive;
    if (isLost || report.after.scaledJacobians[c] < report.before.quality.minimum) {
      cells.push_back(c);
    }
  }
  return cells;
}

}  // namespace

std::size_t Subject::parts() const {
  if (curved == nullptr) return 1;
  const auto order = static_cast<std::size_t>(curved->order);
  return order * order * order;
}

Certificate Subject::certifyNow(Context& context) const {
  if (curved == nullptr) return certify(mesh, context);
  std::copy(mesh.points.begin(), mesh.points.end(), curved->points.begin());
  return certify(*curved, context);
}

void Subject::putBack(const Array<Vec3>& points) const {
  std::copy(points.begin(), points.end(), mesh.points.begin());
  if (curved != nullptr) std::copy(points.begin(), points.end(), curved->points.begin());
}

Boundary::Boundary(const HexMesh& mesh, TriangleTree surface_, Stage& stage)
    : faces(adjacency::boundaryPlaces(mesh, stage)),
      quads(adjacency::quadsAt(mesh, faces)),
      surface(std::move(surface_)) {}

BoundaryDistance Boundary::distanceTo(const VertexPlaces& places, const Array<Vec3>& points,
                                      double diagonal, Stage& stage) const {
  return distanceBetween(points, quads, places.surface, surface, diagonal, stage);
}

Array<std::uint64_t> Boundary::cellsBeyond(double limit, const BoundaryDistance& distance,
                                           std::size_t parts) const {
  Array<std::uint64_t> cells;
  for (const Index q : distance.quadsBeyond(limit)) {
    const std::uint64_t cell = faces[q] / 8 / parts;
    if (cells.empty() || cells.back() != cell) cells.push_back(cell);
  }
  return cells;
}

double farthestAllowed(const SurfaceDistance& before) {
  constexpr double kSame = 1 + 1e-6;  // of distances that are the same but for rounding
  return kSame * std::max(before.hausdorff(), kSurfaceTolerance);
}

double meritOf(const ImproveReport& report) {
  constexpr double kGood = 0.3;        // a minimum above needs no better
  constexpr double kElsewhere = 0.01;  // of the diagonal: that is another object
  constexpr double kUnfollowed = 0.5;  // of a mesh that follows no curve
  constexpr double kGrown = 2;         // times the cells that were asked for, before layers
  if (!report.after.allPositive()) return -1;
  const double quality = std::min(1.0, report.after.quality.minimum / kGood);
  const double nearness = std::max(0.0, 1 - report.distanceAfter.hausdorff() / kElsewhere);
  const auto cells = static_cast<double>(report.after.positive);
  const double size = std::min(1.0, kGrown * (1 - static_cast<double>(report.addedCells) / cells));
  return quality * nearness * size * (kUnfollowed + (1 - kUnfollowed) * report.curvesFollowed);
}

BoundaryDistance movePoints(const Subject& subject, const Boundary& boundary, VertexPlaces& places,
                            const ImproveOptions& options, const Array<Vec3>& before,
                            ImproveReport& report, Context& context, Stage& stage) {
  std::optional<CurvedCells> curved;
  if (subject.curved != nullptr) curved.emplace(*subject.curved);
  Array<Index> simplices = places.simplex;
  const auto newSweeps = [&] {
    return Sweeps(subject.mesh, curved ? &*curved : nullptr, places, report.diagonal, stage);
  };
  const auto distance = [&] {
    return boundary.distanceTo(places, subject.mesh.points, report.diagonal, stage);
  };
  const double limit = farthestAllowed(report.distanceBefore);
  const auto quadsBeyond = [&](const std::vector<double>& distances) {
    Array<Quad> far;
    for (Index q = 0; q < distances.size(); ++q) {
      if (distances[q] > limit) far.push_back(boundary.quads[q]);
    }
    return far;
  };
  BoundaryDistance after;
  {
    Sweeps sweeps = newSweeps();
    const double slack = options.slack * report.diagonal;
    sweeps.untangle(slack);
    const std::vector<Index> loose =
        sweeps.untangleAcrossCreases(slack, [&] { return quadsBeyond(distance().fromQuads); });
    report.offCreases += loose.size();
    for (const Index v : loose) {
      simplices[v] = places.surface.acrossCreases(before[v], places.simplex[v]).simplex;
    }
    sweeps.raiseWorst(options.target);
    const double floor = std::max(options.target, report.before.quality.minimum);
    sweeps.smooth(options.passes, floor);
    after = distance();
    for (int i = 0; i < Sweeps::kReturns && after.largest.hausdorff() > limit; ++i) {
      sweeps.moveBack(quadsBeyond(after.ofQuads), before, simplices, floor);
      after = distance();
    }
  }  // its memory is free for certificates
  report.after = subject.certifyNow(context);
  const std::vector<Index> worse = worsened(report);
  if (worse.empty()) return after;
  putBack(newSweeps().cellPoints(), worse, before, simplices, subject.mesh.points, places);
  report.after = subject.certifyNow(context);
  return distance();
}

}  // namespace hexhex::improvement
