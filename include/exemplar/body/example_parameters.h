// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_parameters_h
#define exemplar_example_parameters_h

#include <exemplar/kernels/elasticity.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;

  /// How the examples' strain enters the energy, Eq. (5).
  enum class ExampleEnergy
  {
    scaled,
    blended,
    mixed
  };

  /// Admissible example weights, or prescribed ones.
  enum class WeightRule
  {
    simplex,
    additive, ///< each between 0 and 1, without a sum
    free,
    prescribed
  };

  /// Whether regions with weights of their own are looked for.
  enum class RegionsOfExamples
  {
    none,
    automatic ///< where the examples strain the body alike and apart from others
  };

  /// The part of the strain that examples act on, Eq. (31).
  enum class ActsOn
  {
    all,
    shape,        ///< the part without change of volume
    volume,       ///< the strain of a pressure
    along_fibres, ///< the strain of a tension along the fibres
    across_fibres ///< the strain without along_fibres
  };

  /// The isotropic elasticity C_e of the examples, Eq. (38); a constant without value is the
  /// material's.
  struct ExampleElasticity
  {
    std::optional<double> youngs_modulus, poissons_ratio; ///< [Pa], [-]

    bool
    is_own() const
    {
      return youngs_modulus || poissons_ratio;
    }

    /// C_e in a material of Young's modulus E [Pa] and Poisson's ratio nu.
    template <typename Number>
    Isotropic<Number>
    isotropic(const Number &E, const Number &nu) const
    {
      return isotropic_of(youngs_modulus ? Number(*youngs_modulus) : E,
                          poissons_ratio ? Number(*poissons_ratio) : nu);
    }
  };

  /// Subsection Examples.
  struct ExampleParameters
  {
    std::vector<std::string> poses;
    double                   attach = 30.; ///< Examples/Attach, of poses that are surfaces
    std::string              pose_functions;
    bool                     include_rest_pose  = true;
    double                   importance         = 0.8; ///< eta
    double                   bending_importance = 1.;  ///< of a shell: factor of eta for curvatures
    std::string              weight_penalty     = "auto";
    ExampleEnergy            energy             = ExampleEnergy::mixed;
    ActsOn                   acts_on            = ActsOn::all;
    std::string              modulus;       ///< Example modulus [Pa]; empty: the material's
    std::string              poisson_ratio; ///< Example Poisson ratio; empty: the material's
    WeightRule               weights = WeightRule::simplex;
    std::string              prescribed_weights;
    std::string              weights_file; ///< of prescribed weights; empty: Prescribed weights
    double                   yield               = 0.; ///< [J/m^3]
    double                   creep_viscosity     = 0.; ///< [J s/m^3]
    bool                     weights_per_region  = false;
    double                   region_blend_length = 0.; ///< [m]
    RegionsOfExamples        regions             = RegionsOfExamples::none;
    std::vector<std::string> weight_maps; ///< FILE:ATTRIBUTE, one a region
    bool in_single_precision = false;     ///< store strains in single precision; no key of scenes

    /// Whether the examples' strains say where weights act.
    bool
    finds_regions() const
    {
      return in_use() && regions == RegionsOfExamples::automatic;
    }

    /// Whether painted maps say where weights act.
    bool
    are_painted() const
    {
      return in_use() && !weight_maps.empty();
    }

    void
    declare(KeyTable &keys);

    /// Whether the weights are unknowns within bounds.
    bool
    are_bounded() const
    {
      return weights == WeightRule::simplex || weights == WeightRule::additive;
    }

    /// Whether the rest pose is an example. Additive keys are added to it, and it has no weight.
    bool
    has_rest_pose() const
    {
      return include_rest_pose && weights != WeightRule::additive;
    }

    /// Number by which users know the first example, as in weight_0: 0 is kept for the rest pose
    /// where keys are added to it.
    unsigned int
    first_number() const
    {
      return weights == WeightRule::additive ? 1 : 0;
    }

    /// Whether examples need fibre directions.
    bool
    need_fibres() const
    {
      return in_use() && (acts_on == ActsOn::along_fibres || acts_on == ActsOn::across_fibres);
    }

    /// C_e of Eq. (38); without values where no examples are in use. Throws UserError for an invalid constant.
    ExampleElasticity
    elasticity() const;

    /// Whether any pose is given and its importance is not 0.
    bool
    in_use() const;

    /// Number of examples, including the rest pose if it is one.
    std::size_t
    n_examples() const;

    /// Coefficient sigma [J] of the ridge on the weights; `unit_energy` is sum E V [J].
    double
    ridge(double unit_energy) const;

    /// Throws UserError for what a pattern of the keys cannot exclude.
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
