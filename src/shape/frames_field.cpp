#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <shape/frames_field.hpp>

#include <base/parallel.hpp>

namespace hexhex::shape {

namespace {

using adjacency::HalfFace;
using Eigen::Vector3d;
using Tensors = Eigen::Matrix<double, 9, Eigen::Dynamic>;

constexpr std::size_t kTetGrain = 256;

/// Diffusion times decrease by a factor from this fraction of the object's squared diagonal down to
/// the squared edge length.
constexpr double kLongest = 0.02;
constexpr double kShorter = 0.4;
/// Rounds per time, and for the last time.
constexpr int kRounds = 4;
constexpr int kLastRounds = 20;
/// Rounds end when the energy changes by less than this fraction.
constexpr double kAtRest = 1e-4;
/// Lower bound on the distance between centroids of neighbours, in edge lengths: smaller ones would
/// weld the two tets together.
constexpr double kLeastDistance = 0.1;
/// Lower bound on volumes, relative to their mean: less is noise.
constexpr double kLeastVolume = 1e-3;

/// Restricts a tet's tensor to a circle (if an axis is given), or to a single one.
struct Condition {
  std::optional<Frame> fixed;
  std::optional<Vector3d> axis;
  FrameTensor middle = FrameTensor::Zero();
  FrameTensor cosine = FrameTensor::Zero();  ///< normalized
  FrameTensor sine = FrameTensor::Zero();    ///< normalized

  [[nodiscard]] bool isFree() const { return !fixed && !axis; }
  /// Projects a change to those that keep the condition.
  [[nodiscard]] FrameTensor allowed(const FrameTensor& change) const {
    if (isFree()) return change;
    return cosine * cosine.dot(change) + sine * sine.dot(change);
  }
};

class FieldMaker {
 public:
  FieldMaker(const FrameTets& tets, Stage& stage)
      : tets_(tets), stage_(stage), conditions_(tets.size()) {
    parallelFor(stage, tets.size(), kTetGrain,
                [&](std::size_t t) { conditions_[t] = conditionOf(static_cast<Index>(t)); });
    measure();
  }

  std::vector<Frame> run() {
    frames_.assign(tets_.size(), Frame::Identity());
    tensors_ = Tensors::Zero(9, std::ssize(frames_));
    constexpr double kHarmonic = 1e-9;
    diffuse(1, kHarmonic, 1e-5, 1500);
    project();
    const double shortest = tets_.edgeLength() * tets_.edgeLength();
    for (double time = kLongest * extent() * extent(); time > shortest; time *= kShorter) {
      settle(time, kRounds);
    }
    settle(shortest, kLastRounds);
    return std::move(frames_);
  }

 private:
  [[nodiscard]] Condition conditionOf(Index t) const {
    const Tet& tet = tets_.mesh().tets[t];
    Condition condition;
    int outside = -1;
    for (int face = 0; face < 4; ++face) {
      if (tets_.topology().isBoundary(adjacency::halfFaceOf(t, face))) outside = face;
    }
    std::optional<Vector3d> along;
    tetmap::forEachEdgeOf(tet, [&](const VertexPair& edge, lattice::CornerMask corners) {
      if (outside >= 0 && lattice::contains(corners, outside)) return;
      if (tets_.isFeature(edge)) along = (tets_.point(edge[1]) - tets_.point(edge[0])).normalized();
    });
    if (outside < 0) {
      condition.axis = along;
    } else {
      condition.axis = tets_.normal(adjacency::halfFaceOf(t, outside)).normalized();
    }
    if (outside >= 0 && along) {
      Frame frame;
      frame.col(0) = *condition.axis;
      frame.col(1) = (*along - frame.col(0) * frame.col(0).dot(*along)).normalized();
      frame.col(2) = Vector3d(frame.col(0)).cross(Vector3d(frame.col(1)));
      condition.fixed = frame;
      condition.middle = tensorOf(frame);
    } else if (condition.axis) {
      const TensorCircle circle(*condition.axis);
      condition.middle = circle.middle;
      condition.cosine = circle.cosine.normalized();
      condition.sine = circle.sine.normalized();
    }
    return condition;
  }

  /// Computes volumes of tets and weights of neighbours, area / distance.
  void measure() {
    const adjacency::TetTopology& topology = tets_.topology();
    masses_.resize(tets_.size());
    std::vector<Vector3d> middles(tets_.size(), Vector3d::Zero());
    double sum = 0;
    for (Index t = 0; t < tets_.size(); ++t) {
      masses_[t] = tets_.volume(t);
      sum += masses_[t];
      for (const Index v : topology.tets[t]) middles[t] += 0.25 * tets_.point(v);
    }
    const double least = kLeastVolume * sum / static_cast<double>(tets_.size());
    for (double& mass : masses_) mass = std::max(mass, least);
    pulls_.resize(topology.mate.size());
    allPulls_.assign(tets_.size(), 0);
    for (HalfFace h = 0; h < pulls_.size(); ++h) {
      if (topology.isBoundary(h)) continue;
      const Index here = adjacency::tetOf(h);
      const double apart =
          std::max((middles[here] - middles[adjacency::tetOf(topology.mate[h])]).norm(),
                   kLeastDistance * tets_.edgeLength());
      pulls_[h] = 0.5 * tets_.normal(h).norm() / apart;
      allPulls_[here] += pulls_[h];
    }
  }

  [[nodiscard]] double extent() const {
    Vector3d low = tets_.point(0);
    Vector3d high = low;
    for (const Tet& tet : tets_.mesh().tets) {
      for (const Index v : tet) {
        low = low.cwiseMin(tets_.point(v));
        high = high.cwiseMax(tets_.point(v));
      }
    }
    return (high - low).norm();
  }

  /// The Laplacian of tensors at a tet. Weights are halved, as the energy counts each triangle from
  /// both sides.
  [[nodiscard]] FrameTensor differences(const Tensors& tensors, std::size_t t) const {
    FrameTensor sum = FrameTensor::Zero();
    for (std::size_t h = 4 * t; h < 4 * t + 4; ++h) {
      if (tets_.topology().isBoundary(static_cast<HalfFace>(h))) continue;
      const Index there = adjacency::tetOf(tets_.topology().mate[h]);
      sum += pulls_[h] * (tensors.col(static_cast<Eigen::Index>(t)) - tensors.col(there));
    }
    return sum;
  }

  /// Adds up visit(tet) over all tets, in the same order for any number of threads.
  template <class Visit>
  double sumOver(const Visit& visit) {
    std::vector<double> parts(blockCount(tets_.size(), kTetGrain));
    parallelBlocks(stage_, tets_.size(), kTetGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     for (std::size_t t = begin; t < end; ++t) parts[block] += visit(t);
                   });
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
  }

  double energy() {
    return sumOver([&](std::size_t t) {
      return tensors_.col(static_cast<Eigen::Index>(t)).dot(differences(tensors_, t));
    });
  }

  /// An implicit step of diffusion under all conditions: minimizes inertia times squared changes
  /// plus time times squared differences, by preconditioned conjugate gradients.
  void diffuse(double time, double inertia, double tolerance, int mostSteps) {
    const auto column = [](std::size_t t) { return static_cast<Eigen::Index>(t); };
    Tensors there = tensors_;
    for (std::size_t t = 0; t < conditions_.size(); ++t) {
      const Condition& condition = conditions_[t];
      if (condition.isFree()) continue;
      const FrameTensor q = tensors_.col(column(t));
      there.col(column(t)) = condition.middle + condition.allowed(q - condition.middle);
    }
    const auto scale = [&](std::size_t t) { return inertia * masses_[t] + time * allPulls_[t]; };
    Tensors rest(9, there.cols());
    Tensors towards(9, there.cols());
    Tensors forces(9, there.cols());
    double slope = sumOver([&](std::size_t t) {
      const FrameTensor force =
          inertia * masses_[t] * (tensors_.col(column(t)) - there.col(column(t))) -
          time * differences(there, t);
      rest.col(column(t)) = conditions_[t].allowed(force);
      towards.col(column(t)) = rest.col(column(t)) / scale(t);
      return rest.col(column(t)).dot(towards.col(column(t)));
    });
    const double enough = tolerance * tolerance * slope;
    for (int step = 0; step < mostSteps && slope > enough && slope > 0; ++step) {
      const double curvature = sumOver([&](std::size_t t) {
        const FrameTensor force =
            inertia * masses_[t] * towards.col(column(t)) + time * differences(towards, t);
        forces.col(column(t)) = conditions_[t].allowed(force);
        return towards.col(column(t)).dot(forces.col(column(t)));
      });
      const double length = slope / curvature;
      const double next = sumOver([&](std::size_t t) {
        there.col(column(t)) += length * towards.col(column(t));
        rest.col(column(t)) -= length * forces.col(column(t));
        return rest.col(column(t)).squaredNorm() / scale(t);
      });
      parallelFor(stage_, conditions_.size(), kTetGrain, [&](std::size_t t) {
        towards.col(column(t)) =
            rest.col(column(t)) / scale(t) + next / slope * towards.col(column(t));
      });
      slope = next;
    }
    tensors_ = std::move(there);
  }

  /// Projects tensors to the nearest frames.
  void project() {
    parallelFor(stage_, frames_.size(), kTetGrain, [&](std::size_t t) {
      const Condition& condition = conditions_[t];
      const FrameTensor tensor = tensors_.col(static_cast<Eigen::Index>(t));
      if (condition.fixed) {
        frames_[t] = *condition.fixed;
      } else if (condition.axis) {
        const double angle =
            std::atan2(condition.sine.dot(tensor), condition.cosine.dot(tensor)) / 4;
        frames_[t] = frameAbout(*condition.axis, angle);
      } else {
        frames_[t] = nearestFrame(tensor, frames_[t]);
      }
      tensors_.col(static_cast<Eigen::Index>(t)) = tensorOf(frames_[t]);
    });
  }

  void settle(double time, int rounds) {
    double last = energy();
    for (int round = 0; round < rounds; ++round) {
      diffuse(time, 1, 2e-3, 400);
      project();
      const double now = energy();
      if (std::abs(now - last) < kAtRest * last) return;
      last = now;
    }
  }

  const FrameTets& tets_;
  Stage& stage_;
  std::vector<Condition> conditions_;
  std::vector<double> masses_;    ///< per tet
  std::vector<double> pulls_;     ///< per half-face
  std::vector<double> allPulls_;  ///< per tet: the sum of its pulls
  std::vector<Frame> frames_;
  Tensors tensors_;
};

}  // namespace

std::vector<Frame> frameField(const FrameTets& tets, Stage& stage) {
  return FieldMaker(tets, stage).run();
}

}  // namespace hexhex::shape
