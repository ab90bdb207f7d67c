# SPDX-License-Identifier: GPL-3.0-or-later
"""The formulas that doc/model.md, dynamics.md, rotations.md and solver.md print, in numpy, against the module.

Held are (1) to (22), (24) to (28), (30) to (40), (44) and (45), with what the pages print between them (damping, guards, fibres, patches, the convex tangent
of stretched cells, importance by region, quadratic elements, lumped masses, moved handles, handles that follow a pose, closed forms).

Not held are (23), which no caller sees, but see RotatedMetric in tests/unit/solvers; which cells make a patch (patches_test.cc); convex tangents of
thin cells and of (26), plastic cells and (38) in patches (tests/unit/potential, test_evaluation.py by differences); shares of Weight maps in (20)
(scenes/test_by_surface.py); interpolations and their support (supports_test.cc); the energy bound, spins and falls of implicit Euler (exemplar verify).
"""
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

import exemplar

try:
    import scipy.sparse  # noqa: F401
except ImportError:
    raise SystemExit(0)  # Hessians need it

I = np.eye(3)
YOUNG, NU, ETA, SIGMA = 2e5, 0.3, 0.7, 11.0
LAMBDA, MU = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
NODES = np.array([[0.1, 0, 0], [1, 0.1, 0], [0.2, 0.9, 0], [0, 0.1, 1.2]])
CELLS = np.array([[0, 1, 2, 3]])
POSES = [I + np.array(D) for D in ([[0.2, 0.1, 0], [0, -0.1, 0.3], [0.1, 0, 0.05]], [[-0.1, 0, 0.2], [0.3, 0.2, 0], [0, 0.1, -0.2]])]
WEIGHTS = np.array([0.2, 0.5, 0.3])


def turn(axis, angle):
    a = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    return I + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def with_stretches(*s):
    """F of these singular values."""
    return turn([1, 2, -1], 0.8) @ np.diag(s) @ turn([0.3, -1, 1], 1.1)


STATES = {  # F
    "at rest": I,
    "strained": I + np.array([[0.1, 0.3, -0.2], [0, -0.2, 0.1], [0.2, 0.1, 0.3]]),
    "turned": turn([1, 1, 2], 2.5) @ (I + 0.2 * np.ones((3, 3))),
    "flat": with_stretches(1.2, 0.9, 0),
    "inverted": with_stretches(1.1, 0.9, -0.3),
    "guarded": with_stretches(1.2, 0.5, -0.3),
    "hardly unique": with_stretches(1.1, 0.31, -0.3),
    "stretched": with_stretches(6, 0.8, -0.3),
    "drawn out": with_stretches(9, 0.5, -0.4),
}


def scene(**sections):
    base = {"Scene": "static", "Material": {"Young's modulus": YOUNG, "Poisson's ratio": NU}, "Model": {"Dilatation": "cells"},
            "Handles": {"foot": {"Select": "box -9 -9 -9 9 9 0"}}, "Solver": {"Tolerance": 1e-11}, "Time": {"Increments": 1}}
    return {**base, **{name: {**base[name], **keys} if name in base and name not in ("Scene", "Handles") else keys for name, keys in sections.items()}}


def examples(energy="scaled", **more):
    return {"Importance": ETA, "Energy": energy, "Weights": "free", "Weight penalty": SIGMA, **more}


def make(of, nodes=NODES, cells=CELLS, poses=None):
    cells, ids = cells if isinstance(cells, tuple) else (cells, None)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if poses is None and "Examples" in of:
            poses = [nodes @ F.T for F in POSES]
        return exemplar.Problem(of, mesh=(nodes, cells) + (() if ids is None else (ids,)), **({} if poses is None else {"poses": poses}))


# ------------------------------------------------------------------------------------------------- what the pages print

def dot(A, B):
    return (A * B).sum()


def dev(A):
    return A - np.trace(A) / 3 * I


def sym(A):
    return (A + A.T) / 2


def stress(E, young=YOUNG, nu=NU):
    """(3)."""
    return young * nu / ((1 + nu) * (1 - 2 * nu)) * np.trace(E) * I + young / (1 + nu) * E


def polar(F):
    """F = R S with a proper rotation."""
    U, s, V = np.linalg.svd(F)
    sign = np.diag([1, 1, np.sign(np.linalg.det(U @ V))])
    return U @ sign @ V, V.T @ sign @ np.diag(s) @ V


def skew(S, K):
    """X with S X + X S = K; sums of singular values below 1e-8 count as 1e-8."""
    s, Q = np.linalg.eigh(S)
    sums = np.maximum(np.add.outer(s, s), 1e-8)
    np.fill_diagonal(sums, np.inf)
    return Q @ (Q.T @ K @ Q / sums) @ Q.T


class Law:
    """A corotational cell, (16) to (18), (24), (30) and (40)."""

    def __init__(self, lam=LAMBDA, mu=MU, grain=None, p_0=0.8, of_guard=None):
        self.lam, self.mu, self.p_0 = lam, mu, p_0
        self.grain = grain or (lambda E: 0 * E)  # C_a:E
        self.of_guard = of_guard or (lam, mu)

    def C(self, E):
        return self.lam * np.trace(E) * I + 2 * self.mu * E + self.grain(E)

    def guard(self, S):
        """phi and its two derivatives by p; dp/dS."""
        p = np.linalg.det(np.trace(S) * I - S)
        z = np.clip(p / self.p_0, 0, 1)
        inside = z < 1
        return z**2 * (3 - 2 * z), 6 * z * (1 - z) / self.p_0, inside * 6 * (1 - 2 * z) / self.p_0**2, np.trace(S)**2 * I - S @ S

    def held(self, S, D):
        """psi_phi, and its derivatives by S and D."""
        e = S - I
        return (2 * self.mu * dot(S, dev(D)) - dot(e, self.grain(e - 2 * D)) / 2, 2 * self.mu * dev(D) - self.grain(e - D),
                2 * self.mu * dev(S) + self.grain(e))

    def density(self, F, D):
        """(16) and (24)."""
        _, S = polar(F)
        X = S - I - D
        phi = self.guard(S)[0]
        return self.mu * dot(X, X) + self.lam / 2 * np.trace(X)**2 + dot(X, self.grain(X)) / 2 + (1 - phi) * self.held(S, D)[0] + self.Gamma(F)

    def T_W(self, S, D):
        T = self.C(S - I - D) + (1 - self.guard(S)[0]) * self.held(S, D)[1]
        return T, skew(S, S @ T - T @ S)

    def P(self, F, D):
        """(17)."""
        R, S = polar(F)
        T, W = self.T_W(S, D)
        _, d_phi, _, dp = self.guard(S)
        return R @ (T + W) - d_phi * self.held(S, D)[0] * R @ dp + self.dGamma(F)

    def dP(self, F, D, dF):
        """(18) and the change of dGamma."""
        R, S = polar(F)
        T, W = self.T_W(S, D)
        phi, d_phi, dd_phi, dp = self.guard(S)
        held, by_S, _ = self.held(S, D)
        M = R.T @ dF
        Omega = skew(S, M - M.T)
        dS = M - Omega @ S
        change = dot(dp, dS)
        dT = self.C(dS) - (1 - phi) * self.grain(dS) - d_phi * change * by_S
        dW = skew(S, dS @ T + S @ dT - dT @ S - T @ dS - dS @ W - W @ dS)
        d_dp = 2 * np.trace(S) * np.trace(dS) * I - dS @ S - S @ dS
        of_guard = -(dd_phi * held * change + d_phi * dot(by_S, dS)) * dp - d_phi * held * (d_dp + Omega @ dp)
        return R @ (Omega @ (T + W) + dT + dW + of_guard + self.ddGamma(F, Omega, dS, d_dp))

    def by_target(self, F, E):
        """What stands between R and g_a in (40)."""
        _, S = polar(F)
        phi, d_phi, _, dp = self.guard(S)
        T = self.C(E) - (1 - phi) * (2 * self.mu * dev(E) + self.grain(E))
        return T + skew(S, S @ T - T @ S) + d_phi * dot(self.held(S, E)[2], E) * dp

    def by_weight(self, F, D):
        """The stress in (7): -d psi / dD."""
        _, S = polar(F)
        return self.C(S - I - D) - (1 - self.guard(S)[0]) * self.held(S, D)[2]

    def kink(self, S):
        """q and r of (24) with their two derivatives by |F| and y; y, dy/dS and |F|."""
        lam, mu = self.of_guard
        norm = np.linalg.norm(S)
        y, y_0 = np.linalg.det(np.trace(S) * I - S) / norm**2, 0.4
        c, c_0 = lam * (norm - 3) - 2 * mu, 0.4 * (lam + mu)
        q = np.zeros(3) if c <= -c_0 else np.array([(c + c_0)**2 / 2, c + c_0, 1]) / (2 * c_0) if c < c_0 else np.array([c, 1, 0])
        r = y_0 / 3 * np.array([(1 - y / y_0)**3, -3 / y_0 * (1 - y / y_0)**2, 6 / y_0**2 * (1 - y / y_0)]) * (y < y_0)
        return q * lam**np.arange(3), r, y, (np.trace(S)**2 * I - S @ S - 2 * y * S) / norm**2, norm

    def Gamma(self, F):
        """(24)."""
        q, r, *_ = self.kink(polar(F)[1])
        return 4 * q[0] * r[0]

    def dGamma(self, F):
        R, S = polar(F)
        q, r, _, dy, norm = self.kink(S)
        return 4 * R @ (q[1] * r[0] / norm * S + q[0] * r[1] * dy)

    def ddGamma(self, F, Omega, dS, d_dp):
        """The change of R^T dGamma, turned by Omega."""
        S = polar(F)[1]
        q, r, y, by_S, norm = self.kink(S)
        d_norm, dy = dot(S, dS) / norm, dot(by_S, dS)
        d_by_S = (d_dp - 2 * (dy * S + y * dS)) / norm**2 - 2 * d_norm / norm * by_S
        of_S = q[2] * d_norm * r[0] + q[1] * r[1] * dy - q[1] * r[0] * d_norm / norm
        return 4 * (Omega @ (q[1] * r[0] / norm * S + q[0] * r[1] * by_S) + of_S / norm * S + q[1] * r[0] / norm * dS
                    + (q[1] * d_norm * r[1] + q[0] * r[2] * dy) * by_S + q[0] * r[1] * d_by_S)


def shapes(nodes, cells):
    """g_a and V, Eq. (1)."""
    D = np.array([np.vstack([nodes[c].T, np.ones(4)]) for c in cells])
    return np.linalg.inv(D)[:, :, :3], np.abs(np.linalg.det(D)) / 6


def gradients_of(x, cells, g):
    """F, Eq. (1)."""
    return np.einsum("mai,maj->mij", x[cells], g)


def to_nodes(cells, P, g, V, n):
    """sum V P g_a."""
    f = np.zeros((n, 3))
    np.add.at(f, cells, np.einsum("m,mij,maj->mai", V, P, g))
    return f


def matrix(cells, dP, g, V, n):
    """sum V g_a dP/dF g_b of dP(cell, dF)."""
    A = np.zeros((n, 3, n, 3))
    for m, nodes in enumerate(cells):
        for b in range(len(nodes)):
            for c in range(3):
                f = V[m] * dP(m, np.outer(I[c], g[m, b])) @ g[m].T
                A[nodes, :, nodes[b], c] += f.T
    return A.reshape(3 * n, 3 * n)


def relative(a, b):
    a, b = np.asarray(a), np.asarray(b)
    return np.abs(a - b).max() / max(np.abs(b).max(), 1e-300)


def differences(f, x, h=1e-6):
    """By central differences, one row of x's entries after the other."""
    rows = []
    for k in range(x.size):
        d = np.zeros(x.size)
        d[k] = h
        d = d.reshape(x.shape)
        rows.append((np.asarray(f(x + d)) - np.asarray(f(x - d))) / (2 * h))
    return np.array(rows)


def example_strains(poses):
    """(4), the rest pose first."""
    return np.array([0 * I] + [polar(F)[1] - I for F in poses])


EXAMPLES = example_strains(POSES)


def star():
    """An icosahedron of twenty cells around a node, which are one patch."""
    t = (1 + 5**0.5) / 2
    outer = np.array([np.roll([0, a, b * t], k) for k in range(3) for a in (1, -1) for b in (1, -1)], float)
    near = [[j for j in range(12) if j != i and np.linalg.norm(outer[i] - outer[j]) < 2.1] for i in range(12)]
    faces = [(i, j, k) for i in range(12) for j in near[i] for k in near[i] if i < j < k and k in near[j]]
    nodes = np.vstack([outer, [[0.2, -0.1, 0.15]]])
    return nodes, np.array([[*f, 12] if np.linalg.det(outer[list(f)]) < 0 else [f[1], f[0], f[2], 12] for f in faces])


STAR, STAR_CELLS = star()
STAR_POSES = [STAR @ F.T + 0.03 * np.sin(3 * STAR[:, [1, 2, 0]] + k) for k, F in enumerate(POSES)]
FOOT = {"foot": {"Select": "box -9 -9 -9 9 9 -0.9"}}


def moved(nodes, F=STATES["strained"], size=0.03, seed=1):
    return nodes @ F.T + size * np.random.default_rng(seed).standard_normal(nodes.shape)


class Body:
    """Sums over the points of a body whose cells have a law, examples with the strains E[i][point], and Eq. (5)."""

    def __init__(self, nodes, cells, poses=(), law=None, eta=ETA, sigma=SIGMA, part=0, n=None, points=None):
        self.cells, self.n = cells, n or len(nodes)
        self.g, self.V = points or shapes(nodes, cells)
        self.law, self.eta, self.sigma, self.part = law or Law(), eta, sigma, part
        self.E = np.array([np.zeros((len(cells), 3, 3))]
                          + [[polar(F)[1] - I for F in self.F(x)] for x in poses])

    def F(self, x):
        return gradients_of(x, self.cells, self.g)

    def sum(self, numbers):
        return (self.V * np.array(numbers)).sum()

    def forces(self, P):
        return to_nodes(self.cells, np.array(P), self.g, self.V, self.n)

    def D(self, w):
        return self.eta * np.einsum("i,imjk->mjk", w, self.E)

    def more(self, A, B):
        """Of the energies of (5) but the scaled one: eta (1 - eta) sum V A:C:B, or a fifth of it."""
        return self.part * self.eta * (1 - self.eta) * self.sum([dot(a, self.law.C(b)) for a, b in zip(A, B)])

    def energy(self, x, w):
        E = self.D(w) / self.eta
        return self.sum([self.law.density(F, D) for F, D in zip(self.F(x), self.D(w))]) + self.more(E, E) / 2 + self.sigma / 2 * w @ w

    def gradient(self, x, w):
        return self.forces([self.law.P(F, D) for F, D in zip(self.F(x), self.D(w))])

    def weight_gradient(self, x, w):
        """(7)."""
        D = self.D(w)
        T = [self.law.by_weight(F, d) for F, d in zip(self.F(x), D)]
        return np.array([-self.eta * self.sum([dot(e, t) for e, t in zip(E, T)]) + self.more(E, D / self.eta) for E in self.E]) + self.sigma * w

    def tangent(self, x, w):
        F, D = self.F(x), self.D(w)
        return matrix(self.cells, lambda m, dF: self.law.dP(F[m], D[m], dF), self.g, self.V, self.n)

    def columns(self, x):
        """(40)."""
        F = self.F(x)
        return self.eta * np.array([self.forces([polar(f)[0] @ self.law.by_target(f, e) for f, e in zip(F, E)]).ravel() for E in self.E]).T

    def H(self):
        """(9)."""
        return np.array([[self.eta**2 * self.sum([dot(a, self.law.C(b)) for a, b in zip(A, B)]) + self.more(A, B) for B in self.E] for A in self.E]) \
            + self.sigma * np.eye(len(self.E))

    def convex(self, x):
        """(8) without mass, and the columns (9)."""
        R = [polar(F)[0] for F in self.F(x)]
        A = matrix(self.cells, lambda m, dF: R[m] @ self.law.C(sym(R[m].T @ dF)), self.g, self.V, self.n)
        G = self.eta * np.array([self.forces([r @ self.law.C(e) for r, e in zip(R, E)]).ravel() for E in self.E]).T
        return A, G


class Formulas(unittest.TestCase):
    def near(self, a, b, bound=1e-11):
        self.assertLess(relative(a, b), bound)

    def compare(self, problem, body, x, w, bound=1e-11):
        """All that a body is asked for."""
        given = w if len(body.E) > 1 else None
        self.near(problem.energy(x, given) + 1, body.energy(x, w) + 1, bound)
        self.near(problem.gradient(x, given) + 1, body.gradient(x, w) + 1, bound)
        self.near(problem.hessian(x, given).toarray(), body.tangent(x, w), bound)
        if len(body.E) > 1:
            self.near(problem.weight_gradient(x, w), body.weight_gradient(x, w), bound)
            self.near(problem.coupling(x, w), body.columns(x), bound)
            self.near(problem.weight_hessian(), body.H(), bound)


def grain(C):
    """C:E of a tensor of four indices, without its isotropic part; lambda and mu of that."""
    iijj, ijij = np.einsum("iijj", C), np.einsum("ijij", C)
    mu = (3 * ijij - iijj) / 30
    lam = (iijj - 6 * mu) / 9
    return lambda E: np.einsum("ijkl,kl", C, E) - lam * np.trace(E) * I - 2 * mu * E, lam, mu


def orthotropic(constants, axes):
    """C of nine constants along the rows of axes."""
    E, nu, G = np.array(constants).reshape(3, 3)
    compliance = np.diag(1 / E)
    for k, (i, j) in enumerate(((1, 2), (0, 2), (0, 1))):
        compliance[i, j] = compliance[j, i] = -nu[k] / E[i]
    C, stiffness = np.zeros((3, 3, 3, 3)), np.linalg.inv(compliance)
    for i in range(3):
        for j in range(3):
            C[i, i, j, j] = stiffness[i, j]
    for k, (i, j) in enumerate(((1, 2), (0, 2), (0, 1))):
        C[i, j, i, j] = C[j, i, i, j] = C[i, j, j, i] = C[j, i, j, i] = G[k]
    return np.einsum("ijkl,ia,jb,kc,ld", C, axes, axes, axes, axes)


def isotropic():
    d = np.eye(3)
    return (LAMBDA * np.einsum("ij,kl->ijkl", d, d) + MU * (np.einsum("ik,jl->ijkl", d, d) + np.einsum("il,jk->ijkl", d, d)))


ALPHA, FIBRE = 3e5, np.array([1, 0.3, -0.2]) / np.linalg.norm([1, 0.3, -0.2])
CROSS = np.cross(FIBRE, [0, 0, 1]) / np.linalg.norm(np.cross(FIBRE, [0, 0, 1]))
FIBRES = {"Fibre stiffness": ALPHA, "Fibre direction": "1; 0.3; -0.2"}
NINE = [2e5, 1e5, 0.7e5, 0.3, 0.25, 0.2, 0.3e5, 0.4e5, 0.5e5]
ORTHOTROPY = {"Orthotropy": ", ".join(map(str, NINE)), "Fibre direction": "1; 0.3; -0.2", "Cross direction": "; ".join(map(str, CROSS))}
FIBRE_TENSOR = ALPHA * np.einsum("i,j,k,l->ijkl", *[FIBRE] * 4)
NINE_TENSOR = orthotropic(NINE, np.array([FIBRE, CROSS, np.cross(FIBRE, CROSS)]))


def of_fibres(E):
    """C_a:E of (30)."""
    return ALPHA * (FIBRE @ E @ FIBRE) * np.outer(FIBRE, FIBRE)


def law_of_nine():
    of_grain, lam, mu = grain(NINE_TENSOR)
    return Law(lam, mu, of_grain, of_guard=(lam, mu))


class OfCells(Formulas):
    def test_strains_and_stresses(self):
        """(1) to (4), (14), (14b)."""
        problem = make(scene(Examples=examples()))
        self.near(problem.shape_gradients, shapes(NODES, CELLS)[0])
        self.near(problem.example_strains[:, 0], ETA * EXAMPLES, 1e-14)
        for name, F in STATES.items():
            with self.subTest(name):
                R, S = polar(F)
                problem.state = problem.state.replace(positions=NODES @ F.T + [1, 2, 3])
                n, J = dot(F, F), np.linalg.det(F)
                cof = np.array([np.cross(F[(i + 1) % 3], F[(i + 2) % 3]) for i in range(3)])
                root = (3 * n)**0.5
                for _ in range(60):
                    slope = 4 * root**3 - 4 * n * root - 8 * J
                    root -= (root**4 - 2 * n * root**2 - 8 * J * root + n**2 - 4 * dot(cof, cof)) / slope
                self.near(root, np.trace(S), 1e-7)
                product = np.linalg.det(np.trace(S) * I - S)
                if product > 0.1:
                    self.near(slope / 8, product, 1e-6)
                    I_2 = (root**2 - n) / 2
                    self.near((root * cof + (root**2 - I_2) * F - F @ F.T @ F) * 8 / slope, R, 1e-8)
                self.near(problem.strains[0] + I, S, 1e-13)
                T = stress(S - I - ETA * np.einsum("i,ijk", problem.weights, EXAMPLES))
                self.near(problem.stresses[0] + 1e3 * I, R @ T @ R.T + 1e3 * I)
                self.near(problem.det_F + 1, J + 1, 1e-14)

    def test_consistent_forces(self):
        """(7), (9), (16) to (18), (24), (30), (40) in one cell, also inverted, flat, guarded and stretched."""
        near_kink = [POSES[0], with_stretches(1.1, 0.5, -0.45)]
        least = np.linalg.det(np.trace(polar(near_kink[1])[1]) * I - polar(near_kink[1])[1]) / 2
        for name, material, law, poses in (
                ("isotropic", {}, Law(), POSES), ("near the kink", {}, Law(p_0=least), near_kink), ("fibres", FIBRES, Law(grain=of_fibres), POSES),
                ("nine constants", ORTHOTROPY, law_of_nine(), POSES), ("without examples", {}, Law(), None)):
            poses = poses and [NODES @ F.T for F in poses]
            problem = make(scene(Material=material, **({"Examples": examples()} if poses else {})), poses=poses)
            body = Body(NODES, CELLS, poses or (), law, sigma=SIGMA if poses else 0)
            for state, F in STATES.items():
                with self.subTest(name, state=state):
                    self.compare(problem, body, NODES @ F.T, WEIGHTS if poses else np.ones(1))

    def test_columns_are_differences_of_forces(self):
        problem = make(scene(Examples=examples()))
        for state, F in STATES.items():
            with self.subTest(state):
                x = NODES @ F.T
                change = -differences(lambda w: problem.gradient(x, w).ravel(), WEIGHTS, 1e-4).T
                self.near(problem.coupling(x, WEIGHTS), change, 1e-7)
                self.near(problem.hessian(x, WEIGHTS).toarray(), differences(lambda y: problem.gradient(y, WEIGHTS).ravel(), x, 1e-7), 1e-6)


class OfBodies(Formulas):
    def test_the_three_energies(self):
        """(5), (7), (9), (16) to (18), (40)."""
        for energy, part in ("scaled", 0), ("blended", 1), ("mixed", 0.2):
            with self.subTest(energy):
                problem = make(scene(Examples=examples(energy), Handles=FOOT), STAR, STAR_CELLS, STAR_POSES)
                body = Body(STAR, STAR_CELLS, STAR_POSES, part=part)
                x = moved(STAR)
                self.compare(problem, body, x, WEIGHTS)
                e, E = [polar(F)[1] - I for F in body.F(x)], body.D(WEIGHTS) / ETA
                scaled = body.sum([dot(a - ETA * b, stress(a - ETA * b)) / 2 for a, b in zip(e, E)])
                blended = body.sum([(1 - ETA) / 2 * dot(a, stress(a)) + ETA / 2 * dot(a - b, stress(a - b)) for a, b in zip(e, E)])
                self.near(problem.energy(x, WEIGHTS), (1 - part) * scaled + part * blended + SIGMA / 2 * WEIGHTS @ WEIGHTS)

    def test_frozen_rotations_and_the_convex_tangent(self):
        """(6) to (9): of frozen forces, and beside the exact ones."""
        for gradient in "frozen", "consistent":
            problem = make(scene(Examples=examples(), Handles=FOOT, Model={"Gradient": gradient}), STAR, STAR_CELLS, STAR_POSES)
            body, x = Body(STAR, STAR_CELLS, STAR_POSES), moved(STAR)
            A, G = body.convex(x)
            self.near(problem.hessian(x, WEIGHTS, "convex").toarray(), A)
            self.near(problem.coupling(x, WEIGHTS, "convex"), G)
        problem = make(scene(Examples=examples(), Handles=FOOT, Model={"Gradient": "frozen"}), STAR, STAR_CELLS, STAR_POSES)
        T = [polar(F)[0] @ stress(polar(F)[1] - I - D) for F, D in zip(body.F(x), body.D(WEIGHTS))]
        self.near(problem.gradient(x, WEIGHTS), body.forces(T))
        self.near(problem.weight_gradient(x, WEIGHTS), body.weight_gradient(x, WEIGHTS))

    def test_convex_tangent_of_stretched_cells(self):
        """(8) with the positive part of what the exact tangent without examples has more."""
        for with_examples in False, True:
            problem = make(scene(**({"Examples": examples()} if with_examples else {})))
            body = Body(NODES, CELLS)
            for F in STATES["drawn out"], with_stretches(7, -0.5, 0.6), with_stretches(5, 2, 1):
                R = polar(F)[0]
                units = [np.outer(I[i], I[j]) for i in range(3) for j in range(3)]
                more = np.array([(body.law.dP(F, 0 * I, M) - R @ stress(sym(R.T @ M))).ravel() for M in units])
                values, vectors = np.linalg.eigh(sym(more))
                more = vectors @ np.diag(np.maximum(values, 0)) @ vectors.T
                A = body.convex(NODES @ F.T)[0] + matrix(CELLS, lambda m, dF: (more @ dF.ravel()).reshape(3, 3), body.g, body.V, 4)
                self.near(problem.hessian(NODES @ F.T, WEIGHTS if with_examples else None, "convex").toarray(), A, 1e-10)

    def test_linear_and_greens_strain(self):
        """(19), and all with R = I."""
        problem = make(scene(Examples=examples(), Handles=FOOT, Model={"Strain": "green"}), STAR, STAR_CELLS, STAR_POSES)
        body, x = Body(STAR, STAR_CELLS, STAR_POSES), moved(STAR)
        E = np.array([0 * body.E[0]] + [[(F.T @ F - I) / 2 for F in body.F(y)] for y in STAR_POSES])
        D, F = ETA * np.einsum("i,imjk->mjk", WEIGHTS, E), body.F(x)
        T = [stress((f.T @ f - I) / 2 - d) for f, d in zip(F, D)]
        self.near(problem.energy(x, WEIGHTS), body.sum([dot(f.T @ f / 2 - I / 2 - d, t) / 2 for f, d, t in zip(F, D, T)])
                  + SIGMA / 2 * WEIGHTS @ WEIGHTS)
        self.near(problem.gradient(x, WEIGHTS), body.forces([f @ t for f, t in zip(F, T)]))
        positive = []
        for t in T:
            values, vectors = np.linalg.eigh(t)
            positive.append(vectors @ np.diag(np.maximum(values, 0)) @ vectors.T)
        for kind, of in ("exact", T), ("convex", positive):
            A = matrix(STAR_CELLS, lambda m, dF: dF @ of[m] + F[m] @ stress(sym(F[m].T @ dF)), body.g, body.V, body.n)
            self.near(problem.hessian(x, WEIGHTS, kind).toarray(), A)
            G = np.array([ETA * body.forces([f @ stress(e) for f, e in zip(F, e_i)]).ravel() for e_i in E]).T
            self.near(problem.coupling(x, WEIGHTS, kind), G)
        problem = make(scene(Examples=examples(), Handles=FOOT, Model={"Strain": "linear"}), STAR, STAR_CELLS, STAR_POSES)
        E = np.array([0 * body.E[0]] + [[sym(F) - I for F in body.F(y)] for y in STAR_POSES])
        D = ETA * np.einsum("i,imjk->mjk", WEIGHTS, E)
        T = [stress(sym(f) - I - d) for f, d in zip(F, D)]
        self.near(problem.gradient(x, WEIGHTS), body.forces(T))
        A = matrix(STAR_CELLS, lambda m, dF: stress(sym(dF)), body.g, body.V, body.n)
        for kind in "exact", "convex":
            self.near(problem.hessian(x, WEIGHTS, kind).toarray(), A)
            self.near(problem.coupling(x, WEIGHTS, kind), np.array([ETA * body.forces([stress(e) for e in e_i]).ravel() for e_i in E]).T)

    def test_parts_of_the_strain(self):
        """(31), with fibres and nine constants."""
        for material, C in ({}, isotropic()), (FIBRES, isotropic() + FIBRE_TENSOR), (ORTHOTROPY, NINE_TENSOR):
            compliance = np.linalg.pinv(C.reshape(9, 9)).reshape(3, 3, 3, 3)
            for part in ("all", "shape", "volume", "along fibres", "across fibres")[:5 if material else 3]:
                with self.subTest(part, material=str(material)):
                    problem = make(scene(Examples=examples("blended", **{"Acts on": part}), Material=material, Handles=FOOT),
                                   STAR, STAR_CELLS, STAR_POSES)
                    B = I if part in ("shape", "volume") else np.outer(FIBRE, FIBRE)
                    held = np.einsum("ijkl,kl", compliance, B)
                    Pi = np.einsum("ij,kl->ijkl", held, B) / dot(B, held)
                    one = (np.einsum("ik,jl->ijkl", I, I) + np.einsum("il,jk->ijkl", I, I)) / 2
                    Pi = {"all": one, "shape": one - Pi, "across fibres": one - Pi}.get(part, Pi)
                    C_e = ETA * np.einsum("ijkl,klmn->ijmn", C, Pi)
                    self.near(C_e, np.einsum("ijkl->klij", C_e))
                    body, x = Body(STAR, STAR_CELLS, STAR_POSES), moved(STAR)
                    e, E = np.array([polar(F)[1] - I for F in body.F(x)]), body.D(WEIGHTS) / ETA
                    square = lambda A, C: np.einsum("mij,ijkl,mkl->m", A, C, A) / 2
                    self.near(problem.energy(x, WEIGHTS), body.sum(square(e, C - C_e) + square(e - E, C_e)) + SIGMA / 2 * WEIGHTS @ WEIGHTS)

    def test_examples_with_constants_of_their_own(self):
        """(38): the left side of it, and the columns and H with D_i and C'."""
        young, nu = 5e4, 0.1
        for material, of_grain in ({}, None), (FIBRES, of_fibres):
            problem = make(scene(Examples=examples("blended", **{"Example modulus": young, "Example Poisson ratio": nu}), Material=material,
                                 Handles=FOOT), STAR, STAR_CELLS, STAR_POSES)
            body, x = Body(STAR, STAR_CELLS, STAR_POSES, Law(grain=of_grain)), moved(STAR)
            e, E = np.array([polar(F)[1] - I for F in body.F(x)]), body.D(WEIGHTS) / ETA
            self.near(problem.energy(x, WEIGHTS), body.sum([(1 - ETA) / 2 * dot(a, body.law.C(a)) + ETA / 2 * dot(a - b, stress(a - b, young, nu))
                                                            for a, b in zip(e, E)]) + SIGMA / 2 * WEIGHTS @ WEIGHTS)
            C = np.array([body.law.C(np.outer(a, b) / 2 + np.outer(b, a) / 2).ravel() for a in I for b in I])
            C_e = np.array([stress(np.outer(a, b) / 2 + np.outer(b, a) / 2, young, nu).ravel() for a in I for b in I])
            whole = (1 - ETA) * C + ETA * C_e
            C_y = (1 - ETA) / ETA * whole @ np.linalg.pinv(C_e) @ C
            D = body.E.reshape(3, -1, 9) @ (np.linalg.pinv(whole) @ (ETA * C_e)).T
            self.near(problem.weight_hessian(), np.einsum("m,imk,kl,jml->ij", body.V, D, whole + C_y, D) + SIGMA * np.eye(3))
            a, b = ETA * stress(I, young, nu)[0, 0] / 3 + (1 - ETA) * stress(I)[0, 0] / 3, ETA * young / (1 + nu) / 2 + (1 - ETA) * MU
            law = Law(a - 2 / 3 * b, b, of_grain and (lambda E: (1 - ETA) * of_fibres(E)))
            body.law, body.E = law, D.reshape(3, -1, 3, 3) / ETA
            self.near(problem.gradient(x, WEIGHTS), body.gradient(x, WEIGHTS))
            self.near(problem.coupling(x, WEIGHTS), body.columns(x))

    def test_importance_and_weights_by_region(self):
        """(20), and (5) with the importance of each cell."""
        ids = np.arange(20) % 2 + 1
        for energy, part in ("scaled", 0), ("blended", 1):
            problem = make(scene(Examples=examples(energy), Material={"region 2": {"Importance factor": 0.6}}, Handles=FOOT), STAR,
                           (STAR_CELLS, ids), STAR_POSES)
            body, x = Body(STAR, STAR_CELLS, STAR_POSES), moved(STAR)
            eta = ETA * np.where(ids == 2, 0.6, 1)
            e, E = np.array([polar(F)[1] - I for F in body.F(x)]), body.D(WEIGHTS) / ETA
            scaled = [dot(a - h * b, stress(a - h * b)) / 2 for a, b, h in zip(e, E, eta)]
            blended = [(1 - h) / 2 * dot(a, stress(a)) + h / 2 * dot(a - b, stress(a - b)) for a, b, h in zip(e, E, eta)]
            self.near(problem.energy(x, WEIGHTS), body.sum(blended if part else scaled) + SIGMA / 2 * WEIGHTS @ WEIGHTS)
        for length in 0, 1.2:
            problem = make(scene(Examples=examples(**{"Weights per region": True, "Region blend length": length}), Handles=FOOT), STAR,
                           (STAR_CELLS, ids), STAR_POSES)
            filtered = np.array([ids == 1, ids == 2], float)
            if length:  # of linear elements with lumped masses, the mean in each cell
                mass, A, right = np.zeros(13), np.zeros((13, 13)), np.zeros((2, 13))
                for c, g, V, i in zip(STAR_CELLS, body.g, body.V, ids):
                    mass[c] += V / 4
                    A[np.ix_(c, c)] += length**2 / 12 * V * g @ g.T
                    right[i - 1, c] += V / 4
                filtered = np.linalg.solve(A + np.diag(mass), right.T).T[:, STAR_CELLS].mean(axis=2)
            w = np.array([0.2, 0.5, 0.3, 0.7, -0.3, 0.6])
            E = np.einsum("rm,ri,imjk->mjk", filtered, w.reshape(2, 3), body.E)
            self.near(filtered.sum(axis=0), np.ones(20))
            energy = body.sum([dot(a - ETA * b, stress(a - ETA * b)) / 2 for a, b in zip(e, E)])
            ridge = SIGMA / 2 * (w**2).reshape(2, 3).sum(axis=1) @ (filtered @ body.V) / body.V.sum()
            self.near(problem.energy(x, w), energy + ridge)


class Patch(Body):
    """A body that is one patch: (25) with its continued traces, and (26). `law` is that of the cells, without lambda_m."""

    def __init__(self, *of, lambda_p=LAMBDA, poses=(), full=Law(), **more):
        super().__init__(*of, poses, **more)
        self.lambda_p, self.whole, self.full = lambda_p, self.V.sum(), full  # `full`: whose Gamma (26) has
        means = [(self.V @ (self.F(x)**2).sum(axis=(1, 2))) / self.whole for x in poses]
        self.m_0 = max([5] + [1.2 * m for m in means])
        self.theta_E = np.array([self.V @ np.trace(e, axis1=1, axis2=2) for e in self.E]) / self.whole

    def traces(self, x):
        return np.array([np.trace(polar(F)[1]) - 3 + self.law.kink(polar(F)[1])[1][0] for F in self.F(x)])

    def d_traces(self, x):
        """Their derivatives by F."""
        stretches = [polar(F) for F in self.F(x)]
        return np.array([R @ (I + self.law.kink(S)[1][1] * self.law.kink(S)[3]) for R, S in stretches])

    def theta(self, x):
        return self.V @ self.traces(x) / self.whole

    def b(self, x):
        return self.forces(self.d_traces(x)) / self.whole

    def transition(self, x):
        """m_p; beta and its derivative; Xi of the cells."""
        m = self.V @ (self.F(x)**2).sum(axis=(1, 2)) / self.whole
        z = np.clip((m - self.m_0) / (0.3 * self.m_0), 0, 1)
        Xi = self.lambda_p / 2 * (self.traces(x) - self.theta(x))**2 + [self.full.Gamma(F) for F in self.F(x)]
        return z**3 * (10 - 15 * z + 6 * z**2), 30 * z**2 * (1 - z)**2 / (0.3 * self.m_0), Xi

    def pressure(self, x, w):
        return self.lambda_p * (self.theta(x) - self.eta * w @ self.theta_E)

    def energy(self, x, w):
        more = self.part * self.eta * (1 - self.eta) * self.lambda_p * self.whole / 2 * (w @ self.theta_E)**2
        beta, _, Xi = self.transition(x)
        return super().energy(x, w) + self.whole / 2 * self.pressure(x, w)**2 / self.lambda_p + more + beta * self.sum(Xi)

    def gradient(self, x, w):
        beta, d_beta, Xi = self.transition(x)
        excess = self.traces(x) - self.theta(x)
        P = [beta * self.lambda_p * t * d + beta * self.full.dGamma(F) + 2 * d_beta / self.whole * self.sum(Xi) * F
             for t, d, F in zip(excess, self.d_traces(x), self.F(x))]
        return super().gradient(x, w) + self.pressure(x, w) * self.whole * self.b(x) + self.forces(P)

    def weight_gradient(self, x, w):
        more = self.part * self.eta * (1 - self.eta) * self.lambda_p * self.whole * (w @ self.theta_E)
        return super().weight_gradient(x, w) + (more - self.eta * self.whole * self.pressure(x, w)) * self.theta_E

    def tangent(self, x, w):
        """With what (26) adds, each summand as it is printed."""
        F, D, theta, traces, d_traces = self.F(x), self.D(w), self.theta(x), self.traces(x), self.d_traces(x)
        beta, d_beta, Xi = self.transition(x)
        dd_beta = self.dd_beta(x)
        pressures = self.pressure(x, w) + beta * self.lambda_p * (traces - theta)
        sum_Xi = self.sum(Xi)

        def dP(m, dF):
            R, S = polar(F[m])
            M = R.T @ dF
            Omega = skew(S, M - M.T)
            dS = M - Omega @ S
            d_dp = 2 * np.trace(S) * np.trace(dS) * I - dS @ S - S @ dS
            _, r, y, by_S, norm = self.law.kink(S)
            d_by_S = (d_dp - 2 * (dot(by_S, dS) * S + y * dS)) / norm**2 - 2 * dot(S, dS) / norm**2 * by_S
            turned = Omega @ (I + r[1] * by_S) + r[2] * dot(by_S, dS) * by_S + r[1] * d_by_S
            return (self.law.dP(F[m], D[m], dF) + pressures[m] * R @ turned
                    + beta * (self.lambda_p * dot(d_traces[m], dF) * d_traces[m] + R @ self.full.ddGamma(F[m], Omega, dS, d_dp))
                    + sum_Xi * d_beta * 2 / self.whole * dF)
        b = self.b(x).ravel()
        d_m = self.forces(2 / self.whole * F).ravel()
        d_Xi = self.forces([self.lambda_p * (t - theta) * d + self.full.dGamma(f) for t, d, f in zip(traces, d_traces, F)]).ravel()
        return (matrix(self.cells, dP, self.g, self.V, self.n) + (1 - beta) * self.lambda_p * self.whole * np.outer(b, b)
                + d_beta * (np.outer(d_m, d_Xi) + np.outer(d_Xi, d_m)) + sum_Xi * dd_beta * np.outer(d_m, d_m))

    def dd_beta(self, x):
        z = np.clip((self.V @ (self.F(x)**2).sum(axis=(1, 2)) / self.whole - self.m_0) / (0.3 * self.m_0), 0, 1)
        return 60 * z * (1 - z) * (1 - 2 * z) / (0.3 * self.m_0)**2

    def columns(self, x):
        return super().columns(x) + self.eta * self.lambda_p * self.whole * np.outer(self.b(x), self.theta_E)

    def H(self):
        factor = self.eta**2 + self.part * self.eta * (1 - self.eta)
        return super().H() + factor * self.lambda_p * self.whole * np.outer(self.theta_E, self.theta_E)


PATCHES = {"Dilatation": "patches"}


class OfPatches(Formulas):
    def test_mean_dilatation(self):
        """(25) with isotropic cells, and with lambda_m of fibres and nine constants."""
        deviators = np.linalg.qr(np.array([(sym(np.outer(I[i], I[j])) if i != j else np.outer(I[i], I[i]) - np.outer(I[2], I[2])).ravel()
                                           for i, j in ((0, 0), (1, 1), (0, 1), (1, 2), (0, 2))]).T)[0].T
        for name, material, C, of_grain, lam, mu in (("isotropic", {}, isotropic(), None, LAMBDA, MU),
                                                     ("fibres", FIBRES, isotropic() + FIBRE_TENSOR, of_fibres, LAMBDA, MU),
                                                     ("nine constants", ORTHOTROPY, NINE_TENSOR, *grain(NINE_TENSOR))):
            compliance = np.linalg.pinv(C.reshape(9, 9)).reshape(3, 3, 3, 3)
            least = np.linalg.eigvalsh(deviators @ C.reshape(9, 9) @ deviators.T)[0] / 2
            lambda_m = 1 / np.einsum("iijj", compliance) - 2 / 3 * least
            if name == "isotropic":
                self.near(lambda_m, LAMBDA)
            for energy, part in ("scaled", 0), ("mixed", 0.2):
                with self.subTest(name, energy=energy):
                    problem = make(scene(Examples=examples(energy), Model=PATCHES, Material=material, Handles=FOOT), STAR, STAR_CELLS, STAR_POSES)
                    body = Patch(STAR, STAR_CELLS, poses=STAR_POSES, law=Law(lam - lambda_m, mu, of_grain), lambda_p=lambda_m, part=part)
                    self.compare(problem, body, moved(STAR), WEIGHTS, 1e-10)
                    A, G = body.convex(moved(STAR))
                    b = body.b(moved(STAR)).ravel()
                    self.near(problem.hessian(moved(STAR), WEIGHTS, "convex").toarray(), A + lambda_m * body.whole * np.outer(b, b), 1e-10)
                    self.near(problem.coupling(moved(STAR), WEIGHTS, "convex"),
                              G + ETA * lambda_m * body.whole * np.outer(b, body.theta_E), 1e-10)

    def test_thin_cells_and_strongly_stretched_patches(self):
        """(25) with r(y), (26)."""
        for name, F, size in ("thin", with_stretches(1.2, 0.3, -0.25), 0.1), ("stretched", with_stretches(1.9, 1.2, 0.6), 0.1), \
                ("far", with_stretches(2.7, 1, 0.5), 0.2), ("thin and stretched", with_stretches(2.7, 0.3, -0.25), 0.1), \
                ("guarded and stretched", with_stretches(4, 0.4, -0.3), 0.2):
            for poses in [], STAR_POSES:
                with self.subTest(name, examples=len(poses)):
                    problem = make(scene(Model=PATCHES, Handles=FOOT, **({"Examples": examples()} if poses else {})), STAR, STAR_CELLS, poses or None)
                    body = Patch(STAR, STAR_CELLS, poses=poses, law=Law(0, MU), full=Law(), sigma=SIGMA if poses else 0)
                    x = moved(STAR, F, size)
                    thin = [body.law.kink(polar(f)[1])[1][0] > 0 for f in body.F(x)]
                    self.assertEqual(any(thin), "thin" in name or "guarded" in name)
                    self.assertEqual(body.transition(x)[0] > 0, name != "thin")
                    self.compare(problem, body, x, WEIGHTS if poses else np.ones(1), 1e-10)


class NeoHookean:
    """(34), (36)."""

    def __init__(self, lam=LAMBDA, mu=MU):
        self.mu, self.mu_S, self.lambda_S = mu, 4 / 3 * mu, lam + 5 / 6 * mu
        self.J_0 = 1 + mu / self.lambda_S
        self.at_rest = 0
        self.at_rest = self.density(I)

    def density(self, F):
        I_C, J = dot(F, F), np.linalg.det(F)
        return (self.mu_S / 2 * (I_C - 3) + self.lambda_S / 2 * (J - self.J_0)**2 - self.mu_S / 2 * np.log(I_C + 1)) - self.at_rest

    def P(self, F):
        I_C, J = dot(F, F), np.linalg.det(F)
        return self.mu_S * (1 - 1 / (I_C + 1)) * F + self.lambda_S * (J - self.J_0) * cofactors(F)

    def dP(self, F, dF):
        I_C, J, cof = dot(F, F), np.linalg.det(F), cofactors(F)
        return (self.mu_S * (1 - 1 / (I_C + 1)) * dF + 2 * self.mu_S / (I_C + 1)**2 * dot(F, dF) * F + self.lambda_S * dot(cof, dF) * cof
                + self.lambda_S * (J - self.J_0) * d_cofactors(F, dF))


def cofactors(F):
    return np.array([np.cross(F[1], F[2]), np.cross(F[2], F[0]), np.cross(F[0], F[1])])


def d_cofactors(F, dF):
    """Cofactors are quadratic."""
    return cofactors(F + dF) - cofactors(F) - cofactors(dF)


class OfNeoHookeanBodies(Formulas):
    def test_the_background(self):
        """(34), (36)."""
        problem, law, body = make(scene(Model={"Background": "neo-hookean"})), NeoHookean(), Body(NODES, CELLS)
        for state, F in STATES.items():
            with self.subTest(state):
                x = NODES @ F.T
                self.near(problem.energy(x) + 1, body.sum([law.density(F)]) + 1)
                self.near(problem.gradient(x) + 1, body.forces([law.P(F)]) + 1)
                self.near(problem.hessian(x).toarray(), matrix(CELLS, lambda m, dF: law.dP(F, dF), body.g, body.V, 4))
                self.near(problem.hessian(x, kind="convex").toarray(), body.convex(x)[0])
        e = 1e-5 * sym(STATES["strained"])
        self.near(law.density(I + e), dot(e, stress(e)) / 2, 1e-4)
        for J in 0.3, 1.7:
            other, const = NeoHookean(0), law.lambda_S / 2 * (1 - law.J_0)**2 - 5 * MU / 12 * (1 - 11 / 5)**2
            self.near(law.lambda_S / 2 * (J - law.J_0)**2, LAMBDA / 2 * (J - 1)**2 + 5 * MU / 12 * (J - 11 / 5)**2 + const)
            self.near([other.J_0, other.lambda_S], [11 / 5, 5 / 6 * MU])

    def test_with_examples(self):
        """(35), whose examples have the guard (16) and the columns (40)."""
        problem = make(scene(Model={"Background": "neo-hookean"}, Examples=examples("blended")))
        law, body = NeoHookean(), Body(NODES, CELLS, [NODES @ F.T for F in POSES], Law(ETA * LAMBDA, ETA * MU), eta=1)
        for state, F in STATES.items():
            with self.subTest(state):
                x = NODES @ F.T
                self.near(problem.energy(x, WEIGHTS), body.energy(x, WEIGHTS) + (1 - ETA) * body.sum([law.density(F)]))
                self.near(problem.gradient(x, WEIGHTS), body.gradient(x, WEIGHTS) + (1 - ETA) * body.forces([law.P(F)]))
                self.near(problem.weight_gradient(x, WEIGHTS), body.weight_gradient(x, WEIGHTS))
                self.near(problem.coupling(x, WEIGHTS), body.columns(x))
                self.near(problem.weight_hessian(), body.H())
                A = body.tangent(x, WEIGHTS) + (1 - ETA) * matrix(CELLS, lambda m, dF: law.dP(F, dF), body.g, body.V, 4)
                self.near(problem.hessian(x, WEIGHTS).toarray(), A)

    def test_patches(self):
        """(37), and (25) and (26) with eta lambda_p of the part of the examples."""
        law = NeoHookean(0)
        for F in STATES["strained"], with_stretches(2.7, 1, 0.5), with_stretches(1.2, 0.3, -0.25):
            x = moved(STAR, F, 0.05)
            for poses in [], STAR_POSES:
                problem = make(scene(Model={**PATCHES, "Background": "neo-hookean"}, Handles=FOOT,
                                     **({"Examples": examples("blended")} if poses else {})), STAR, STAR_CELLS, poses or None)
                body = Patch(STAR, STAR_CELLS, poses=poses, law=Law(0, ETA * MU), full=Law(of_guard=(ETA * LAMBDA, ETA * MU)),
                             lambda_p=ETA * LAMBDA, eta=1, sigma=SIGMA)
                w, share = (WEIGHTS, 1 - ETA) if poses else (None, 1)
                Fs = body.F(x)
                J, b = body.V @ np.linalg.det(Fs) / body.whole, body.forces([cofactors(f) for f in Fs]) / body.whole
                energy = body.sum([law.density(f) for f in Fs]) + LAMBDA / 2 * body.whole * (J - 1)**2
                gradient = body.forces([law.P(f) for f in Fs]) + LAMBDA * (J - 1) * body.whole * b
                A = matrix(STAR_CELLS, lambda m, dF: law.dP(Fs[m], dF) + LAMBDA * (J - 1) * d_cofactors(Fs[m], dF), body.g, body.V, body.n)
                A += LAMBDA * body.whole * np.outer(b, b)
                of = [body.energy(x, w), body.gradient(x, w), body.tangent(x, w)] if poses else [0, 0, 0]
                self.near(problem.energy(x, w), share * energy + of[0])
                self.near(problem.gradient(x, w), share * gradient + of[1])
                self.near(problem.hessian(x, w).toarray(), share * A + of[2], 1e-10)
                if poses:
                    self.near(problem.coupling(x, w), body.columns(x), 1e-10)
                    self.near(problem.weight_hessian(), body.H())


YIELD = {"Yield stress": 9e3, "Kinematic hardening": 2e4, "Isotropic hardening": 1e4, "Flow viscosity": 300, "Density": 900}


def flow(e, last, accumulated, h, greatest=0.9):
    """The plastic strain at the end of a step, by (32): the radial return, with the multiplier by bisection; the accumulated one; Delta."""
    s_y, H_kin, H_iso, viscosity = (YIELD[key] for key in ("Yield stress", "Kinematic hardening", "Isotropic hardening", "Flow viscosity"))
    c, limit = viscosity / h, (2 / 3)**0.5 * (s_y + H_iso * accumulated)
    xi = 2 * MU * dev(e) - (2 * MU + 2 / 3 * H_kin) * last
    if np.linalg.norm(xi) <= limit:
        return last, accumulated, 0

    def end(k):
        of = xi - k * last
        size = np.linalg.norm(of)
        step = max(size - limit, 0) / (2 * MU + 2 / 3 * (H_kin + H_iso) + c + k)
        return last + step * of / size, step
    low, high = 0, 0
    if (2 / 3)**0.5 * np.linalg.norm(end(0)[0]) > greatest:
        high = 1e9
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if (2 / 3)**0.5 * np.linalg.norm(end(middle)[0]) > greatest else (low, middle)
    p, step = end(high)
    return p, accumulated + (2 / 3)**0.5 * step, step


def plastic_density(e, last, accumulated, h, p):
    """psi_b of (32) before the minimum is taken."""
    s_y, H_kin, H_iso, viscosity = (YIELD[key] for key in ("Yield stress", "Kinematic hardening", "Isotropic hardening", "Flow viscosity"))
    Delta = np.linalg.norm(p - last)
    a = accumulated + (2 / 3)**0.5 * Delta
    return (dot(e - p, stress(e - p)) / 2 + H_kin / 3 * dot(p, p) + H_iso / 2 * a**2 + (2 / 3)**0.5 * s_y * Delta
            + viscosity / (2 * h) * Delta**2)


class OfViscoelasticBodies(Formulas):
    def test_active_fibres(self):
        """(45): energies and forces above and below the least stretch, along a curve and without one."""
        a = np.array([1.0, 2, -1]) / np.sqrt(6)
        gradients = np.linalg.inv(np.hstack([np.ones((4, 1)), NODES]))[1:].T
        volume = np.linalg.det(NODES[1:] - NODES[0]) / 6
        for curve, f in (("", lambda s: 1.0), ("0.5: 0.5; 1: 1; 2: 0", lambda s: np.interp(s, [0.5, 1, 2], [0.5, 1, 0]))):
            for F in (I, I + np.array([[0.1, 0.3, -0.2], [0, -0.2, 0.1], [0.2, 0.1, 0.3]]), turn([1, 1, 2], 2.5) @ (I - 0.95 * np.outer(a, a))):
                material = {"Young's modulus": YOUNG, "Poisson's ratio": NU, "Fibre direction": "1, 2, -1"}
                passive, active = (make(scene(Material={**material, **more})) for more in
                                   ({"Fibre direction": ""}, {"Fibre tension": "3e4 + 1e4*t", "Fibre tension curve": curve}))
                x = NODES @ F.T
                s = np.linalg.norm(F @ a)
                grid = np.linspace(1, max(s, 0.1), 200001)
                W = np.trapezoid([f(y) for y in grid], grid) if hasattr(np, "trapezoid") else np.trapz([f(y) for y in grid], grid)
                factor = f(max(s, 0.1)) / max(s, 0.1)
                W -= 0.5 * factor * (0.1**2 - s**2) if s < 0.1 else 0
                self.assertAlmostEqual((active.energy(x) - passive.energy(x)) / (3e4 * volume * W or 1), float(W != 0), places=8)
                forces = 3e4 * volume * factor * np.outer(gradients @ a, F @ a)
                np.testing.assert_allclose(active.gradient(x) - passive.gradient(x), forces, atol=1e-9 * 3e4)

    def test_relaxing_cells(self):
        """(41) over two steps of a dynamic scene, with examples and without: energies, what is dissipated, and forces by differences."""
        h, tau, r = 0.01, 0.03, 0.4
        for eta in 0, ETA:
            with self.subTest(eta=eta):
                problem = make(scene(Scene="dynamic", Handles={}, Material={"Density": 900, "Relaxation time": tau, "Relaxing share": r},
                                     Time={"Step": h, "End": 1}, **({"Examples": examples("scaled")} if eta else {})))
                body = Body(NODES, CELLS, [NODES @ F.T for F in POSES], Law())
                problem.state = problem.state.replace(velocities=NODES @ np.array([[9, 4, -20], [3, -7, 2], [8, 3, 1.]]))
                q, dissipated, f = np.zeros((3, 3)), 0, h / (tau + h)

                def relaxed(E):
                    return stress(E) - 2 * MU * r * dev(E)
                for _ in range(2):
                    problem.step()
                    e = polar(body.F(problem.positions)[0])[1] - I
                    way = dev(e) - q
                    density = r * MU * (1 - f) * dot(way, way)
                    dissipated += body.V[0] * 2 * f * density
                    self.near(problem.statistics["energy_dissipated"], dissipated, 1e-9)
                    self.near(problem.statistics["energy_elastic"], body.V[0] * (dot(e, relaxed(e)) / 2 + (1 - f) * density), 1e-9)
                    q = q + f * way
                mass = body.V[0] * 900 / 20 * (np.ones((4, 4)) + np.eye(4))
                x_hat = problem.positions + h * problem.velocities
                x = moved(problem.positions, I, 0.1, 2)
                e, u = polar(body.F(x)[0])[1] - I, x - x_hat
                D = body.D(WEIGHTS)[0] if eta else np.zeros((3, 3))
                psi = dot(e - D, relaxed(e - D)) / 2 + r * MU * (1 - f) * dot(dev(e) - q, dev(e) - q)
                given, ridge = ((WEIGHTS,), SIGMA / 2 * WEIGHTS @ WEIGHTS) if eta else ((), 0)
                self.near(problem.energy(x, *given), body.V[0] * psi + np.sum(u * (mass @ u)) / (2 * h**2) + ridge, 1e-10)
                self.near(problem.gradient(x, *given).ravel(), differences(lambda y: problem.energy(y, *given), x, 1e-6).ravel(), 1e-6)
                self.near(problem.hessian(x, *given).toarray(), differences(lambda y: problem.gradient(y, *given).ravel(), x, 1e-7), 1e-6)
                if eta:
                    self.near(problem.weight_gradient(x, WEIGHTS), differences(lambda w: problem.energy(x, w), WEIGHTS, 1e-5), 1e-6)
                    self.near(problem.coupling(x, WEIGHTS), -differences(lambda w: problem.gradient(x, w).ravel(), WEIGHTS, 1e-4).T, 1e-7)


class OfPlasticBodies(Formulas):
    def test_yielding_cells(self):
        """(32), (33), also with fibres and beyond the greatest plastic strain, over two steps of a dynamic scene."""
        h = 0.01
        for name, material, of_grain in ("isotropic", {}, None), ("fibres", FIBRES, of_fibres), ("bounded", {"Greatest plastic strain": 0.08}, None):
            for eta in 0, ETA:
                with self.subTest(name, eta=eta):
                    problem = make(scene(Scene="dynamic", Handles={}, Material={**YIELD, **material}, Time={"Step": h, "End": 1},
                                         **({"Examples": examples("blended")} if eta else {})))
                    body, greatest = Body(NODES, CELLS, [NODES @ F.T for F in POSES], Law(grain=of_grain)), material.get("Greatest plastic strain", 0.9)
                    mass = body.V[0] * 900 / 20 * (np.ones((4, 4)) + np.eye(4))
                    problem.state = problem.state.replace(velocities=NODES @ np.array([[9, 4, -20], [3, -7, 2], [8, 3, 1.]]))
                    last, accumulated, dissipated = np.zeros((3, 3)), 0, 0
                    H_kin, H_iso = YIELD["Kinematic hardening"], YIELD["Isotropic hardening"]
                    for _ in range(2):
                        problem.step()
                        e = polar(body.F(problem.positions)[0])[1] - I
                        p, a, Delta = flow(e, last, accumulated, h, greatest)
                        self.assertGreater(Delta, 0)
                        stored = [H_kin / 3 * dot(x, x) + H_iso / 2 * y**2 for x, y in ((last, accumulated), (p, a))]
                        dissipated += (1 - eta) * body.V[0] * ((2 / 3)**0.5 * YIELD["Yield stress"] * Delta
                                                              + YIELD["Flow viscosity"] / h * Delta**2 + stored[1] - stored[0])
                        last, accumulated = p, a
                        self.near(problem.statistics["energy_dissipated"], dissipated, 1e-9)
                        elastic = dot(e - p, stress(e - p)) / 2 + (dot(e, of_grain(e)) / 2 if of_grain else 0)
                        self.near(problem.statistics["energy_elastic"], body.V[0] * elastic, 1e-9)
                    if name == "bounded":
                        self.assertAlmostEqual((2 / 3)**0.5 * np.linalg.norm(last), 0.08, places=12)
                    x_hat = problem.positions + h * problem.velocities
                    places = [moved(problem.positions, I, size, seed) for size, seed in ((0.1, 2), (0.02, 3))]
                    for x in places if of_grain else [*places, NODES @ STATES["guarded"].T]:
                        S, u = polar(body.F(x)[0])[1], x - x_hat
                        e, E, phi = S - I, body.D(WEIGHTS)[0] / ETA, body.law.guard(S)[0]
                        of_fibre = of_grain or (lambda e: 0 * e)
                        p = flow(phi * e, last, accumulated, h, greatest)[0]
                        D = eta * E + (1 - eta) * p
                        psi = (1 - eta) * (plastic_density(e, last, accumulated, h, p) + dot(e, of_fibre(e)) / 2)
                        psi += eta / 2 * dot(e - E, body.law.C(e - E)) + (1 - phi) * body.law.held(S, D)[0]
                        inertia = np.einsum("ac,ab,bc", u, mass, u) / (2 * h**2)
                        w = WEIGHTS if eta else None
                        self.near(problem.energy(x, w), body.V[0] * psi + inertia + (SIGMA / 2 * WEIGHTS @ WEIGHTS if eta else 0), 1e-9)
                        force = body.forces([body.law.P(body.F(x)[0], D)]) + mass @ u / h**2
                        if of_grain:  # fibres see all of the strain
                            force += body.forces([Law(0, 0, of_grain).P(body.F(x)[0], eta * E) - Law(0, 0, of_grain).P(body.F(x)[0], D)])
                        self.near(problem.gradient(x, w), force, 1e-9)
                        self.near(problem.hessian(x, w).toarray(), differences(lambda y: problem.gradient(y, w).ravel(), x, 1e-7), 1e-6)
                        best = plastic_density(phi * e, last, accumulated, h, p)
                        for seed in range(9):
                            other = p + 1e-3 * dev(sym(np.random.default_rng(seed).standard_normal((3, 3))))
                            if (2 / 3)**0.5 * np.linalg.norm(other) <= greatest:
                                self.assertGreater(plastic_density(phi * e, last, accumulated, h, other), best)
                        R = polar(body.F(x)[0])[0]
                        if not of_grain:
                            def dP(m, dF):
                                d = sym(R.T @ dF)
                                change = [phi * flow(phi * (e + s * 1e-6 * d), last, accumulated, h, greatest)[0] for s in (1, -1)]
                                return R @ (stress(d) - 0.9 * (1 - eta) * 2 * MU * (change[0] - change[1]) / 2e-6)
                            A = matrix(CELLS, dP, body.g, body.V, 4) + np.kron(mass, I) / h**2
                            self.near(problem.hessian(x, w, "convex").toarray(), A, 1e-7)


DENSITY = 900.0
GRAVITY = np.array([1, -2, -6.0])


def mass_of(cells, V, n):
    """Consistent mass matrix of nodes."""
    M = np.zeros((n, n))
    for c, v in zip(cells, V):
        M[np.ix_(c, c)] += DENSITY * v / 20 * (np.ones((4, 4)) + np.eye(4))
    return M


def squared(M, u):
    return np.einsum("ac,ab,bc", u, M, u)


class OfMotion(Formulas):
    def motion(self, **sections):
        sections = {"Time": {"Step": 0.01, "End": 1}, "Loads": {"Gravity": list(GRAVITY)}, **sections}
        return make(scene(Scene="dynamic", Handles={}, Material={"Density": DENSITY}, **sections), STAR, STAR_CELLS,
                    STAR_POSES if "Examples" in sections else None)

    def test_incremental_potential(self):
        """(12), (21), (22), and what damping adds to patches."""
        a, b = 1.7, 0.004
        damped = {"Mass damping": a, "Stiffness damping": b}
        for name, time, model in (("implicit Euler", {}, {}), ("damped", damped, {}), ("BDF2", {**damped, "Scheme": "bdf2"}, {}),
                                  ("patches", {**damped, "Scheme": "bdf2"}, PATCHES)):
            with self.subTest(name):
                problem = self.motion(Examples=examples(), Time={"Step": 0.01, "End": 1, **time}, Model=model)
                body = Body(STAR, STAR_CELLS, STAR_POSES) if not model else \
                    Patch(STAR, STAR_CELLS, poses=STAR_POSES, law=Law(0, MU))
                M = mass_of(STAR_CELLS, body.V, body.n)
                problem.state = problem.state.replace(velocities=STAR @ np.array([[3, 4, -2], [3, -7, 2], [8, 3, 1.]]))
                history = [(problem.positions.copy(), problem.velocities.copy())]
                for h in 0.01, 0.008:
                    problem.step(h)
                    history.append((problem.positions.copy(), problem.velocities.copy()))
                h, r = 0.01, 0.01 / 0.008
                with_two = "Scheme" in time
                gamma = (1 + 2 * r) / ((1 + r) * h) if with_two else 1 / h
                last, before = ((1 + r)**2 / (1 + 2 * r), -r**2 / (1 + 2 * r)) if with_two else (1, 0)
                x_star, v_star = (last * history[-1][k] + before * history[-2][k] for k in (0, 1))
                m, k = (a, b) if time else (0, 0)
                x_hat = x_star + v_star / (gamma + m)
                x, s = moved(problem.positions, I, 0.02), k * gamma
                e_star = last * np.array([polar(F)[1] - I for F in body.F(history[-1][0])]) \
                    + before * np.array([polar(F)[1] - I for F in body.F(history[-2][0])])
                e = np.array([polar(F)[1] - I for F in body.F(x)])
                energy = gamma * (gamma + m) / 2 * squared(M, x - x_hat) + body.energy(x, WEIGHTS) - (M.sum(axis=1) @ (x - STAR)) @ GRAVITY
                energy += s / 2 * body.sum([dot(c, body.law.C(c)) for c in e - e_star])
                if model:
                    theta_star = body.V @ np.trace(e_star, axis1=1, axis2=2) / body.whole
                    energy += s / 2 * LAMBDA * body.whole * (body.theta(x) - theta_star)**2
                self.near(problem.energy(x, WEIGHTS), energy)
                # one quadratic with C (1 + b gamma) and a driving strain
                driven = (body.D(WEIGHTS) + s * e_star) / (1 + s)
                law = Law((1 + s) * body.law.lam, (1 + s) * MU, of_guard=(body.law.lam, MU))
                force = body.forces([law.P(F, D) for F, D in zip(body.F(x), driven)])
                force += gamma * (gamma + m) * M @ (x - x_hat) - np.outer(M.sum(axis=1), GRAVITY)
                if model:
                    force += body.whole * (body.pressure(x, WEIGHTS) + s * LAMBDA * (body.theta(x) - theta_star)) * body.b(x)
                self.near(problem.gradient(x, WEIGHTS), force)
                self.near(problem.coupling(x, WEIGHTS), body.columns(x))
                A = body.convex(x)[0] * (1 + s) + gamma * (gamma + m) * np.kron(M, I)
                if model:
                    A += (1 + s) * LAMBDA * body.whole * np.outer(body.b(x).ravel(), body.b(x).ravel())
                self.near(problem.hessian(x, WEIGHTS, "convex").toarray(), A)

    def test_guarded_cells_are_not_damped(self):
        """Below (22) and (25): cells that were guarded before the step, and their patch."""
        h, b = 0.01, 0.004
        for model in {}, PATCHES:
            problem = self.motion(Time={"Step": h, "End": 1, "Stiffness damping": b}, Model=model)
            body = Patch(STAR, STAR_CELLS, law=Law(0, MU), sigma=0) if model else Body(STAR, STAR_CELLS, sigma=0)
            before = moved(STAR, with_stretches(1.1, 0.7, -0.2), 0.2)
            problem.state = problem.state.replace(positions=before)
            S = [polar(F)[1] for F in body.F(before)]
            is_damped = np.array([body.law.guard(s)[0] == 1 for s in S])
            self.assertTrue(is_damped.any() and not is_damped.all())
            x, M = moved(STAR), mass_of(STAR_CELLS, body.V, body.n)
            change = np.array([polar(F)[1] - s for F, s in zip(body.F(x), S)])
            energy = squared(M, x - before) / (2 * h**2) + body.energy(x, np.ones(1)) - (M.sum(axis=1) @ (x - STAR)) @ GRAVITY
            self.near(problem.energy(x), energy + b / h / 2 * body.sum([d * dot(c, body.law.C(c)) for c, d in zip(change, is_damped)]))

    def test_velocities_and_momentum(self):
        """(12), (21): velocities; L = L + h sum v x M v."""
        problem, h = self.motion(Time={"Step": 0.01, "End": 1, "Scheme": "bdf2"}, Loads={"Gravity": [0, 0, 0]}), 0.01
        M = mass_of(STAR_CELLS, shapes(STAR, STAR_CELLS)[1], len(STAR))
        problem.state = problem.state.replace(velocities=STAR @ np.array([[0, 4, -2], [-4, 0, 2], [2, -2, 0.]]))
        x = [problem.positions.copy()]
        for _ in range(2):
            problem.step(h)
            x.append(problem.positions.copy())
        self.near(problem.velocities, 3 / (2 * h) * (x[2] - (4 * x[1] - x[0]) / 3), 1e-9)
        problem = self.motion(Loads={"Gravity": [0, 0, 0]}, Solver={"Method": "newton", "Tolerance": 1e-11})
        problem.state = problem.state.replace(velocities=STAR @ np.array([[0, 4, -2], [-4, 0, 2], [2, -2, 0.]]))
        for _ in range(3):
            x_n, v_n = problem.positions.copy(), problem.velocities.copy()
            problem.step()
            x, v = problem.positions, problem.velocities
            self.near(v, (x - x_n) / h, 1e-9)
            L = np.cross(x, M @ v).sum(axis=0)
            self.near(L, np.cross(x_n, M @ v_n).sum(axis=0) + h * np.cross(v, M @ v_n).sum(axis=0), 1e-7)

    def test_weights_that_remember(self):
        """(27), (28)."""
        price, viscosity = 50.0, 7.0
        problem = self.motion(Examples=examples("blended", Weights="simplex", **{"Yield": price, "Creep viscosity": viscosity}))
        body = Body(STAR, STAR_CELLS, STAR_POSES, part=1)
        M, volume, h = mass_of(STAR_CELLS, body.V, body.n), body.V.sum(), 0.01
        problem.state = problem.state.replace(velocities=40 * (STAR_POSES[0] - STAR))
        dissipated = 0
        for _ in range(3):
            w_n = problem.weights.copy()
            problem.step()
            change = problem.weights - w_n
            dissipated += price * volume * np.abs(change).sum() + h * viscosity * volume * (change**2).sum() / h**2
            self.near(problem.statistics["energy_dissipated"], dissipated, 1e-9)
        self.assertGreater(np.abs(problem.weights - [1, 0, 0]).max(), 0.01)
        x, w_n = moved(problem.positions, I, 0.02), problem.weights
        energy = squared(M, x - problem.positions - h * problem.velocities) / (2 * h**2) + body.energy(x, WEIGHTS) - (M.sum(axis=1) @ (x - STAR)) @ GRAVITY
        energy += volume * (price * np.abs(WEIGHTS - w_n).sum() + viscosity / (2 * h) * ((WEIGHTS - w_n)**2).sum())
        self.near(problem.energy(x, WEIGHTS), energy)
        self.near(problem.weight_gradient(x, WEIGHTS), body.weight_gradient(x, WEIGHTS) + viscosity * volume / h * (WEIGHTS - w_n))
        self.near(problem.weight_hessian(), body.H() + viscosity * volume / h * np.eye(3))

    def test_conditions_on_weights_that_yield(self):
        """The table below (28): some lambda_w fulfils all of them."""
        price, seen = 300.0, set()
        top = {"top": {"Select": "box -9 -9 1.1 9 9 9", "Motion": ["0.9*sin(4.5*t)", "0.7*sin(4.5*t)", "0.5*sin(4.5*t)"]}}
        problem = make(scene(Handles={**FOOT, **top}, Examples=examples("blended", Weights="simplex", Yield=price), Time={"Increments": 12}),
                       STAR, STAR_CELLS, STAR_POSES)
        Y, tolerance = price * shapes(STAR, STAR_CELLS)[1].sum(), 1e-6
        for _ in range(12):
            before = problem.weights.copy()
            problem.step()
            least, greatest = -np.inf, np.inf  # of lambda_w, from bounds on rho = slope + lambda_w
            for w, w_n, slope in zip(problem.weights, before, problem.weight_gradient()):
                kind = "at 0" if w == 0 else "stuck" if w == w_n else "above" if w > w_n else "below"
                kind += " as before" if w == 0 and w_n == 0 else ""
                low, high = {"above": (-Y, -Y), "below": (Y, Y), "stuck": (-Y, Y), "at 0": (Y, np.inf), "at 0 as before": (-Y, np.inf)}[kind]
                least, greatest = max(least, low - slope), min(greatest, high - slope)
                seen.add(kind)
            self.assertLess(least, greatest + tolerance * Y)
        self.assertLessEqual({"above", "below", "stuck", "at 0 as before"}, seen)


class OfStatics(Formulas):
    def test_keys_that_add_up(self):
        """(44) and the table below it, at equilibria with weights at both bounds and between them."""
        seen = set()
        for energy, part in ("scaled", 0), ("mixed", 0.2), ("blended", 1):
            body = Body(STAR, STAR_CELLS, STAR_POSES, part=part)
            body.E = body.E[1:]  # none of the rest pose
            for to in np.array([[0.9, 0.7, 0.5], [-0.3, 0.4, 0.2], [0.3, 0.2, 0.8]]):
                top = {"top": {"Select": "box -9 -9 1.1 9 9 9", "Motion": [f"{x}*t" for x in to]}}
                problem = make(scene(Handles={**FOOT, **top}, Examples=examples(energy, Weights="additive"), Time={"Increments": 2}),
                               STAR, STAR_CELLS, STAR_POSES)
                problem.run()
                x, w = problem.positions, problem.weights
                self.near(problem.energy(x, w), body.energy(x, w))
                slopes, size = body.weight_gradient(x, w), np.abs(np.diag(body.H())).max()
                for weight, slope in zip(w, slopes):
                    kind = "at 0" if weight == 0 else "at 1" if weight == 1 else "between"
                    self.assertTrue(0 <= weight <= 1)
                    low, high = {"at 0": (0, np.inf), "at 1": (-np.inf, 0), "between": (0, 0)}[kind]
                    self.assertTrue(low - 1e-6 * size <= slope <= high + 1e-6 * size, (kind, slope, size))
                    seen.add(kind)
        self.assertEqual(seen, {"at 0", "at 1", "between"})

    def test_balance(self):
        """(39): what bears the loads at rest, and its energy, force and tangent anywhere, examples aside."""
        for patches in False, True:
            problem = make(scene(Handles=FOOT, Material={"Density": DENSITY}, Loads={"Gravity": list(GRAVITY), "Balanced": True},
                                 Model=PATCHES if patches else {}), STAR, STAR_CELLS)
            body = Patch(STAR, STAR_CELLS, law=Law(0, MU), sigma=0) if patches else Body(STAR, STAR_CELLS, sigma=0)
            f = np.outer(mass_of(STAR_CELLS, body.V, body.n).sum(axis=1), GRAVITY)
            free = np.repeat(STAR[:, 2] > -0.9, 3)
            K, u = body.tangent(STAR, np.ones(1)), np.zeros(f.size)
            u[free] = np.linalg.solve(K[np.ix_(free, free)], f.ravel()[free])
            grad = gradients_of(u.reshape(-1, 3), STAR_CELLS, body.g)
            tau = np.array([body.law.C(sym(d)) for d in grad])
            if patches:
                tau += LAMBDA * (body.b(STAR).ravel() @ u) * I
            self.near(body.forces(tau)[free[::3]], f[free[::3]], 1e-9)
            for F in STATES["strained"], with_stretches(1.2, 0.5, -0.3):
                x = moved(STAR, F)
                S = [polar(F)[1] for F in body.F(x)]
                phi = [body.law.guard(s)[0] for s in S]
                of_tau = body.sum([dot(t, s - I) - (1 - p) * dot(s, dev(t)) for t, s, p in zip(tau, S, phi)])
                self.near(problem.energy(x), body.energy(x, np.ones(1)) + of_tau - (f * (x - STAR)).sum(), 1e-9)
                # (17) and (18) are linear in T: - tau as the target of a material with 2 mu = 1 and no C of its own
                stressed = Law(0, 0.5)
                only = [stressed.P(F, -t) - stressed.P(F, 0 * t) for F, t in zip(body.F(x), tau)]
                self.near(problem.gradient(x), body.gradient(x, np.ones(1)) + body.forces(only) - f, 1e-9)
                F = body.F(x)
                A = matrix(STAR_CELLS, lambda m, dF: stressed.dP(F[m], -tau[m], dF) - stressed.dP(F[m], 0 * I, dF), body.g, body.V, body.n)
                self.near(problem.hessian(x).toarray(), body.tangent(x, np.ones(1)) + A, 1e-9)

    def test_one_pass(self):
        """(10), (11), (13) and moved handles, with (6) to (9): from a strained state, once."""
        motion = np.array([0.1, -0.05, 0.2])
        top = {"top": {"Select": "box -9 -9 1.1 9 9 9", "Motion": [f"{m}*t" for m in motion]}}
        problem = make(scene(Handles={**FOOT, **top}, Examples=examples(), Material={"Density": DENSITY}, Loads={"Gravity": list(GRAVITY)},
                             Model={"Gradient": "frozen"}, Solver={"Method": "one pass"}), STAR, STAR_CELLS, STAR_POSES)
        body, k = Body(STAR, STAR_CELLS, STAR_POSES), 3
        f = np.outer(mass_of(STAR_CELLS, body.V, body.n).sum(axis=1), GRAVITY)
        w = problem.weights.copy()
        problem.step()
        held = (STAR[:, 2] < -0.9) | (STAR[:, 2] > 1.1)
        free = np.repeat(~held, 3)
        A, G = body.convex(STAR)
        move = np.where(STAR[:, 2:] > 1.1, motion, 0).ravel()
        N = np.ones((1, k))
        right = f.ravel() - problem_force(body, STAR, w) - A @ move
        r_w = -(body.weight_gradient(STAR, w) - G.T @ move)
        whole = np.block([[A[np.ix_(free, free)], -G[free], np.zeros((free.sum(), 1))], [-G[free].T, body.H(), N.T],
                          [np.zeros((1, free.sum())), N, np.zeros((1, 1))]])
        solution = np.linalg.solve(whole, np.concatenate([right[free], r_w, [1 - w.sum()]]))
        n = free.sum()
        x = STAR.ravel() + move
        x[free] += solution[:n]
        self.near(problem.positions, x.reshape(-1, 3), 1e-9)
        self.near(problem.weights, w + solution[n:n + k], 1e-8)
        Z, z = np.linalg.solve(A[np.ix_(free, free)], G[free]), np.linalg.solve(A[np.ix_(free, free)], right[free])  # (11)
        small = np.block([[body.H() - G[free].T @ Z, N.T], [N, np.zeros((1, 1))]])
        change = np.linalg.solve(small, np.concatenate([r_w + G[free].T @ z, [1 - w.sum()]]))[:k]
        self.near(change, solution[n:n + k], 1e-8)
        self.near(z + Z @ change, solution[:n], 1e-8)

        x, w = problem.positions, problem.weights  # (13)
        e, E = [polar(F)[1] - I for F in body.F(x)], body.D(w) / ETA
        sizes = [np.linalg.norm(stress(a)) + ETA * np.linalg.norm(stress(b)) for a, b in zip(e, E)]
        scale = np.linalg.norm(f, axis=1)
        np.add.at(scale, STAR_CELLS, np.einsum("m,m,ma->ma", body.V, sizes, np.linalg.norm(body.g, axis=2)))
        gradient = problem_force(body, x, w) - f.ravel()
        self.near(problem.residual, np.abs(gradient[free]).max() / scale.max(), 1e-8)
        slope = body.weight_gradient(x, w)
        scales = ETA * body.sum(np.square(sizes))**0.5 * np.array([body.sum([dot(a, a) for a in e_i])**0.5 for e_i in body.E]) + SIGMA * np.abs(w)
        self.near(problem.statistics["kkt_residual"], np.abs(slope - slope.mean()).max() / scales.max(), 1e-7)

    def test_handles_that_follow_a_pose(self):
        """(15), and the turn of a handle by its part."""
        pose = STAR @ (turn([1, 3, 2], 1.3) @ (I + 0.1 * np.ones((3, 3)))).T + [3, 1, 2]
        with tempfile.TemporaryDirectory() as directory:
            name = Path(directory) / "pose.msh"
            name.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n13\n"
                            + "".join(f"{i + 1} {a!r} {b!r} {c!r}\n" for i, (a, b, c) in enumerate(pose.tolist())) + "$EndNodes\n$Elements\n20\n"
                            + "".join(f"{i + 1} 4 2 1 1 {' '.join(str(a + 1) for a in c)}\n" for i, c in enumerate(STAR_CELLS)) + "$EndElements\n")
            problem = make(scene(Handles={"foot": {"Select": "box -9 -9 -9 9 9 0.1", "Follow pose": str(name)}}, Time={"Increments": 4}),
                           STAR, STAR_CELLS)
        held = STAR[:, 2] < 0.1
        X, bar = STAR[held], pose[held]
        c, c_bar = X.mean(axis=0), bar.mean(axis=0)
        Q = polar((bar - c_bar).T @ (X - c))[0]
        angle = np.arccos((np.trace(Q) - 1) / 2)
        axis = np.array([Q[2, 1] - Q[1, 2], Q[0, 2] - Q[2, 0], Q[1, 0] - Q[0, 1]])
        d = (bar - c_bar) @ Q - (X - c)
        for s in 0.25, 0.5, 0.75, 1:
            problem.step()
            self.near(problem.positions[held], c + s * (c_bar - c) + (X - c + s * d) @ turn(axis, s * angle).T, 1e-12)
        self.near(problem.positions[held], bar)


def problem_force(body, x, w):
    """Frozen forces (6)."""
    return body.forces([polar(F)[0] @ stress(polar(F)[1] - I - D) for F, D in zip(body.F(x), body.D(w))]).ravel()


class OfQuadraticElements(Formulas):
    def test_ten_nodes(self):
        """The rule, the masses and the loads of quadratic elements; (16) to (18), (40) and (25) at their points."""
        for mass in "consistent", "lumped":
            for model in {}, PATCHES:
                problem = make(scene(Model={"Element": "P2", **({"Dilatation": "cells"} if not model else model)}, Examples=examples(),
                                     Material={"Density": DENSITY, "Mass matrix": mass}, Loads={"Gravity": list(GRAVITY)}))
                nodes, numbers = problem.state.positions, problem.cell_nodes[0]
                ends = []
                for x in nodes[numbers[4:]]:
                    ends += [(i, j) for i in range(4) for j in range(i) if np.abs((NODES[i] + NODES[j]) / 2 - x).max() < 1e-12]
                self.assertEqual(len(ends), 6)
                linear, V = shapes(NODES, CELLS)
                big, small = (5 + 3 * 5**0.5) / 20, (5 - 5**0.5) / 20
                points = np.full((4, 4), small) + (big - small) * np.eye(4)
                g = []
                for L in points:
                    corners = [(4 * L[a] - 1) * linear[0, a] for a in range(4)]
                    g.append(corners + [4 * (L[i] * linear[0, j] + L[j] * linear[0, i]) for i, j in ends])
                of_points = (np.array(g), np.full(4, V[0] / 4))
                poses = [(NODES @ F.T)[[*range(4)]] for F in POSES]
                poses = [np.array([*x, *[(x[i] + x[j]) / 2 for i, j in ends]]) for x in poses]
                order = np.argsort(numbers)
                body = (Patch if model else Body)(nodes, np.tile(numbers, (4, 1)), poses=[x[order] for x in poses], points=of_points,
                                                  law=Law(0 if model else LAMBDA, MU))
                M = problem.mass.toarray()[::3, ::3]
                unit = DENSITY * V[0]
                expected = np.array([6] * 4 + [32] * 6) / 420 if mass == "consistent" else np.array([1 / 36] * 4 + [4 / 27] * 6)
                self.near(M[numbers, numbers], unit * expected)
                loads = np.array([-1 / 20] * 4 + [1 / 5] * 6) if mass == "consistent" else expected
                f = np.zeros((10, 3))
                f[numbers] = unit * np.outer(loads, GRAVITY)
                x = moved(nodes, size=0.05)
                self.near(problem.energy(x, WEIGHTS), body.energy(x, WEIGHTS) - (f * (x - nodes)).sum())
                self.near(problem.gradient(x, WEIGHTS), body.gradient(x, WEIGHTS) - f)
                self.near(problem.hessian(x, WEIGHTS).toarray(), body.tangent(x, WEIGHTS))
                self.near(problem.coupling(x, WEIGHTS), body.columns(x))
                self.near(problem.weight_gradient(x, WEIGHTS), body.weight_gradient(x, WEIGHTS))
                self.near(problem.weight_hessian(), body.H())


class ClosedForms(Formulas):
    def density(self, F, **sections):
        problem = make(scene(**sections))
        return problem.energy(NODES @ F.T) / shapes(NODES, CELLS)[1][0]

    def test_densities(self):
        s, gamma = 1.3, 0.8
        shear, r = I + gamma * np.outer(I[0], I[1]), (4 + gamma**2)**0.5
        self.near(self.density(s * I), 3 * MU * (s - 1)**2 + 9 / 2 * LAMBDA * (s - 1)**2)
        self.near(self.density(shear), MU * (4 + gamma**2 - 2 * r) + LAMBDA / 2 * (r - 2)**2)
        lateral = 1 - NU * (s - 1)
        self.near(Law().P(np.diag([s, lateral, lateral]), 0 * I) + I, YOUNG * (s - 1) * np.outer(I[0], I[0]) + I)
        law = NeoHookean()
        P = law.P(shear)
        self.near([P[0, 1], P[1, 0]], [law.mu_S * gamma * (1 - 1 / (4 + gamma**2)), MU * gamma])
        r = 0.9
        for _ in range(99):  # free sides
            F = np.diag([s, r, r])
            r -= law.P(F)[1, 1] / (law.dP(F, np.diag([0, 1, 1]))[1, 1])
        k, J = law.mu_S * (1 - 1 / (s**2 + 2 * r**2 + 1)), s * r**2
        self.near([law.P(F)[0, 0], -law.lambda_S * (J - law.J_0) * s], [k * (s - r**2 / s), k], 1e-9)

    def test_tension_of_fibres(self):
        b = np.array([2, -1, 1]) / 6**0.5
        s = FIBRE @ b
        C = (isotropic() + FIBRE_TENSOR).reshape(9, 9)
        strain = np.linalg.pinv(C) @ np.outer(b, b).ravel()
        self.near(b @ strain.reshape(3, 3) @ b, 1 / YOUNG - ((1 + NU) * s**2 - NU)**2 / YOUNG**2 / (1 / ALPHA + 1 / YOUNG))


if __name__ == "__main__":
    unittest.main()
