# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells against closed forms: plates, strips that roll up by examples, elastica; and what is refused of them."""

import math
import unittest

from exemplar_runner import SceneTest, greatest_distance, nodes_of, read_csv, results
from shell_meshes import grid, obj_text, rolled_vertices, strip

SHELL = {"Mesh/Kind": "shell", "Mesh/File": "rest.obj", "Material/Thickness": "0.001", "Material/Young's modulus": "1e6",
         "Material/Poisson's ratio": "0.3", "Output/Every": "0"}
LENGTH, WIDTH, COLUMNS, ROWS = 1., .25, 16, 4


def best_distance(found, wanted):
    """Greatest distance of points after the best rigid motion, by numpy."""
    import numpy
    a, b = numpy.array(found), numpy.array(wanted)
    a0, b0 = a - a.mean(0), b - b.mean(0)
    u, _, v = numpy.linalg.svd(a0.T @ b0)
    turn = u @ numpy.diag([1., 1., numpy.sign(numpy.linalg.det(u @ v))]) @ v
    return float(numpy.abs(a0 @ turn - b0).max())


class Shells(SceneTest):
    def write_shell(self, name, vertices, triangles):
        self.write(name, obj_text(vertices, triangles))

    def solve_shell(self, keys, *arguments, output="out"):
        return self.solve({**SHELL, **keys}, *arguments, output=output)

    def write_strip(self, angle=math.pi):
        flat, triangles = strip(LENGTH, WIDTH, COLUMNS, ROWS)
        self.write_shell("rest.obj", flat, triangles)
        self.write_shell("rolled.obj", rolled_vertices(LENGTH, WIDTH, COLUMNS, ROWS, angle), triangles)

    def test_a_strip_rolls_up_by_its_weights(self):
        self.write_strip()
        for weight in (.25, .5, .75):
            output = self.solve_shell({"Scene": "interpolation", "Examples/Poses": "rolled.obj",
                                  "Examples/Prescribed weights": f"1-{weight}*t; {weight}*t", "Time/Increments": "4",
                                  "Solver/Tolerance": "1e-11"})
            found = [place for _, place in sorted(nodes_of(output / "final.msh").items())]
            wanted = rolled_vertices(LENGTH, WIDTH, COLUMNS, ROWS, weight * math.pi)
            self.assertLess(best_distance(found, wanted), 1e-9 * LENGTH)

    def test_weights_are_found_where_ends_are_held(self):
        self.write_strip()
        flat, triangles = strip(LENGTH, WIDTH, COLUMNS, ROWS)
        self.write_shell("held.obj", rolled_vertices(LENGTH, WIDTH, COLUMNS, ROWS, .35 * math.pi), triangles)
        column = LENGTH / COLUMNS
        output = self.solve_shell({"Scene": "static", "Examples/Poses": "rolled.obj", "Examples/Importance": "1", "Time/Increments": "4",
                              "Solver/Tolerance": "1e-10", "Examples/Weight penalty": "0",
                              "Handles/Names": "left, right", "Handles/left/Select": f"box -1 -1 -1 {1.01 * column} 1 1",
                              "Handles/right/Select": f"box {LENGTH - 1.01 * column} -1 -1 2 1 1",
                              "Handles/left/Follow pose": "held.obj", "Handles/right/Follow pose": "held.obj"})
        self.assertLess(abs(read_csv(output)[-1]["weight_1"] - .35), 1e-6)

    def deflection(self, n, kind, clamped, more=None):
        """Deflection of the middle of a square plate over the closed form (Timoshenko and Woinowsky-Krieger 1959)."""
        points, triangles = grid(n, n, kind)
        self.write_shell("rest.obj", [(x, y, 0.) for x, y in points], triangles)
        thickness, young, nu, density = 1e-3, 1e6, .3, 1000.
        stiffness = young * thickness ** 3 / (12. * (1. - nu ** 2))
        coefficient = .00126532 if clamped else .00406235
        wanted = thickness / 1000.
        gravity = wanted * stiffness / (coefficient * density * thickness)
        handles = {"Handles/Names": "a, b, c, d"}
        for name, box in zip("abcd", ("-1 -1 -1 1e-9 2 1", "0.999999999 -1 -1 2 2 1", "-1 -1 -1 2 1e-9 1", "-1 0.999999999 -1 2 2 1")):
            handles[f"Handles/{name}/Select"] = "box " + box
            handles[f"Handles/{name}/Slopes"] = "held" if clamped else "free"
        output = self.solve_shell({"Scene": "static", "Time/Increments": "1", "Loads/Gravity": f"0, 0, -{gravity!r}",
                              "Solver/Tolerance": "1e-9", **handles, **(more or {})})
        return -min(z for _, _, z in nodes_of(output / "final.msh").values()) / wanted

    def test_plates_bend_as_they_should(self):
        for kind in ("right", "alternating", "equilateral", "random"):
            with self.subTest(kind):
                coarse, fine = self.deflection(16, kind, False), self.deflection(32, kind, False)
                self.assertLess(abs(coarse - 1.), .02)
                self.assertLess(abs(fine - 1.), .005)
        self.assertLess(abs(self.deflection(32, "right", True) - 1.), .03)

    def test_an_elastica(self):
        """A cantilever under an end load P L^2/EI = 1, 5, 10 (Bisshopp and Drucker 1945, by shooting)."""
        nx, ny, thickness, young, width = 32, 8, .01, 1e6, .5
        flat, triangles = strip(1., width, nx, ny)
        self.write_shell("rest.obj", flat, triangles)
        bending = young * width * thickness ** 3 / 12.
        for load, wanted in ((1., .30172), (5., .71379), (10., .81061)):
            output = self.solve_shell({"Scene": "static", "Time/Increments": "4", "Material/Thickness": "0.01", "Material/Poisson's ratio": "0",
                                  "Handles/Names": "left", "Handles/left/Select": "box -1 -1 -1 1e-9 1 1", "Loads/Names": "end",
                                  "Loads/end/Select": "box 0.999999999 -1 -1 2 1 1", "Loads/end/Force": f"0; 0; -{load * bending!r}*t"})
            end = [z for x, y, z in nodes_of(output / "final.msh").values()]
            self.assertLess(abs(-min(end) / wanted - 1.), .01)

    def test_a_free_shell_keeps_its_momentum(self):
        self.write_strip()
        output = self.solve_shell({"Scene": "dynamic", "Time/Step": "0.01", "Time/End": "0.2", "Initial/Velocity": "0; 0; x",
                              "Solver/Tolerance": "1e-10", "Solver/Step tolerance": "1e-10"})
        first, last = read_csv(output)[1], read_csv(output)[-1]
        for c in "xyz":
            self.assertAlmostEqual(first[f"momentum_{c}"], last[f"momentum_{c}"], delta=1e-12)
        self.assertIn("min_area", first)
        self.assertNotIn("min_det_F", first)

    def test_a_result_is_a_pose_without_loss(self):
        self.write_strip()
        column = LENGTH / COLUMNS
        keys = {"Scene": "static", "Time/Increments": "2", "Loads/Gravity": "0, 0, -1", "Handles/Names": "left",
                "Handles/left/Select": f"box -1 -1 -1 {1.01 * column} 1 1", "Solver/Tolerance": "1e-10"}
        first = self.solve_shell(keys, output="first")
        again = self.solve_shell({**keys, "Time/Increments": "1", "Initial/Pose": "first/final.msh"}, output="again")
        self.assertLess(greatest_distance(nodes_of(first / "final.msh"), nodes_of(again / "final.msh")), 1e-9)
        self.assertEqual(read_csv(again)[1]["iterations"], 0)

    def test_threads_and_resume_keep_bytes(self):
        self.write_strip()
        keys = {"Scene": "dynamic", "Time/Step": "0.01", "Time/End": "0.1", "Loads/Gravity": "0, 0, -1", "Examples/Poses": "rolled.obj",
                "Handles/Names": "left", "Handles/left/Select": "box -1 -1 -1 0.1 1 1", "Handles/left/Until": "0.05"}
        one = self.solve_shell(keys, output="one")
        two = self.solve_shell(keys, "--threads", "2", output="two")
        self.assertEqual((one / "final.msh").read_bytes(), (two / "final.msh").read_bytes())
        half = self.solve_shell({**keys, "Time/End": "0.06"}, output="half")
        self.assertEqual(self.attempt({**SHELL, **keys}, "--resume", output="half").status, 0)
        self.assertEqual((one / "final.msh").read_bytes(), (half / "final.msh").read_bytes())

    def test_a_sheet_that_is_swung_takes_few_iterations(self):
        """Its metric is renewed as soon as that pays, one made in the step too: without that steps take twice as many."""
        points, triangles = grid(20, 20, "alternating")
        self.write_shell("rest.obj", [(x - .5, y - .5, 0.) for x, y in points], triangles)
        rows = read_csv(self.solve_shell({"Scene": "dynamic", "Time/Step": "0.016", "Time/End": "0.48", "Material/Density": "300", "Material/Young's modulus": "5e6",
                                          "Loads/Gravity": "0, -9.81, 0", "Handles/Names": "side", "Handles/side/Select": "box -1 0.499 -1 1 1 1",
                                          "Handles/side/Motion": "0; 0; 0.3*sin(2*pi*t)"}))[1:]
        self.assertLess(sum(row["iterations"] for row in rows) / len(rows), 6.6)
        self.assertLess(sum(row["factorizations"] for row in rows) / len(rows), 2.7)

    def test_a_fold_beyond_half_a_turn_is_remembered(self):
        """A strip of three columns, folded at the first line between them by 234 degrees, through itself; the last column is free."""
        flat, triangles = strip(.3, .1, 3, 1)
        self.write_shell("rest.obj", flat, triangles)
        turn = 1.3 * math.pi
        keys = {"Scene": "static", "Time/Increments": "13", "Material/Density": "100", "Loads/Gravity": "0, 0, -0.1", "Output/Keep states": "true",
                "Output/Every": "1", "Handles/Names": "left, right", "Handles/left/Select": "box -1 -1 -1 0.101 1 1", "Handles/left/Slopes": "free",
                "Handles/right/Select": "box 0.199 -1 -1 0.201 1 1", "Handles/right/Slopes": "free",
                "Handles/right/Motion": f"0.1*(cos({turn!r}*t) - 1); 0; 0.1*sin({turn!r}*t)"}
        whole = results(self.solve_shell(keys, output="whole"))
        self.solve_shell(keys)
        resumed = results(self.solve_shell(keys, "--resume-from", "11"))
        self.assertEqual([name for name in whole if resumed[name] != whole[name]], [])
        rows = read_csv(self.directory / "whole")
        self.assertAlmostEqual(rows[12]["energy_elastic"] / rows[6]["energy_elastic"], 4., delta=.1)
        # the normal at the fold is in the middle between those of the columns: at 117 degrees of the first
        text = (self.directory / "whole" / "final.msh").read_text()
        tips = [tuple(map(float, line.split())) for line in text.split("$NormalTips")[1].splitlines()[2:-1]]
        x, y, z = min(tips, key=lambda tip: math.dist(tip, (.1 - .1 * math.sin(turn / 2.), 0., .1 * math.cos(turn / 2.))))
        self.assertLess(math.dist((x, y, z), (.1 - .1 * math.sin(turn / 2.), 0., .1 * math.cos(turn / 2.))), .03)

    def test_frames_have_triangles(self):
        self.write_strip()
        output = self.solve_shell({"Scene": "static", "Time/Increments": "1", "Loads/Gravity": "0, 0, -1e-3", "Handles/Names": "left",
                              "Handles/left/Select": "box -1 -1 -1 0.1 1 1", "Output/Every": "1", "Output/Formats": "vtu, obj, usda"})
        self.assertIn("area_ratio", sorted(output.glob("*.vtu"))[-1].read_text(errors="replace"))
        self.assertTrue(list(output.glob("*.obj")))


    def test_pages_and_game_engines_get_triangles(self):
        self.write_strip()
        for formats, words in (("vtu", ("--html", "page.html")), ("vtu, pc2", ("--gltf", "run.glb")), ("vtu, pc2", ("--html", "page.html"))):
            output = self.solve_shell({"Scene": "interpolation", "Examples/Poses": "rolled.obj", "Time/Increments": "4", "Output/Every": "1",
                                       "Output/Formats": formats}, output=f"out_{words[0]}_{len(formats)}")
            run = self.call("export", output, *words)
            self.assertEqual(run.status, 0, run.stderr)
            self.assertGreater((self.directory / words[1]).stat().st_size, 1000)
            (self.directory / words[1]).unlink()


class Refused(SceneTest):
    def refuse(self, words, keys, vertices=None, triangles=None):
        flat, faces = strip(1., .25, 4, 1)
        self.write("rest.obj", obj_text(vertices or flat, triangles or faces))
        run = self.attempt({**SHELL, "Scene": "dynamic", **keys})
        self.assertEqual(run.status, 1)
        self.assertIn(words, run.stderr)

    def test_bad_surfaces(self):
        flat, faces = strip(1., .25, 4, 1)
        self.refuse("belongs to 3 triangles", {}, flat + [(.5, 0., 1.)], faces + [(a, c, len(flat)) for a, b, c in faces[:1]])
        self.refuse("turned differently", {}, flat, [(a, c, b) if k == 0 else (a, b, c) for k, (a, b, c) in enumerate(faces)])
        self.refuse("no area", {}, [flat[0] if k == 1 else v for k, v in enumerate(flat)], faces)

    def test_keys_of_solids(self):
        for key, value in (("Material/Fibre stiffness", "1e5"), ("Material/Yield stress", "1e3"), ("Model/Dilatation", "patches"),
                           ("Model/Element", "P2")):
            self.refuse(key, {key: value, "Material/Fibre direction": "1; 0; 0"})
        self.refuse("Mesh/Generator", {"Mesh/Generator": "box"})

    def test_poses_without_area_or_strain(self):
        for key in ("Examples/Pose functions", "Initial/Pose function"):
            self.refuse("8 of 8 triangles have no area", {key: "0*x; y; z"})
            self.refuse("triangles have no area", {key: "x < .3 ? 0 : x; y; z"})
        flat, faces = strip(1., .25, 4, 1)
        self.write("rest.obj", obj_text(flat, faces))
        for pose, words in (("z; y; -x", "moved rigidly"), ("1e3*x; 1e3*y; z", "times as large"), ("x; y; 0.1*x^2", "")):
            run = self.attempt({**SHELL, "Scene": "dynamic", "Time/End": "0.01", "Time/Step": "0.01", "Examples/Pose functions": pose}, output="posed")
            self.assertIn(words, run.stderr)
            self.assertEqual(bool(words), bool(run.stderr), run.stderr)

    def test_thickness(self):
        self.refuse("Thickness", {"Material/Thickness": "0"})
        self.refuse("half of the edges", {"Material/Thickness": "0.2"})

    def test_thickness_of_regions_alone(self):
        """A strip of two groups, of which each says how thick it is: the same as if all were."""
        flat, triangles = strip(LENGTH, WIDTH, COLUMNS, ROWS)
        lines = obj_text(flat, triangles).splitlines()
        first = next(i for i, line in enumerate(lines) if line.startswith("f "))
        middle = (first + len(lines)) // 2
        self.write("rest.obj", "\n".join([*lines[:first], "g one", *lines[first:middle], "g two", *lines[middle:]]) + "\n")
        keys = {"Mesh/File": "rest.obj", "Handles/Names": "left", "Handles/left/Select": "box -1 -9 -9 1e-6 9 9", "Loads/Gravity": "0, 0, -0.1",
                "Material/Thickness": "0", "Material/region one/Thickness": "0.01"}
        keys = {**SHELL, "Scene": "static", **keys}
        run = self.attempt(keys)
        self.assertIn("Material/Thickness = 0: a shell", run.stderr)
        apart = self.solve({**keys, "Material/region two/Thickness": "0.01"}, output="apart")
        whole = self.solve({**keys, "Material/region one/Thickness": None, "Material/Thickness": "0.01"}, output="whole")
        self.assertEqual((apart / "final.msh").read_bytes(), (whole / "final.msh").read_bytes())


if __name__ == "__main__":
    unittest.main()
