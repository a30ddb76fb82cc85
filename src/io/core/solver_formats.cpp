// The table of solvers and the formats they read. A name here is also valid for
// WriteOptions::format (registry.cpp).
#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include <hexhex/io.hpp>

namespace hexhex {

std::span<const SolverFormat> solverFormats() noexcept {
  // MSH 2.2 text for readers that support neither newer versions nor binary files.
  static constexpr std::array kSolvers = {
      SolverFormat{"abaqus", "Abaqus", "inp", ".inp", "inp"},
      SolverFormat{"calculix", "CalculiX", "inp", ".inp", "inp"},
      SolverFormat{"code-aster", "Code_Aster", "msh22-ascii", ".msh"},
      SolverFormat{"dealii", "deal.II", "msh22-ascii", ".msh"},
      SolverFormat{"dolfinx", "DOLFINx", "msh", ".msh", "msh"},
      SolverFormat{"dune", "DUNE", "msh22-ascii", ".msh"},
      SolverFormat{"elmer", "ElmerGrid", "msh22-ascii", ".msh", "msh"},
      SolverFormat{"febio", "FEBio Studio", "inp", ".inp", "inp"},
      SolverFormat{"getfem", "GetFEM", "msh22-ascii", ".msh"},
      SolverFormat{"mfem", "MFEM", "mfem", ".mesh", "mfem"},
      SolverFormat{"moose", "MOOSE", "exodus-e", ".e", "exodus-e"},
      SolverFormat{"ngsolve", "NGSolve", "msh22-ascii", ".msh"},
      SolverFormat{"openfoam", "OpenFOAM", "openfoam", ".foam"},
      SolverFormat{"scikit-fem", "scikit-fem", "msh", ".msh", "msh"},
  };
  return kSolvers;
}

const SolverFormat* findSolver(std::string_view name) noexcept {
  const auto solvers = solverFormats();
  const auto found = std::find_if(solvers.begin(), solvers.end(),
                                  [name](const SolverFormat& each) { return each.name == name; });
  return found == solvers.end() ? nullptr : &*found;
}

}  // namespace hexhex
