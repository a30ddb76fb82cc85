/**
 * @class vtkHexHexWriter
 * @brief writes hexahedral meshes in the formats of hexhex, by the extension of the file or by name
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

  /**
   * A format by the name that `hexhex formats` lists. Empty, the default: what the extension means.
   */
  vtkSetStringMacro(Format);
  vtkGetStringMacro(Format);

  /**
   * Where no quad is tagged: the angle in degrees by which the boundary may turn within a group of
   * quads. 0: one group.
   */
  vtkSetClampMacro(PatchAngle, double, 0.0, 180.0);
  vtkGetMacro(PatchAngle, double);

protected:
  vtkHexHexWriter() = default;
  ~vtkHexHexWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkHexHexWriter(const vtkHexHexWriter&) = delete;
  void operator=(const vtkHexHexWriter&) = delete;

  char* FileName = nullptr;
  char* Format = nullptr;
  double PatchAngle = 40.0;
};

#endif
