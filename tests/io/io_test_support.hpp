// What the tests of files share: a folder of their own, small meshes, a generator of random
// numbers, and a way to look at errors.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/input_file.hpp>
#include <io/core/output_file.hpp>

#include "support/random.hpp"

namespace hexhex::test {

/// An empty folder that vanishes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::random_device random;
    do {
      path_ = std::filesystem::temp_directory_path() / ("hexhex-test-" + std::to_string(random()));
    } while (!std::filesystem::create_directory(path_));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] std::size_t fileCount() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

 private:
  std::filesystem::path path_;
};

/// What the reader of a format makes of bytes.
/// @param more  what else it takes
template <auto& reader, class... More>
auto readBytes(std::string_view bytes, const std::string& name, Context& context,
               const More&... more) {
  return io::inStage(context, "read",
                     [&](Stage& stage) { return reader(io::Input(bytes, name), more..., stage); });
}

/// Has a file written by write(output, stage).
template <class Write>
void writeBy(const std::filesystem::path& file, Context& context, const Write& write) {
  io::OutputFile output(file);
  Stage stage(context, "write");
  write(output, stage);
  output.commit();
}

/// Whether this build has HDF5, and the library can be loaded.
inline bool hasHdf5() {
  try {
    io::requireHdf5("a file");
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// A text with the first place that reads `from` changed.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

inline std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream content;
  content << stream.rdbuf();
  return content.str();
}

inline void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// What a call threw.
struct Failure {
  ErrorCode code = ErrorCode::Internal;
  std::string sentence;
  Place place;
};

/// Calls f, which must throw an Error.
template <class F>
Failure failureOf(const F& f) {
  try {
    f();
  } catch (const Error& error) {
    return {error.code(), error.what(), error.place()};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

/// Two tets that share a face, with awkward numbers.
inline TetMap smallMap() {
  TetMap map;
  map.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.0 / 3}, {-0.1, 1e-300, 6.02e23}};
  map.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  map.parameters = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                    {{{0.1, -0.2, 5e-324}, {1e9, 2, -3}, {0, -0.0, 1}, {1e100, 0.7, 2}}}};
  return map;
}

/// A grid of nx by ny by nz hexahedra with coordinates of many digits.
inline HexMesh gridMesh(Index nx, Index ny, Index nz) {
  HexMesh mesh;
  const auto vertex = [&](Index x, Index y, Index z) { return x + (nx + 1) * (y + (ny + 1) * z); };
  for (Index z = 0; z <= nz; ++z) {
    for (Index y = 0; y <= ny; ++y) {
      for (Index x = 0; x <= nx; ++x) mesh.points.push_back({x / 3.0, y / 7.0, z * 1.1});
    }
  }
  for (Index z = 0; z < nz; ++z) {
    for (Index y = 0; y < ny; ++y) {
      for (Index x = 0; x < nx; ++x) {
        mesh.cells.push_back({vertex(x, y, z), vertex(x + 1, y, z), vertex(x + 1, y + 1, z),
                              vertex(x, y + 1, z), vertex(x, y, z + 1), vertex(x + 1, y, z + 1),
                              vertex(x + 1, y + 1, z + 1), vertex(x, y + 1, z + 1)});
      }
    }
  }
  return mesh;
}

/// The bytes of an array of a `.vtu` file as this library writes it; its tag tells the place.
inline std::string arrayOf(const std::string& file, const std::string& name) {
  const std::size_t tag = file.find("Name=\"" + name + "\"");
  if (tag == std::string::npos) return "no such array";
  const std::size_t offset = file.find("offset=\"", tag) + 8;
  const std::size_t data = file.find('_', file.find("<AppendedData")) + 1;
  const std::size_t place = data + std::stoull(file.substr(offset));
  std::uint64_t bytes = 0;
  std::copy_n(file.data() + place, sizeof(bytes), reinterpret_cast<char*>(&bytes));
  return file.substr(place + sizeof(bytes), bytes);
}

/// The same as numbers.
template <class T>
std::vector<T> numbersOf(const std::string& file, const std::string& name) {
  const std::string bytes = arrayOf(file, name);
  std::vector<T> numbers(bytes.size() / sizeof(T));
  std::copy_n(bytes.data(), numbers.size() * sizeof(T), reinterpret_cast<char*>(numbers.data()));
  return numbers;
}

/// Equal bit for bit (the sign of zero counts).
inline bool sameBits(const Vec3& a, const Vec3& b) {
  return std::bit_cast<std::array<std::uint64_t, 3>>(a) ==
         std::bit_cast<std::array<std::uint64_t, 3>>(b);
}

template <class Points>
void expectSameBits(const Points& a, const Points& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(sameBits(a[i], b[i])) << "at " << i;
}

/// That a mesh is one cell of order 2, each of whose nodes is where its number says: at 0, 1 or 2
/// along each axis.
inline void expectCubeOfOrder2(const LagrangeMesh& mesh) {
  ASSERT_EQ(mesh.order, 2);
  ASSERT_EQ(mesh.cellCount(), 1U);
  ASSERT_EQ(mesh.nodes.size(), 27U);
  EXPECT_EQ(mesh.points.size(), 27U);
  EXPECT_EQ(mesh.vertexCount, 8U);
  for (std::size_t i = 0; i < 27; ++i) {
    const Vec3 expected = {static_cast<double>(i % 3), static_cast<double>(i / 3 % 3),
                           static_cast<double>(i / 9)};
    EXPECT_EQ(mesh.points[mesh.nodes[i]], expected) << i;
  }
}

}  // namespace hexhex::test
