// A grid of cubes, each of six tets around a diagonal.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex {

struct KuhnGrid {
  std::vector<Vec3> points;
  std::vector<Tet> tets;  ///< positive; tets, and corners of each, in random order

  explicit KuhnGrid(Index size, unsigned seed = 1) {
    const Index n = size + 1;
    for (Index v = 0; v < n * n * n; ++v) {
      points.push_back({static_cast<double>(v % n), static_cast<double>(v / n % n),
                        static_cast<double>(v / n / n)});
    }
    std::mt19937 random(seed);
    const std::array<Index, 3> steps = {1, n, n * n};
    for (Index cube = 0; cube < size * size * size; ++cube) {
      const Index corner = cube % size + cube / size % size * n + cube / size / size * n * n;
      std::array<std::size_t, 3> axes = {0, 1, 2};
      do {
        const Index second = corner + steps[axes[0]];
        const Index third = second + steps[axes[1]];
        Tet tet = {corner, second, third, third + steps[axes[2]]};
        const bool isEven = (axes[1] + 3 - axes[0]) % 3 == 1;
        if (!isEven) std::swap(tet[1], tet[2]);
        // Turns of three corners, and of pairs, keep its orientation.
        std::rotate(tet.begin(), tet.begin() + random() % 3, tet.begin() + 3);
        if (random() % 2 == 0) std::swap(tet[0], tet[1]), std::swap(tet[2], tet[3]);
        tets.push_back(tet);
      } while (std::next_permutation(axes.begin(), axes.end()));
    }
    std::shuffle(tets.begin(), tets.end(), random);
  }
};

}  // namespace hexhex
