// What the tests of `.ovm` and `.ovmb` share: files built byte by byte from the description of the
// format, random maps and meshes, comparison bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/samples.hpp>
#include <hexhex/types.hpp>

#include "io_test_support.hpp"

namespace hexhex::test {

/// Little-endian bytes, independent of the library's.
class Bytes {
 public:
  template <class T>
  Bytes& integer(T value) {
    const auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      text_ += static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
    }
    return *this;
  }
  Bytes& u8(std::uint64_t v) { return integer(static_cast<std::uint8_t>(v)); }
  Bytes& u16(std::uint64_t v) { return integer(static_cast<std::uint16_t>(v)); }
  Bytes& u32(std::uint64_t v) { return integer(static_cast<std::uint32_t>(v)); }
  Bytes& u64(std::uint64_t v) { return integer(v); }
  Bytes& f32(float v) { return integer(std::bit_cast<std::uint32_t>(v)); }
  Bytes& f64(double v) { return integer(std::bit_cast<std::uint64_t>(v)); }
  Bytes& sized(std::uint64_t v, int bytes) {
    for (int i = 0; i < bytes; ++i) text_ += static_cast<char>(v >> (8 * i));
    return *this;
  }
  Bytes& text(std::string_view t) {
    text_ += t;
    return *this;
  }
  Bytes& counted(std::string_view t) { return u32(t.size()).text(t); }
  Bytes& span(std::uint64_t first, std::uint64_t count) { return u64(first).u32(count); }
  /// A chunk with its header and padding.
  Bytes& chunk(std::string_view type, const Bytes& payload, std::uint64_t flags = 1,
               std::uint64_t version = 0, std::uint64_t compression = 0) {
    const std::size_t padding = (8 - payload.text_.size() % 8) % 8;
    text(type).u8(version).u8(padding).u8(compression).u8(flags);
    u64(payload.text_.size() + padding).text(payload.text_);
    return text(std::string(padding, '\0'));
  }
  [[nodiscard]] const std::string& str() const noexcept { return text_; }

 private:
  std::string text_;
};

inline Bytes ovmbHeader(std::uint64_t kind, const std::array<std::uint64_t, 4>& counts) {
  Bytes bytes;
  bytes.text("OVMB\n\r\n\xff").u8(1).u8(1).u8(3).u8(kind).u32(0);
  for (const std::uint64_t count : counts) bytes.u64(count);
  return bytes;
}

inline void expectSameMap(const TetMap& a, const TetMap& b) {
  expectSameBits(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t t = 0; t < a.parameters.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_TRUE(sameBits(a.parameters[t][i], b.parameters[t][i])) << "tet " << t;
    }
  }
  EXPECT_EQ(a.rotations, b.rotations);
  const auto sorted = [](const std::vector<EdgeValence>& list) {
    std::vector<std::array<std::int64_t, 3>> keys;
    for (const EdgeValence& edge : list) {
      keys.push_back({std::min(edge.vertex0, edge.vertex1), std::max(edge.vertex0, edge.vertex1),
                      edge.offset});
    }
    std::sort(keys.begin(), keys.end());
    return keys;
  };
  EXPECT_EQ(sorted(a.edgeValences), sorted(b.edgeValences));
}

/// Features in an order of their own: elements by ascending vertices, lists sorted.
template <class Feature>
std::vector<std::vector<std::int64_t>> sortedFeatures(const std::vector<Feature>& features) {
  std::vector<std::vector<std::int64_t>> keys;
  for (const Feature& feature : features) {
    std::vector<std::int64_t> key(feature.vertices.begin(), feature.vertices.end());
    std::sort(key.begin(), key.end());
    key.push_back(feature.tag);
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

template <class Features_>
void expectSameFeatures(const Features_& a, const Features_& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(sortedFeatures(a.edges), sortedFeatures(b.edges));
  if constexpr (std::is_same_v<Features_, Features>) {
    EXPECT_EQ(sortedFeatures(a.faces), sortedFeatures(b.faces));
  } else {
    EXPECT_EQ(sortedFeatures(a.quads), sortedFeatures(b.quads));
  }
}

inline void expectSameMesh(const HexMesh& a, const HexMesh& b) {
  expectSameBits(a.points, b.points);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.generatorTet, b.generatorTet);
  EXPECT_EQ(a.generatorCorners, b.generatorCorners);
  expectSameFeatures(a.features, b.features);
}

/// Tags some vertices, edges and faces of the cells.
inline void tagSome(TetMap& map, Random& random) {
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::array<Index, 3>> faces;
  for (const Tet& tet : map.tets) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<Index, 3> face{};
      for (std::size_t k = 0, n = 0; k < 4; ++k) {
        if (k != i) face[n++] = tet[k];
        if (k > i) edges.push_back({std::min(tet[i], tet[k]), std::max(tet[i], tet[k])});
      }
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  }
  const auto unique = [](auto& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  unique(edges);
  unique(faces);
  const auto tag = [&random] { return static_cast<std::int32_t>(random.below(7)) - 3; };
  for (Index v = 0; v < map.points.size(); ++v) {
    const std::int32_t value = tag();
    if (value > 0) map.features.vertices.push_back({v, value});
  }
  for (const auto& edge : edges) {
    const std::int32_t value = tag();
    if (value > 0) map.features.edges.push_back({{edge[1], edge[0]}, value});
    if (value < 0) map.edgeValences.push_back({edge[0], edge[1], value});
  }
  for (const auto& face : faces) {
    const std::int32_t value = tag();
    if (value != 0) map.features.faces.push_back({{face[2], face[0], face[1]}, value});
  }
}

/// Random rotations across all half-faces: any value is carried, right or wrong.
inline void rotateSome(TetMap& map, Random& random) {
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    std::array<std::int8_t, 4> rotations{};
    for (std::int8_t& r : rotations) r = static_cast<std::int8_t>(random.below(25)) - 1;
    map.rotations.push_back(rotations);
  }
}

}  // namespace hexhex::test
