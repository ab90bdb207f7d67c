# SPDX-License-Identifier: GPL-3.0-or-later
"""A program that uses every public name of the module, for `mypy --strict` (test_types.py): it is checked, not run."""
from typing import Any

import numpy as np
from numpy.typing import NDArray

import exemplar

Field = NDArray[np.float64]


def make() -> exemplar.Problem:
    exemplar.use_one_blas_thread()
    scene = {"Scene": "dynamic", "Handles": {"left": {"Select": ["box", 0, 0, 0, 0, 1, 1]}}}
    nodes, cells = np.zeros((4, 3)), np.array([[0, 1, 2, 3]])
    return exemplar.Problem(scene, mesh=(nodes, cells), poses=[nodes])


def term(x: Field, t: float) -> tuple[float, Field, None]:
    return float(x.sum()) + t, np.ones_like(x), None


def watch(report: exemplar.Report) -> bool:
    numbers: list[float] = [report.residual, report.kkt_residual, report.step_length, report.newton_decrement, *report.residual_history]
    return report.status == "converged" and report.iterations + report.factorizations < len(numbers)


def change(problem: exemplar.Problem) -> None:
    problem.set_material(young=1e5, poisson=0.3, density=np.full(4, 900.0))
    problem.gravity = np.array([0, 0, -9.81])
    problem.nodal_forces = np.zeros((4, 3))
    problem.importance = problem.importance / 2
    problem.mass_damping, problem.stiffness_damping = 2 * problem.stiffness_damping, problem.mass_damping
    problem.hold("paw", [1, 2])
    problem.hold("paw")
    problem.let_go("paw")
    problem.grab("nose", [3], lambda rest, t: t * rest)
    problem.set_motion("left", lambda rest, t: 0 * rest)
    problem.set_pose(1, problem.rest_positions)
    problem.set_tension("biceps", 2e3)
    problem.set_tension({"biceps": 2e3} if problem.tension.size > 0 else None)
    problem.add_term(term)
    problem.add_obstacle("floor", "plane 0 0 -9  0 0 1", motion="0; 0; 0", friction=0.5)
    errors: dict[str, float] = problem.check_term(term, positions=problem.state.positions, time=0.5)
    errors.update(problem.check_term(1))
    problem.on_iteration(watch)
    problem.on_iteration(None)


def look(problem: exemplar.Problem) -> None:
    by_node: list[Field] = [problem.positions, problem.rest_positions, problem.gravity, problem.nodal_forces, problem.contact_forces]
    by_cell: list[Field] = [problem.young, problem.poisson, problem.density, problem.volumes, problem.det_F, problem.strains, problem.stresses,
                            problem.example_strains, problem.shape_gradients, problem.weights]
    of_nodes: list[NDArray[np.uint32]] = [problem.cells, problem.cell_nodes, problem.surface_triangles, *problem.handles.values()]
    words: list[str] = [*problem.example_names, *problem.warnings, *problem.handles, *problem.obstacles, *map(str, problem.weight_regions)]
    numbers: list[float] = [problem.time, problem.residual, problem.energies["energy_elastic"], *problem.statistics.values()]
    counts: list[int] = [problem.step_number, problem.n_steps, len(by_node), len(by_cell), len(of_nodes), len(words), len(numbers)]
    has_settled: bool = problem.friction_settled
    measures: exemplar.Measures = problem.energies
    if problem.velocities is not None:
        by_node.append(problem.velocities)
    print(counts, measures, exemplar.__version__)


def evaluate(problem: exemplar.Problem) -> float:
    force: Field = problem.gradient(weights=problem.weights) + problem.weight_gradient().sum()
    matrices: list[Any] = [problem.hessian(kind="convex"), problem.reduced_hessian(), problem.mass]
    small: list[Field] = [problem.coupling(), problem.weight_hessian()]
    return problem.energy(positions=force) + len(matrices) + len(small)


def state(problem: exemplar.Problem) -> exemplar.State:
    saved: exemplar.State = problem.state
    same: list[Field | None] = [saved.positions, saved.velocities, saved.weights, saved.history]
    problem.state = saved.replace(positions=saved.positions, velocities=None, weights=None, time=saved.time, step=saved.step + len(same))
    problem.reset()
    return problem.state


def gradients(problem: exemplar.Problem) -> dict[str, Any]:
    with problem.record() as trajectory:
        problem.step(0.01)
    steps: exemplar.Trajectory = trajectory
    fields: list[list[Field]] = [steps.positions, steps.velocities, steps.weights]
    times: list[float] = steps.times
    found: dict[str, Any] = problem.vjp(problem.positions, None)
    found.update(steps.vjp([fields[0][0]], dJ_dw=[None], dJ_dv=None))
    return {**found, "correction": problem.correction(problem.positions), "times": times[:len(steps)]}


def show(problem: exemplar.Problem) -> str:
    problem.plot(problem.det_F, axes=None)
    problem.animate([problem.rest_positions, problem.positions], interval=20)
    problem.write("body.vtu")
    with problem.live(port=0, record="session") as page:
        return page.address + page.log


def main() -> None:
    problem = make()
    try:
        report: exemplar.Report = problem.step()
        report = problem.goto(0.5)
        report = problem.run()
    except (exemplar.UserError, exemplar.SolverFailure, exemplar.Interrupted) as error:
        print(error)
    else:
        print(report, problem, evaluate(problem), state(problem), gradients(problem), show(problem))
    change(problem)
    look(problem)
