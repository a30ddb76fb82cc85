// Arcs and patches in `.ovmb` files, read back by a small reader of its own, which knows nothing of
// the library's: every element and property against the arrays in memory, and indices of simplices
// against the file of the tets themselves.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include <base/vector3.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {
namespace {

using Simplex = std::set<Index>;  ///< vertices of the tet mesh

/// What an `.ovmb` file holds. Reading throws std::out_of_range behind its end.
class OvmbContent {
 public:
  explicit OvmbContent(const std::filesystem::path& file) : bytes_(contentOf(file)) {
    EXPECT_EQ(bytes_.substr(0, 8), std::string("OVMB\n\r\n\xff"));
    EXPECT_EQ(bytes_.substr(8, 3), std::string("\1\1\3"));
    kind = number<std::uint8_t>(11);
    EXPECT_EQ(number<std::uint32_t>(12), 0U);
    for (std::size_t i = 0; i < 4; ++i) counts[i] = number<std::uint64_t>(16 + 8 * i);
    std::size_t at = 48;
    while (readChunk(at)) {
    }
    EXPECT_EQ(at, bytes_.size());
    EXPECT_EQ(points.size(), counts[0]);
    EXPECT_EQ(edges.size(), counts[1]);
    EXPECT_EQ(faces.size(), counts[2]);
  }

  unsigned kind = 0;
  std::array<std::uint64_t, 4> counts{};
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::vector<Index>> faces;  ///< half-edges
  /// By entity and name.
  std::map<std::pair<int, std::string>, std::vector<std::int32_t>> integers;
  std::map<std::pair<int, std::string>, std::vector<std::array<double, 2>>> pairs;

  [[nodiscard]] Index from(Index halfEdge) const { return edges.at(halfEdge / 2).at(halfEdge % 2); }
  [[nodiscard]] std::vector<Index> loop(std::size_t face) const {
    std::vector<Index> vertices;
    const std::vector<Index>& halfEdges = faces.at(face);
    for (std::size_t i = 0; i < halfEdges.size(); ++i) {
      EXPECT_EQ(from(halfEdges[i] ^ 1U), from(halfEdges[(i + 1) % halfEdges.size()]));
      vertices.push_back(from(halfEdges[i]));
    }
    return vertices;
  }
  [[nodiscard]] const std::vector<std::int32_t>& integersOf(int entity, const char* name) const {
    const auto found = integers.find({entity, name});
    if (found == integers.end()) throw std::out_of_range(name);
    EXPECT_EQ(found->second.size(), counts[static_cast<std::size_t>(entity)]) << name;
    return found->second;
  }

 private:
  template <class T>
  [[nodiscard]] T number(std::size_t at) const {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, bytes_.substr(at, sizeof(T)).data(), sizeof(T));
    if (at + sizeof(T) > bytes_.size()) throw std::out_of_range("end of file");
    return value;
  }
  [[nodiscard]] std::uint64_t handle(std::size_t at, std::size_t size) const {
    if (size == 1) return number<std::uint8_t>(at);
    return size == 2 ? number<std::uint16_t>(at) : number<std::uint32_t>(at);
  }

  bool readChunk(std::size_t& at) {
    const std::string type = bytes_.substr(at, 4);
    const auto padding = number<std::uint8_t>(at + 5);
    const auto length = number<std::uint64_t>(at + 8);
    EXPECT_EQ(length % 8, 0U);
    const std::size_t body = at + 16;
    const std::size_t end = body + length - padding;
    at = body + length;
    for (std::size_t i = end; i < at; ++i) EXPECT_EQ(bytes_.at(i), '\0');
    if (type == "EOF ") return false;
    if (type == "DIRP") readDirectory(body, end);
    if (type == "VERT") {
      EXPECT_EQ(number<std::uint64_t>(body), 0U);
      points.resize(number<std::uint32_t>(body + 8));
      EXPECT_EQ(number<std::uint32_t>(body + 12), 2U);
      EXPECT_EQ(end, body + 16 + points.size() * sizeof(Vec3));
      for (std::size_t i = 0; i < 3 * points.size(); ++i) {
        points[i / 3][i % 3] = number<double>(body + 16 + 8 * i);
      }
    }
    if (type == "TOPO") readTopology(body, end);
    if (type == "PROP") readProperty(body, end);
    return true;
  }

  void readDirectory(std::size_t at, std::size_t end) {
    const auto text = [&] {
      const auto size = number<std::uint32_t>(at);
      std::string result = bytes_.substr(at + 4, size);
      at += 4 + size;
      return result;
    };
    while (at < end) {
      const int entity = number<std::uint8_t>(at++);
      const std::string name = text();
      const std::string type = text();
      text();
      directory_.push_back({entity, name, type});
    }
    EXPECT_EQ(at, end);
  }

  void readTopology(std::size_t at, std::size_t end) {
    EXPECT_EQ(number<std::uint64_t>(at), 0U);
    const std::size_t count = number<std::uint32_t>(at + 8);
    const int entity = number<std::uint8_t>(at + 12);
    const std::size_t valence = number<std::uint8_t>(at + 13);
    const std::size_t valenceBytes = number<std::uint8_t>(at + 14);
    const std::size_t handleBytes = number<std::uint8_t>(at + 15);
    EXPECT_EQ(number<std::uint64_t>(at + 16), 0U);
    std::vector<std::size_t> valences(count, valence);
    at += 24;
    for (std::size_t i = 0; valence == 0 && i < count; ++i, at += valenceBytes) {
      valences[i] = handle(at, valenceBytes);
    }
    for (const std::size_t n : valences) {
      std::vector<Index> handles;
      for (std::size_t i = 0; i < n; ++i, at += handleBytes) {
        handles.push_back(static_cast<Index>(handle(at, handleBytes)));
      }
      if (entity == 1) edges.push_back({handles.at(0), handles.at(1)});
      if (entity == 2) faces.push_back(handles);
    }
    EXPECT_EQ(at, end);
  }

  void readProperty(std::size_t at, std::size_t end) {
    EXPECT_EQ(number<std::uint64_t>(at), 0U);
    const std::size_t count = number<std::uint32_t>(at + 8);
    const auto& [entity, name, type] = directory_.at(number<std::uint32_t>(at + 12));
    at += 16;
    if (type == "i32") {
      std::vector<std::int32_t>& values = integers[{entity, name}];
      for (std::size_t i = 0; i < count; ++i) values.push_back(number<std::int32_t>(at + 4 * i));
      EXPECT_EQ(end, at + 4 * count);
    }
    if (type == "2d") {
      for (std::size_t i = 0; i < count; ++i) {
        pairs[{entity, name}].push_back(
            {number<double>(at + 16 * i), number<double>(at + 16 * i + 8)});
      }
      EXPECT_EQ(end, at + 16 * count);
    }
  }

  struct Entry {
    int entity;
    std::string name;
    std::string type;
  };
  std::string bytes_;
  std::vector<Entry> directory_;
};

/// Compares files with one mesh.
class Comparison {
 public:
  Comparison(const TetMap& map, const PiecewiseLinearMesh& mesh,
             const std::filesystem::path& folder)
      : map_(map), mesh_(mesh), tets_(written(map, folder / "tets.ovmb")) {}

  /// Points, arcs, and all that is known about both.
  void arcs(const OvmbContent& file, bool withPatches) const {
    EXPECT_EQ(file.kind, 0U);
    EXPECT_EQ(file.counts[3], 0U);
    const std::size_t vertices = mesh_.mesh.points.size();
    const std::size_t shared = vertices + mesh_.arcs.points.size();
    ASSERT_EQ(file.points.size(), shared + (withPatches ? mesh_.patches.points.size() : 0));
    const auto& types = file.integersOf(0, "v_type");
    const auto& tetOf = file.integersOf(0, "hexhex::generator_tet");
    const auto& uv = file.pairs.at({0, "v_igm_uv"});
    ASSERT_EQ(uv.size(), file.points.size());
    for (std::size_t i = 0; i < file.points.size(); ++i) {
      EXPECT_EQ(file.points[i], mesh_.point(i));
      EXPECT_EQ(types[i], i < vertices ? 0 : (i < shared ? 1 : 2));
      const Simplex holder = namedBy(file, 0, i);
      ASSERT_EQ(holder, generatorOf(i));
      expectInside(file.points[i], holder, static_cast<Index>(tetOf.at(i)));
      if (i < vertices) {
        EXPECT_EQ(uv[i], (std::array<double, 2>{0, 0}));
      } else if (i < shared) {
        EXPECT_EQ(uv[i], (std::array<double, 2>{mesh_.arcs.parameters[i - vertices], 0}));
      }
    }
    const auto& arcOf = file.integersOf(1, "e_linear_hex_edge");
    std::size_t segment = 0;
    for (std::size_t e = 0; e < mesh_.arcs.count(); ++e) {
      Index from = mesh_.arcs.ends[e][0];
      for (std::uint64_t i = mesh_.arcs.pointBegin[e]; i <= mesh_.arcs.pointBegin[e + 1]; ++i) {
        const Index to = i < mesh_.arcs.pointBegin[e + 1] ? static_cast<Index>(vertices + i)
                                                          : mesh_.arcs.ends[e][1];
        EXPECT_EQ(file.edges.at(segment), (std::array<Index, 2>{from, to}));
        EXPECT_EQ(arcOf.at(segment), static_cast<std::int32_t>(e));
        ASSERT_EQ(namedBy(file, 1, segment),
                  simplex(mesh_.arcs.segmentTet[segment], mesh_.arcs.segmentCorners[segment]));
        from = to;
        ++segment;
      }
    }
    EXPECT_EQ(segment, mesh_.arcs.segmentTet.size());
    if (!withPatches) {
      EXPECT_EQ(file.edges.size(), segment);
      EXPECT_EQ(file.faces.size(), 0U);
    }
  }

  /// Polygons, their sides inside faces, and all that is known about both.
  void patches(const OvmbContent& file) const {
    const Patches& patches = mesh_.patches;
    ASSERT_EQ(file.faces.size(), patches.polygonTet.size());
    const auto& faceOf = file.integersOf(2, "f_linear_hex_face");
    const auto& tetOf = file.integersOf(2, "f_intersected_tet_index");
    const auto& uv = file.pairs.at({0, "v_igm_uv"});
    const std::size_t shared = mesh_.mesh.points.size() + mesh_.arcs.points.size();
    std::vector<std::vector<Index>> polygonsAt(file.edges.size());
    for (std::size_t f = 0; f < patches.count(); ++f) {
      for (std::uint64_t p = patches.polygonBegin[f]; p < patches.polygonBegin[f + 1]; ++p) {
        EXPECT_EQ(faceOf[p], static_cast<std::int32_t>(f));
        EXPECT_EQ(tetOf[p], static_cast<std::int32_t>(patches.polygonTet[p]));
        const std::vector<Index> loop = file.loop(p);
        const auto begin = static_cast<std::ptrdiff_t>(patches.cornerBegin[p]);
        const auto end = static_cast<std::ptrdiff_t>(patches.cornerBegin[p + 1]);
        ASSERT_EQ(loop, std::vector<Index>(patches.corners.begin() + begin,
                                           patches.corners.begin() + end));
        for (std::size_t i = 0; i < loop.size(); ++i) {
          if (loop[i] < shared) continue;
          EXPECT_EQ(uv[loop[i]], patches.parameters[patches.cornerBegin[p] + i]);
        }
        for (const Index halfEdge : file.faces[p]) {
          polygonsAt[halfEdge / 2].push_back(static_cast<Index>(p));
        }
      }
    }
    innerSides(file, polygonsAt);
  }

  /// How often simplices of each dimension were met by indices.
  mutable std::array<int, 4> met{};

 private:
  static OvmbContent written(const TetMap& map, const std::filesystem::path& file) {
    writeMap(map, file);
    return OvmbContent(file);
  }

  void innerSides(const OvmbContent& file,
                  const std::vector<std::vector<Index>>& polygonsAt) const {
    const Patches& patches = mesh_.patches;
    const auto& arcOf = file.integersOf(1, "e_linear_hex_edge");
    for (std::size_t e = mesh_.arcs.segmentTet.size(); e < file.edges.size(); ++e) {
      EXPECT_EQ(arcOf[e], -1);
      ASSERT_EQ(polygonsAt[e].size(), 2U);
      // The smallest simplex that has both ends is one of both polygons' carriers, too.
      const Simplex here = namedBy(file, 1, e);
      ASSERT_TRUE(here.size() == 2 || here.size() == 3);
      for (const Index end : file.edges[e]) {
        const Simplex generator = generatorOf(end);
        ASSERT_TRUE(std::includes(here.begin(), here.end(), generator.begin(), generator.end()));
      }
      for (const Index p : polygonsAt[e]) {
        const Simplex carrier = simplex(patches.polygonTet[p], patches.polygonCorners[p]);
        ASSERT_TRUE(std::includes(carrier.begin(), carrier.end(), here.begin(), here.end()));
      }
    }
  }

  /// A point lies in the interior of a simplex of a tet: its shares of corners are positive there,
  /// and 0 elsewhere.
  void expectInside(const Vec3& point, const Simplex& holder, Index tet) const {
    const auto volume = [](const std::array<Vec3, 4>& p) {
      return dot(minus(p[1], p[0]), hexhex::cross(minus(p[2], p[0]), minus(p[3], p[0])));
    };
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = map_.points[map_.tets[tet][i]];
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<Vec3, 4> moved = corners;
      moved[i] = point;
      const double share = volume(moved) / volume(corners);
      if (holder.contains(map_.tets[tet][i])) {
        EXPECT_GT(share, -1e-12);
      } else {
        EXPECT_NEAR(share, 0, 1e-9);
      }
    }
  }

  [[nodiscard]] Simplex simplex(Index tet, CornerSet corners) const {
    Simplex vertices;
    for (std::size_t i = 0; i < 4; ++i) {
      if ((corners >> i & 1) != 0) vertices.insert(map_.tets[tet][i]);
    }
    return vertices;
  }
  [[nodiscard]] Simplex generatorOf(std::size_t i) const {
    const auto of = [&](const auto& part) {
      return simplex(part.generatorTet[i], part.generatorCorners[i]);
    };
    if (i < mesh_.mesh.points.size()) return of(mesh_.mesh);
    i -= mesh_.mesh.points.size();
    if (i < mesh_.arcs.points.size()) return of(mesh_.arcs);
    i -= mesh_.arcs.points.size();
    return of(mesh_.patches);
  }

  /// The simplex that a file names for a vertex or edge: the same by its index in the file of tets
  /// and by a tet and its corners.
  [[nodiscard]] Simplex namedBy(const OvmbContent& file, int entity, std::size_t i) const {
    const std::string prefix = entity == 0 ? "v" : "e";
    const std::int32_t type =
        file.integersOf(entity, (prefix + "_tet_generator_type").c_str()).at(i);
    const auto index = static_cast<std::size_t>(
        file.integersOf(entity, (prefix + "_tet_generator_index").c_str()).at(i));
    const Simplex byCorners =
        simplex(static_cast<Index>(file.integersOf(entity, "hexhex::generator_tet").at(i)),
                static_cast<CornerSet>(file.integersOf(entity, "hexhex::generator_corners").at(i)));
    Simplex byIndex;
    if (type == 0) byIndex = {static_cast<Index>(index)};
    if (type == 1) byIndex = {tets_.edges.at(index)[0], tets_.edges.at(index)[1]};
    if (type == 2) {
      const std::vector<Index> loop = tets_.loop(index);
      byIndex = {loop.begin(), loop.end()};
    }
    if (type == 3) byIndex = {map_.tets.at(index).begin(), map_.tets.at(index).end()};
    EXPECT_EQ(byIndex, byCorners);
    ++met.at(static_cast<std::size_t>(type));
    return byIndex;
  }

  const TetMap& map_;
  const PiecewiseLinearMesh& mesh_;
  OvmbContent tets_;
};

struct Case {
  const char* name;
  SampleKind kind;
  SampleOptions options;
  bool mirrored = false;
  int cellsAround = 0;  ///< of a torus, if not 0
};

std::vector<Case> cases() {
  std::vector<Case> all(5);
  all[0] = {"degenerate", SampleKind::Sphere, {}};  // aligned with the grid
  all[0].options.cells = 2;
  all[1] = {"generic", SampleKind::Torus, {}};
  all[1].options.cells = 2;
  all[1].options.refine = 3;
  all[1].options.jitter = 0.6;
  all[1].options.charts = ChartStyle::Random;
  all[2] = {"half on the lattice", SampleKind::Star, {}};
  all[2].options.cells = 3;
  all[2].options.jitter = 0.7;
  all[2].options.onLattice = 0.5;
  all[2].options.charts = ChartStyle::Blocks;
  all[3] = all[1];
  all[3].name = "mirrored";
  all[3].mirrored = true;
  all[4] = {"edges that come back", SampleKind::Torus, {}};
  all[4].options.cells = 1;
  all[4].options.refine = 3;
  all[4].options.jitter = 0.3;
  all[4].cellsAround = 1;
  return all;
}

TetMap mapOf(const Case& given) {
  TetMap map = generateSample(given.kind, given.options).map;
  for (TetParameters& corners : map.parameters) {
    if (given.cellsAround == 0) break;
    for (Vec3& u : corners) u[2] *= given.cellsAround / 6.0;  // six blocks
  }
  if (!given.mirrored) return map;
  for (Vec3& point : map.points) point[0] = -point[0];
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) u[1] = -u[1];
  }
  return map;
}

PiecewiseLinearMesh extractPieces(const TetMap& map, Context& context) {
  return extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches, {}, context);
}

TEST(PiecewiseOvmb, HoldsWhatIsInMemory) {
  const TemporaryFolder folder;
  Context context;
  std::array<int, 4> met{};
  for (const Case& given : cases()) {
    SCOPED_TRACE(given.name);
    const TetMap map = mapOf(given);
    const PiecewiseLinearMesh mesh = extractPieces(map, context);
    const Comparison comparison(map, mesh, folder.path());
    writeArcs(mesh, map, folder / "arcs.ovmb", context);
    comparison.arcs(OvmbContent(folder / "arcs.ovmb"), false);
    writePatches(mesh, map, folder / "patches.ovmb", context);
    const OvmbContent patches(folder / "patches.ovmb");
    comparison.arcs(patches, true);
    comparison.patches(patches);
    for (std::size_t i = 0; i < 4; ++i) met[i] += comparison.met[i];
  }
  for (const int count : met) EXPECT_GT(count, 0);
}

TEST(PiecewiseOvmb, LacksIndicesWithoutTheMap) {
  const TemporaryFolder folder;
  Context context;
  const TetMap map = mapOf(cases()[1]);
  const PiecewiseLinearMesh mesh = extractPieces(map, context);
  writePatches(mesh, folder / "without.ovmb", context);
  writePatches(mesh, map, folder / "with.ovmb", context);
  const OvmbContent without(folder / "without.ovmb");
  const OvmbContent with(folder / "with.ovmb");
  EXPECT_FALSE(without.integers.contains({0, "v_tet_generator_index"}));
  EXPECT_FALSE(without.integers.contains({1, "e_tet_generator_index"}));
  EXPECT_EQ(without.edges, with.edges);
  EXPECT_EQ(without.faces, with.faces);
  const auto& types = without.integersOf(1, "e_tet_generator_type");
  const auto& known = with.integersOf(1, "e_tet_generator_type");
  for (std::size_t e = 0; e < types.size(); ++e) {
    EXPECT_EQ(types[e], e < mesh.arcs.segmentTet.size() ? known[e] : -1);
  }
}

TEST(PiecewiseOvmb, RefusesAnotherMap) {
  const TemporaryFolder folder;
  Context context;
  const TetMap map = mapOf(cases()[1]);
  const PiecewiseLinearMesh mesh = extractPieces(map, context);
  const auto expectRefused = [&](const TetMap& other, ErrorCode code) {
    try {
      writePatches(mesh, other, folder / "a.ovmb", context);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.ovmb"));
  };
  expectRefused(generateSample(SampleKind::Box).map, ErrorCode::InvalidArgument);
  TetMap broken = map;
  broken.tets[3][1] = 1u << 30U;
  expectRefused(broken, ErrorCode::IndexOutOfRange);
}

}  // namespace
}  // namespace hexhex::test
