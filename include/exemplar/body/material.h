// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_h
#define exemplar_material_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/body/material_parameters.h>
#include <exemplar/body/orthotropy.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/mesh/msh_file.h>

#include <memory>
#include <utility>
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
    PaintedConstant youngs_modulus = {}, poissons_ratio = {}, density = {}, importance = {};
    /// Fibre direction, in x, y and z; empty: it is not painted.
    std::vector<std::vector<double>> fibre_direction = {};
  };

  /// All regions of a scene by their material ids. `names` is a mesh whose physical groups may give them
  /// their names. Throws UserError for a region that is named by no name of the mesh, or twice.
  std::map<unsigned int, ElasticConstants>
  regions_by_id(const MaterialParameters &parameters, const MshFile &names);

  /// New constants, one for all cells or one a cell; empty: as they are.
  struct ChangedConstants
  {
    std::vector<double> youngs_modulus; ///< [Pa]
    std::vector<double> poissons_ratio; ///< [-]
    std::vector<double> density;        ///< [kg/m^3]
  };

  /// The constants of a region, or of a cell where they are painted.
  struct CellConstants
  {
    CellMaterial<double>                elasticity;
    double                              density;
    double                              youngs_modulus;
    double                              poissons_ratio;    ///< as given, where isotropic
    double                              importance;        ///< factor of Examples/Importance
    std::shared_ptr<const OwnConstants> own;               ///< mostly the same in many cells
    double                              lambda_of_patches; ///< [Pa]
    Orthotropy                          grain;             ///< all of C, in the cell's axes
    double                              lambda_of_others;  ///< what of it patches have taken [Pa]
    bool                                is_orthotropic;    ///< by nine constants

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      OwnConstants numbers;
      if constexpr (Archive::is_saving::value)
        numbers = *own;
      archive &elasticity.lambda &elasticity.mu &density &youngs_modulus &poissons_ratio &importance
          &numbers &lambda_of_patches &grain &lambda_of_others &is_orthotropic;
      if constexpr (Archive::is_loading::value)
        own = std::make_shared<const OwnConstants>(std::move(numbers));
    }
  };

  /// C and C_e of a cell of which the examples have an elasticity of their own, and the eta with which they
  /// are summed up to C' = (1 - eta) C + eta C_e, Eq. (38).
  class BlendedElasticity
  {
  public:
    BlendedElasticity(const CellConstants     &body,
                      const ExampleElasticity &of_examples,
                      double                   eta,
                      const GrainAxes         &axes);

    /// C_e.
    const Orthotropy &
    of_examples() const
    {
      return examples;
    }

    /// C'^-1:eta C_e:E, the strain to which the strain E of an example draws the cell.
    Matrix3<double>
    drawn_strain(const Matrix3<double> &E) const;

    /// Of such a strain D, by how much the energy of the examples is greater than that of D:
    /// (1 - eta) / eta C':C_e^-1:C:D [Pa]; 0 where eta is 0.
    Matrix3<double>
    excess_stress(const Matrix3<double> &D) const;

    /// What patches take of that: lambda of an isotropic material, 0 of another one [Pa].
    double
    excess_of_patches() const;

  private:
    Orthotropy body, examples;
    double     eta;
    GrainAxes  axes;
    bool       body_is_isotropic;
  };

  /// The elastic constants and the density of each cell.
  class Material
  {
  public:
    /// Of no cells.
    Material() = default;

    /// `names` is a mesh whose physical groups may give regions their names; `axes` are those of each cell
    /// where a material has a grain. Throws UserError if
    /// a region is named by a material id that no cell has, by no name of the mesh, or twice, and for
    /// painted constants that are out of range.
    Material(const MaterialParameters        &parameters,
             const std::vector<unsigned int> &material_ids,
             const MshFile                   &names   = {},
             const PaintedMaterial           &painted = {},
             std::vector<GrainAxes>           axes    = {});

    /// Of a material with fibres that around them; of an orthotropic one the isotropic elasticity nearest
    /// to it.
    const CellMaterial<double> &
    elasticity(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].elasticity;
    }

    /// What patches take of its elasticity: lambda of an isotropic one [Pa].
    double
    lambda_of_patches(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].lambda_of_patches;
    }

    /// An estimate of the norm of C [Pa].
    double
    norm_estimate(unsigned int cell) const;

    /// Number k of the Constants of a law.
    double
    number(CellLaw law, unsigned int cell, std::size_t k) const;

    /// A constant that some law adds to those of elasticity.h, by its name.
    double
    own_number(const std::string &name, const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].own->at(name);
    }

    /// With other constants. Throws UserError for numbers that are not one for all or one a cell, or that
    /// are out of range.
    Material
    with(const ChangedConstants &changed) const;

    /// The sum (1 - eta) C + eta C_e of this body's and its examples' elasticity, where these have one
    /// of their own, which must be; eta is `importance` times that of the cell. Another call replaces C_e and
    /// eta. Young's moduli and densities stay those of the body.
    Material
    with_examples(const ExampleElasticity &own, double importance) const;

    /// Whether with_examples() has made it.
    bool
    has_elasticity_of_examples() const
    {
      return of_examples.is_own();
    }

    /// Only then.
    BlendedElasticity
    blend(unsigned int cell) const;

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
      archive &constants &constants_of_cell &axes &stiffnesses;
    }

    double
    density(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].density;
    }

    /// Whether cells differ in it from 1.
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

    /// What set_material() changes of the body alone, without an elasticity of its examples.
    struct BodyConstants
    {
      double youngs_modulus;  ///< [Pa]
      double poissons_ratio;  ///< [-]
      double fibre_stiffness; ///< [Pa]
      bool   is_orthotropic;  ///< by nine constants, of which the others are none
    };

    BodyConstants
    of_body_alone(unsigned int cell) const;

    /// C_e, where it is not the body's.
    const ExampleElasticity &
    elasticity_of_examples() const
    {
      return of_examples;
    }

    /// All of C, in the axes of its grain.
    const Orthotropy &
    grain(const unsigned int cell) const
    {
      return constants[constants_of_cell[cell]].grain;
    }

    /// Zeros where nothing asks for them.
    GrainAxes
    grain_axes(const unsigned int cell) const
    {
      return axes.empty() ? GrainAxes() : axes[cell];
    }

    /// Of the wish to be like the examples [Pa].
    double
    youngs_modulus_of_examples(const unsigned int cell) const
    {
      return of_examples.youngs_modulus.value_or(youngs_modulus(cell));
    }

  private:
    /// Of the law that any C needs: its constants behind Lamé's.
    void
    find_stiffnesses();

    /// Give each cell constants of its own, from `bases`, those of each entry of `constants`.
    void
    paint(const PaintedMaterial &painted, const std::vector<ElasticConstants> &bases);

    std::vector<CellConstants>          constants;
    ExampleElasticity                   of_examples;           ///< where it is their own
    double                              importance_there = 0.; ///< then
    std::vector<CellConstants>          of_body; ///< then, without the examples; else empty
    std::vector<unsigned int>           constants_of_cell;
    std::vector<GrainAxes>              axes;        ///< by cell; empty: isotropic
    std::vector<std::array<double, 22>> stiffnesses; ///< by cell; empty: none is orthotropic
  };
} // namespace Exemplar

#endif
