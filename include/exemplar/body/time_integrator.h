// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_time_integrator_h
#define exemplar_time_integrator_h

#include <exemplar/algebra/vector.h>
#include <exemplar/body/state.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/body/weight_memory.h>

#include <vector>

namespace Exemplar
{
  /// Positions of an earlier step and their coefficient in a formula of the time scheme.
  struct WeightedPositions
  {
    double        weight;
    const Vector *positions; ///< positions by degree of freedom [m]
  };

  /// The time scheme and the damping of dynamic scenes, Eqs. (12), (21) and (22). Velocities at the
  /// end of a step are v = gamma (x - x_star), with x_star from earlier positions.
  class TimeIntegrator
  {
  public:
    explicit TimeIntegrator(const TimeParameters &parameters);

    /// Set the mass damping a [1/s] and the stiffness damping b [s], between steps.
    void
    set_damping(const double a, const double b)
    {
      mass_damping      = a;
      stiffness_damping = b;
    }

    /// Start a step of length h [s] from `state`.
    void
    begin_step(const State &state, double step_size);

    /// Set the velocities of `state`, and the fields that the step after that from `old` to `state`
    /// needs.
    void
    end_step(const State &old, State &state) const;

    /// x_hat of the step: the positions without forces.
    const Vector &
    predicted_positions() const
    {
      return predicted;
    }

    /// Factor gamma (gamma + a_M) of the mass matrix [1/s^2], where a_M is the mass damping.
    double
    mass_factor() const
    {
      return gamma * (gamma + mass_damping);
    }

    /// gamma [1/s].
    double
    rate_factor() const
    {
      return gamma;
    }

    /// Stiffness damping b times gamma [-].
    double
    stiffness_damping_factor() const
    {
      return stiffness_damping * gamma;
    }

    /// The terms of x_star in the step from `state`.
    std::vector<WeightedPositions>
    history(const State &state) const;

    /// Coefficients of the weights' rates in the step from `state`, by the scheme of positions.
    WeightStep
    weight_step(const State &state) const;

    /// Whether half the square of x - x_hat, which a step minimises with the energy, is
    /// |v_(n+1) - v_n|^2_M/2: where the energy bound below Eq. (12) can hold.
    bool
    is_undamped_implicit_euler() const
    {
      return scheme == TimeScheme::implicit_euler && mass_damping == 0. && stiffness_damping == 0.;
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const
    {
      return base.memory_consumption() + predicted.memory_consumption();
    }

  private:
    const TimeScheme scheme;
    double           mass_damping;      ///< a [1/s]
    double           stiffness_damping; ///< b [s]
    double           step_size  = 0.;
    double           gamma      = 0.; ///< [1/s]
    double           c_last     = 1.; ///< x_star = c_last x_n + c_previous x_(n-1)
    double           c_previous = 0.;
    Vector           base;      ///< x_star
    Vector           predicted; ///< x_hat
  };
} // namespace Exemplar

#endif
