// From a mesh that was extracted to one that a solver takes: cells become positive everywhere, then
// the worst ones better, then all. Vertices of the boundary stay on the surface of the object.
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

/// Whether a layer of cells is added under the boundary. In it, each cell has one face on the
/// boundary: no position of its vertices makes a cell good that has two where the boundary hardly
/// turns, as at borders of labels on a smooth surface.
enum class PillowMode : std::uint8_t {
  Never,
  Auto,   ///< where fewer cells stay that are not positive, or the minimum rises by 0.02 or more
  Always  ///< if there cannot be one, that is an error
};

struct ImproveOptions {
  /// Cells whose scaled Jacobian is below are improved until none is, or no vertex helps any more.
  /// 0 to 1; 0: cells are only made positive.
  double target = 0.3;
  /// Over all vertices in the end, for the mean. 0 to 1000.
  int passes = 2;
  bool fixBoundary = false;  ///< vertices on the surface and on tagged faces inside stay
  /// Edges of the surface where it turns by more than that are curves, which vertices on them do
  /// not leave; in degrees, 0 to 180. Tagged edges are curves, too, and without a map or any of
  /// these, so are edges of the boundary with other than two cells.
  double featureAngle = 40;
  /// Where vertices on the surface cannot make cells positive, those without tags may leave it by
  /// so much, in diagonals of the bounding box; in such meshes also to raise cells below the
  /// target. 0 to 0.1.
  double slack = 1e-3;
  PillowMode pillow = PillowMode::Never;  ///< of straight cells only
  /// Where edges of the mesh do not follow the curves of a map's surface: lays paths of edges of
  /// the boundary onto them, in a copy with a pillow, which is kept if it is better by its least
  /// scaled Jacobian, its distance and what it follows together. Straight cells only.
  bool snapCurves = false;
};

/// Between the boundaries of the object and of the mesh, in diagonals of the surface's bounding
/// box.
struct SurfaceDistance {
  double fromMesh = 0;     ///< largest of vertices, centres and middles of edges of boundary quads
  double fromSurface = 0;  ///< largest of vertices and centres of the object's boundary triangles

  [[nodiscard]] double hausdorff() const noexcept {
    return fromMesh > fromSurface ? fromMesh : fromSurface;
  }
};

/// So far may the boundary of a mesh be from the surface, in diagonals of its bounding box, until
/// ImproveReport says which cells are farther. What lets it come farther than that, and than it was
/// anywhere before, is undone, unless cells would become worse.
inline constexpr double kSurfaceTolerance = 1e-3;

/// What keeps a cell from being better.
enum class CellHolder : std::uint8_t {
  Neighbours,  ///< nothing but the cells around
  Surface,     ///< two of its faces are on the boundary, which hardly turns between them
  Curve,       ///< an edge of the object, or one with a tag
  Corner,      ///< a vertex where curves meet, end or turn, or one with a tag
  Held,        ///< a vertex that ImproveOptions::fixBoundary holds, or a cell of the next kind
  SharedFaces  ///< a cell with which it shares two faces that meet: one of the two is not positive
};

/// The cell with the least scaled Jacobian, and what is at its worst corner.
struct WorstCell {
  std::uint64_t cell = 0;
  CellHolder holder = CellHolder::Neighbours;
  bool isTagged = false;  ///< the curve or corner
  Index vertex = kNone;   ///< of the corner
  /// Of the cell there, in degrees, between two faces on the boundary: of up to three such angles
  /// the one that differs most from 90. 0: it has no two.
  double angle = 0;
};

struct ImproveReport {
  Certificate before;
  Certificate after;
  Array<std::uint64_t> notPositive;  ///< cells that are not certified in the end, ascending
  double diagonal = 0;               ///< of the surface's bounding box
  SurfaceDistance distanceBefore;
  SurfaceDistance distanceAfter;
  /// Of faces inside that are tagged, or between regions of the map: the largest distance of such a
  /// face from such triangles, in diagonals. 0 if there are none.
  double innerDistanceBefore = 0;
  double innerDistanceAfter = 0;
  std::uint64_t farCellsBefore = 0;         ///< whose boundary is beyond kSurfaceTolerance
  Array<std::uint64_t> farCells;            ///< those of the end, ascending
  std::array<std::uint64_t, 4> vertices{};  ///< that move freely, on patches, on curves, not at all
  // Why vertices do not move at all: these, and the rest are corners, where curves meet or turn.
  std::uint64_t taggedVertices = 0;    ///< that have a tag
  std::uint64_t boundaryVertices = 0;  ///< that only ImproveOptions::fixBoundary holds
  std::uint64_t pairedVertices = 0;    ///< that only `cannotBePositive` holds
  std::uint64_t movedVertices = 0;
  double largestMove = 0;        ///< in diagonals
  double meanMove = 0;           ///< of those that moved
  std::uint64_t offSurface = 0;  ///< vertices that used the slack
  double seconds = 0;
  /// Vertices that left creases where nothing else made cells positive. Creases are curves that
  /// have no tag, and on both sides of which the surface goes on.
  std::uint64_t offCreases = 0;
  /// Of a pillow, and of layers beside curves: they are last in the mesh, and so are their
  /// vertices. In `before`, they are missing.
  std::uint64_t addedCells = 0;
  Array<Vec3> addedPoints;  ///< their vertices, where they were put before they moved
  /// Curves of the object: its sharp and its tagged edges.
  double curveLength = 0;           ///< in diagonals
  double curvesFollowed = 1;        ///< share of it near which edges of the mesh run along, 0 to 1
  std::uint64_t snappedCurves = 0;  ///< pieces between corners that paths of edges were laid onto
  /// Cells that are not positive and share two faces that meet with another cell: one of the two
  /// is not, wherever vertices are. Theirs are left alone. Ascending.
  Array<std::uint64_t> cannotBePositive;
  WorstCell worst;  ///< in the end
};

/// Moves vertices, and adds a pillow if that is wanted. The surface is that of the map: its
/// boundary, tagged triangles and those between regions.
///
/// The least scaled Jacobian is no less in the end, and no cell that is certified loses that. Cells
/// at the target or above end there, unless cells beside them were untangled. Connectivity, tags
/// and regions stay as they are; so do vertices at tagged corners. (With PillowMode::Always, cells
/// may be worse than before, and a pillow changes the connectivity; tags and regions inside go on
/// through it to the boundary.) Vertices on tagged curves and
/// patches stay on them. The result does not depend on the number of threads. If it throws, the
/// mesh is as it was.
///
/// @param mesh  with generators in the map: what extract() returns, or what was read from `.vtu`,
///              `.ovm` or `.ovmb`
/// @throws Error InvalidArgument for options out of range, vertices that do not exist, generators
///         that are not in the map, and a map that is elsewhere than the mesh; NotFinite for a
///         coordinate; TooLarge unless the mesh extends over 1e-10 to 1e30; RepeatedVertex for a
///         cell that names a vertex twice; NonManifoldFace for a face of more than two cells;
///         Orientation for cells that list their corners the other way round; EmptyMesh; those of
///         broken maps; with PillowMode::Always, NonManifoldEdge for edges with other than two
///         quads of the boundary, and InvalidArgument where tags or regions inside leave no room
///         for a layer
ImproveReport improve(HexMesh& mesh, const TetMapView& map, const ImproveOptions& options,
                      Context& context);

/// The surface is the boundary of the mesh itself, and its tagged quads: each is divided into two
/// triangles.
/// @throws Error  as above
ImproveReport improve(HexMesh& mesh, const ImproveOptions& options, Context& context);

/// The surface is one that the boundary of the mesh approximates; its edges beyond the angle are
/// curves. Vertices of the boundary are pulled onto it as far as cells allow: those on curves and
/// at corners of the mesh itself onto curves and corners of the surface, if these are nearer than
/// half an edge. Tags of the mesh count as its own curves and corners do; tagged quads inside stay.
/// @throws Error  as above; InvalidArgument for a surface that is elsewhere than the mesh, or with
///         vertices that do not exist; EmptyMesh if it has no triangles
ImproveReport improve(HexMesh& mesh, const TriangleMesh& surface, const ImproveOptions& options,
                      Context& context);

/// Cells of order 1 to 3: all nodes move, each where its generator lets it; certificates are those
/// of curved cells. Vertices in the report are nodes, and its distances those of the grid of quads
/// between them.
/// @throws Error  as above; InvalidArgument also for higher orders, and for arrays that do not fit
///         each other
ImproveReport improve(LagrangeMesh& mesh, const TetMapView& map, const ImproveOptions& options,
                      Context& context);
ImproveReport improve(LagrangeMesh& mesh, const ImproveOptions& options, Context& context);
ImproveReport improve(LagrangeMesh& mesh, const TriangleMesh& surface,
                      const ImproveOptions& options, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
