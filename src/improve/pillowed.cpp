#include <algorithm>
#include <string>
#include <utility>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <improve/merit.hpp>
#include <improve/pillowed.hpp>
#include <mesh/pillow.hpp>

namespace hexhex::improvement {

namespace {

/// Minimum gain in the least scaled Jacobian that justifies a layer, which adds cells and makes
/// those at edges and corners of the object worse.
constexpr double kWorthwhile = 0.02;

/// Whether a cell below the target has several faces on the boundary, which a pillow divides.
bool couldHelp(const Boundary& boundary, const ImproveOptions& options,
               const Certificate& certificate) {
  const auto isLow = [&](std::uint64_t cell) {
    return certificate.validity[cell] != Validity::Positive ||
           certificate.scaledJacobians[cell] < options.target;
  };
  const auto isSameCell = [](std::uint64_t a, std::uint64_t b) { return a / 8 == b / 8; };
  auto face = boundary.faces.begin();
  while ((face = std::adjacent_find(face, boundary.faces.end(), isSameCell)) !=
         boundary.faces.end()) {
    if (isLow(*face / 8)) return true;
    ++face;
  }
  return false;
}

/// New vertices are free, or have the place of their leader.
/// @return a leader that is fixed, so that its copy cannot move off it; kNone if there is none
Index extend(VertexPlaces& places, const mesh::Pillow& pillow) {
  const std::size_t n = places.freedom.size();
  for (std::size_t i = 0; i < pillow.leaders.size(); ++i) {
    const Index leader = pillow.leaders[i];
    const auto vertex = static_cast<Index>(n + i);
    places.freedom.push_back(leader != kNone ? places.freedom[leader] : Freedom::Free);
    places.simplex.push_back(leader != kNone ? places.simplex[leader] : kNone);
    places.isLoose.push_back(false);
    if (places.freedom[vertex] == Freedom::Fixed) return leader;
    places.simplex[vertex] = places.nearest(vertex, pillow.mesh.points[vertex]).simplex;
  }
  places.innerQuads = pillow.walls;
  return kNone;
}

}  // namespace

bool isWorthLayer(const ImproveReport& pillowed, const ImproveReport& without) {
  if (meritOf(pillowed) > meritOf(without)) return true;
  if (pillowed.distanceAfter.hausdorff() > farthestAllowed(without.distanceAfter)) return false;
  const std::uint64_t bad = notPositive(pillowed.after);
  const std::uint64_t badWithout = notPositive(without.after);
  if (bad != badWithout) return bad < badWithout;
  return pillowed.after.quality.minimum > without.after.quality.minimum + kWorthwhile;
}

void moveEnlarged(Improved& improved, const HexMesh& without, const ImproveOptions& options,
                  Context& context, Stage& stage) {
  ImproveReport& report = improved.report;
  Positions initial(improved.mesh.points, improved.places);
  const Array<Vec3>& points = initial.points;
  report.addedCells = improved.mesh.cells.size() - without.cells.size();
  report.addedPoints.assign(points.begin() + static_cast<std::ptrdiff_t>(without.points.size()),
                            points.end());
  const Subject subject{improved.mesh};
  Certificate before = std::exchange(report.before, subject.certifyNow(context));
  improved.distance = movePoints(subject, improved.boundary, improved.places, options, initial,
                                 report, context, stage);
  report.before = std::move(before);
}

std::optional<Improved> improvedWithPillow(const HexMesh& mesh, const Boundary& boundary,
                                           const VertexPlaces& places,
                                           const ImproveOptions& options,
                                           const ImproveReport& report, Context& context,
                                           Stage& stage) {
  const bool isAlways = options.pillow == PillowMode::Always;
  if (!isAlways &&
      (options.pillow == PillowMode::Never || !couldHelp(boundary, options, report.after)))
    return std::nullopt;
  mesh::Pillow pillow = mesh::addPillow(mesh, places.innerQuads, stage);
  Improved result{{}, {}, places, {}, report};
  if (!pillow.obstacle) {
    const Index held = extend(result.places, pillow);
    if (held != kNone) {
      pillow.obstacle = Error(
          ErrorCode::InvalidArgument,
          concat("A layer of cells under the boundary cannot pass a face or curve inside that ends "
                 "at vertex ",
                 held, ", which cannot move. Improve without a pillow."),
          Place{PlaceKind::Vertex, held, 0});
    }
  }
  if (pillow.obstacle) {
    if (isAlways) throw Error(*pillow.obstacle);
    return std::nullopt;
  }
  result.mesh = std::move(pillow.mesh);
  result.boundary = Boundary(result.mesh, boundary.surface, stage);
  moveEnlarged(result, mesh, options, context, stage);
  return result;
}

}  // namespace hexhex::improvement
