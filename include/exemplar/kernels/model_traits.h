// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_model_traits_h
#define exemplar_model_traits_h

#include <array>
#include <cstddef>
#include <limits>

namespace Exemplar
{
  /// A constant of a law beside those of elasticity.h: a key of Material and of its regions.
  struct LawConstant
  {
    const char *name;
    const char *documentation; ///< text for users, with the unit
    double      value;         ///< default
    double      min = 0.;
    double      max = std::numeric_limits<double>::max();
  };

  /// Constants of the examples that are the same in all cells, as opposed to target strains.
  template <typename Number>
  struct ExampleNumbers
  {
    Number guard_bound = Number(0.8); ///< p_0 of Eq. (16); the guard acts for p < p_0
    Number importance  = Number(0.);  ///< eta; 0 without examples
  };

  using ExampleConstants = ExampleNumbers<double>;

  /// What a law may have no place beside: in a scene, or in the section of Material that chooses the law.
  enum class Beside
  {
    interpolation, ///< Scene = interpolation
    statics,       ///< Scene = static
    other_strain, ///< Model/Strain other than corotational, or Model/Gradient other than consistent
    grain,        ///< fibres or orthotropy in some section
    fibres,       ///< Fibre stiffness in the same section
    orthotropy,   ///< Orthotropy in the same section
    memory,       ///< a law that remembers, in some section
    other_memory, ///< another law that remembers, in the same section
    unblended_examples, ///< examples with an Energy other than blended
    own_elasticity,     ///< examples with an elasticity of their own
    varying_importance  ///< examples with an importance that differs between cells
  };

  /// A combination that a law refuses.
  struct Refusal
  {
    Beside beside;

    /// Behind the law's key, with the remedy; {} stands for the assignment without which no cell has
    /// the law.
    const char *words;

    /// Refused only where this constant of the law is greater than 0, and its key stands for the
    /// law's.
    const char *constant = nullptr;
  };

  /// The row of a law that takes examples with the elasticity of the material alone.
  inline constexpr Refusal no_own_elasticity = {
    Beside::own_elasticity,
    " is for examples with the elasticity of the material. Remove Examples/Example modulus and "
    "Example Poisson ratio, or set {}."
  };

  /// Properties of a law of cells, beside its formulas; each law has them as a constant `traits`.
  struct ModelTraits
  {
    /// Name of the law; its value of Model/Strain where is_strain().
    const char *name;

    /// The strain measure, for the documentation of Model/Strain; empty for a law that other keys
    /// choose.
    const char *strain;

    /// Whether R is the rotation of F. In laws without rotations R is I, and P = R (R^T P) holds,
    /// too.
    bool has_rotations;

    /// Whether the energy contains the guard phi of Eq. (16), which acts in badly inverted cells.
    bool has_guard;

    /// Whether the energy has the kink described in stretch_guard.h, for the elasticity of
    /// Material, and its guard, Eq. (24).
    bool has_stretch_guard;

    /// Whether R K R^T, Eq. (8), is the exact derivative of the force.
    bool exact_is_rotated;

    /// Whether R K R^T is the convex, positive semidefinite tangent. Otherwise make_convex() turns
    /// response() into one.
    bool convex_is_rotated;

    /// Whether the derivative of tr(e) by F is R. Then patches of cells may have the volume part of
    /// the energy, Eq. (25).
    bool trace_gradient_is_R;

    /// Whether the energy without examples is invariant under rotations of the body.
    bool is_frame_indifferent;

    /// Number of history variables at each point; their initial values are 0. Such a law also has
    /// the members remember(), new_history(), inelastic_density() and energy(), see make_cell(),
    /// advance_history() and evaluate() of the loops.
    std::size_t n_history = 0;

    static constexpr std::size_t not_remembered = std::numeric_limits<std::size_t>::max();

    /// Index in the history of the equivalent plastic strain, which frames show.
    std::size_t plastic_strain = not_remembered;

    /// Index in the history of the dissipated energy density, the plastic work [J/m^3].
    std::size_t dissipated = not_remembered;

    /// Whether the energy depends on J = det F beside the strain. Then patches may have its volume
    /// part, as a function of their mean of J, Eq. (37). Such a law has the member
    /// add_volume_pressure().
    bool has_volumetric_energy = false;

    /// Names of the constants, at most two, whose positive values select this law for a cell; the
    /// last law selected applies. None: selected by other keys.
    std::array<const char *, 2> chosen_by = { {} };

    /// Whether patches have the terms of Eq. (26), for far stretched cells.
    constexpr bool
    has_guard_of_patches() const
    {
      return has_stretch_guard || has_volumetric_energy;
    }

    /// Whether the law is a value of Model/Strain.
    constexpr bool
    is_strain() const
    {
      return *strain != '\0';
    }
  };

  /// The traits of a law that is selected where these constants are positive.
  constexpr ModelTraits
  chosen_by(ModelTraits traits, const char *first, const char *second = nullptr)
  {
    traits.chosen_by = { { first, second } };
    return traits;
  }
} // namespace Exemplar

#endif
