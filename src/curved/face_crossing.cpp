#include <curved/face_crossing.hpp>

namespace hexhex {

FaceShares shareExactly(const FaceView& face, const GridPoint& z, std::int64_t unit) noexcept {
  LatticePoint line{};
  for (const std::uint8_t axis : face.axes) line[axis] = z[axis] * unit;
  const auto axis = static_cast<int>(face.axes[0]);
  const auto weight = [&](const LatticePoint& a, const LatticePoint& b) {
    return crossComponent(a - line, b - line, axis);
  };
  const std::array<Int128, 3> weights = {weight(face.second, face.third),
                                         weight(face.third, face.first),
                                         weight(face.first, face.second)};
  unsigned positive = 0;
  unsigned negative = 0;
  double sum = 0;
  FaceShares shares;
  for (std::size_t i = 0; i < 3; ++i) {
    positive += weights[i] > 0 ? 1 : 0;
    negative += weights[i] < 0 ? 1 : 0;
    shares.of[i] = toDouble(weights[i]);
    sum += shares.of[i];
  }
  shares.inside = positive == 3 || negative == 3;
  if (!shares.inside) return {};
  for (double& share : shares.of) share /= sum;
  return shares;
}

}  // namespace hexhex
