# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells in numpy, written from doc/model.md and independent of the program: an array has a row a cell."""
import numpy as np

from scene_runs import read_msh


def read_pose(file):
    """Node places of a .msh file in ascending order of node numbers, and its tetrahedra by index."""
    mesh = read_msh(file)
    index = {number: i for i, number in enumerate(sorted(mesh.nodes))}
    places = np.array([mesh.nodes[number] for number in sorted(mesh.nodes)])
    cells = np.array([[index[number] for number in element[-4:]] for element in mesh.elements if element[1] == 4])
    return places, cells


def transposed(A):
    return np.swapaxes(A, 1, 2)


def polar(F):
    """F = R S with det R = 1, and the singular values, the last with the sign of det F."""
    U, values, Vt = np.linalg.svd(F)
    sign = np.sign(np.linalg.det(U) * np.linalg.det(Vt))
    U[:, :, 2] *= sign[:, None]
    values[:, 2] *= sign
    return U @ Vt, np.einsum("cki,ck,ckj->cij", Vt, values, Vt), values


def skew_part_solution(S, right):
    """The skew W with S W + W S = right, skew, for each cell."""
    values, Q = np.linalg.eigh(S)
    sums = values[:, :, None] + values[:, None, :]
    np.einsum("cii->ci", sums)[:] = 1.  # the diagonal of a skew matrix is zero
    return Q @ ((transposed(Q) @ right @ Q) / sums) @ transposed(Q)


class Body:
    """A mesh at rest of an isotropic material."""

    def __init__(self, rest, cells, young=1e6, poisson=0.45):
        self.rest, self.cells = rest, cells
        edges = transposed(rest[cells[:, 1:]] - rest[cells[:, :1]])
        self.volume = np.abs(np.linalg.det(edges)) / 6.
        last = np.linalg.inv(edges)
        self.gradients = np.concatenate([-last.sum(axis=1, keepdims=True), last], axis=1)
        self.lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        self.mu = young / (2 * (1 + poisson))

    def deformation_gradient(self, places):
        return np.einsum("cai,caj->cij", places[self.cells], self.gradients)

    def strain(self, places):
        """S - I."""
        return polar(self.deformation_gradient(places))[1] - np.eye(3)

    def stress(self, strain):
        trace = np.einsum("cii->c", strain)
        return self.lame * trace[:, None, None] * np.eye(3) + 2 * self.mu * strain

    def force_stress(self, places, target, model):
        """P of Eq. (6), (17) or Green's or the linear model, for the target strain eta E(w)."""
        F = self.deformation_gradient(places)
        if model == "linear":
            return self.stress((F + transposed(F)) / 2 - np.eye(3) - target)
        if model == "green":
            return F @ self.stress((transposed(F) @ F - np.eye(3)) / 2 - target)
        R, S, _ = polar(F)
        T = self.stress(S - np.eye(3) - target)
        return R @ T if model == "frozen" else R @ (T + skew_part_solution(S, S @ T - T @ S))

    def nodal_forces(self, P):
        """Gradient of the energy by the node places."""
        forces = np.zeros_like(self.rest)
        np.add.at(forces, self.cells, np.einsum("c,cij,caj->cai", self.volume, P, self.gradients))
        return forces

    def force_scale(self, strain, target):
        """s_a of Eq. (13) without loads and inertia."""
        norm = lambda A: np.sqrt((A * A).sum(axis=(1, 2)))
        density = self.volume * (norm(self.stress(strain)) + norm(self.stress(target)))
        scale = np.zeros(len(self.rest))
        np.add.at(scale, self.cells, density[:, None] * np.linalg.norm(self.gradients, axis=2))
        return scale

    def ghost_torque(self, places, P):
        """Sum of the torques that cells exert on themselves, over the sum of |x x f| about their centroids."""
        arms = places[self.cells] - places[self.cells].mean(axis=1, keepdims=True)
        torques = np.cross(arms, np.einsum("c,cij,caj->cai", self.volume, P, self.gradients))
        return np.linalg.norm(torques.sum(axis=1), axis=1).sum() / np.linalg.norm(torques, axis=2).sum()
