// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/mpi_session.h>
#include <exemplar/base/words.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/from_python.h>
#include <exemplar/python/held_problem.h>
#include <exemplar/python/trajectory.h>
#include <exemplar/python/unlocked_work.h>
#include <exemplar/run/adjoint/functional.h>
#include <exemplar/run/problem/idle_review.h>
#include <exemplar/run/problem/motion_review.h>
#include <exemplar/run/problem/scene_review.h>
#include <exemplar/run/problem/unit_review.h>

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// Report a step to logging.getLogger("exemplar"), at level INFO. Costs nothing unless Python
    /// has imported logging. The caller holds Python's lock.
    void
    log_step(const Problem &problem, const SolveReport &report)
    {
      const py::dict modules = py::module_::import("sys").attr("modules");
      if (!modules.contains("logging")) // nobody listens
        return;
      const py::object logging = modules["logging"];
      const py::object logger  = logging.attr("getLogger")("exemplar");
      if (logger.attr("isEnabledFor")(logging.attr("INFO")).cast<bool>())
        logger.attr("info")(fmt::format(
            "step {} of {}, t = {:g}: {}, {}, residual {:.2g}", problem.state.step,
            std::max(problem.state.step, problem.time_axis.n_steps()), problem.state.time,
            status_name(report.status), counted(report.iterations, "iteration"), report.residual));
    }

    std::unique_ptr<Problem>
    make_unlocked(Given given)
    {
      UnlockedWork::check();
      const UnlockedWork unlocked;
      try
      {
        const CompleteScene scene(std::move(given.scene));
        return std::make_unique<Problem>(scene, read_inputs(scene, std::move(given.inputs)));
      }
      catch (const SolverFailure &failure)
      {
        throw UserError(failure.what()); // nothing has been solved yet: the input is to blame
      }
    }

    /// The session of MPI, which lasts until the process ends, as MPI cannot start twice.
    std::shared_ptr<MpiSession>
    mpi_session()
    {
      static const auto session = std::make_shared<MpiSession>();
      return session;
    }

    std::shared_ptr<Problem>
    make_problem(Given given)
    {
      const auto mpi      = mpi_session(); // ends after the last problem
      const auto end_last = [mpi](Problem *problem)
      {
        const UnlockedWork unlocked; // another thread may use Trilinos for long
        delete problem;
      };
      return { make_unlocked(std::move(given)).release(), end_last };
    }

    /// Whether a step may read files: surfaces that a handle follows are read when needed.
    bool
    reads_while_it_steps(const Problem &problem)
    {
      const auto &handles = problem.parameters.handles;
      return std::any_of(handles.begin(), handles.end(),
                         [](const HandleParameters &handle)
                         { return !handle.follow_cache.empty(); });
    }

    /// Marks the problem as stepped by this thread while it lives.
    class Stepping
    {
    public:
      explicit Stepping(std::thread::id &thread) : thread(thread)
      {
        thread = std::this_thread::get_id();
      }

      ~Stepping()
      {
        thread = std::thread::id();
      }

      Stepping(const Stepping &) = delete;
      Stepping &
      operator=(const Stepping &)
          = delete;

    private:
      std::thread::id &thread;
    };
  } // namespace

  namespace
  {
    /// Throws KeyboardInterrupt after Ctrl-C.
    void
    check_signals()
    {
      const py::gil_scoped_acquire lock;
      if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
      UnlockedWork::check();
    }
  } // namespace

  HeldProblem::HeldProblem(const py::object &scene, const py::object &mesh, const py::object &poses)
      : HeldProblem(from_python(scene, mesh, poses))
  {
  }

  HeldProblem::HeldProblem(Given given)
      : source(std::move(given.source)), inputs(std::move(given.stamps)),
        problem(make_problem(std::move(given))), arrays(problem), diagnostics(*problem),
        initial(save_state(*problem, {})), review(*problem)
  {
    problem->solver->observe = [this](const SolveReport &iteration) { return observe(iteration); };
    problem->solver->may_go_on = []
    {
      check_signals();
      return true;
    };
    require_functional(*problem);
    warn(problem->warnings());
    warn(unit_warnings(*problem));
    warn(scene_warnings(*problem));
    warn(motion_warnings(*problem));
    warn(idle_load_warnings(*problem));
  }

  void
  HeldProblem::warn(const std::vector<std::string> &some)
  {
    const py::gil_scoped_acquire lock;
    warnings.insert(warnings.end(), some.begin(), some.end());
    for (const std::string &warning : some)
      if (PyErr_WarnEx(PyExc_UserWarning, message_text(warning).c_str(), 1) != 0)
        throw py::error_already_set(); // a filter makes errors of warnings
  }

  const Problem &
  HeldProblem::get() const
  {
    if (is_of_another_thread())
      throw std::runtime_error("Another thread is making a step of this problem.");
    return *problem;
  }

  bool
  HeldProblem::in_step() const
  {
    get();
    return stepping != std::thread::id();
  }

  bool
  HeldProblem::observe(const SolveReport &iteration)
  {
    const py::gil_scoped_acquire lock;
    check_signals();
    if (functions.callback.is_none())
      return true;
    const py::object function = functions.callback; // a copy, as the call may replace it
    is_stopped
        = is_stopped
          || call(function, py::make_tuple(iteration), "on_iteration calls function(report).")
                 .is(py::bool_(false));
    return !is_stopped;
  }

  SolveReport
  HeldProblem::advance(const StepInterval &interval)
  {
    const auto go_back = [this] // evaluation and memory belong to the failed step
    { problem->resume_from(State(problem->state)); };
    try
    {
      warn_of_motions();
      check_new_terms();
      SolveReport result = problem->advance(interval);
      if (!is_success(result.status))
        throw SolverFailure(problem->failure_message(result));
      return result;
    }
    catch (const SolverFailure &failure)
    {
      go_back();
      blame_terms(failure.what());
      throw;
    }
    catch (...)
    {
      go_back();
      throw;
    }
  }

  void
  HeldProblem::require_no_step(const std::string &what) const
  {
    if (stepping == std::this_thread::get_id())
      throw std::runtime_error("A step of this problem is being made, and has called a function "
                               "that calls "
                               + what
                               + ". Such a function may only look at the problem; if that of "
                                 "on_iteration returns False, the step ends.");
    if (stepping != std::thread::id())
      throw std::runtime_error("A step of this problem is being made by another thread: " + what
                               + " must wait for its end.");
  }

  SolveReport
  HeldProblem::step(const std::optional<StepInterval> &other)
  {
    require_no_step("step()");
    const StepInterval interval = other.value_or(next_step(*problem));
    const bool         is_extra = has_reached(*problem, end_of_scene(*problem));
    UnlockedWork::check();
    arrays.let_go();
    const auto keep_alive = shared_from_this(); // a callback may drop the last other owner
    is_stopped            = false;
    std::vector<std::string> at_end;
    {
      const Stepping     this_one(stepping);
      const UnlockedWork unlocked;
      report = advance(interval);
      diagnostics.add_step();
      review.add_step(report);
      if (!is_extra && has_reached(*problem, end_of_scene(*problem)))
      {
        at_end = review.warnings();
        for (const std::string &warning : missed_example_warnings(*problem))
          at_end.push_back(warning);
      }
    }
    log_step(*problem, report);
    warn(at_end);
    if (is_stopped)
      throw Interrupted(fmt::format("Interrupted after step {}.", problem->state.step));
    return report;
  }

  SolveReport
  HeldProblem::run(const std::function<void()> &after_step)
  {
    const double end = end_of_scene(*problem);
    if (has_reached(*problem, end))
      warn({ fmt::format(
          "run() does nothing: all {} steps of the scene are made. step() makes more, "
          "and reset() begins anew.",
          problem->time_axis.n_steps()) });
    while (!has_reached(*problem, end))
    {
      step(step_towards(*problem, end));
      if (after_step)
        after_step();
    }
    return report;
  }

  void
  HeldProblem::use(const std::string &what, const std::function<void(Problem &)> &function)
  {
    require_no_step(what);
    UnlockedWork::check();
    const auto         keep_alive = shared_from_this(); // other threads may drop it meanwhile
    const Stepping     this_one(stepping);
    const UnlockedWork unlocked; // ends before the problem is anybody's again
    function(*problem);
  }

  void
  HeldProblem::require_not_recorded(const std::string &what) const
  {
    if (is_recorded(*problem))
      throw UserError(
          what
          + ": the problem is being recorded, and gradients are known through the steps "
            "of one problem alone. Do it before the with statement of record(), or "
            "after it.");
  }

  void
  HeldProblem::change(const std::string &what, const std::function<void(Problem &)> &function)
  {
    require_no_step(what);
    require_not_recorded(what);
    use(what, function);
  }

  SavedState
  HeldProblem::save() const
  {
    require_no_step("state");
    return save_state(*problem, diagnostics.get_work());
  }

  void
  HeldProblem::restore(const SavedState *saved)
  {
    const SavedState &target = saved == nullptr ? initial : *saved;
    const std::string what   = saved == nullptr ? "reset()" : "state";
    require_no_step(what);
    require_not_recorded(what);
    if (reads_while_it_steps(*problem))
      inputs.require_unchanged(what);
    check_fits(target, *problem);
    arrays.let_go();
    change(what, [&target](Problem &changed) { restore_state(target, changed); });
    diagnostics.resume(target.work);
    report               = {};
    is_warned_of_motions = false;
  }

  std::string
  HeldProblem::change_since_made() const
  {
    require_no_step("live()");
    for (const auto &[handle, function] : functions.motions)
      if (function) // null for a name that is no handle's
        return "set_motion()";
    if (problem->get_changes().n > 0)
      return problem->get_changes().last;
    if (problem->state == initial.state)
      return "";
    return problem->state.step > 0 ? "step()" : "state";
  }

  py::dict
  HeldProblem::statistics(const std::string &prefix) const
  {
    py::dict numbers;
    for (const StatisticsCell &cell : diagnostics.row(get().state, report))
      if (cell.column.compare(0, prefix.size(), prefix) == 0)
        std::visit(
            [&](const auto &value)
            {
              if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>)
                numbers[py::str(cell.column)] = py::float_(static_cast<double>(value));
            },
            cell.value);
    return numbers;
  }

  // The functions of Python that move handles and look at iterations.

  void
  HeldProblem::set_motion(const py::object &name, const py::object &function)
  {
    if (!py::isinstance<py::str>(name))
      throw py::type_error("set_motion(name, function): the name of a handle must be a str, but is "
                           + description(name) + ".");
    if (PyCallable_Check(function.ptr()) == 0)
      throw py::type_error("set_motion(name, function): function is called as function(rest, t), "
                           "but is "
                           + description(function)
                           + ". Displacements that do not change: lambda rest, t: displacements.");
    const std::string handle = text_of(name, "set_motion: the name of the handle");
    require_no_step("set_motion()");
    py::object &kept
        = functions.motions[handle]; // null if there is no such handle, which the next line says
    problem->set_motion(handle, motion_of(handle, kept));
    kept                 = function;
    is_warned_of_motions = false;
  }

  void
  HeldProblem::on_iteration(const py::object &function)
  {
    if (!function.is_none() && !PyCallable_Check(function.ptr()))
      throw py::type_error("on_iteration needs a function or None.");
    functions.callback = function;
  }

  void
  HeldProblem::warn_of_motions()
  {
    if (functions.motions.empty() || is_warned_of_motions)
      return;
    std::vector<std::string> found = next_step_warnings(*problem);
    is_warned_of_motions           = !found.empty();
    found.erase(std::remove_if(found.begin(), found.end(), // known ones, of formulas
                               [this](const std::string &warning) {
                                 return std::count(warnings.begin(), warnings.end(), warning) > 0;
                               }),
                found.end());
    warn(found);
  }
} // namespace Exemplar::Python
