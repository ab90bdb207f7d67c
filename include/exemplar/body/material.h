// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_h
#define exemplar_material_h

#include <exemplar/kernels/elasticity.h>

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <set>
#include <vector>

namespace Exemplar
{
  struct ElasticConstants
  {
    double youngs_modulus = 1e6;  ///< E [Pa]
    double poissons_ratio = 0.45; ///< nu [-]
    double density        = 1000; ///< rho [kg/m^3]
  };

  enum class MassMatrix
  {
    consistent,
    lumped
  };

  /// Subsection Material.
  struct MaterialParameters
  {
    ElasticConstants                         everywhere;
    MassMatrix                               mass_matrix = MassMatrix::consistent;
    std::map<unsigned int, ElasticConstants> regions; ///< by material id

    void
    declare(dealii::ParameterHandler &prm);

    /// Declare subsections "region N"; what they do not set is as everywhere.
    void
    declare_regions(dealii::ParameterHandler &prm, const std::set<unsigned int> &ids);

    /// Throws UserError for a Poisson's ratio outside (-1, 0.5).
    void
    check() const;
  };

  /// The elastic constants and the density of each cell.
  class Material
  {
  public:
    /// Throws UserError if a region names a material id that no cell has.
    Material(const MaterialParameters &parameters, const std::vector<unsigned int> &material_ids);

    const CellMaterial<double> &
    elasticity(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].elasticity;
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
    struct Constants
    {
      CellMaterial<double> elasticity;
      double               density;
      double               youngs_modulus;
    };

    std::vector<Constants>    constants;
    std::vector<unsigned int> constants_of_cell;
  };
} // namespace Exemplar

#endif
