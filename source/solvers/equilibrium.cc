// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/supports.h>
#include <exemplar/prm/key_table.h>
#include <exemplar/solvers/equilibrium.h>

#include <deal.II/base/memory_consumption.h>

#include <cmath>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    const EnumTable<SolveStatus> statuses = { { SolveStatus::initial, "initial" },
                                              { SolveStatus::converged, "converged" },
                                              { SolveStatus::one_pass, "one pass" },
                                              { SolveStatus::stalled, "stalled" },
                                              { SolveStatus::indefinite, "indefinite" },
                                              { SolveStatus::iteration_limit, "iteration limit" },
                                              { SolveStatus::failed, "failed" } };

    /// The greater of two numbers; a NaN is the greatest, which std::max may pass over.
    double
    greater(const double a, const double b)
    {
      return a <= b ? b : a;
    }

    /// a / b; where a is nothing but rounding, as in a body on which nothing acts, it
    /// counts as 0. Throws SolverFailure for what is not finite.
    double
    relative(const double a, const double b, const double rounding)
    {
      if (!std::isfinite(a) || !std::isfinite(b))
        throw SolverFailure("The residual is not a finite number. Forces have grown without bound: "
                            "take smaller steps, or look at what the handles do.");
      return a <= rounding ? 0. : a / b;
    }
  } // namespace

  std::string
  status_name(const SolveStatus status)
  {
    return enum_name(status, statuses);
  }

  Equilibrium::Equilibrium(const SolverParameters &parameters, const Parts &parts)
      : parameters(parameters), parts(parts), turned_factor(parts.free_dofs)
  {
    if (parts.examples != nullptr && !parts.examples->weights_are_prescribed())
    {
      block.H = parts.examples->weight_matrix();
      for (unsigned int weight = 0; weight < block.H.n(); ++weight)
        if (parts.examples->is_strained(weight))
          block.coupled.push_back(weight);
      block.N.reinit(parts.examples->n_regions(), block.H.n()); // the weights of each sum to one
      for (unsigned int weight = 0; weight < block.H.n(); ++weight)
        block.N(weight / parts.examples->size(), weight) = 1.;
    }
  }

  void
  Equilibrium::start(const State &state)
  {
    StepClock::Scope scope(parts.clock, Part::evaluate);
    dynamic_terms = false;
    update_loads(state.time);
    parts.assembler.set_damping(0., {});
    evaluate(state, Rotations::update);
  }

  void
  Equilibrium::begin_dynamic_step(const State &state, const double step_size)
  {
    if (parts.inertia == nullptr)
      return;
    parts.inertia->begin_step(state, step_size);
    dynamic_terms = true;
    if (parts.inertia->stiffness_damping_factor() > 0.)
      parts.assembler.set_damping(parts.inertia->stiffness_damping_factor(),
                                  parts.inertia->history(state));
  }

  void
  Equilibrium::update_loads(const double time)
  {
    if (parts.loads == nullptr)
      return;
    external_force.reinit(parts.free_dofs.n_dofs());
    if (parts.loads->has_named_loads())
      parts.loads->named_loads(time, external_force);
    if (parts.loads->has_gravity())
      external_force += parts.loads->gravity();
    external_force_norms.reinit(external_force.size() / 3);
    for (unsigned int node = 0; node < external_force_norms.size(); ++node)
      external_force_norms[node] = std::hypot(
          external_force[3 * node], external_force[3 * node + 1], external_force[3 * node + 2]);
  }

  void
  Equilibrium::evaluate(const State               &state,
                        const Rotations            rotations,
                        const std::vector<double> *weight_target)
  {
    StepClock::Scope scope(parts.clock, Part::evaluate);
    parts.assembler.evaluate(state.positions, state.weights, current, rotations, weight_target);
    add_inertia_and_loads(state);
  }

  void
  Equilibrium::add_inertia_and_loads(const State &state)
  {
    total_gradient = current.gradient;
    force_scale    = current.force_scale;
    if (dynamic_terms)
      inertia_energy = parts.inertia->add_gradient(state.positions, total_gradient, force_scale);
    if (parts.loads == nullptr)
      return;
    total_gradient -= external_force;
    force_scale += external_force_norms;
  }

  void
  Equilibrium::factorize(const dealii::Vector<double> &positions,
                         const std::vector<double>    &weights,
                         const double                  convexity)
  {
    {
      StepClock::Scope     scope(parts.clock, Part::assemble);
      std::vector<double> &values = parts.linear_solver.matrix_values();
      parts.assembler.assemble_tangent(convexity < 1. ? Tangent::exact : Tangent::convex, positions,
                                       weights, values, block.coupling);
      if (convexity > 0. && convexity < 1.)
      {
        std::vector<double> convex_values(values.size()), convex_coupling;
        parts.assembler.assemble_tangent(Tangent::convex, positions, weights, convex_values,
                                         convex_coupling);
        const auto mix = [&](std::vector<double> &exact, const std::vector<double> &convex)
        {
          for (std::size_t i = 0; i < convex.size(); ++i)
            exact[i] += convexity * (convex[i] - exact[i]);
        };
        mix(values, convex_values);
        mix(block.coupling, convex_coupling);
      }
    }
    StepClock::Scope scope(parts.clock, Part::factorize);
    ++factorizations;
    has_last_factor = false;
    parts.linear_solver.place_nodes(positions);
    parts.linear_solver.factorize(block);
  }

  void
  Equilibrium::solve_for_step(const State &state)
  {
    StepClock::Scope scope(parts.clock, Part::solve);
    unknowns.positions.clear();
    for (const unsigned int dof : parts.free_dofs.list())
      unknowns.positions.push_back(-total_gradient[dof]);
    unknowns.weights.clear();
    unknowns.multipliers.clear();
    if (block.H.m() > 0)
    {
      for (const double derivative : current.weight_gradient)
        unknowns.weights.push_back(-derivative);
      const unsigned int k = parts.examples->size();
      for (auto first = state.weights.begin(); first != state.weights.end(); first += k)
        unknowns.multipliers.push_back(1. - std::accumulate(first, first + k, 0.));
      if (parts.examples->weights_are_bounded())
      {
        block.lower.clear();
        for (const double weight : state.weights)
          block.lower.push_back(-weight);
      }
    }
    parts.linear_solver.solve(block, unknowns);
  }

  Conditioning
  Equilibrium::conditioning() const
  {
    Conditioning result;
    if (SpdOperator *matrix = parts.linear_solver.matrix())
      result.matrix = matrix->condition_estimate();
    const dealii::FullMatrix<double> &schur = turned_factor.empty()
                                                  ? parts.linear_solver.schur_complement()
                                                  : turned_factor.schur_complement();
    if (schur.m() > 0)
      result.schur = condition_number(form_of_differences(schur, parts.examples->size()));
    return result;
  }

  dealii::Vector<double>
  Equilibrium::solved_step(const State &state) const
  {
    const auto            &free = parts.free_dofs.list();
    dealii::Vector<double> step(state.positions.size());
    for (unsigned int i = 0; i < free.size(); ++i)
      step[free[i]] = unknowns.positions[i];
    // the far ends of a body held at one cell would turn about it, along straight lines
    if (parts.turns_freely)
      remove_rigid_motion(state.positions, step);
    return step;
  }

  void
  Equilibrium::add_step(State &state) const
  {
    state.positions += solved_step(state);
    for (unsigned int i = 0; i < unknowns.weights.size(); ++i)
      state.weights[i] += unknowns.weights[i];
    if (parts.examples != nullptr && parts.examples->weights_are_bounded())
      for (double &weight : state.weights)
        weight = std::max(weight, 0.); // exact zeros, not their rounding
  }

  void
  Equilibrium::measure(State &state, SolveReport &report) const
  {
    double greatest = 0.;
    for (const unsigned int dof : parts.free_dofs.list())
      greatest = greater(std::abs(total_gradient[dof]), greatest);
    const double rounding
        = parts.assembler.rounding_force() + (dynamic_terms ? parts.inertia->rounding_force() : 0.);
    report.residual = relative(greatest, force_scale.linfty_norm(), rounding);
    if (!current.weight_gradient.empty())
      measure_weights(state, report);
  }

  void
  Equilibrium::measure_iteration(State &state, SolveReport &report) const
  {
    measure(state, report);
    report.residual_history.push_back(report.residual);
    if (observe_iteration)
      observe_iteration(report);
  }

  void
  Equilibrium::measure_weights(State &state, SolveReport &report) const
  {
    // the derivatives of a region's weights off their bounds equal -multiplier, others
    // exceed it
    const auto        &gradient = current.weight_gradient;
    const unsigned int k        = parts.examples->size();
    const auto         is_off   = [&](const unsigned int weight)
    { return !parts.examples->weights_are_bounded() || state.weights[weight] > 0.; };
    double deviation = 0., rounding = 0.;
    for (unsigned int region = 0; region < parts.examples->n_regions(); ++region)
    {
      double       sum = 0.;
      unsigned int n   = 0;
      for (unsigned int weight = region * k; weight < (region + 1) * k; ++weight)
        if (is_off(weight))
        {
          sum += gradient[weight];
          ++n;
        }
      state.multipliers[region] = -sum / n;
      for (unsigned int weight = region * k; weight < (region + 1) * k; ++weight)
      {
        const double excess = gradient[weight] + state.multipliers[region];
        deviation = greater(is_off(weight) ? std::abs(excess) : std::max(-excess, 0.), deviation);
        rounding  = std::max(rounding, parts.assembler.rounding_weight_gradient(weight));
      }
    }
    report.kkt_residual = relative(deviation, current.weight_scale, rounding);
  }

  SolveReport
  Equilibrium::solve(State &state, const double time, const double step_size)
  {
    switch (parameters.method)
    {
    case Method::newton:
      return solve_by_newton(state, time, step_size);
    case Method::quasi_newton:
      return solve_by_quasi_newton(state, time, step_size);
    default:
      return solve_by_passes(state, time, step_size);
    }
  }

  std::size_t
  Equilibrium::memory_of_weights() const
  {
    if (block.H.m() == 0)
      return 0;
    return dealii::MemoryConsumption::memory_consumption(block.coupling)
           + block.H.memory_consumption() + block.N.memory_consumption();
  }

  std::size_t
  Equilibrium::memory_of_quasi_newton() const
  {
    if (turned_factor.empty())
      return 0;
    return turned_factor.memory_consumption() + memory.memory_consumption()
           + dealii::MemoryConsumption::memory_consumption(node_rotations);
  }
} // namespace Exemplar
