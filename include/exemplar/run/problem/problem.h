// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_problem_h
#define exemplar_problem_h

#include <exemplar/algebra/conditioning.h>
#include <exemplar/base/step_clock.h>
#include <exemplar/run/problem/energy_audit.h>
#include <exemplar/run/problem/laboratory.h>
#include <exemplar/run/problem/problem_parts.h>
#include <exemplar/run/problem/session_player.h>
#include <exemplar/run/problem/step_interval.h>
#include <exemplar/solvers/step_solver.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// All parts of a scene, in order of dependency. Parts that the scene does not need are absent.
  class Problem
  {
  public:
    /// `inputs` come from read_inputs(), or are arrays of a program: then the scene needs no file.
    /// `clock` may run since the inputs are read. Throws UserError for any invalid scene; writes
    /// nothing.
    Problem(const CompleteScene &scene, Inputs inputs, StepClock clock = StepClock(Phase::read));

    /// Make a problem of the body that inputs have been turned into, or of this process' part of
    /// it.
    Problem(const CompleteScene &scene, BodyInputs given, StepClock clock = StepClock(Phase::read));

    /// Solve the scene's next step from `state` and replace that if the solve succeeds; see
    /// next_step(). Throws Interrupted if the solver's `observe` or `may_go_on` stops it: then the state and
    /// solver_memory() are those at the end of the last step.
    SolveReport
    advance();

    /// Solve a step with another end and length, as from step_of() and others.
    SolveReport
    advance(const StepInterval &step);

    /// Replace the formulas of a handle's motion by `motion` from the next step on. Throws
    /// UserError if no handle has this name.
    void
    set_motion(const std::string &handle, Motion motion);

    /// Between steps, let `change` alter which nodes handles hold, by hold(), let_go() and grab().
    /// Released degrees of freedom keep their velocity. Throws UserError, with nothing changed, for
    /// interpolations, and as Constraints::change_handles(). All processes must call this.
    void
    change_handles(const std::function<void(Handles &)> &change);

    /// Between steps, change constants of the cells. Patches stay those of the initial constants.
    /// Throws UserError, with nothing changed, for numbers that Material::with() refuses. All
    /// processes must call this and the three functions below.
    void
    set_material(const ChangedConstants &changed);

    /// Between steps, change the importance of the examples. Throws as check_importance().
    void
    set_importance(double importance);

    /// Throws UserError for a scene without examples, an interpolation, or a number outside (0, 1].
    void
    check_importance(double importance) const;

    /// Between steps, let weights that are found minimise another of the examples' energies. Throws as
    /// check_energy().
    void
    set_energy(ExampleEnergy energy);

    /// Throws UserError for a scene without examples, an interpolation, and an energy that the scene does not allow.
    void
    check_energy(ExampleEnergy energy) const;

    /// Between steps, prescribe the examples' weights from the next step on, by region one after
    /// the other; empty: weights are unknown again. Throws UserError, with nothing changed, for
    /// weights that ExampleWeights::hold() refuses.
    void
    hold_weights(const std::vector<double> &weights);

    /// Between steps, change gravity [m/s^2]. Throws UserError for an interpolation.
    void
    set_gravity(const std::array<double, 3> &acceleration);

    /// Between steps, set forces [N] on the nodes of this process, by degree of freedom, which add
    /// to other loads and follow their Ramp; empty: none. Throws UserError for an interpolation.
    void
    set_nodal_forces(Vector forces);

    /// Between steps, let the fibres of each cell pull with these tensions [Pa], one for all active fibres or one a cell, at
    /// all times; empty: as the scene says. Throws UserError, with nothing changed, for a scene without Material/Fibre
    /// tension, for a wrong number, and for tensions that are negative or of cells without active fibres. It is no change
    /// for steps that are recorded.
    void
    set_tension(std::vector<double> tensions);

    /// The same of one region, FibreTensions::Source::region(), times its painted factors; others keep what they have.
    void
    set_tension(const std::string &region, double tension);

    /// The number of the region among FibreTensions::sources. Throws UserError if it has no active fibres, or for a
    /// negative tension [Pa].
    unsigned int
    check_tension(const std::string &region, double tension) const;

    /// Between steps, replace the pose of example i, counted as the weights, by these positions of
    /// the nodes [m]. Handles that follow a pose keep the earlier one. Throws UserError, with
    /// nothing changed, for the rest pose, a missing example, and positions that are no valid pose.
    void
    set_pose(unsigned int i, const std::vector<dealii::Point<3>> &places);

    /// Between steps, change mass damping [1/s] and stiffness damping [s]. Throws as
    /// check_damping().
    void
    set_damping(double mass_damping, double stiffness_damping);

    /// Throws UserError for a scene that is not dynamic, and for negative numbers.
    void
    check_damping(double mass_damping, double stiffness_damping) const;

    /// Between steps, add a term to Phi that does not belong to Psi. Throws exceptions of `make`,
    /// and UserError for an interpolation, with nothing changed. All processes must call this.
    void
    add_term(const MakeTerm &make);

    /// Between steps, add an obstacle, with what files would say of it. What touches it now stands, as
    /// at the beginning of a scene. Throws UserError, with nothing changed, as the scene's obstacles
    /// are refused, and for a name that one has. All processes must call this.
    void
    add_obstacle(const ObstacleParameters &obstacle, const ObstacleSurface &surface = {});

    /// Between steps, add an obstacle of a shape without files that is clear of the body, as is_clear() says. Throws UserError as
    /// add_obstacle().
    void
    put_obstacle(const ObstacleParameters &obstacle);

    /// Whether the body is farther from such an obstacle than the distance from which it would push. Throws UserError as
    /// add_obstacle().
    bool
    is_clear(const ObstacleParameters &obstacle) const;

    /// Let an obstacle go straight, in the next step of this length [s], to this displacement [m] from where it would be
    /// without. Throws UserError for a name that none has.
    void
    carry_obstacle(const std::string &name, const SpaceVector3 &displacement, double step_size);

    /// Between steps, take an obstacle away. Its name stays in use. Throws UserError for a name that none has.
    void
    remove_obstacle(const std::string &name);

    /// The body of cells; not for a shell.
    ElasticPotential &
    cells() const
    {
      auto *const of_cells = dynamic_cast<ElasticPotential *>(elastic.get());
      AssertThrow(of_cells != nullptr, dealii::ExcMessage("A shell has no cells."));
      return *of_cells;
    }

    /// Whether some cell's law has a trait; those of a shell have none.
    template <typename Trait>
    bool
    has_trait(const Trait trait) const
    {
      return !body.mesh.is_shell() && cells().get_field().get_batches().has_trait(trait);
    }

    /// The potential at arbitrary arguments, for use between steps; made at the first call. Throws
    /// UserError if several processes share the body.
    Laboratory &
    laboratory();

    /// Count and last kind of the changes by problem_changes.cc: steps before and after a change
    /// belong to different problems.
    struct Changes
    {
      unsigned int n = 0;
      std::string  last;

      /// Count a change of `what`, named as in messages.
      void
      count(const std::string &what)
      {
        ++n;
        last = what;
      }
    };

    /// Tell the audit of energies that `what` changes from outside, so that it begins again.
    void
    restart_audit(const std::string &what);

    /// The audit of energies; null for a scene that has none.
    const EnergyAudit *
    get_audit() const
    {
      return audit.get();
    }

    /// Changes since the problem was made; an increased count tells of more.
    const Changes &
    get_changes() const
    {
      return changes;
    }

    /// Evaluate at a state that is not the end of a step.
    void
    start(State &at);

    /// Continue from a state of an earlier run.
    void
    resume_from(const State &earlier, const std::string &solver_memory = "");

    /// The solver's memory beside the state, for resume_from().
    std::string
    solver_memory() const;

    /// Message for a step that advance() could not make: the cause, the step and the remedy.
    std::string
    failure_message(const SolveReport &report) const;

    /// Conditioning of the linear systems solved last.
    Conditioning
    conditioning() const;

    /// Warnings of all parts.
    std::vector<std::string>
    warnings() const;

    CompleteScene                      parameters;
    StepClock                          clock;
    const TimeAxis                     time_axis;
    Body                               body;
    Constraints                        constraints;
    Examples                           examples;
    Actions                            actions;
    const std::unique_ptr<ElasticBody> elastic;   ///< cells, or the triangles of a shell
    IncrementalPotential               potential; ///< of these and terms
    StepSystem                         system;
    const std::unique_ptr<StepSolver>  solver;
    State                              state;
    Evaluation                         evaluation; ///< at the state

    /// Called after each step with the state at its start and its length [s]; may be null.
    std::function<void(const State &start, double size)> on_step;

  private:
    /// advance(), which may be interrupted.
    SolveReport
    make_step(const StepInterval &step);

    /// Whether this step ends with starts from the examples.
    bool
    starts_from_examples(const StepInterval &step) const;

    /// Whether the first increment has the whole loads, which it did not solve.
    bool
    loads_act_at_once() const;

    /// Throws what boost's archives throw.
    void
    load_memory(const std::string &solver_memory);

    /// Update the parts that depend on what has changed, in order of dependency, by the bits of
    /// problem_changes.cc.
    void
    refresh(unsigned int changed);

    /// Warn of poses in which surfaces cross that must not.
    void
    review_poses_in_contact();

    /// Warn of tensions of fibres that are too great. Throws SolverFailure for negative ones.
    void
    review_tensions();

    /// Let handles hold as in a step that begins at this time [s].
    void
    follow_time(double time);

    /// The state has slopes as they are held in a step that begins at the end of this one.
    void
    hold_slopes_as_in(unsigned int step);

    /// Let slopes of a shell that have been caught be places of tips in the state, and those that have been let go slopes.
    void
    follow_slopes();

    /// Count a change of `what` from outside, named as in messages.
    void
    count_change(const std::string &what);

    /// make_step() for held nodes and session events that are those of the step. Sets `gains_energy` if the energy audit
    /// does not accept the solution.
    SolveReport
    solve_step(const StepInterval &interval, bool &gains_energy);

    /// Turn a report on the step to `next` into a failure if the audit of energies refuses it. Returns whether it does.
    bool
    audit_step(const State &next, const StepInterval &interval, SolveReport &report);

    /// Whether an increment of statics that ends there may be made in parts.
    bool
    has_parts(const StepInterval &interval) const;

    /// Repeat an increment that the audit did not accept in parts, whose work is known better. Returns `refused`, the
    /// report of the whole increment, if no number of parts is accepted.
    SolveReport
    make_step_in_parts(const StepInterval &interval, const SolveReport &refused);
    /// The obstacle of this name. Throws UserError if there is none.
    Obstacle &
    find_obstacle(const std::string &name);

    /// Take over obstacles that are made already. Changes the term of obstacles, or adds it.
    void
    append_obstacle(const ObstacleParameters &obstacle, std::unique_ptr<Obstacles> added);

    /// Obstacles of this one, apart from the others. Throws UserError as add_obstacle().
    std::unique_ptr<Obstacles>
    make_obstacle(const ObstacleParameters &obstacle, const ObstacleSurface &surface) const;

    /// Make loads if there are none. Throws UserError for an interpolation.
    void
    require_loads();

    Changes                        changes;
    HeldTips                       slopes_held; ///< Constraints::held_tips as the state has them
    State                          spare;   ///< memory of a step's end, with the one before in it
    std::unique_ptr<Laboratory>    lab;     ///< null until it is used
    std::unique_ptr<SessionPlayer> session; ///< null unless the scene has one
    std::unique_ptr<EnergyAudit>   audit;   ///< null where energies have no balance
  };

  /// Reads or makes the body of a problem.
  using ReadBody = std::function<BodyInputs(const CompleteScene &)>;

  /// The problem of a scene whose body `read` returns. Throws UserError for any failure, as the
  /// scene is to blame before the first step.
  std::unique_ptr<Problem>
  make_problem(const CompleteScene &parameters, const ReadBody &read);

  /// The problem of a scene with the files that it names. See read_inputs() for `announce`.
  std::unique_ptr<Problem>
  make_problem(const CompleteScene &parameters, const Announce &announce = {});
} // namespace Exemplar

#endif
