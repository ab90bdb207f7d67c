// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/words.h>
#include <exemplar/body/pose_checks.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/run/problem/balance.h>
#include <exemplar/run/problem/body_contact_start.h>
#include <exemplar/run/problem/example_starts.h>
#include <exemplar/run/problem/finiteness.h>
#include <exemplar/run/problem/initial_state.h>
#include <exemplar/run/problem/obstacle_start.h>
#include <exemplar/run/problem/problem.h>

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// Angle [rad] to which the cell that supports an interpolation may turn before the body is
    /// turned back: the matrix is singular at 90 degrees. With frozen forces the body is always
    /// turned back, as solutions depend on that cell's rotation.
    constexpr double max_turn = 0.7;

    /// The number of places for functions that move bodies rigidly, which count nodes of the whole body.
    unsigned int
    places_of_body(const NodeNumbering &nodes)
    {
      return nodes.has_slopes() ? nodes.n_places() : all_places;
    }

    /// Whether the body has a support of its own, which must not determine its rotation.
    bool
    turns_freely(const Problem &problem)
    {
      return problem.constraints.support
             && traits_of(problem.parameters.model.law()).is_frame_indifferent;
    }

    /// An interpolation starts at the example of greatest weight, unless Initial gives a pose.
    void
    start_interpolation(const InitialParameters &initial, const ExamplePoses &poses, State &state)
    {
      if (!initial.pose.empty() || !initial.pose_function.empty())
        return;
      const auto maximum = std::max_element(state.weights.begin(), state.weights.end());
      state.positions    = poses.pose((maximum - state.weights.begin()) % poses.size());
    }
  } // namespace

  Problem::Problem(const CompleteScene &scene, Inputs inputs, StepClock running_clock)
      : Problem(scene, make_body_inputs(scene, std::move(inputs)), std::move(running_clock))
  {
  }

  Problem::Problem(const CompleteScene &scene, BodyInputs given, StepClock running_clock)
      : parameters(with_factor_beside_barriers(scene)), clock(std::move(running_clock)),
        time_axis(make_time_axis(parameters)), body(parameters, given),
        constraints(parameters, body, time_axis, given),
        examples(parameters, body, time_axis, given), actions(parameters, body, given),
        elastic(make_elastic_body(parameters, body, examples.poses, examples.weights, constraints)),
        potential(*elastic,
                  examples.weights,
                  constraints.free_dofs,
                  actions.make_terms(body, elastic.get(), actions.integrator.get()),
                  actions.integrator.get(),
                  is_assembled_in_parts(parameters.solver, body.fe_space, examples.weights.size())),
        system(
            potential,
            [this] { return make_bordered_system(parameters.solver, potential); },
            clock,
            turns_freely(*this) && !parameters.model.is_frozen()
                ? places_of_body(body.fe_space.numbering())
                : 0),
        solver(make_step_solver(parameters.solver, potential, system, constraints.handles, clock)),
        state(initial_state(parameters.initial,
                            body.mesh,
                            body.fe_space,
                            examples.weights,
                            parameters.scene == SceneKind::dynamic,
                            given.fields.poses))
  {
    constraints.check(parameters, body, time_axis);
    review_tensions();
    if (parameters.loads.balanced)
    {
      actions.initial_stresses = initial_stresses(parameters, body, examples, constraints,
                                                  actions.loads.get(), actions.warnings);
      potential.add_term(std::make_unique<InitialStressTerm>(cells().get_field(), body.fe_space,
                                                             actions.initial_stresses));
    }
    if (parameters.scene == SceneKind::interpolation)
      start_interpolation(parameters.initial, examples.poses, state);
    slopes_held.assign(constraints.held_tips.size(), held_in_space);
    follow_slopes();
    if (actions.body_contacts != nullptr)
      suit_body_contacts(*actions.body_contacts, *actions.contact_surface, body.fe_space,
                         constraints.free_dofs, state.positions, actions.notes);
    if (actions.obstacles != nullptr)
    {
      check_obstacle_motions(*actions.obstacles, body, time_axis);
      leave_room_for_shell(*actions.obstacles, parameters.obstacles, *actions.contact_surface,
                           time_axis, actions.notes);
      suit_obstacles(*actions.obstacles, *actions.contact_surface, body, state.positions, 0.,
                     actions.notes);
    }
    review_poses_in_contact();
    state.history = elastic->initial_history();
    start(state);
    check_start(*this);
    if (!parameters.session.empty())
    {
      session                  = std::make_unique<SessionPlayer>(*this);
      RecordedSession recorded = read_session(parameters.session);
      actions.warnings.insert(actions.warnings.end(), recorded.warnings.begin(),
                              recorded.warnings.end());
      if (!recorded.events.empty() && recorded.events.front().step > time_axis.n_steps())
        actions.warnings.push_back(fmt::format("Nothing of the session {} happens: its first line "
                                               "is of step {}, and the scene has {} steps. Enlarge "
                                               "Time/End.",
                                               parameters.session, recorded.events.front().step,
                                               time_axis.n_steps()));
      session->play(std::move(recorded.events), parameters.session);
    }
    if (EnergyAudit::is_possible(*this))
      audit = std::make_unique<EnergyAudit>(*this);
  }

  void
  Problem::review_poses_in_contact()
  {
    for (unsigned int i = 0; actions.body_contacts != nullptr && i < examples.poses.size(); ++i)
      if (std::string warning
          = crossing_pose_warning(*actions.body_contacts, *actions.contact_surface,
                                  examples.poses.pose(i), examples.poses.name(i));
          !warning.empty())
        actions.warnings.push_back(std::move(warning));
  }

  void
  Problem::review_tensions()
  {
    if (body.material.tensions().sources.empty())
      return;
    constexpr unsigned int most = 100; // times to look at
    std::vector<double>    times;
    const unsigned int     n = time_axis.n_steps(), stride = 1 + n / most;
    for (unsigned int step = 0; step < n; step += stride)
      times.push_back(time_axis.time(step));
    times.push_back(time_axis.time(n));
    FibreTensionTerm term(body.material, body.fe_space, actions.held_tensions);
    for (std::string &warning : describe_tensions(term, body.material, body.fe_space, times))
      actions.warnings.push_back(std::move(warning));
  }

  void
  Problem::start(State &at)
  {
    StepClock::Scope scope(clock, Phase::evaluate);
    potential.leave_step(at);
    potential.set_time(at.time, at);
    potential.evaluate(at, RotationUse::update, evaluation);
  }

  SolveReport
  Problem::advance()
  {
    return advance(next_step(*this));
  }

  SolveReport
  Problem::advance(const StepInterval &interval)
  {
    // which a step may change before it is made: slopes follow handles, and starts from examples forget
    const State       before = slopes_held.empty() ? State() : state;
    const std::string memory = starts_from_examples(interval) ? solver_memory() : "";
    try
    {
      return make_step(interval);
    }
    catch (const Interrupted &)
    {
      if (!slopes_held.empty())
      {
        state = before;
        hold_slopes_as_in(std::max(state.step, 1U) - 1);
      }
      if (!memory.empty())
        load_memory(memory);
      start(state);
      throw;
    }
  }

  bool
  Problem::starts_from_examples(const StepInterval &interval) const
  {
    return parameters.solver.starts == Starts::examples && interval.end == end_of_scene(*this);
  }

  SolveReport
  Problem::make_step(const StepInterval &interval)
  {
    if (session != nullptr)
      session->begin_step();
    check_weights(*this, interval);
    follow_time(state.time);
    bool        gains_energy = false;
    SolveReport report       = solve_step(interval, gains_energy);
    if (gains_energy && has_parts(interval))
      report = make_step_in_parts(interval, report);
    if (is_success(report.status) && on_step)
      on_step(spare, interval.size);
    return report;
  }

  SolveReport
  Problem::solve_step(const StepInterval &interval, bool &gains_energy)
  {
    constraints.handles.begin_step(state.time, state.positions);
    State &next = spare;
    next        = state;
    next.step   = state.step + 1;
    if (turns_freely(*this)
        && turn_to_support(*constraints.support, parameters.model.is_frozen() ? 0. : max_turn,
                           next.positions, body.exchange(),
                           places_of_body(body.fe_space.numbering())))
    {
      solver->forget(); // its memory has not turned with the body
      start(next);
    }
    const unsigned int factorizations_before = system.n_new_factorizations();
    SolveReport        report;
    try
    {
      report = solver->solve(next, evaluation, interval.end, interval.size);
    }
    catch (const SolverFailure &failure) // of a term with which the step cannot begin
    {
      report.status  = SolveStatus::failed;
      report.failure = failure.what();
    }
    report.factorizations = system.n_new_factorizations() - factorizations_before;
    if (is_success(report.status))
    {
      if (actions.integrator != nullptr)
        actions.integrator->end_step(state, next);
      if (turns_freely(*this))
      {
        align(state.positions, next.positions, body.exchange(),
              places_of_body(body.fe_space.numbering()));
        start(next);
      }
      if (starts_from_examples(interval))
        start_from_examples(*this, next, interval, report);
      refuse_what_is_not_finite(*this, next, report);
    }
    if (is_success(report.status))
    {
      potential.remember(next);
      gains_energy = audit_step(next, interval, report);
    }
    if (is_success(report.status))
    {
      potential.end_step(next);
      std::swap(state, next);
    }
    else
      solver->forget(); // its memory includes the failed step
    return report;
  }

  void
  Problem::set_motion(const std::string &handle, Motion motion)
  {
    constraints.handles.set_motion(handle, std::move(motion));
  }

  void
  Problem::resume_from(const State &earlier, const std::string &solver_memory)
  {
    if (session != nullptr)
      session->catch_up(earlier.step);
    state = earlier;
    solver->forget();
    if (!slopes_held.empty())
      hold_slopes_as_in(std::max(state.step, 1U) - 1);
    if (solver_memory.empty())
      follow_time(state.time);
    else
    {
      // memory is of the last step, and slopes that are released and held again are others by rounding
      follow_time(time_axis.time(std::max(state.step, 1U) - 1));
      load_memory(solver_memory);
    }
    start(state);
    if (audit != nullptr && solver_memory.empty())
      audit->restart("the state");
  }

  void
  Problem::load_memory(const std::string &solver_memory)
  {
    std::istringstream              bytes(solver_memory);
    boost::archive::binary_iarchive archive(bytes);
    solver->load(archive);
    for (const auto &term : potential.get_terms())
      term->load(archive);
    if (audit != nullptr)
      audit->load(archive);
    potential.get_tangent().follow_couplings();
    if (bytes.peek() != std::char_traits<char>::eof())
      throw boost::archive::archive_exception(
          boost::archive::archive_exception::input_stream_error);
  }

  std::string
  Problem::solver_memory() const
  {
    std::ostringstream bytes;
    {
      boost::archive::binary_oarchive archive(bytes);
      solver->save(archive);
      for (const auto &term : potential.get_terms())
        term->save(archive);
      if (audit != nullptr)
        audit->save(archive);
    }
    return bytes.str();
  }

  bool
  Problem::loads_act_at_once() const
  {
    return parameters.scene == SceneKind::statics && state.step == 0
           && parameters.loads.ramp == LoadRamp::none && actions.loads != nullptr
           && (actions.loads->has_gravity() || time_axis.n_steps() == 1);
  }

  std::string
  Problem::failure_message(const SolveReport &report) const
  {
    const std::string step = fmt::format("Step {}", state.step + 1);
    const std::string ramp = "The loads act in full from the first increment: let them grow over "
                             "the increments (Loads/Ramp = increments, Time/Increments = 100)";
    if (report.status == SolveStatus::failed || report.status == SolveStatus::indefinite)
    {
      const bool may_be_of_loads = report.status == SolveStatus::indefinite
                                   || report.failure.find("smaller steps") != std::string::npos;
      return step + (report.status == SolveStatus::failed ? " failed: " : " has no descent: ")
             + report.failure + (may_be_of_loads && loads_act_at_once() ? " " + ramp + "." : "");
    }
    std::ostringstream message;
    const bool         lacks_derivative = parameters.solver.method == Method::fixed_point
                                  && examples.poses.size() > 0
                                  && traits_of(parameters.model.law()).has_rotations
                                  && !traits_of(parameters.model.law()).exact_is_rotated;
    message << step
            << (report.status == SolveStatus::stalled ? " stalled"
                                                      : " stopped at its iteration limit")
            << ": residual " << report.residual << " after "
            << counted(report.iterations, "iteration") << ", tolerance "
            << parameters.solver.tolerance
            << (lacks_derivative
                    ? ". The matrix of a fixed point lacks a part of the consistent force's "
                      "derivative, so it may never converge: set Solver/Method = newton, "
                      "or Model/Gradient = frozen."
                : report.load_stages > 0 && parameters.scene == SceneKind::statics ? fmt::format(
                      " and {} stages in which the loads were raised. Let them grow over "
                      "the increments (Loads/Ramp = increments, Time/Increments = 100), or "
                      "look at the units of Young's modulus, density and lengths.",
                      report.load_stages)
                : loads_act_at_once()
                    ? ". " + ramp + ", or change Solver/Tolerance or Solver/Maximum iterations."
                    : ". Take smaller steps (Time/Step or Time/Increments), or change "
                      "Solver/Tolerance or Solver/Maximum iterations.");
    return message.str();
  }

  Conditioning
  Problem::conditioning() const
  {
    Conditioning result;
    result.matrix                           = system.bordered().traits().pivot_ratio;
    const dealii::FullMatrix<double> &schur = solver->schur_complement();
    if (schur.m() > 0)
      result.schur = condition_number(examples.weights.form_of_changes(schur));
    return result;
  }

  std::vector<std::string>
  Problem::warnings() const
  {
    std::vector<std::string> all = parameters.warnings;
    all.insert(all.end(), body.mesh.get_warnings().begin(), body.mesh.get_warnings().end());
    if (parameters.model.gradient == GradientKind::frozen && !parameters.model.is_frozen())
      all.push_back(
          "Model/Gradient = frozen holds rotations, which this Model/Strain does not have: "
          "its forces are the gradient of its energy.");
    const auto append = [&all](const auto &part)
    {
      if (part != nullptr)
        all.insert(all.end(), part->get_warnings().begin(), part->get_warnings().end());
    };
    all.insert(all.end(), body.warnings.begin(), body.warnings.end());
    if (body.made != nullptr)
      for (const std::string &warning : warnings_of(*body.made))
        all.push_back(warning);
    all.insert(all.end(), actions.warnings.begin(), actions.warnings.end());
    append(&constraints.handles);
    // statics refuse bodies that can rotate
    for (const std::string &warning : actions.mass != nullptr
                                          ? constraints.describe_single_nodes(body)
                                          : constraints.describe_pulled_nodes(parameters, body))
      all.push_back(warning);
    if (const std::string &function = parameters.initial.pose_function;
        !function.empty() && state.step == 0)
      if (const std::string problem
          = describe_displacements(function, body.mesh, body.fe_space, state.positions);
          !problem.empty())
        all.push_back("Initial/Pose function" + problem);
    append(&examples.poses);
    append(&examples.weights);
    return all;
  }

  std::unique_ptr<Problem>
  make_problem(const CompleteScene &parameters, const ReadBody &read)
  {
    try
    {
      const StepClock clock(Phase::read);
      return std::make_unique<Problem>(parameters, read(parameters), clock);
    }
    catch (const SolverFailure &failure)
    {
      throw UserError(failure.what());
    }
  }

  std::unique_ptr<Problem>
  make_problem(const CompleteScene &parameters, const Announce &announce)
  {
    return make_problem(parameters, ReadBody([&announce](const CompleteScene &scene)
                                             { return read_body(scene, announce); }));
  }
} // namespace Exemplar
