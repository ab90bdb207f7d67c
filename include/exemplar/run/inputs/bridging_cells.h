// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_bridging_cells_h
#define exemplar_bridging_cells_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/mesh/mesh.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Cells of a body that an example stretches more than ten times. They connect parts of the surface that the pose
  /// separates, as closed lips, and would hold these together.
  struct BridgingCells
  {
    /// Factor of Young's modulus in each cell, about 1 over the square of the greatest stretch; 1 in other cells. Empty
    /// without such cells.
    std::vector<double> factors;

    std::string warning;
  };

  /// Looks at the poses of Examples/Poses. Powers of two make the factors, so that small changes of poses do not
  /// change them. For tetrahedra, of a single process; of a shell none are found.
  BridgingCells
  find_bridging_cells(const ExampleParameters &examples, const Mesh &mesh, const NamedPoses &poses);
} // namespace Exemplar

#endif
