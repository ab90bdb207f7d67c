# SPDX-License-Identifier: GPL-3.0-or-later
"""Static equilibria as a function of torch; doc/gradients.md."""
from typing import Any

try:
    import torch
    from torch.autograd.function import once_differentiable
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError("exemplar.with_torch needs torch, which is not installed: pip install torch", name="torch") from missing

import exemplar
from exemplar._equilibrium import pull_back, solve


class _Equilibrium(torch.autograd.Function):
    @staticmethod
    def forward(ctx, problem, names, *values):
        ctx.problem, ctx.values = problem, values
        ctx.set_materialize_grads(False)
        ctx.solved = solve(problem, {name: value.detach().cpu() for name, value in zip(names, values)})
        return torch.tensor(problem.positions), torch.tensor(problem.weights)

    @staticmethod
    @once_differentiable
    def backward(ctx, *by_state):
        found = pull_back(ctx.problem, ctx.solved, *(None if by is None else by.cpu().numpy() for by in by_state))
        return None, None, *(torch.as_tensor(by).to(value) for by, value in zip(found.values(), ctx.values))


def equilibrium(problem: exemplar.Problem, **parameters: Any) -> tuple[torch.Tensor, torch.Tensor]:
    """Solve a static problem with these parameters, tensors by their names in problem.vjp(): young, poisson, density (a number
    or (m,)), importance, gravity (3,), nodal_forces (n, 3), poses (k, n, 3). Returns the positions (n, 3) [m] and the weights
    (k,), in double precision, through which torch differentiates once. Raises what problem.step() and problem.vjp() raise,
    and UserError for other names.

    >>> young = torch.full((96,), 1e5, requires_grad=True)
    >>> positions, weights = equilibrium(static, young=young)
    >>> positions.sum().backward()
    >>> young.grad.shape
    torch.Size([96])
    """
    return _Equilibrium.apply(problem, tuple(parameters), *map(torch.as_tensor, parameters.values()))
