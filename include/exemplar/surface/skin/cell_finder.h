// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_finder_h
#define exemplar_cell_finder_h

#include <deal.II/base/point.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace Exemplar
{
  class Mesh;

  /// Finds the cell of a mesh at rest in which a point lies.
  class CellFinder
  {
  public:
    /// Keeps a reference to the mesh.
    explicit CellFinder(const Mesh &mesh);

    ~CellFinder();

    /// A cell, and where in it a point lies.
    struct Place
    {
      unsigned int          cell;
      std::array<double, 4> shares; ///< barycentric coordinates, >= 0 to rounding
    };

    /// The cell of a point; nothing if the point is outside the mesh. A point on a face between
    /// cells is in the cell where it lies deepest, of several in the first.
    std::optional<Place>
    find(const dealii::Point<3> &point) const;

  private:
    struct Tree;

    const Mesh                 &mesh;
    const std::unique_ptr<Tree> tree;
  };
} // namespace Exemplar

#endif
