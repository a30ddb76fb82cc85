// Meshes of random maps, what makes another mesh of them, and what does not.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/hexhex.hpp>

#include <mesh/grid_meshes.hpp>

#include "extract/support.hpp"
#include "support/collecting_sink.hpp"

namespace hexhex::test {

using testing::Random;
using testing::reversed;
using testing::shuffled;

inline bool passes(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options = {}) {
  return verify(map, mesh, options).passed();
}

/// A small map of any kind.
inline TetMap drawMap(std::uint64_t seed) {
  Random random(seed);
  const SampleKindName& kind = sampleKinds()[random.below(sampleKinds().size())];
  SampleOptions options;
  options.cells = static_cast<int>(1 + random.below(3));
  options.refine = static_cast<int>(1 + random.below(2));
  options.valence = static_cast<int>(3 + random.below(5));
  options.charts = chartStyles()[random.below(chartStyles().size())].kind;
  options.jitter = std::array{0.0, 0.3, 1.0}[random.below(3)];
  options.onLattice = std::array{0.0, 0.5, 1.0}[random.below(3)];
  options.seed = random.next();
  return generateSample(kind.kind, options).map;
}

/// Every cell as one of its 24 orientations sees it.
inline HexMesh turned(HexMesh mesh, Random& random) {
  for (Hex& c : mesh.cells) {
    for (std::uint64_t i = random.below(4); i > 0; --i) {
      c = {c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]};
    }
    for (std::uint64_t i = random.below(4); i > 0; --i) {
      c = {c[3], c[2], c[6], c[7], c[0], c[1], c[5], c[4]};
    }
    for (std::uint64_t i = random.below(4); i > 0; --i) {
      c = {c[1], c[5], c[6], c[2], c[0], c[4], c[7], c[3]};
    }
  }
  return mesh;
}

inline HexMesh renumbered(const HexMesh& mesh, Random& random) {
  return turned(shuffled(mesh, random.next()), random);
}

inline std::uint64_t two(Random& random, std::uint64_t n, std::uint64_t& other) {
  const std::uint64_t one = random.below(n);
  other = (one + 1 + random.below(n - 1)) % n;
  return one;
}

inline double lengthOf(const HexMesh& mesh, Index a, Index b) {
  const Vec3& p = mesh.points[a];
  const Vec3& q = mesh.points[b];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Moves a vertex by a share of an edge.
inline void move(HexMesh& mesh, Random& random, double share) {
  const Hex& cell = mesh.cells[random.below(mesh.cells.size())];
  mesh.points[cell[0]][random.below(3)] += share * lengthOf(mesh, cell[0], cell[1]);
}

/// How often cells have a vertex.
inline std::vector<int> usesOf(const HexMesh& mesh) {
  std::vector<int> uses(mesh.points.size());
  for (const Hex& cell : mesh.cells) {
    for (const Index v : cell) ++uses[v];
  }
  return uses;
}

inline void dropVertex(HexMesh& mesh, Index vertex) {
  mesh.points.erase(mesh.points.begin() + vertex);
  for (Hex& cell : mesh.cells) {
    for (Index& v : cell) v -= v > vertex ? 1 : 0;
  }
}

/// Makes one vertex of two.
inline void merge(HexMesh& mesh, Index a, Index b) {
  for (Hex& cell : mesh.cells) std::replace(cell.begin(), cell.end(), b, a);
  dropVertex(mesh, b);
}

/// Vertices of faces that only one cell has, as far as vertex numbers tell.
inline std::vector<Index> boundaryVertices(const HexMesh& mesh) {
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
      {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  std::map<std::array<Index, 4>, int> cells;
  for (const Hex& cell : mesh.cells) {
    for (const auto& [a, b, c, d] : kFaces) {
      std::array<Index, 4> face = {cell[a], cell[b], cell[c], cell[d]};
      std::sort(face.begin(), face.end());
      ++cells[face];
    }
  }
  std::vector<Index> result;
  for (const auto& [face, count] : cells) {
    if (count == 1) result.insert(result.end(), face.begin(), face.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Something that makes another mesh of any mesh. Returns false for one that it cannot damage.
struct Mutation {
  const char* name;
  std::function<bool(HexMesh&, Random&)> apply;
};

inline const std::vector<Mutation>& mutations() {
  static const std::vector<Mutation> all = {
      {"positions of neighbours swapped",
       [](HexMesh& m, Random& r) {
         const Hex& cell = m.cells[r.below(m.cells.size())];
         std::swap(m.points[cell[0]], m.points[cell[1]]);
         return true;
       }},
      {"positions swapped",
       [](HexMesh& m, Random& r) {
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.points.size(), b);
         std::swap(m.points[a], m.points[b]);
         return true;
       }},
      {"three positions exchanged",
       [](HexMesh& m, Random& r) {
         const Hex& cell = m.cells[r.below(m.cells.size())];
         std::swap(m.points[cell[0]], m.points[cell[2]]);
         std::swap(m.points[cell[2]], m.points[cell[6]]);
         return true;
       }},
      {"neighbours merged",
       [](HexMesh& m, Random& r) {
         const Hex cell = m.cells[r.below(m.cells.size())];
         merge(m, cell[0], cell[r.below(2) == 0 ? 1 : 6]);
         return true;
       }},
      {"any vertices glued",
       [](HexMesh& m, Random& r) {
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.points.size(), b);
         merge(m, static_cast<Index>(a), static_cast<Index>(b));
         return true;
       }},
      {"boundary vertices glued",
       [](HexMesh& m, Random& r) {
         const std::vector<Index> boundary = boundaryVertices(m);
         if (boundary.size() < 2) return false;
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, boundary.size(), b);
         merge(m, boundary[a], boundary[b]);
         return true;
       }},
      {"a vertex split",
       [](HexMesh& m, Random& r) {
         const std::vector<int> uses = usesOf(m);
         Hex& cell = m.cells[r.below(m.cells.size())];
         Index& v = cell[r.below(8)];
         if (uses[v] == 1) return false;
         m.points.push_back(m.points[v]);
         v = static_cast<Index>(m.points.size() - 1);
         return true;
       }},
      {"a vertex on another one",
       [](HexMesh& m, Random& r) {
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.points.size(), b);
         m.points[a] = m.points[b];
         return true;
       }},
      {"off by 1e-3",
       [](HexMesh& m, Random& r) {
         move(m, r, 1e-3);
         return true;
       }},
      {"off by 1e-5",
       [](HexMesh& m, Random& r) {
         move(m, r, 1e-5);
         return true;
       }},
      {"off by 1e-7",
       [](HexMesh& m, Random& r) {
         move(m, r, 1e-7);
         return true;
       }},
      {"no number",
       [](HexMesh& m, Random& r) {
         m.points[r.below(m.points.size())][r.below(3)] = r.below(2) == 0 ? std::nan("") : INFINITY;
         return true;
       }},
      {"corners of a cell swapped",
       [](HexMesh& m, Random& r) {
         Hex& cell = m.cells[r.below(m.cells.size())];
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, 8, b);
         std::swap(cell[a], cell[b]);
         return true;
       }},
      {"a corner repeated",
       [](HexMesh& m, Random& r) {
         Hex& cell = m.cells[r.below(m.cells.size())];
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, 8, b);
         cell[a] = cell[b];
         return true;
       }},
      {"a cell mirrored",
       [](HexMesh& m, Random& r) {
         Hex& cell = m.cells[r.below(m.cells.size())];
         cell = reversed(cell);
         return true;
       }},
      {"all cells mirrored",
       [](HexMesh& m, Random& /*r*/) {
         for (Hex& cell : m.cells) cell = reversed(cell);
         return true;
       }},
      {"a cell dropped",
       [](HexMesh& m, Random& r) {
         m.cells.erase(m.cells.begin() + static_cast<std::ptrdiff_t>(r.below(m.cells.size())));
         return true;
       }},
      {"a cell doubled",
       [](HexMesh& m, Random& r) {
         m.cells.push_back(m.cells[r.below(m.cells.size())]);
         return true;
       }},
      {"a cell replaced by another",
       [](HexMesh& m, Random& r) {
         if (m.cells.size() == 1) return false;
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.cells.size(), b);
         m.cells[a] = m.cells[b];
         return true;
       }},
      {"corners of two cells exchanged",
       [](HexMesh& m, Random& r) {
         if (m.cells.size() == 1) return false;
         std::uint64_t b = 0;
         const std::uint64_t a = two(r, m.cells.size(), b);
         Index& v = m.cells[a][r.below(8)];
         Index& w = m.cells[b][r.below(8)];
         if (v == w) return false;
         std::swap(v, w);
         return true;
       }},
      {"another vertex in a cell",
       [](HexMesh& m, Random& r) {
         Index& v = m.cells[r.below(m.cells.size())][r.below(8)];
         v = static_cast<Index>((v + 1 + r.below(m.points.size() - 1)) % m.points.size());
         return true;
       }},
      {"a vertex too many",
       [](HexMesh& m, Random& r) {
         m.points.push_back(m.points[r.below(m.points.size())]);
         return true;
       }},
      {"all points scaled",
       [](HexMesh& m, Random& /*r*/) {
         for (Vec3& p : m.points) {
           for (double& x : p) x *= 1 + 1e-7;
         }
         return true;
       }},
      {"all points shifted",
       [](HexMesh& m, Random& r) {
         const std::size_t k = r.below(3);
         const double shift = 1e-6 * lengthOf(m, m.cells[0][0], m.cells[0][1]);
         for (Vec3& p : m.points) p[k] += shift;
         return true;
       }},
      {"all points mirrored",
       [](HexMesh& m, Random& /*r*/) {
         for (Vec3& p : m.points) p[0] = -p[0];
         return true;
       }},
      {"out of range",
       [](HexMesh& m, Random& r) {
         m.cells[r.below(m.cells.size())][r.below(8)] =
             r.below(2) == 0 ? kNone : static_cast<Index>(m.points.size());
         return true;
       }},
      {"nothing", [](HexMesh& m, Random& /*r*/) {
         m = {};
         return true;
       }}};
  return all;
}

/// Hands over a mesh in pieces of random sizes: to a sink with a map of its own, or that of an
/// extractor, with another sink behind it that must not see the end of a wrong mesh.
template <class Cell>
VerifyReport verifiedInPieces(const TetMap& map, const HexMesh& mesh, Random& random,
                              const VerifyOptions& options = {}) {
  Context context(1 + static_cast<int>(random.below(3)));
  CollectingSink behind;
  std::optional<Extractor> extractor;
  if (check(map, {options.tolerance}).valid() && random.below(2) == 0) extractor.emplace(map);
  const auto made = extractor ? std::make_unique<VerifySink>(*extractor, options, context, &behind)
                              : std::make_unique<VerifySink>(map, options, context, &behind);
  VerifySink& sink = *made;
  std::vector<Cell> cells;
  for (const Hex& cell : mesh.cells) {
    std::copy(cell.begin(), cell.end(), cells.emplace_back().begin());
  }
  sink.begin(mesh.points.size(), mesh.cells.size());
  const auto inPieces = [&](std::size_t count, const auto& take) {
    for (std::size_t first = 0; first < count;) {
      const std::size_t size = std::min<std::size_t>(count - first, 1 + random.below(100));
      take(first, size);
      first += size;
    }
  };
  inPieces(mesh.points.size(), [&](std::size_t first, std::size_t size) {
    sink.points({first, std::span(mesh.points).subspan(first, size), {}, {}});
  });
  inPieces(cells.size(), [&](std::size_t first, std::size_t size) {
    sink.cells(first, std::span<const Cell>(cells).subspan(first, size));
  });
  sink.end();
  EXPECT_EQ(behind.mesh.points.size(), mesh.points.size());
  EXPECT_EQ(behind.mesh.cells.size(), mesh.cells.size());
  EXPECT_EQ(behind.ended, sink.report().passed());
  return sink.report();
}

}  // namespace hexhex::test
