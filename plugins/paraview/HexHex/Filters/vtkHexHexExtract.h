/**
 * @class vtkHexHexExtract
 * @brief extracts the hexahedral mesh that an integer-grid map implies
 *
 * Input: tets with a cell array of twelve parameters, to be chosen with SetInputArrayToProcess.
 * Output ports: 0 hexahedra, 1 singular edges, 2 arcs, 3 patches. Arcs and patches are empty unless
 * asked for.
 */
#ifndef vtkHexHexExtract_h
#define vtkHexHexExtract_h

#include "hexhexFiltersModule.h"
#include <vtkUnstructuredGridAlgorithm.h>

class HEXHEXFILTERS_EXPORT vtkHexHexExtract : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkHexHexExtract* New();
  vtkTypeMacro(vtkHexHexExtract, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Multiplies the parameters: Scale^3 times as many cells. */
  vtkSetMacro(Scale, int);
  vtkGetMacro(Scale, int);
  /** Number of threads, 0 for all cores. */
  vtkSetMacro(Threads, int);
  vtkGetMacro(Threads, int);
  /** 0: atlas, 1: the paper's propellers; the same mesh. */
  vtkSetMacro(Engine, int);
  vtkGetMacro(Engine, int);
  /** Order of the cells; 1 for straight ones. */
  vtkSetMacro(Order, int);
  vtkGetMacro(Order, int);
  /** How far the map may be from its integer conditions, in parameter units. */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  /** Whether flipped and flat tets of the map are repaired first, with a warning. */
  vtkSetMacro(Repair, vtkTypeBool);
  vtkGetMacro(Repair, vtkTypeBool);
  /** Whether a seamless map is made an integer-grid map of about Cells cells first. */
  vtkSetMacro(Quantize, vtkTypeBool);
  vtkGetMacro(Quantize, vtkTypeBool);
  vtkSetMacro(Cells, double);
  vtkGetMacro(Cells, double);
  /** Whether vertices move until all cells are positive, and none has a scaled Jacobian below Target
   * if that can be. */
  vtkSetMacro(Improve, vtkTypeBool);
  vtkGetMacro(Improve, vtkTypeBool);
  vtkSetMacro(Target, double);
  vtkGetMacro(Target, double);
  /** Whether the mesh is compared with the map. */
  vtkSetMacro(Verify, vtkTypeBool);
  vtkGetMacro(Verify, vtkTypeBool);
  /** Whether hex edges are traced through the tets (port 2). */
  vtkSetMacro(Arcs, vtkTypeBool);
  vtkGetMacro(Arcs, vtkTypeBool);
  /** Whether hex faces are cut by the tets (port 3); implies arcs. */
  vtkSetMacro(Patches, vtkTypeBool);
  vtkGetMacro(Patches, vtkTypeBool);

protected:
  vtkHexHexExtract();
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs) override;

private:
  vtkHexHexExtract(const vtkHexHexExtract&) = delete;
  void operator=(const vtkHexHexExtract&) = delete;

  int Scale = 1;
  int Threads = 0;
  int Engine = 0;
  int Order = 1;
  double Tolerance = 0.01;
  vtkTypeBool Repair = 1;
  vtkTypeBool Quantize = 0;
  double Cells = 10000;
  vtkTypeBool Improve = 0;
  double Target = 0.3;
  vtkTypeBool Verify = 1;
  vtkTypeBool Arcs = 0;
  vtkTypeBool Patches = 0;
};

#endif
