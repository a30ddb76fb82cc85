#include <curved/face_crossing.hpp>

namespace hexhex {

bool shareExactly(const FaceView& view, std::array<double, 3>& shares) noexcept {
  const std::array<Int128, 3> weights = {
      crossComponent(view.second - view.begin, view.third - view.begin, 0),
      crossComponent(view.begin, view.third, 0), crossComponent(view.second, view.begin, 0)};
  unsigned positive = 0;
  unsigned negative = 0;
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    positive += weights[i] > 0 ? 1 : 0;
    negative += weights[i] < 0 ? 1 : 0;
    shares[i] = toDouble(weights[i]);
    sum += shares[i];
  }
  if (positive != 3 && negative != 3) return false;
  for (double& share : shares) share /= sum;
  return true;
}

}  // namespace hexhex
