// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_parameters_h
#define exemplar_example_parameters_h

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;

  /// How the blended strain acts, Eq. (5).
  enum class ExampleEnergy
  {
    scaled,
    blended,
    mixed
  };

  /// Which weights are allowed, and who finds them.
  enum class WeightRule
  {
    simplex,
    free,
    prescribed
  };

  /// Which strains of the body are to be like those of the examples.
  enum class ActsOn
  {
    all,
    shape,        ///< without change of volume
    volume,       ///< what a pressure makes
    along_fibres, ///< what a tension along them makes
    across_fibres ///< all but that
  };

  /// The isotropic elasticity of the wish to be like the examples; a constant that is absent is the
  /// material's.
  struct ExampleElasticity
  {
    std::optional<double> youngs_modulus, poissons_ratio; ///< [Pa], [-]

    bool
    is_own() const
    {
      return youngs_modulus || poissons_ratio;
    }
  };

  /// Subsection Examples.
  struct ExampleParameters
  {
    std::vector<std::string> poses;
    double                   attach = 30.; ///< of poses that are surfaces
    std::string              pose_functions;
    bool                     include_rest_pose = true;
    double                   importance        = 0.8; ///< eta
    std::string              weight_penalty    = "auto";
    ExampleEnergy            energy            = ExampleEnergy::mixed;
    ActsOn                   acts_on           = ActsOn::all;
    std::string              modulus;       ///< Example modulus [Pa]; empty: the material's
    std::string              poisson_ratio; ///< Example Poisson ratio; empty: the material's
    WeightRule               weights = WeightRule::simplex;
    std::string              prescribed_weights;
    double                   yield               = 0.; ///< [J/m^3]
    double                   creep_viscosity     = 0.; ///< [J s/m^3]
    bool                     weights_per_region  = false;
    double                   region_blend_length = 0.; ///< [m]
    std::vector<std::string> weight_maps;              ///< FILE:ATTRIBUTE, one a region
    bool in_single_precision = false; ///< strains, where steps need no more; no key of scene files

    /// Whether painted maps say where weights act.
    bool
    are_painted() const
    {
      return in_use() && !weight_maps.empty();
    }

    void
    declare(KeyTable &keys);

    /// Whether they need to know where fibres lie.
    bool
    need_fibres() const
    {
      return in_use() && (acts_on == ActsOn::along_fibres || acts_on == ActsOn::across_fibres);
    }

    /// C_e of Eq. (38). Throws UserError for what is no such constant.
    ExampleElasticity
    elasticity() const;

    /// Whether any pose is given and its importance is not 0.
    bool
    in_use() const;

    /// How many examples there are, the rest pose among them where it is included.
    std::size_t
    n_examples() const;

    /// sigma [J] of the ridge on the weights; `unit_energy` is sum E V [J].
    double
    ridge(double unit_energy) const;

    /// Throws UserError for what no pattern can tell.
    void
    check() const;

  private:
    void
    check_memory() const;

    void
    check_elasticity() const;
  };
} // namespace Exemplar

#endif
