// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/version.h>
#include <exemplar/base/words.h>
#include <exemplar/python/evaluation.h>
#include <exemplar/python/from_python.h>
#include <exemplar/python/module_parts.h>
#include <exemplar/python/problem_gradients.h>
#include <exemplar/python/problem_type.h>
#include <exemplar/python/trajectory.h>
#include <exemplar/python/unlocked_work.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <fmt/core.h>
#include <pybind11/stl.h>

#include <algorithm>

namespace py = pybind11;

namespace Exemplar::Python
{
  namespace
  {
    /// Imports numpy beforehand: pybind11 would do so when first used, and the import of a module
    /// lets other threads run, which could then deadlock with pybind11.
    void
    import_numpy()
    {
      try
      {
        py::module_::import("numpy");
        py::dtype::of<double>();
      }
      catch (py::error_already_set &error)
      {
        if (!error.matches(PyExc_ImportError))
          throw;
        py::raise_from(error, PyExc_ImportError,
                       "exemplar needs numpy, which this Python cannot import. Install it (Debian: "
                       "apt-get install python3-numpy; elsewhere: pip install numpy).");
        throw py::error_already_set();
      }
    }

    void
    add_exceptions(py::module_ &module)
    {
      const auto add
          = [&module](const auto *type, const char *name, const py::handle &base, const char *doc)
      {
        using Exception = std::remove_const_t<std::remove_pointer_t<decltype(type)>>;
        py::register_exception<Exception>(module, name, base).attr("__doc__") = doc;
      };
      add(static_cast<UserError *>(nullptr), "UserError", PyExc_ValueError,
          "The input is wrong; the message says what, where, what is allowed and the remedy.");
      add(static_cast<SolverFailure *>(nullptr), "SolverFailure", PyExc_ArithmeticError,
          "A step could not be solved. The problem is as it was before the step.");
      add(static_cast<Interrupted *>(nullptr), "Interrupted", PyExc_RuntimeError,
          "A callback has returned False.");
    }

    void
    add_report(py::module_ &module)
    {
      py::class_<SolveReport> type(module, "Report", "How a step was solved, or how far it is.");
      refuse_pickling(type, "Keep its numbers.");
      suggest_attributes(type);
      type.def_property_readonly(
              "status", [](const SolveReport &report) { return status_name(report.status); },
              "'converged' or 'one pass'; 'initial' before it ends.")
          .def_readonly("iterations", &SolveReport::iterations, "How many were made.")
          .def_readonly("residual", &SolveReport::residual,
                        "Of the forces, relative: doc/solver.md, Eq. (13).")
          .def_readonly("kkt_residual", &SolveReport::kkt_residual, "Of the weights, relative.")
          .def_readonly("residual_history", &SolveReport::residual_history,
                        "A list, one residual an iteration.")
          .def_readonly("step_length", &SolveReport::step_length,
                        "Of the last iteration, as the line search left it; 1 is all of it.")
          .def_readonly("factorizations", &SolveReport::factorizations, "In this step.")
          .def_readonly(
              "newton_decrement", &SolveReport::newton_decrement,
              "Half of what the energy would fall by along the slope of the last step [J].")
          .def("__repr__",
               [](const SolveReport &report)
               {
                 return py::str("<exemplar.Report: {}, {}, residual {:.2g}>")
                     .format(status_name(report.status), counted(report.iterations, "iteration"),
                             report.residual);
               });
    }

    using Class = ProblemClass;

    /// A message on wrong arguments of exemplar.Problem, by their names and number.
    std::string
    describe_arguments(const py::args &given, const py::kwargs &named)
    {
      const std::vector<std::string> names{ "scene", "mesh", "poses" };
      const std::string usage = "It is called as exemplar.Problem(scene, mesh=None, poses=None).";
      for (const auto &argument : named)
      {
        const std::string name     = text_of(argument.first, "Problem: the name of an argument");
        const auto        position = std::find(names.begin(), names.end(), name) - names.begin();
        const std::string nearest  = nearest_word(name, names);
        if (static_cast<std::size_t>(position) < given.size() && position < 3)
          return "Problem has got its argument '" + name + "' twice. " + usage;
        if (position == 3)
          return "Problem has no argument '" + name + "'. "
                 + (!nearest.empty() ? "Did you mean '" + nearest + "'? " : "")
                 + (name.find("thread") != std::string::npos
                        ? "A problem uses one thread; several are solved at once in as many "
                          "threads of Python, as in doc/python/sweep.py. "
                        : "All else is said by the keys of the scene. ")
                 + usage;
      }
      return given.size() > names.size()
                 ? fmt::format("Problem has got {} arguments. {}", given.size(), usage)
                 : "Problem has got no scene. " + usage;
    }

    void
    add_actions(Class &problem)
    {
      problem.def(
          "run", [](HeldProblem &held) { return held.run(); },
          "run() -> exemplar.Report\n\n"
          "Make steps to the scene's end, Time/End or t = 1, the last one shorter if it\n"
          "must be; return the last Report. Warns if the end is reached.");
      problem.def(
          "set_motion", &HeldProblem::set_motion, py::arg("name"), py::arg("function"),
          "set_motion(name, function)\n\n"
          "From the next step on let a function move the handle `name`.\n\n"
          "function(rest, t) gets the rest positions (k, 3) [m] of the handle's nodes and the\n"
          "time t [s], and returns their displacements (k, 3) [m]. It may be called several\n"
          "times for one t, and must then return the same. Raises UserError for a name\n"
          "that is no handle's.");
      problem.def(
          "on_iteration", &HeldProblem::on_iteration, py::arg("function"),
          "on_iteration(function)\n\n"
          "Call function(report) after each iteration of a step; None: call nothing.\n\n"
          "If it returns False, the step is abandoned and Interrupted raised, unless the step\n"
          "ends with this iteration. Raises TypeError if `function` cannot be called.");
      refuse_other_arguments(problem, "run",
                             "run() takes no argument: it makes all steps that are left. Some of "
                             "them: for _ in range(5): problem.step().");
      refuse_other_arguments(problem, "set_motion",
                             "set_motion is called as set_motion(name, function).");
      refuse_other_arguments(problem, "on_iteration",
                             "on_iteration is called as on_iteration(function), or with None.");
      add_refusals_to_set(problem);
    }

    void
    add_state(Class &problem)
    {
      problem.def_property_readonly(
          "positions",
          [](HeldProblem &held) { return held.get_arrays().positions(held.in_step()); },
          "Positions (n, 3) [m] of the nodes, read only, in the mesh's order. No copy is made. "
          "The\n"
          "array shows the state at which it was asked for, also after later steps: ask again for\n"
          "the new one.");
      problem.def_property_readonly(
          "velocities",
          [](HeldProblem &held) { return held.get_arrays().velocities(held.in_step()); },
          "Velocities (n, 3) [m/s], as positions; None unless dynamic.");
      problem.def_property_readonly(
          "rest_positions", [](HeldProblem &held) { return held.get_arrays().rest_positions(); },
          "Rest positions (n, 3) [m], read only, no copy.");
      problem.def_property_readonly(
          "cells", [](HeldProblem &held) { return held.get_arrays().cells(); },
          "Nodes (m, 4) of the tetrahedra, from 0, each positively\n"
          "oriented; uint32, read only, no copy.");
      problem.def_property_readonly(
          "weights",
          [](const HeldProblem &held)
          {
            const std::vector<double> &weights = held.get().state.weights;
            py::array_t<double> copy(static_cast<py::ssize_t>(weights.size()), weights.data());
            copy.attr("flags").attr("writeable") = false; // writing would change nothing
            return copy;
          },
          "Weights of the examples, the rest pose first if it is one (additive keys: weight_1 of\n"
          "the statistics first); of each region one after the other if there are several. Empty\n"
          "without examples. A copy, read only.");
      problem.def_property_readonly(
          "time", [](const HeldProblem &held) { return held.get().state.time; },
          "[s] in a dynamic scene, else from 0 to 1.");
      problem.def_property_readonly(
          "step_number", [](const HeldProblem &held) { return held.get().state.step; },
          "How many steps are made.");
      problem.def_property_readonly(
          "n_steps", [](const HeldProblem &held) { return held.get().time_axis.n_steps(); },
          "How many steps the scene has; step() makes more.");
    }

    /// A type of dictionaries whose KeyError lists the names that there are.
    py::object
    make_measures_type()
    {
      py::dict members;
      members["__module__"] = "exemplar";
      members["__doc__"]    = "A dictionary of numbers by their columns in statistics.csv.";
      py::object type
          = py::module_::import("builtins")
                .attr("type")("Measures", py::make_tuple(py::type::of(py::dict())), members);
      const auto missing = [](const py::dict &measures, const py::object &name)
      {
        std::vector<std::string> names;
        std::string              list;
        for (const auto &entry : measures)
        {
          names.emplace_back(py::str(entry.first));
          list += (list.empty() ? "" : ", ") + names.back();
        }
        const std::string nearest = nearest_word(py::str(name), names);
        throw py::key_error("there is no " + std::string(py::repr(name))
                            + (nearest.empty() ? "" : ". Did you mean '" + nearest + "'?")
                            + " (there: " + list + ")");
      };
      type.attr("__missing__")
          = py::cpp_function(missing, py::name("__missing__"), py::is_method(type));
      return type;
    }

    void
    add_measures(Class &problem, const py::object &measures)
    {
      problem.def_property_readonly(
          "residual", [](const HeldProblem &held) { return held.get_report().residual; },
          "Relative residual of the last step, doc/solver.md, Eq. (13); 0 before the first.");
      problem.def_property_readonly(
          "energies",
          [measures](const HeldProblem &held) { return measures(held.statistics("energy_")); },
          "The energies [J] of the state by their columns in statistics.csv: energy_elastic, ...");
      problem.def_property_readonly(
          "statistics",
          [measures](const HeldProblem &held) { return measures(held.statistics("")); },
          "All numbers of the state's row in statistics.csv, seconds aside: reactions of handles,\n"
          "work, momenta, ... doc/output.md explains them.");
      problem.def_property_readonly("warnings", &HeldProblem::get_warnings,
                                    "What the program would warn of: a list of strings. Each is "
                                    "also a UserWarning of\n"
                                    "Python when it is found: as the problem is made, in a step, "
                                    "or after the last.");
    }

    void
    add_problem(py::module_ &module)
    {
      Class       problem(module, "Problem",
                          "An elastic body with example poses, as a scene describes it.",
                          py::custom_type_setup(support_garbage_collection));
      py::options options;
      options.disable_function_signatures(); // they would show the overloads that refuse
      problem.def(
          py::init<const py::object &, const py::object &, const py::object &>(), py::arg("scene"),
          py::arg("mesh") = py::none(), py::arg("poses") = py::none(),
          "Problem(scene, mesh=None, poses=None)\n\n"
          "scene: the path of a .prm file, its text (of several lines), or a dictionary of "
          "sections\n"
          "with the keys of doc/parameters.md. Lists are joined as the key needs it; Handles and\n"
          "Loads need no Names.\n"
          "mesh: (nodes (n, 3) float, cells (m, 4) int from 0), or with material ids (m) as a "
          "third,\n"
          "instead of a file; in metres, unless Mesh/Scale makes metres of them.\n"
          "poses: a list of arrays (n, 3) as the nodes, instead of Examples/Poses.\n"
          "Raises UserError.");
      problem.def(py::init(
          [](const py::args &given, const py::kwargs &named) -> std::shared_ptr<HeldProblem>
          { throw py::type_error(describe_arguments(given, named)); }));
      add_actions(problem);
      add_state(problem);
      add_saved_states(module, problem);
      add_changes(problem);
      add_obstacles(problem);
      add_evaluation(problem);
      add_cell_arrays(problem);
      add_body(problem);
      add_write(problem);
      add_terms(problem);
      add_gradients(problem);
      add_trajectories(module, problem);
      const py::object measures = make_measures_type();
      module.attr("Measures")   = measures; // where pickle looks for it
      add_measures(problem, measures);
      add_plot(problem);
      add_live(problem);
      refuse_pickling(problem, "Pickle its state, problem.state, and make the problem anew.");
      suggest_attributes(problem);
    }
  } // namespace
} // namespace Exemplar::Python

PYBIND11_MODULE(exemplar, module)
{
  using namespace Exemplar;
  Python::import_numpy();
  module.doc()
      = "Elastic solids that deform the way their examples say. doc/python.md has examples.";
  module.attr("__version__") = EXEMPLAR_VERSION;
  Python::add_exceptions(module);
  Python::add_report(module);
  Python::add_problem(module);
  module.def(
      "use_one_blas_thread", &use_one_blas_thread,
      "Let BLAS use one thread in the whole process, numpy with it if it uses the same BLAS.\n"
      "A problem that is made, steps or gives gradients does so for that while by itself;\n"
      "evaluations at given places do not.\n"
      "Raises nothing.");
  Python::add_examples(module);
  Python::add_signatures(module);
  py::module_::import("atexit").attr("register")(py::cpp_function(&Python::UnlockedWork::end_all));
  dealii::MultithreadInfo::set_thread_limit(1);
  dealii::deal_II_exceptions::disable_abort_on_exception();
}
