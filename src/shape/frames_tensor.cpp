#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <shape/frames_tensor.hpp>

namespace hexhex::shape {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMonomials = 15;
constexpr double kPi = std::numbers::pi;
using Quartic = Eigen::Matrix<double, kMonomials, 1>;
using Exponents = std::array<int, 3>;

/// Quartic forms of three variables, and the subspace of harmonic ones.
class QuarticSpace {
 public:
  QuarticSpace() {
    for (int a = 0; a <= 4; ++a) {
      for (int b = 0; a + b <= 4; ++b) {
        const Exponents e = {a, b, 4 - a - b};
        constexpr std::array<double, 5> kFactorials = {1, 1, 2, 6, 24};
        double ways = 24;
        for (const int exponent : e) ways /= kFactorials[static_cast<std::size_t>(exponent)];
        number(e) = static_cast<int>(exponents_.size());
        exponents_.push_back(e);
        roots_.push_back(std::sqrt(ways));
      }
    }
    findHarmonics();
    for (int axis = 0; axis < 3; ++axis) findTurns(axis);
  }

  /// The form v^4, scaled so that dot products are (v . w)^4.
  [[nodiscard]] Quartic power(const Vector3d& v) const {
    Eigen::Matrix<double, 3, 5> powers;
    powers.col(0).setOnes();
    for (int k = 1; k <= 4; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(v);
    Quartic quartic;
    for (std::size_t i = 0; i < kMonomials; ++i) {
      const Exponents& e = exponents_[i];
      quartic[static_cast<Eigen::Index>(i)] =
          roots_[i] * powers(0, e[0]) * powers(1, e[1]) * powers(2, e[2]);
    }
    return quartic;
  }
  [[nodiscard]] FrameTensor harmonic(const Quartic& quartic) const {
    return harmonics_.transpose() * quartic;
  }
  /// The derivative of tensors as frames turn about an axis of space.
  [[nodiscard]] const Eigen::Matrix<double, 9, 9>& turn(int axis) const {
    return turns_[static_cast<std::size_t>(axis)];
  }

 private:
  int& number(const Exponents& e) {
    return numbers_[5 * static_cast<std::size_t>(e[0]) + static_cast<std::size_t>(e[1])];
  }

  /// The orthogonal complement of the multiples of x^2 + y^2 + z^2.
  void findHarmonics() {
    Eigen::Matrix<double, kMonomials, 6> multiples = Eigen::Matrix<double, kMonomials, 6>::Zero();
    int column = 0;
    for (int a = 0; a <= 2; ++a) {
      for (int b = 0; a + b <= 2; ++b, ++column) {
        for (std::size_t k = 0; k < 3; ++k) {
          Exponents e = {a, b, 2 - a - b};
          e[k] += 2;
          multiples(number(e), column) += 1 / roots_[static_cast<std::size_t>(number(e))];
        }
      }
    }
    const Eigen::HouseholderQR<Eigen::Matrix<double, kMonomials, 6>> qr(multiples);
    const Eigen::Matrix<double, kMonomials, kMonomials> q = qr.householderQ();
    harmonics_ = q.rightCols<9>();
  }

  /// The derivative of v^4 as v turns: each factor v_l of a monomial becomes (axis x v)_l.
  void findTurns(int axis) {
    Eigen::Matrix<double, kMonomials, kMonomials> change;
    change.setZero();
    const auto next = static_cast<std::size_t>((axis + 1) % 3);
    const auto last = static_cast<std::size_t>((axis + 2) % 3);
    for (std::size_t i = 0; i < kMonomials; ++i) {
      const auto replace = [&](std::size_t from, std::size_t by, double sign) {
        Exponents e = exponents_[i];
        if (e[from] == 0) return;
        const double factor = sign * e[from];
        --e[from];
        ++e[by];
        const int to = number(e);
        change(static_cast<Eigen::Index>(i), to) +=
            factor * roots_[i] / roots_[static_cast<std::size_t>(to)];
      };
      replace(next, last, -1);
      replace(last, next, 1);
    }
    turns_[static_cast<std::size_t>(axis)] = harmonics_.transpose() * change * harmonics_;
  }

  std::vector<Exponents> exponents_;
  std::vector<double> roots_;  ///< square roots of multinomial coefficients
  std::array<int, 25> numbers_{};
  Eigen::Matrix<double, kMonomials, 9> harmonics_;
  std::array<Eigen::Matrix<double, 9, 9>, 3> turns_;
};

const QuarticSpace& quartics() {
  static const QuarticSpace kSpace;
  return kSpace;
}

struct Sample {
  Frame frame;
  FrameTensor tensor;
};

/// Enough frames that one of them is in the basin of attraction of the frame nearest to any tensor.
const std::vector<Sample>& samples() {
  static const std::vector<Sample> kSamples = [] {
    constexpr int kCount = 60;
    std::mt19937 random(3);
    const auto draw = [&] { return static_cast<double>(random()) * 0x1p-32; };
    std::vector<Sample> all;
    for (int i = 0; i < kCount; ++i) {
      // Uniform over all rotations (Shoemake 1992).
      const double share = draw();
      const double first = 2 * kPi * draw();
      const double second = 2 * kPi * draw();
      const Eigen::Quaterniond q(
          std::sqrt(1 - share) * std::sin(first), std::sqrt(1 - share) * std::cos(first),
          std::sqrt(share) * std::sin(second), std::sqrt(share) * std::cos(second));
      const Frame frame = q.toRotationMatrix();
      all.push_back({frame, tensorOf(frame)});
    }
    return all;
  }();
  return kSamples;
}

}  // namespace

FrameTensor tensorOf(const Frame& frame) {
  const QuarticSpace& space = quartics();
  return space.harmonic(space.power(frame.col(0)) + space.power(frame.col(1)) +
                        space.power(frame.col(2)));
}

Frame nearestFrame(const FrameTensor& tensor, const Frame& start) {
  constexpr int kMostSteps = 30;
  constexpr double kLevel = 1e-9;       // of the gradient
  constexpr double kConvexity = 0.05;   // lower bound on the convexity of regularized Hessians
  constexpr double kLargestTurn = 0.5;  // in radians
  const double size = tensor.norm();
  Frame frame = start;
  double best = tensor.dot(tensorOf(start));
  for (const Sample& sample : samples()) {
    const double likeness = tensor.dot(sample.tensor);
    if (likeness <= best + 1e-12 * size) continue;
    best = likeness;
    frame = sample.frame;
  }
  const QuarticSpace& space = quartics();
  for (int step = 0; step < kMostSteps; ++step) {
    const FrameTensor here = tensorOf(frame);
    Eigen::Matrix<double, 9, 3> changes;
    Eigen::Matrix<double, 9, 3> turned;
    for (int k = 0; k < 3; ++k) {
      changes.col(k) = space.turn(k) * here;
      turned.col(k) = space.turn(k).transpose() * tensor;
    }
    const Vector3d gradient = changes.transpose() * tensor;
    if (gradient.norm() <= kLevel * size) break;
    const Matrix3d product = turned.transpose() * changes;
    const Matrix3d hessian = 0.5 * (product + product.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix3d> spectrum(hessian, Eigen::EigenvaluesOnly);
    const double shift = std::max(0.0, spectrum.eigenvalues()[2] + kConvexity * size);
    Vector3d turn = (shift * Matrix3d::Identity() - hessian).ldlt().solve(gradient);
    const double angle = turn.norm();
    if (angle == 0) break;
    turn /= angle;
    frame = Eigen::AngleAxisd(std::min(angle, kLargestTurn), turn).toRotationMatrix() * frame;
  }
  return frame;
}

Frame frameAbout(const Vector3d& axis, double angle) {
  const Vector3d other = std::abs(axis[0]) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d u = other.cross(axis).normalized();
  Frame frame;
  frame.col(0) = axis;
  frame.col(1) = std::cos(angle) * u + std::sin(angle) * axis.cross(u);
  frame.col(2) = axis.cross(Vector3d(frame.col(1)));
  return frame;
}

TensorCircle::TensorCircle(const Vector3d& axis) {
  const auto at = [&](double angle) { return tensorOf(frameAbout(axis, angle)); };
  middle = 0.5 * (at(0) + at(kPi / 4));
  cosine = 0.5 * (at(0) - at(kPi / 4));
  sine = 0.5 * (at(kPi / 8) - at(-kPi / 8));
}

}  // namespace hexhex::shape
