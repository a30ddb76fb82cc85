// The sinks behind openMeshSink(), by format.
#pragma once

#include <filesystem>
#include <memory>

#include <hexhex/context.hpp>
#include <hexhex/stream.hpp>

namespace hexhex {

/// Writes the same as writeMedit() but no section Quadrilaterals: that the boundary is not known
/// before the last cell came.
[[nodiscard]] std::unique_ptr<MeshSink> openMeditSink(const std::filesystem::path& file,
                                                      Context& context);

/// Writes vertices and hexahedra as writeMeshb() does, but no boundary.
[[nodiscard]] std::unique_ptr<MeshSink> openMeshbSink(const std::filesystem::path& file,
                                                      Context& context);

/// Writes nodes and hexahedra as writeGmsh41Binary() does, but no boundary.
/// @throws Error FileWrite also for a device or a pipe
[[nodiscard]] std::unique_ptr<MeshSink> openGmsh41BinarySink(const std::filesystem::path& file,
                                                             Context& context);

/// Write the same as writeVtkLegacy() and writeVtkLegacyBinary().
[[nodiscard]] std::unique_ptr<MeshSink> openVtkLegacySink(const std::filesystem::path& file,
                                                          Context& context);
[[nodiscard]] std::unique_ptr<MeshSink> openVtkLegacyBinarySink(const std::filesystem::path& file,
                                                                Context& context);

/// Writes the same as writeVtu() but no array scaled_jacobian: it takes the vertices of all cells.
/// @throws Error FileWrite also for a device or a pipe: arrays are written side by side
[[nodiscard]] std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file,
                                                    Context& context);

}  // namespace hexhex
