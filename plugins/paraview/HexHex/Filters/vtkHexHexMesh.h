/**
 * @class vtkHexHexMesh
 * @brief makes a hexahedral mesh of tets that have no map
 *
 * Output ports: 0 hexahedra, 1 singular edges.
 */
#ifndef vtkHexHexMesh_h
#define vtkHexHexMesh_h

#include "hexhexFiltersModule.h"
#include <vtkUnstructuredGridAlgorithm.h>

class HEXHEXFILTERS_EXPORT vtkHexHexMesh : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkHexHexMesh* New();
  vtkTypeMacro(vtkHexHexMesh, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** About so many cells. */
  vtkSetMacro(Cells, double);
  vtkGetMacro(Cells, double);
  /** How a map is made. 0: what fits best, 1: as a polycube, 2: along frames. */
  vtkSetMacro(Method, int);
  vtkGetMacro(Method, int);
  /** Edges where the surface turns by more degrees are edges of the object. */
  vtkSetMacro(FeatureAngle, double);
  vtkGetMacro(FeatureAngle, double);
  /** Cells with a smaller scaled Jacobian are improved until nothing helps. */
  vtkSetMacro(Target, double);
  vtkGetMacro(Target, double);
  /** A layer of cells under the boundary. 0: never, 1: where it makes the mesh better, 2: always. */
  vtkSetMacro(Pillow, int);
  vtkGetMacro(Pillow, int);
  /** Of random decisions, from 0. */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  /** Number of threads, 0 for all cores. */
  vtkSetMacro(Threads, int);
  vtkGetMacro(Threads, int);

protected:
  vtkHexHexMesh();
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs) override;

private:
  vtkHexHexMesh(const vtkHexHexMesh&) = delete;
  void operator=(const vtkHexHexMesh&) = delete;

  double Cells = 10000;
  int Method = 0;
  double FeatureAngle = 40;
  double Target = 0.3;
  int Pillow = 0;
  int Seed = 1;
  int Threads = 0;
};

#endif
