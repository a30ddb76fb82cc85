// Work in a process of its own: for libraries that may crash, and cannot be told to stop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <hexhex/context.hpp>

namespace hexhex::quantization {

/// Runs `work` in a copy of this process (fork) and waits for it; what it prints is lost, and no
/// signal but the last one reaches it. Of threads, it has its own only: it must not wait for
/// another one, nor load libraries.
/// @param count  of numbers that it makes
/// @param work   sets them all; returns whether it could
/// @return  nothing if it could not
/// @throws Error OutOfMemory if there is no process, or it crashes; Cancelled
[[nodiscard]] std::optional<std::vector<std::int64_t>> inChildProcess(
    std::size_t count, const Context& context,
    const std::function<bool(std::span<std::int64_t>)>& work);

}  // namespace hexhex::quantization
