// improve(): checks options and input, moves vertices, and reports.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/corner_range.hpp>

#include <hexhex/error.hpp>
#include <hexhex/improve.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <improve/curved_cells.hpp>
#include <improve/followed_curves.hpp>
#include <improve/given_surface.hpp>
#include <improve/merit.hpp>
#include <improve/moving.hpp>
#include <improve/pillowed.hpp>
#include <improve/snapping.hpp>
#include <improve/sound_input.hpp>
#include <improve/surface_distance.hpp>
#include <improve/vertex_places.hpp>
#include <improve/worst_cell.hpp>
#include <mesh/lagrange_check.hpp>

namespace hexhex::improvement {

namespace {

void requireRange(double value, double most, const char* what) {
  if (value >= 0 && value <= most) return;
  throw Error(ErrorCode::InvalidArgument,
              concat(what, " is ", value, ". Choose a number from 0 to ", most, "."));
}

void requireOptions(const ImproveOptions& options) {
  requireRange(options.target, 1, "The target of improvement");
  requireRange(options.passes, 1000, "The number of passes");
  requireRange(options.featureAngle, 180, "The angle of curves");
  requireRange(options.slack, 0.1, "The slack of the surface");
}

/// Limits of coordinates and of the size of the surface, since products of squared areas are
/// computed, and lengths of cells as floats.
constexpr double kFarthest = 1e30;
constexpr double kSmallest = 1e-10;

[[noreturn]] void refuseSize(const std::string& what) {
  throw Error(ErrorCode::TooLarge,
              what +
                  ". Meshes are improved that extend over 1e-10 to 1e30: multiply all positions "
                  "by a constant.");
}

/// @param whose  "the mesh", "the map"
void requirePositions(std::span<const Vec3> points, const std::string& whose, Stage& stage) {
  const std::size_t bad = firstFault(stage, points.size(), [&](std::size_t v) {
    return std::all_of(points[v].begin(), points[v].end(),
                       [](double x) { return std::abs(x) <= kFarthest; });
  });
  if (bad == points.size()) return;
  const std::string where = concat("A coordinate of vertex ", bad, " of ", whose);
  if (isFinite(points[bad])) refuseSize(where + " is beyond 1e30");
  throw Error(ErrorCode::NotFinite, where + " is not a finite number. Correct the mesh first.",
              Place{PlaceKind::Vertex, bad, 0});
}

void requireCells(const HexMesh& mesh, Context& context) {
  Stage stage(context, "input");
  if (mesh.cells.empty()) {
    throw Error(ErrorCode::EmptyMesh, "The mesh has no cells. There is nothing to improve.");
  }
  adjacency::requireCornersInRange(mesh, stage);
  requirePositions(mesh.points, "the mesh", stage);
}

void reportMoves(const Array<Vec3>& before, const Array<Vec3>& points, ImproveReport& report) {
  report.movedVertices = 0;
  report.largestMove = 0;
  report.meanMove = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double move = length(minus(points[v], before[v])) / report.diagonal;
    if (move == 0) continue;
    ++report.movedVertices;
    report.largestMove = std::max(report.largestMove, move);
    report.meanMove += move;
  }
  if (report.movedVertices > 0) report.meanMove /= static_cast<double>(report.movedVertices);
}

/// Counts vertices that are farther from their triangle or segment than rounding explains.
void reportOff(const Array<Vec3>& points, const VertexPlaces& places, ImproveReport& report) {
  constexpr double kOn = 1e-9;
  report.offSurface = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Vec3& point = points[v];
    Vec3 nearest = point;
    if (places.freedom[v] == Freedom::OnPatch) {
      nearest = nearestOf(places.surface.triangle(places.simplex[v]), point);
    } else if (places.freedom[v] == Freedom::OnCurve) {
      nearest = nearestOf(places.surface.segment(places.simplex[v]), point);
    }
    if (length(minus(point, nearest)) > kOn * report.diagonal) ++report.offSurface;
  }
}

double distanceInside(const VertexPlaces& places, const HexMesh& mesh, const ImproveReport& report,
                      Stage& stage) {
  return innerDistance(mesh.points, places.innerQuads, places.surface, report.diagonal, stage);
}

/// @return 1 if the vertex could move before, else 0
std::uint64_t fix(VertexPlaces& places, Index v) {
  places.simplex[v] = kNone;
  return std::exchange(places.freedom[v], Freedom::Fixed) != Freedom::Fixed ? 1 : 0;
}

/// @return number of vertices that could move before
std::uint64_t fixBoundary(VertexPlaces& places) {
  std::uint64_t count = 0;
  for (Index v = 0; v < places.freedom.size(); ++v) {
    if (places.freedom[v] != Freedom::Free) count += fix(places, v);
  }
  return count;
}

/// Fixes the vertices of cells that no positions make positive: moving them takes long and makes
/// other cells worse.
/// @return number of vertices that could move before
std::uint64_t fixPaired(const Subject& subject, std::span<const std::uint64_t> cells,
                        VertexPlaces& places) {
  std::uint64_t count = 0;
  for (const std::uint64_t cell : cells) {
    for (std::size_t c = cell * subject.parts(); c < (cell + 1) * subject.parts(); ++c) {
      for (const Index v : subject.mesh.cells[c]) count += fix(places, v);
    }
  }
  return count;
}

/// Per vertex: 1 if a cell there is not positive.
std::vector<std::uint8_t> atBadCells(const Subject& subject, const Certificate& certificate) {
  std::vector<std::uint8_t> isAtBad(subject.mesh.points.size(), 0);
  for (std::size_t c = 0; c < subject.mesh.cells.size(); ++c) {
    if (certificate.validity[c / subject.parts()] == Validity::Positive) continue;
    for (const Index v : subject.mesh.cells[c]) isAtBad[v] = 1;
  }
  return isAtBad;
}

void listNotPositive(ImproveReport& report) {
  report.notPositive.clear();
  for (std::size_t c = 0; c < report.after.validity.size(); ++c) {
    if (report.after.validity[c] != Validity::Positive) report.notPositive.push_back(c);
  }
}

void reportBefore(const Subject& subject, const Boundary& boundary, const VertexPlaces& places,
                  ImproveReport& report, Stage& stage) {
  const Array<Vec3>& points = subject.mesh.points;
  const BoundaryDistance distance = boundary.distanceTo(places, points, report.diagonal, stage);
  report.taggedVertices = places.tagged;
  report.distanceBefore = distance.largest;
  report.innerDistanceBefore = distanceInside(places, subject.mesh, report, stage);
  report.farCellsBefore = boundary.cellsBeyond(kSurfaceTolerance, distance, subject.parts()).size();
}

/// A mesh whose points were moved.
struct Moved {
  Subject subject;
  const Boundary& boundary;
  VertexPlaces& places;
  const BoundaryDistance& distance;

  explicit Moved(Improved& improved)
      : Moved({improved.mesh}, improved.boundary, improved.places, improved.distance) {}
  Moved(const Subject& subject_, const Boundary& boundary_, VertexPlaces& places_,
        const BoundaryDistance& distance_)
      : subject(subject_), boundary(boundary_), places(places_), distance(distance_) {}
};

/// Also replaces what it has written for another state of the mesh.
/// @param object  the surface, with all of its curves
/// @param before  the initial points
void reportAfter(const Moved& moved, const ReferenceSurface& object, Array<Vec3> before,
                 ImproveReport& report, Stage& stage) {
  const auto& [subject, boundary, places, distance] = moved;
  before.insert(before.end(), report.addedPoints.begin(), report.addedPoints.end());
  report.vertices = {};
  for (const Freedom freedom : places.freedom) {
    ++report.vertices[static_cast<std::size_t>(freedom)];
  }
  report.distanceAfter = distance.largest;
  report.innerDistanceAfter = distanceInside(places, subject.mesh, report, stage);
  report.farCells = boundary.cellsBeyond(kSurfaceTolerance, distance, subject.parts());
  const FollowedCurves curves =
      followedCurves(subject.mesh, places, object, kSurfaceTolerance * report.diagonal, stage);
  report.curveLength = curves.length / report.diagonal;
  report.curvesFollowed = curves.share;
  reportMoves(before, subject.mesh.points, report);
  reportOff(subject.mesh.points, places, report);
  listNotPositive(report);
  report.worst = worstCell(subject, boundary, places, report);
}

/// Snapping edges to curves adds a layer, too.
bool mayAddLayers(const ImproveOptions& options) {
  return options.pillow != PillowMode::Never || options.snapCurves;
}

/// Whether snapping edges to curves could help: some curves are not followed, or quads with two
/// edges on a curve are flat.
bool couldSnap(const ImproveOptions& options, const ImproveReport& report) {
  constexpr double kAll = 0.999;  // up to rounding and short chords
  return options.snapCurves && report.curveLength > 0 &&
         (report.curvesFollowed < kAll || !report.after.allPositive() ||
          report.after.quality.minimum < options.target);
}

/// Moves vertices off the surface at the end, as layers and snapped curves need them on it. Keeps
/// the mesh as it is if that makes it no better.
/// @param[in,out] report  complete
void closeIfBetter(const Moved& moved, const ImproveOptions& options,
                   const ReferenceSurface& object, const Array<Vec3>& before, ImproveReport& report,
                   Context& context, Stage& stage) {
  const auto& [subject, boundary, places, distance] = moved;
  if (!isOtherShape(distance)) return;
  const Array<Vec3> points = subject.mesh.points;
  ImproveReport other = report;
  const std::optional<BoundaryDistance> closed =
      closeGaps(subject, boundary, places, distance, options, other, context, stage);
  if (!closed) return;
  reportAfter({subject, boundary, places, *closed}, object, before, other, stage);
  if (meritOf(other) > meritOf(report)) {
    report = std::move(other);
  } else {
    subject.putBack(points);
  }
}

/// Moves points. Adds a layer and snaps edges to curves where that is requested and helps.
void moveAll(const Subject& subject, VertexPlaces& places, const ImproveOptions& options,
             ImproveReport& report, Context& context, Stage& stage) {
  HexMesh& mesh = subject.mesh;
  const Boundary boundary(mesh, treeOf(places.surface), stage);
  reportBefore(subject, boundary, places, report, stage);
  Positions initial(mesh.points, places);
  const Array<Vec3>& points = initial.points;
  try {
    const BoundaryDistance distance =
        movePoints(subject, boundary, places, options, initial, report, context, stage);
    const ImproveReport moved = mayAddLayers(options) ? report : ImproveReport{};
    const Moved plain(subject, boundary, places, distance);
    reportAfter(plain, places.surface, points, report, stage);
    std::optional<Improved> best =
        improvedWithPillow(mesh, boundary, places, options, moved, context, stage);
    if (best) {
      reportAfter(Moved(*best), places.surface, points, best->report, stage);
      if (options.pillow == PillowMode::Always || isWorthLayer(best->report, report)) {
        report = best->report;
      } else {
        best.reset();
      }
    }
    if (couldSnap(options, report)) {
      std::optional<Improved> snapped =
          improvedWithCurves(mesh, boundary, places, options, moved, context, stage);
      if (snapped) {
        reportAfter(Moved(*snapped), places.surface, points, snapped->report, stage);
        if (meritOf(snapped->report) > meritOf(report)) {
          report = snapped->report;
          best = std::move(snapped);
        }
      }
    }
    closeIfBetter(best ? Moved(*best) : plain, options, places.surface, points, report, context,
                  stage);
    stage.finish();
    if (best) mesh = std::move(best->mesh);
  } catch (...) {
    subject.putBack(points);
    throw;
  }
}

/// @param subjectOf  called with the context, once the options are checked
/// @param placesOf   called with (mesh, per vertex whether a cell there is not positive, stage)
template <class SubjectOf, class PlacesOf>
ImproveReport improveOn(const ImproveOptions& options, Context& context, const SubjectOf& subjectOf,
                        const PlacesOf& placesOf) {
  requireOptions(options);
  const auto begin = std::chrono::steady_clock::now();
  constexpr std::array<WorkStep, 4> kSteps = {
      {{"input", 0.1}, {"findCellFaults", 0.2}, {"certify", 0.4}, {"moving", 10}}};
  WorkSteps steps(context, "improve", kSteps);
  ImproveReport report;
  withThreads(context.threads(), [&] {
    const Subject subject = subjectOf(context);
    requireSoundCells(subject.mesh, subject.parts(), context);
    report.before = subject.certifyNow(context);
    Stage stage(context, "moving");
    VertexPlaces places = placesOf(subject.mesh, atBadCells(subject, report.before), stage);
    if (options.fixBoundary) report.boundaryVertices = fixBoundary(places);
    report.cannotBePositive =
        cellsThatCannotBePositive(subject.mesh, subject.parts(), report.before, stage);
    report.pairedVertices = fixPaired(subject, report.cannotBePositive, places);
    report.diagonal = diagonalOf(places.surface);
    if (report.diagonal < kSmallest) refuseSize("The surface is smaller than 1e-10");
    moveAll(subject, places, options, report, context, stage);
  });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  report.seconds = seconds.count();
  steps.finish();
  return report;
}

/// How to find the places of vertices: on the surface of a map, on the mesh's own, or on a given
/// one.
auto onMap(const TetMapView& map, const ImproveOptions& options) {
  return [&map, &options](const HexMesh& mesh, std::span<const std::uint8_t> /*isAtBad*/,
                          Stage& stage) {
    requirePositions(map.points, "the map", stage);
    return placesOnMap(mesh, map, options.featureAngle, stage);
  };
}
auto onItself(const ImproveOptions& options) {
  return [&options](const HexMesh& mesh, std::span<const std::uint8_t> isAtBad, Stage& stage) {
    return placesOnMesh(mesh, isAtBad, options.featureAngle, stage);
  };
}

auto onGiven(const TriangleMesh& surface, const ImproveOptions& options) {
  return [&surface, &options](const HexMesh& mesh, std::span<const std::uint8_t> isAtBad,
                              Stage& stage) {
    requirePositions(surface.points, "the surface", stage);
    return placesOnSurface(mesh, surface, isAtBad, options.featureAngle, stage);
  };
}

template <class PlacesOf>
ImproveReport improveStraight(HexMesh& mesh, const ImproveOptions& options, Context& context,
                              const PlacesOf& placesOf) {
  const auto subjectOf = [&mesh](Context& working) {
    requireCells(mesh, working);
    return Subject{mesh};
  };
  return improveOn(options, context, subjectOf, placesOf);
}

void requireImprovable(const LagrangeMesh& mesh, const ImproveOptions& options) {
  mesh::requireConsistent(mesh);
  if (mayAddLayers(options)) {
    throw Error(ErrorCode::InvalidArgument,
                "Layers under the boundary are added to straight cells, not to those of a curved "
                "mesh, and edges of straight ones are laid onto curves. Leave out both.");
  }
  if (mesh.order <= CurvedCells::kMaxOrder) return;
  throw Error(ErrorCode::InvalidArgument,
              concat("Cells of order ", mesh.order, " are not improved, only those of orders 1 to ",
                     CurvedCells::kMaxOrder, ". Choose a lower order."));
}

template <class PlacesOf>
ImproveReport improveCurved(LagrangeMesh& mesh, const ImproveOptions& options, Context& context,
                            const PlacesOf& placesOf) {
  HexMesh refined;
  const auto subjectOf = [&](Context& working) {
    requireImprovable(mesh, options);
    {
      Stage stage(working, "nodes");
      refined = refinedMesh(mesh, stage);
    }
    requireCells(refined, working);
    return Subject{refined, &mesh};
  };
  return improveOn(options, context, subjectOf, placesOf);
}

}  // namespace

}  // namespace hexhex::improvement

namespace hexhex {

ImproveReport improve(HexMesh& mesh, const TetMapView& map, const ImproveOptions& options,
                      Context& context) {
  return improvement::improveStraight(mesh, options, context, improvement::onMap(map, options));
}

ImproveReport improve(HexMesh& mesh, const ImproveOptions& options, Context& context) {
  return improvement::improveStraight(mesh, options, context, improvement::onItself(options));
}

ImproveReport improve(HexMesh& mesh, const TriangleMesh& surface, const ImproveOptions& options,
                      Context& context) {
  return improvement::improveStraight(mesh, options, context,
                                      improvement::onGiven(surface, options));
}

ImproveReport improve(LagrangeMesh& mesh, const TriangleMesh& surface,
                      const ImproveOptions& options, Context& context) {
  return improvement::improveCurved(mesh, options, context, improvement::onGiven(surface, options));
}

ImproveReport improve(LagrangeMesh& mesh, const TetMapView& map, const ImproveOptions& options,
                      Context& context) {
  return improvement::improveCurved(mesh, options, context, improvement::onMap(map, options));
}

ImproveReport improve(LagrangeMesh& mesh, const ImproveOptions& options, Context& context) {
  return improvement::improveCurved(mesh, options, context, improvement::onItself(options));
}

}  // namespace hexhex
