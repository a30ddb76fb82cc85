/**
 * @class vtkHexHexWriter
 * @brief writes hexahedral meshes in the formats of hexhex, by the extension of the file
 */
#ifndef vtkHexHexWriter_h
#define vtkHexHexWriter_h

#include "hexhexFiltersModule.h"
#include <vtkWriter.h>

class HEXHEXFILTERS_EXPORT vtkHexHexWriter : public vtkWriter
{
public:
  static vtkHexHexWriter* New();
  vtkTypeMacro(vtkHexHexWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSetStringMacro(FileName);
  vtkGetStringMacro(FileName);

protected:
  vtkHexHexWriter() = default;
  ~vtkHexHexWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkHexHexWriter(const vtkHexHexWriter&) = delete;
  void operator=(const vtkHexHexWriter&) = delete;

  char* FileName = nullptr;
};

#endif
