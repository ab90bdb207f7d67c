# SPDX-License-Identifier: GPL-3.0-or-later
"""Static equilibria as a function of jax; doc/gradients.md."""
import functools
from typing import Any

import numpy as np

try:
    import jax
    import jax.numpy as jnp
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError("exemplar.with_jax needs jax, which is not installed: pip install jax", name="jax") from missing

import exemplar
from exemplar._equilibrium import pull_back, solve


@functools.partial(jax.custom_vjp, nondiff_argnums=(0,))
def _equilibrium(problem, parameters):
    return _forward(problem, parameters)[0]


def _forward(problem, parameters):
    solved = solve(problem, parameters)
    return (jnp.array(problem.positions), jnp.array(problem.weights)), (solved[1], parameters)


def _backward(problem, kept, by_state):
    state, parameters = kept
    values = {name: np.array(value, dtype=float) for name, value in parameters.items()}
    found = pull_back(problem, (values, state), *(np.array(by, dtype=float) for by in by_state))
    return ({name: jnp.asarray(found[name], parameters[name].dtype) for name in parameters},)


_equilibrium.defvjp(_forward, _backward)


def equilibrium(problem: exemplar.Problem, **parameters: Any) -> tuple[jax.Array, jax.Array]:
    """Solve a static problem with these parameters, arrays by their names in problem.vjp(): young, poisson, density (a number
    or (m,)), importance, gravity (3,), nodal_forces (n, 3), poses (k, n, 3). Returns the positions (n, 3) [m] and the weights
    (k,), which jax.grad and jax.vjp differentiate once, outside of jax.jit. Numbers are single unless jax.config says
    jax_enable_x64. Raises what problem.step() and problem.vjp() raise, and UserError for other names.

    >>> jax.grad(lambda young: equilibrium(static, young=young)[0].sum())(1e5 * jnp.ones(96)).shape
    (96,)
    """
    return _equilibrium(problem, {name: jnp.asarray(value) for name, value in parameters.items()})
