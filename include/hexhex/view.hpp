// A page that shows a hexahedral mesh in any browser. An optional component, the target
// hexhex::view: it requires zlib and nlohmann-json, and npm to build the page's script.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

namespace hexhex {

/// What the page shows in addition to the mesh.
struct ViewOptions {
  std::string title = "mesh";  ///< shown, and the name of saved pictures; UTF-8

  /// Result of verify() for this mesh, and the name of the map; null: the page does not mention it.
  const VerifyReport* verification = nullptr;
  std::string mapName = {};

  /// Result of scaledJacobians() for this mesh, if already available. Empty: computed.
  std::span<const double> scaledJacobians = {};

  /// Positions of the vertices (all nodes, for a LagrangeMesh) before the mesh was improved: the
  /// page can switch between both. Empty: it shows the mesh as it is.
  std::span<const Vec3> pointsBefore = {};
};

/// Writes a self-contained HTML file that contains mesh and script and has no access to the
/// network. Positions are rounded to a millionth of the longest side of the bounding box, scaled
/// Jacobians to 16 bits. About 3 to 10 bytes per cell; with positions before an improvement, up to
/// twice as much.
///
/// The file appears complete or not at all.
/// @throws Error EmptyMesh without cells; InvalidArgument if arrays are inconsistent, or a cell or
///         a feature names a vertex that does not exist; NotFinite; TooLarge beyond 2^24 - 1 cells
///         or vertices, which browsers cannot handle, and for a bounding box too large for doubles;
///         FileWrite
void writeViewPage(const HexMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context);

/// The same for higher-order cells, which the page draws curved or straight. It stores the nodes on
/// faces of cells: about 120 bytes per cell of order 2, and 260 of order 3.
/// @throws Error  the same; TooLarge also for more than 2^24 - 1 vertices and face nodes combined;
///         InvalidArgument for nodes that do not match the order
void writeViewPage(const LagrangeMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context);

/// Shows where a part cannot be meshed: its tets, each cut into four hexahedra; the tets that touch
/// the place of the error are region 1, and its edges are tagged.
/// @param place  a vertex, whose edges are tagged; an edge; a face; or a tet: that of an error with
///        the code NotMeshable. Places of others may be in a map of the part, which has more tets
/// @throws Error  EmptyMesh; IndexOutOfRange; NotFinite; TooLarge beyond 3.8 million tets or so;
///         FileWrite
void writeViewPage(const TetMesh& part, const Place& place, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context);

}  // namespace hexhex
