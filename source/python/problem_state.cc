// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/sealed_file.h>
#include <exemplar/base/version.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/module_parts.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/vector.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The serialized version and state, as bytes to be sealed.
    std::string
    bytes_of(const SavedState &saved)
    {
      std::ostringstream bytes;
      bytes << EXEMPLAR_VERSION << '\n';
      boost::archive::binary_oarchive(bytes) << saved;
      return bytes.str();
    }

    SavedState
    state_in(std::istream &bytes)
    {
      SavedState saved;
      try
      {
        boost::archive::binary_iarchive(bytes) >> saved;
      }
      catch (
          const std::exception &error) // intact, but written by a machine or library that differs
      {
        throw UserError(fmt::format("The state was pickled by another build of exemplar {}, of "
                                    "which this one cannot read the bytes ({}). Keep arrays to "
                                    "carry it over: positions, velocities, weights, time.",
                                    EXEMPLAR_VERSION, error.what()));
      }
      return saved;
    }

    /// The pickled form of a state: bytes with their digest.
    py::object
    pickled(const SavedState &saved)
    {
      return py::bytes(sealed(bytes_of(saved)));
    }

    /// The state from the result of pickled(). Throws UserError for anything else: bytes that were
    /// changed, and those of another version of exemplar.
    SavedState
    unpickled(const py::object &kept)
    {
      const auto whole = py::isinstance<py::bytes>(kept) ? unsealed(kept.cast<std::string>())
                                                         : std::optional<std::string>();
      if (!whole)
        throw UserError(
            "The pickle of an exemplar.State is damaged, or of an earlier exemplar, whose "
            "pickles had no digest. Pickle the state anew, and keep arrays to read it "
            "for years: positions, velocities, weights, time.");
      std::istringstream bytes(*whole);
      std::string        version;
      std::getline(bytes, version);
      if (version != EXEMPLAR_VERSION)
        throw UserError(
            fmt::format("The state was pickled by exemplar {}, but this is {}. Keep "
                        "arrays to read it later: positions, velocities, weights, time.",
                        version, EXEMPLAR_VERSION));
      return state_in(bytes);
    }

    /// A read-only array of numbers of a state, in the memory of its Python object.
    py::array
    shown(const py::object &owner, const double *numbers, std::vector<py::ssize_t> shape)
    {
      py::array_t<double> array(std::move(shape), numbers, owner);
      array.attr("flags").attr("writeable") = false;
      return array;
    }

    const State &
    state_of(const py::object &object)
    {
      return object.cast<const SavedState &>().state;
    }

    py::object
    rows_of_nodes(const py::object &owner, const Vector &field)
    {
      if (field.size() == 0)
        return py::none();
      return shown(owner, field.begin(), { py::ssize_t(field.size() / 3), 3 });
    }

    py::array
    row(const py::object &owner, const std::vector<double> &numbers)
    {
      return shown(owner, numbers.data(), { py::ssize_t(numbers.size()) });
    }

    /// Replaces a nodal field by an array.
    void
    replace_field(const py::object &rows, const std::string &what, Vector &field)
    {
      if (rows.is_none())
        return;
      if (field.size() == 0)
        throw UserError(what
                        + " cannot be replaced: the state is of a problem that is not dynamic, "
                          "and has none.");
      const auto points = points_of(rows, what, py::ssize_t(field.size() / 3));
      for (std::size_t node = 0; node < points.size(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          field[3 * node + c] = points[node][c];
    }

    unsigned int
    step_of_state(const py::object &object)
    {
      const double step = real_number_of(object, "step");
      if (!(step >= 0. && step <= std::numeric_limits<int>::max() && step == std::floor(step)))
        throw UserError("step must be a whole number from 0.");
      return static_cast<unsigned int>(step);
    }

    SavedState
    replaced(const SavedState &saved,
             const py::object &positions,
             const py::object &velocities,
             const py::object &weights,
             const py::object &time,
             const py::object &step)
    {
      SavedState result = saved;
      result.memory     = ""; // it is of steps that did not lead here
      State &state      = result.state;
      replace_field(positions, "positions", state.positions);
      replace_field(velocities, "velocities", state.velocities);
      if (!weights.is_none())
      {
        const auto n  = py::ssize_t(state.weights.size());
        state.weights = numbers_of(weights, "weights", n);
        if (py::ssize_t(state.weights.size()) != n)
          throw UserError(fmt::format("weights must be an array of shape ({},).", n));
      }
      if (!time.is_none())
        state.time = real_number_of(time, "time");
      if (!step.is_none())
        state.step = step_of_state(step);
      state.previous_step = 0.; // a scheme of two steps begins anew
      return result;
    }

    void
    add_numbers_of_state(py::class_<SavedState> &type)
    {
      const auto add = [&type](const char *name, auto get, const char *doc)
      { type.def_property_readonly(name, get, doc); };
      add(
          "positions",
          [](const py::object &self) { return rows_of_nodes(self, state_of(self).positions); },
          "Positions (n, 3) [m] of all nodes, with Element = P2 those in the middles of edges, "
          "too,\n"
          "in the order of final.msh with Final pose = quadratic. Read only, no copy.");
      add(
          "velocities",
          [](const py::object &self) { return rows_of_nodes(self, state_of(self).velocities); },
          "Velocities (n, 3) [m/s], as positions; None unless dynamic.");
      add(
          "weights", [](const py::object &self) { return row(self, state_of(self).weights); },
          "Weights of the examples, as problem.weights. Read only.");
      add(
          "history", [](const py::object &self) { return row(self, state_of(self).history); },
          "What laws remember, such as plastic strains, and of a shell the angles at its edges: "
          "equally\n"
          "many numbers for each cell, one cell after the other; empty if nothing is. Read only.");
      add(
          "time", [](const py::object &self) { return state_of(self).time; },
          "[s] in a dynamic scene, else from 0 to 1.");
      add(
          "step", [](const py::object &self) { return state_of(self).step; },
          "How many steps have led to it.");
    }

    void
    add_state_type(py::module_ &module)
    {
      py::options options;
      options.disable_function_signatures();
      py::class_<SavedState> type(
          module, "State",
          "Where a problem stands: problem.state. It does not change when the problem goes on, can "
          "be\n"
          "copied, pickled and compared, and set as problem.state. Beside what it shows it holds "
          "what\n"
          "the solver remembers, so that steps from it are the same bytes each time.");
      type.def(py::init(
          [](const py::args &, const py::kwargs &) -> SavedState
          {
            throw py::type_error(
                "A State is got from a problem: problem.state. Other arrays in it: "
                "problem.state.replace(positions=...).");
          }));
      add_numbers_of_state(type);
      type.def(
          "replace", &replaced, py::kw_only(), py::arg("positions") = py::none(),
          py::arg("velocities") = py::none(), py::arg("weights") = py::none(),
          py::arg("time") = py::none(), py::arg("step") = py::none(),
          "replace(*, positions=None, velocities=None, weights=None, time=None, step=None)"
          " -> exemplar.State\n\n"
          "A state with other values: positions (n, 3) [m], velocities (n, 3) [m/s], weights (k),\n"
          "time [s] or 0 to 1, step. What the solver remembers is left out. Raises UserError for\n"
          "other shapes and for what is not finite.");
      type.def("replace",
               [](const SavedState &, const py::args &, const py::kwargs &) -> SavedState
               {
                 throw py::type_error("replace is called as replace(positions=..., velocities=..., "
                                      "weights=..., time=..., step=...), with the names.");
               });
      type.def("__eq__",
               [](const SavedState &a, const SavedState &b) { return a.state == b.state; });
      type.def("__eq__", [](const SavedState &, const py::object &) { return false; });
      type.attr("__hash__") = py::none();
      type.def("__copy__", [](const SavedState &saved) { return saved; });
      type.def("__deepcopy__", [](const SavedState &saved, const py::object &) { return saved; });
      type.def(py::pickle(&pickled, &unpickled));
      // one way for all protocols: the oldest two have none of their own
      type.def("__reduce__",
               [](const py::object &self)
               {
                 return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"),
                                       py::make_tuple(py::type::of(self)),
                                       pickled(self.cast<const SavedState &>()));
               });
      type.def("__repr__",
               [](const SavedState &saved)
               {
                 return fmt::format("<exemplar.State: step {}, time {:.6g}, {} nodes>",
                                    saved.state.step, saved.state.time,
                                    saved.state.positions.size() / 3);
               });
    }

    SolveReport
    make_step(HeldProblem &held, const py::object &dt)
    {
      if (dt.is_none())
        return held.step();
      return held.step(step_of(held.get(), real_number_of(dt, "step(dt=None): dt")));
    }

    SolveReport
    go_to(HeldProblem &held, const py::object &object)
    {
      const double time = real_number_of(object, "goto(time): time");
      const double now  = held.get().state.time;
      if (!std::isfinite(time) || now - time > 1e-9 * held.get().time_axis.step_size(1))
        throw UserError(fmt::format("goto({:.9g}): the problem is at t = {:.9g}, and goes forward "
                                    "alone. Set an earlier state, or call reset().",
                                    time, now));
      if (held.get().parameters.scene != SceneKind::dynamic && time > 1.)
        throw UserError(
            fmt::format("goto({:.9g}): in a scene that is not dynamic t ends at 1.", time));
      while (!has_reached(held.get(), time))
        held.step(step_towards(held.get(), time));
      return held.get_report();
    }
  } // namespace

  void
  add_saved_states(py::module_ &module, ProblemClass &problem)
  {
    add_state_type(module);
    problem.def_property(
        "state", &HeldProblem::save,
        [](HeldProblem &held, const py::object &saved)
        {
          if (!py::isinstance<SavedState>(saved))
            throw py::type_error(
                "state must be an exemplar.State, but is " + description(saved)
                + ". Arrays are put into one by problem.state.replace(positions=...).");
          held.restore(&saved.cast<const SavedState &>());
        },
        "Where the problem stands, an exemplar.State. Setting it puts the problem there, with the "
        "work\n"
        "done until then; residual and the other numbers of the last step begin anew. Steps from "
        "it\n"
        "are the same bytes as when it was got, unless the problem was changed since: then what "
        "the\n"
        "solver remembers is left out. Motions, handles and numbers that were changed stay "
        "changed.\n"
        "Raises UserError for a state of another body, and RuntimeError within a step.");
    problem.def(
        "step", &make_step, py::arg("dt") = py::none(),
        "step(dt=None) -> exemplar.Report\n\n"
        "Make the next step and return its Report. dt [s], in a scene that is not dynamic a part "
        "of\n"
        "its time from 0 to 1: how long the step is; None: as the scene says. After the scene's "
        "end\n"
        "dynamics go on by Time/Step, and others are solved once more at t = 1, as they are then.\n"
        "With Scheme = bdf2 steps of changing length keep its order (while they grow by less than\n"
        "2.4 from one to the next). Raises SolverFailure if the step cannot be solved, "
        "Interrupted\n"
        "if a callback stopped it, KeyboardInterrupt, and whatever a callback raises; the problem "
        "is\n"
        "then as it was before, unless step_number says that the step was made. Other Python\n"
        "threads run meanwhile.");
    problem.def(
        "goto", &go_to, py::arg("time"),
        "goto(time) -> exemplar.Report\n\n"
        "Make steps until `time` [s] (in a scene that is not dynamic 0 to 1), the last one\n"
        "shorter if it must be; return the last Report. Raises UserError for a time that has\n"
        "gone by, and what step() raises: the problem is then at its last good step.");
    problem.def(
        "reset", [](HeldProblem &held) { held.restore(); },
        "reset()\n\n"
        "Back to the initial state. Steps are then the same bytes as at first, but for what was "
        "changed\n"
        "since: motions, handles and numbers that were changed stay changed. Raises RuntimeError\n"
        "within a step.");
    refuse_other_arguments(problem, "step",
                           "step is called as step(dt=None), with the length of the "
                           "step. Some steps: for _ in range(5): problem.step().");
    refuse_other_arguments(problem, "goto", "goto is called as goto(time).");
    refuse_other_arguments(problem, "reset", "reset() takes no argument.");
  }
} // namespace Exemplar::Python
