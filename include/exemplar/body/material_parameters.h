// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_material_parameters_h
#define exemplar_material_parameters_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/prm/assignments.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;
  struct Selection;

  /// Values by name of the constants that laws have beside those of elasticity.h.
  using OwnConstants = std::map<std::string, double>;

  /// Their default values.
  OwnConstants
  default_own_constants();

  /// Materials whose constants are known by a name; an index of the table of material_parameters.cc.
  enum class MaterialPreset : unsigned int
  {
    none
  };

  /// The constants of a material as a scene gives them.
  struct ElasticConstants
  {
    MaterialPreset preset = MaterialPreset::none; ///< stands behind the three below

    double youngs_modulus = 1e6;  ///< E [Pa]
    double poissons_ratio = 0.45; ///< nu [-]
    double density        = 1000; ///< rho [kg/m^3]

    OwnConstants own = default_own_constants();

    double importance = 1; ///< factor of Examples/Importance [-]

    std::string fibre_direction = {}; ///< formulas of x, y, z, or "from SELECTION to SELECTION"
    std::string cross_direction = {}; ///< formulas; empty: any that is perpendicular
    std::string orthotropy      = {}; ///< nine numbers; empty: isotropic

    std::string fibre_tension       = "0"; ///< T [Pa], a formula of x, y, z and t
    std::string fibre_tension_curve = {};  ///< see TensionCurve; empty: constant

    double thickness = 0.; ///< of a shell [m]; 0: not given

    /// Whether the elasticity of cells has material axes.
    bool
    has_grain() const;

    /// Whether cells have active fibres: a Fibre tension other than the number 0.
    bool
    has_tension() const;

    /// Whether cells need material axes: they have a grain, or active fibres.
    bool
    has_fibres() const
    {
      return has_grain() || has_tension();
    }
  };

  /// Whether the masses of neighbouring nodes are coupled, or lumped at the nodes.
  enum class MassMatrix
  {
    consistent,
    lumped
  };

  constexpr double least_thickness = 1e-6; ///< of a shell [m]

  /// That a key, or what it leaves to regions, makes a shell thinner than that.
  std::string
  too_thin_text(const std::string &key, double thickness);

  /// Subsection Material.
  struct MaterialParameters
  {
    ElasticConstants everywhere;
    MassMatrix       mass_matrix      = MassMatrix::consistent;
    double           volume_stiffness = 0.;                 ///< of what a shell encloses [Pa]
    std::map<unsigned int, ElasticConstants> regions;       ///< regions by material id
    std::map<std::string, ElasticConstants>  named_regions; ///< regions by name, as in the scene
    /// Painted maps, each with its mode of use; empty: none.
    std::string youngs_modulus_map, poissons_ratio_map, density_map, thickness_map, importance_map,
        fibre_tension_map;
    std::vector<std::string> fibre_direction_maps; ///< maps of x, y and z; empty: none

    bool
    is_painted() const
    {
      return !youngs_modulus_map.empty() || !poissons_ratio_map.empty() || !density_map.empty()
             || !thickness_map.empty() || !fibre_direction_maps.empty() || !importance_map.empty()
             || !fibre_tension_map.empty();
    }

    /// Whether the importance factor differs between cells.
    bool
    importance_varies() const;

    /// The law of corotational cells for these constants; none: isotropic.
    std::optional<CellLaw>
    law_of_grain() const;

    /// The assignments with, in front of them, those that "Preset = NAME" in Material and its regions stands for: keys
    /// beside it, which come later, win.
    static std::vector<Assignment>
    with_presets(const std::vector<Assignment> &assignments);

    /// What Preset stands for, in a sentence for each section that has one of its own.
    std::vector<std::string>
    describe_presets() const;

    /// Whether some section has active fibres.
    bool
    has_tension() const;

    /// Whether some section needs material axes.
    bool
    has_fibres() const;

    /// All selections that fibre directions go from or to, each with its key.
    std::vector<std::pair<Selection, std::string>>
    selections() const;

    /// Call function(constants, "Material/..." or the like) for each subsection.
    template <typename Function>
    void
    for_each_section(const Function &function) const
    {
      function(everywhere, std::string("Material"));
      for (const auto &[id, constants] : regions)
        function(constants, "Material/" + region_name(id));
      for (const auto &[name, constants] : named_regions)
        function(constants, "Material/" + region_name(name));
    }

    /// Whether a constant that some law adds, by its name, is greater than 0 in some section.
    bool
    has(const std::string &constant) const;

    /// Whether some cells have a constant that may choose their law, ModelTraits::chosen_by.
    bool
    chooses_laws() const;

    void
    declare(KeyTable &keys);

    /// Declare subsections "region N" and "region NAME"; what they do not set is as everywhere.
    void
    declare_regions(KeyTable                     &keys,
                    const std::set<unsigned int> &ids,
                    const std::set<std::string>  &names);

    /// The subsection of a material id.
    static std::string
    region_name(unsigned int id);

    /// The subsection of a region with a name.
    static std::string
    region_name(const std::string &name);

    /// Throws UserError for a Poisson's ratio outside (-1, 0.5).
    void
    check() const;
  };
} // namespace Exemplar

#endif
