// Runs work of the library for an algorithm of VTK: progress, cancellation, errors.
#pragma once

#include <functional>
#include <string>

#include <hexhex/context.hpp>

class vtkAlgorithm;

namespace hexhex::paraview {

/// Runs `work` on a thread of its own, while the calling thread, the only one that may, keeps
/// VTK's progress up to date and asks whether the user wants to stop.
/// @return an empty string, or what went wrong as a sentence with code and place in brackets
[[nodiscard]] std::string runGuarded(vtkAlgorithm& algorithm, int threads,
                                     const std::function<void(Context&)>& work);

}  // namespace hexhex::paraview
