#include "vtkHexHexExtract.h"

#include <string>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/verify.hpp>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include "conversion.h"
#include "run_guarded.h"

namespace
{

/// All that comes out; what was not asked for is empty.
struct Extracted
{
  hexhex::PiecewiseLinearMesh linear;
  hexhex::LagrangeMesh curved;
  hexhex::Array<double> quality;
  hexhex::MeshStructure structure;
  hexhex::RepairedMap repaired;
};

struct Request
{
  hexhex::ExtractOptions options;
  bool repair = false;
  int order = 1;
  bool quantize = false;
  double cells = 0; // to quantize for
  bool improve = false;
  double target = 0; // of improvement
  bool verify = true;
  bool arcs = false;
  bool patches = false;
};

void requireVerified(
  const hexhex::TetMapView& map, const hexhex::HexMesh& mesh, int scale, double tolerance,
  hexhex::Context& context)
{
  const hexhex::VerifyReport report = hexhex::verify(map, mesh, { scale, tolerance }, context);
  if (report.passed())
  {
    return;
  }
  std::string sentence = "The mesh does not agree with the map:";
  for (const hexhex::VerifyItem& item : report.items)
  {
    if (!item.passed)
    {
      sentence += " " + item.name + ": expected " + item.expected + ", found " + item.found + ".";
    }
  }
  throw hexhex::Error(hexhex::ErrorCode::VerificationFailed, sentence);
}

/// Moves vertices, or the nodes of cells of higher order.
void improveAll(Extracted& result, const hexhex::TetMapView& map, const Request& request,
  hexhex::Context& context)
{
  if (request.order > 3 || request.arcs || request.patches)
  {
    throw hexhex::Error(hexhex::ErrorCode::InvalidArgument,
      "Improve moves nodes of cells up to order 3, away from the map that arcs and patches follow. "
      "Switch off Improve, or Arcs and Patches, or lower Order.");
  }
  if (request.order == 1)
  {
    hexhex::improve(result.linear.mesh, map, { .target = request.target }, context);
    return;
  }
  hexhex::improve(result.curved, map, { .target = request.target }, context);
  // Singular edges end where corners of cells are.
  result.linear.mesh = hexhex::straightMesh(result.curved);
}

Extracted extractAll(const hexhex::TetMap& map, const Request& request, hexhex::Context& context)
{
  Extracted result;
  hexhex::ExtractOptions options = request.options;
  options.repair = request.repair ? &result.repaired : nullptr;
  if (request.arcs || request.patches)
  {
    const auto parts = request.patches ? hexhex::PiecewiseLinearParts::ArcsAndPatches
                                       : hexhex::PiecewiseLinearParts::Arcs;
    result.linear = hexhex::extractPiecewiseLinear(map, parts, options, context);
  }
  else
  {
    result.linear.mesh = hexhex::extract(map, options, context);
  }
  // What the mesh belongs to.
  const hexhex::TetMapView repaired =
    result.repaired.map ? hexhex::TetMapView(*result.repaired.map) : hexhex::TetMapView(map);
  hexhex::HexMesh& mesh = result.linear.mesh;
  if (request.verify)
  {
    requireVerified(repaired, mesh, request.options.scale, request.options.tolerance, context);
  }
  if (request.order > 1)
  {
    result.curved = hexhex::extractLagrange(repaired, request.order, request.options, context);
  }
  if (request.improve)
  {
    improveAll(result, repaired, request, context);
  }
  result.structure = hexhex::findStructure(mesh, context);
  result.quality = request.order == 1 ? hexhex::scaledJacobians(mesh, context)
                                      : hexhex::scaledJacobians(result.curved, context);
  return result;
}

}

vtkStandardNewMacro(vtkHexHexExtract);

vtkHexHexExtract::vtkHexHexExtract()
{
  this->SetNumberOfOutputPorts(4);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, hexhex::paraview::kParameters);
}

void vtkHexHexExtract::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
  os << indent << "Engine: " << this->Engine << "\n";
  os << indent << "Order: " << this->Order << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Repair: " << this->Repair << "\n";
  os << indent << "Quantize: " << this->Quantize << "\n";
  os << indent << "Cells: " << this->Cells << "\n";
  os << indent << "Improve: " << this->Improve << "\n";
  os << indent << "Target: " << this->Target << "\n";
  os << indent << "Verify: " << this->Verify << "\n";
  os << indent << "Arcs: " << this->Arcs << "\n";
  os << indent << "Patches: " << this->Patches << "\n";
}

int vtkHexHexExtract::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

int vtkHexHexExtract::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

int vtkHexHexExtract::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkUnstructuredGrid* const input = vtkUnstructuredGrid::GetData(inputs[0], 0);
  vtkDataArray* parameters = this->GetInputArrayToProcess(0, inputs);
  if (!parameters)
  {
    // Scripts that build a pipeline before they run it have no list to choose from yet.
    parameters = input->GetCellData()->GetArray(hexhex::paraview::kParameters);
  }
  Request request;
  request.options.engine = this->Engine == 0 ? hexhex::Engine::Atlas : hexhex::Engine::Propeller;
  request.options.scale = this->Scale;
  request.options.tolerance = this->Tolerance;
  request.repair = this->Repair != 0;
  request.order = this->Order;
  request.quantize = this->Quantize != 0;
  request.cells = this->Cells;
  request.improve = this->Improve != 0;
  request.target = this->Target;
  request.verify = this->Verify != 0;
  request.arcs = this->Arcs != 0;
  request.patches = this->Patches != 0;
  Extracted result;
  const std::string problem =
    hexhex::paraview::runGuarded(*this, this->Threads, [&](hexhex::Context& context) {
      hexhex::TetMap map = hexhex::paraview::mapOf(*input, parameters);
      if (request.quantize)
      {
        map = hexhex::quantize(map, { .cells = request.cells }, context).map;
      }
      result = extractAll(map, request, context);
    });
  if (this->GetAbortExecute())
  {
    return 1; // empty, as the user wanted; no error
  }
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
    return 0;
  }
  if (result.repaired.map)
  {
    const auto& places = result.repaired.report.regions;
    vtkWarningMacro(<< "The map has flipped or flat tets, which were repaired before the extraction, in "
                    << places.size() << (places.size() == 1 ? " place." : " places."));
  }
  vtkUnstructuredGrid& grid = *vtkUnstructuredGrid::GetData(outputs, 0);
  if (this->Order == 1)
  {
    hexhex::paraview::fillGrid(grid, result.linear.mesh, result.quality);
  }
  else
  {
    hexhex::paraview::fillGrid(grid, result.curved, result.quality);
  }
  hexhex::paraview::fillSingularEdges(
    *vtkPolyData::GetData(outputs, 1), result.linear.mesh, result.structure);
  if (request.arcs || request.patches)
  {
    hexhex::paraview::fillArcs(*vtkPolyData::GetData(outputs, 2), result.linear);
  }
  if (request.patches)
  {
    hexhex::paraview::fillPatches(*vtkPolyData::GetData(outputs, 3), result.linear);
  }
  return 1;
}
