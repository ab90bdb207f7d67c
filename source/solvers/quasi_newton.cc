// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/quasi_newton.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int max_iterations = 7; ///< with one metric in a step
    constexpr unsigned int min_iterations
        = 2; ///< the same, of bodies that do not keep their tangent
    constexpr unsigned int max_contact_iterations = 14; ///< the same where gaps matter
    constexpr unsigned int max_metrics            = 2;  ///< that a step may ask for
    constexpr unsigned int max_short_metrics
        = 12; ///< the same, of bodies that do not keep their tangent
    constexpr unsigned int max_changes  = 60; ///< of terms in a step
    constexpr unsigned int max_halvings = 5;
    /// So often what terms lag is renewed before a step is solved. Without a bound it jumps to and fro as the positions do,
    /// and neither settles.
    constexpr unsigned int n_early_changes = 3;
    /// Of a change that the slope promises, where the model of gaps has none.
    constexpr double min_promise = 1e-3;
    /// Times what is enough for the step: from there on what terms have lagged follows each iteration.
    constexpr double nearly_there          = 30.;
    constexpr double max_contraction       = 0.9;
    constexpr double least_turn            = 1e-3; ///< of a node: less is not worth a solve [rad]
    constexpr double min_error_over_length = 2.2;

    double
    max_displacement(const Exchange &exchange, const State &from, const State &to)
    {
      MaxMagnitude maximum;
      for (unsigned int dof = 0; dof < from.positions.size(); ++dof)
        maximum.add(to.positions[dof] - from.positions[dof]);
      return exchange.max(maximum.value());
    }
  } // namespace

  QuasiNewton::QuasiNewton(const SolverParameters &parameters,
                           IncrementalPotential   &potential,
                           StepSystem             &system,
                           const Handles          &handles,
                           StepClock              &clock)
      : parameters(parameters), potential(potential), system(system), clock(clock),
        newton(parameters, potential, system, handles, clock),
        prediction(potential.get_free_dofs(), handles, parameters.prediction_order),
        motion(potential, handles, may_go_on), metric(potential.get_free_dofs()),
        lbfgs(potential.get_free_dofs().exchange()), contact(potential, metric, lbfgs)
  {
    newton.observe   = [this](const SolveReport &so_far) { return !observe || observe(so_far); };
    newton.may_go_on = [this] { return !may_go_on || may_go_on(); };
  }

  SolveReport
  QuasiNewton::solve(State       &state,
                     Evaluation  &evaluation,
                     const double time,
                     const double step_size)
  {
    keep();
    try
    {
      return solve_or_hand_over(state, evaluation, time, step_size);
    }
    catch (const Interrupted &)
    {
      go_back();
      throw;
    }
  }

  SolveReport
  QuasiNewton::solve_or_hand_over(State       &state,
                                  Evaluation  &evaluation,
                                  const double time,
                                  const double step_size)
  {
    SolveReport report;
    bool        has_reached = false;
    potential.begin_step(state, step_size);
    State &trial = memory.trial;
    trial        = state;
    trial.time   = time;
    in_contact   = false;
    try
    {
      predict(state, step_size, trial, evaluation);
      report_or_stop(trial, evaluation, report);
      find_metric(state, step_size, trial);
      iterate(state, step_size, trial, evaluation, report);
      has_reached = true;
    }
    catch (const SolverFailure &failure)
    {
      report.failure = failure.what();
    }
    count_step(report);
    if (report.status == SolveStatus::converged)
    {
      std::swap(state, trial);
      return report;
    }
    history.made.reset();
    next = {};
    metric.clear();
    newton.take_over(state, has_reached && potential.gap_width() > 0. ? &trial : nullptr,
                     evaluation, time, report);
    return report;
  }

  void
  QuasiNewton::report_or_stop(State &trial, const Evaluation &evaluation, SolveReport &report) const
  {
    if (!report_iteration(potential, evaluation, trial, report))
      throw Interrupted("Interrupted.");
  }

  void
  QuasiNewton::predict(const State &accepted,
                       const double step_size,
                       State       &trial,
                       Evaluation  &evaluation)
  {
    StepClock::Scope scope(clock, Phase::evaluate);
    potential.set_time(trial.time, trial);
    rebuild_metrics(accepted, step_size, trial.time);
    prediction.predict(accepted, step_size, trial);
    bool       has_metric = false;
    const auto follow     = [&](std::vector<double> &forces)
    {
      if (!has_metric)
        begin_with_metric(accepted, step_size);
      has_metric = true;
      metric.rotate_back(forces);
      metric.apply(forces);
      metric.rotate_forth(forces);
    };
    motion.move(accepted.time, accepted.positions, trial.time, trial.positions,
                std::cref(follow)); // a copy would ask for memory in each step
    potential.minimize_over_weights(trial, RotationUse::update, evaluation);
    potential.renew(trial, evaluation, false);
  }

  void
  QuasiNewton::begin_with_metric(const State &start, const double step_size)
  {
    potential.get_body().update_rotations(start.positions);
    if (metric.empty() || history.mass_factor() != potential.mass_factor())
      renew_metric(start, step_size, start);
    potential.get_body().node_rotations(node_rotations);
    metric.rotate(node_rotations);
  }

  void
  QuasiNewton::make_metric(const Vector &positions, const std::vector<double> &weights)
  {
    contact.forget();
    metric.clear(); // whose memory the next one takes
    system.factorize_metric(positions, weights);
    StepClock::Scope scope(clock, Phase::factorize);
    potential.get_body().node_rotations(node_rotations);
    metric.reinit(system.bordered(), inverse_columns(system.bordered()), node_rotations);
    metric.rotate(node_rotations);
  }

  void
  QuasiNewton::renew_metric(const State &start, const double step_size, const State &trial)
  {
    make_metric(trial.positions, trial.weights);
    history = new_history(start, step_size, trial);
    next    = {};
    lbfgs.clear();
  }

  QuasiNewton::MetricHistory
  QuasiNewton::new_history(const State &start, const double step_size, const State &trial) const
  {
    MetricHistory result;
    result.made = std::make_shared<const MetricOrigin>(
        MetricOrigin{ trial.positions, trial.weights, potential.get_tangent().couplings_of_terms(),
                      potential.changes_between_steps() ? start : State(), trial.time, step_size,
                      potential.mass_factor() });
    return result;
  }

  bool
  QuasiNewton::has_other_couplings() const
  {
    return potential.get_free_dofs().exchange().any(
        history.made->couplings != potential.get_tangent().couplings_of_terms());
  }

  unsigned int
  QuasiNewton::most_iterations() const
  {
    return potential.get_body().keeps_its_tangent()
               ? max_iterations
               : std::clamp<unsigned int>(std::lround(metric.cost_in_iterations()), min_iterations,
                                          max_iterations);
  }

  bool
  QuasiNewton::should_have_another(const double residual, const double gradient_ratio) const
  {
    if (potential.get_body().keeps_its_tangent() || in_contact
        || !(residual > parameters.step_tolerance))
      return false;
    return !(gradient_ratio < 1.)
           || std::log(parameters.step_tolerance / residual)
                  < metric.cost_in_iterations() * std::log(gradient_ratio);
  }

  bool
  QuasiNewton::is_slow() const
  {
    if (!potential.get_body().keeps_its_tangent() && !history.last_in_contact
        && history.last_iterations > most_iterations())
      return true;
    const bool         touched = history.last_in_contact;
    const unsigned int iterations
        = touched ? history.contact_iterations : history.iterations - history.contact_iterations;
    const unsigned int n = touched ? history.contact_steps : history.steps - history.contact_steps;
    return n > 0 && history.last_iterations > (metric.cost_in_iterations() + iterations) / n;
  }

  void
  QuasiNewton::count_step(const SolveReport &report)
  {
    ++history.steps;
    ++next.steps;
    history.iterations += report.iterations;
    history.last_iterations = report.iterations;
    history.last_in_contact = in_contact;
    if (in_contact)
    {
      ++history.contact_steps;
      history.contact_iterations += report.iterations;
    }
  }

  void
  QuasiNewton::find_metric(const State &start, const double step_size, const State &trial)
  {
    if (next.mass_factor() != potential.mass_factor())
      next = {};
    // where Newton's method has taken over, there is no metric, but steps since it was made
    const bool has_metric = history.made != nullptr
                            && history.mass_factor() == potential.mass_factor()
                            && !has_other_couplings();
    if (has_metric && is_next_due())
      take_next_metric();
    if (!has_metric || (is_slow() && !begin_next_metric(start, step_size, trial)))
      renew_metric(start, step_size, trial);
    else
    {
      StepClock::Scope scope(clock, Phase::solve);
      potential.get_body().node_rotations(node_rotations);
      metric.rotate(node_rotations);
    }
  }

  void
  QuasiNewton::turn_metric()
  {
    StepClock::Scope    scope(clock, Phase::solve);
    std::vector<float> &now = memory.node_rotations;
    potential.get_body().node_rotations(now);
    float turn = 0.F;
    for (std::size_t i = 0; i < now.size(); ++i)
      turn = std::max(turn, std::abs(now[i] - node_rotations[i]));
    if (!(potential.get_free_dofs().exchange().max(turn) > least_turn))
      return;
    node_rotations.swap(now);
    metric.rotate(node_rotations);
    contact.forget_response();
  }

  void
  QuasiNewton::measure(const State &trial, const Evaluation &evaluation, Iteration &iteration) const
  {
    potential.get_free_dofs().gather(evaluation.gradient, iteration.gradient);
    iteration.contact = contact.gradient(trial.positions);
  }

  double
  QuasiNewton::find_step(const State &trial, const Evaluation &evaluation, Iteration &iteration)
  {
    StepClock::Scope     scope(clock, Phase::solve);
    std::vector<double> &step = iteration.rotated;
    step.resize(iteration.gradient.size());
    std::transform(iteration.gradient.begin(), iteration.gradient.end(), step.begin(),
                   std::negate<>());
    metric.rotate_back(step);
    const WeightLimits         limits = potential.get_weights().limits_of_changes(trial.weights);
    const std::vector<double> &weight_gradient = evaluation.elastic.weight_gradient;
    std::vector<double>        changes = metric.find_weight_changes(step, weight_gradient, limits);
    if (!iteration.contact.empty())
    {
      std::vector<double> of_gaps = iteration.contact;
      metric.rotate_back(of_gaps);
      add(step, 1., of_gaps);
    }
    ContactModel::Direction direction;
    const bool              touches = in_contact || !iteration.contact.empty();
    std::vector<double>     of_body = touches ? step : std::vector<double>();
    metric.add_example_forces(changes, step);
    if (contact.is_possible())
    {
      direction.forces            = step;
      direction.weight_changes    = std::move(changes);
      direction.greatest_gradient = potential.get_free_dofs().max_magnitude(evaluation.gradient);
    }
    if (touches)
      contact.find_free_step(of_body, direction);
    else
    {
      contact.forget_response();
      lbfgs.before(step);
      metric.apply(step);
      lbfgs.after(step);
      direction.step.swap(step);
    }
    iteration.gaps.reset();
    if (contact.is_possible())
    {
      iteration.gaps = contact.add_contact(trial.positions, { weight_gradient, limits }, direction);
      in_contact |= iteration.gaps != nullptr;
    }
    step.swap(direction.step);
    iteration.direct = step;
    metric.rotate_forth(iteration.direct);
    return potential.get_free_dofs().exchange().sum(dot(iteration.direct, iteration.gradient));
  }

  double
  QuasiNewton::expected_change(const Iteration &iteration,
                               const double     slope,
                               const double     length) const
  {
    const double linear = length * slope;
    if (iteration.gaps == nullptr)
      return linear;
    // barriers are so far from linear that their slope promises much more than there is
    const double change
        = linear + potential.get_free_dofs().exchange().sum(iteration.gaps->beyond_slope(length));
    return change < 0. && change >= linear ? change : min_promise * linear;
  }

  double
  QuasiNewton::slope_along(const std::vector<double> &step, const Evaluation &evaluation) const
  {
    const FreeDofs     &free_dofs = potential.get_free_dofs();
    std::vector<double> gradient;
    free_dofs.gather(evaluation.gradient, gradient);
    return free_dofs.exchange().sum(dot(step, gradient));
  }

  bool
  QuasiNewton::take_step(const double slope,
                         State       &trial,
                         Evaluation  &evaluation,
                         SolveReport &report)
  {
    const FreeDofs            &free_dofs = potential.get_free_dofs();
    const std::vector<double> &step      = memory.iteration.direct;
    const Merit                before(potential, evaluation);
    double                    &length = report.step_length;
    report.newton_decrement           = -0.5 * slope;
    memory.displacement.reinit(trial.positions.size());
    free_dofs.add(1., step, memory.displacement);
    length = std::min(1., potential.max_step(trial.positions, memory.displacement));
    free_dofs.add(length, step, trial.positions);
    for (unsigned int halving = 0;; ++halving)
    {
      {
        StepClock::Scope scope(clock, Phase::evaluate);
        potential.minimize_over_weights(
            trial, in_contact ? RotationUse::update : RotationUse::find_and_forget, evaluation);
      }
      const Merit now(potential, evaluation);
      if (is_better(now, before, expected_change(memory.iteration, slope, length))
          || (in_contact && is_below_rounding(before, length * slope)
              && is_better_by_slopes(now, before, slope, slope_along(step, evaluation), length)))
        return true;
      if (halving == max_halvings)
      {
        free_dofs.add(-length, step, trial.positions);
        return false;
      }
      length *= 0.5;
      free_dofs.add(-length, step, trial.positions);
    }
  }

  void
  QuasiNewton::learn(const State               &trial,
                     const std::vector<double> &old_contact,
                     std::vector<double>       &old_weights,
                     std::vector<double>       &change,
                     const double               step_length,
                     Iteration                 &iteration)
  {
    StepClock::Scope scope(clock, Phase::solve);
    for (std::size_t i = 0; i < change.size(); ++i)
    {
      change[i] = iteration.gradient[i] - change[i];
      iteration.rotated[i] *= step_length;
    }
    if (!old_contact.empty())
      add(change, 1., old_contact);
    if (!iteration.contact.empty())
      add(change, -1., iteration.contact);
    metric.rotate_back(change);
    for (std::size_t i = 0; i < old_weights.size(); ++i)
      old_weights[i] = trial.weights[i] - old_weights[i];
    metric.add_example_forces(old_weights, change);
    contact.follow(lbfgs.add_pair(iteration.rotated, change), old_weights);
  }

  bool
  QuasiNewton::has_arrived(const State       &accepted,
                           const State       &trial,
                           const SolveReport &report,
                           const double       gradient_ratio,
                           Iteration         &iteration) const
  {
    const Exchange &exchange    = potential.get_free_dofs().exchange();
    const double    length      = report.step_length * exchange.max(max_entry(iteration.direct));
    const double    contraction = std::min(
           std::max(gradient_ratio, iteration.last_length > 0. ? length / iteration.last_length : 0.),
           max_contraction);
    const double slower        = std::max(contraction, iteration.last_contraction); // one alone may
    iteration.last_length      = length;                                            // be luck
    iteration.last_contraction = contraction;
    // the sum of the steps that would follow if they went on shrinking like this
    const double error = length * max_or_nan(min_error_over_length, slower / (1. - slower)),
                 moved = max_displacement(exchange, accepted, trial);
    // of a stiff body, or one that is carried far, small errors of positions are large ones of
    // forces
    const auto is_within = [&](const double tolerance)
    { return error <= tolerance * moved && report.residual <= tolerance; };
    iteration.is_nearly_there = is_within(nearly_there * parameters.step_tolerance);
    return is_within(parameters.step_tolerance);
  }

  void
  QuasiNewton::iterate(const State &accepted,
                       const double step_size,
                       State       &trial,
                       Evaluation  &evaluation,
                       SolveReport &report)
  {
    const FreeDofs      &free_dofs    = potential.get_free_dofs();
    std::vector<double> &old_gradient = memory.old_gradient;
    Iteration           &iteration    = memory.iteration;
    const unsigned int   most_metrics
        = potential.get_body().keeps_its_tangent() ? max_metrics : max_short_metrics;
    unsigned int n_metrics = 0, n_with_metric = 0, n_changes = 0;
    iteration.last_length = iteration.last_contraction = 0.;
    contact.forget_response();
    measure(trial, evaluation, iteration);
    iteration.is_nearly_there = false;
    for (bool is_near = false;;)
    {
      const bool is_solved = is_near || has_met(parameters.tolerance, report);
      if (potential.renew(trial, evaluation,
                          is_solved || (iteration.is_nearly_there && n_changes < n_early_changes))
          != TermChange::none)
      {
        report_or_stop(trial, evaluation, report);
        measure(trial, evaluation, iteration);
        if (++n_changes > max_changes)
          return;
        if (has_other_couplings())
          renew_metric(accepted, step_size, trial);
      }
      else if (is_solved)
        break;
      // limbs that give way turn so far that a step in the old frame would stretch them
      if (in_contact && n_with_metric > 0)
        turn_metric();
      memory.old_weights       = trial.weights;
      const double       slope = find_step(trial, evaluation, iteration);
      const unsigned int most  = in_contact ? max_contact_iterations : most_iterations();
      const bool         is_descent
          = n_with_metric < most && slope < 0. && take_step(slope, trial, evaluation, report);
      if (!is_descent)
      {
        if (++n_metrics > most_metrics || (in_contact && contact.has_many_gaps()))
          return;
        if (n_with_metric < most) // the line search gave up, and went back
        {
          StepClock::Scope scope(clock, Phase::evaluate);
          potential.minimize_over_weights(trial, RotationUse::update, evaluation);
        }
        measure(trial, evaluation, iteration);
        renew_metric(accepted, step_size, trial);
        n_with_metric = 0;
        is_near = iteration.is_nearly_there = false;
        continue;
      }
      ++report.iterations;
      ++n_with_metric;
      old_gradient.swap(iteration.gradient);
      memory.old_contact.swap(iteration.contact);
      measure(trial, evaluation, iteration);
      const auto norm = [&](const std::vector<double> &vector)
      { return std::sqrt(free_dofs.exchange().sum(dot(vector, vector))); };
      const double old_norm = norm(old_gradient);
      const double ratio    = norm(iteration.gradient) / old_norm;
      learn(trial, memory.old_contact, memory.old_weights, old_gradient, report.step_length,
            iteration);
      const bool goes_on = report_iteration(potential, evaluation, trial, report);
      is_near            = has_arrived(accepted, trial, report, ratio, iteration);
      if (!goes_on && !is_near && !has_met(parameters.tolerance, report))
        throw Interrupted("Interrupted.");
      if (!is_near && should_have_another(report.residual, ratio))
        n_with_metric = std::max(max_iterations, max_contact_iterations);
    }
    report.status = SolveStatus::converged;
  }
} // namespace Exemplar
