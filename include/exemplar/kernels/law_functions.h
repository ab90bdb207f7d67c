// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_law_functions_h
#define exemplar_law_functions_h

#include <exemplar/kernels/elasticity.h>
#include <exemplar/kernels/lanes.h>
#include <exemplar/kernels/stretch_guard.h>

#include <cstddef>

// What an element asks of a law, at the points in a register: functions that are compiled once for
// an instruction set and know neither elements nor matrices. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  enum class CellLaw;

  /// The points in a register: how they are deformed, and what acts on them.
  template <typename Number>
  struct LawInput
  {
    Matrix3<Number>  R, F;
    const double    *constants = nullptr; ///< number k of the law's Constants at k * batch_size
    const double    *history   = nullptr; ///< history variable k likewise
    ExampleConstants examples;
    double           step_size = 0.; ///< current step size [s]; 0: outside of steps

    bool            has_target = false, is_damped = false, has_pressure = false;
    Matrix3<Number> target{};                     ///< D = eta E(w); 0 without examples
    Number          damping = Number(0.);         ///< s of Eq. (14)
    Matrix3<Number> past{};                       ///< e*
    Number          pressure        = Number(0.); ///< of the point's patch, along R, Eq. (25) [Pa]
    Number          volume_pressure = Number(0.); ///< likewise along cof F, Eq. (37) [Pa]
  };

  /// Energies and forces at the points in a register.
  template <typename Number>
  struct LawValue
  {
    Number          elastic;      ///< energy density of the elasticity without a target [Pa]
    Number          inelastic;    ///< of hardening and flow [Pa]
    Number          energy;       ///< psi for the target; without a target, of all but damping [Pa]
    Number          damping;      ///< s times the density of stiffness damping [Pa]
    Number          stress_scale; ///< |C:e| + |C:D| [Pa]
    Number          force_scale;  ///< the scale of |R^T P|, damping included [Pa]
    Matrix3<Number> P;            ///< R^T P [Pa], without the guard of the stretch
    Matrix3<Number> weight_stress;    ///< -d psi / dD [Pa], if it was asked for
    bool            may_be_stretched; ///< whether some point may have the guard of the stretch

    decltype(Number() < Number()) is_guarded; ///< whether the guard of Eq. (16) acts
  };

  /// How the points in a register change along a direction.
  template <typename Number>
  struct LawChange
  {
    Matrix3<Number> F, target;
    Number          pressure = Number(0.); ///< change of LawInput::pressure [Pa]

    /// The derivative of the energy of the point's patch by the trace of the target, and its change.
    Number of_target = Number(0.), change_of_target = Number(0.); ///< [Pa]
  };

  /// The slope P:dF + dpsi/dD:dD of the energy psi(F, D) along a LawChange (dF, dD), with the guard
  /// of the stretch and without damping, and its derivatives. A point in a patch has the energy psi +
  /// p tr e + q tr D instead, whose pressures p and q along the trace and that of the target change
  /// with the direction by dp and dq.
  template <typename Number>
  struct LawSlope
  {
    static constexpr std::size_t n_constants = 2; ///< the first ones of the law

    Number          value; ///< [Pa]
    Matrix3<Number> by_F, by_change_of_F;
    Matrix3<Number> by_target, by_change_of_target; ///< 0 without a target
    Number          by_constants[n_constants];      ///< at fixed pressures
    Number          by_importance; ///< by ExampleNumbers::importance, at a fixed target

    /// Where the guard of Eq. (16) acts; the derivatives are wrong there.
    decltype(Number() < Number()) is_guarded;
  };

  /// A linear map from R^T dF to R^T dP.
  template <typename Number>
  struct LawTangent
  {
    Matrix3<Number> of[3][3]; ///< [k][l]: of M = e_k e_l^T [Pa]

    /// Set it to the map of a function, response(M).
    template <typename Response>
    [[gnu::always_inline]] void
    set(const Response &response)
    {
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
        {
          Matrix3<Number> M{};
          M[k][l]  = Number(1.);
          of[k][l] = response(M);
        }
    }

    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      Matrix3<Number> dP{};
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          dP = combine(Number(1.), dP, M[k][l], of[k][l]);
      return dP;
    }
  };

  /// The functions of a law.
  template <typename Number>
  struct LawFunctions
  {
    const ModelTraits *traits;
    std::size_t        n_constants;
    bool is_isotropic; ///< whether C is that of lambda and mu, which the constants begin with

    /// Whether a tangent is R K R^T, Eq. (8).
    bool
    is_rotated(const bool convex) const
    {
      return convex ? traits->convex_is_rotated : traits->exact_is_rotated;
    }

    /// Whether the guard of Eq. (16) acts on more than the target.
    bool
    guards_without_target() const
    {
      return traits->n_history > 0 || !is_isotropic;
    }

    void (*evaluate)(const LawInput<Number> &, bool with_weight_stress, LawValue<Number> &);

    /// -d psi / dD without a target, damping and patches [Pa].
    Matrix3<Number> (*weight_stress)(const LawInput<Number> &);

    /// The derivative of psi by e, towards the target and without damping and guards [Pa].
    Matrix3<Number> (*stress)(const LawInput<Number> &);

    /// The guard of Eq. (24), which is no part of evaluate(); inactive where it acts at no point.
    StretchGuard<Number> (*stretch_guard)(const LawInput<Number> &);

    /// The exact tangent, or one that is never negative.
    void (*tangent)(const LawInput<Number> &, bool convex, LawTangent<Number> &);

    /// R^T dP for changes of the target by -E_i, i = 0 to n - 1, damping included.
    void (*columns)(const LawInput<Number> &,
                    bool                   convex,
                    std::size_t            n,
                    const Matrix3<Number> *E,
                    Matrix3<Number>       *dP);

    /// The slope along a direction; null for laws without a potential, see has_potential.
    void (*slope)(const LawInput<Number> &, const LawChange<Number> &, LawSlope<Number> &);

    /// The strain e.
    Matrix3<Number> (*strain)(const Matrix3<Number> &R, const Matrix3<Number> &F);

    /// The history variables at the end of the step.
    void (*advance)(const LawInput<Number> &, Number *history);
  };

  /// The functions of a law for a register of some instruction set, or for double. CMake makes a
  /// source file of source/kernels/laws.cc.in for each.
  template <typename Number>
  const LawFunctions<Number> &
  law_functions(CellLaw law);
} // namespace Exemplar

#endif
