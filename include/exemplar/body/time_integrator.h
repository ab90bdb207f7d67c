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
  /// Positions of earlier steps and their weights in a formula of the time scheme.
  struct WeightedPositions
  {
    double        weight;
    const Vector *positions; ///< by degree of freedom [m]
  };

  /// The time scheme and the damping of dynamic scenes, Eqs. (12), (21) and (22). Rates at the end
  /// of a step are v = gamma (x - x_star), with x_star from earlier positions.
  class TimeIntegrator
  {
  public:
    explicit TimeIntegrator(const TimeParameters &parameters);

    /// From the next step on mass damping a [1/s] and stiffness damping b [s].
    void
    set_damping(const double a, const double b)
    {
      mass_damping      = a;
      stiffness_damping = b;
    }

    /// Start a step of length h [s] from `state`.
    void
    begin_step(const State &state, double step_size);

    /// Velocities, and what the next step needs of the one from `old` to `state`.
    void
    end_step(const State &old, State &state) const;

    /// x_hat of the step, where the body would be without forces.
    const Vector &
    predicted_positions() const
    {
      return predicted;
    }

    /// gamma (gamma + a_M) with the mass damping a_M: what multiplies the mass matrix [1/s^2].
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

    /// Stiffness damping over the time that gamma stands for [-].
    double
    stiffness_damping_factor() const
    {
      return stiffness_damping * gamma;
    }

    /// The positions that make x_star in the step from `state`.
    std::vector<WeightedPositions>
    history(const State &state) const;

    /// What makes rates of weights in the step from `state`, as of positions.
    WeightStep
    weight_step(const State &state) const;

    /// Whether half the square of x - x_hat, which a step minimises with the energy, is
    /// |v_(n+1) - v_n|^2_M/2: where the energy bound below Eq. (12) can hold.
    bool
    is_undamped_implicit_euler() const
    {
      return scheme == TimeScheme::implicit_euler && mass_damping == 0. && stiffness_damping == 0.;
    }

    /// In bytes.
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
