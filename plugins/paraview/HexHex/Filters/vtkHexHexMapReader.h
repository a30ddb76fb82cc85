/**
 * @class vtkHexHexMapReader
 * @brief reads tetrahedral meshes with an integer-grid map: .hexex, .ovm, .ovmb
 *
 * Port 0: the tets, with the cell array `hexhex_parameters` (12 components). Port 1: the triangles at
 * which charts differ, with the transitions. Port 2: singular edges with valences. Port 3: what is
 * tagged.
 */
#ifndef vtkHexHexMapReader_h
#define vtkHexHexMapReader_h

#include "hexhexFiltersModule.h"
#include <vtkUnstructuredGridAlgorithm.h>

class HEXHEXFILTERS_EXPORT vtkHexHexMapReader : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkHexHexMapReader* New();
  vtkTypeMacro(vtkHexHexMapReader, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSetStringMacro(FileName);
  vtkGetStringMacro(FileName);

protected:
  vtkHexHexMapReader();
  ~vtkHexHexMapReader() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs) override;

private:
  vtkHexHexMapReader(const vtkHexHexMapReader&) = delete;
  void operator=(const vtkHexHexMapReader&) = delete;

  char* FileName = nullptr;
};

#endif
