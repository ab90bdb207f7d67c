// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_weights_h
#define exemplar_example_weights_h

#include <exemplar/algebra/bordered_system.h>
#include <exemplar/body/example_poses.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/body/weight_memory.h>
#include <exemplar/prm/expression.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// How far weights are from the minimum of the energy at given positions, Eq. (13).
  struct WeightResidual
  {
    std::vector<double> multipliers; ///< of each region's sum of weights [J]
    double deviation = 0.; ///< greatest violation of the conditions of Karush, Kuhn and Tucker [J]
  };

  /// How much of the blended energy is in `energy`; the rest is the scaled one, Eq. (5).
  double
  blended_part(ExampleEnergy energy);

  /// The rule by which example weights are found: whether they are prescribed functions of time or
  /// unknowns, their bounds and sums, and the part of the energy that depends on them alone. Weight
  /// r * n_per_region() + i is that of example i in region r; the weights of a region sum to one.
  /// A scene without examples has no weights, and all loops over them are empty.
  class ExampleWeights
  {
  public:
    /// `unit_energy` is sum E V over the cells [J], `volume_fractions` the part of each region in
    /// the body. Throws UserError for prescribed weights that do not sum to one in every step, and
    /// for weights without penalty if the examples are affinely dependent.
    ExampleWeights(const ExampleParameters &parameters,
                   const ExamplePoses      &poses,
                   double                   unit_energy,
                   const TimeAxis          &axis);

    unsigned int
    size() const
    {
      return poses.n_weights();
    }

    unsigned int
    n_regions() const
    {
      return poses.get_regions().n_regions();
    }

    /// Of the examples as they are now, in a body of this unit energy [J]; see the constructor.
    void
    set_parameters(const ExampleParameters &parameters, double unit_energy);

    /// From now on unknown weights are these, of all regions, because bounds leave no others; empty: steps find
    /// them again. Throws UserError, with nothing changed, unless they are to be found on the simplex and
    /// these lie there.
    void
    hold(std::vector<double> values);

    /// Throws UserError for what hold() does not take.
    void
    check_held(const std::vector<double> &values) const;

    /// As many as there are examples.
    unsigned int
    n_per_region() const
    {
      return poses.size();
    }

    /// What they remember; nothing unless a scene asks for it.
    const WeightMemory &
    get_memory() const
    {
      return memory;
    }

    /// From now on they are compared with those of this step.
    void
    set_step(WeightStep step);

    /// Those that steps have to find: none if they are prescribed.
    unsigned int
    n_unknown() const
    {
      return form.H.m();
    }

    bool
    are_prescribed() const
    {
      return !prescribed.empty();
    }

    /// Prescribed weights at time t.
    std::vector<double>
    at(double time) const;

    /// What these weights are at time t: others if they are prescribed or held.
    std::vector<double>
    at(const double time, const std::vector<double> &weights) const
    {
      if (are_prescribed())
        return at(time);
      return held.empty() ? weights : held;
    }

    /// Prescribed weights at t = 0; one on the first example if they are unknown.
    std::vector<double>
    initial() const;

    /// The quadratic form H, Eq. (9), of the unknown ones, their sums and coupled columns, for linear
    /// systems. It is empty where none is unknown.
    const WeightForm &
    weight_form() const
    {
      return form;
    }

    /// The second derivative by the weights of what depends on them alone: the ridge and
    /// p eta (1 - eta) sum V E_i : C : E_j [J], where p is the blended part of the energy. Of unknown
    /// weights.
    const dealii::FullMatrix<double> &
    penalty_matrix() const
    {
      return penalty;
    }

    /// The minimiser of w^T H w / 2 - c^T w under bounds and sums, from `start` near it. Throws
    /// SolverFailure if it is not determined.
    std::vector<double>
    best(const std::vector<double> &c, const std::vector<double> &start) const;

    /// Of changes of these weights.
    WeightLimits
    limits_of_changes(const std::vector<double> &weights) const;

    /// What the sums of each region's weights lack to one.
    std::vector<double>
    missing_sums(const std::vector<double> &weights) const;

    /// Add changes, with exact zeros at bounds, and exactly what is remembered, instead of their
    /// rounding.
    void
    add(const std::vector<double> &changes, std::vector<double> &weights) const;

    /// From the energy's derivative by them, kinks aside [J].
    WeightResidual
    residual(const std::vector<double> &weights, const std::vector<double> &gradient) const;

    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    compute_form(const ExampleParameters &parameters, double unit_energy);

    void
    read_prescribed(const std::string &text);

    void
    check_prescribed(const TimeAxis &axis) const;

    /// Warns of examples that depend on each other; throws UserError where no ridge decides
    /// between them.
    void
    check_independence(double unit_energy, bool has_ridge);

    const ExamplePoses        &poses;
    const bool                 bounded; ///< not below zero
    WeightMemory               memory;
    WeightForm                 form;
    dealii::FullMatrix<double> penalty;
    std::vector<Expression>    prescribed; ///< one, or one a region
    std::vector<double>        held;       ///< empty: nobody holds them
    std::vector<std::string>   warnings;
  };
} // namespace Exemplar

#endif
