# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the table of doc/measured.md on random pulls: a body is drawn somewhere and let go, again and again.

Usage: PYTHONPATH=build/release/python /usr/bin/python3 doc/scripts/measure_releases.py [--body B] [--reach L] [--steps N] [--seed S] [MATERIAL]...
B is bar, held at one end and drawn at the other, or cat, which stands on its paws and is drawn at its back. Ten steps of .02 s draw it in a
random direction, each time another one, up to `reach` lengths of the body from where it is (.5), ten leave it to itself. The second half is
made once more from a state in the middle. All materials by default: minutes for the bar, hours for the cat; each row is printed
when it is there. Exits with 1 if a run fails, gains energy or resumes to other bytes.
"""
import argparse
import pickle
import sys
from pathlib import Path

import numpy as np

import exemplar

TOP = Path(__file__).resolve().parents[2]
E = 1e6
# mesh, what is held, what is drawn, length [m], an example pose
BODIES = {
    "bar": ({"Generator": "box", "Box size": [4, 1, 1], "Box cells": [8, 2, 2]}, "boundary 1", lambda x: x[:, 0] == 4, 4,
            {"Pose functions": "(8/pi-z)*sin(pi*x/8); y; 8/pi - (8/pi-z)*cos(pi*x/8)"}),
    "cat": ({"File": TOP / "meshes/cat.msh"}, "box -9 -9 -9 9 9 0.04", lambda x: (abs(x[:, 0]) < 0.06) & (x[:, 2] > 0.5), 1,
            {"Poses": TOP / "meshes/poses/cat_arch.msh"}),
}
EXAMPLE = {"Examples": {"Importance": 0.5, "Energy": "blended"}}
FIBRES = {"Fibre stiffness": 4 * E, "Fibre direction": "1; 0; 0.3"}
YIELD = {"Yield stress": 0.02 * E, "Isotropic hardening": 0.02 * E}
MATERIALS = {
    "elastic": {},
    "fibres": {"Material": FIBRES},
    "orthotropy": {"Material": {"Orthotropy": f"{4 * E}, {E}, {E / 2}, 0.3, 0.3, 0.3, {E / 3}, {E / 2}, {E / 4}", "Fibre direction": "1; 0; 0.3",
                                "Cross direction": "0; 1; 0"}},
    "plastic": {"Material": YIELD},
    "fibres in plastic cells": {"Material": {**FIBRES, **YIELD}},
    "memory": {"Examples": {"Importance": 0.8, "Energy": "blended", "Yield": 800}},
    "neo-Hookean": {"Model": {"Background": "neo-hookean"}},
}
MATERIALS.update({f"{name}, example": {**keys, **EXAMPLE} for name, keys in MATERIALS.items() if name != "memory"})
PULL = REST = 10  # steps
MOST_ENERGY_GAINED = 1e-3  # of the greatest: steps are solved to a thousandth of their displacement


class Releases:
    """A body that is pulled and let go."""

    def __init__(self, keys, body, reach, seed):
        mesh, held, drawn, length, pose = BODIES[body]
        material = {"Young's modulus": E, "Poisson's ratio": 0.45, "Density": 1000, **keys.get("Material", {})}
        examples = {"Examples": {**keys["Examples"], **pose}} if "Examples" in keys else {}
        self.problem = exemplar.Problem({"Scene": "dynamic", "Mesh": mesh, "Time": {"Step": 0.02, "End": 1000},
                                         "Handles": {"held": {"Select": held}}, **keys, **examples, "Material": material})
        self.drawn = np.flatnonzero(drawn(self.problem.rest_positions))
        self.reach, self.seed, self.energies, self.reports, self.gain, self.min_det_F = reach * length, seed, [], [], 0, 1

    def pull(self, number):
        """Grab the body, in the pull of that number."""
        random = np.random.default_rng([self.seed, number])
        way = random.normal(size=3)
        way *= self.reach * random.random() ** (1 / 3) / np.linalg.norm(way)
        start, begin = self.problem.time, (self.problem.positions - self.problem.rest_positions)[self.drawn]
        duration = 0.02 * PULL
        self.problem.grab("drawn", self.drawn, lambda rest, t: begin + way * min((t - start) / duration, 1))

    def total_energy(self):
        return sum(self.problem.energies[f"energy_{kind}"] for kind in ("elastic", "example", "kinetic") if f"energy_{kind}" in self.problem.energies)

    def run(self, n_steps):
        """Steps up to that number; what ends them is raised."""
        while self.problem.step_number < n_steps:
            pull, step = divmod(self.problem.step_number, PULL + REST)
            if step == 0:
                self.pull(pull)
            elif step == PULL:
                self.problem.let_go("drawn")
            self.reports.append(self.problem.step())
            self.min_det_F = min(self.min_det_F, self.problem.statistics["min_det_F"])
            self.energies.append(self.total_energy())
            if step >= PULL:
                self.gain = max(self.gain, self.energies[-1] - self.energies[-2])


def measure(keys, n_steps, *pulls):
    """A row of the table but its name, and whether all is well."""
    middle = n_steps // (PULL + REST) // 2 * (PULL + REST)
    first, ended, resumed = Releases(keys, *pulls), "", ""
    try:
        first.run(middle)
        state = pickle.dumps(first.problem.state)
        first.run(n_steps)
        second = Releases(keys, *pulls)
        second.problem.state = pickle.loads(state)
        second.run(n_steps)
        resumed = "same bytes" if second.problem.state == first.problem.state else "OTHER BYTES"
    except exemplar.SolverFailure as failure:
        ended = str(failure).split("\n")[0]
    iterations = [report.iterations for report in first.reports]
    gain = first.gain / max(first.energies)
    row = [len(first.energies), f"{np.mean(iterations):.1f}", max(iterations), sum(report.factorizations for report in first.reports),
           f"{max(first.energies):.2g}", f"{gain:.1g}", f"{first.min_det_F:.2g}", resumed or ended]
    return row, resumed == "same bytes" and gain <= MOST_ENERGY_GAINED


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--body", choices=BODIES, default="bar")
    parser.add_argument("--reach", type=float, default=0.5)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("materials", nargs="*", metavar="MATERIAL")
    arguments = parser.parse_args()
    exemplar.use_one_blas_thread()
    print("| material | steps | iterations a step | most | factorisations | greatest energy [J] | gained, over that | least det F | resumed |")
    print("|" + "---|" * 9, flush=True)
    is_well = True
    for name in arguments.materials or MATERIALS:
        row, is_row_well = measure(MATERIALS[name], arguments.steps, arguments.body, arguments.reach, arguments.seed)
        is_well &= is_row_well
        print("| " + " | ".join(map(str, [name, *row])) + " |", flush=True)
    sys.exit(not is_well)


if __name__ == "__main__":
    main()
