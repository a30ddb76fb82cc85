// A sink that puts a mesh together again from its pieces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include <gtest/gtest.h>

#include <hexhex/stream.hpp>

namespace hexhex::test {

/// Collects pieces, and checks that calls come in order and as announced.
class CollectingSink final : public MeshSink {
 public:
  HexMesh mesh;
  bool ended = false;
  std::size_t largestPiece = 0;  ///< points
  int wide = 0;                  ///< pieces of cells with 64-bit indices

  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    EXPECT_FALSE(begun_);
    begun_ = true;
    points_ = pointCount;
    cells_ = cellCount;
  }
  void points(const PointPiece& piece) override {
    EXPECT_TRUE(begun_);
    EXPECT_TRUE(mesh.cells.empty());
    EXPECT_EQ(piece.first, mesh.points.size());
    largestPiece = std::max(largestPiece, piece.points.size());
    append(mesh.points, piece.points);
    append(mesh.generatorTet, piece.generatorTet);
    append(mesh.generatorCorners, piece.generatorCorners);
  }
  void cells(std::uint64_t first, std::span<const Hex> cells) override {
    EXPECT_EQ(first, mesh.cells.size());
    append(mesh.cells, cells);
  }
  void cells(std::uint64_t first, std::span<const Hex64> cells) override {
    ++wide;
    EXPECT_EQ(first, mesh.cells.size());
    for (const Hex64& cell : cells) {
      Hex narrow{};
      std::transform(cell.begin(), cell.end(), narrow.begin(),
                     [](std::uint64_t vertex) { return static_cast<Index>(vertex); });
      mesh.cells.push_back(narrow);
    }
  }
  void end() override {
    EXPECT_FALSE(ended);
    EXPECT_EQ(mesh.points.size(), points_);
    EXPECT_EQ(mesh.cells.size(), cells_);
    ended = true;
  }

 private:
  template <class T>
  static void append(Array<T>& all, std::span<const T> piece) {
    all.insert(all.end(), piece.begin(), piece.end());
  }

  bool begun_ = false;
  std::uint64_t points_ = 0;
  std::uint64_t cells_ = 0;
};

}  // namespace hexhex::test
