// The table of formats for curved meshes, by extension.
#include <array>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>

#include <io/core/input_file.hpp>
#include <io/core/registry.hpp>
#include <io/core/text_scanner.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/ovm/ovm.hpp>
#include <io/vtk/vtk.hpp>
#include <mesh/lagrange_check.hpp>

namespace hexhex::io {

namespace {

using PiecewiseWriter = void (*)(const PiecewiseLinearMesh&, const TetMapView*,
                                 const std::filesystem::path&, Context&);
using LagrangeWriter = void (*)(const LagrangeMesh&, const std::filesystem::path&,
                                const WriteOptions&, Context&);

template <class Writer>
struct CurvedFormat {
  std::string_view extension;
  Writer write;
};

/// Writers of formats that say nothing about the map.
template <void (*write)(const PiecewiseLinearMesh&, const std::filesystem::path&, Context&)>
void withoutMap(const PiecewiseLinearMesh& mesh, const TetMapView* /*map*/,
                const std::filesystem::path& file, Context& context) {
  write(mesh, file, context);
}

constexpr std::array<CurvedFormat<PiecewiseWriter>, 3> kArcFormats = {
    {{".vtu", withoutMap<writeArcsVtk>},
     {".vtp", withoutMap<writeArcsVtk>},
     {".ovmb", writeArcsOvmb}}};
constexpr std::array<CurvedFormat<PiecewiseWriter>, 3> kPatchFormats = {
    {{".vtu", withoutMap<writePatchesVtk>},
     {".vtp", withoutMap<writePatchesVtk>},
     {".ovmb", writePatchesOvmb}}};
constexpr std::array<CurvedFormat<LagrangeWriter>, 3> kLagrangeFormats = {
    {{".vtu", writeLagrangeVtu}, {".msh", writeLagrangeGmsh}, {".mesh", writeLagrangeMfem}}};

template <class Formats>
auto find(const Formats& formats, const std::filesystem::path& file, const char* what) {
  const std::string extension = lowerCaseExtension(file);
  std::string known;
  for (const auto& format : formats) {
    if (format.extension == extension) return format.write;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  throw Error(ErrorCode::FileUnsupported, file.string() + ": the extension \"" + extension +
                                              "\" is no format of " + what + ". Formats: " + known +
                                              ".");
}

/// The format of a file that may hold cells of higher order; null if there is none.
const Format* curvedFormat(const std::filesystem::path& file) {
  try {
    const Format& format = findFormat(file, {}, FileContent::HexMesh);
    return format.curved.read == nullptr ? nullptr : &format;
  } catch (const Error&) {  // no mesh at all
    return nullptr;
  }
}

constexpr const char* kArcs = "arcs";
constexpr const char* kPatches = "patches";
constexpr const char* kCells = "cells of higher order";

constexpr std::array<WorkStep, 1> kArcsSteps = {{{"write arcs", 1}}};
constexpr std::array<WorkStep, 1> kPatchesSteps = {{{"write patches", 1}}};
constexpr std::array<WorkStep, 1> kReadSteps = {{{"read mesh", 1}}};
constexpr std::array<WorkStep, 1> kWriteSteps = {{{"write mesh", 1}}};

}  // namespace

}  // namespace hexhex::io

namespace hexhex {

void writeArcs(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
               Context& context) {
  const auto write = io::find(io::kArcFormats, file, io::kArcs);
  inSteps(context, "writeArcs", io::kArcsSteps, [&] { write(mesh, nullptr, file, context); });
}

void writeArcs(const PiecewiseLinearMesh& mesh, const TetMapView& map,
               const std::filesystem::path& file, Context& context) {
  const auto write = io::find(io::kArcFormats, file, io::kArcs);
  inSteps(context, "writeArcs", io::kArcsSteps, [&] { write(mesh, &map, file, context); });
}

void writePatches(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                  Context& context) {
  const auto write = io::find(io::kPatchFormats, file, io::kPatches);
  inSteps(context, "writePatches", io::kPatchesSteps, [&] { write(mesh, nullptr, file, context); });
}

void writePatches(const PiecewiseLinearMesh& mesh, const TetMapView& map,
                  const std::filesystem::path& file, Context& context) {
  const auto write = io::find(io::kPatchFormats, file, io::kPatches);
  inSteps(context, "writePatches", io::kPatchesSteps, [&] { write(mesh, &map, file, context); });
}

void writeLagrangeMesh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  const io::LagrangeWriter write = io::find(io::kLagrangeFormats, file, io::kCells);
  mesh::requireConsistent(mesh);
  if (!options.scaledJacobians.empty() && options.scaledJacobians.size() != mesh.cellCount()) {
    throw Error(ErrorCode::InvalidArgument,
                "There are " + std::to_string(options.scaledJacobians.size()) +
                    " scaled Jacobians of " + std::to_string(mesh.cellCount()) +
                    " cells. Give one for each, or none.");
  }
  inSteps(context, "writeLagrangeMesh", io::kWriteSteps,
          [&] { write(mesh, file, options, context); });
}

bool holdsLagrangeCells(const std::filesystem::path& file, Context& context) {
  const io::Format* const format = io::curvedFormat(file);
  return format != nullptr && format->curved.isIn(io::openInput(file, context), context);
}

LagrangeMesh readLagrangeMesh(const std::filesystem::path& file, Context& context) {
  const io::Format* const format = io::curvedFormat(file);
  if (format == nullptr) {
    throw Error(ErrorCode::FileUnsupported,
                file.string() +
                    ": cells of higher order are read from .vtu, .vtk, .inp, .exo and .e "
                    "files only.");
  }
  return inSteps(context, "readLagrangeMesh", io::kReadSteps,
                 [&] { return format->curved.read(io::openInput(file, context), context); });
}

void requireArcFormat(const std::filesystem::path& file) {
  static_cast<void>(io::find(io::kArcFormats, file, io::kArcs));
}

void requirePatchFormat(const std::filesystem::path& file) {
  static_cast<void>(io::find(io::kPatchFormats, file, io::kPatches));
}

void requireLagrangeFormat(const std::filesystem::path& file) {
  static_cast<void>(io::find(io::kLagrangeFormats, file, io::kCells));
}

}  // namespace hexhex
