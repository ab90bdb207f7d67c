# SPDX-License-Identifier: GPL-3.0-or-later
"""What exemplar.with_torch and exemplar.with_jax share: a solve with given parameters, and the gradient there."""
import numpy as np

from exemplar import UserError

MATERIAL = ("young", "poisson", "density")
ATTRIBUTES = ("importance", "gravity", "nodal_forces")


def set_parameters(problem, values):
    """Give the problem these arrays, by their names in problem.vjp()."""
    for name in values:
        if name not in (*MATERIAL, *ATTRIBUTES, "poses"):
            raise UserError(f"equilibrium: there is no parameter '{name}'. Allowed: {', '.join((*MATERIAL, *ATTRIBUTES, 'poses'))}.")
    if material := {name: values[name] for name in MATERIAL if name in values}:
        problem.set_material(**material)
    for name in ATTRIBUTES:
        if name in values:
            setattr(problem, name, float(values[name]) if name == "importance" else values[name])
    for number, pose in enumerate(values.get("poses", [])):
        problem.set_pose(number + len(problem.example_strains) - len(values["poses"]), pose)


def solve(problem, values):
    """The equilibrium with these parameters; what pull_back() needs, where the problem then stands."""
    values = {name: np.array(value, dtype=float) for name, value in values.items()}
    set_parameters(problem, values)
    problem.run() if problem.step_number < problem.n_steps else problem.step()
    return values, problem.state


def pull_back(problem, solved, by_positions, by_weights):
    """The gradients by the parameters of a solve(), as arrays of their shapes. The problem goes back to it."""
    values, state = solved
    set_parameters(problem, values)
    problem.state = state
    found = problem.vjp(by_positions, by_weights)
    return {name: np.sum(found[name]) if value.ndim == 0 else np.array(found[name]) for name, value in values.items()}
