// Improves an extracted mesh for use in a solver: first makes all cells positive, then improves the
// worst cells, then all. Boundary vertices stay on the surface of the object.
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/export.h>
#include <hexhex/fill.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Whether to add a layer of cells under the boundary, in which each cell has one boundary face. A
/// cell with two boundary faces cannot become good where the boundary is nearly smooth between
/// them, as at label borders on a smooth surface, wherever its vertices move.
enum class PillowMode : std::uint8_t {
  Never,
  Auto,   ///< if fewer cells are not positive, the minimum rises by 0.02, or it is better overall
  Always  ///< report an error if a layer is impossible
};

struct ImproveOptions {
  /// Improve cells with a scaled Jacobian below this value until none is left or no vertex move
  /// helps. Where none is left, the worst straight cells are raised further, unless there are no
  /// passes. 0 to 1; 0 only makes cells positive.
  double target = 0.3;
  /// Final passes over all vertices, to raise the mean. 0 to 1000.
  int passes = 2;
  bool fixBoundary = false;  ///< keep vertices on the surface and on tagged interior faces fixed
  /// Edges where the surface turns by more than this angle are curves, which their vertices do not
  /// leave; in degrees, 0 to 180. Tagged edges are curves, too. Without a map and tagged edges, so
  /// are boundary edges with other than two cells.
  double featureAngle = 40;
  /// How far untagged vertices may leave the surface where vertices on it cannot make cells
  /// positive, in diagonals of the bounding box; also to raise cells below the target in such
  /// meshes. Unless it is 0, coarse meshes may leave it farther, to get nearer. 0 to 0.1.
  double slack = 1e-3;
  PillowMode pillow = PillowMode::Never;  ///< straight cells only
  /// Where mesh edges do not follow the curves of a map's surface: snap paths of boundary edges to
  /// them in a copy with a pillow. The copy is kept if its minimum scaled Jacobian, its distance
  /// and the curves that it follows are better overall. Straight cells only.
  bool snapCurves = false;
};

/// Distance between the boundaries of the object and of the mesh, in diagonals of the surface's
/// bounding box.
struct SurfaceDistance {
  double fromMesh = 0;  ///< maximum over boundary quads, at 5 x 5 points of each
  /// Maximum over vertices, edge midpoints and centres of the object's boundary triangles.
  double fromSurface = 0;

  [[nodiscard]] double hausdorff() const noexcept {
    return fromMesh > fromSurface ? fromMesh : fromSurface;
  }
};

/// Maximum distance of the mesh boundary from the surface beyond which ImproveReport lists cells,
/// in diagonals of the bounding box. Moves that take it beyond this, and beyond any earlier
/// distance, are undone unless that would make cells worse.
inline constexpr double kSurfaceTolerance = 1e-3;

/// What limits the quality of a cell.
enum class CellHolder : std::uint8_t {
  Neighbours,  ///< only the cells around it
  Surface,     ///< two of its faces are on the boundary, which is nearly flat there
  Curve,       ///< an edge of the object, or one with a tag
  Corner,      ///< a vertex where curves meet, end or turn, or one with a tag
  Held,        ///< a vertex that ImproveOptions::fixBoundary holds, or a cell of the next kind
  SharedFaces  ///< it shares two adjacent faces with a cell: one of the two is not positive
};

/// The cell with the least scaled Jacobian, and what is at its worst corner.
struct WorstCell {
  std::uint64_t cell = 0;
  CellHolder holder = CellHolder::Neighbours;
  bool isTagged = false;  ///< the curve or corner
  Index vertex = kNone;   ///< of the corner
  /// Angle of the cell there between two boundary faces, in degrees; of up to three such angles,
  /// the one farthest from 90. 0 without two such faces.
  double angle = 0;
};

struct ImproveReport {
  Certificate before;
  Certificate after;
  Array<std::uint64_t> notPositive;  ///< cells that are not certified at the end, ascending
  double diagonal = 0;               ///< of the surface's bounding box
  SurfaceDistance distanceBefore;
  SurfaceDistance distanceAfter;
  /// Largest distance of an interior mesh face that is tagged or on a region interface from the
  /// corresponding triangles of the map, in diagonals. 0 if there are none.
  double innerDistanceBefore = 0;
  double innerDistanceAfter = 0;
  std::uint64_t farCellsBefore = 0;         ///< cells whose boundary is beyond kSurfaceTolerance
  Array<std::uint64_t> farCells;            ///< the same at the end, ascending
  std::array<std::uint64_t, 4> vertices{};  ///< free, on patches, on curves, fixed
  // Why vertices are fixed; those not counted here are corners, where curves meet or turn.
  std::uint64_t taggedVertices = 0;    ///< vertices with a tag
  std::uint64_t boundaryVertices = 0;  ///< vertices fixed only by ImproveOptions::fixBoundary
  std::uint64_t pairedVertices = 0;    ///< vertices fixed only because of `cannotBePositive`
  std::uint64_t movedVertices = 0;
  double largestMove = 0;  ///< in diagonals
  double meanMove = 0;     ///< mean over the moved vertices
  std::uint64_t offSurface =
      0;  ///< vertices off the surface: by the slack, to get nearer, or for the sake of cells
  double seconds = 0;
  /// Vertices that left creases because nothing else made cells good. A crease is an untagged
  /// curve with surface on both sides.
  std::uint64_t offCreases = 0;
  /// Cells of a pillow and of layers beside curves. They come last in the mesh, as do their
  /// vertices; `before` does not include them.
  std::uint64_t addedCells = 0;
  Array<Vec3> addedPoints;  ///< positions of their vertices before improvement
  /// Curves of the object: its sharp edges and its tagged edges.
  double curveLength = 0;           ///< in diagonals
  double curvesFollowed = 1;        ///< share of that length closely followed by mesh edges, 0 to 1
  std::uint64_t snappedCurves = 0;  ///< segments between corners to which edges were snapped
  /// Cells that are not positive and share two adjacent faces with another cell: one of the two is
  /// not positive, wherever the vertices are. Their vertices are left alone. Ascending.
  Array<std::uint64_t> cannotBePositive;
  WorstCell worst;  ///< at the end
};

/// Moves vertices and, if requested, adds a pillow. The surface is that of the map: its boundary,
/// tagged triangles and region interfaces.
///
/// The minimum scaled Jacobian does not decrease, and certified cells remain certified. Cells at or
/// above the target remain there, unless cells beside them were untangled. Connectivity, tags,
/// regions and vertices at tagged corners are preserved. (With PillowMode::Always, cells may become
/// worse. A pillow changes the connectivity; interior tags and regions are extended through it to
/// the boundary.) Vertices on tagged curves and patches stay on them. The result does not depend on
/// the number of threads. If an exception is thrown, the mesh is unchanged.
///
/// @param mesh  with generators in the map: returned by extract(), or read from `.vtu`, `.ovm` or
///              `.ovmb`
/// @throws Error InvalidArgument for options out of range, vertices that do not exist, generators
///         that are not in the map, and a map in a different location than the mesh; NotFinite for
///         a coordinate; TooLarge unless the extent of the mesh is between 1e-10 and 1e30;
///         RepeatedVertex for a cell that names a vertex twice; NonManifoldFace for a face of more
///         than two cells; Orientation for cells that list their corners in reverse orientation;
///         EmptyMesh; the errors of broken maps; with PillowMode::Always, NonManifoldEdge for edges
///         that do not have exactly two boundary quads, and InvalidArgument where interior tags or
///         regions leave no room for a layer
ImproveReport improve(HexMesh& mesh, const TetMapView& map, const ImproveOptions& options,
                      Context& context);

/// The same without a map: the surface is the boundary of the mesh and its tagged quads, each split
/// into two triangles.
/// @throws Error  as above
ImproveReport improve(HexMesh& mesh, const ImproveOptions& options, Context& context);

/// The boundary of the mesh approximates the given surface, whose edges beyond the feature angle
/// are curves. Boundary vertices are pulled onto it as far as cells allow: vertices on curves and
/// at corners of the mesh onto curves and corners of the surface that are nearer than half an edge.
/// Tags of the mesh count as its curves and corners; tagged quads inside stay where they are.
/// @throws Error  as above; InvalidArgument for a surface in a different location than the mesh, or
///         with vertices that do not exist; EmptyMesh if it has no triangles
ImproveReport improve(HexMesh& mesh, const TriangleMesh& surface, const ImproveOptions& options,
                      Context& context);

/// The same for cells of order 1 to 3: moves all nodes, each as far as its generator permits, and
/// certifies curved cells. In the report, vertices are nodes, and distances are those of the grid
/// of quads between them.
/// @throws Error  as above; also InvalidArgument for higher orders, and for arrays of inconsistent
///         sizes
ImproveReport improve(LagrangeMesh& mesh, const TetMapView& map, const ImproveOptions& options,
                      Context& context);
ImproveReport improve(LagrangeMesh& mesh, const ImproveOptions& options, Context& context);
ImproveReport improve(LagrangeMesh& mesh, const TriangleMesh& surface,
                      const ImproveOptions& options, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
