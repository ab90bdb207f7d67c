#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What patches of one mean dilatation do to linear elements: stiffness, soft modes, pressures, cost.

    /usr/bin/python3 doc/scripts/measure_patches.py [BODY]... [--patches FILE] [--nu NU,...] [--refine 0|1] [--modes N]

BODY is bar, unstructured, cat, horse, slivers or a mesh file (.msh 2.2 or .geo) whose lowest nodes are then held; without one all
but files. FILE holds a patch number a cell, in the order of the mesh file, and is added to the partitions made here: cells (P1), the
program's, node stars, node stars of which small ones join a neighbour, clusters of about 8 cells (METIS), pairs of cells with a common
face. Quadratic elements with the dilatation of each point, and with the mean of a cell, are beside them. The elements are those of
doc/scripts/space_elements.py, not the program's. A row a ratio of Poisson and partition; the truth is P2 with the mean dilatation of
a cell on the mesh with each cell cut in eight:

    deflection    work of gravity over that of P2 with the dilatation of each point on the same mesh, and over the truth
    operations    of a Cholesky factor, over those of P1
    modes         least and greatest ratio of the N least eigenvalues of free vibration to the true ones
                  (a soft spurious mode would be a small ratio)
    beta          least inf-sup constant sup (q, div u) / |eps(u)| over |q|, for pressures q constant on patches
    pressure      error of the patches' pressures in the L2 norm, and of their jumps across patches over the true ones
                  (1: as rough; a checkerboard would be a multiple)
"""
import argparse
import sys
import time
from pathlib import Path

from space_elements import (Elements, Solid, box_mesh, clusters, edges_of, face_areas, face_pairs, gmsh_mesh, inner_faces, np,
                            oriented, program_stars, read_mesh, refined, stars)

TOP = Path(__file__).resolve().parents[2]


def slivers():
    """The bar by Delaunay's tetrahedra of jittered points, as they come: dihedral angles down to a degree."""
    from scipy.spatial import Delaunay
    n, random = (16, 4, 4), np.random.default_rng(1)
    places, _ = box_mesh((4, 1, 1), n)
    jitter = random.uniform(-.08, .08, places.shape)
    jitter[(places == 0) | (places == places.max(axis=0))] = 0
    places = places + jitter
    cells = Delaunay(places).simplices
    edges = places[cells[:, 1:]] - places[cells[:, :1]]
    return oriented(places, cells[np.abs(np.linalg.det(edges)) > 1e-9])


def body(name):
    """Places, cells and the held vertices."""
    if name == "bar":
        places, cells = box_mesh((4, 1, 1), (16, 4, 4))
    elif name == "unstructured":
        places, cells = gmsh_mesh(TOP / "prm/studies/meshes/bar.geo")
    elif name in ("cat", "horse"):
        places, cells = read_mesh(TOP / f"meshes/{name}.msh")
        return places, cells, places[:, 2] < 0.05
    elif name == "slivers":
        places, cells = slivers()
    else:
        places, cells = read_mesh(name)
        low, high = places[:, 2].min(), places[:, 2].max()
        return places, cells, places[:, 2] < low + 0.05 * (high - low)
    return places, cells, places[:, 0] < places[:, 0].min() + 1e-9


def dofs_of(nodes):
    return (3 * np.nonzero(nodes)[0][:, None] + np.arange(3)).ravel()


def partitions(cells, n_nodes, file):
    yield "cells (P1)", None
    yield "the program's", program_stars(cells, n_nodes)
    yield "node stars", stars(cells, n_nodes)
    for least in (4, 8):
        yield f"stars of {least} or more", stars(cells, n_nodes, least)
    yield "clusters of 8", clusters(cells, 8)
    yield "pairs", face_pairs(cells)
    if file:
        yield Path(file).name, np.unique(np.loadtxt(file, dtype=int), return_inverse=True)[1]


class Truth:
    """Quadratic elements on the mesh cut `levels` times, with the mean dilatation of a cell if it is cut: work of gravity, least
    eigenvalues, volume dilated in each cell."""

    def __init__(self, places, cells, held, levels):
        self.n_cells, self.parent = len(cells), np.arange(len(cells))
        for _ in range(levels):
            held = np.concatenate([held, held[edges_of(cells)[0]].all(axis=1)])
            places, cells = refined(places, cells)
            self.parent = np.repeat(self.parent, 8)
        elements = Elements(places, cells, "P2")
        self.solid = Solid(elements, dofs_of(elements.held(held)), np.arange(len(cells)) if levels else None)
        self.forces = elements.gravity([0, 0, -1])

    def solve(self, nu):
        u, self.factor = self.solid.solve(1., nu, self.forces)
        dilated = (self.solid.B @ u).reshape(len(self.parent), -1).sum(axis=1)
        return self.forces @ u, np.bincount(self.parent, dilated, self.n_cells)


def jumps(pressure, patch, pairs, areas):
    a, b = patch[pairs[:, 0]], patch[pairs[:, 1]]
    return np.sqrt((areas * (pressure[a] - pressure[b]) ** 2).sum())


def measure(name, args):
    places, cells, held = body(name)
    coarse = Elements(places, cells)
    p2 = Truth(places, cells, held, 0)
    fine = Truth(places, cells, held, args.refine)
    pairs, faces = inner_faces(cells)
    areas = face_areas(places, faces)
    solids = [(label, patch, Solid(coarse, dofs_of(held), patch)) for label, patch in
              partitions(cells, len(places), args.patches)]
    quadratic, each = p2.solid.elements, np.arange(len(cells))
    solids += [("P2", None, p2.solid), ("P2, mean of a cell", each, Solid(quadratic, dofs_of(quadratic.held(held)), each))]
    print(f"\n{name}: {len(cells)} cells, {3 * (~held).sum()} unknowns; P2 {len(p2.solid.free)}, cut {len(fine.solid.free)}",
          flush=True)
    print("| nu | dilatation | patches | deflection over P2 | over the limit | operations | modes | beta | next | pressure | jumps |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    betas = {label: solid.inf_sup() if patch is not None and len(solid.patch_volume) < args.largest else np.full(3, np.nan)
             for label, patch, solid in solids}
    base = None
    for nu in args.nu:
        work_p2, _ = p2.solve(nu)
        work_fine, dilated = fine.solve(nu)
        true_modes = fine.solid.frequencies(fine.factor, args.modes)
        lam = nu / ((1 + nu) * (1 - 2 * nu))
        for label, patch, solid in solids:
            forces = solid.elements.gravity([0, 0, -1])
            u, factor = solid.solve(1., nu, forces)
            base = base or factor.operations
            modes = solid.frequencies(factor, args.modes) / true_modes
            of = np.arange(len(cells)) if patch is None else patch
            count = of.max() + 1
            volume = solid.patch_volume.reshape(count, -1).sum(axis=1)
            true = lam * np.bincount(of, dilated) / volume
            pressure = lam * (solid.B @ u).reshape(count, -1).sum(axis=1) / volume
            error = np.sqrt((volume * (pressure - true) ** 2).sum() / (volume * true ** 2).sum())
            rough = jumps(pressure, of, pairs, areas) / jumps(true, of, pairs, areas)
            print(f"| {nu} | {label} | {count} | {forces @ u / work_p2:.3f} | {forces @ u / work_fine:.3f} | "
                  f"{factor.operations / base:.2f} | {modes.min():.3f} to {modes.max():.3f} | {betas[label][0]:.3f} | "
                  f"{betas[label][1]:.3f} | {error:.3f} | {rough:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodies", nargs="*", default=["bar", "unstructured", "slivers", "horse", "cat"])
    parser.add_argument("--patches")
    parser.add_argument("--nu", type=lambda text: [float(v) for v in text.split(",")], default=[.3, .45, .49, .499, .4999])
    parser.add_argument("--refine", type=int, default=1)
    parser.add_argument("--modes", type=int, default=20)
    parser.add_argument("--largest", type=int, default=2500, help="patches up to which beta is computed")
    args = parser.parse_args()
    for name in args.bodies:
        start = time.perf_counter()
        measure(name, args)
        print(f"{time.perf_counter() - start:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
