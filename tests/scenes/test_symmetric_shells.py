# SPDX-License-Identifier: GPL-3.0-or-later
"""Half and quarter models of shells, with slopes held in planes of symmetry, against whole ones on mirror-symmetric meshes."""

import math
import unittest

from exemplar_runner import SceneTest, nodes_of, read_csv
from shell_meshes import obj_text

SHELL = {"Mesh/Kind": "shell", "Output/Every": "0", "Solver/Tolerance": "1e-12"}
SHEET = {**SHELL, "Scene": "static", "Material/Young's modulus": "1.2e6", "Material/Poisson's ratio": "0.4", "Material/Thickness": "0.1",
         "Loads/Names": "end", "Loads/Ramp": "increments", "Time/Increments": "10"}
LENGTH, WIDTH, COLUMNS, ROWS = 8., 3., 16, 3


def sheet(rows, mirrored):
    """A sheet from y = 0 to WIDTH/2, with its mirror image below if it is `mirrored`."""
    below = rows if mirrored else 0
    points = [(LENGTH * i / COLUMNS, WIDTH / 2 * j / rows, 0.) for j in range(-below, rows + 1) for i in range(COLUMNS + 1)]
    triangles = []
    for j in range(-below, rows):
        for i in range(COLUMNS):
            a = (j + below) * (COLUMNS + 1) + i
            b, c, d = a + 1, a + COLUMNS + 2, a + COLUMNS + 1
            triangles += [(a, b, d), (b, c, d)] if j < 0 else [(a, b, c), (a, c, d)]
    return points, triangles


def tube(n, quarters, rows, below):
    """Part of a tube about y of radius 1, in quarters of n triangles' edges, with rows above y = 0 and as many below if told."""
    columns = n * quarters + (quarters < 4)
    points = [tuple(round(x, 12) + 0. for x in (math.sin(math.pi / 2 * i / n), .25 * j, math.cos(math.pi / 2 * i / n)))
              for j in range(-below, rows + 1) for i in range(columns)]
    triangles = []
    for j in range(rows + below):
        for i in range(n * quarters):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            c, d = b + columns, a + columns
            triangles += [(a, c, b), (a, d, c)] if (i // n) % 2 == (j < below) else [(a, d, b), (b, d, c)]
    return points, triangles


def open_hemisphere(n):
    """Quarter of a hemisphere of radius 10 with a hole of 18 degrees, of n times n squares, and the whole of four mirror images."""
    angles = [(math.radians(72 * j / n), math.radians(90 * i / n)) for j in range(n + 1) for i in range(n + 1)]
    quarter = [tuple(round(10. * x, 12) + 0. for x in (math.cos(a) * math.cos(b), math.cos(a) * math.sin(b), math.sin(a))) for a, b in angles]
    triangles = []
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            b, c, d = a + 1, a + n + 2, a + n + 1
            triangles += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
    numbers, whole = {}, []
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        of_image = [numbers.setdefault((x * p[0] + 0., y * p[1] + 0., p[2]), len(numbers)) for p in quarter]
        whole += [tuple(of_image[k] for k in (t if x * y > 0 else t[::-1])) for t in triangles]
    return (quarter, triangles), (list(numbers), whole)


def turned(points, axis):
    """With the axis y where `axis` is."""
    shift = {"y": 0, "z": 1, "x": 2}[axis]
    return [tuple(p[(c - shift) % 3] for c in range(3)) for p in points]


def words(numbers, separator, axis):
    return separator.join(turned([tuple(numbers)], axis)[0])


def box(low, high, axis):
    (a,), (b,) = turned([low], axis), turned([high], axis)
    return "box " + " ".join(map(str, a + b))


class Symmetric(SceneTest):
    def run_shell(self, name, shell, keys):
        """Positions of the vertices by their place at rest, and the last row of statistics."""
        points, triangles = shell
        self.write(name + ".obj", obj_text(points, triangles))
        output = self.solve({**keys, "Mesh/File": name + ".obj"}, output=name)
        places = [x for _, x in sorted(nodes_of(output / "final.msh").items())][:len(points)]
        return {tuple(round(c, 9) + 0. for c in p): x for p, x in zip(points, places)}, read_csv(output)[-1]

    def compare(self, part, whole, factor, tolerance=1e-8):
        """A part has the positions of the whole, and the energy but for a factor."""
        deviation = max(max(abs(a - b) for a, b in zip(x, whole[0][p])) for p, x in part[0].items())
        self.assertLess(deviation, tolerance)
        self.assertLess(abs(factor * part[1]["energy_elastic"] / whole[1]["energy_elastic"] - 1.), tolerance)
        return max(math.dist(x, p) for p, x in whole[0].items())

    def sheets(self, axis, force, more=None):
        """The half and the whole of a sheet that is clamped at one end and pulled up at the other."""
        component = "xyz"["xyz".index("y") if axis == "y" else {"z": 2, "x": 0}[axis]]
        keys = {**SHEET, "Handles/clamp/Select": box((-1, -9, -1), (1e-6, 9, 1), axis), "Loads/end/Select": box((7.999, -9, -1), (9, 9, 1), axis)}
        sym = {"Handles/Names": "clamp, sym", "Handles/sym/Select": box((-1, -1e-6, -1), (9, 1e-6, 1), axis), "Handles/sym/Slopes": "held",
               "Handles/sym/Components": component}
        whole, half = sheet(ROWS, True), sheet(ROWS, False)
        results = [self.run_shell(name, (turned(shell[0], axis), shell[1]),
                                  {**keys, **handles, "Loads/end/Force": words(("0", "0", f"{part * force}*t" if more else repr(part * force)), "; ", axis), **(more or {})})
                   for name, shell, handles, part in (("whole", whole, {"Handles/Names": "clamp"}, 1.), ("half", half, sym, .5))]
        return self.compare(results[1], results[0], 2.)

    def test_half_of_a_sheet_bends_as_the_whole(self):
        """At 1 and 8 times the load at which the end moves by an edge, in planes across each axis."""
        for axis, force in (("y", 60.), ("x", 480.), ("z", 480.)):
            with self.subTest(axis):
                self.assertGreater(self.sheets(axis, force), .5 if force < 100. else 3.)

    def test_half_of_a_sheet_moves_as_the_whole(self):
        moved = self.sheets("y", 480., {"Scene": "dynamic", "Time/Step": "0.02", "Time/End": "0.6", "Material/Density": "100", "Time/Increments": None,
                                        "Loads/Ramp": None, "Solver/Step tolerance": "1e-12"})
        self.assertGreater(moved, 1.)

    def test_an_eighth_of_a_tube_is_pulled_as_the_whole(self):
        """By two opposite forces. A line in the plane across y is held in one component, its ends in two."""
        n, rows, force = 5, 4, 4.
        keys = {**SHELL, "Scene": "static", "Material/Young's modulus": "1e5", "Material/Poisson's ratio": "0.3", "Material/Thickness": "0.02",
                "Loads/Ramp": "increments", "Time/Increments": "8"}
        at = {"top": "box -1e-6 -1e-6 0.9 1e-6 1e-6 1.1", "low": "box -1e-6 -1e-6 -1.1 1e-6 1e-6 -0.9", "side": "box 0.9 -1e-6 -1e-6 1.1 1e-6 1e-6"}
        whole = self.run_shell("whole", tube(n, 4, rows, rows), {
            **keys, "Handles/Names": "top, low, side", **{f"Handles/{name}/Select": select for name, select in at.items()},
            "Handles/top/Components": "x, y", "Handles/low/Components": "x, y", "Handles/side/Components": "y, z", "Loads/Names": "up, down",
            "Loads/up/Select": at["top"], "Loads/up/Force": f"0; 0; {force}", "Loads/down/Select": at["low"], "Loads/down/Force": f"0; 0; -{force}"})
        planes = {}
        for axis, select in (("x", "box -1e-6 -9 -9 1e-6 9 9"), ("y", "box -9 -1e-6 -9 9 1e-6 9"), ("z", "box -9 -9 -1e-6 9 9 1e-6")):
            planes.update({f"Handles/{axis}/Select": select, f"Handles/{axis}/Components": axis, f"Handles/{axis}/Slopes": "held"})
        eighth = self.run_shell("eighth", tube(n, 1, rows, 0), {
            **keys, **planes, "Handles/Names": "x, y, z", "Loads/Names": "up", "Loads/up/Select": at["top"], "Loads/up/Force": f"0; 0; {force / 4}"})
        self.assertGreater(self.compare(eighth, whole, 8.), .3)

    def test_a_quarter_of_an_open_hemisphere_is_pulled_as_the_whole(self):
        """By two pairs of opposite forces of 400, which move the edge by 0.8 radii (Simo, Fox and Rifai 1990)."""
        quarter, whole = open_hemisphere(8)
        keys = {**SHELL, "Scene": "static", "Material/Young's modulus": "6.825e7", "Material/Poisson's ratio": "0.3", "Material/Thickness": "0.04",
                "Loads/Ramp": "increments", "Time/Increments": "10", "Handles/Names": "x, y, foot", "Handles/x/Select": "box -1e-6 -11 -1 1e-6 11 11",
                "Handles/x/Components": "x", "Handles/y/Select": "box -11 -1e-6 -1 11 1e-6 11", "Handles/y/Components": "y",
                "Handles/foot/Select": "box 9.999 -1e-6 -1e-6 11 1e-6 1e-6", "Handles/foot/Components": "z"}
        places = {"east": (1, 0), "south": (0, 1), "west": (-1, 0), "north": (0, -1)}
        for name, (x, y) in places.items():
            keys[f"Loads/{name}/Select"] = " ".join(map(str, ("box", *(10. * c - .001 for c in (x, y, 0)), *(10. * c + .001 for c in (x, y, 0)))))
        force = {name: f"{{0}}*{x}; {{0}}*{-y}; 0" for name, (x, y) in places.items()}
        part = self.run_shell("quarter", quarter, {
            **keys, "Loads/Names": "east, south", "Handles/x/Slopes": "held", "Handles/y/Slopes": "held",
            **{f"Loads/{name}/Force": force[name].format(200) for name in ("east", "south")},
            **{f"Loads/{name}/Select": keys[f"Loads/{name}/Select"] if name in ("east", "south") else None for name in places}})
        result = self.run_shell("whole", whole, {**keys, "Loads/Names": ", ".join(places),
                                                 **{f"Loads/{name}/Force": force[name].format(400) for name in places}})
        self.assertGreater(self.compare(part, result, 4.), 8.)

    def test_a_plane_of_symmetry_moves_along_its_axis(self):
        """A sheet between two planes, one of which moves outwards, is stretched by a tenth: as one that is pulled at both sides."""
        keys = {**SHEET, "Loads/Names": None, "Loads/Ramp": None}
        points, triangles = sheet(ROWS, False)
        stretched, row = self.run_shell("half", (points, triangles), {
            **keys, "Handles/Names": "low, high, end, tip", "Handles/low/Select": "box -1 -1e-6 -1 9 1e-6 1", "Handles/low/Components": "y", "Handles/low/Slopes": "held",
            "Handles/high/Select": "box -1 1.499999 -1 9 2 1", "Handles/high/Components": "y", "Handles/high/Slopes": "held", "Handles/high/Motion": "0; 0.15*t; 0",
            "Handles/end/Select": "box -1 -1 -1 1e-6 1e-6 1", "Handles/tip/Select": "box 7.999 -1 -1 9 1e-6 1", "Handles/tip/Components": "z"})
        thinner = 1. - .1 * .4
        for p, x in stretched.items():
            for found, wanted in zip(x, (thinner * p[0], 1.1 * p[1], 0.)):
                self.assertAlmostEqual(found, wanted, delta=1e-9)
        self.assertAlmostEqual(row["reaction_high_y"], 1.2e6 * .1 * .1 * LENGTH, delta=1e-6 * 1e5)
        self.assertEqual(row["reaction_high_x"], 0.)

    def test_what_planes_leave_free_is_said(self):
        self.write("half.obj", obj_text(*sheet(ROWS, False)))
        run = self.attempt({**SHEET, "Loads/Names": None, "Mesh/File": "half.obj", "Handles/Names": "sym", "Handles/sym/Select": "box -1 -1e-6 -1 9 1e-6 1",
                            "Handles/sym/Slopes": "held", "Handles/sym/Components": "y"})
        self.assertEqual(run.status, 1)
        self.assertIn("leave 3 of 6 rigid motions free", run.stderr)

    def test_hinges_have_no_slopes_to_hold(self):
        self.write("half.obj", obj_text(*sheet(ROWS, False)))
        run = self.attempt({**SHEET, "Loads/Names": None, "Mesh/File": "half.obj", "Model/Shell": "hinges", "Handles/Names": "sym",
                            "Handles/sym/Select": "box -1 -1e-6 -1 9 1e-6 1", "Handles/sym/Slopes": "held", "Handles/sym/Components": "y"})
        self.assertEqual(run.status, 1)
        self.assertIn("Set Model/Shell = plate", run.stderr)


if __name__ == "__main__":
    unittest.main()
