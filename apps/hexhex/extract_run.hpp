// The work of `hexhex extract`: a mesh in memory, straight or curved, piece by piece, or in parts.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/extractor.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include "extract_arguments.hpp"
#include "extract_report.hpp"
#include "long_run.hpp"

namespace hexhex::command {

/// The library functions that run() calls; weights are their seconds for a mesh of seven million
/// cells.
[[nodiscard]] std::vector<WorkStep> extractionSteps(const ExtractArguments& arguments);

/// Extracts, verifies and writes the mesh of a map, and records the results. No file is written of
/// a mesh that does not agree with its map.
class Extraction {
 public:
  /// Opens the file of a mesh in pieces, to fail before long work.
  /// @param record  receives the results
  /// @throws Error FileUnsupported, FileWrite
  Extraction(const ExtractArguments& arguments, LongRun& longRun, ExtractionRecord& record);

  /// @throws Error  as the functions of the library; VerificationFailed
  void run(const TetMap& map);

 private:
  [[nodiscard]] ExtractOptions options();
  [[nodiscard]] Extractor prepare(const TetMap& map);
  void requireVerified(VerifyReport report);
  void inMemory(const TetMap& map, std::optional<Extractor> extractor);
  void curved(const TetMap& map, std::optional<Extractor> extractor);
  void inPieces(Extractor& extractor);
  void inParts(const TetMap& map);

  // Steps of a mesh in memory, straight or curved:
  void verifyMesh(Extractor& extractor, const HexMesh& mesh);
  void writeCurves(const TetMap& map, const PiecewiseLinearMesh& mesh);
  void finishMesh(const TetMap& map, auto& mesh);
  [[nodiscard]] Array<Vec3> improveOrCertify(const TetMap& map, auto& mesh);
  void noteBoundary(const auto& mesh);
  void writeMeshPage(const auto& mesh, const Array<Vec3>& before);

  const ExtractArguments& arguments_;
  LongRun& longRun_;
  Context& context_;
  ExtractionRecord& record_;
  std::unique_ptr<MeshSink> pieces_;  ///< null unless the mesh is written piece by piece
};

}  // namespace hexhex::command
