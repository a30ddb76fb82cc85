// Frame fields of the tets of real models, whose maps are ignored: what becomes of each, as a
// table. Not run with the others:
//
//     build/release/tests/test_shape --gtest_also_run_disabled_tests --gtest_filter='*Table*'
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <shape/frames_map.hpp>

#include <hexhex/hexhex.hpp>

namespace hexhex::test {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::vector<std::filesystem::path> modelFiles() {
  const char* const only = std::getenv("HEXHEX_FRAMES_ONLY");
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"maps", "seamless", "shapes"}) {
    const auto path = std::filesystem::path(HEXHEX_DATA_DIR) / folder;
    if (!std::filesystem::exists(path)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (only == nullptr || entry.path().string().find(only) != std::string::npos)
        files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(FramesOfRealTets, DISABLED_Table) {
  std::map<std::vector<Tet>, std::string> seen;
  for (const auto& file : modelFiles()) {
    Context reading;
    const TetMesh tets = readTetMesh(file, {}, reading);
    std::string line = file.parent_path().filename().string() + "/" + file.filename().string();
    line += ", " + std::to_string(tets.tets.size()) + " tets: ";
    std::string& known = seen[tets.tets];
    if (!known.empty()) {
      std::printf("%ssame as above: %s\n", line.c_str(), known.c_str());
      continue;
    }
    const auto begin = Clock::now();
    std::string answer;
    std::string step = "map";
    try {
      Context context;
      Stage stage(context, "frames");
      const TetMap map = shape::mapFromFrames(tets, 40, stage);
      char text[200];
      std::snprintf(text, sizeof text, "map of %zu tets in %.1f s, ", map.tets.size(),
                    secondsSince(begin));
      answer += text;
      step = "seamless";
      const SeamlessReport report = examineSeamless(map, context);
      std::snprintf(text, sizeof text, "%s (%.1e), ",
                    report.kind == SeamlessKind::Seamless ? "seamless" : report.problem.c_str(),
                    report.displacement);
      answer += text;
      step = "quantize";
      const QuantizedMap quantized = quantize(map, {.cells = 3000}, context);
      step = "extract";
      HexMesh mesh = extract(quantized.map, {}, context);
      answer += verify(quantized.map, mesh).passed() ? "verified, " : "NOT VERIFIED, ";
      step = "improve";
      static_cast<void>(improve(mesh, quantized.map, {}, context));
      const Certificate certificate = certify(mesh, context);
      std::snprintf(
          text, sizeof text, "%zu cells, %zu not certified, minimum %.2f, %.1f s",
          mesh.cells.size(),
          certificate.scaledJacobians.size() -
              static_cast<std::size_t>(std::count_if(certificate.scaledJacobians.begin(),
                                                     certificate.scaledJacobians.end(),
                                                     [](double x) { return x > 0; })),
          *std::min_element(certificate.scaledJacobians.begin(), certificate.scaledJacobians.end()),
          secondsSince(begin));
      answer += text;
    } catch (const Error& error) {
      answer += step + ": " + error.what() + " [" + toString(error.place()) + "] " +
                std::to_string(secondsSince(begin)) + " s";
    }
    known = answer;
    std::printf("%s%s\n", line.c_str(), answer.c_str());
    std::fflush(stdout);
  }
}

}  // namespace

}  // namespace hexhex::test
