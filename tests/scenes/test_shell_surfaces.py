# SPDX-License-Identifier: GPL-3.0-or-later
"""What is painted on a shell, chosen on it, and caches that its handles follow."""

import math
import struct
import unittest

from exemplar_runner import SceneTest, nodes_of, read_csv
from shell_meshes import obj_text, rolled_vertices, strip

LENGTH, WIDTH, COLUMNS, ROWS = 1., .25, 16, 4
SHELL = {"Mesh/Kind": "shell", "Mesh/File": "rest.obj", "Material/Thickness": "0.01", "Material/Young's modulus": "1e6",
         "Material/Poisson's ratio": "0.3", "Output/Every": "0", "Scene": "static", "Time/Increments": "2"}
HELD = {"Handles/Names": "left", "Handles/left/Select": "box -1 -1 -1 0.07 1 1"}
GRAVITY = {"Loads/Gravity": "0, 0, -0.5"}


class Painted(SceneTest):
    def setUp(self):
        super().setUp()
        self.vertices, self.triangles = strip(LENGTH, WIDTH, COLUMNS, ROWS)
        self.write("rest.obj", obj_text(self.vertices, self.triangles))

    def paint(self, name, value):
        """A table of a value for each vertex by its place."""
        self.write(name, "vertex,paint\n" + "".join(f"{k},{value(*place)!r}\n" for k, place in enumerate(self.vertices, 1)))

    def bytes_of(self, keys, output):
        return (self.solve({**SHELL, **HELD, **GRAVITY, **keys}, output=output) / "final.msh").read_bytes()

    def test_a_constant_map_is_the_constant(self):
        self.paint("twice.csv", lambda x, y, z: 2.)
        self.paint("all.csv", lambda x, y, z: .02)
        wanted = self.bytes_of({"Material/Thickness": "0.02"}, "wanted")
        self.assertEqual(self.bytes_of({"Material/Thickness map": "twice.csv"}, "factor"), wanted)
        self.assertEqual(self.bytes_of({"Material/Thickness map": "all.csv absolute"}, "absolute"), wanted)
        self.paint("half.csv", lambda x, y, z: .5)
        self.assertEqual(self.bytes_of({"Material/Thickness map": "half.csv from 1 to 3"}, "range"), wanted)
        self.assertEqual(self.bytes_of({"Material/Young's modulus map": "twice.csv"}, "E"), self.bytes_of({"Material/Young's modulus": "2e6"}, "2E"))

    def test_a_linear_map_gives_mass_as_its_integral(self):
        self.paint("wedge.csv", lambda x, y, z: 1. + x)
        output = self.solve({**SHELL, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.02",
                             "Initial/Velocity": "0; 0; 1", "Material/Thickness map": "wedge.csv", "Material/Density": "1000"})
        self.assertAlmostEqual(read_csv(output)[-1]["momentum_z"], 1000. * .01 * WIDTH * LENGTH * 1.5, places=9)

    def test_a_thick_end_bends_less(self):
        """A cantilever under its own weight: thickness t to the middle and 2 t beyond, over the beam's closed form (nu = 0)."""
        self.paint("step.csv", lambda x, y, z: 1. if x < .5 else 2.)
        keys = {"Material/Poisson's ratio": "0", "Time/Increments": "1", "Loads/Gravity": "0, 0, -1e-3", "Material/Density": "1000"}
        output = self.solve({**SHELL, **HELD, **keys, "Material/Thickness map": "step.csv"})
        tip = -min(place[2] for place in nodes_of(output / "final.msh").values())
        E, t, g, clamp, n = 1e6, .01, 1e-3, LENGTH / COLUMNS, 20000
        slope = deflection = 0.
        for k in range(n):  # moments of what is beyond, with the transition of one column
            x = clamp + (k + .5) * (LENGTH - clamp) / n

            def thickness(at):
                column = int(at * COLUMNS)
                return t * (1.5 if column == COLUMNS // 2 - 1 else 1. if at < .5 else 2.)
            middle = COLUMNS // 2 / COLUMNS
            moment = sum(1000. * g * thickness((a + b) / 2) * ((b - x)**2 - max(a - x, 0.)**2) / 2
                         for a, b in ((0., middle - clamp), (middle - clamp, middle), (middle, LENGTH)) if b > x)
            slope += moment / (E * thickness(x)**3 / 12) * (LENGTH - clamp) / n
            deflection += slope * (LENGTH - clamp) / n
        self.assertAlmostEqual(tip / deflection, 1., delta=.02)

    def test_nodes_are_chosen_on_the_shell(self):
        wanted = self.bytes_of({}, "wanted")
        self.paint("left.csv", lambda x, y, z: 1. if x < .07 else 0.)
        self.assertEqual(self.bytes_of({"Handles/left/Select": "map left.csv"}, "map"), wanted)
        groups = ["left" if max(self.vertices[v][0] for v in face) < .07 else "rest" for face in self.triangles]
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.vertices]
        for name in ("left", "rest"):
            lines += [f"g {name}"] + ["f " + " ".join(str(v + 1) for v in face) for face, of in zip(self.triangles, groups) if of == name]
        self.write("rest.obj", "\n".join(lines) + "\n")
        self.assertEqual(nodes_of(self.solve({**SHELL, **HELD, **GRAVITY, "Handles/left/Select": "group left"}, output="group") / "final.msh").keys(),
                         nodes_of(self.directory / "wanted/final.msh").keys())

    def test_a_handle_follows_a_cache(self):
        def lifted(t):
            return [(x, y, z + .2 * t if x > .9 else z) for x, y, z in self.vertices]
        samples = [0., .5, 1.]
        data = struct.pack(">2i", len(samples), len(self.vertices)) + struct.pack(f">{len(samples)}f", *samples)
        for t in samples:
            data += b"".join(struct.pack(">3f", *place) for place in lifted(t))
        (self.directory / "lift.mdd").write_bytes(data)
        keys = {**SHELL, "Handles/Names": "left, right", "Handles/left/Select": HELD["Handles/left/Select"],
                "Handles/right/Select": "box 0.99 -1 -1 2 1 1", "Handles/right/Follow cache": "lift.mdd"}
        found = nodes_of(self.solve(keys) / "final.msh")
        for number, (x, _, z) in enumerate(lifted(1.), 1):
            if x > .99:
                self.assertAlmostEqual(found[number][2], z, delta=1e-7)
        run = self.attempt({**keys, "Handles/right/Slopes": "held"})
        self.assertEqual(run.status, 1)
        self.assertIn("Slopes = free", run.stderr)

    def test_weights_are_painted(self):
        self.write("rolled.obj", obj_text(rolled_vertices(LENGTH, WIDTH, COLUMNS, ROWS, math.pi), self.triangles))
        self.paint("left.csv", lambda x, y, z: max(0., min(1., 4. * (.6 - x))))
        self.paint("right.csv", lambda x, y, z: max(0., min(1., 4. * (x - .4))))
        output = self.solve({**SHELL, **HELD, "Examples/Poses": "rolled.obj", "Examples/Weight maps": "left.csv, right.csv", "Examples/Importance": "1"})
        row = read_csv(output)[-1]
        for region in range(3):  # 0 has what is painted in neither
            self.assertAlmostEqual(row[f"weight_{region}_0"] + row[f"weight_{region}_1"], 1., places=9)

    def test_what_is_refused(self):
        def refuse(words, keys):
            run = self.attempt({**SHELL, **HELD, **keys})
            self.assertEqual(run.status, 1)
            self.assertIn(words, run.stderr)
        self.paint("none.csv", lambda x, y, z: 0. if x > .9 else 1.)
        refuse("Thickness map", {"Material/Thickness map": "none.csv"})
        self.paint("thick.csv", lambda x, y, z: 10.)
        refuse("half of the edges", {"Material/Thickness map": "thick.csv"})
        self.solve({**SHELL, **HELD, "Time/Increments": "1"}, output="flat")
        refuse("is read off a surface", {"Mesh/File": "flat/final.msh", "Material/Thickness map": "none.csv"})
        refuse("is of shells", {"Mesh/Kind": "solid", "Mesh/File": None, "Mesh/Generator": "box", "Material/Thickness": None,
                                "Material/Thickness map": "none.csv"})


if __name__ == "__main__":
    unittest.main()
