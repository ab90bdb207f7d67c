// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_h
#define exemplar_material_h

#include <exemplar/body/cell_elasticity.h>
#include <exemplar/body/example_parameters.h>
#include <exemplar/body/material_parameters.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/mesh/msh_file.h>

#include <memory>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Values of a painted constant, one a cell; empty: not painted.
  struct PaintedConstant
  {
    std::vector<double> values;
    bool                is_factor = true; ///< whether values multiply those of the scene
  };

  /// The constants that a scene paints on its surface; those without values are not painted.
  struct PaintedMaterial
  {
    PaintedConstant youngs_modulus = {}, poissons_ratio = {}, density = {}, importance = {};
    PaintedConstant fibre_tension = {}, thickness = {};
    /// Fibre direction, components x, y and z; empty: not painted.
    std::vector<std::vector<double>> fibre_direction = {};
  };

  /// Constants of all regions of a scene by material id. `names` is a mesh whose physical groups
  /// may name regions. Throws UserError for a name that the mesh does not have, or a region that is
  /// set twice.
  std::map<unsigned int, ElasticConstants>
  regions_by_id(const MaterialParameters &parameters, const MshFile &names);

  /// New constants, one for all cells or one a cell; empty: unchanged.
  struct ChangedConstants
  {
    std::vector<double> youngs_modulus; ///< [Pa]
    std::vector<double> poissons_ratio; ///< [-]
    std::vector<double> density;        ///< [kg/m^3]
  };

  /// The constants of a region, or of a cell where they are painted.
  struct CellConstants
  {
    CellElasticity<double>              whole;      ///< C
    CellMaterial<double>                elasticity; ///< of cells, less what patches have taken
    double                              density;
    double                              youngs_modulus;
    double                              poissons_ratio;   ///< input value, where isotropic
    double                              importance;       ///< factor of Examples/Importance
    std::shared_ptr<const OwnConstants> own;              ///< shared by many cells
    double                              lambda_of_others; ///< lambda that patches have taken [Pa]

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      OwnConstants numbers;
      if constexpr (Archive::is_saving::value)
        numbers = *own;
      archive &whole &elasticity.lambda                                     &elasticity
          .mu &density &youngs_modulus &poissons_ratio &importance &numbers &lambda_of_others;
      if constexpr (Archive::is_loading::value)
        own = std::make_shared<const OwnConstants>(std::move(numbers));
    }
  };

  /// What scenes say of the tension of fibres, by cell.
  struct FibreTensions
  {
    /// Of a section of Material.
    struct Source
    {
      std::string section, formula, curve; ///< see ElasticConstants

      /// What hands and programs call it: the region of Material, or "Material".
      std::string
      region() const
      {
        const std::string prefix = "Material/region ";
        return section.rfind(prefix, 0) == 0 ? section.substr(prefix.size()) : section;
      }

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        archive &section &formula &curve;
      }
    };

    std::vector<Source>       sources;
    std::vector<unsigned int> of_cells; ///< 1 + index of the source; 0: no tension; empty: none has
    std::vector<double>       factors;  ///< painted, by cell; empty: 1

    FibreTensions
    part(const std::vector<unsigned int> &cells) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &sources &of_cells &factors;
    }
  };

  /// The elastic constants and the density of each cell.
  class Material
  {
  public:
    /// The material of no cells.
    Material() = default;

    /// `names` is a mesh whose physical groups may name regions; `axes` are those of each cell
    /// where a material has a grain. Throws UserError for a region whose material id no cell has,
    /// whose name the mesh does not have, or that is set twice, and for painted constants out of
    /// range.
    Material(const MaterialParameters        &parameters,
             const std::vector<unsigned int> &material_ids,
             const MshFile                   &names   = {},
             const PaintedMaterial           &painted = {},
             std::vector<GrainAxes>           axes    = {});

    /// Lamé's constants: of a material with fibres, those of the matrix around them; of an
    /// orthotropic one, those of the nearest isotropic elasticity.
    const CellMaterial<double> &
    elasticity(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].elasticity;
    }

    /// The part of C that patches take: lambda of an isotropic material [Pa].
    double
    lambda_of_patches(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].whole.lambda_of_patches();
    }

    /// An estimate of the norm of C [Pa].
    double
    norm_estimate(unsigned int cell) const;

    /// Constant k of a law, in the order of its Constants.
    double
    number(CellLaw law, unsigned int cell, std::size_t k) const;

    /// A constant that a law has beside those of elasticity.h, by name.
    double
    own_number(const std::string &name, const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].own->at(name);
    }

    /// A copy with other constants. Throws UserError for numbers that are not one for all or one a
    /// cell, or that are out of range.
    Material
    with(const ChangedConstants &changed) const;

    /// A copy with the elasticity C' = (1 - eta) C + eta C_e of the body and its examples,
    /// Eq. (38); eta is `importance` times that of the cell. Requires that C_e is the examples'
    /// own. Another call replaces C_e and eta. Young's moduli and densities stay those of the body.
    Material
    with_examples(const ExampleElasticity &own, double importance) const;

    /// Whether this was made by with_examples().
    bool
    has_elasticity_of_examples() const
    {
      return of_examples.is_own();
    }

    /// C and C_e of a cell. Requires has_elasticity_of_examples().
    BlendedElasticity<double>
    blend(unsigned int cell) const;

    /// A copy without the volume part of the energy that belongs to patches.
    Material
    without_dilatation() const;

    /// The material of these cells, in their order.
    Material
    part(const std::vector<unsigned int> &cells) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &constants &constants_of_cell &axes &stiffnesses &fibre_tensions &stiffness_of_volume;
    }

    double
    density(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].density;
    }

    /// Whether the importance() of some cell is not 1.
    bool
    importance_varies() const;

    /// Factor of Examples/Importance.
    double
    importance(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].importance;
    }

    double
    youngs_modulus(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].youngs_modulus;
    }

    /// Constants of the body without the elasticity of its examples.
    const CellConstants &
    of_body_alone(const unsigned int cell) const
    {
      return (has_elasticity_of_examples() ? of_body : constants)[constants_of_cell[cell]];
    }

    /// C_e; without values where it is the body's.
    const ExampleElasticity &
    elasticity_of_examples() const
    {
      return of_examples;
    }

    /// C_e, or C where that is the examples' elasticity.
    CellElasticity<double>
    whole_of_examples(unsigned int cell) const;

    /// Axes of a cell; zeros where no material needs them.
    GrainAxes
    grain_axes(const unsigned int cell) const
    {
      return axes.empty() ? GrainAxes() : axes[cell];
    }

    /// How fibres pull; nothing if none does.
    const FibreTensions &
    tensions() const
    {
      return fibre_tensions;
    }

    /// What the volume that a closed shell encloses resists [Pa]; 0: nothing.
    double
    volume_stiffness() const
    {
      return stiffness_of_volume;
    }

    /// Young's modulus of C_e [Pa].
    double
    youngs_modulus_of_examples(const unsigned int cell) const
    {
      return of_examples.youngs_modulus.value_or(youngs_modulus(cell));
    }

  private:
    /// Compute the constants beyond Lamé's of the law of general anisotropy, by cell.
    void
    find_stiffnesses();

    /// Give each cell its own constants, from `bases`, the constants of each entry of `constants`.
    void
    paint(const PaintedMaterial &painted, const std::vector<ElasticConstants> &bases);

    std::vector<CellConstants>          constants;
    ExampleElasticity                   of_examples;           ///< C_e; without values: the body's
    double                              importance_there = 0.; ///< Examples/Importance with it
    std::vector<CellConstants>          of_body; ///< `constants` without C_e; may be empty
    std::vector<unsigned int>           constants_of_cell;
    std::vector<GrainAxes>              axes;        ///< material axes by cell; empty: isotropic
    std::vector<std::array<double, 22>> stiffnesses; ///< numbers of C by cell; may be empty
    FibreTensions                       fibre_tensions;
    double                              stiffness_of_volume = 0.; ///< [Pa]
  };
} // namespace Exemplar

#endif
