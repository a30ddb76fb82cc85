#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include <adjacency/hex_topology.hpp>

#include <improve/all_at_once.hpp>
#include <improve/closing.hpp>
#include <improve/moving.hpp>
#include <improve/sweeps.hpp>

namespace hexhex::improvement {

namespace {

/// Maximum number of cells below the target for moving all at once: more take a minute or longer.
constexpr std::size_t kMostLowAtOnce = 5'000;

/// A mesh farther than 5e-3 diagonals from the surface counts as a different shape. The limit is a
/// tenth lower, for what samples miss.
constexpr double kOtherShape = 4.5e-3;
/// Boundary quads of meshes farther than the first one shrink where they are far, until these are
/// no farther than the second one.
constexpr double kSpreadFrom = 3.5e-3;
constexpr double kFarChord = 2.5e-3;
/// Maximum number of rounds, and of consecutive rounds without a nearer mesh.
constexpr int kMostSpreads = 40;
constexpr int kSpreadStalls = 4;
/// Gaps are closed to this or, as no more can be had of chords, to half of the largest, until none
/// is longer than the second one: below kOtherShape, since samples miss some of the distance. Each
/// round that comes no nearer was too much at once: after it, half as much is closed.
/// Maximum number of rounds, and of consecutive rounds without a nearer mesh.
constexpr double kClosed = 3.5e-3;
constexpr double kCloseEnough = 4e-3;
constexpr int kMostClosings = 10;
constexpr int kClosingStalls = 3;
/// A smaller reduction of the distance is not worth the quality that it costs.
constexpr double kNearer = 0.99;
/// Nor is one after which less than this fraction of the sum of scaled Jacobians is left: of a mesh
/// of a different shape, and otherwise.
constexpr double kKeptOther = 0.98;
constexpr double kKept = 0.99;

/// The least scaled Jacobian to preserve: the initial one, but at most the target if the mesh is
/// pulled onto a given surface, which makes good cells worse.
double leastKept(const ImproveReport& report, const VertexPlaces& places, double target) {
  const double least = report.before.quality.minimum;
  return places.isGiven ? std::min(least, target) : least;
}

/// Cells that lost their certificate, or whose scaled Jacobian fell below the least to preserve.
std::vector<Index> worsened(const ImproveReport& report, double least) {
  std::vector<Index> cells;
  for (Index c = 0; c < report.after.validity.size(); ++c) {
    const bool isLost = report.before.validity[c] == Validity::Positive &&
                        report.after.validity[c] != Validity::Positive;
    if (isLost || report.after.scaledJacobians[c] < least) {
      cells.push_back(c);
    }
  }
  return cells;
}

}  // namespace

Boundary::Boundary(const HexMesh& mesh, TriangleTree surface_, Stage& stage)
    : faces(adjacency::boundaryPlaces(mesh, stage)),
      quads(adjacency::quadsAt(mesh, faces)),
      surface(std::move(surface_)) {}

BoundaryDistance Boundary::distanceTo(const VertexPlaces& places, const Array<Vec3>& points,
                                      double diagonal, Stage& stage,
                                      const Accuracy& accuracy) const {
  return distanceBetween(points, quads, places.surface, surface, diagonal, stage, accuracy);
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

bool isOtherShape(const BoundaryDistance& distance) {
  return distance.largest.hausdorff() > kOtherShape;
}

namespace {

/// Moves the points of a mesh, with the data that all steps share.
class Moving {
 public:
  Moving(const Subject& subject, const Boundary& boundary, VertexPlaces& places,
         const ImproveOptions& options, Positions& before, ImproveReport& report, Stage& stage)
      : subject_(subject),
        boundary_(boundary),
        places_(places),
        options_(options),
        report_(report),
        stage_(stage),
        before_(before),
        limit_(farthestAllowed(report.distanceBefore)),
        slack_(options.slack * report.diagonal) {}

  [[nodiscard]] BoundaryDistance distance(const Accuracy& accuracy = {}) const {
    return boundary_.distanceTo(places_, subject_.mesh.points, report_.diagonal, stage_, accuracy);
  }

  /// Improves the mesh as far as possible.
  BoundaryDistance run() {
    Sweeps sweeps = newSweeps();
    const double target = options_.target;
    const std::vector<Index> wereBad = badCells(sweeps);
    // Near cells that cannot become positive, others would get worse.
    const bool canAtOnce =
        !subject_.isCurved() && report_.cannotBePositive.empty() && canMoveAtOnce();
    const Sweeps::Standing initial = sweeps.standing(target);
    const bool isFolded = canAtOnce && 2 * initial.bad > subject_.mesh.cells.size();
    if (isFolded) sweeps.moveAtOnce(target, slack_, true, [&] { return quadsTooFar(); });
    pull(sweeps);
    oneByOne(sweeps);
    pull(sweeps);  // vertices that bad cells held back
    const double lowest = std::max(target, leastKept(report_, places_, target));
    double floor = lowest;
    const Sweeps::Standing standing = sweeps.standing(target);
    const std::size_t low = standing.bad + standing.below;
    if (canAtOnce && low > 0 && low <= kMostLowAtOnce) atOnce(sweeps, wereBad);
    // Meshes without low cells would take as long again. Without a target, cells need only be
    // positive.
    const bool isRaised = target > 0 && options_.passes > 0 && initial.bad + initial.below > 0;
    if (!subject_.isCurved() && isRaised && sweeps.standing(target).depth <= 1 - target) {
      floor = std::max(floor, raiseFurther(sweeps));
    }
    sweeps.smooth(options_.passes, floor);
    raiseAgain(sweeps, floor);
    letGo(sweeps, floor);
    Array<Quad> far = quadsTooFar();
    for (const double kept : {floor, lowest}) {
      for (int i = 0; i < Sweeps::kReturns && !far.empty(); ++i) {
        sweeps.moveBack(far, before_, kept);
        far = quadsTooFar();
      }
    }
    const BoundaryDistance after = distance();
    return canMoveBoundary() ? spread(sweeps, floor, after) : after;
  }

  /// Moves vertices off the surface where the mesh is a different shape although they are on it:
  /// the error of chords is then on both sides.
  BoundaryDistance close(const BoundaryDistance& after) {
    if (!canMoveBoundary() || slack_ == 0 || places_.isOwn) return after;
    Sweeps sweeps = newSweeps();
    return close(sweeps, after);
  }

  /// Restores all points that moved together with those of some cells.
  void putBackAt(std::span<const Index> cells) {
    putBack(newSweeps().cellPoints(), cells, before_, subject_.mesh.points, places_);
  }

 private:
  [[nodiscard]] bool canMoveBoundary() const {
    return !subject_.isCurved() && options_.passes > 0 && !options_.fixBoundary;
  }

  [[nodiscard]] Sweeps newSweeps() {
    return {subject_, places_, before_, report_.diagonal, stage_};
  }

  [[nodiscard]] Array<Quad> quadsTooFar() const {
    Array<Quad> far;
    for (const Index q : distance({.enough = limit_}).quadsBeyond(limit_)) {
      far.push_back(boundary_.quads[q]);
    }
    return far;
  }

  /// Initially bad cells; none after layers were added, whose cells start out bad although the
  /// surface is right.
  [[nodiscard]] std::vector<Index> badCells(const Sweeps& sweeps) const {
    return report_.addedCells > 0 ? std::vector<Index>() : sweeps.cellsBelow(-1);
  }

  /// Records vertices that left their creases. If restored, they are on a patch, not on a crease.
  void noteLoose(std::span<const Index> vertices) {
    report_.offCreases += vertices.size();
    for (const Index v : vertices) {
      before_.setSimplex(
          v, places_.surface.acrossCreases(before_.points[v], places_.simplex[v]).simplex);
    }
  }

  /// Pulls the mesh onto a given surface, with leastKept() as the floor, but not less than 0.
  void pull(Sweeps& sweeps) const {
    if (!places_.isGiven) return;
    sweeps.pullOntoSurface(std::max(0.0, leastKept(report_, places_, options_.target)));
  }

  void oneByOne(Sweeps& sweeps) const {
    sweeps.untangle(slack_);
    sweeps.raiseWorst(options_.target, 0);
  }

  /// Shrinks quads that are far from the surface, as long as the mesh gets nearer. Preserves the
  /// least scaled Jacobian, and nearly all of the mean.
  BoundaryDistance spread(Sweeps& sweeps, double floor, BoundaryDistance best) const {
    if (best.largest.hausdorff() <= kSpreadFrom) return best;
    Positions nearest = sweeps.positions();
    BoundaryDistance now = best;
    const auto sum = [&] {
      const Array<double>& all = sweeps.qualities();
      return std::accumulate(all.begin(), all.end(), 0.0);
    };
    const double enough = (isOtherShape(best) ? kKeptOther : kKept) * sum();
    floor = std::max(floor, 1 - sweeps.standing(options_.target).depth);
    int stalls = 0;
    for (int i = 0; i < kMostSpreads && stalls < kSpreadStalls; ++i) {
      if (now.largest.hausdorff() <= kFarChord) break;
      sweeps.spread(boundary_.quads, now.ofQuads, kFarChord / 2, floor);
      now = distance();
      ++stalls;
      if (now.largest.hausdorff() > kNearer * best.largest.hausdorff() || sum() < enough) continue;
      stalls = 0;
      best = now;
      nearest = sweeps.positions();
    }
    sweeps.putBackAll(nearest);
    return best;
  }

  /// Per vertex: 1 if it must not leave the surface, since it is a corner, on something tagged, or
  /// at a face inside.
  [[nodiscard]] std::vector<std::uint8_t> heldOnSurface() const {
    std::vector<std::uint8_t> isHeld(subject_.mesh.points.size(), 0);
    for (Index v = 0; v < isHeld.size(); ++v) {
      const Freedom freedom = places_.freedom[v];
      if (freedom == Freedom::Free) continue;
      const bool isTagged = places_.surface.isTagged(freedom, places_.simplex[v]);
      if (isTagged || freedom == Freedom::Fixed) isHeld[v] = 1;
    }
    for (const Quad& quad : places_.innerQuads) {
      for (const Index v : quad) isHeld[v] = 1;
    }
    return isHeld;
  }

  BoundaryDistance close(Sweeps& sweeps, BoundaryDistance best) const {
    const std::vector<std::uint8_t> isHeld = heldOnSurface();
    Positions nearest = sweeps.positions();
    double limit = kOtherShape;
    double cut = 0.5;
    for (int i = 0, stalls = -1; i < kMostClosings && stalls < kClosingStalls; ++i) {
      const BoundaryDistance now = distance({.gapsFrom = limit / 2});
      ++stalls;
      if (now.largest.hausdorff() < kNearer * best.largest.hausdorff()) {
        stalls = 0;
        best = now;
        nearest = sweeps.positions();
      } else if (i > 0) {
        cut /= 2;
      }
      if (now.largest.hausdorff() <= kCloseEnough) break;
      limit = std::max(kClosed, (1 - cut) * best.largest.hausdorff());
      sweeps.shift(closingMoves(now.gaps, boundary_.quads, isHeld, limit * report_.diagonal),
                   options_.target);
    }
    sweeps.putBackAll(nearest);
    return best;
  }

  /// Moves all vertices at once where cells are still below the target. Around initially bad cells,
  /// edges of folds are not features, and the surface is no more accurate than its folds: vertices
  /// are released from creases and may leave the surface. Restores all points if the mesh is no
  /// better afterwards.
  /// @param wereBad  the initially bad cells
  void atOnce(Sweeps& sweeps, const std::vector<Index>& wereBad) {
    constexpr int kRings = 2;
    const double target = options_.target;
    const Sweeps::Standing standing = sweeps.standing(target);
    const std::vector<Index> below = sweeps.cellsBelow(target);
    std::vector<Index> low = sweeps.verticesNear(below, 0);
    {
      const std::vector<Index> near = sweeps.verticesNear(wereBad, kRings);
      std::erase_if(low, [&](Index v) { return !std::binary_search(near.begin(), near.end(), v); });
    }
    LooseVertices loose(places_, low, subject_.mesh.points);
    const Positions before = sweeps.positions();
    sweeps.moveAtOnce(target, slack_, false, [&] { return quadsTooFar(); });
    oneByOne(sweeps);
    if (!wereBad.empty()) sweeps.raiseWorst(target, slack_);
    const Sweeps::Standing now = sweeps.standing(target);
    const bool isUntangled = now.bad == 0 && standing.bad > 0;
    const bool isBetter =
        isUntangled || (now < standing && sweeps.fallenSince(below, target).empty());
    if (!isBetter) sweeps.putBackAll(before);
    noteLoose(loose.holdUnmoved(subject_.mesh.points));
  }

  /// Raises the worst cells and smooths in turns until progress gets small: once their neighbours
  /// are smooth, they have room. Not in curved cells, where it would double the time.
  void raiseAgain(Sweeps& sweeps, double floor) const {
    if (subject_.isCurved() || options_.passes == 0) return;
    constexpr int kMost = 15;
    constexpr double kStall = 0.001;
    // Of what is missing: a turn over a million bad cells takes a third of the whole time.
    constexpr double kSlow = 0.01;
    const double target = options_.target;
    Sweeps::Standing now = sweeps.standing(target);
    for (int i = 0; i < kMost && now.bad + now.below > 0; ++i) {
      const Sweeps::Standing was = now;
      sweeps.raiseWorst(target, 0);
      sweeps.smooth(1, floor);
      now = sweeps.standing(target);
      const double missing = was.depth - (1 - target);
      if (was.depth - now.depth < std::max(kStall, kSlow * missing)) break;
    }
  }

  /// Releases vertices of the worst cells from creases that fade out, as edges of coarse triangles
  /// on smooth surfaces do, and raises these cells again. Restores all points if that is no better.
  void letGo(Sweeps& sweeps, double floor) {
    if (subject_.isCurved() || options_.passes == 0) return;
    constexpr double kWorthwhile = 0.02;
    std::vector<Index> low = sweeps.verticesBelow(options_.target, 0);
    std::erase_if(low, [&](Index v) {
      return !places_.surface.isFading(places_.freedom[v], places_.simplex[v]);
    });
    if (low.empty()) return;
    const Positions before = sweeps.positions();
    const Sweeps::Standing was = sweeps.standing(options_.target);
    LooseVertices loose(places_, low, subject_.mesh.points);
    raiseAgain(sweeps, floor);
    if (sweeps.standing(options_.target).depth > was.depth - kWorthwhile) sweeps.putBackAll(before);
    noteLoose(loose.holdUnmoved(subject_.mesh.points));
  }

  /// Improves the worst cells until progress gets small.
  /// @return the least scaled Jacobian, or less if a cell is not certified
  static double raiseFurther(Sweeps& sweeps) {
    constexpr int kMost = 10;
    constexpr double kAim = 0.05;
    constexpr double kStall = 0.01;
    const auto least = [&] { return 1 - sweeps.standing(0).depth; };
    double now = least();
    for (int i = 0; i < kMost; ++i) {
      const double was = now;
      sweeps.raiseWorst(std::min(was + kAim, 1.0), 0);
      now = least();
      if (now < was + kStall) break;
    }
    return now;
  }

  const Subject& subject_;
  const Boundary& boundary_;
  VertexPlaces& places_;
  const ImproveOptions& options_;
  ImproveReport& report_;
  Stage& stage_;
  Positions& before_;
  double limit_;  ///< of distances, in diagonals
  double slack_;
};

}  // namespace

BoundaryDistance movePoints(const Subject& subject, const Boundary& boundary, VertexPlaces& places,
                            const ImproveOptions& options, Positions& before, ImproveReport& report,
                            Context& context, Stage& stage) {
  Moving moving(subject, boundary, places, options, before, report, stage);
  BoundaryDistance after = moving.run();
  report.after = subject.certifyNow(context);
  const std::vector<Index> worse = worsened(report, leastKept(report, places, options.target));
  if (worse.empty()) return after;
  moving.putBackAt(worse);
  report.after = subject.certifyNow(context);
  return moving.distance();
}

std::optional<BoundaryDistance> closeGaps(const Subject& subject, const Boundary& boundary,
                                          VertexPlaces& places, const BoundaryDistance& distance,
                                          const ImproveOptions& options, ImproveReport& report,
                                          Context& context, Stage& stage) {
  Positions before(subject.mesh.points, places);
  Moving moving(subject, boundary, places, options, before, report, stage);
  BoundaryDistance after = moving.close(distance);
  if (after.largest.hausdorff() >= distance.largest.hausdorff()) return std::nullopt;
  Certificate was = std::exchange(report.after, subject.certifyNow(context));
  if (notPositive(report.after) <= notPositive(was)) return after;
  subject.putBack(before.points);
  report.after = std::move(was);
  return std::nullopt;
}

}  // namespace hexhex::improvement
