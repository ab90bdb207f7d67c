// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_model_traits_h
#define exemplar_model_traits_h

#include <array>
#include <cstddef>
#include <limits>

namespace Exemplar
{
  /// A constant that a law adds to those of elasticity.h: a key of Material and of its regions.
  struct LawConstant
  {
    const char *name;
    const char *documentation; ///< with its unit
    double      value;         ///< unless a scene says another
    double      min = 0.;
    double      max = std::numeric_limits<double>::max();
  };

  /// What a law knows of all examples, beside the target strains that they ask of its cells.
  struct ExampleConstants
  {
    double guard_bound = 0.8; ///< p_0 of Eq. (16), below which the guard acts
    double importance  = 0.;  ///< eta; 0 without examples
  };

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
    Beside      beside;
    const char *words; ///< behind the law's key, with the remedy; {} stands for that key
    const char *constant
        = nullptr; ///< refused only where this constant of the law is greater than 0, and its key
                   ///< stands for the law's
  };

  /// What distinguishes the models of a cell, beside their formulas. Each model has a constant
  /// `traits`.
  struct ModelTraits
  {
    /// What scenes call it, as the value of Model/Strain or Model/Gradient.
    const char *name;

    /// Its strain measure, for the documentation of Model/Strain; empty for a law that is chosen by
    /// Model/Gradient or Material.
    const char *strain;

    /// R is the rotation of F. In models without rotations it is I, and P = R (R^T P) holds, too.
    bool has_rotations;

    /// The energy contains the guard phi of Eq. (16), which acts in badly inverted cells.
    bool has_guard;

    /// The energy has the kink of stretch_guard.h by the elasticity of Material, and its guard, Eq. (24).
    bool has_stretch_guard;

    /// R K R^T, Eq. (8), is the derivative of the force.
    bool exact_is_rotated;

    /// R K R^T is the tangent that is never indefinite. Else make_convex() turns response() into
    /// that.
    bool convex_is_rotated;

    /// The derivative of tr(e) by F is R. Then the volume part of the energy may be that of patches of
    /// cells, Eq. (25).
    bool trace_gradient_is_R;

    /// The energy without examples stays as it is when the body turns.
    bool turns_freely;

    /// Numbers that it remembers at each point from step to step; 0 at the beginning. Such a law has
    /// the members remember(), new_history(), inelastic_density() and energy() as well, see make_cell(),
    /// advance_history() and evaluate() of the loops.
    std::size_t n_history = 0;

    static constexpr std::size_t not_remembered = std::numeric_limits<std::size_t>::max();

    /// Index in the history of the equivalent plastic strain that frames show.
    std::size_t plastic_strain = not_remembered;

    /// Index in the history of the dissipated energy density [J/m^3].
    std::size_t dissipated = not_remembered;

    /// It has an energy of J = det F beside that of the strain. Then the volume part of that energy may be
    /// one of the mean of J, Eq. (37), in patches. Such a law has the member add_volume_pressure().
    bool knows_volume = false;

    /// The constants, at most two, whose values above 0 give a cell this law; of several such laws it has the
    /// last. None: something else chooses it.
    std::array<const char *, 2> chosen_by = { {} };

    /// Whether patches have its part of Eq. (26): what is stretched far of the trace of the strain.
    constexpr bool
    has_guard_of_patches() const
    {
      return has_stretch_guard || knows_volume;
    }

    /// Whether it is a value of Model/Strain.
    constexpr bool
    is_strain() const
    {
      return *strain != '\0';
    }
  };

  /// Those of a law that cells have where these constants are greater than 0.
  constexpr ModelTraits
  chosen_by(ModelTraits traits, const char *first, const char *second = nullptr)
  {
    traits.chosen_by = { { first, second } };
    return traits;
  }
} // namespace Exemplar

#endif
