// Closed surfaces with known answers, and some that are not closed.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <hexhex/fill.hpp>

namespace hexhex::test {

using Triangle = std::array<Index, 3>;

/// Of the box from 0 to a size, moved.
inline TriangleMesh boxSurface(const Vec3& size = {1, 1, 1}, const Vec3& from = {0, 0, 0}) {
  TriangleMesh mesh;
  for (Index v = 0; v < 8; ++v) {
    mesh.points.push_back({from[0] + (v & 1U) * size[0], from[1] + (v >> 1U & 1U) * size[1],
                           from[2] + (v >> 2U) * size[2]});
  }
  for (const auto& [a, b, c, d] : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

/// A square ring with a slit of some width, as thick as it is wide: a ball to topologists.
inline TriangleMesh splitRingSurface(double slit) {
  const std::vector<double> xs = {0, 1, 2, 3};
  const std::vector<double> ys = {0, 1, 1.5, 1.5 + slit, 2, 3};
  const auto isFull = [](Index i, Index j) {
    return i < 3 && j < 5 && (i != 1 || j == 0 || j == 4) && (i != 2 || j != 2);
  };
  TriangleMesh mesh;
  for (const double y : ys) {
    for (const double x : xs) mesh.points.insert(mesh.points.end(), {{x, y, 0}, {x, y, 1}});
  }
  const auto add = [&mesh](Index a, Index b, Index c, Index d) {
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
  };
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 5; ++j) {
      if (!isFull(i, j)) continue;
      const Index a = 2 * (4 * j + i);
      const Index b = a + 2;
      const Index c = b + 8;
      const Index d = a + 8;
      add(a, d, c, b);
      add(a + 1, b + 1, c + 1, d + 1);
      if (!isFull(i, j - 1)) add(a, b, b + 1, a + 1);
      if (!isFull(i + 1, j)) add(b, c, c + 1, b + 1);
      if (!isFull(i, j + 1)) add(c, d, d + 1, c + 1);
      if (!isFull(i - 1, j)) add(d, a, a + 1, d + 1);
    }
  }
  return mesh;
}

/// A grid that is closed both ways: n by m quads, each two triangles.
template <class Place>
TriangleMesh periodicSurface(Index n, Index m, const Place& place) {
  TriangleMesh mesh;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < m; ++j) {
      mesh.points.push_back(place(2 * std::numbers::pi * i / n, 2 * std::numbers::pi * j / m));
      const Index a = i * m + j;
      const Index b = (i + 1) % n * m + j;
      const Index c = (i + 1) % n * m + (j + 1) % m;
      const Index d = i * m + (j + 1) % m;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

inline TriangleMesh torusSurface() {
  return periodicSurface(32, 16, [](double u, double v) -> Vec3 {
    const double r = 1 + 0.4 * std::cos(v);
    return {r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)};
  });
}

/// An octahedron, each triangle cut into four some times, on a sphere.
inline TriangleMesh ballSurface(double radius = 1, const Vec3& centre = {0, 0, 0}, int cuts = 3) {
  TriangleMesh mesh;
  mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < cuts; ++i) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [found, isNew] = middles.try_emplace(std::minmax(a, b), mesh.points.size());
      if (isNew) {
        Vec3 p{};
        for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.points[a][k] + mesh.points[b][k];
        const double length = std::hypot(p[0], p[1], p[2]);
        for (double& x : p) x /= length;
        mesh.points.push_back(p);
      }
      return found->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b);
      const Index bc = middle(b, c);
      const Index ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (Vec3& p : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) p[k] = centre[k] + radius * p[k];
  }
  return mesh;
}

/// Of radius 1 and height 2, with both caps, of n corners.
inline TriangleMesh cylinderSurface(Index n = 32) {
  TriangleMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 2}};
  for (Index i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    mesh.points.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.points.push_back({std::cos(angle), std::sin(angle), 2});
    const Index a = 2 + 2 * i;
    const Index b = 2 + 2 * ((i + 1) % n);
    mesh.triangles.insert(mesh.triangles.end(),
                          {{a, b, b + 1}, {a, b + 1, a + 1}, {0, b, a}, {1, a + 1, b + 1}});
  }
  return mesh;
}

/// A torus whose cross-section comes back mirrored: a Klein bottle, which meets itself.
inline TriangleMesh kleinSurface() {
  constexpr Index n = 16;
  TriangleMesh mesh;
  const auto vertex = [](Index i, Index j) {
    return i < n ? i * n + j : (n - j) % n;  // of the first ring, the other way round
  };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      mesh.points.push_back({1.0 * i, std::cos(j * 0.4), std::sin(j * 0.4) + 0.01 * i});
      const Index a = vertex(i, j);
      const Index b = vertex(i + 1, j);
      const Index c = vertex(i + 1, (j + 1) % n);
      const Index d = vertex(i, (j + 1) % n);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const auto first = static_cast<Index>(a.points.size());
  both.points.insert(both.points.end(), b.points.begin(), b.points.end());
  for (const auto& [i, j, k] : b.triangles) {
    both.triangles.push_back({first + i, first + j, first + k});
  }
  return both;
}

}  // namespace hexhex::test
