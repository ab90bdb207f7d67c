#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits under refinement of the bodies in doc/measured.md, by elements of high order that share nothing with the program.

    /usr/bin/python3 doc/scripts/measure_space_limits.py [bar] [cook] [cat] [horse] [--write]

Linear elasticity. The bar and Cook's membrane by spectral elements: Lagrange polynomials at Gauss-Lobatto points on quadrilaterals
(Cook's membrane, plane strain) or bricks (the bar 4:1:1, clamped at x = 0, under its own weight across its length), integrated by
Gauss's rule with one point more. Elements shrink geometrically towards clamped edges, where stresses are singular. Printed for two
orders, so that one sees which digits stand. Cook's membrane for unit load, modulus and thickness: displacement along the load of the
middle and the upper corner of the loaded edge, and the mean over it (the work of the load). The bar of unit modulus under a unit body
force: the work, and the displacement of the middle of the end. Cat and horse stand on their soles under a unit body force; each mesh is
a body of its own, a polyhedron, whose limit comes from quadratic tetrahedra with the mean dilatation of a cell on the mesh with each
cell cut in eight, the finest mesh as it is. --write keeps the works in doc/studies/space_limits.csv, as energies of the studies
prm/studies/space_*.prm. Half an hour.
"""
import csv
import itertools
import sys
from pathlib import Path

from space_elements import Elements, Factor, Solid, edges_of, lame, np, read_mesh, refined, sp

TOP = Path(__file__).resolve().parents[2]
FILE = TOP / "doc/studies/space_limits.csv"
# energy of a study's scene over the work for unit modulus and force: half of (density g)^2 / E, of force^2 / E
ENERGY = {"bar": 0.5e6 / 1e8, "cat": 0.5e6 / 1e8, "horse": 0.5e6 / 1e8, "cook": 0.5e-8}
MESHES = {"cat": ("cat_68mm.geo", "cat_48mm.geo", "cat.msh", "cat_26mm.geo"),
          "horse": ("horse_91mm.geo", "horse_64mm.geo", "horse.msh", "horse_34mm.geo")}
NUS = (.3, 1 / 3, .45, .49, .499, .4999)


def lobatto(order):
    """Gauss-Lobatto points on [-1, 1]: the ends and the zeros of the derivative of Legendre's polynomial."""
    inner = np.polynomial.legendre.Legendre.basis(order).deriv().roots()
    return np.concatenate([[-1.], np.sort(inner.real), [1.]])


def lagrange(nodes, x):
    """Values and derivatives of Lagrange's polynomials of the nodes, a row a point."""
    V = np.polynomial.legendre.legvander(nodes, len(nodes) - 1)
    d = np.polynomial.legendre.legder(np.eye(len(nodes)))
    values = np.polynomial.legendre.legvander(x, len(nodes) - 1)
    slopes = np.polynomial.legendre.legvander(x, len(nodes) - 2) @ d
    return values @ np.linalg.inv(V), slopes @ np.linalg.inv(V)


class Spectral:
    """A body that is the image of a box under `place`; `breaks` hold the bounds of the elements along each axis of the box."""

    def __init__(self, breaks, order, place):
        d = self.d = len(breaks)
        nodes = lobatto(order)
        lines = [np.concatenate([[b[0]]] + [(lo + hi) / 2 + (hi - lo) / 2 * nodes[1:] for lo, hi in zip(b, b[1:])]) for b in breaks]
        self.box = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, d)
        self.places = place(self.box)
        counts = [len(line) for line in lines]
        index = np.arange(np.prod(counts)).reshape(counts)
        starts = itertools.product(*(range(0, n - 1, order) for n in counts))
        self.elements = np.array([index[tuple(slice(s, s + order + 1) for s in start)].ravel() for start in starts])
        x, w = np.polynomial.legendre.leggauss(order + 2)
        values, slopes = lagrange(nodes, x)

        def product(factors):
            full = factors[0]
            for f in factors[1:]:
                full = np.einsum("pa,qb->pqab", full, f).reshape(full.shape[0] * f.shape[0], -1)
            return full
        self.N = product([values] * d)
        self.dN = np.stack([product([slopes if i == k else values for i in range(d)]) for k in range(d)], axis=-1)
        self.w = product([w[:, None]] * d)[:, 0]

    def stiffness(self, nu):
        lam, mu = lame(1., nu)
        d, k = self.d, self.elements.shape[1]
        rows, columns, data = [], [], []
        self.weights = np.zeros(len(self.places))
        for nodes in self.elements:
            J = np.einsum("pak,ai->pik", self.dN, self.places[nodes])
            g = np.einsum("pak,pki->pai", self.dN, np.linalg.inv(J))
            w = self.w * np.abs(np.linalg.det(J))
            np.add.at(self.weights, nodes, w @ self.N)
            K = np.zeros((k, d, k, d))
            gw = g * w[:, None, None]
            laplace = mu * np.tensordot(gw, g, ([0, 2], [0, 2]))
            for i in range(d):
                K[:, i, :, i] += laplace
                for j in range(d):
                    cross = gw[:, :, i].T @ g[:, :, j]
                    K[:, i, :, j] += lam * cross + mu * (gw[:, :, j].T @ g[:, :, i])
            dofs = (d * nodes[:, None] + np.arange(d)).ravel()
            rows.append(np.repeat(dofs, len(dofs)))
            columns.append(np.tile(dofs, len(dofs)))
            data.append(K.ravel())
        n = d * len(self.places)
        return sp.csc_matrix((np.concatenate(data), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n))

    def solve(self, nu, forces, held):
        """Displacements, a row a node; `forces` of this shape, from the weights of the nodes if it is a function."""
        K = self.stiffness(nu)
        f = forces(self.weights) if callable(forces) else forces
        free = np.nonzero(~np.repeat(held, self.d))[0]
        u = np.zeros(f.size)
        Kff = K[free][:, free]
        factor = Factor(Kff)
        u[free] = factor.solve(f.ravel()[free])
        u[free] += factor.solve(f.ravel()[free] - Kff @ u[free])
        return u.reshape(f.shape), f


def graded(n, ratio=0.15, uniform=1):
    """Bounds on [0, 1] that shrink towards 0."""
    return np.concatenate([[0.], ratio ** np.arange(n, 0, -1.), np.arange(1, uniform + 1) / uniform]) if uniform == 1 else \
        np.concatenate([[0.], ratio ** np.arange(n, 0, -1.) / uniform, np.arange(1, uniform + 1) / uniform])


def cook(order):
    both = np.concatenate([graded(6) / 2, 1 - graded(6)[-2::-1] / 2])
    left = np.concatenate([graded(6, uniform=2)[:-1], 1 - graded(3)[::-1] / 2])
    left = np.unique(left.round(14))
    body = Spectral([left, both], order, lambda p: np.stack([48 * p[:, 0], 44 * p[:, 0] + p[:, 1] * (44 - 28 * p[:, 0])], axis=1))
    edge = np.nonzero(body.box[:, 0] > 1 - 1e-9)[0]
    # weights of the loaded edge from one-dimensional elements of the same points
    line = Spectral([both], order, lambda p: p)
    line.stiffness(.3)
    forces = np.zeros_like(body.places)
    forces[edge, 1] = line.weights
    rows = []
    for nu in NUS:
        u, f = body.solve(nu, forces, body.box[:, 0] < 1e-12)
        eta = body.box[edge, 1]
        rows.append((nu, u[edge[np.abs(eta - .5).argmin()], 1], u[edge[eta.argmax()], 1], (u * f).sum()))
    return rows


def bar(order):
    x = np.concatenate([graded(3, .15) * .5, np.arange(1, 5.)])
    y = np.concatenate([graded(2, .15) / 2, 1 - graded(2, .15)[-2::-1] / 2])
    body = Spectral([x, y, y], order, lambda p: p)
    tip = np.linalg.norm(body.places - [4, .5, .5], axis=1).argmin()
    rows = []
    for nu in NUS:
        u, f = body.solve(nu, lambda weights: weights[:, None] * np.array([0, 0, -1.]), body.box[:, 0] < 1e-12)
        rows.append((nu, (u * f).sum(), -u[tip, 2]))
    return rows


def animal(mesh):
    """Work of the weight on the limit of one mesh."""
    file = TOP / "meshes" / mesh if mesh.endswith(".msh") else TOP / "prm/studies/meshes" / mesh
    places, cells = read_mesh(file)
    held = places[:, 2] < 1e-3
    if len(cells) < 12000:
        held = np.concatenate([held, held[edges_of(cells)[0]].all(axis=1)])
        places, cells = refined(places, cells)
    elements = Elements(places, cells, "P2")
    fixed = 3 * np.nonzero(elements.held(held))[0][:, None] + np.arange(3)
    solid = Solid(elements, fixed.ravel(), np.arange(len(cells)))
    forces = elements.gravity([0, 0, -1])
    return [(nu, forces @ solid.solve(1., nu, forces)[0], len(cells)) for nu in NUS]


def keep(body, mesh, rows):
    """In the file of the limits, beside the others."""
    others = [row for row in csv.reader(FILE.open()) if row[:2] != [body, mesh]][1:] if FILE.exists() else []
    ours = [[body, mesh, f"{nu:.4g}", f"{ENERGY[body] * work:.6g}"] for nu, work in rows]
    with FILE.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([["body", "mesh", "nu", "energy"], *sorted(others + ours)])


def show(title, columns, rows):
    print(f"\n{title}\n| nu | " + " | ".join(columns) + " |\n|" + " --- |" * (len(columns) + 1))
    for nu, *values in rows:
        print(f"| {nu:.4g} | " + " | ".join(f"{v:.6g}" for v in values) + " |", flush=True)


def main():
    bodies = [word for word in sys.argv[1:] if word in ENERGY] or list(ENERGY)
    for body in bodies:
        if body in MESHES:
            runs = [(mesh, mesh, ("work", "cells"), lambda mesh=mesh: animal(mesh)) for mesh in MESHES[body]]
        elif body == "cook":
            runs = [("", f"cook, order {order}", ("middle", "corner", "work"), lambda order=order: cook(order)) for order in (6, 8)]
        else:
            runs = [("", f"bar, order {order}", ("work", "end"), lambda order=order: bar(order)) for order in (3, 4)]
        for mesh, title, columns, run in runs:
            rows = run()
            show(title, columns, rows)
            if "--write" in sys.argv:
                keep(body, mesh, [(row[0], row[1 + columns.index("work")]) for row in rows])


if __name__ == "__main__":
    main()
