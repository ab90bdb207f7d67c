// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_memory_h
#define exemplar_weight_memory_h

#include <exemplar/algebra/weight_limits.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// What weights are compared with in a step: those at its start, and the rate gamma (w - w*) of the
  /// time scheme. Outside of dynamics, and of steps, weights have no rate: gamma is 0.
  struct WeightStep
  {
    std::vector<double> last;
    std::vector<double> base;       ///< w*
    double              gamma = 0.; ///< [1/s]
    double              size  = 0.; ///< of the step [s]
  };

  /// Energy [J] that a step has turned into heat, by what has done it.
  struct Dissipation
  {
    double yield_of_weights = 0.;
    double creep_of_weights = 0.;

    double
    total() const
    {
      return yield_of_weights + creep_of_weights;
    }
  };

  /// Weights that remember, Eq. (27): a step adds sum Y_i |w_i - last_i| + gamma/2 sum c_i (w_i -
  /// w*_i)^2 to what it minimises. The first sum has kinks, which are left to the quadratic program of
  /// the weights: forces here are those of the second.
  class WeightMemory
  {
  public:
    /// Nothing is remembered.
    WeightMemory() = default;

    /// Y_i [J] and c_i [J s] of each weight; empty where there are none.
    WeightMemory(std::vector<double> yields, std::vector<double> viscosities);

    bool
    in_use() const
    {
      return yields() || creeps();
    }

    bool
    yields() const
    {
      return !yield.empty();
    }

    bool
    creeps() const
    {
      return !viscosity.empty();
    }

    /// What follows is of this step.
    void
    set_step(WeightStep new_step)
    {
      step = std::move(new_step);
    }

    /// Add kinks to limits on weights less these; on the weights themselves if it is empty.
    void
    add_to(WeightLimits &limits, const std::vector<double> &origin = {}) const;

    /// Take weights that are off their kinks by rounding alone back to them.
    void
    snap(std::vector<double> &weights) const;

    /// What a step minimises beside the energy of the body [J].
    double
    energy(const std::vector<double> &weights) const;

    /// Derivative of the creep's part by a weight [J].
    double
    force(unsigned int i, double weight) const;

    /// Second derivative of the same [J].
    double
    stiffness(const unsigned int i) const
    {
      return creeps() ? step.gamma * viscosity[i] : 0.;
    }

    /// Add what makes H w - c of the energy's own c with stiffness() in H.
    void
    add_linear_term(std::vector<double> &c) const;

    /// Of the energy by a weight with such a derivative of all but the kinks: to the right and to the left.
    struct Slopes
    {
      double up, down;
    };

    Slopes
    slopes(unsigned int i, double weight, double derivative) const;

    /// Magnitude of the forces on a weight [J].
    double
    force_scale(unsigned int i, double weight) const;

    /// Of a step that ends with these weights.
    Dissipation
    dissipation(const std::vector<double> &weights) const;

  private:
    std::vector<double> yield, viscosity;
    WeightStep          step;
  };
} // namespace Exemplar

#endif
