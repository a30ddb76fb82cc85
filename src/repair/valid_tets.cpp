#include <algorithm>
#include <cmath>

#include <base/vector3.hpp>
#include <lattice/tet_geometry.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

constexpr std::size_t kValidTetsGrain = 4096;

/// The elements of [0, n) that pass a test, ascending.
template <class Test>
std::vector<Index> select(std::size_t n, Stage& stage, const Test& test) {
  return collectFromBlocks<Index>(
      stage, n, kValidTetsGrain,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          if (test(static_cast<Index>(i))) found.push_back(static_cast<Index>(i));
        }
      });
}

}  // namespace

double determinantOf(const TetParameters& u) noexcept {
  return tripleProduct(minus(u[1], u[0]), minus(u[2], u[0]), minus(u[3], u[0]));
}

bool isBad(const TetParameters& u) noexcept {
  // A determinant of three vectors is off by less than a few 2^-53 times the product of their
  // lengths; differences inherit the rounding of the coordinates themselves.
  constexpr double kRounding = 0x1p-48;
  double largest = 0;
  for (const Vec3& corner : u) {
    for (const double x : corner) largest = std::max(largest, std::abs(x));
  }
  const double a = length(minus(u[1], u[0]));
  const double b = length(minus(u[2], u[0]));
  const double c = length(minus(u[3], u[0]));
  const double noise = 0x1p-51 * largest * (a * b + b * c + c * a);
  return !(determinantOf(u) > kRounding * a * b * c + noise);
}

bool isThin(const TetParameters& u, double noise) noexcept {
  // The determinant is the height over a face times twice the area of the face.
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = minus(u[(i + 1) % 4], u[i]);
    const Vec3 b = minus(u[(i + 2) % 4], u[i]);
    largest = std::max(largest, length(cross(a, b)));
  }
  // Each of four corners moves by up to sqrt(3) times the noise.
  return !(determinantOf(u) > 7 * noise * largest);
}

std::vector<Index> findBadTets(std::size_t tets, const igm::LocalParameters& parameters,
                               Stage& stage) {
  return select(tets, stage, [&](Index t) { return isBad(parameters(t)); });
}

std::vector<Index> findExactlyBadTets(const igm::ExactMap& map, Stage& stage) {
  return select(map.corners.size(), stage, [&](Index t) {
    const lattice::LatticeTet& c = map.corners[t];
    return lattice::orientation(c[0], c[1], c[2], c[3]) <= 0;
  });
}

bool isCarriedOver(const igm::PreparedMap& map, adjacency::HalfFace halfFace) noexcept {
  const adjacency::SharedCorners<lattice::LatticePoint> face(
      map.topology, halfFace,
      [&](Index tet, std::size_t corner) { return map.exact.corners[tet][corner]; });
  return std::equal(face.here.begin(), face.here.end(), face.there.begin(),
                    [&](const lattice::LatticePoint& here, const lattice::LatticePoint& there) {
                      return map.exact.transitions.across(halfFace)(here, map.exact.unit) == there;
                    });
}

std::vector<std::uint8_t> findValidTets(const igm::PreparedMap& map,
                                        const igm::LocalParameters& parameters, double tolerance,
                                        Stage& stage) {
  std::vector<std::uint8_t> valid(map.topology.tetCount(), 0);
  const auto unit = static_cast<double>(map.exact.unit);
  parallelFor(stage, valid.size(), kValidTetsGrain, [&](std::size_t t) {
    const lattice::LatticeTet& corners = map.exact.corners[t];
    double displacement = 0;
    for (int c = 0; c < 4; ++c) {
      displacement =
          std::max(displacement, igm::displacementOf(parameters(static_cast<Index>(t), c),
                                                     corners[static_cast<std::size_t>(c)], unit));
    }
    const bool positive = lattice::orientation(corners[0], corners[1], corners[2], corners[3]) > 0;
    valid[t] = positive && displacement <= tolerance ? 1 : 0;
  });
  return valid;
}

}  // namespace hexhex::repairs
