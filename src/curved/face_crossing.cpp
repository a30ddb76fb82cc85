#include <curved/face_crossing.hpp>

namespace hexhex {

bool weighExactly(const SeenCorners& seen, std::array<double, 3>& weights) noexcept {
  unsigned positive = 0;
  unsigned negative = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 product = crossComponent(seen[(i + 1) % 3], seen[(i + 2) % 3], 0);
    positive += product > 0 ? 1 : 0;
    negative += product < 0 ? 1 : 0;
    weights[i] = toDouble(product);
  }
  return positive == 3 || negative == 3;
}

}  // namespace hexhex
