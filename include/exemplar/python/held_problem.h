// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_held_problem_h
#define exemplar_held_problem_h

#include <exemplar/python/from_python.h>
#include <exemplar/python/kept_functions.h>
#include <exemplar/python/saved_state.h>
#include <exemplar/python/state_arrays.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/state_review.h>

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace Exemplar::Python
{
  /// A problem that Python holds. Steps are made without Python's lock; meanwhile other threads are
  /// refused, and callbacks of the step may only read. It owns the functions of Python, and arrays
  /// do not own it: what refers to both could never be freed.
  class HeldProblem : public std::enable_shared_from_this<HeldProblem>
  {
  public:
    /// Takes the arguments of from_python(). Throws UserError.
    HeldProblem(const pybind11::object &scene,
                const pybind11::object &mesh,
                const pybind11::object &poses);

    /// Makes the next step, or that of `other`. Throws SolverFailure, Interrupted and whatever
    /// callbacks throw; the problem is then as it was before the step.
    SolveReport
    step(const std::optional<StepInterval> &other = {});

    /// Makes all steps that are left; returns the report of the last one. `after_step` is called
    /// after each.
    SolveReport
    run(const std::function<void()> &after_step = {});

    /// Between steps, call `function` without Python's lock; `what` is the name of the caller.
    /// Throws RuntimeError while a step is made, and what `function` throws.
    void
    use(const std::string &what, const std::function<void(Problem &)> &function);

    /// use() for a function that changes the problem or sets its state. Throws UserError, too,
    /// while the problem is recorded.
    void
    change(const std::string &what, const std::function<void(Problem &)> &function);

    /// The state with the solver's memory. Throws RuntimeError while a step is made.
    SavedState
    save() const;

    /// Continue from a saved state, by default from the beginning. Throws UserError for a state of
    /// another body, and RuntimeError while a step is made.
    void
    restore(const SavedState *saved = nullptr);

    void
    set_motion(const pybind11::object &name, const pybind11::object &function);

    /// Add to Phi a term that calls a function, see make_function_term().
    void
    add_term(const pybind11::object &function);

    /// Set the function that is called after each iteration; None removes it.
    void
    on_iteration(const pybind11::object &function);

    /// The scene that the problem was made of.
    const SceneSource &
    get_source() const
    {
      return source;
    }

    /// The files that the problem was made of.
    const InputStamps &
    get_inputs() const
    {
      return inputs;
    }

    /// The call that has changed the problem since it was made, such as "set_material()"; empty:
    /// none. Throws RuntimeError while a step is made.
    std::string
    change_since_made() const;

    KeptFunctions &
    get_functions()
    {
      return functions;
    }

    /// The problem, to be read. Throws RuntimeError while another thread makes a step.
    const Problem &
    get() const;

    /// The warnings of the program, so far. Python is given each when it is found.
    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

    const SolveReport &
    get_report() const
    {
      return report;
    }

    StateArrays &
    get_arrays()
    {
      return arrays;
    }

    /// Whether this thread is making a step. Throws RuntimeError while another one does.
    bool
    in_step() const;

    /// Whether another thread is making a step: get() would throw.
    bool
    is_of_another_thread() const
    {
      return stepping != std::thread::id() && stepping != std::this_thread::get_id();
    }

    /// The numbers of a row of statistics.csv, without seconds, from columns that begin with
    /// `prefix`.
    pybind11::dict
    statistics(const std::string &prefix) const;

  private:
    explicit HeldProblem(Given given);

    /// Issues some warnings. Throws what a filter of Python's warnings makes of them.
    void
    warn(const std::vector<std::string> &some);

    /// Warns of functions that move handles too far in the next step, or away from rest at the
    /// beginning; once until one is set anew.
    void
    warn_of_motions();

    /// Throws RuntimeError while a step is made; `what` is the name of the caller.
    void
    require_no_step(const std::string &what) const;

    /// Throws UserError while a trajectory records the problem; `what` is the name of the caller.
    void
    require_not_recorded(const std::string &what) const;

    /// Check the user's terms that have not acted before. Throws UserError for a gradient that is
    /// not its energy's, and what functions raise.
    void
    check_new_terms();

    /// After a step that failed with this message: throw UserError or SolverFailure if one of the
    /// user's terms is to blame.
    void
    blame_terms(const std::string &failure) const;

    /// Called after each iteration; returns whether to go on.
    bool
    observe(const SolveReport &iteration);

    /// A step of the solver that leaves the problem as it was if it throws.
    SolveReport
    advance(const StepInterval &interval);

    const SceneSource              source;
    const InputStamps              inputs;
    KeptFunctions                  functions;
    const std::shared_ptr<Problem> problem; ///< its memory is shared with arrays
    StateArrays                    arrays;
    std::vector<std::string>       warnings;
    Diagnostics                    diagnostics;
    const SavedState               initial;
    StateReview                    review;
    SolveReport                    report;
    std::thread::id stepping; ///< the thread that makes a step; none: no step is made
    bool            is_stopped           = false; ///< whether the callback stopped the solver
    bool            is_warned_of_motions = false;
  };
} // namespace Exemplar::Python

#endif
