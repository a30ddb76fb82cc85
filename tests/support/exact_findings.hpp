// What the definition of an integer-grid map says about one, in exact integers, and as slowly and
// plainly as possible: it shares no code with src/igm.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <hexhex/types.hpp>

namespace hexhex::test {

/// How far a map is from each condition, in parameter units; 0 only if it holds exactly.
struct ExactFindings {
  double transition = 0;
  double boundary = 0;
  double singularity = 0;     ///< nothing is said of it if tets are flipped
  std::size_t flipped = 0;    ///< tets without positive volume
  std::size_t thin = 0;       ///< tets that lose it if corners move by `noise`
  std::size_t oddAngles = 0;  ///< edges around which angles are no multiple of a right one

  [[nodiscard]] double worst() const { return std::max({transition, boundary, singularity}); }
};

class ExactExamination {
 public:
  using Integer = boost::multiprecision::int512_t;
  using Point = std::array<Integer, 3>;

  /// @param map  all coordinates are multiples of 2^-100, and below 2^53
  ExactExamination(const TetMapView& map, double noise) : tets_(map.tets) {
    for (const TetParameters& u : map.parameters) {
      std::array<Point, 4>& corners = corners_.emplace_back();
      for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t k = 0; k < 3; ++k) corners[c][k] = integerOf(u[c][k]);
      }
    }
    for (std::size_t t = 0; t < tets_.size(); ++t) examineTet(t, noise);
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      for (std::size_t f = 0; f < 4; ++f) faces_[faceOf(t, f)].push_back({t, f});
    }
    for (const auto& [vertices, sides] : faces_) {
      if (sides.size() == 2) examineTransition(vertices, sides[0].first, sides[1].first);
      if (sides.size() == 1) examineBoundary(vertices, sides[0].first);
    }
    if (findings_.flipped == 0) examineEdges();
  }

  [[nodiscard]] const ExactFindings& findings() const { return findings_; }

 private:
  static constexpr int kBits = 100;
  using Face = std::array<Index, 3>;

  static Integer integerOf(double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    const auto digits = static_cast<long long>(std::ldexp(mantissa, 53));
    const int shift = exponent - 53 + kBits;
    if (digits == 0) return 0;
    if (shift >= 0) return Integer(digits) << shift;
    const Integer rounded = Integer(digits) / (Integer(1) << -shift);
    return rounded;  // what is lost is far below any tolerance
  }
  static double toDouble(const Integer& x) { return std::ldexp(x.convert_to<double>(), -kBits); }
  static Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  /// A multiple of one near x: floor(x + 1/2).
  static Integer nearest(const Integer& x) {
    const Integer unit = Integer(1) << kBits;
    const Integer moved = x + unit / 2;
    Integer rest = moved % unit;
    if (rest < 0) rest += unit;
    return moved - rest;
  }
  /// The distance of the farthest of several numbers from the multiple of one that is best for all.
  static double offInteger(const std::vector<Integer>& numbers) {
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    const Integer middle = nearest((*low + *high) / 2);
    return toDouble(std::max(Integer(abs(*low - middle)), Integer(abs(*high - middle))));
  }

  [[nodiscard]] Face faceOf(std::size_t t, std::size_t opposite) const {
    Face face{};
    std::size_t n = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      if (c != opposite) face[n++] = tets_[t][c];
    }
    std::sort(face.begin(), face.end());
    return face;
  }
  [[nodiscard]] const Point& at(std::size_t t, Index v) const {
    std::size_t c = 0;
    while (tets_[t][c] != v) ++c;
    return corners_[t][c];
  }

  void examineTet(std::size_t t, double noise) {
    const std::array<Point, 4>& u = corners_[t];
    const Point n = cross(minus(u[1], u[0]), minus(u[2], u[0]));
    const Point e = minus(u[3], u[0]);
    const Integer determinant = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
    if (determinant <= 0) ++findings_.flipped;
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Point normal = cross(minus(u[(i + 1) % 4], u[i]), minus(u[(i + 2) % 4], u[i]));
      double squared = 0;
      for (const Integer& x : normal)
        squared += std::pow(std::ldexp(x.convert_to<double>(), -2 * kBits), 2);
      largest = std::max(largest, std::sqrt(squared));
    }
    const double volume = std::ldexp(determinant.convert_to<double>(), -3 * kBits);
    if (std::abs(volume) <= 8 * noise * largest) ++findings_.thin;
  }

  void examineTransition(const Face& vertices, std::size_t here, std::size_t there) {
    double best = 1e300;
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {
      const bool odd = (axes[0] > axes[1]) != ((axes[0] > axes[2]) != (axes[1] > axes[2]));
      for (unsigned signs = 0; signs < 8; ++signs) {
        const bool mirrored = ((signs & 1U) != 0) != (((signs & 2U) != 0) != ((signs & 4U) != 0));
        if (odd != mirrored) continue;  // a reflection
        double worst = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          std::vector<Integer> rest;
          for (const Index v : vertices) {
            const Integer& x = at(here, v)[axes[k]];
            rest.push_back(at(there, v)[k] - ((signs >> k & 1U) != 0 ? Integer(-x) : x));
          }
          worst = std::max(worst, offInteger(rest));
        }
        best = std::min(best, worst);
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
    findings_.transition = std::max(findings_.transition, best);
  }

  void examineBoundary(const Face& vertices, std::size_t t) {
    double best = 1e300;
    for (std::size_t k = 0; k < 3; ++k) {
      best = std::min(
          best, offInteger({at(t, vertices[0])[k], at(t, vertices[1])[k], at(t, vertices[2])[k]}));
    }
    findings_.boundary = std::max(findings_.boundary, best);
  }

  [[nodiscard]] double angleAt(std::size_t t, Index v, Index w) const {
    std::vector<Point> others;
    for (const Index x : tets_[t]) {
      if (x != v && x != w) others.push_back(minus(at(t, x), at(t, v)));
    }
    const Point e = minus(at(t, w), at(t, v));
    const Point a = cross(e, others[0]);
    const Point b = cross(e, others[1]);
    const Point c = cross(a, b);
    double sine = 0;
    for (const Integer& x : c) sine += std::pow(std::ldexp(x.convert_to<double>(), -4 * kBits), 2);
    const Integer cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    return std::atan2(std::sqrt(sine), std::ldexp(cosine.convert_to<double>(), -4 * kBits));
  }

  void examineEdges() {
    std::map<std::pair<Index, Index>, std::vector<std::size_t>> edges;
    std::set<std::pair<Index, Index>> onBoundary;
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b) {
          if (tets_[t][a] < tets_[t][b]) edges[{tets_[t][a], tets_[t][b]}].push_back(t);
        }
      }
    }
    for (const auto& [vertices, sides] : faces_) {
      if (sides.size() != 1) continue;
      onBoundary.insert({vertices[0], vertices[1]});
      onBoundary.insert({vertices[0], vertices[2]});
      onBoundary.insert({vertices[1], vertices[2]});
    }
    std::map<Index, std::vector<std::size_t>> singularAt;
    for (const auto& [edge, around] : edges) {
      double sum = 0;
      for (const std::size_t t : around) sum += angleAt(t, edge.first, edge.second);
      const double right = sum / (std::numbers::pi / 2);
      if (std::abs(right - std::round(right)) > 0.1) ++findings_.oddAngles;
      if (std::lround(right) == (onBoundary.contains(edge) ? 2 : 4)) continue;
      singularAt[edge.first].push_back(around[0]);
      singularAt[edge.second].push_back(around[0]);
      double best = 1e300;
      for (std::size_t along = 0; along < 3; ++along) {
        double worst = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          if (k == along) continue;
          worst = std::max(
              worst, offInteger({at(around[0], edge.first)[k], at(around[0], edge.second)[k]}));
        }
        best = std::min(best, worst);
      }
      findings_.singularity = std::max(findings_.singularity, best);
    }
    for (const auto& [v, tets] : singularAt) {
      if (tets.size() == 2) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        findings_.singularity = std::max(findings_.singularity, offInteger({at(tets[0], v)[k]}));
      }
    }
  }

  std::span<const Tet> tets_;
  std::vector<std::array<Point, 4>> corners_;
  std::map<Face, std::vector<std::pair<std::size_t, std::size_t>>> faces_;
  ExactFindings findings_;
};

[[nodiscard]] inline ExactFindings exactFindings(const TetMapView& map, double noise) {
  return ExactExamination(map, noise).findings();
}

}  // namespace hexhex::test
