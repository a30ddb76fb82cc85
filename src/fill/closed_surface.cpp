#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fill/closed_surface.hpp>
#include <fill/flat_triangles.hpp>
#include <fill/intersections.hpp>

#include <hexhex/error.hpp>

#include <base/box.hpp>
#include <base/concat.hpp>
#include <base/vector3.hpp>

namespace hexhex::fill {
namespace {

using Corners = std::array<Index, 3>;

/// A point for messages: "(0.5, 1, 2.25)".
std::string asText(const Vec3& point) {
  constexpr int kDigits = 6;
  std::string text;
  for (const double x : point) {
    std::array<char, 32> room{};
    const auto end = std::to_chars(room.data(), room.data() + room.size(), x,
                                   std::chars_format::general, kDigits);
    text += concat((text.empty() ? "(" : ", "), std::string(room.data(), end.ptr));
  }
  return text + ")";
}

std::array<Vec3, 3> cornersOf(const TriangleMesh& surface, Index t) {
  const auto& [a, b, c] = surface.triangles[t];
  return {surface.points[a], surface.points[b], surface.points[c]};
}

std::string nameOf(const TriangleMesh& surface, Index t) {
  const std::array<Vec3, 3> corners = cornersOf(surface, t);
  return asText(corners[0]) + ", " + asText(corners[1]) + ", " + asText(corners[2]);
}

/// A surface that is checked to be closed and manifold, and oriented consistently.
class Checked {
 public:
  Checked(TriangleMesh surface, Stage& stage) : surface_(std::move(surface)) {
    requireTriangles();
    flatTriangles_ = removeFlatTriangles(surface_);
    requireArea();
    requireThickness();
    joinSides();
    orient();
    requireFans();
    if (const auto pair = firstIntersection(surface_, stage)) {
      throw Error(
          ErrorCode::NotMeshable,
          "The surface intersects or touches itself: the triangles with the corners " +
              nameOf(surface_, (*pair)[0]) + " and " + nameOf(surface_, (*pair)[1]) +
              " meet beside common corners and edges. Unite the bodies, or mend the surface, "
              "where it was made.");
    }
  }

  [[nodiscard]] std::size_t flatTriangles() const noexcept { return flatTriangles_; }

  /// The closed surfaces that it consists of, oriented to enclose a positive volume.
  [[nodiscard]] std::vector<TriangleMesh> shells() const {
    std::vector<TriangleMesh> all(shellCount_);
    std::vector<Index> vertices(surface_.points.size(), kNone);  // each belongs to one shell
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      TriangleMesh& shell = all[shell_[t]];
      Corners& corners = shell.triangles.emplace_back(surface_.triangles[t]);
      for (Index& v : corners) {
        if (vertices[v] == kNone) {
          vertices[v] = static_cast<Index>(shell.points.size());
          shell.points.push_back(surface_.points[v]);
        }
        v = vertices[v];
      }
    }
    return all;
  }

 private:
  void requireTriangles() const {
    if (surface_.triangles.empty()) {
      throw Error(ErrorCode::EmptyMesh, "The surface has no triangles.");
    }
    // Sides have indices, too.
    if (surface_.triangles.size() > kNone / 3) {
      throw Error(ErrorCode::TooLarge, "The surface has more triangles than can be numbered.");
    }
    for (const Vec3& point : surface_.points) {
      if (!isFinite(point)) throw Error(ErrorCode::NotFinite, "A vertex of it is not finite.");
    }
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      for (const Index v : surface_.triangles[t]) {
        if (v < surface_.points.size()) continue;
        throw Error(
            ErrorCode::IndexOutOfRange,
            concat("Triangle ", t, " of the surface names vertex ", v, ", which does not exist."),
            {PlaceKind::Vertex, v});
      }
    }
  }

  void requireArea() const {
    if (surface_.triangles.empty()) {
      throw Error(ErrorCode::EmptyMesh, "No triangle of the surface has an area.");
    }
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      if (!isFlat(cornersOf(surface_, t))) continue;
      throw Error(ErrorCode::NotMeshable,
                  "A triangle of the surface has no area, and no neighbour to be united with: its "
                  "corners " +
                      nameOf(surface_, t) + " are on a line. Remove it where it was made.");
    }
  }

  /// Refuses two triangles with the same corners.
  void requireThickness() const {
    std::vector<std::pair<Corners, Index>> sorted;
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      Corners corners = surface_.triangles[t];
      std::sort(corners.begin(), corners.end());
      sorted.emplace_back(corners, t);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first != sorted[i - 1].first) continue;
      throw Error(ErrorCode::NotMeshable,
                  "The surface has no thickness, or a triangle twice: two triangles have the "
                  "corners " +
                      nameOf(surface_, sorted[i].second) +
                      ". Remove one of them, or give the sheet a thickness.");
    }
  }

  [[nodiscard]] std::string edgeName(const std::array<Index, 2>& ends) const {
    return "the edge from " + asText(surface_.points[ends[0]]) + " to " +
           asText(surface_.points[ends[1]]);
  }

  void joinSides() {
    const std::vector<Side> sides = sortedSides(surface_);
    twins_.resize(sides.size());
    std::uint64_t open = 0;
    std::array<Index, 2> firstOpen{};
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t end = i + 1;
      while (end < sides.size() && sides[end].ends == sides[i].ends) ++end;
      if (end - i > 2) {
        throw Error(
            ErrorCode::NonManifoldEdge,
            concat(end - i, " triangles of the surface meet in ", edgeName(sides[i].ends),
                   "; it bounds a body only if there are two at each edge. Bodies that touch "
                   "have to be united, or moved apart, where they were made."),
            {PlaceKind::Edge, sides[i].ends[0], sides[i].ends[1]});
      }
      if (end - i == 2) {
        twins_[sides[i].side] = sides[i + 1].side;
        twins_[sides[i + 1].side] = sides[i].side;
      } else if (open++ == 0) {
        firstOpen = sides[i].ends;
      }
      i = end;
    }
    if (open == 0) return;
    throw Error(ErrorCode::NonManifoldEdge,
                "The surface is open: " + edgeName(firstOpen) + " has one triangle only" +
                    (open == 1 ? "" : concat(", and so have ", open - 1, " others")) +
                    ". Close it where it was made. Vertices have to be equal in all digits to be "
                    "the same.",
                {PlaceKind::Edge, firstOpen[0], firstOpen[1]});
  }

  [[nodiscard]] Index tail(Index side) const { return surface_.triangles[side / 3][side % 3]; }
  [[nodiscard]] static Index next(Index side) noexcept { return side / 3 * 3 + (side + 1) % 3; }

  /// Orients triangles consistently with the first one of their shell, and numbers the shells.
  void orient() {
    const std::size_t count = surface_.triangles.size();
    shell_.assign(count, kNone);
    std::vector<bool> turned(count, false);
    std::vector<Index> open;
    for (Index seed = 0; seed < count; ++seed) {
      if (shell_[seed] != kNone) continue;
      shell_[seed] = shellCount_;
      open.push_back(seed);
      while (!open.empty()) {
        const Index t = open.back();
        open.pop_back();
        for (Index side = 3 * t; side < 3 * t + 3; ++side) {
          const Index twin = twins_[side];
          const bool agree = tail(side) != tail(twin);  // as listed
          const bool mustTurn = agree == turned[t];
          if (shell_[twin / 3] == kNone) {
            shell_[twin / 3] = shellCount_;
            turned[twin / 3] = mustTurn;
            open.push_back(twin / 3);
          } else if (turned[twin / 3] != mustTurn) {
            throw Error(ErrorCode::Orientation,
                        "The surface has one side only, as a Moebius strip has, and no inside: "
                        "triangles cannot be oriented alike at " +
                            edgeName({tail(side), tail(next(side))}) + ".");
          }
        }
      }
      ++shellCount_;
    }
    turn(turned);
  }

  /// Flips triangles: corners 0, 1, 2 become 1, 0, 2, so side 0 stays and the other two are
  /// swapped.
  void turn(const std::vector<bool>& turned) {
    const auto renamed = [&turned](Index side) {
      const bool moves = turned[side / 3] && side % 3 != 0;
      return moves ? side / 3 * 3 + (3 - side % 3) : side;
    };
    std::vector<Index> twins(twins_.size());
    for (Index side = 0; side < twins_.size(); ++side) twins[renamed(side)] = renamed(twins_[side]);
    twins_ = std::move(twins);
    for (Index t = 0; t < turned.size(); ++t) {
      if (turned[t]) std::swap(surface_.triangles[t][0], surface_.triangles[t][1]);
    }
  }

  /// Checks that the triangles around each vertex form a single fan.
  void requireFans() const {
    std::vector<bool> seen(twins_.size(), false);
    std::vector<bool> hasFan(surface_.points.size(), false);
    for (Index begin = 0; begin < twins_.size(); ++begin) {
      if (seen[begin]) continue;
      const Index vertex = tail(begin);
      if (hasFan[vertex]) {
        throw Error(ErrorCode::NonManifoldVertex,
                    "The surface touches itself in the point " + asText(surface_.points[vertex]) +
                        ". Bodies that touch have to be united, or moved apart, where they were "
                        "made.",
                    {PlaceKind::Vertex, vertex});
      }
      hasFan[vertex] = true;
      Index side = begin;
      do {
        seen[side] = true;
        side = next(twins_[side]);
      } while (side != begin);
    }
  }

  TriangleMesh surface_;
  std::size_t flatTriangles_ = 0;
  std::vector<Index> twins_;  ///< per side
  std::vector<Index> shell_;  ///< per triangle
  Index shellCount_ = 0;
};

/// Negative if the orientation is inward.
double signedVolume(const TriangleMesh& shell) {
  double sum = 0;
  const Vec3& origin = shell.points[0];
  for (const auto& [a, b, c] : shell.triangles) {
    sum += tripleProduct(minus(shell.points[a], origin), minus(shell.points[b], origin),
                         minus(shell.points[c], origin));
  }
  return sum / 6;
}

void turnAll(TriangleMesh& shell) {
  for (Corners& t : shell.triangles) std::swap(t[0], t[1]);
}

void appendShell(TriangleMesh& all, const TriangleMesh& shell) {
  const auto first = static_cast<Index>(all.points.size());
  all.points.insert(all.points.end(), shell.points.begin(), shell.points.end());
  for (const auto& [a, b, c] : shell.triangles) {
    all.triangles.push_back({first + a, first + b, first + c});
  }
}

/// A closed surface, and the surfaces that contain it.
struct Shell {
  TriangleMesh surface;  ///< around a positive volume
  double volume = 0;
  Box box;
  std::vector<std::size_t> around;  ///< other shells
};

std::vector<Shell> nested(std::vector<TriangleMesh> surfaces) {
  std::vector<Shell> shells;
  for (TriangleMesh& surface : surfaces) {
    Shell& shell = shells.emplace_back();
    shell.volume = signedVolume(surface);
    if (shell.volume < 0) turnAll(surface);
    shell.volume = std::abs(shell.volume);
    for (const Vec3& point : surface.points) shell.box.add(point);
    shell.surface = std::move(surface);
  }
  for (Shell& shell : shells) {
    // The surfaces are disjoint, so any point of one will do.
    const Vec3& point = shell.surface.points[0];
    for (std::size_t other = 0; other < shells.size(); ++other) {
      const Box& box = shells[other].box;
      bool isInBox = &shells[other] != &shell;
      for (std::size_t k = 0; k < 3; ++k) {
        isInBox = isInBox && box.low[k] < point[k] && point[k] < box.high[k];
      }
      if (isInBox && windings(shells[other].surface, point) != 0) shell.around.push_back(other);
    }
  }
  return shells;
}

}  // namespace

int windings(const TriangleMesh& surface, const Vec3& point) {
  double sum = 0;  // of solid angles (Van Oosterom and Strackee 1983)
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = minus(surface.points[i], point);
    const Vec3 b = minus(surface.points[j], point);
    const Vec3 c = minus(surface.points[k], point);
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    const double real = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    sum += 2 * std::atan2(tripleProduct(a, b, c), real);
  }
  return static_cast<int>(std::lround(sum / (4 * std::numbers::pi)));
}

Bodies bodiesOf(TriangleMesh surface, Stage& stage) {
  const Checked checked(std::move(surface), stage);
  const std::vector<Shell> shells = nested(checked.shells());
  Bodies all;
  all.flatTriangles = checked.flatTriangles();
  std::vector<Body>& bodies = all.bodies;
  std::vector<std::size_t> bodyOf(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (shells[i].around.size() % 2 != 0) continue;
    bodyOf[i] = bodies.size();
    bodies.push_back({shells[i].surface, {}, 0, shells[i].volume});
  }
  for (const Shell& shell : shells) {
    if (shell.around.size() % 2 == 0) continue;
    // The innermost surface around a shell is the one contained in most others.
    const std::size_t inner = *std::max_element(
        shell.around.begin(), shell.around.end(),
        [&](auto a, auto b) { return shells[a].around.size() < shells[b].around.size(); });
    Body& body = bodies[bodyOf[inner]];
    TriangleMesh turned = shell.surface;
    turnAll(turned);
    appendShell(body.surface, turned);
    appendShell(body.voids, turned);
    ++body.voidCount;
    body.volume -= shell.volume;
  }
  return all;
}

}  // namespace hexhex::fill
