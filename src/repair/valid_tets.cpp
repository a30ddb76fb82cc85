#include <cmath>

#include <repair/valid_tets.hpp>

namespace hexhex {

namespace {
constexpr std::size_t kGrain = 1024;
}

bool isCarriedOver(const PreparedMap& map, HalfFace halfFace) noexcept {
  const TetTopology& topology = map.topology;
  const HalfFace mate = topology.mate[halfFace];
  for (const int c : kFaceCorners[halfFace % 4]) {
    const auto corner = static_cast<std::size_t>(c);
    const Index v = topology.tets[tetOf(halfFace)][corner];
    const auto other = static_cast<std::size_t>(topology.localCorner(tetOf(mate), v));
    const LatticePoint& here = map.exact.corners[tetOf(halfFace)][corner];
    const LatticePoint& there = map.exact.corners[tetOf(mate)][other];
    if (map.exact.transitions.across(halfFace)(here, map.exact.unit) != there) return false;
  }
  return true;
}

std::vector<std::uint8_t> findValidTets(const PreparedMap& map, const LocalParameters& parameters,
                                        double tolerance, Stage& stage) {
  std::vector<std::uint8_t> valid(map.topology.tetCount(), 0);
  const auto unit = static_cast<double>(map.exact.unit);
  parallelFor(stage, valid.size(), kGrain, [&](std::size_t t) {
    const LatticeTet& corners = map.exact.corners[t];
    double displacement = 0;
    for (int c = 0; c < 4; ++c) {
      const Vec3 u = parameters(static_cast<Index>(t), c);
      for (std::size_t k = 0; k < 3; ++k) {
        const double now = static_cast<double>(corners[static_cast<std::size_t>(c)][k]) / unit;
        displacement = std::max(displacement, std::abs(now - u[k]));
      }
    }
    const bool positive = orientation(corners[0], corners[1], corners[2], corners[3]) > 0;
    valid[t] = positive && displacement <= tolerance ? 1 : 0;
  });
  return valid;
}

}  // namespace hexhex
