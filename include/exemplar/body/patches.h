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
    /// The patch of each cell of a whole body, numbered from 0 on. Quadratic elements have one for each
    /// cell, linear ones stars of nodes: the node with the most cells that have no patch yet takes these,
    /// first as long as they are 18 or more, then 9. In between and at the end cells that are left join a
    /// patch with which they share a face, first if all their nodes are nodes of the patch. Nodes
    /// with equally many cells are taken in the order of their numbers. A patch lies in one region,
    /// and its Lamé constants lambda, where they are painted, within a factor of two.
    static std::vector<unsigned int>
    choose(const Mesh &mesh, const Material &material, Element element);

    /// None: cells know their own dilatation.
    Patches() = default;

    /// Those that choose() has found: the one of each cell of this process, numbered from 0 on without
    /// gaps; none if there are no numbers.
    Patches(const std::vector<unsigned int> &of_cells,
            const FESpace                   &fe_space,
            const Material                  &material);

    /// What of a material is the cells' own, beside the dilatation of patches.
    Material
    rest_of(const Material &material) const
    {
      return size() > 0 ? material.without_dilatation() : material;
    }

    /// The cells have other constants. Which cells make a patch stays.
    void
    set_material(const FESpace &fe_space, const Material &material);

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

    /// lambda_p V_p [J].
    double
    stiffness(const unsigned int patch) const
    {
      return lambda(patch) * volume(patch);
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
    std::vector<unsigned int>              patch_of_point;
    std::vector<std::vector<unsigned int>> points_of_patch;
    std::vector<double>                    volumes;
    std::vector<double>                    lambdas;
  };
} // namespace Exemplar

#endif
