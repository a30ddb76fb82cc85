#include "vtkHexHexMesh.h"

#include <cstdint>
#include <string>

#include <hexhex/error.hpp>
#include <hexhex/mesh.hpp>
#include <hexhex/structure.hpp>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include "conversion.h"
#include "run_guarded.h"

vtkStandardNewMacro(vtkHexHexMesh);

vtkHexHexMesh::vtkHexHexMesh()
{
  this->SetNumberOfOutputPorts(2);
}

void vtkHexHexMesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Cells: " << this->Cells << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "Target: " << this->Target << "\n";
  os << indent << "Pillow: " << this->Pillow << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Threads: " << this->Threads << "\n";
}

int vtkHexHexMesh::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

int vtkHexHexMesh::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

int vtkHexHexMesh::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkUnstructuredGrid* const input = vtkUnstructuredGrid::GetData(inputs[0], 0);
  hexhex::MeshedPart part;
  hexhex::MeshStructure structure;
  const std::string problem =
    hexhex::paraview::runGuarded(*this, this->Threads, [&](hexhex::Context& context) {
      if (this->Method < 0 || this->Method > 2 || this->Pillow < 0 || this->Pillow > 2 ||
        this->Seed < 0)
      {
        throw hexhex::Error(hexhex::ErrorCode::InvalidArgument,
          "Method and Pillow are from 0 to 2, and Seed is not negative.");
      }
      hexhex::MeshOptions options;
      options.shape = { static_cast<hexhex::ShapeMethod>(this->Method), this->FeatureAngle,
        static_cast<std::uint64_t>(this->Seed) };
      options.quantize.cells = this->Cells;
      options.quantize.densify = true;
      options.improve.target = this->Target;
      options.improve.featureAngle = this->FeatureAngle;
      options.improve.pillow = static_cast<hexhex::PillowMode>(this->Pillow);
      part = hexhex::meshFromTets(hexhex::paraview::tetsOf(*input), options, context);
      structure = hexhex::findStructure(part.mesh, context);
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
  if (!part.improvement.notPositive.empty())
  {
    vtkWarningMacro(<< part.improvement.notPositive.size()
                    << " cells are not certified to be positive everywhere. Try another number of cells, "
                       "method or pillow.");
  }
  hexhex::paraview::fillGrid(*vtkUnstructuredGrid::GetData(outputs, 0), part.mesh,
    part.improvement.after.scaledJacobians);
  hexhex::paraview::fillSingularEdges(
    *vtkPolyData::GetData(outputs, 1), part.mesh, structure);
  return 1;
}
