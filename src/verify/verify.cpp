// A mesh in canonical order is compared with the map itself (proof.hpp); any other mesh is compared
// with one in canonical order that was proven right (match.hpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <adjacency/corner_range.hpp>
#include <verify/comparisons.hpp>
#include <verify/match.hpp>
#include <verify/proof.hpp>

#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/verify.hpp>

#include <base/parallel.hpp>
#include <extract/prepared_extractor.hpp>

namespace hexhex::verification {

/// A scaled map, and what it implies.
struct Reference {
  igm::PreparedMap map;
  Expectation expected;
};

namespace {

constexpr std::array<WorkStep, 1> kCompareSteps = {{{"verification", 2.5}}};

/// "FlippedTet at tet 7, and 2 more kinds of defects"
std::string describe(const std::vector<Defect>& defects) {
  std::string text = "no: " + std::string(name(defects.front().code));
  const auto& worst = defects.front().worst;
  const std::string place = worst.empty() ? "" : toString(worst.front().place);
  if (!place.empty()) text += " at " + place;
  const std::size_t more = defects.size() - 1;
  if (more > 0) text += ", and " + std::to_string(more) + " more kinds of defects";
  return text;
}

void checkOptions(const VerifyOptions& options) {
  if (options.digits >= 0 && options.digits <= 17) return;
  throw Error(ErrorCode::InvalidArgument, "The number of digits is " +
                                              std::to_string(options.digits) +
                                              ". Choose 1 to 17, or 0 to have it found out.");
}

/// Adds "indices_in_range"; returns whether it passed.
/// @param bad  the first cell with a corner that is no vertex, or the number of cells if there is
///             none
bool addIndicesInRange(std::size_t bad, std::size_t cells, Comparisons& comparisons) {
  const bool inRange = bad == cells;
  comparisons.add("indices_in_range", "yes", inRange ? "yes" : "no (first: " + cellName(bad) + ")",
                  inRange);
  return inRange;
}

/// Maximum distance of a vertex from its place: digits beyond those that coordinates carry are
/// unknown.
double toleranceOf(const HexMesh& mesh, const Array<Vec3>& right, int digits) {
  if (digits == 0) {
    const auto isFloat = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
    const auto areFloats = [&](const Vec3& p) {
      return isFloat(p[0]) && isFloat(p[1]) && isFloat(p[2]);
    };
    digits = std::all_of(mesh.points.begin(), mesh.points.end(), areFloats) ? 7 : 17;
  }
  double largest = 0;
  for (const Vec3& p : right) {
    for (const double x : p) largest = std::max(largest, std::abs(x));
  }
  // Positions are off by a few roundings; below 2^-1022, numbers lose digits.
  return largest * std::max(0x1p-46, 0.5 * std::pow(10.0, 1 - digits)) + 0x1p-1060;
}

void compareMeshes(const HexMesh& right, const HexMesh& mesh, int digits, Stage& stage,
                   Comparisons& comparisons) {
  const Mismatch mismatch =
      matchMeshes(right, mesh, toleranceOf(mesh, right.points, digits), stage);
  const auto addVertices = [&](const char* name, const Odd& odd) {
    comparisons.addNone(name, odd.count, vertexName(odd.first));
  };
  const auto addCells = [&](const char* name, const Odd& odd, const char* which = "") {
    comparisons.addNone(name, odd.count, which + cellName(odd.first));
  };
  addVertices("vertices_off_lattice", mismatch.strangeVertices);
  addVertices("glued_vertices", mismatch.gluedVertices);
  addVertices("split_vertices", mismatch.splitVertices);
  addVertices("unused_vertices", mismatch.unusedVertices);
  addCells("wrong_cells", mismatch.strangeCells);
  addCells("missing_cells", mismatch.missingCells, "in canonical order, ");
}

/// Adds "map_valid"; returns nothing if it did not pass.
std::optional<Reference> referenceOf(const TetMapView& map, const VerifyOptions& options,
                                     Context& context, Comparisons& comparisons) {
  igm::DefectCollector defects;
  igm::PreparedMap prepared = igm::prepareMap(map, options.tolerance, options.scale, context,
                                              defects, igm::ChartChoice::Unfolded);
  const bool valid = defects.empty();
  comparisons.add("map_valid", "yes", valid ? "yes" : describe(defects.defects()), valid);
  if (!valid) return std::nullopt;
  Stage stage(context, "verification");
  igm::scaleMap(prepared.exact, options.scale, stage);
  Expectation expected = expectationOf(prepared, stage);
  return Reference{std::move(prepared), std::move(expected)};
}

/// Adds "cells" and "vertices"; returns whether everything passed so far.
bool compareCounts(const Expectation& expected, std::uint64_t cells, std::uint64_t vertices,
                   Comparisons& comparisons) {
  comparisons.addEqual<std::uint64_t>("cells", expected.cells, cells);
  comparisons.addEqual<std::uint64_t>("vertices", expectedElements(expected).vertices, vertices);
  return comparisons.passed();
}

void addWrongExtraction(Comparisons& comparisons) {
  comparisons.add("extraction", "right", "wrong: please report this with the map", false);
}

/// A map that is ready to be compared with meshes.
class Verification {
 public:
  /// @param map  scaled
  Verification(igm::PreparedMap& map, const Expectation& expected, const VerifyOptions& options,
               Context& context, Stage& stage)
      : map_(map), options_(options), context_(context), stage_(stage), expected_(expected) {}

  void compare(const HexMesh& mesh, Comparisons& comparisons) {
    // The proof also checks all corners, so there is no need to check them again if it passes.
    if (isProven(map_, expected_, mesh, stage_)) {
      addIndicesInRange(mesh.cells.size(), mesh.cells.size(), comparisons);
      compareCounts(expected_, mesh.cells.size(), mesh.points.size(), comparisons);
      addNothingWrong(comparisons);
    } else {
      const std::size_t bad = adjacency::firstCellOutOfRange(mesh, stage_);
      if (!addIndicesInRange(bad, mesh.cells.size(), comparisons)) return;
      compareCells(mesh, comparisons);
    }
    if (options_.countElements) compareSums(expected_, mesh, stage_, comparisons);
  }

 private:
  void compareCells(const HexMesh& mesh, Comparisons& comparisons) {
    compareCounts(expected_, mesh.cells.size(), mesh.points.size(), comparisons);
    // If the mesh has a completely different size, naming a vertex or cell is pointless.
    if (mesh.cells.size() / 2 > expected_.cells || expected_.cells / 2 > mesh.cells.size()) return;
    compareWithRightOne(mesh, comparisons);
  }

  static void addNothingWrong(Comparisons& comparisons) {
    for (const char* name : {"vertices_off_lattice", "glued_vertices", "split_vertices",
                             "unused_vertices", "wrong_cells", "missing_cells"}) {
      comparisons.addNone(name, 0, "");
    }
  }

  void compareWithRightOne(const HexMesh& mesh, Comparisons& comparisons) {
    ExtractOptions options;
    options.scale = options_.scale;
    options.tolerance = options_.tolerance;
    ExtractStatistics statistics;
    const HexMesh right =
        extraction::runEngine(map_, expected_.cells, options, context_, statistics);
    if (!isProven(map_, expected_, right, stage_)) {
      addWrongExtraction(comparisons);
    }
    compareMeshes(right, mesh, options_.digits, stage_, comparisons);
  }

  igm::PreparedMap& map_;
  const VerifyOptions& options_;
  Context& context_;
  Stage& stage_;
  const Expectation& expected_;
};

}  // namespace

}  // namespace hexhex::verification

namespace hexhex {

VerifyReport verify(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options,
                    Context& context) {
  constexpr std::array<WorkStep, 3> kSteps = {
      {{"prepare", 0.1}, {"verification", 0.01}, {"verification", 2.5}}};
  verification::checkOptions(options);
  WorkSteps steps(context, "verify", kSteps);
  verification::Comparisons comparisons;
  withThreads(context.threads(), [&] {
    std::optional<verification::Reference> reference =
        verification::referenceOf(map, options, context, comparisons);
    if (!reference) return;
    Stage stage(context, "verification");
    verification::Verification(reference->map, reference->expected, options, context, stage)
        .compare(mesh, comparisons);
  });
  steps.finish();
  return comparisons.take();
}

VerifyReport Extractor::verify(const HexMesh& mesh, const VerifyOptions& options,
                               Context& context) {
  verification::checkOptions(options);
  verification::Comparisons comparisons;
  ExtractOptions scaling;
  scaling.scale = options.scale;
  prepared_->run({"Extractor::verify", verification::kCompareSteps}, scaling,
                 {1, igm::kMaxCountedCells}, context, nullptr,
                 [&](std::uint64_t /*cells*/, ExtractStatistics& /*filled*/) {
                   comparisons.add("map_valid", "yes", "yes", true);
                   Stage stage(context, "verification");
                   igm::PreparedMap& map = prepared_->map();
                   const Expectation expected = verification::expectationOf(map, stage);
                   verification::Verification(map, expected, options, context, stage)
                       .compare(mesh, comparisons);
                 });
  return comparisons.take();
}

VerifyReport verify(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options) {
  Context context;
  return verify(map, mesh, options, context);
}

class VerifySink::Checker {
 public:
  Checker(const TetMapView& map, const VerifyOptions& options, Context& context)
      : quiet_(context.threads()) {
    constexpr std::array<WorkStep, 2> kSteps = {{{"prepare", 1}, {"verification", 0.1}}};
    WorkSteps steps(context, "VerifySink", kSteps);
    withThreads(context.threads(), [&] {
      reference_ = verification::referenceOf(map, options, context, comparisons_);
      if (!reference_) return;
      Stage stage(context, "verification");
      begin(reference_->map, reference_->expected, stage);
    });
    steps.finish();
  }

  Checker(Extractor::Prepared& prepared, const VerifyOptions& options, Context& context)
      : quiet_(context.threads()) {
    ExtractOptions scaling;
    scaling.scale = options.scale;
    prepared.run({"VerifySink", verification::kCompareSteps}, scaling, {1, igm::kMaxCountedCells},
                 context, nullptr, [&](std::uint64_t /*cells*/, ExtractStatistics& /*filled*/) {
                   comparisons_.add("map_valid", "yes", "yes", true);
                   Stage stage(context, "verification");
                   begin(prepared.map(), verification::expectationOf(prepared.map(), stage), stage);
                 });
  }

  void points(const PointPiece& piece) {
    if (!proof_) return;
    compare(piece.first, piece.points, verification::expectedElements(expected_).vertices, points_);
  }
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    if (proof_) compare(first, cells, expected_.cells, cells_);
  }

  void end() {
    if (!proof_ || !verification::compareCounts(expected_, cells_, points_, comparisons_)) return;
    if (proof_->hints().count() > 0) verification::addWrongExtraction(comparisons_);
    const verification::Faults& positions = proof_->positions();
    const verification::Faults& cells = proof_->cells();
    comparisons_.addNone("vertices_off_lattice", positions.count(),
                         verification::vertexName(positions.first()));
    comparisons_.addNone("wrong_cells", cells.count(), verification::cellName(cells.first()));
  }

  [[nodiscard]] const VerifyReport& report() const noexcept { return comparisons_.report(); }

 private:
  void begin(const igm::PreparedMap& map, const Expectation& expected, Stage& stage) {
    expected_ = expected;
    counts_ = sweep::countElements(map, expected.cells, nullptr, stage);
    proof_.emplace(map, expected, counts_);
  }

  /// @param come  how many came before, in order
  template <class T>
  void compare(std::uint64_t first, std::span<const T> items, std::uint64_t expected,
               std::uint64_t& come) {
    if (first == come) come += items.size();
    if (come > expected || first + items.size() > come || proof_->hints().count() > 0) return;
    withThreads(quiet_.threads(), [&] {
      Stage stage(quiet_, "verification");
      proof_->compare(first, items, stage);
    });
  }

  Context quiet_;  ///< pieces arrive while somebody else reports progress
  verification::Comparisons comparisons_;
  std::optional<verification::Reference> reference_;  ///< unless an extractor has one
  Expectation expected_;
  sweep::ElementCounts counts_;
  std::optional<verification::Proof> proof_;  ///< empty if the map is not valid
  std::uint64_t points_ = 0;
  std::uint64_t cells_ = 0;
};

VerifySink::VerifySink(const TetMapView& map, const VerifyOptions& options, Context& context,
                       MeshSink* next)
    : checker_(std::make_unique<Checker>(map, options, context)), next_(next) {}
VerifySink::VerifySink(Extractor& extractor, const VerifyOptions& options, Context& context,
                       MeshSink* next)
    : checker_(std::make_unique<Checker>(*extractor.prepared_, options, context)), next_(next) {}
VerifySink::~VerifySink() = default;

void VerifySink::begin(std::uint64_t pointCount, std::uint64_t cellCount) {
  if (next_ != nullptr) next_->begin(pointCount, cellCount);
}
void VerifySink::points(const PointPiece& piece) {
  checker_->points(piece);
  if (next_ != nullptr) next_->points(piece);
}
void VerifySink::cells(std::uint64_t first, std::span<const Hex> cells) {
  checker_->cells(first, cells);
  if (next_ != nullptr) next_->cells(first, cells);
}
void VerifySink::cells(std::uint64_t first, std::span<const Hex64> cells) {
  checker_->cells(first, cells);
  if (next_ != nullptr) next_->cells(first, cells);
}
void VerifySink::end() {
  checker_->end();
  if (next_ != nullptr && report().passed()) next_->end();
}
const VerifyReport& VerifySink::report() const noexcept { return checker_->report(); }

}  // namespace hexhex
