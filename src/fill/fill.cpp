// Fills surfaces and STEP files with tets, body by body.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fill/closed_surface.hpp>
#include <fill/mesher.hpp>
#include <fill/topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>

#include <base/concat.hpp>
#include <base/disjoint_sets.hpp>
#include <base/parallel.hpp>
#include <base/short_number.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/input_file.hpp>
#include <io/core/registry.hpp>

namespace hexhex {

namespace fill {
namespace {

constexpr std::array<WorkStep, 2> kFill = {{{"check surface", 1}, {"fill", 10}}};
constexpr std::array<WorkStep, 3> kReadPart = {
    {{"readTetMesh", 1}, {"readTriangleMesh", 0.2}, {"fillSurface", 10}}};

void requireInRange(const FillOptions& options) {
  const auto fits = [](double x) { return x >= 0 && std::isfinite(x); };
  if (fits(options.tetSize) && fits(options.cells) && options.featureAngle >= 0 &&
      options.featureAngle <= 180) {
    return;
  }
  throw Error(
      ErrorCode::InvalidArgument,
      "The size of tets and the number of cells must not be negative, and the feature angle "
      "has to be from 0 to 180 degrees.");
}

/// The number of regular tets with the volume of this many cubes of the same edge length.
double tetsFor(double cells) {
  constexpr double kPerCell = 8.5;
  constexpr double kFewest = 3000;  // enough to have some across most parts
  constexpr double kMost = 20000;   // maps of these take half a minute
  return cells == 0 ? kMost : std::clamp(kPerCell * cells, kFewest, kMost);
}

double sizeFor(double volume, const FillOptions& options) {
  constexpr double kPerVolume = 8.5;  // edge^3 of a regular tet
  if (options.tetSize > 0) return options.tetSize;
  return std::cbrt(kPerVolume * volume / tetsFor(options.cells));
}

double totalVolume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& tet : mesh.tets) sum += volumeOf(mesh, tet);
  return sum;
}

/// Removes tets in cavities, which some meshers fill as well.
void emptyVoids(TetMesh& mesh, const Body& body, Stage& stage) {
  if (body.voidCount == 0) return;
  constexpr std::size_t kGrain = 16;
  std::vector<char> isInVoid(mesh.tets.size());
  parallelFor(stage, mesh.tets.size(), kGrain, [&](std::size_t t) {
    const auto [a, b, c, d] = mesh.tets[t];
    const std::array<Vec3, 4> corners = {mesh.points[a], mesh.points[b], mesh.points[c],
                                         mesh.points[d]};
    isInVoid[t] = windings(body.voids, centreOf(corners)) != 0 ? 1 : 0;
  });
  std::size_t t = 0;
  std::erase_if(mesh.tets, [&](const Tet& /*tet*/) { return isInVoid[t++] != 0; });
}

/// Refuses tets that are not those of the body: some meshers close gaps narrower than their
/// tolerance, and lose thin walls and voids.
void requireFilled(const Body& body, const Meshed& meshed, Context& context) {
  constexpr double kMostMissing = 0.1;
  const double filled = totalVolume(meshed.tets);
  if (std::abs(filled - body.volume) > kMostMissing * body.volume) {
    throw Error(ErrorCode::NotMeshable, "The tets of the mesher " + meshed.mesher +
                                            " have a volume of " + shortNumber(filled) +
                                            ", but the surface is around one of " +
                                            shortNumber(body.volume) + ".");
  }
  const Topology wanted = topologyOf(body.surface);
  const Topology got = topologyOf(boundaryOf(meshed.tets, context));
  if (got == wanted) return;
  throw Error(ErrorCode::NotMeshable,
              concat("The mesher ", meshed.mesher,
                     " changed the shape, as by closing a gap or losing a thin wall or void: the "
                     "boundary of its tets has ",
                     got.components, " components and the Euler number ", got.euler,
                     ", the surface has ", wanted.components, " and ", wanted.euler, "."));
}

void appendTets(TetMesh& all, const TetMesh& more) {
  const auto first = static_cast<Index>(all.points.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  for (Tet tet : more.tets) {
    for (Index& v : tet) v += first;
    all.tets.push_back(tet);
  }
}

FilledPart fillBodies(const Bodies& found, const std::string& name, const FillOptions& options,
                      Stage& stage) {
  const std::vector<Body>& bodies = found.bodies;
  FilledPart part;
  FillReport& report = part.report.emplace();
  report.bodies = bodies.size();
  report.flatTriangles = found.flatTriangles;
  for (const Body& body : bodies) report.volume += body.volume;
  report.tetSize = sizeFor(report.volume, options);
  for (const Body& body : bodies) {
    Task task{name,           &body.surface,          {},
              report.tetSize, tetsFor(options.cells), options.featureAngle};
    const auto check = [&](Meshed& meshed) {
      emptyVoids(meshed.tets, body, stage);
      requireFilled(body, meshed, stage.context());
    };
    const Meshed meshed = runMesher(task, options.mesher, check, stage.context());
    appendTets(part.tets, meshed.tets);
    part.warnings.insert(part.warnings.end(), meshed.warnings.begin(), meshed.warnings.end());
    report.filledVolume += totalVolume(meshed.tets);
    report.mesher = meshed.mesher;
    report.triangles += body.surface.triangles.size();
    report.voids += body.voidCount;
  }
  report.tets = part.tets.tets.size();
  return part;
}

FilledPart fillNamed(const TriangleMesh& surface, const std::string& name,
                     const FillOptions& options, Context& context) {
  requireInRange(options);
  return inSteps(context, "fillSurface", kFill, [&] {
    FilledPart part;
    withThreads(context.threads(), [&] {
      Bodies bodies;
      {
        Stage stage(context, "check surface");
        bodies = bodiesOf(surface, stage);
      }
      Stage stage(context, "fill");
      part = fillBodies(bodies, name, options, stage);
    });
    return part;
  });
}

FilledPart fillStep(const std::filesystem::path& file, const FillOptions& options,
                    Context& context) {
  requireInRange(options);
  if (options.mesher == Mesher::TetWild || options.mesher == Mesher::TetGen) {
    throw Error(
        ErrorCode::InvalidArgument,
        file.string() + ": only Netgen and Gmsh read STEP files (--mesher netgen or gmsh).");
  }
  return inSteps(context, "fillSurface", kFill, [&] {
    Stage stage(context, "fill");
    const Task task{file.string(),       nullptr, file, options.tetSize, tetsFor(options.cells),
                    options.featureAngle};
    Meshed meshed = runMesher(
        task, options.mesher, [](Meshed& /*any*/) {}, context);
    FilledPart part{std::move(meshed.tets), FillReport{}, std::move(meshed.warnings)};
    part.report->mesher = meshed.mesher;
    part.report->tetSize = options.tetSize;
    part.report->tets = part.tets.tets.size();
    part.report->filledVolume = totalVolume(part.tets);
    return part;
  });
}

/// Warns of bodies with vertices in the same places, which fall apart, though they look like one.
void warnOfTouching(FilledPart& part) {
  const TetMesh& mesh = part.tets;
  DisjointSets bodies(mesh.points.size());
  for (const Tet& tet : mesh.tets) {
    for (std::size_t i = 1; i < tet.size(); ++i) bodies.unite(tet[0], tet[i]);
  }
  std::vector<Index> roots;
  for (const Tet& tet : mesh.tets) roots.push_back(bodies.find(tet[0]));
  sortUnique(roots);
  if (roots.size() < 2) return;
  std::vector<std::pair<Vec3, Index>> vertices;
  for (const Tet& tet : mesh.tets) {
    for (const Index v : tet) vertices.emplace_back(mesh.points[v], bodies.find(v));
  }
  std::sort(vertices.begin(), vertices.end());
  const auto touch = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second != b.second;
  };
  const auto found = std::adjacent_find(vertices.begin(), vertices.end(), touch);
  if (found == vertices.end()) return;
  const Vec3& place = found->first;
  part.warnings.push_back(
      concat("The tets are in ", roots.size(), " components, of which some touch, as at (",
             shortNumber(place[0]), ", ", shortNumber(place[1]), ", ", shortNumber(place[2]),
             "), but share no vertices there: they are meshed as separate bodies. Merge equal "
             "vertices to connect them."));
}

FilledPart read(const std::filesystem::path& file, const FillOptions& options, Context& context) {
  const std::string extension = io::contentExtension(file);
  if (extension == ".step" || extension == ".stp") return fillStep(file, options, context);
  if (!io::holdsSurface(file, context)) {
    if (options.mesher != Mesher::Auto || options.tetSize != 0) {
      throw Error(ErrorCode::InvalidArgument,
                  file.string() +
                      ": such files hold no surface, so no mesher and no --tet-size can be "
                      "chosen.");
    }
    FilledPart part{readTetMesh(file, {}, context), {}, {}};
    warnOfTouching(part);
    return part;
  }
  const TriangleMesh surface = readTriangleMesh(file, context);
  try {
    return fillNamed(surface, file.string(), options, context);
  } catch (const Error& error) {
    const std::string sentence = error.what();
    if (error.code() == ErrorCode::Cancelled || sentence.starts_with(file.string())) throw;
    throw Error(error.code(), file.string() + ": " + sentence, error.place());
  }
}

}  // namespace
}  // namespace fill

FilledPart fillSurface(const TriangleMesh& surface, const FillOptions& options, Context& context) {
  return fill::fillNamed(surface, "The surface", options, context);
}

TriangleMesh readSurfaceOf(const std::filesystem::path& file, Context& context) {
  if (io::holdsSurface(file, context)) return readTriangleMesh(file, context);
  return boundaryOf(readTetMesh(file, {}, context), context);
}

FilledPart readPart(const std::filesystem::path& file, const FillOptions& options,
                    Context& context) {
  return inSteps(context, "readPart", fill::kReadPart,
                 [&] { return fill::read(file, options, context); });
}

}  // namespace hexhex
