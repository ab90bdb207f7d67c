// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/from_python.h>
#include <exemplar/python/module_parts.h>
#include <exemplar/run/problem/scene_review.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    std::vector<double>
    constants_of(const py::object &object, const std::string &what, const Problem &problem)
    {
      if (object.is_none())
        return {};
      return numbers_of(object, "set_material: " + what, py::ssize_t(problem.body.mesh.n_cells()));
    }

    void
    set_material(HeldProblem      &held,
                 const py::object &young,
                 const py::object &poisson,
                 const py::object &density)
    {
      const Problem         &now = held.get();
      const ChangedConstants changed{ constants_of(young, "young", now),
                                      constants_of(poisson, "poisson", now),
                                      constants_of(density, "density", now) };
      held.change("set_material()",
                  [&changed](Problem &problem) { problem.set_material(changed); });
    }

    /// Of each cell [Pa]; 0 without active fibres.
    std::vector<double>
    tensions_of(const Problem &problem)
    {
      const FibreTensionTerm *const term = find_tension_term(problem.potential.get_terms());
      return term != nullptr ? term->tensions() : std::vector<double>(problem.body.mesh.n_cells());
    }

    /// Tensions by cell of a dictionary by regions, as Material names them; those that it does not name keep theirs.
    std::vector<double>
    tensions_by_region(const Problem &problem, const py::dict &by_region)
    {
      const FibreTensions &tensions = problem.body.material.tensions();
      std::vector<double>  all      = tensions_of(problem);
      for (const auto &[name, value] : by_region)
      {
        const auto        key = py::cast<std::string>(py::str(name));
        const std::string section
            = key == "Material" ? key : "Material/" + MaterialParameters::region_name(key);
        const auto source = std::find_if(tensions.sources.begin(), tensions.sources.end(),
                                         [&](const FibreTensions::Source &one)
                                         { return one.section == section; });
        if (source == tensions.sources.end())
        {
          std::string names;
          for (const FibreTensions::Source &one : tensions.sources)
            names += (names.empty() ? "" : ", ") + one.section;
          throw UserError("set_tension: there are no active fibres in " + section
                          + ". Allowed: " + (names.empty() ? "none" : names)
                          + ", without 'Material/region '; 'Material' is what no region is.");
        }
        const double number
            = numbers_of(py::reinterpret_borrow<py::object>(value), "set_tension: " + key, 1)[0];
        for (std::size_t cell = 0; cell < all.size(); ++cell)
          if (tensions.of_cells[cell]
              == 1 + static_cast<std::size_t>(source - tensions.sources.begin()))
            all[cell] = number;
      }
      return all;
    }

    void
    set_tension(HeldProblem &held, const py::object &region, const py::object &value)
    {
      const Problem      &now = held.get();
      std::vector<double> tensions;
      py::object          object = region;
      if (!value.is_none())
      {
        py::dict one;
        one[py::str(region)] = value;
        object               = one;
      }
      if (py::isinstance<py::dict>(object))
        tensions = tensions_by_region(now, py::reinterpret_borrow<py::dict>(object));
      else if (!object.is_none())
        tensions = numbers_of(object, "set_tension: tension", py::ssize_t(now.body.mesh.n_cells()));
      held.change("set_tension()",
                  [&tensions](Problem &problem) { problem.set_tension(tensions); });
    }

    double
    single_number(const py::object &object, const std::string &what)
    {
      return numbers_of(object, what, 1)[0];
    }

    void
    set_gravity(HeldProblem &held, const py::object &object)
    {
      const std::vector<double> g = numbers_of(object, "gravity", 3);
      if (g.size() != 3)
        throw UserError("gravity must be an array of shape (3,), such as [0, 0, -9.81].");
      held.change("gravity",
                  [&g](Problem &problem) {
                    problem.set_gravity({ { g[0], g[1], g[2] } });
                  });
    }

    py::array
    nodal_forces(const HeldProblem &held)
    {
      const Problem      &problem = held.get();
      const Loads        *loads   = problem.actions.loads.get();
      py::array_t<double> forces({ py::ssize_t(problem.body.fe_space.n_nodes()), py::ssize_t(3) });
      double *const       memory = forces.mutable_data();
      const auto          n      = static_cast<std::size_t>(forces.size());
      const bool          is_any = loads != nullptr && loads->nodal_forces().size() > 0;
      for (std::size_t dof = 0; dof < n; ++dof)
        memory[dof] = is_any ? loads->nodal_forces()[dof] : 0.;
      forces.attr("flags").attr("writeable") = false; // writing would change nothing
      return forces;
    }

    void
    set_nodal_forces(HeldProblem &held, const py::object &object)
    {
      Vector forces;
      if (!object.is_none())
      {
        const auto rows
            = points_of(object, "nodal_forces", py::ssize_t(held.get().body.fe_space.n_nodes()));
        forces.reinit(3 * rows.size());
        for (unsigned int dof = 0; dof < forces.size(); ++dof)
          forces[dof] = rows[dof / 3][dof % 3];
      }
      held.change("nodal_forces",
                  [&forces](Problem &problem) { problem.set_nodal_forces(forces); });
    }

    /// A motion that leaves nodes where they are.
    Motion
    stay_here(const Problem &problem, const std::vector<unsigned int> &nodes)
    {
      std::vector<dealii::Tensor<1, 3>> displacements(nodes.size());
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          displacements[i][c] = problem.state.positions[3 * nodes[i] + c]
                                - problem.body.fe_space.rest_positions()[3 * nodes[i] + c];
      return [displacements](const std::vector<dealii::Point<3>> &, double)
      { return displacements; };
    }

    /// A handle that holds nodes where they are.
    void
    hold_here(HeldProblem &held, const std::string &name, const std::vector<unsigned int> &nodes)
    {
      held.change(
          "hold()",
          [&](Problem &problem)
          {
            problem.change_handles([&](Handles &handles)
                                   { handles.grab(name, nodes, stay_here(problem, nodes)); });
            const Handles &handles = problem.constraints.handles;
            for (unsigned int h = 0; h < handles.size(); ++h) // edges of quadratic cells may bend
              if (handles.name(h) == name)
                problem.set_motion(name, stay_here(problem, handles.nodes(h)));
          });
    }

    std::vector<unsigned int>
    nodes_to_hold(const HeldProblem &held, const py::object &nodes, const std::string &call)
    {
      return nodes_of(nodes, call + ": nodes", held.get().body.mesh.n_nodes());
    }

    void
    hold(HeldProblem &held, const std::string &name, const py::object &nodes)
    {
      if (nodes.is_none())
        held.change("hold()", [&name](Problem &problem)
                    { problem.change_handles([&](Handles &handles) { handles.hold(name); }); });
      else
        hold_here(held, name, nodes_to_hold(held, nodes, "hold(name, nodes)"));
    }

    void
    let_go(HeldProblem &held, const std::string &name)
    {
      held.change("let_go()", [&name](Problem &problem)
                  { problem.change_handles([&](Handles &handles) { handles.let_go(name); }); });
    }

    void
    grab(HeldProblem       &held,
         const std::string &name,
         const py::object  &nodes,
         const py::object  &function)
    {
      if (PyCallable_Check(function.ptr()) == 0)
        throw py::type_error(
            "grab(name, nodes, function): function is called as function(rest, t), "
            "but is "
            + description(function) + ". Nodes that stay where they are: hold(name, nodes).");
      hold_here(held, name, nodes_to_hold(held, nodes, "grab(name, nodes, function)"));
      held.set_motion(py::str(name), function);
    }

    void
    set_pose(HeldProblem &held, const py::object &i, const py::object &positions)
    {
      if (PyIndex_Check(i.ptr()) == 0)
        throw py::type_error("set_pose(i, positions): i must be an int, but is " + description(i)
                             + ".");
      const auto index = i.cast<long long>();
      const auto rows  = points_of(positions, fmt::format("set_pose({}): positions", index));
      const auto n     = held.get().body.fe_space.n_nodes();
      const auto n_own = held.get().body.mesh.n_nodes();
      if (rows.size() != n && rows.size() != n_own)
        throw UserError(fmt::format("set_pose({}): positions have {} nodes, the mesh {}.", index,
                                    rows.size(), n_own));
      if (index < 0)
        throw UserError("set_pose: examples are counted from 0, as weights.");
      const auto  example = static_cast<unsigned int>(index);
      std::string warning;
      held.change("set_pose()",
                  [&](Problem &problem)
                  {
                    problem.set_pose(example, rows);
                    warning = pose_warning(problem, example);
                  });
      if (!warning.empty() && PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0)
        throw py::error_already_set();
    }

    void
    add_material(ProblemClass &problem)
    {
      problem.def(
          "set_material", &set_material, py::kw_only(), py::arg("young") = py::none(),
          py::arg("poisson") = py::none(), py::arg("density") = py::none(),
          "set_material(*, young=None, poisson=None, density=None)\n\n"
          "From the next step on Young's modulus [Pa], Poisson's ratio and density [kg/m^3] are "
          "others:\n"
          "a number for all cells, or an array (m,), one a cell; None: as before. Only what "
          "depends\n"
          "on them is made anew. Patches are chosen from the first values and stay: with Model/\n"
          "Dilatation = patches, or auto, a body that becomes nearly incompressible keeps those "
          "that\n"
          "it has. Shares of Loads/NAME, too, are those of the first density. Raises UserError, "
          "with\n"
          "nothing changed, for other shapes and for what Material does not allow.");
      refuse_other_arguments(problem, "set_material",
                             "set_material is called as set_material(young=..., poisson=..., "
                             "density=...), with the names.");
      problem.def_property(
          "importance",
          [](const HeldProblem &held) { return held.get().parameters.examples.importance; },
          [](HeldProblem &held, const py::object &object)
          {
            const double value = single_number(object, "importance");
            held.change("importance", [value](Problem &changed) { changed.set_importance(value); });
          },
          "Examples/Importance, above 0 and at most 1. Setting it raises UserError in a scene "
          "without\n"
          "examples, and in an interpolation.");
    }

    void
    add_tension(ProblemClass &problem)
    {
      problem.def(
          "set_tension", &set_tension, py::arg("region"), py::arg("value") = py::none(),
          "set_tension(region, value=None)\n\n"
          "From the next step on the active fibres of a region, a name or id of Material, pull "
          "with this\n"
          "tension [Pa]; others keep theirs. Alone the argument is the tension: a number, an "
          "array (m,), one a\n"
          "cell, or a dictionary of numbers by regions; None: as Material/Fibre tension says. "
          "Steps that are\n"
          "recorded may have different ones. Raises UserError, with nothing changed, for a "
          "scene without active\n"
          "fibres, other shapes, and negative numbers.");
      refuse_other_arguments(
          problem, "set_tension",
          "set_tension is called as set_tension(region, value), or set_tension(tension).");
      problem.def_property_readonly(
          "tension",
          [](const HeldProblem &held)
          {
            std::vector<double> values = tensions_of(held.get());
            const auto          n      = static_cast<py::ssize_t>(values.size());
            py::array_t<double> copy(n, values.data());
            copy.attr("flags").attr("writeable") = false;
            return copy;
          },
          "Tension (m,) [Pa] of the fibres of each cell at the end of the last step, or as it was "
          "set since; 0\n"
          "without active fibres. A copy, read only; set_tension() sets it.");
    }

    void
    add_loads(ProblemClass &problem)
    {
      problem.def_property(
          "gravity",
          [](const HeldProblem &held)
          {
            const auto         &gravity = held.get().parameters.loads.gravity;
            py::array_t<double> copy(3, gravity.data());
            copy.attr("flags").attr("writeable") = false;
            return copy;
          },
          &set_gravity,
          "Gravity (3,) [m/s^2], a read-only copy; set it as a whole. UserError in an "
          "interpolation.");
      problem.def_property("nodal_forces", &nodal_forces, &set_nodal_forces,
                           "Forces (n, 3) [N] on the nodes, beside gravity and Loads and with "
                           "Loads/Ramp as these; a\n"
                           "read-only copy, 0 until it is set. None: none. With Element = P2 n "
                           "counts the nodes in the\n"
                           "middles of edges, too, as state.positions. Their work is in work_loads "
                           "of the statistics.\n"
                           "Raises UserError for other shapes and in an interpolation.");
    }

    void
    add_damping(ProblemClass     &problem,
                const char *const name,
                double TimeParameters::*const member,
                const char *const             doc)
    {
      problem.def_property(
          name, [member](const HeldProblem &held) { return held.get().parameters.time.*member; },
          [name, member](HeldProblem &held, const py::object &object)
          {
            const double value = single_number(object, name);
            held.change(name,
                        [&](Problem &changed)
                        {
                          TimeParameters time = changed.parameters.time;
                          time.*member        = value;
                          changed.set_damping(time.mass_damping, time.stiffness_damping);
                        });
          },
          doc);
    }

    void
    add_handles(ProblemClass &problem)
    {
      problem.def(
          "hold", &hold, py::arg("name"), py::arg("nodes") = py::none(),
          "hold(name, nodes=None)\n\n"
          "From the next step on a new handle `name` holds these nodes, indices (k,) from 0, "
          "where\n"
          "they are; set_motion(name, function) moves it. None: a handle that was let go holds "
          "its\n"
          "nodes again. Raises UserError, with nothing changed, for a name in use, for what would\n"
          "hold every node, and in an interpolation.");
      problem.def(
          "grab", &grab, py::arg("name"), py::arg("nodes"), py::arg("function"),
          "grab(name, nodes, function)\n\n"
          "hold(name, nodes) and set_motion(name, function): function(rest (k, 3), t) returns the\n"
          "displacements (k, 3) [m] of the nodes in ascending order. Raises what these two raise.");
      problem.def("let_go", &let_go, py::arg("name"),
                  "let_go(name)\n\n"
                  "From the next step on the handle holds nothing; its nodes keep their "
                  "velocities. hold() and\n"
                  "grab() may take the name again. Raises UserError, with nothing changed, for a "
                  "name that is\n"
                  "no handle's and, in a static scene, for what would leave the body free to move "
                  "rigidly.");
      refuse_other_arguments(problem, "hold", "hold is called as hold(name, nodes=None).");
      refuse_other_arguments(problem, "grab", "grab is called as grab(name, nodes, function).");
      refuse_other_arguments(problem, "let_go", "let_go is called as let_go(name).");
    }
  } // namespace

  void
  add_changes(ProblemClass &problem)
  {
    add_material(problem);
    add_loads(problem);
    add_tension(problem);
    add_damping(
        problem, "mass_damping", &TimeParameters::mass_damping,
        "Time/Mass damping [1/s], not negative. Setting it raises UserError unless dynamic.");
    add_damping(
        problem, "stiffness_damping", &TimeParameters::stiffness_damping,
        "Time/Stiffness damping [s], not negative. Setting it raises UserError unless dynamic.");
    add_handles(problem);
    problem.def(
        "set_pose", &set_pose, py::arg("i"), py::arg("positions"),
        "set_pose(i, positions)\n\n"
        "From the next step on example i, counted from 0 as the weights, is another pose: "
        "positions\n"
        "(n, 3) [m]. The strains of the examples and what follows from them are made anew; handles "
        "that\n"
        "follow a pose keep the first. Warns of what looks wrong in a pose. Raises UserError, "
        "with\n"
        "nothing changed, for the rest pose, an example that is not there, and other shapes.");
    refuse_other_arguments(problem, "set_pose", "set_pose is called as set_pose(i, positions).");
  }
} // namespace Exemplar::Python
