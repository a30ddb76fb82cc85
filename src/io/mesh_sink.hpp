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

/// Writes the same as writeVtu() but no array scaled_jacobian: it takes the vertices of all cells.
/// @throws Error FileWrite also for a device or a pipe: arrays are written side by side
[[nodiscard]] std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file,
                                                    Context& context);

}  // namespace hexhex
