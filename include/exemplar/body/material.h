// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_h
#define exemplar_material_h

#include <exemplar/body/material_parameters.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/mesh/msh_file.h>

#include <set>
#include <vector>

namespace Exemplar
{
  /// Values of a constant that is painted, one a cell; empty: it is not.
  struct PaintedConstant
  {
    std::vector<double> values;
    bool                is_factor = true; ///< of what the scene says, or instead of it
  };

  /// The constants that a scene paints on its surface; one without values is not painted.
  struct PaintedMaterial
  {
    PaintedConstant youngs_modulus, poissons_ratio, density;
  };

  /// The elastic constants and the density of each cell.
  class Material
  {
  public:
    /// `names` is a mesh whose physical groups may give regions their names. Throws UserError if
    /// a region is named by a material id that no cell has (or, where `regions` is not null, that
    /// is not there), by no name of the mesh, or twice, and for painted constants that are out of
    /// range.
    Material(const MaterialParameters        &parameters,
             const std::vector<unsigned int> &material_ids,
             const MshFile                   &names   = {},
             const PaintedMaterial           &painted = {},
             const std::set<unsigned int>    *regions = nullptr);

    const CellMaterial<double> &
    elasticity(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].elasticity;
    }

    /// Number k of the Constants of a law.
    double
    number(CellLaw law, unsigned int cell, std::size_t k) const;

    /// What is left of it in cells of which the volume part of the energy is that of patches.
    Material
    without_dilatation() const;

    double
    density(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].density;
    }

    double
    youngs_modulus(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].youngs_modulus;
    }

  private:
    /// The constants of a region, or of a cell where they are painted.
    struct Constants
    {
      CellMaterial<double> elasticity;
      double               density;
      double               youngs_modulus;
      OwnConstants         own;
    };

    void
    add(const ElasticConstants &values);

    /// Give each cell constants of its own, from `bases`, those of each entry of `constants`.
    void
    paint(const PaintedMaterial &painted, const std::vector<ElasticConstants> &bases);

    std::vector<Constants>    constants;
    std::vector<unsigned int> constants_of_cell;
  };
} // namespace Exemplar

#endif
