// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_weights_h
#define exemplar_example_weights_h

#include <exemplar/algebra/bordered_system.h>
#include <exemplar/body/example_parameters.h>
#include <exemplar/body/example_targets.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/body/weight_memory.h>
#include <exemplar/body/weight_table.h>
#include <exemplar/prm/expression.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Residual of the optimality conditions of the weights at given positions, Eq. (13).
  struct WeightResidual
  {
    std::vector<double>
           multipliers;    ///< multiplier of each region's sum of weights [J], if they have sums
    double deviation = 0.; ///< greatest violation of the conditions of Karush, Kuhn and Tucker [J]
  };

  /// Fraction p of the blended energy in `energy`; the rest is the scaled one, Eq. (5).
  double
  blended_part(ExampleEnergy energy);

  /// The example weights: prescribed functions of time or unknowns, their bounds and sums, and the
  /// part of the energy that depends on them alone. Weight r * n_per_region() + i is that of
  /// example i in region r; the weights of a region sum to one unless they are additive. A scene
  /// without examples has no weights, and all loops over them are empty.
  class ExampleWeights
  {
  public:
    /// `unit_energy` is sum E V over the cells [J]. Prescribed weights are formulas unless there is a `table`.
    /// Throws UserError for prescribed weights that do not sum to one in every step, and for weights without penalty if the examples are affinely
    /// dependent.
    ExampleWeights(const ExampleParameters &parameters,
                   const ExampleTargets    &targets,
                   double                   unit_energy,
                   const TimeAxis          &axis,
                   WeightTable              table = {});

    unsigned int
    size() const
    {
      return targets.n_weights();
    }

    unsigned int
    n_regions() const
    {
      return targets.n_regions();
    }

    /// Recompute the quadratic form after a change of the examples, with this unit energy [J]; see
    /// the constructor.
    void
    set_parameters(const ExampleParameters &parameters, double unit_energy);

    /// Fix the unknown weights at `values`, one for each weight; an empty vector frees them. Throws
    /// UserError, and changes nothing, unless Examples/Weights is simplex or additive and admits the
    /// values.
    void
    hold(std::vector<double> values);

    /// Throws UserError for values that hold() rejects.
    void
    check_held(const std::vector<double> &values) const;

    /// Number of weights in each region, that of examples.
    unsigned int
    n_per_region() const
    {
      return targets.size();
    }

    /// Whether weights have no sum.
    bool
    are_additive() const
    {
      return additive;
    }

    /// Whether weights are bounded: by 0 and, without a sum, by 1.
    bool
    are_bounded() const
    {
      return bounded;
    }

    /// Whether a weight of this value is off its bounds.
    bool
    is_off_bounds(const double weight) const
    {
      return can_fall(weight) && can_rise(weight);
    }

    /// The part of a form of all weights by which they can differ: of differences within regions,
    /// or the whole one without sums.
    dealii::FullMatrix<double>
    form_of_changes(const dealii::FullMatrix<double> &form) const;

    /// Yield and creep of the weights; empty unless the scene asks for it.
    const WeightMemory &
    get_memory() const
    {
      return memory;
    }

    /// Set the step, with whose start the memory compares the weights.
    void
    set_step(WeightStep step);

    /// Number of unknown weights; 0 if they are prescribed.
    unsigned int
    n_unknown() const
    {
      return form.H.m();
    }

    bool
    are_prescribed() const
    {
      return !prescribed.empty() || !table.empty();
    }

    /// Prescribed weights at time t.
    std::vector<double>
    at(double time) const;

    /// Throws UserError for prescribed weights that do not sum to one at time t.
    void
    check_sums(double time) const;

    /// The table of prescribed weights; empty: formulas.
    const WeightTable &
    get_table() const
    {
      return table;
    }

    /// The weights at time t: prescribed or held values, or else `weights`.
    std::vector<double>
    at(const double time, const std::vector<double> &weights) const
    {
      if (are_prescribed())
        return at(time);
      return held.empty() ? weights : held;
    }

    /// Initial weights: prescribed or held ones; otherwise 1 on the first example of each region, or
    /// 0 of all additive ones.
    std::vector<double>
    initial() const;

    /// The quadratic form H, Eq. (9), the constraints on sums and the coupled columns of the
    /// unknown weights, for linear systems. Empty without unknown weights.
    const WeightForm &
    weight_form() const
    {
      return form;
    }

    /// The Hessian of the energy that depends on the weights alone: the ridge, the penalties of preferences(), and
    /// p eta (1 - eta) sum V E_i : C : E_j [J], where p is the blended part of the energy. For unknown weights
    /// only.
    const dealii::FullMatrix<double> &
    penalty_matrix() const
    {
      return penalty;
    }

    /// The part of sigma, Examples/Weight penalty, on a weight, over the volume fraction of its region; 1 but in
    /// regions that were found.
    double
    part_of_ridge(const unsigned int weight) const
    {
      return parts_of_ridge.empty() ? 1. : parts_of_ridge[weight];
    }

    /// Coefficients of the penalties along combinations of strains that nearly vanish, over the unit energy times the volume
    /// fraction of their region; empty without such combinations.
    const dealii::FullMatrix<double> &
    preferences() const
    {
      return preference_form;
    }

    /// The minimiser of w^T H w / 2 - c^T w under bounds and sums, from `start` near it. Throws
    /// SolverFailure if it is not determined.
    std::vector<double>
    best(const std::vector<double> &c, const std::vector<double> &start) const;

    /// Limits on changes of the given weights.
    WeightLimits
    limits_of_changes(const std::vector<double> &weights) const;

    /// One minus the sum of the weights, for each region; empty for additive ones.
    std::vector<double>
    missing_sums(const std::vector<double> &weights) const;

    /// Add changes to the weights; those that are at a bound or a kink but for rounding get its
    /// exact value.
    void
    add(const std::vector<double> &changes, std::vector<double> &weights) const;

    /// Residual of the optimality conditions, from the derivative of the energy by the weights
    /// without kinks [J].
    WeightResidual
    residual(const std::vector<double> &weights, const std::vector<double> &gradient) const;

    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    bool
    can_fall(const double weight) const
    {
      return !bounded || weight > 0.;
    }

    bool
    can_rise(const double weight) const
    {
      return !additive || !(weight >= 1.); // a NaN is at no bound, so that it shows
    }

    void
    compute_form(const ExampleParameters &parameters, double unit_energy);

    /// Find the combinations of strains that nearly vanish, with a warning of each, and the penalties along them.
    void
    find_preferences(double unit_energy);

    /// Add the penalties along these combinations to `penalty`.
    void
    add_preferences(double unit_energy);

    void
    read_prescribed(const std::string &text);

    /// The remedy for a list of formulas whose sum is not one.
    std::string
    remedy_for_sum(const std::string &list) const;

    /// Warns of affinely dependent examples; throws UserError where no ridge makes their weights
    /// unique.
    void
    check_independence(double unit_energy, bool has_ridge);

    const ExampleTargets      &targets;
    const bool                 bounded, additive;
    const std::vector<double>  parts_of_ridge; ///< see part_of_ridge(); empty: all 1
    WeightMemory               memory;
    WeightForm                 form;
    dealii::FullMatrix<double> penalty;
    dealii::FullMatrix<double> preference_form; ///< see preferences()
    WeightTable                table; ///< of prescribed weights in all regions; empty: formulas
    std::vector<std::string>
        formulas; ///< of prescribed weights: one list for all regions, or one per region
    std::vector<Expression>  prescribed; ///< of these
    std::vector<double>      held;       ///< weights of hold(); empty: free
    std::vector<std::string> warnings;
  };
} // namespace Exemplar

#endif
