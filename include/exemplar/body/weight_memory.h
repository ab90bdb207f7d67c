// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_memory_h
#define exemplar_weight_memory_h

#include <exemplar/algebra/weight_limits.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Data of a step for the weights' memory: the weights at its start, and their rate gamma
  /// (w - w*) in the time scheme. Outside of dynamics, and of steps, weights have no rate: gamma is
  /// 0.
  struct WeightStep
  {
    std::vector<double> last;
    std::vector<double> base;       ///< w*
    double              gamma = 0.; ///< [1/s]
    double              size  = 0.; ///< step size [s]
  };

  /// Energy [J] that a step has dissipated, by mechanism.
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

  /// Yield and creep of the weights, Eq. (27): a step adds sum Y_i |w_i - last_i| + gamma/2 sum c_i
  /// (w_i - w*_i)^2 to its objective. The first sum has kinks, which are left to the quadratic
  /// program of the weights; "forces" here are derivatives of the second.
  class WeightMemory
  {
  public:
    /// No yield and no creep.
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

    /// Set the data of the current step.
    void
    set_step(WeightStep new_step)
    {
      step = std::move(new_step);
    }

    /// Add the kinks to limits on the weights, or on their differences to `origin` if it is given.
    void
    add_to(WeightLimits &limits, const std::vector<double> &origin = {}) const;

    /// Round weights that differ from their kinks by rounding errors to these.
    void
    snap(std::vector<double> &weights) const;

    /// The two sums of Eq. (27) that a step adds to the energy of the body [J].
    double
    energy(const std::vector<double> &weights) const;

    /// Derivative of the creep term by a weight [J].
    double
    force(unsigned int i, double weight) const;

    /// Second derivative of the creep term by a weight [J].
    double
    stiffness(const unsigned int i) const
    {
      return creeps() ? step.gamma * viscosity[i] : 0.;
    }

    /// Add the creep's linear term to c, so that H w - c is the gradient, with stiffness() in H.
    void
    add_linear_term(std::vector<double> &c) const;

    /// One-sided derivatives of the energy by a weight, to the right and to the left; `derivative`
    /// is that of all but the kinks [J].
    struct Slopes
    {
      double up, down;
    };

    Slopes
    slopes(unsigned int i, double weight, double derivative) const;

    /// Scale of the forces of yield and creep on a weight [J].
    double
    force_scale(unsigned int i, double weight) const;

    /// Energy dissipated by a step that ends with these weights.
    Dissipation
    dissipation(const std::vector<double> &weights) const;

  private:
    std::vector<double> yield, viscosity;
    WeightStep          step;
  };
} // namespace Exemplar

#endif
