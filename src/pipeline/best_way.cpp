#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <pipeline/best_way.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <improve/merit.hpp>

namespace hexhex::pipeline {
namespace {

/// Limits of a good enough polycube mesh: minimum scaled Jacobian, distance from the part in
/// diagonals (with coarse quads, chords alone cost some thousandths), fraction of curves followed.
constexpr double kGood = 0.5;
constexpr double kNear = 5e-3;
constexpr double kFollowed = 0.99;

/// The faster one first.
constexpr std::array<ShapeMethod, 2> kWays = {ShapeMethod::Polycube, ShapeMethod::Frames};

std::string_view nameOf(ShapeMethod method) {
  return method == ShapeMethod::Frames ? "frames" : "polycube";
}

/// The result of one way: its mesh, why it has none, or an error that ends the search.
struct Outcome {
  std::optional<MeshedPart> part;
  std::optional<Error> refusal;
  std::exception_ptr failure;
  bool isNeeded = true;
};

WayReport reportOf(ShapeMethod method, const Outcome& outcome) {
  WayReport report;
  report.method = method;
  if (!outcome.isNeeded) return report;
  if (outcome.refusal) report.refusal = outcome.refusal->what();
  if (!outcome.part) return report;
  const ImproveReport& improved = outcome.part->improvement;
  report.hasMesh = true;
  report.isCertified = improved.after.allPositive();
  report.minimum = improved.after.quality.minimum;
  report.distance = improved.distanceAfter.hausdorff();
  report.curvesFollowed = improved.curvesFollowed;
  report.merit = improvement::meritOf(improved);
  return report;
}

/// Whether a better mesh is not worth waiting for.
bool isGoodEnough(const Outcome& outcome) {
  if (!outcome.part) return false;
  const WayReport report = reportOf(ShapeMethod::Auto, outcome);
  return report.isCertified && report.minimum >= kGood && report.distance <= kNear &&
         report.curvesFollowed >= kFollowed;
}

/// "frames: scaled Jacobian 0.3 at least, 0.0056 diagonals from the part, 100 % of curves"
std::string figuresOf(const WayReport& way) {
  std::ostringstream text;
  text.precision(2);
  text << nameOf(way.method) << ": scaled Jacobian " << way.minimum << " at least, " << way.distance
       << " diagonals from the part, " << std::lround(100 * way.curvesFollowed) << " % of curves";
  return text.str();
}

std::string whyKept(const WayReport& kept, const WayReport& other, bool otherIsNeeded) {
  if (!otherIsNeeded) return figuresOf(kept) + "; no other way was needed";
  if (!other.hasMesh) return "the only way with a mesh";
  if (kept.isCertified != other.isCertified) return "the only way with a certified mesh";
  return figuresOf(kept) + "; " + figuresOf(other);
}

[[noreturn]] void failBoth(const std::array<Outcome, 2>& outcomes) {
  const Error& first = *outcomes[0].refusal;
  const Error& second = *outcomes[1].refusal;
  if (std::string_view(first.what()) == second.what()) throw Error(first);
  // The place of another code is one in the map.
  const auto placeInPart = [](const Error& error) {
    return error.code() == ErrorCode::NotMeshable ? error.place() : Place{};
  };
  const Place place = placeInPart(first);
  throw Error(ErrorCode::NotMeshable,
              "Neither way leads to a mesh. By a polycube: " + std::string(first.what()) +
                  " Along frames: " + second.what(),
              place.kind == PlaceKind::None ? placeInPart(second) : place);
}

/// Runs both ways, each in a context of its own that shares the caller's progress and cancellation.
class BothWays {
 public:
  BothWays(const Way& way, Context& context)
      : way_(way), caller_(context), contexts_{contextOf(0), contextOf(1)} {}

  MeshedPart run(bool atOnce) {
    if (atOnce) {
      withThreads(caller_.threads(), [&] {
        Stage stage(caller_, "both ways");
        parallelFor(stage, kWays.size(), 1, [&](std::size_t i) { go(i); });
      });
    } else {
      for (std::size_t i = 0; i < kWays.size(); ++i) {
        if (i == 0 || !isGoodEnough(outcomes_[0])) go(i);
      }
    }
    for (const Context& context : contexts_) {
      for (const StageTime& time : context.stageTimes()) {
        caller_.addStageTime(time.stage, time.seconds);
      }
    }
    return better();
  }

 private:
  [[nodiscard]] Context contextOf(std::size_t i) {
    return Context(caller_.threads(), [this, i](std::string_view stage, double share) {
      shares_[i].store(share);
      if (caller_.cancelled()) contexts_[i].cancel();
      caller_.report(std::string(nameOf(kWays[i])) + ": " + std::string(stage),
                     (shares_[0].load() + shares_[1].load()) / 2);
    });
  }

  void go(std::size_t i) {
    try {
      outcomes_[i].part = way_(kWays[i], contexts_[i]);
      if (i == 0 && isGoodEnough(outcomes_[0])) contexts_[1].cancel();
    } catch (const Refusal& refusal) {
      outcomes_[i].refusal = refusal;
    } catch (...) {
      outcomes_[i].failure = std::current_exception();
    }
  }

  MeshedPart better() {
    // Discard what the other way has found so far: with one thread, it would not have started.
    if (isGoodEnough(outcomes_[0])) {
      outcomes_[1] = {};
      outcomes_[1].isNeeded = false;
    }
    for (const Outcome& outcome : outcomes_) {
      if (outcome.failure) std::rethrow_exception(outcome.failure);
    }
    if (!outcomes_[0].part && !outcomes_[1].part) failBoth(outcomes_);
    std::array<WayReport, 2> reports;
    for (std::size_t i = 0; i < kWays.size(); ++i) reports[i] = reportOf(kWays[i], outcomes_[i]);
    // If neither is certified, keep frames, which usually come closer.
    const bool isFirst = outcomes_[0].part && reports[0].merit > reports[1].merit;
    const std::size_t kept = isFirst || !outcomes_[1].part ? 0 : 1;
    MeshedPart part = std::move(*outcomes_[kept].part);
    part.whyThisWay = whyKept(reports[kept], reports[1 - kept], outcomes_[1 - kept].isNeeded);
    part.ways.assign(reports.begin(), reports.end());
    return part;
  }

  const Way& way_;
  Context& caller_;
  std::array<std::atomic<double>, 2> shares_{};
  std::array<Context, 2> contexts_;
  std::array<Outcome, 2> outcomes_;
};

}  // namespace

bool isOfTheWay(ErrorCode code, bool hasMap) noexcept {
  switch (code) {
    case ErrorCode::NotMeshable:
      return true;
    case ErrorCode::FlippedTet:
    case ErrorCode::HalfIntegerFixedPoint:
    case ErrorCode::TransitionResidual:
    case ErrorCode::BoundaryOffLattice:
    case ErrorCode::SingularityOffLattice:
    case ErrorCode::AmbiguousMesh:
    case ErrorCode::TooLarge:
    case ErrorCode::EmptyMesh:
    case ErrorCode::NonManifoldFace:
    case ErrorCode::NonManifoldEdge:
    case ErrorCode::NonManifoldVertex:
    case ErrorCode::Orientation:
      return hasMap;
    default:
      return false;
  }
}

MeshedPart firstMesh(const std::function<MeshedPart(std::uint64_t)>& meshOfMap,
                     std::uint64_t mostMaps) {
  std::optional<Refusal> first;
  for (std::uint64_t map = 0;; ++map) {
    try {
      return meshOfMap(map);
    } catch (const Refusal& refusal) {
      if (!first) first = refusal;
      if (!refusal.hasMap() || map + 1 == mostMaps) throw Refusal(*first);
    }
  }
}

MeshedPart bestOfBothWays(const Way& way, bool atOnce, Context& context) {
  return BothWays(way, context).run(atOnce && effectiveThreads(context.threads()) > 1);
}

}  // namespace hexhex::pipeline
