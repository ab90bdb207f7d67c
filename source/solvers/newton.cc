// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/extent.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/newton.h>

#include <boost/serialization/vector.hpp>
#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Residual after a prediction up to which its factor serves for more steps: as much as forces
    /// differ from those that the tangent predicts, the tangent itself has changed.
    constexpr double nearly_linear = 1e-3;

    /// Of the extent.
    constexpr double max_prediction = 0.25;

    /// Residual of a prediction.
    constexpr double well_predicted = 0.1;

    /// For a difference quotient: of the way of obstacles until one of them would meet the body.
    constexpr double small_part = 1e-4;

    /// Inertia holds a body and predicts its motion; without it small forces can move soft or thin parts far,
    /// and factors of exact tangents serve the next prediction.
    bool
    is_without_inertia(const IncrementalPotential &potential)
    {
      return potential.inertial_positions() == nullptr;
    }
    /// Whether the pattern may have couplings of gaps, which depend on the iterations of the step.
    bool
    has_pattern_of_step(const IncrementalPotential &potential)
    {
      return potential.gap_width() > 0.
             && potential.get_free_dofs().exchange().any(potential.get_tangent().get_pattern().plain
                                                         != nullptr);
    }
  } // namespace

  Newton::Newton(const SolverParameters &parameters,
                 IncrementalPotential   &potential,
                 StepSystem             &system,
                 const Handles          &handles,
                 StepClock              &clock)
      : parameters(parameters), potential(potential), system(system), handles(handles),
        clock(clock), motion(potential, handles, may_go_on)
  {
  }

  SolveReport
  Newton::solve(State &state, Evaluation &evaluation, const double time, const double step_size)
  {
    SolveReport report;
    potential.begin_step(state, step_size);
    Trial trial = { state, accepted, system.n_factorizations() };
    if (advance(trial, evaluation, time, 0, report))
    {
      state    = std::move(trial.state);
      accepted = std::move(trial.linearization);
      if (potential.has_tangent_of_step() || has_pattern_of_step(potential))
        accepted = {}; // a resumed run could not make it again
    }
    return report;
  }

  void
  Newton::take_over(State       &state,
                    const State *reached,
                    Evaluation  &evaluation,
                    const double time,
                    SolveReport &report)
  {
    if (reached != nullptr)
    {
      Trial trial = { *reached, {}, system.n_factorizations() };
      if (finish(trial, evaluation, time, report))
      {
        state = std::move(trial.state);
        return;
      }
    }
    Trial trial = { state, {}, system.n_factorizations() };
    if (advance(trial, evaluation, time, 0, report))
      state = std::move(trial.state);
  }

  void
  Newton::predict(Trial       &start,
                  const double time,
                  const bool   is_whole_step,
                  Trial       &trial,
                  Evaluation  &evaluation)
  {
    StepClock::Scope scope(clock, Phase::evaluate);
    potential.set_time(time, trial.state);
    const Vector *inertial = potential.inertial_positions();
    potential.move_to(start.state.time); // where there are gaps
    if (inertial == nullptr || !is_whole_step)
      predict_along_tangent(start, trial, evaluation);
    else
    {
      // inertia predicts better than any tangent: x + h v
      for (const unsigned int dof : potential.get_free_dofs().local_list())
        trial.state.positions[dof] = (*inertial)[dof];
      handles.move(time, trial.state.positions);
    }
    bool has_factor = false;
    motion.move(start.state.time, start.state.positions, time, trial.state.positions,
                [&](std::vector<double> &forces)
                {
                  if (!has_factor)
                  {
                    potential.get_body().update_rotations(start.state.positions);
                    if (is_without_inertia(potential))
                      // contacts of the start resist what is carried
                      system.factorize(start.state.positions, start.state.weights, 1.);
                    else
                      system.factorize_metric(start.state.positions, start.state.weights);
                  }
                  has_factor = true;
                  system.bordered().apply_inverse(forces);
                });
  }

  void
  Newton::predict_along_tangent(Trial &start, Trial &trial, Evaluation &evaluation)
  {
    // so that free nodes move with the handles instead of being crushed by them
    handles.move(trial.state.time, trial.state.positions);
    Vector displacement = trial.state.positions;
    displacement -= start.state.positions;
    const State moved      = trial.state;
    const bool  has_factor = start.linearization.positions.size() > 0;
    const bool  is_made = add_tangent_step(start, displacement, Tangent::exact, trial, evaluation);
    if (is_made && has_factor && !is_descent_of_flow(moved, trial.state, evaluation))
    {
      trial.state         = moved;
      start.linearization = {};
      predict_along_tangent(start, trial, evaluation);
      return;
    }
    if (!is_made)
      add_tangent_step(start, displacement, Tangent::convex, trial, evaluation);
    if (has_left(moved.positions, trial.state.positions))
      trial.state = moved;
    trial.linearization = start.linearization; // of which the factor may have been made
  }

  bool
  Newton::has_left(const Vector &from, const Vector &to) const
  {
    const Exchange &exchange = potential.get_free_dofs().exchange();
    if (!exchange.any(!potential.weakly_constrained_pieces().empty()))
      return false;
    Vector way = to;
    way -= from;
    return exchange.max(max_entry(way.begin(), way.end()))
           > max_prediction * extent(from, exchange);
  }

  bool
  Newton::is_descent_of_flow(const State &from, const State &to, Evaluation &evaluation)
  {
    if (!potential.get_body().remembers())
      return true;
    const auto potential_of = [&](State state)
    {
      evaluate(state, evaluation);
      return evaluation.potential;
    };
    return potential_of(to) < potential_of(from);
  }

  bool
  Newton::add_tangent_step(Trial        &start,
                           const Vector &displacement,
                           const Tangent tangent,
                           Trial        &trial,
                           Evaluation   &evaluation)
  {
    State from   = start.state;
    from.weights = trial.state.weights; // prescribed ones are those of the new time
    try
    {
      const bool has_factor = tangent == Tangent::exact && find_factor(start, trial.state.time);
      potential.get_body().update_rotations(from.positions);
      potential.get_body().evaluate(from.positions, from.weights, evaluation.elastic);
      potential.get_body().add_response(tangent, displacement, from.positions, from.weights,
                                        evaluation.elastic);
      potential.add_terms(from.positions, evaluation);
      const double time_of_obstacles
          = is_without_inertia(potential)
                ? add_motion_of_obstacles(from.positions, from.time, trial.state.time, evaluation)
                : from.time;
      if (!has_factor)
        system.factorize(from.positions, from.weights, tangent == Tangent::convex ? 1. : 0.);
      potential.move_to(from.time);
      system.add(system.solve(from, evaluation), trial.state);
      if (tangent == Tangent::exact && !has_factor && is_without_inertia(potential))
        start.linearization = { from.positions,   from.weights,      from.history,
                                trial.state.time, time_of_obstacles, system.n_factorizations() };
      return true;
    }
    catch (const SolverFailure &)
    {
      potential.move_to(from.time);
      return false; // indefinite
    }
  }

  double
  Newton::add_motion_of_obstacles(const Vector &positions,
                                  const double  from_time,
                                  const double  time,
                                  Evaluation   &evaluation)
  {
    if (potential.gap_width() == 0. || !potential.moves_between(from_time, time))
      return from_time;
    // a small part of what would close a gap
    const Vector at_rest(positions.size());
    const double part  = small_part * std::min(1., potential.max_step_to(time, positions, at_rest));
    const double soon  = from_time + part * (time - from_time);
    Evaluation   after = evaluation;
    potential.move_to(soon);
    potential.add_terms(positions, after);
    after.gradient -= evaluation.gradient;
    evaluation.gradient.add(1. / part, after.gradient);
    return soon;
  }

  bool
  Newton::has_factor_of_step(const Trial &trial) const
  {
    return system.n_factorizations() > trial.n_factors
           || trial.linearization.factor == system.n_factorizations();
  }

  bool
  Newton::find_factor(Trial &start, const double time)
  {
    if (start.linearization.positions.size() == 0)
      return false;
    if (start.linearization.factor != system.n_factorizations())
      remake_factor(start, time);
    else
      system.forget_earlier(start.linearization.positions);
    return true;
  }

  void
  Newton::remake_factor(Trial &start, const double time)
  {
    Linearization &linearization = start.linearization;
    ElasticBody   &body          = potential.get_body();
    body.set_history(linearization.history);
    potential.set_time_of_terms(linearization.time);
    potential.move_to(linearization.time_of_obstacles);
    body.update_rotations(linearization.positions);
    system.factorize(linearization.positions, linearization.weights, 0.);
    system.prepare();
    system.count_as_remade();
    body.set_history(start.state.history);
    potential.set_time_of_terms(time);
    potential.move_to(start.state.time);
    linearization.factor = system.n_factorizations();
  }

  void
  Newton::evaluate(State &state, Evaluation &evaluation)
  {
    StepClock::Scope scope(clock, Phase::evaluate);
    potential.minimize_over_weights(state, RotationUse::update, evaluation);
  }

  bool
  Newton::has_residual(const double bound, const State &state, const Evaluation &evaluation) const
  {
    const Residual residual = potential.residual(state, evaluation);
    return max_or_nan(residual.positions, residual.weights) <= bound;
  }

  void
  Newton::iterate(const unsigned int max_iterations,
                  Trial             &trial,
                  Evaluation        &evaluation,
                  SolveReport       &report)
  {
    evaluate(trial.state, evaluation);
    if (trial.linearization.factor == system.n_factorizations()
        && has_residual(nearly_linear, trial.state, evaluation))
      go_on_with_same_factor(trial.state, evaluation);
    unsigned int last = max_iterations;
    for (unsigned int iteration = 0;; ++iteration)
    {
      // a good prediction has the normal forces of friction, too
      const double bound
          = iteration == 0 && is_without_inertia(potential) ? well_predicted : parameters.tolerance;
      const bool is_solved
          = potential.gap_width() > 0. && has_residual(bound, trial.state, evaluation);
      const bool is_same = potential.renew(trial.state, evaluation, is_solved) == TermChange::none;
      if (is_solved && !is_same)
        last = iteration + max_iterations; // another solution begins, with other friction
      const bool goes_on = report_iteration(potential, evaluation, trial.state, report);
      const bool is_met  = is_same && has_met(parameters.tolerance, report);
      if (is_met && (iteration == last || is_placed(trial.state, evaluation)))
        report.status = SolveStatus::converged;
      else if (!goes_on)
        throw Interrupted("Interrupted.");
      else if (iteration == last)
        report.status = SolveStatus::iteration_limit;
      else
        take_step(trial, evaluation, report);
      if (is_met && report.status != SolveStatus::initial)
        report.status = SolveStatus::converged; // as near as rounding lets it come
      if (report.status != SolveStatus::initial)
        return;
      ++report.iterations;
    }
  }

  bool
  Newton::is_placed(const State &state, const Evaluation &evaluation)
  {
    if (!is_without_inertia(potential) || !system.has_factor())
      return true;
    try
    {
      const Exchange &exchange  = potential.get_free_dofs().exchange();
      const double    tolerance = parameters.tolerance * extent(state.positions, exchange);
      const auto      is_within = [&](const BorderedVector &step, const double part)
      {
        const Vector error = system.displacement(state, step);
        return exchange.max(max_entry(error.begin(), error.end())) <= part * tolerance;
      };
      // most states are placed far better than they need be, which a tenth of the digits shows
      return (system.iterates() && is_within(system.solve(state, evaluation, 0.1), 0.1))
             || is_within(system.solve(state, evaluation), 1.);
    }
    catch (const SolverFailure &)
    {
      return false; // the factor is not one for these weights
    }
  }

  void
  Newton::take_step(Trial &trial, Evaluation &evaluation, SolveReport &report)
  {
    Linearization  here = { trial.state.positions, trial.state.weights, trial.state.history,
                            trial.state.time,      trial.state.time,    Linearization::not_made };
    BorderedVector step;
    if (!find_step(trial, evaluation, step, report)
        || !search_along(step, trial.state, evaluation, report))
      return;
    if (!has_residual(parameters.tolerance, trial.state, evaluation))
      correct_with_same_factor(trial.state, evaluation);
    here.factor = system.n_factorizations();
    // if it is that of the exact tangent
    const bool is_used_again = is_without_inertia(potential) && report.convexity == 0.;
    trial.linearization      = is_used_again ? std::move(here) : Linearization();
  }

  void
  Newton::save(boost::archive::binary_oarchive &archive) const
  {
    const Vector positions = whole(potential.get_free_dofs().exchange(), accepted.positions);
    const std::vector<double> history
        = potential.get_body().history_order().whole(accepted.history);
    archive &positions &accepted.weights &history &accepted.time &accepted.time_of_obstacles;
  }

  void
  Newton::load(boost::archive::binary_iarchive &archive)
  {
    accepted = {};
    archive &accepted.positions &accepted.weights &accepted.history &accepted.time &accepted
        .time_of_obstacles;
    accepted.history   = potential.get_body().history_order().part(accepted.history);
    accepted.positions = part(potential.get_free_dofs().exchange(), accepted.positions);
  }

  std::size_t
  Newton::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return accepted.positions.memory_consumption() + memory_consumption(accepted.weights)
           + memory_consumption(accepted.history);
  }
} // namespace Exemplar
