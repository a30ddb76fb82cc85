#include <curved/crossings.hpp>

namespace hexhex {

FaceShares shareExactly(const OwnersFace& face, const ChartEdge& edge, std::int64_t unit) noexcept {
  LatticePoint line;
  for (std::size_t k = 0; k < 3; ++k) line[k] = edge.z[k] * unit;
  const auto axis = static_cast<std::size_t>(axisOf(edge.along));
  const auto weight = [&](std::size_t i, std::size_t j) {
    return crossComponent(face.corner(i) - line, face.corner(j) - line, axis);
  };
  const std::array<Int128, 3> weights = {weight(1, 2), weight(2, 0), weight(0, 1)};
  unsigned positive = 0;
  unsigned negative = 0;
  double sum = 0;
  FaceShares shares;
  for (std::size_t i = 0; i < 3; ++i) {
    positive += weights[i] > 0 ? 1 : 0;
    negative += weights[i] < 0 ? 1 : 0;
    shares.of[i] = signedToDouble(weights[i]);
    sum += shares.of[i];
  }
  shares.inside = positive == 3 || negative == 3;
  if (!shares.inside) return {};
  for (double& share : shares.of) share /= sum;
  return shares;
}

}  // namespace hexhex
