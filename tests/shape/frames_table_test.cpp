// Frame fields of the tets of real models, whose maps are ignored: what becomes of each, as a
// table. Not run with the others:
//
//     build/release/tests/test_shape --gtest_also_run_disabled_tests --gtest_filter='*Table*'
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <shape/frames_map.hpp>

#include <hexhex/hexhex.hpp>

namespace hexhex::test {

namespace {

std::vector<std::filesystem::path> modelFiles() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"maps", "seamless", "shapes"}) {
    const auto path = std::filesystem::path(HEXHEX_DATA_DIR) / folder;
    if (!std::filesystem::exists(path)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(path))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

struct Counts {
  int models = 0;
  int maps = 0;
  int seamless = 0;
  int certified = 0;
};

/// What becomes of a model, in words.
std::string resultOf(const TetMesh& tets, Counts& counts) {
  std::string step = "map";
  try {
    Context context;
    Stage stage(context, "frames");
    const TetMap map = shape::mapFromFrames(tets, 40, stage);
    ++counts.maps;
    step = "seamless map";
    const SeamlessReport report = examineSeamless(map, context);
    if (report.kind != SeamlessKind::Seamless) return "not seamless: " + report.problem;
    ++counts.seamless;
    step = "quantization";
    const QuantizedMap quantized = quantize(map, {.cells = 3000}, context);
    step = "extraction";
    HexMesh mesh = extract(quantized.map, {}, context);
    if (!verify(quantized.map, mesh).passed()) return "not verified";
    step = "improvement";
    static_cast<void>(improve(mesh, quantized.map, {}, context));
    const Certificate certificate = certify(mesh, context);
    counts.certified += certificate.allPositive() ? 1 : 0;
    std::array<char, 80> text{};
    std::snprintf(
        text.data(), text.size(), "%zu cells, %scertified, minimum %.2f", mesh.cells.size(),
        certificate.allPositive() ? "" : "not ",
        *std::min_element(certificate.scaledJacobians.begin(), certificate.scaledJacobians.end()));
    return text.data();
  } catch (const Error& error) {
    return step + ": " + error.what() + " [" + toString(error.place()) + "]";
  }
}

TEST(FramesOfRealTets, DISABLED_Table) {
  std::map<std::vector<Tet>, std::string> known;
  Counts counts;
  for (const auto& file : modelFiles()) {
    Context context;
    const TetMesh tets = readTetMesh(file, {}, context);
    const std::string name = (file.parent_path().filename() / file.filename()).string();
    if (known.contains(tets.tets)) {
      std::printf("%s: as %s\n", name.c_str(), known[tets.tets].c_str());
      continue;
    }
    known[tets.tets] = name;
    ++counts.models;
    Context timed;
    std::string result;
    {
      Stage stage(timed, "all");
      result = resultOf(tets, counts);
    }
    std::printf("%s, %zu tets, %.1f s: %s\n", name.c_str(), tets.tets.size(),
                timed.stageTimes().front().seconds, result.c_str());
    std::fflush(stdout);
  }
  std::printf("%d different models: %d maps, %d seamless, %d meshes certified\n", counts.models,
              counts.maps, counts.seamless, counts.certified);
}

}  // namespace

}  // namespace hexhex::test
