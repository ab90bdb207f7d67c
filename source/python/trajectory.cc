// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/problem_gradients.h>
#include <exemplar/python/trajectory.h>
#include <exemplar/run/adjoint/trajectory_gradients.h>

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

    /// Callback after each step. It does not own the steps, which a trajectory does.
    struct Recorder
    {
      std::weak_ptr<RecordedSteps> steps;
      const Problem               *problem;

      void
      operator()(const State &start, const double size) const
      {
        if (const auto kept = steps.lock())
          kept->add(*problem, start, size);
      }
    };

  } // namespace

  /// Steps of a problem, recorded in a with statement.
  struct Trajectory
  {
    std::shared_ptr<HeldProblem>   held;
    std::shared_ptr<RecordedSteps> steps; ///< null before it begins

    const RecordedSteps &
    get() const
    {
      if (steps == nullptr)
        throw UserError("Nothing is recorded yet: with problem.record() as trajectory: ...");
      return *steps;
    }
  };

  static const char *
  how_to_get(const Trajectory * /*type*/)
  {
    return "A Trajectory is got from a problem: with problem.record() as trajectory: ...";
  }
} // namespace Exemplar::Python

namespace pybind11::detail
{
  template <>
  struct type_caster<Exemplar::Python::Trajectory>
      : Exemplar::Python::MadeCaster<Exemplar::Python::Trajectory>
  {
  };
} // namespace pybind11::detail

namespace Exemplar::Python
{
  bool
  is_recorded(const Problem &problem)
  {
    const Recorder *recorder = problem.on_step.target<Recorder>();
    return recorder != nullptr && !recorder->steps.expired();
  }

  namespace
  {
    Trajectory
    record(HeldProblem &held)
    {
      RecordedSteps known(held.get()); // throws if it is not made
      return { held.shared_from_this(), {} };
    }

    void
    begin(Trajectory &trajectory)
    {
      trajectory.held->use("record()",
                           [&](Problem &problem)
                           {
                             if (trajectory.steps != nullptr)
                               throw UserError("record(): this trajectory has its steps. Record "
                                               "others by a call of record() of their own.");
                             if (is_recorded(problem))
                               throw UserError("record(): the problem is being recorded. Leave "
                                               "the with statement that does it first.");
                             trajectory.steps = std::make_shared<RecordedSteps>(problem);
                             problem.on_step  = Recorder{ trajectory.steps, &problem };
                           });
    }

    void
    end(Trajectory &trajectory)
    {
      trajectory.held->use("the end of record()",
                           [&](Problem &problem)
                           {
                             const Recorder *recorder = problem.on_step.target<Recorder>();
                             if (recorder != nullptr && recorder->steps.lock() == trajectory.steps)
                               problem.on_step = nullptr;
                           });
    }

    /// The rows (n, 3) of a field at the vertices, in the memory of a step, which the array keeps
    /// alive.
    py::array
    rows(const Trajectory &trajectory, const Vector &field)
    {
      const std::size_t n
          = std::min<std::size_t>(field.size() / 3, trajectory.held->get().body.mesh.n_nodes());
      const py::capsule   owner(new std::shared_ptr<RecordedSteps>(trajectory.steps), [](void *kept)
                                { delete static_cast<std::shared_ptr<RecordedSteps> *>(kept); });
      py::array_t<double> array({ py::ssize_t(n), py::ssize_t(3) }, field.begin(), owner);
      array.attr("flags").attr("writeable") = false;
      return array;
    }

    /// A list with an entry a step.
    template <typename Function>
    py::list
    of_steps(const Trajectory &trajectory, const Function &entry)
    {
      py::list entries;
      for (unsigned int i = 0; i < trajectory.get().size(); ++i)
        entries.append(entry(trajectory.get().step(i)));
      return entries;
    }

    /// The entries for the steps in a list of arrays and None; null where they are None. `check`
    /// throws UserError for an array that does not fit a step, which messages name.
    template <typename Check>
    std::vector<Numbers>
    arrays_of(const py::object  &list,
              const std::string &what,
              const std::size_t  n_steps,
              const Check       &check)
    {
      std::vector<Numbers> arrays(n_steps);
      if (list.is_none())
        return arrays;
      if (!py::isinstance<py::sequence>(list) && !py::isinstance<py::array>(list))
        throw UserError(fmt::format("vjp: {} must be a list with an entry for each of the {} "
                                    "steps, but is {}.",
                                    what, n_steps, description(list)));
      if (py::len(list) != n_steps)
        throw UserError(fmt::format("vjp: {} has {} entries, but {} steps were recorded. Give each "
                                    "an array, or None for zero.",
                                    what, py::len(list), n_steps));
      for (std::size_t i = 0; i < n_steps; ++i)
      {
        const py::object entry = list[py::int_(i)];
        if (entry.is_none())
          continue;
        check(entry, fmt::format("vjp: {}[{}]", what, i));
        arrays[i] = entry.cast<Numbers>();
      }
      return arrays;
    }

    dealii::ArrayView<const double>
    view(const Numbers &array)
    {
      return { array.data(), static_cast<std::size_t>(array.size()) };
    }

    py::dict
    to_python(TrajectoryGradients found, const std::size_t n_vertices)
    {
      py::dict result = gradients_to_python(found.all, n_vertices);
      py::list handles;
      for (const std::vector<double> &of_step : found.handles)
        handles.append(py::array_t<double>({ py::ssize_t(found.held_nodes.size()), py::ssize_t(3) },
                                           of_step.data()));
      result["handles_of_steps"] = handles;
      if (!found.tension.empty())
      {
        py::list tension;
        for (const std::vector<double> &of_step : found.tension)
          tension.append(py::array_t<double>(py::ssize_t(of_step.size()), of_step.data()));
        result["fibre_tension"] = tension;
      }
      result["held_nodes"] = py::array_t<unsigned int>(py::ssize_t(found.held_nodes.size()),
                                                       found.held_nodes.data());
      if (found.mass_damping)
      {
        result["mass_damping"]       = *found.mass_damping;
        result["stiffness_damping"]  = *found.stiffness_damping;
        result["initial_velocities"] = array_of_nodes(std::move(*found.initial_velocities));
      }
      if (found.initial_positions)
        result["initial_positions"] = array_of_nodes(std::move(*found.initial_positions));
      py::list weak;
      for (const auto &[step, weight] : found.weakly_active)
        weak.append(py::make_tuple(step, weight));
      result["weakly_active"] = weak;
      return result;
    }

    py::dict
    vjp_of_steps(const Trajectory &trajectory,
                 const py::object &by_positions,
                 const py::object &by_weights,
                 const py::object &by_velocities)
    {
      const RecordedSteps &steps   = trajectory.get();
      const Problem       &problem = trajectory.held->get();
      if (problem.actions.integrator == nullptr && !by_velocities.is_none())
        throw UserError("vjp: dJ_dv must be None, as the scene is not dynamic.");
      const auto n         = py::ssize_t(problem.body.mesh.n_nodes());
      const auto n_all     = py::ssize_t(problem.body.fe_space.n_nodes());
      const auto n_weights = problem.state.weights.size();
      const auto of_nodes  = [n, n_all](const py::object &entry, const std::string &what)
      { points_of(entry, what, has_rows(entry, n_all) ? n_all : n); };
      const auto of_weights = [n_weights](const py::object &entry, const std::string &what)
      { check_weight_derivatives(entry, what, n_weights); };
      const auto                    x = arrays_of(by_positions, "dJ_dx", steps.size(), of_nodes);
      const auto                    w = arrays_of(by_weights, "dJ_dw", steps.size(), of_weights);
      const auto                    v = arrays_of(by_velocities, "dJ_dv", steps.size(), of_nodes);
      std::vector<StateDerivatives> by_states;
      for (unsigned int i = 0; i < steps.size(); ++i)
        by_states.push_back({ view(x[i]), view(w[i]), view(v[i]) });
      TrajectoryGradients found;
      trajectory.held->use("vjp()", [&](Problem &changed)
                           { found = trajectory_gradients(changed, steps, by_states); });
      return to_python(std::move(found), problem.body.mesh.n_nodes());
    }

    void
    add_states(py::class_<Trajectory> &type)
    {
      type.def("__len__", [](const Trajectory &trajectory)
               { return trajectory.steps == nullptr ? 0 : trajectory.steps->size(); });
      type.def("__repr__",
               [](const Trajectory &trajectory)
               {
                 const std::size_t n = trajectory.steps == nullptr ? 0 : trajectory.steps->size();
                 return fmt::format("<exemplar.Trajectory of {} step{}>", n, n == 1 ? "" : "s");
               });
      type.def_property_readonly(
          "times",
          [](const Trajectory &trajectory)
          { return of_steps(trajectory, [](const RecordedStep &step) { return step.time; }); },
          "When each step ends [s]: a list.");
      type.def_property_readonly(
          "positions",
          [](const Trajectory &trajectory)
          {
            return of_steps(trajectory, [&](const RecordedStep &step)
                            { return rows(trajectory, step.positions); });
          },
          "A list with the positions of the mesh's nodes, n rows of 3 [m], at the end of each "
          "step.\n"
          "Read only, no copies.");
      type.def_property_readonly(
          "velocities",
          [](const Trajectory &trajectory)
          {
            return of_steps(trajectory, [&](const RecordedStep &step)
                            { return rows(trajectory, step.velocities); });
          },
          "A list with the velocities [m/s], as positions; with empty arrays unless dynamic.");
      type.def_property_readonly(
          "weights",
          [](const Trajectory &trajectory)
          {
            return of_steps(trajectory,
                            [&](const RecordedStep &step) {
                              return py::array_t<double>(py::ssize_t(step.weights.size()),
                                                         step.weights.data());
                            });
          },
          "A list with the weights of the examples at the end of each step, each a copy.");
    }

    void
    add_type(py::module_ &module)
    {
      py::options options;
      options.disable_function_signatures();
      py::class_<Trajectory> type(
          module, "Trajectory",
          "Steps of a problem, recorded for gradients through them: with problem.record() as "
          "trajectory.\nIts length is the number of steps. It keeps the problem, which does not "
          "keep it.");
      type.def("__enter__",
               [](const py::object &self)
               {
                 begin(self.cast<Trajectory &>());
                 return self;
               });
      type.def("__exit__", [](Trajectory &trajectory, const py::args &) { end(trajectory); });
      refuse_pickling(type, "Keep its lists: times, positions, velocities, weights.");
      suggest_attributes(type);
      add_states(type);
      type.def(
          "vjp", &vjp_of_steps, py::arg("dJ_dx"), py::arg("dJ_dw") = py::none(),
          py::arg("dJ_dv") = py::none(),
          "vjp(dJ_dx, dJ_dw=None, dJ_dv=None) -> dict[str, Any]\n\n"
          "Gradients of a function J of the positions, weights and velocities at the ends of the\n"
          "recorded steps, from its derivatives there: lists with an entry for each step, (n, 3),\n"
          "(k,) and (n, 3), or None for zero. It takes one linear system a step, whatever the\n"
          "number of parameters. The dictionary has what problem.vjp() returns, by what holds for\n"
          "all steps, with\n"
          "  handles (n, 3)          by a displacement [m] of held nodes that is the same in all "
          "steps\n"
          "  held_nodes (h,)         the nodes of which a component is held\n"
          "  fibre_tension           a list of (m,), by the tension of each cell in each step; "
          "with active fibres\n"
          "  handles_of_steps        a list of (h, 3), by their positions at the end of each step\n"
          "  weakly_active           a list of (step, weight), both from 0\n"
          "and of a dynamic scene, with all else where it is,\n"
          "  mass_damping, stiffness_damping          floats\n"
          "  initial_positions, initial_velocities    (n, 3), of the state at the beginning; the "
          "first\n"
          "                                           of a static scene with friction, too\n"
          "With quadratic elements rows are those of problem.vjp(): dJ_dx and dJ_dv have one for "
          "each\n"
          "vertex or for each node, initial_positions and initial_velocities one for each node.\n"
          "Raises UserError for scenes whose gradients are not known (doc/gradients.md), where a "
          "cell\n"
          "has no unique rotation, where the problem was changed since it was recorded, by what,\n"
          "and for lists and arrays of other sizes; SolverFailure if a tangent is not positive\n"
          "definite. The problem stays as it is.");
      type.def("vjp",
               [](const Trajectory &, const py::args &, const py::kwargs &) -> py::dict
               { throw py::type_error("vjp is called as vjp(dJ_dx, dJ_dw=None, dJ_dv=None)."); });
    }
  } // namespace

  void
  add_trajectories(py::module_ &module, ProblemClass &problem)
  {
    add_type(module);
    problem.def(
        "record", &record,
        "record() -> exemplar.Trajectory\n\n"
        "with problem.record() as trajectory: records the steps that are made there, for\n"
        "gradients of functions of them: trajectory.vjp(). A static scene is recorded as a\n"
        "dynamic one, each increment as a step. Motions may change meanwhile, and steps "
        "be of\n"
        "any length; what else would change the problem, or set its state, raises UserError\n"
        "there. Positions, velocities and weights are kept. Raises UserError, by name, for\n"
        "scenes through whose steps no gradients are known.");
    refuse_other_arguments(problem, "record",
                           "record() takes no argument: with problem.record() as trajectory: ...");
  }
} // namespace Exemplar::Python
