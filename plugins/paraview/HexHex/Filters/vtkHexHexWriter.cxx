#include "vtkHexHexWriter.h"

#include <hexhex/io.hpp>

#include <vtkErrorCode.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkUnstructuredGrid.h>

#include "conversion.h"
#include "run_guarded.h"

vtkStandardNewMacro(vtkHexHexWriter);

vtkHexHexWriter::~vtkHexHexWriter()
{
  this->SetFileName(nullptr);
  this->SetFormat(nullptr);
}

void vtkHexHexWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Format: " << (this->Format ? this->Format : "(by extension)") << "\n";
  os << indent << "PatchAngle: " << this->PatchAngle << "\n";
}

int vtkHexHexWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

void vtkHexHexWriter::WriteData()
{
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::SafeDownCast(this->GetInput());
  if (!grid || !this->FileName)
  {
    vtkErrorMacro("The writer needs a grid and the name of a file.");
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    return;
  }
  const std::string problem =
    hexhex::paraview::runGuarded(*this, 0, [&](hexhex::Context& context) {
      hexhex::WriteOptions options;
      if (this->Format) options.format = this->Format;
      options.patchAngle = this->PatchAngle;
      hexhex::writeHexMesh(hexhex::paraview::hexesOf(*grid), this->FileName, options, context);
    });
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
    this->SetErrorCode(vtkErrorCode::UserError);
  }
}
