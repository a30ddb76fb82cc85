#include "vtkHexHexMapReader.h"

#include <hexhex/io.hpp>

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
  this->SetNumberOfOutputPorts(2);
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
  const std::string problem = hexhex::paraview::runGuarded(
    *this, 0, [&](hexhex::Context& context) { map = hexhex::readMap(this->FileName, context); });
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
    return 0;
  }
  hexhex::paraview::fillGrid(*vtkUnstructuredGrid::GetData(outputs, 0), map);
  hexhex::paraview::fillFeatures(*vtkPolyData::GetData(outputs, 1), map);
  return 1;
}
