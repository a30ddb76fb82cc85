#include "vtkHexHexMapReader.h"

#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/map_structure.hpp>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include "conversion.h"
#include "run_guarded.h"

vtkStandardNewMacro(vtkHexHexMapReader);

vtkHexHexMapReader::vtkHexHexMapReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(4);
}

vtkHexHexMapReader::~vtkHexHexMapReader()
{
  this->SetFileName(nullptr);
}

void vtkHexHexMapReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}

int vtkHexHexMapReader::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

int vtkHexHexMapReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  if (!this->FileName)
  {
    vtkErrorMacro("Choose a file.");
    return 0;
  }
  hexhex::TetMap map;
  hexhex::MapStructure structure;
  const std::string problem =
    hexhex::paraview::runGuarded(*this, 0, [&](hexhex::Context& context) {
      map = hexhex::readMap(this->FileName, context);
      structure = hexhex::findMapStructure(map, hexhex::ExtractOptions{}.tolerance, context);
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
  hexhex::paraview::fillGrid(*vtkUnstructuredGrid::GetData(outputs, 0), map);
  hexhex::paraview::fillChartJumps(*vtkPolyData::GetData(outputs, 1), map, structure);
  hexhex::paraview::fillSingularEdges(*vtkPolyData::GetData(outputs, 2), map, structure);
  hexhex::paraview::fillFeatures(*vtkPolyData::GetData(outputs, 3), map);
  if (!structure.defects.empty())
  {
    const hexhex::Defect& defect = structure.defects.front();
    vtkWarningMacro(<< "This is no valid integer-grid map. " << defect.sentence << " ["
                    << std::string(hexhex::name(defect.code)) << "]");
  }
  return 1;
}
