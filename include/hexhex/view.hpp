// A page that shows a hexahedral mesh in any browser. An optional part of the project, the target
// hexhex::view: it takes zlib and nlohmann-json, and the page's script takes npm at build time.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

namespace hexhex {

/// What the page shall say beside the mesh.
struct ViewOptions {
  std::string title = "mesh";  ///< shown, and the name of saved pictures; UTF-8

  /// What verify() said of this mesh, and the name of the map; null: the page says nothing of it.
  const VerifyReport* verification = nullptr;
  std::string mapName = {};

  /// What scaledJacobians() returned for this mesh, if the caller has it. Empty: computed.
  std::span<const double> scaledJacobians = {};

  /// Where the vertices (of a LagrangeMesh: all nodes) were before the mesh was improved: the page
  /// goes back and forth between both. Empty: it shows the mesh as it is.
  std::span<const Vec3> pointsBefore = {};
};

/// Writes one self-contained HTML file: mesh and script are in it, and it may not use the network.
/// Positions are rounded to a millionth of the longest side of the bounding box, scaled Jacobians
/// to 16 bits. About 3 to 10 bytes per cell; with positions before an improvement, up to twice
/// that.
///
/// The file appears complete or not at all.
/// @throws Error EmptyMesh without cells; InvalidArgument if arrays disagree, or a cell or a
///         feature names a vertex that does not exist; NotFinite; TooLarge beyond 2^24 - 1 cells or
///         vertices, which browsers do not hold, and for a box that no double measures; FileWrite
void writeViewPage(const HexMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context);

/// The same for cells of higher order: the page draws them curved or straight. It holds the nodes
/// on faces of cells: about 120 bytes per cell of order 2, and 260 of order 3.
/// @throws Error  the same; TooLarge also for more than 2^24 - 1 vertices and nodes on faces
///         together; InvalidArgument for nodes that do not fit the order
void writeViewPage(const LagrangeMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context);

/// A page whose mesh comes separately, for programs that serve it.
struct ServedPage {
  std::string html;               ///< asks for `dataUrl` on the same server, and for nothing else
  std::vector<std::string> data;  ///< one after the other, what is at `dataUrl`
};

/// The page in two parts. @throws Error as writeViewPage(), but FileWrite
[[nodiscard]] ServedPage makeServedPage(const HexMesh& mesh, const std::string& dataUrl,
                                        const ViewOptions& options, Context& context);
[[nodiscard]] ServedPage makeServedPage(const LagrangeMesh& mesh, const std::string& dataUrl,
                                        const ViewOptions& options, Context& context);

}  // namespace hexhex
