// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patches_h
#define exemplar_patches_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// Disjoint patches that hold all quadrature points. In a patch the volume part of the energy
  /// knows one mean dilatation, Eq. (25), and not that of each point, which tetrahedra cannot keep
  /// small one by one. Of quadratic elements the points of a cell are a patch, of linear ones the
  /// cells of a star are.
  class Patches
  {
  public:
    /// Stars of nodes: the node with the most cells that have no patch yet takes these, first as
    /// long as they are 18 or more, then 9. In between and at the end cells that are left join a
    /// patch with which they share a face, first if all their nodes are nodes of the patch. Nodes
    /// with equally many cells are taken in the order of their numbers. A patch lies in one region,
    /// and its Lamé constants lambda, where they are painted, within a factor of two.
    Patches(const Mesh &mesh, const FESpace &fe_space, const Material &material);

    /// Those that stars() has chosen in the whole body: the one of each cell of this process, numbered
    /// from 0 on without gaps; of quadratic elements there are none.
    Patches(const std::vector<unsigned int> &stars_of_cells,
            const FESpace                   &fe_space,
            const Material                  &material);

    /// The patch of each cell, of linear elements on the cells of a mesh with as many nodes.
    static std::vector<unsigned int>
    stars(const std::vector<std::array<unsigned int, 4>> &cells,
          unsigned int                                    n_nodes,
          const std::vector<unsigned int>                &material_ids,
          const Material                                 &material);

    unsigned int
    size() const
    {
      return volumes.size();
    }

    unsigned int
    of_point(const unsigned int point) const
    {
      return patch_of_point[point];
    }

    /// Its quadrature points, in ascending order.
    const std::vector<unsigned int> &
    points(const unsigned int patch) const
    {
      return points_of_patch[patch];
    }

    /// At rest [m^3].
    double
    volume(const unsigned int patch) const
    {
      return volumes[patch];
    }

    /// The mean over its volume [Pa].
    double
    lambda(const unsigned int patch) const
    {
      return lambdas[patch];
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    collect(const FESpace &fe_space, const Material &material);

    std::vector<unsigned int>              patch_of_point;
    std::vector<std::vector<unsigned int>> points_of_patch;
    std::vector<double>                    volumes;
    std::vector<double>                    lambdas;
  };
} // namespace Exemplar

#endif
