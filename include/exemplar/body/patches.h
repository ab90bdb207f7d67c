// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patches_h
#define exemplar_patches_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// A partition of all quadrature points into patches. The volume part of the energy takes one
  /// mean dilatation a patch, Eq. (25), instead of that of each point, which locks in tetrahedra.
  /// In quadratic elements the points of a cell are a patch, in linear ones the cells of a star.
  class Patches
  {
  public:
    /// Choose the patch of each cell of a whole body, numbered from 0 on. Quadratic elements have
    /// one for each cell, linear ones stars of nodes: repeatedly the node with the most cells
    /// without a patch takes these, first as long as they are 18 or more, then 9. In between and at
    /// the end the remaining cells join a patch with which they share a face, first if all their
    /// nodes are nodes of the patch. Ties are resolved by the numbers of the nodes. A patch lies in
    /// one region, and its Lamé constants lambda, where they are painted, within a factor of two.
    static std::vector<unsigned int>
    choose(const Mesh &mesh, const Material &material, Element element);

    /// No patches: cells have their own dilatation.
    Patches() = default;

    /// The patches of choose(): that of each cell of this process, numbered from 0 on without gaps;
    /// empty: none.
    Patches(const std::vector<unsigned int> &of_cells,
            const FESpace                   &fe_space,
            const Material                  &material);

    /// The material of the cells' own energy, without the part of the patches.
    Material
    rest_of(const Material &material) const
    {
      return size() > 0 ? material.without_dilatation() : material;
    }

    /// Replace the constants; the partition stays.
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

    /// Quadrature points of a patch, ascending.
    const std::vector<unsigned int> &
    points(const unsigned int patch) const
    {
      return points_of_patch[patch];
    }

    /// Volume of a patch at rest [m^3].
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

    /// Mean of lambda over the volume of a patch [Pa].
    double
    lambda(const unsigned int patch) const
    {
      return lambdas[patch];
    }

    /// Memory in bytes.
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
