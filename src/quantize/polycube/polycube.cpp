// The seamless map of a polycube, given labels: the direction that each boundary triangle is to
// face (Gregson et al. 2011, All-Hex Mesh Generation via Volumetric PolyCube Deformation).
//
// 1. Tets that labels over-constrain are split (tets.hpp).
// 2. A smooth field of rotations aligns the boundary with its labels (field.hpp).
// 3. A linear problem finds the map that follows these rotations best. Its planes determine the
//    order of planes, which must be that of a polycube (borders.hpp).
// 4. The foldover-free solver moves vertices within their planes, and the planes (bend.hpp,
//    problem.hpp). Boundary triangles and edges in its energy are crucial: tets alone do not notice
//    triangles that fold over in their plane.
// 5. If that fails, tets at flips are refined and all steps are repeated: continuing from the
// failed
//    map does not help. If the number of flips does not decrease, the labels admit no map.
#include <string>

#include <hexhex/quantize.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <quantize/polycube/bend.hpp>
#include <quantize/polycube/field.hpp>
#include <quantize/polycube/polycube.hpp>
#include <quantize/polycube/tets.hpp>
#include <untangle/untangle.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#else
#include <base/missing_library.hpp>
#endif

#if defined(HEXHEX_HAS_QUANTIZE)
namespace hexhex::quantization {
namespace {

/// Maximum number of refinements.
constexpr int kMostRefinements = 3;
/// Budget of mapFromFlags() in solver steps times tets: about half a minute.
constexpr double kMostWork = 5e7;
/// Minimum budget in solver steps, for large meshes.
constexpr double kStepsOfAll = 1000;
constexpr double kMostStepsOfTry = 1e6;  // the solver gives up far earlier

double scaleOf(const TetMapView& view) {
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] =
        std::minmax_element(view.points.begin(), view.points.end(),
                            [k](const Vec3& a, const Vec3& b) { return a[k] < b[k]; });
    size = std::max(size, (*high)[k] - (*low)[k]);
  }
  return std::exp2(std::ceil(std::log2(kPolycubeUnits / std::max(size, 1e-300))));
}

/// If at most this share of the tets is flipped, refinement is tried before fixed planes.
constexpr double kFewShare = 1e-3;

template <class Count>
std::string counted(Count count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// @param tets  the tets that `bent` refers to
[[noreturn]] void fail(const BentTets& bent, const PolycubeTets& tets) {
  const PolycubeProblem& problem = bent.problem;
  std::size_t first = bent.flipped.front();
  std::string what;
  if (bent.isWound) {
    what = counted(bent.flipped.size(), "tet") + " overlap around edges, though none is flipped.";
  } else {
    what = std::to_string(bent.flipped.size()) +
           " tets, boundary triangles or edges between labels stay flipped, the first of them " +
           problem.nameOf(first) + ".";
    const std::vector<std::size_t> flat = untangle::flatElements(problem.solved());
    if (!flat.empty()) {
      first = flat.front();
      what.append(" ").append(std::to_string(flat.size()));
      what +=
          " are flat wherever they go, as labels bind their vertices to one plane or line: the "
          "first is " +
          problem.nameOf(first) + ".";
    }
  }
  throw Error(ErrorCode::FlippedTet,
              "The tets cannot be bent to a polycube that fits the labels: " + what +
                  " Look at the labels there, or refine the tets where the object is thin.",
              {PlaceKind::Tet, tets.parentTet[problem.tetAt(first)]});
}

/// Vertices of the flipped elements, ascending.
std::vector<Index> verticesAt(const BentTets& bent) {
  std::vector<Index> vertices;
  for (const std::size_t element : bent.flipped) {
    const std::vector<Index> more = bent.problem.verticesOf(element);
    vertices.insert(vertices.end(), more.begin(), more.end());
  }
  sortUnique(vertices);
  return vertices;
}

TetMap mapOf(const TetMapView& given, PolycubeTets tets, std::vector<TetParameters> parameters,
             double scale) {
  TetMap map{.points = std::move(tets.mesh.points),
             .tets = std::move(tets.mesh.tets),
             .parameters = std::move(parameters)};
  std::copy(given.points.begin(), given.points.end(), map.points.begin());
  for (std::size_t v = given.points.size(); v < map.points.size(); ++v) {
    for (double& x : map.points[v]) x /= scale;
  }
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) {
      for (double& x : u) x /= scale;
    }
  }
  tetmap::carryTags(given.features, given.regions, tets.added, tets.parentTet, map);
  return map;
}

class PolycubeMaker {
 public:
  PolycubeMaker(const TetMesh& tets, std::span<const FaceFlags> flags, double& workLeft,
                Context& context)
      : context_(context),
        mostWork_(workLeft),
        workLeft_(workLeft),
        given_(read(tets, flags)),
        borders_(given_),
        scale_(scaleOf(given_.input.view)),
        tets_(polycubeTets(given_, scale_)) {}

  TetMap run() {
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (int refinements = 0;; ++refinements) {
      makeRoom(tets_);
      std::optional<BentTets> best;
      if (bend(refinements < kMostRefinements, best)) break;
      const std::size_t flips = best->flipped.size();
      if (refinements == kMostRefinements || workLeft_ <= 0 || flips >= fewest) {
        fail(*best, tets_);
      }
      fewest = flips;
      refineAt(tets_, verticesAt(*best));
    }
    return mapOf(given_.input.view, std::move(tets_), std::move(parameters_), scale_);
  }

 private:
  LabelledMesh read(const TetMesh& tets, std::span<const FaceFlags> flags) {
    Stage stage(context_, "labels");
    return readLabels(tets, flags, stage);
  }

  /// @param mayRefine  false in the last attempt
  /// @param[out] best  the attempt with the fewest flips, unless one succeeds
  /// @return whether one succeeds
  bool bend(bool mayRefine, std::optional<BentTets>& best) {
    mesh_ = read(tets_.mesh, tets_.flags);
    const PolycubeProblem start = place();
    const auto planeAt = [&](int axis, Index vertex) {
      return static_cast<std::int64_t>(
          std::llround(start.at(vertex, static_cast<std::size_t>(axis))));
    };
    // Checks the given mesh first, so that errors carry the caller's numbers.
    static_cast<void>(borders_.edges(planeAt));
    const std::vector<PolycubeEdge> edges = PolycubeBorders(mesh_).edges(planeAt);
    Stage stage(context_, "untangling");
    for (const bool fixPlanes : {false, true}) {
      if (fixPlanes && (workLeft_ <= 0 || (mayRefine && isFew(*best)))) break;
      const auto tets = static_cast<double>(tets_.flags.size());
      const int steps = static_cast<int>(std::clamp(workLeft_ / tets, 1.0, kMostStepsOfTry));
      BentTets bent = bendTets(mesh_, start, edges, fixPlanes, steps, stage);
      workLeft_ -= bent.steps * tets;
      announce(bent, fixPlanes);
      if (bent.flipped.empty()) {
        parameters_ = parametersOf(mesh_, bent.problem);
        return true;
      }
      if (!best || bent.flipped.size() < best->flipped.size()) best.emplace(std::move(bent));
    }
    return false;
  }

  /// Whether only a few places lack room, to which fixed planes make no difference.
  [[nodiscard]] bool isFew(const BentTets& bent) const {
    return kFewShare * static_cast<double>(tets_.flags.size()) >=
           static_cast<double>(bent.flipped.size());
  }

  /// Reports an attempt as progress.
  void announce(const BentTets& bent, bool fixPlanes) {
    context_.report("untangling " + std::to_string(tets_.flags.size()) + " tets, planes " +
                        (fixPlanes ? "fixed: " : "free: ") + counted(bent.steps, "step") + ", " +
                        std::to_string(bent.flipped.size()) + " flips",
                    std::min(1.0, 1 - workLeft_ / mostWork_));
  }

  /// Solves for the map that follows the rotation field best; it may have flipped tets.
  PolycubeProblem place() {
    Stage stage(context_, "planes");
    PolycubeProblem problem(mesh_, rotationField(mesh_, stage));
    untangle::Solver(problem.solved(), stage).start();
    return problem;
  }

  Context& context_;
  double mostWork_;
  double& workLeft_;
  LabelledMesh given_;
  PolycubeBorders borders_;
  double scale_;
  PolycubeTets tets_;  ///< with points times `scale_`
  LabelledMesh mesh_;  ///< labels of `tets_`; bent problems refer to it
  std::vector<TetParameters> parameters_;
};

}  // namespace

TetMap mapFromLabels(const TetMesh& tets, std::span<const FaceFlags> flags, double& workLeft,
                     Context& context) {
  constexpr std::array<WorkStep, 3> kSteps = {{{"labels", 1}, {"planes", 2}, {"untangling", 6}}};
  return inSteps(context, "mapFromFlags", kSteps, [&] {
    TetMap map;
    withThreads(context.threads(),
                [&] { map = PolycubeMaker(tets, flags, workLeft, context).run(); });
    return map;
  });
}

}  // namespace hexhex::quantization
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_QUANTIZE)

TetMap mapFromFlags(const TetMesh& tets, std::span<const FaceFlags> flags, Context& context) {
  double work = std::max(quantization::kMostWork,
                         quantization::kStepsOfAll * static_cast<double>(tets.tets.size()));
  return quantization::mapFromLabels(tets, flags, work, context);
}
#else
TetMap mapFromFlags(const TetMesh& /*tets*/, std::span<const FaceFlags> /*flags*/,
                    Context& /*context*/) {
  failWithoutLibrary("make maps of labels", "Eigen (libeigen3-dev)");
}
#endif

}  // namespace hexhex
