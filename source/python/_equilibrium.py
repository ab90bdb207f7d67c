# SPDX-License-Identifier: GPL-3.0-or-later
"""What exemplar.with_torch and exemplar.with_jax share: a solve with given parameters, and the gradient there."""
import weakref
from typing import Any

import numpy as np
from numpy.typing import NDArray

import exemplar
from exemplar import UserError

Values = dict[str, Any]  # arrays by the names of parameters

MATERIAL = ("young", "poisson", "density")
ATTRIBUTES = ("importance", "gravity", "nodal_forces")
ALLOWED = (*MATERIAL, *ATTRIBUTES, "poses")
names_of_last_solve: weakref.WeakKeyDictionary[exemplar.Problem, set[str]] = weakref.WeakKeyDictionary()


def check_poses(problem: exemplar.Problem, poses: NDArray[np.float64]) -> None:
    n = len(problem.example_strains)
    if poses.ndim != 3 or len(poses) not in (n - 1, n):
        raise UserError(f"equilibrium: poses must be an array (k, n, 3) of all examples but the rest pose, but has the shape {poses.shape}.")


def real_array(name: str, value: Any) -> NDArray[np.float64]:
    """Complex numbers would lose their imaginary parts."""
    if np.iscomplexobj(value):
        raise UserError(f"equilibrium: {name} is complex. Allowed: real numbers. Take value.real.")
    return np.array(value, dtype=float)


def set_parameters(problem: exemplar.Problem, values: Values) -> None:
    """Give the problem these arrays, by their names in problem.vjp()."""
    if material := {name: values[name] for name in MATERIAL if name in values}:
        problem.set_material(**material)
    for name in ATTRIBUTES:
        if name in values:
            setattr(problem, name, float(values[name]) if name == "importance" else values[name])
    for number, pose in enumerate(values.get("poses", [])):
        problem.set_pose(number + len(problem.example_strains) - len(values["poses"]), pose)


def solve(problem: exemplar.Problem, values: Values) -> tuple[Values, exemplar.State]:
    """The equilibrium with these parameters; what pull_back() needs, where the problem then stands."""
    for name in values:
        if name not in ALLOWED:
            raise UserError(f"equilibrium: there is no parameter '{name}'. Allowed: {', '.join(ALLOWED)}.")
    if problem.velocities is not None:
        raise UserError("equilibrium: the scene is dynamic. Set Scene = static, or record its steps: with problem.record() as trajectory.")
    values = {name: real_array(name, value) for name, value in values.items()}
    if "poses" in values:
        check_poses(problem, values["poses"])
    set_parameters(problem, values)
    problem.run() if problem.step_number < problem.n_steps else problem.step()
    names_of_last_solve[problem] = set(values)
    return values, problem.state


def pull_back(problem: exemplar.Problem, solved: tuple[Values, exemplar.State], by_positions: Any, by_weights: Any) -> Values:
    """The gradients by the parameters of a solve(), as arrays of their shapes. The problem goes back to it."""
    values, state = solved
    if names_of_last_solve[problem] != set(values):
        raise UserError(f"equilibrium: since this solve, by {', '.join(values)}, the problem was solved by other parameters: "
                        f"{', '.join(names_of_last_solve[problem])}. Give the same ones in each call, or take gradients first.")
    set_parameters(problem, values)
    problem.state = state
    found = problem.vjp(by_positions, by_weights)
    return {name: np.sum(found[name]) if value.ndim == 0 else np.reshape(found[name], value.shape) for name, value in values.items()}
