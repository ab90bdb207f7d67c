// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/module_parts.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// Pairs of a public name, such as "Problem.step", and its example as Python's doctest runs it.
    /// There `problem` is a dynamic scene with an example pose and the handles left and right,
    /// after two steps, `static` one that was solved, and `np` is numpy.
    const std::vector<std::pair<const char *, const char *>> &
    examples_of_names()
    {
      // clang-format off
    static const std::vector<std::pair<const char *, const char *>> examples = {
      { "Problem", R"(>>> scene = {"Scene": "static", "Mesh": {"Generator": "box", "Box size": [4, 1, 1]}, "Loads": {"Gravity": [0, 0, -1]},
...          "Handles": {"left": {"Select": ["box", 0, -1, -1, 0, 1, 1]}}, "Material": {"Young's modulus": 1e7}}
>>> exemplar.Problem(scene).run().status
'converged')" },
      { "Problem.run", R"(>>> problem.run().status
'converged'
>>> problem.time
0.5)" },
      { "Problem.step", R"(>>> problem.step().status
'converged'
>>> problem.step(0.01)
<exemplar.Report: converged, ...>)" },
      { "Problem.goto", R"(>>> problem.goto(0.27).status
'converged'
>>> problem.time
0.27)" },
      { "Problem.reset", R"(>>> problem.reset()
>>> problem.step_number
0)" },
      { "Problem.set_motion", R"(>>> problem.set_motion("right", lambda rest, t: 0 * rest + [0, 0, 0.2 * t]))" },
      { "Problem.on_iteration", R"(>>> problem.on_iteration(lambda report: print("residual", report.residual))
>>> report = problem.step()
residual ...)" },
      { "Problem.positions", R"(>>> problem.positions.shape
(45, 3)
>>> (problem.positions - problem.rest_positions).max() > 0
True)" },
      { "Problem.velocities", R"(>>> problem.velocities.shape
(45, 3)
>>> static.velocities is None
True)" },
      { "Problem.rest_positions", R"(>>> problem.rest_positions.max(axis=0)
array([2. , 0.5, 0.5]))" },
      { "Problem.cells", R"(>>> problem.cells.shape, problem.cells.min()
((96, 4), 0))" },
      { "Problem.weights", R"(>>> round(problem.weights.sum(), 6)
1.0)" },
      { "Problem.time", R"(>>> problem.time
0.1)" },
      { "Problem.step_number", R"(>>> problem.step_number
2)" },
      { "Problem.n_steps", R"(>>> problem.n_steps
10)" },
      { "Problem.state", R"(>>> saved = problem.state
>>> report = problem.step()
>>> problem.state = saved
>>> problem.time
0.1)" },
      { "Problem.set_material", R"(>>> problem.set_material(young=np.where(problem.rest_positions[problem.cells].mean(axis=1)[:, 0] < 1, 1e5, 2e5))
>>> problem.set_material(density=800)
>>> problem.density[0]
800.0)" },
      { "Problem.importance", R"(>>> problem.importance = 0.3
>>> problem.importance
0.3)" },
      { "Problem.gravity", R"(>>> problem.gravity = [0, 0, -9.81]
>>> problem.gravity[2]
-9.81)" },
      { "Problem.set_tension", R"(>>> problem.set_tension(None) # as the scene says)" },
      { "Problem.tension", R"(>>> problem.tension.max() # no fibres are active
0.0)" },
      { "Problem.nodal_forces", R"(>>> forces = np.zeros((45, 3))
>>> forces[problem.handles["right"], 1] = 2.5
>>> problem.nodal_forces = forces)" },
      { "Problem.mass_damping", R"(>>> problem.mass_damping = 0.5)" },
      { "Problem.stiffness_damping", R"(>>> problem.stiffness_damping = 0.01)" },
      { "Problem.hold", R"(>>> problem.hold("middle", np.flatnonzero(problem.rest_positions[:, 0] == 1))
>>> len(problem.handles["middle"])
9)" },
      { "Problem.grab", R"(>>> problem.grab("nose", [22], lambda rest, t: 0 * rest + [0, 0, 0.1 * t]))" },
      { "Problem.let_go", R"(>>> problem.let_go("right")
>>> problem.handles["right"]
array([], dtype=uint32))" },
      { "Problem.set_pose", R"(>>> problem.set_pose(1, problem.rest_positions * [1, 1.2, 1.2]))" },
      { "Problem.energy", R"(>>> problem.energy() < problem.energy(positions=1.01 * problem.positions)
True)" },
      { "Problem.gradient", R"(>>> problem.gradient().shape
(45, 3))" },
      { "Problem.weight_gradient", R"(>>> problem.weight_gradient().shape
(2,))" },
      { "Problem.hessian", R"(>>> A = problem.hessian(kind="convex")
>>> A.shape, A.format
((135, 135), 'csr'))" },
      { "Problem.coupling", R"(>>> problem.coupling().shape
(135, 2))" },
      { "Problem.weight_hessian", R"(>>> problem.weight_hessian().shape
(2, 2))" },
      { "Problem.reduced_hessian", R"(>>> problem.reduced_hessian() @ np.ones(135) @ np.ones(135) > 0
True)" },
      { "Problem.mass", R"(>>> problem.mass.sum() / 3 / (problem.density * problem.volumes).sum()
1.0...)" },
      { "Problem.strains", R"(>>> problem.strains.shape
(96, 3, 3))" },
      { "Problem.stresses", R"(>>> problem.stresses.shape
(96, 3, 3))" },
      { "Problem.det_F", R"(>>> (problem.det_F > 0).all()
True)" },
      { "Problem.example_strains", R"(>>> problem.example_strains.shape
(2, 96, 3, 3))" },
      { "Problem.shape_gradients", R"(>>> abs(problem.shape_gradients.sum(axis=1)).max() < 1e-12
True)" },
      { "Problem.cell_nodes", R"(>>> problem.cell_nodes.shape
(96, 4))" },
      { "Problem.young", R"(>>> problem.young.mean()
100000.0)" },
      { "Problem.poisson", R"(>>> problem.poisson.max()
0.3...)" },
      { "Problem.density", R"(>>> mass = (problem.density * problem.volumes).sum())" },
      { "Problem.volumes", R"(>>> round(problem.volumes.sum(), 9)
2.0)" },
      { "Problem.surface_triangles", R"(>>> corners = problem.positions[problem.surface_triangles]
>>> corners.shape
(80, 3, 3))" },
      { "Problem.handles", R"(>>> sorted(problem.handles), len(problem.handles["left"])
(['left', 'right'], 9))" },
      { "Problem.weight_regions", R"(>>> problem.weight_regions
[])" },
      { "Problem.example_names", R"(>>> problem.example_names[0]
'rest pose')" },
      { "Problem.write", R"(>>> problem.write("body.vtu"))" },
      { "Problem.add_term", R"(>>> import scipy.sparse
>>> def springs(x, t, k=50.):
...     u = x - problem.rest_positions
...     return k / 2 * (u**2).sum(), k * u, k * scipy.sparse.identity(u.size, format="csr")
>>> problem.add_term(springs)
>>> report = problem.step()
>>> problem.energies["energy_term_1"] > 0
True)" },
      { "Problem.check_term", R"(>>> found = problem.check_term(lambda x, t: ((x**2).sum(), 2 * x, None))
Traceback (most recent call last):
exemplar.UserError: the term <lambda>: its Hessian is not that of its gradient ...
>>> found = problem.check_term(lambda x, t: (x.sum(), 1 + 0 * x, None))
>>> found["gradient"] < 1e-6
True)" },
      { "Problem.vjp", R"(>>> lifted = np.zeros((45, 3))
>>> lifted[22, 2] = 1  # J is how high node 22 is
>>> static.vjp(lifted)["young"].shape
(96,))" },
      { "Problem.correction", R"(>>> abs(static.correction(np.ones((45, 3)))) < 1e-3
True)" },
      { "Problem.record", R"(>>> with problem.record() as trajectory:
...     report = problem.goto(0.2)
>>> len(trajectory)
2)" },
      { "Problem.residual", R"(>>> problem.residual < 1e-2
True)" },
      { "Problem.energies", R"(>>> problem.energies["energy_elastic"] > 0
True)" },
      { "Problem.statistics", R"(>>> sorted(problem.statistics)[:2]
[...])" },
      { "Problem.warnings", R"(>>> problem.warnings
[])" },
      { "Problem.obstacles", R"(>>> problem.obstacles
{})" },
      { "Problem.add_obstacle",
        R"(>>> problem.add_obstacle("step", "box 0 -1 -1  1 1 -0.3", friction=0.5)  # doctest: +SKIP)" },
      { "Problem.friction_settled", R"(>>> problem.friction_settled
True)" },
      { "Problem.contact_forces", R"(>>> abs(problem.contact_forces).max()
0.0)" },
      { "Problem.plot", R"(>>> axes = problem.plot(problem.det_F))" },
      { "Problem.animate", R"(>>> player = problem.animate()
>>> player.save("body.gif"))" },
      { "Problem.live", R"(>>> with problem.live(record="session") as page:  # doctest: +SKIP
...     input(page.address))" },
      { "State", R"(>>> problem.state
<exemplar.State: step 2, time 0.1, 45 nodes>
>>> import pickle
>>> pickle.loads(pickle.dumps(problem.state)) == problem.state
True)" },
      { "State.positions", R"(>>> problem.state.positions.shape
(45, 3))" },
      { "State.velocities", R"(>>> problem.state.velocities.shape
(45, 3))" },
      { "State.weights", R"(>>> len(problem.state.weights)
2)" },
      { "State.history", R"(>>> problem.state.history
array([], dtype=float64))" },
      { "State.time", R"(>>> problem.state.time
0.1)" },
      { "State.step", R"(>>> problem.state.step
2)" },
      { "State.replace", R"(>>> problem.state = problem.state.replace(velocities=0 * problem.velocities)
>>> problem.velocities.any()
False)" },
      { "Report.status", R"(>>> problem.step().status
'converged')" },
      { "Report.iterations", R"(>>> problem.step().iterations > 0
True)" },
      { "Report.residual", R"(>>> problem.step().residual < 1e-2
True)" },
      { "Report.kkt_residual", R"(>>> problem.step().kkt_residual < 1e-2
True)" },
      { "Report.residual_history", R"(>>> report = problem.step()
>>> len(report.residual_history) >= report.iterations
True)" },
      { "Report.step_length", R"(>>> 0 < static.step().step_length <= 1
True)" },
      { "Report.factorizations", R"(>>> static.step().factorizations >= 0
True)" },
      { "Report.newton_decrement", R"(>>> problem.step().newton_decrement >= 0
True)" },
      { "Report", R"(>>> problem.step()
<exemplar.Report: converged, ... iterations, residual ...>)" },
      { "Trajectory", R"(>>> with problem.record() as trajectory:
...     report = problem.step()
>>> by_positions = np.ones((45, 3))  # J is the sum of all coordinates
>>> trajectory.vjp([by_positions])["initial_velocities"].shape
(45, 3))" },
      { "Trajectory.times", R"(>>> trajectory.times
[0.1])" },
      { "Trajectory.positions", R"(>>> trajectory.positions[0].shape
(45, 3))" },
      { "Trajectory.velocities", R"(>>> trajectory.velocities[0].shape
(45, 3))" },
      { "Trajectory.weights", R"(>>> trajectory.weights[0].shape
(2,))" },
      { "Trajectory.vjp", R"(>>> sorted(trajectory.vjp([np.ones((45, 3))]))[:3]
['density', 'gravity', 'handles'])" },
      { "UserError", R"(>>> problem.importance = 2
Traceback (most recent call last):
exemplar.UserError: Examples/Importance: it is 2, but must be above 0 and at most 1.)" },
      { "SolverFailure", R"(>>> try:
...     report = problem.step()
... except exemplar.SolverFailure:
...     report = problem.step(0.01))" },
      { "Interrupted", R"(>>> problem.on_iteration(lambda report: report.iterations < 1)
>>> problem.step()
Traceback (most recent call last):
exemplar.Interrupted: ...)" },
      { "Measures", R"(>>> problem.energies["energy_elastik"]
Traceback (most recent call last):
KeyError: "there is no 'energy_elastik'. Did you mean 'energy_elastic'? ...")" },
      { "use_one_blas_thread", R"(>>> exemplar.use_one_blas_thread())" },
    };
      // clang-format on
      return examples;
    }

    /// The object of a dotted name, such as "Problem.step", in the module.
    py::object
    member_of(const py::module_ &module, const std::string &name)
    {
      const std::size_t dot   = name.find('.');
      const py::object  outer = module.attr(name.substr(0, dot).c_str());
      if (dot == std::string::npos)
        return outer;
      return outer.attr("__dict__")[name.substr(dot + 1).c_str()];
    }

    /// Appends to the docstring of a function in C, which pybind11 frees by free().
    void
    append_to_function(PyObject *function, const std::string &text)
    {
      if (PyInstanceMethod_Check(function))
        function = PyInstanceMethod_GET_FUNCTION(function);
      if (!PyCFunction_Check(function))
        throw std::logic_error("An example is of what is no function.");
      PyMethodDef *const definition = reinterpret_cast<PyCFunctionObject *>(function)->m_ml;
      const std::string  doc        = definition->ml_doc == nullptr ? "" : definition->ml_doc;
      std::free(const_cast<char *>(definition->ml_doc));
      definition->ml_doc = strdup((doc + text).c_str());
    }

    void
    append(const py::object &member, const std::string &text)
    {
      const bool is_property = PyObject_TypeCheck(member.ptr(), &PyProperty_Type) != 0;
      if (is_property || PyType_Check(member.ptr()))
        member.attr("__doc__") = std::string(py::str(member.attr("__doc__"))) + text;
      else
        append_to_function(member.ptr(), text);
    }
  } // namespace

  void
  add_examples(const py::module_ &module)
  {
    for (const auto &[name, example] : examples_of_names())
      append(member_of(module, name), "\n\n" + std::string(example));
  }
} // namespace Exemplar::Python
