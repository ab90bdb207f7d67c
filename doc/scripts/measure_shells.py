# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the tables of doc/shells.md: plates on four kinds of meshes, hinges, a roof and a pinched cylinder; and the methods of doc/contact.md for a falling cloth.
With `steps` it prints how long a step of a sheet of 5,000 triangles takes over one of the cat, both with three examples.

    EXEMPLAR=build/release/exemplar python3 doc/scripts/measure_shells.py [cloth | steps]
"""

import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/scenes"))
from exemplar_runner import nodes_of, read_csv  # noqa: E402
from shell_meshes import grid  # noqa: E402
from test_shells import Shells  # noqa: E402

KINDS = ("right", "alternating", "equilateral", "random")
EDGE = 1e-6


class Measure(Shells):
    def runTest(self):  # noqa: N802
        """Nothing: a test case of which the means alone are wanted."""

    def lowering(self, place, handles, keys):
        """Runs a quarter or an eighth of a shell of 16 to 64 strips a side, its vertices at place(u, v); how far vertex (u, v) of
        `keys` has gone down."""
        n, kind, (u, v), scene = keys
        points, triangles = grid(n, n, kind)
        rest = [place(x, y) for x, y in points]
        self.write_shell("rest.obj", rest, triangles)
        held = {"Handles/Names": ", ".join(handles)}
        for name, (box, components, slopes) in handles.items():
            held[f"Handles/{name}/Select"] = "box " + " ".join(map(str, box))
            held[f"Handles/{name}/Components"] = components
            held[f"Handles/{name}/Slopes"] = slopes
        output = self.solve_shell({"Scene": "static", "Time/Increments": "1", **scene, **held})
        number = points.index((u, v))
        return rest[number][2] - nodes_of(output / "final.msh")[number + 1][2]

    def roof(self, n, kind):
        """Scordelis and Lo 1964: the middle of the free edge over .3024."""
        radius, length, load = 25., 25., 1e-3
        found = self.lowering(
            lambda u, v: (radius * math.sin(math.radians(40.) * u), length * v, radius * math.cos(math.radians(40.) * u)),
            {"mid": ((-99, -EDGE, -99, 99, EDGE, 99), "y", "held"), "end": ((-99, length - EDGE, -99, 99, length + EDGE, 99), "x, z", "free"),
             "top": ((-EDGE, -99, -99, EDGE, 99, 99), "x", "held")},
            (n, kind, (1., 0.), {"Material/Thickness": "0.25", "Material/Young's modulus": "4.32e8", "Material/Poisson's ratio": "0",
                                 "Material/Density": "360", "Loads/Gravity": f"0, 0, {-load}"}))
        return found / load / .3024

    def pinched(self, n, kind):
        """A cylinder with diaphragms, pinched by two forces: 1.8248e-5 for radius 300, thickness 3, E 3e6, force 1."""
        radius, scale, force = 3., .01, 50.
        found = self.lowering(
            lambda u, v: (radius * math.sin(math.pi / 2. * u), radius * v, radius * math.cos(math.pi / 2. * u)),
            {"mid": ((-9, -EDGE, -9, 9, EDGE, 9), "y", "held"), "end": ((-9, radius - EDGE, -9, 9, radius + EDGE, 9), "x, z", "free"),
             "top": ((-EDGE, -9, -9, EDGE, 9, 9), "x", "held"), "side": ((-9, -9, -EDGE, 9, 9, EDGE), "z", "held")},
            (n, kind, (0., 0.), {"Material/Thickness": "0.03", "Material/Young's modulus": "3e6", "Loads/Names": "pinch",
                                 "Loads/pinch/Select": f"sphere 0 0 {radius} 1e-3", "Loads/pinch/Force": f"0; 0; {-.25 * force * scale}"}))
        return found / force / 1.8248e-5

    def fall(self, shape, method):
        """Iterations and seconds of 60 steps of a cloth of 1 m that falls on an obstacle."""
        points, triangles = grid(24, 24, "alternating")
        self.write_shell("rest.obj", [(x - .5, y - .5, 0.) for x, y in points], triangles)
        rows = read_csv(self.solve_shell({"Scene": "dynamic", "Material/Density": "500", "Loads/Gravity": "0, 0, -9.81", "Time/Step": "0.01",
                                          "Time/End": "0.6", "Obstacles/Names": "thing", "Obstacles/thing/Shape": shape,
                                          "Solver/Method": method}, "--threads", "1"))
        return [sum(row[column] or 0. for row in rows) for column in ("iterations", "seconds_step")]


def milliseconds_of_step(scene, *settings):
    """User time of a default step of a benchmark scene in one thread, without what a run takes before its first one."""
    def run(end):
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        with tempfile.TemporaryDirectory() as folder:
            words = [word for setting in (f"Time/End={end}", *settings) for word in ("--set", setting)]
            file = Path(__file__).resolve().parents[2] / f"tests/benchmark/scenes/{scene}.prm"
            subprocess.run([os.environ["EXEMPLAR"], str(file), "--output", f"{folder}/out", "--threads", "1", "--quiet", *words], check=True, stdout=subprocess.DEVNULL)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return 1e3 * (run(1) - run(1. / 60.)) / 59.


def print_steps():
    """In pairs, so that both see the same machine. The sheet sways, or is swung so that it buckles."""
    for name, *settings in (("sways",), ("is swung", "Handles/side/Motion=0; 0; 0.3*sin(2*pi*t)")):
        pairs = [(milliseconds_of_step("sheet_examples", *settings), milliseconds_of_step("cat_mid60_examples", "Model/Dilatation=patches")) for _ in range(3)]
        sheet, cat = (statistics.median(column) for column in zip(*pairs))
        ratio = statistics.median(a / b for a, b in pairs)
        print(f"a step of the sheet that {name} {sheet:.2f} ms, of the cat {cat:.2f} ms, their ratio {ratio:.2f}")


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for name, values in rows:
        print("| " + " | ".join([name, *(f"{value:.3f}" for value in values)]) + " |")
    print()


def main():
    if sys.argv[1:] == ["steps"]:
        return print_steps()
    measure = Measure()
    measure.setUp()
    table(["method, shape", "iterations", "seconds"], [(f"{method}, {shape}", measure.fall(shape, method)) for method in ("newton", "quasi newton")
                                                        for shape in ("sphere 0 0 -0.35 0.3", "box -0.15 -0.2 -0.5  0.15 0.2 -0.05")])
    if sys.argv[1:] == ["cloth"]:
        return measure.doCleanups()
    counts = (8, 16, 32, 64)
    for title, clamped in (("supported", False), ("clamped", True)):
        table([title, *(f"n = {n}" for n in counts)], [(kind, [measure.deflection(n, kind, clamped) for n in counts]) for kind in KINDS])
    table(["hinges, supported", *(f"n = {n}" for n in counts)],
          [(kind, [measure.deflection(n, kind, False, {"Model/Shell": "hinges"}) for n in counts]) for kind in KINDS])
    table(["roof", "n = 8", "n = 16", "n = 32"], [(kind, [measure.roof(n, kind) for n in (8, 16, 32)]) for kind in KINDS[:2]])
    table(["pinched cylinder", "n = 16", "n = 32", "n = 64"], [(kind, [measure.pinched(n, kind) for n in (16, 32, 64)]) for kind in KINDS[:2]])
    measure.doCleanups()


if __name__ == "__main__":
    main()
