// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/supports.h>
#include <exemplar/solvers/step_system.h>

#include <deal.II/base/memory_consumption.h>

namespace Exemplar
{
  StepSystem::StepSystem(IncrementalPotential &potential,
                         MakeSystem            new_make_system,
                         StepClock            &clock,
                         const unsigned int    n_turning)
      : potential(potential), make_system(std::move(new_make_system)), system(make_system()),
        pattern_version(potential.get_tangent().get_pattern().version),
        dofs_version(potential.get_free_dofs().version()), clock(clock), n_turning(n_turning)
  {
  }

  void
  StepSystem::factorize(const Vector              &positions,
                        const std::vector<double> &weights,
                        const double               convexity)
  {
    assemble(positions, weights, convexity, PotentialTangent::Terms::all);
    factorize_by(&BorderedSystem::factorize, positions);
  }

  void
  StepSystem::factorize_near(const Vector              &positions,
                             const std::vector<double> &weights,
                             const double               convexity)
  {
    assemble(positions, weights, convexity, PotentialTangent::Terms::all);
    factorize_by(&BorderedSystem::factorize_near, positions);
  }

  void
  StepSystem::factorize_roughly(const Vector              &positions,
                                const std::vector<double> &weights,
                                const double               convexity)
  {
    assemble(positions, weights, convexity, PotentialTangent::Terms::all);
    factorize_by(&BorderedSystem::factorize_roughly, positions);
  }

  void
  StepSystem::factorize_metric(const Vector &positions, const std::vector<double> &weights)
  {
    assemble(positions, weights, 1., PotentialTangent::Terms::without_gaps);
    factorize_by(&BorderedSystem::factorize_roughly, positions);
  }

  void
  StepSystem::factorize_by(void (BorderedSystem::*how)(const Vector &), const Vector &positions)
  {
    StepClock::Scope scope(clock, Phase::factorize);
    (system.get()->*how)(positions);
  }

  void
  StepSystem::forget_earlier(const Vector &positions)
  {
    if (!system->leans_on_earlier())
      return;
    factorize_by(&BorderedSystem::factorize, positions);
    system->prepare();
  }

  bool
  StepSystem::begin_metric(const Vector &positions, const std::vector<double> &weights)
  {
    potential.get_tangent().follow_gaps(positions, PotentialTangent::Terms::without_gaps);
    follow_pattern();
    BorderedSystem *const next = background.prepare(*system);
    if (next == nullptr)
      return false;
    assemble(positions, weights, 1., PotentialTangent::Terms::without_gaps, *next);
    background.start(positions);
    return true;
  }

  std::vector<double>
  StepSystem::take_factor()
  {
    StepClock::Scope scope(clock, Phase::factorize);
    count_factor();
    return background.take(system);
  }

  void
  StepSystem::follow_pattern()
  {
    if (pattern_version == potential.get_tangent().get_pattern().version)
      return;
    background.clear();
    if (dofs_version == potential.get_free_dofs().version())
      system->reinit(potential.get_tangent().get_pattern());
    else
    {
      system.reset(); // its memory first
      system       = make_system();
      dofs_version = potential.get_free_dofs().version();
    }
    pattern_version = potential.get_tangent().get_pattern().version;
  }

  void
  StepSystem::assemble(const Vector                 &positions,
                       const std::vector<double>    &weights,
                       const double                  convexity,
                       const PotentialTangent::Terms terms)
  {
    potential.get_tangent().follow_gaps(positions, terms);
    follow_pattern();
    assemble(positions, weights, convexity, terms, *system);
    count_factor();
  }

  void
  StepSystem::assemble(const Vector                 &positions,
                       const std::vector<double>    &weights,
                       const double                  convexity,
                       const PotentialTangent::Terms terms,
                       BorderedSystem               &assembled)
  {
    StepClock::Scope scope(clock, Phase::assemble);
    potential.get_tangent().assemble(positions, weights, convexity, assembled.matrix_values(),
                                     assembled.columns(), assembled.outer_products(), terms);
    if (UnknownShear *const shear = assembled.shear())
      potential.get_body().find_shear(positions, *shear);
    potential.get_free_dofs().assemble_columns(assembled.columns(),
                                               assembled.weight_form().coupled.size());
  }

  void
  StepSystem::count_factor()
  {
    ++factorizations;
    factor_of = potential.get_free_dofs().version();
  }

  BorderedVector
  StepSystem::solve(const State               &at,
                    const Vector              &gradient,
                    const std::vector<double> &weight_gradient,
                    const double               accuracy)
  {
    StepClock::Scope scope(clock, Phase::solve);
    const auto      &free = potential.get_free_dofs().list();
    BorderedVector   unknowns;
    unknowns.positions.reserve(free.size());
    for (const unsigned int dof : free)
      unknowns.positions.push_back(-gradient[dof]);
    for (const double derivative : weight_gradient)
      unknowns.weights.push_back(-derivative);
    const ExampleWeights &weights = potential.get_weights();
    unknowns.multipliers          = weights.missing_sums(at.weights);
    system->solve(unknowns, weights.limits_of_changes(at.weights), accuracy);
    return unknowns;
  }

  void
  StepSystem::prepare()
  {
    StepClock::Scope scope(clock, Phase::solve);
    system->prepare();
  }

  Vector
  StepSystem::displacement(const State &at, const BorderedVector &step) const
  {
    const auto &free = potential.get_free_dofs().list();
    Vector      displacement(at.positions.size());
    for (unsigned int i = 0; i < free.size(); ++i)
      displacement[free[i]] = step.positions[i];
    const Exchange &exchange = potential.get_free_dofs().exchange();
    exchange.share(displacement);
    // the far ends of a body held at one cell would turn about it, along straight lines
    if (n_turning > 0)
      remove_rigid_motion(at.positions, displacement, exchange, n_turning);
    return displacement;
  }

  void
  StepSystem::add(const BorderedVector &step, State &state) const
  {
    state.positions += displacement(state, step);
    potential.get_weights().add(step.weights, state.weights);
  }

  double
  StepSystem::slope(const Evaluation &evaluation, const BorderedVector &step) const
  {
    const auto &free  = potential.get_free_dofs().list();
    double      slope = 0.;
    for (unsigned int i = 0; i < free.size(); ++i)
      slope += evaluation.gradient[free[i]] * step.positions[i];
    return potential.get_free_dofs().exchange().sum(slope);
  }

  std::size_t
  StepSystem::memory_of_weights() const
  {
    const WeightForm &form = system->weight_form();
    return form.H.empty() ? 0
                          : dealii::MemoryConsumption::memory_consumption(system->columns())
                                + form.H.memory_consumption() + form.N.memory_consumption();
  }
} // namespace Exemplar
