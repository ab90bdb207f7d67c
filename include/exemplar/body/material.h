// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_h
#define exemplar_material_h

#include <exemplar/body/material_parameters.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/mesh/msh_file.h>

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

  /// New constants, one for all cells or one a cell; empty: as they are.
  struct ChangedConstants
  {
    std::vector<double> youngs_modulus; ///< [Pa]
    std::vector<double> poissons_ratio; ///< [-]
    std::vector<double> density;        ///< [kg/m^3]
  };

  /// The elastic constants and the density of each cell.
  class Material
  {
  public:
    /// Of no cells.
    Material() = default;

    /// `names` is a mesh whose physical groups may give regions their names. Throws UserError if
    /// a region is named by a material id that no cell has, by no name of the mesh, or twice, and for
    /// painted constants that are out of range.
    Material(const MaterialParameters        &parameters,
             const std::vector<unsigned int> &material_ids,
             const MshFile                   &names   = {},
             const PaintedMaterial           &painted = {});

    const CellMaterial<double> &
    elasticity(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].elasticity;
    }

    /// Number k of the Constants of a law.
    double
    number(CellLaw law, unsigned int cell, std::size_t k) const;

    /// A constant that some law adds to those of elasticity.h, by its name.
    double
    own_number(const std::string &name, const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].own.at(name);
    }

    /// With other constants. Throws UserError for numbers that are not one for all or one a cell, or that
    /// are out of range.
    Material
    with(const ChangedConstants &changed) const;

    /// What is left of it in cells of which the volume part of the energy is that of patches.
    Material
    without_dilatation() const;

    /// That of these cells, in their order.
    Material
    part(const std::vector<unsigned int> &cells) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &constants &constants_of_cell;
    }

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

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        archive &elasticity.lambda &elasticity.mu &density &youngs_modulus &own;
      }
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
