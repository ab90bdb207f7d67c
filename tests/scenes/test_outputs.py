# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run writes, and what the command line prints."""

import contextlib
import os
import pty
import re
import subprocess
import unittest

from exemplar_runner import (BAR, EXEMPLAR, REPOSITORY, SceneTest, distance, greatest_distance, prm, read_csv, read_msh,
                             read_pvd, read_summary, read_vtu, results)

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Mesh/Scale": "0.5", "Material/Density": "10",
           "Examples/Pose functions": "1.2*x; y; z", "Time/Step": "0.1", "Time/End": "0.35",
           "Handles/left/Motion": "0; 0; 0.1*t", "Output/Every": "2",
           "Material/region 1/Poisson's ratio": "0.3"}
FILES = {"frame_0000.vtu", "frame_0002.vtu", "frame_0004.vtu", "animation.pvd", "final.msh",
         "statistics.csv", "summary.json", "original.prm", "parameters.prm", "checkpoint.bin",
         "log.txt"}

# 2 regions, unordered gaps in the numbers of nodes and elements, tags that differ from the
# entities, a point and a line element, a face without a physical surface
HAND_WRITTEN = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 40 "skin"
3 7 "soft"
3 9 "hard core"
$EndPhysicalNames
$Nodes
5
17 0 0 0
3 1 0 0
101 0 1 0
8 0 0 1
44 1 1 1
$EndNodes
$Elements
6
12 15 2 0 1 17
5 1 2 0 2 17 3
99 2 2 40 21 17 101 3
7 2 2 0 22 17 3 8
1000 4 2 9 31 17 3 101 8
31 4 2 7 32 44 101 3 8
$EndElements
"""

# A box of 0.1 m that stands on a floor: rho g L / E is 1000 * 16 * 0.1 / 1e4.
STANDING = {**{key: value for key, value in BAR.items() if not key.startswith(("Handles", "Time"))}, "Scene": "dynamic", "Mesh/Box size": "0.1, 0.1, 0.1",
            "Mesh/Box cells": "1, 1, 1", "Material/Young's modulus": "1e4", "Loads/Gravity": "0, 0, -16", "Time/Step": "1e-3", "Time/End": "1e-3",
            "Obstacles/Names": "floor", "Obstacles/floor/Shape": "plane 0 0 -0.06  0 0 1"}


class Outputs(SceneTest):
    def test_files(self):
        self.write("scene.prm", "\ufeff# a remark\r\n\r\n" + prm(DYNAMIC) + "# no newline at the end")
        original = (self.directory / "scene.prm").read_bytes()
        run = self.call("scene.prm", "--output", "out")
        self.assertEqual((run.status, run.stderr), (0, ""))
        output = self.directory / "out"
        self.assertEqual({file.name for file in output.iterdir()}, FILES)
        self.assertEqual((output / "original.prm").read_bytes(), original)
        for words in ("scene.prm", "12 cells, 12 nodes, 24 of 36 dofs free", "4 steps", "out",
                      "Where the time went"):
            self.assertIn(words, run.stdout)
        for letter in ("\r", "\x1b"):  # stdout is no terminal here
            self.assertNotIn(letter, run.stdout)

        self.check_pvd(output)
        self.check_vtu(output)
        self.check_statistics(output)
        self.check_summary(output)
        self.check_rerun(output)

    def check_pvd(self, output):
        # step 4, the last one, is shorter
        self.assertEqual(read_pvd(output), [(0., "frame_0000.vtu"), (0.2, "frame_0002.vtu"),
                                            (0.35, "frame_0004.vtu")])

    def check_vtu(self, output):
        arrays, n_points, n_cells = read_vtu(output / "frame_0004.vtu")
        self.assertEqual((n_points, n_cells), (12, 12))
        self.assertEqual({key: len(numbers) for key, numbers in arrays.items()},
                         {("Points", "Points"): 36, ("Cells", "connectivity"): 48,
                          ("Cells", "offsets"): 12, ("Cells", "types"): 12,
                          ("PointData", "displacement"): 36, ("PointData", "velocity"): 36,
                          ("CellData", "strain_energy_density"): 12, ("CellData", "det_F"): 12,
                          ("CellData", "von_mises_stress"): 12, ("CellData", "region"): 12})
        self.assertEqual(arrays["Cells", "types"], [10] * 12)
        self.assertEqual(arrays["Cells", "offsets"], list(range(4, 52, 4)))
        self.assertEqual(arrays["CellData", "region"], [1] * 12)

        final = read_msh(output / "final.msh")
        self.assertEqual([tuple(node - 1 for node in element[-4:]) for element in final.elements
                          if element[1] == 4],
                         list(zip(*[iter(arrays["Cells", "connectivity"])] * 4)))
        points = list(zip(*[iter(arrays["Points", "Points"])] * 3))
        rest, _, _ = read_vtu(output / "frame_0000.vtu")
        for i, x in enumerate(final.nodes.values()):  # in the mesh's unit; frames are in metres
            self.assertLess(distance(points[i], [0.5 * c for c in x]), 1e-15)
        for x, u, x_0 in zip(arrays["Points", "Points"], arrays["PointData", "displacement"],
                             rest["Points", "Points"]):
            self.assertAlmostEqual(x, x_0 + u, delta=1e-15)
        self.assertEqual(rest["PointData", "displacement"], [0.] * 36)
        self.assertAlmostEqual(min(arrays["CellData", "det_F"]), read_csv(output)[-1]["min_det_F"], delta=1e-14)
        self.assertAlmostEqual(max(rest["Points", "Points"]), 1., delta=1e-15)

    def check_statistics(self, output):
        rows = read_csv(output)
        self.assertEqual([row["step"] for row in rows], [0, 1, 2, 3, 4])
        self.assertEqual([row["status"] for row in rows], ["initial"] + 4 * ["converged"])
        for row, time in zip(rows, (0., 0.1, 0.2, 0.3, 0.35)):
            self.assertAlmostEqual(row["time"], time, delta=1e-15)
        self.assertEqual(rows[-1]["time"], 0.35)
        seconds = [name for name in rows[0] if name.startswith("seconds_")]
        self.assertEqual([rows[0][name] for name in seconds], [None] * 6)
        self.assertEqual(seconds[0], "seconds_step")
        for row in rows[1:]:
            parts = [row[name] for name in seconds[1:]]
            self.assertGreaterEqual(min(parts), 0.)
            self.assertAlmostEqual(sum(parts), row["seconds_step"],
                                   delta=0.02 * row["seconds_step"])
            self.assertLessEqual(row["residual"], 1e-3)  # quasi newton stops by Step tolerance
            self.assertAlmostEqual(row["weight_0"] + row["weight_1"], 1., delta=1e-12)

    def check_summary(self, output):
        summary = read_summary(output)
        names = ("program version git deal_ii blas blas_core blas_threads threads scene mesh "
                 "mesh_sha256 cells nodes dofs constrained_dofs linear_solver examples steps "
                 "iterations factorizations status worst_residual seconds peak_memory_mib "
                 "bytes_per_cell used "
                 "left_out").split()
        self.assertEqual([name for name in names if name not in summary], [])
        self.assertEqual({name: summary[name] for name in ("program", "cells", "nodes", "dofs",
                                                           "constrained_dofs", "examples", "steps",
                                                           "status", "scene")},
                         {"program": "exemplar", "cells": 12, "nodes": 12, "dofs": 36,
                          "constrained_dofs": 12, "examples": 2, "steps": 4,
                          "status": "converged", "scene": "scene.prm"})
        rows = read_csv(output)
        self.assertEqual(summary["iterations"], sum(row["iterations"] for row in rows))
        self.assertEqual(summary["factorizations"], sum(row["factorizations"] for row in rows))
        for row in rows:  # small beside the energy, as the step ends near the minimum
            self.assertGreaterEqual(row["newton_decrement"], 0.)
            self.assertLess(row["newton_decrement"], 1e-2 * max(row["energy_elastic"] + row["energy_kinetic"], 1e-3))
        self.assertEqual(summary["worst_residual"], max(row["residual"] for row in rows))
        seconds = summary["seconds"]
        self.assertEqual(summary["blas_threads"], 1)
        self.assertEqual(list(seconds), ["total", "read", "evaluate", "assemble", "factorize",
                                         "solve", "output"])
        self.assertAlmostEqual(2. * seconds["total"], sum(seconds.values()), delta=1e-9)

    def check_rerun(self, output):
        text = (output / "parameters.prm").read_text()
        again = self.solve(text, output="again", file="again.prm")
        self.assertEqual(results(again), results(output))
        self.assertEqual((again / "parameters.prm").read_text().replace("= again", "= out"), text)
        # what the run wrote is refused as its own input only where it would be cleared away
        run = self.call("out/parameters.prm", "--output", "out")
        self.assertEqual(run.status, 1)
        self.assertIn("out/parameters.prm, which this run would clear away", run.stderr)
        self.assertEqual({file.name for file in output.iterdir()}, FILES)

    def test_regions_inherit_every_digit(self):
        exact = {**BAR, "Material/Young's modulus": "1234567.891", "Material/Density": "1001.2345"}
        self.assertEqual(results(self.solve({**exact, "Material/region 1/Poisson's ratio": "0.45"},
                                            output="a")),
                         results(self.solve(exact, output="b")))

    def test_every_column_and_key_is_in_the_manual(self):
        manual = set(re.findall(r"`([\w.]+)`", (REPOSITORY / "doc/output.md").read_text()))
        dynamic = {**DYNAMIC, "Loads/Names": "tip", "Loads/tip/Select": "boundary 2", "Loads/tip/Force": "0; 0; t"}
        for scene in (dynamic, {**dynamic, "Examples/Weights per region": "true"}):
            output = self.solve(scene)
            for column in read_csv(output)[0]:
                general = re.sub(r"_[yz]$", "_x", column).replace("_left_", "_NAME_")
                for pattern, name in ((r"^weight_\d+$", "weight_I"), (r"^weight_\d+_\d+$", "weight_R_I"),
                                      (r"^multiplier_\d+$", "multiplier_R")):
                    general = re.sub(pattern, name, general)
                self.assertIn(general, manual)
            for key in read_summary(output):
                self.assertIn(key, manual)

    def test_final_pose_keeps_numbers_and_tags(self):
        self.write("hand.msh", HAND_WRITTEN)
        hand = read_msh(self.directory / "hand.msh")
        scene = {"Scene": "static", "Mesh/File": "hand.msh", "Mesh/Scale": "0.01",
                 "Handles/Names": "base", "Handles/base/Select": "nodes base.txt",
                 "Loads/Gravity": "0, 0, -1000", "Material/region 7/Young's modulus": "2e6"}
        self.write("base.txt", "17\n3 101\n")
        output = self.solve(scene)
        final = read_msh(output / "final.msh")
        self.assertEqual(final.elements, hand.elements)
        self.assertEqual(sorted(final.names), sorted(hand.names))
        self.assertEqual(list(final.nodes), list(hand.nodes))
        self.assertEqual([final.nodes[number] for number in (17, 3, 101)],
                         [(0., 0., 0.), (1., 0., 0.), (0., 1., 0.)])
        self.assertLess(final.nodes[44][2], 1. - 1e-9)
        arrays, _, _ = read_vtu(output / "frame_0010.vtu")
        self.assertEqual(arrays["CellData", "region"], [9, 7])
        summary = read_summary(output)
        self.assertEqual(summary["mesh"], str(self.directory.resolve() / "hand.msh"))
        self.assertRegex(summary["mesh_sha256"], "^[0-9a-f]{64}$")

        # and so it is a pose of another scene, in the mesh's unit again
        follow = {**scene, "Scene": "interpolation", "Handles/Names": None,
                  "Handles/base/Select": None, "Loads/Gravity": None,
                  "Examples/Poses": "out/final.msh", "Initial/Pose": "out/final.msh",
                  "Examples/Prescribed weights": "0; 1"}
        end = read_msh(self.solve(follow, output="follow", file="follow.prm") / "final.msh")
        self.assertLess(greatest_distance(end.nodes, final.nodes), 1e-12)

    def test_final_pose_has_17_digits(self):
        nodes = self.write_box(BAR, "bar.msh", lambda x, y, z: (x / 3, y / 3, z / 3)).nodes
        scene = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
                 "Mesh/File": "bar.msh", "Output/Every": "0"}
        final = read_msh(self.solve(scene) / "final.msh").nodes
        held = [number for number, x in nodes.items() if x[0] == 0.]
        self.assertEqual(len(held), 4)
        self.assertEqual([final[number] for number in held], [nodes[number] for number in held])

    def test_output_directory(self):
        first = self.solve({**BAR, "Time/Increments": "4"}, output="deep/out")
        frame = (first / "frame_0004.vtu").read_bytes()
        (first / "frame_0004.vtu.tmp").write_bytes(frame[:200])  # of a run that was killed
        (first / "frame_0003.vtu.tmp").write_bytes(b"")
        (first / "notes.txt").write_text("mine")
        (first / "frame_best.vtu").write_text("mine too")
        self.solve(BAR, output="deep/out")  # two increments
        self.assertEqual({file.name for file in first.iterdir()},
                         FILES - {"frame_0004.vtu"} | {"frame_0001.vtu", "notes.txt",
                                                      "frame_best.vtu"})
        self.assertEqual((first / "notes.txt").read_text(), "mine")

        # a bad scene clears nothing
        before = results(first)
        self.assertEqual(self.attempt({**BAR, "Scene": "x"}, output="deep/out").status, 1)
        self.assertEqual(results(first), before)

        # without --output and Output/Directory: output/NAME, from the working directory
        (self.directory / "scenes").mkdir()
        self.write("scenes/bend.prm", prm(BAR))
        self.assertEqual(self.call("scenes/bend.prm", "--quiet").status, 0)
        self.assertTrue((self.directory / "output/bend/final.msh").exists())

    def test_formats(self):
        self.solve({**BAR, "Output/Formats": "vtu"})
        self.assertTrue((self.directory / "out/animation.pvd").exists())
        for formats in ("wobble", "vtu, wobble", "vtu, vtu", "vtu,", ""):
            run = self.attempt({**BAR, "Output/Formats": formats})
            self.assertEqual(run.status, 1)
            self.assertIn(f"Output/Formats = '{formats}' is not allowed. Allowed: one or more of vtu, obj, ply, mdd, pc2, usda, "
                          "each once",
                          run.stderr)

    def test_set_overrides_the_scene(self):
        self.write("scene.prm", prm(BAR))
        run = self.call("scene.prm", "--set", "Time/Increments=3", "--set",
                        "Handles/left/Motion=0; 0; t", "--set", "Time/Increments = 1",
                        "--output", "out")
        self.assertEqual((run.status, run.stderr),
                         (0, "Warning: --set Time/Increments is given twice, as '3' and '1': the last one holds.\n"))
        output = self.directory / "out"
        self.assertEqual(len(read_csv(output)), 2)
        self.assertIn("set Motion = 0; 0; t\n", (output / "parameters.prm").read_text())
        self.assertEqual((output / "original.prm").read_text(), prm(BAR))

    def test_log(self):
        self.write("scene.prm", prm(BAR))
        run = self.call("scene.prm", "--output", "out")
        self.assertEqual((run.status, run.stderr), (0, ""))
        mark, date, *lines = (self.directory / "out/log.txt").read_text().splitlines()
        self.assertEqual(mark, "exemplar: what the run has said")
        self.assertRegex(date, r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d UTC, exemplar \d")
        self.assertEqual(lines, [line for line in run.stdout.splitlines() if not line.startswith("step ")])
        self.assertIn("Body      2 x 1 x 1 m, 2000 kg; E 1e6 Pa, nu 0.45; rho g L / E 0.002", lines)

        # the same with --quiet, which clears the one before; a resumed run adds to it
        quiet = self.solve(BAR, "--quiet")
        def words(text):
            return re.sub(r" *[0-9.]+", " 0", text)
        first = (quiet / "log.txt").read_text()
        self.assertEqual(words(first), words("\n".join([mark, date, *lines, ""])))
        self.solve(BAR, "--quiet", "--resume")
        log = (quiet / "log.txt").read_text()
        self.assertTrue(log.startswith(first))
        self.assertEqual(log.count(mark), 1)
        self.assertIn("Resumed   after step 2\n          it was the last one, and nothing is left to do", log[len(first):])
        self.assertEqual(log.count("Where the time went"), 2)

    def test_log_of_a_failure(self):
        failing = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.1", "Time/End": "0.2", "Solver/Method": "fixed point",
                   "Solver/Maximum iterations": "1", "Solver/Tolerance": "1e-12", "Loads/Gravity": "0, 0, -1"}
        run = self.attempt(failing)
        self.assertEqual(run.status, 2, run.stderr)
        said = run.stderr.removeprefix("exemplar: ")
        self.assertIn(said, (run.output / "log.txt").read_text())
        self.assertEqual(read_summary(run.output)["warnings"], [])

    def test_a_foreign_log_is_not_cleared(self):
        output = self.solve(BAR)
        (output / "log.txt").write_text("my notes\n")
        for arguments in ([], ["--resume"]):
            run = self.attempt(BAR, *arguments)
            self.assertEqual(run.status, 1)
            self.assertIn("holds log.txt, which was not written by exemplar", run.stderr)
        self.assertEqual((output / "log.txt").read_text(), "my notes\n")

    def test_what_does_nothing_is_noted(self):
        cases = (({"Loads/Gravity": None}, "Note      nothing will happen: no handle moves, no load acts"),
                 ({"Examples/Pose functions": "x; y; z+0.1*x^2", "Examples/Weights per region": "true"},
                  "Note      Examples/Weights per region does nothing: the body has one region"))
        for keys, words in cases:
            with self.subTest(words):
                run = self.attempt({**BAR, **keys})
                self.assertEqual((run.status, run.stderr), (0, ""))
                self.assertIn(words, (run.output / "log.txt").read_text())

    def test_turns_of_linear_strain_are_warned_of(self):
        keys = {**BAR, "Loads/Gravity": None, "Model/Strain": "linear", "Handles/Names": "left, right", "Handles/right/Select": "boundary 2"}
        for motion, is_far in (("0; 0; 4*t", True), ("0; 0; .1*t", False)):
            self.write("scene.prm", prm({**keys, "Handles/right/Motion": motion}))
            run = self.call("scene.prm", "--output", motion)
            self.assertEqual(run.status, 0, run.stderr)
            self.assertEqual("Warning: Cells have turned by up to" in run.stderr, is_far, run.stderr)

    def test_wrong_units_are_warned_of(self):
        pulled = {**BAR, "Loads/Gravity": None, "Handles/Names": "left, right", "Handles/right/Select": "boundary 2"}
        motion = "Handles/right/Motion"
        cases = (
            ({**BAR, "Mesh/Box size": "400, 100, 100"}, ["The body is 400 m long.", "Mesh/Scale = 0.001"]),
            ({**BAR, "Mesh/Box size": "0.001, 0.0002, 0.0002"}, ["only 0.001 m long", "Mesh/Scale"]),
            ({**BAR, "Material/Density": "1"}, ["density of 1 kg/m^3", "water has 1000"]),
            ({**BAR, "Material/Density": "7.85e6"}, ["7.85e+06 kg/m^3", "all metals"]),
            ({**BAR, "Material/Young's modulus": "10"}, ["Young's modulus of 10 Pa", "1e6 are one MPa"]),
            ({**BAR, "Loads/Gravity": "0, 0, -100"}, ["sag further than it is long (rho g L / E = 0.2;"]),
            ({**BAR, "Loads/Gravity": "0, 0, -15"}, ["sag by some 30 % of its length (rho g L / E = 0.03;"]),
            ({**STANDING, "Contact/Self": "true"}, ["strains it by some 16 % at the foot (rho g L / E = 0.16", "make steps slow", "of 80000 Pa or more"]),
            ({**STANDING, "Material/Young's modulus": "2e4"}, []),
            ({**pulled, motion: "0; 0; sin(90*t)"}, ["sin(90*t) goes up to 14.3 turns", "write 90*pi/180."]),
            ({**pulled, motion: "300*t; 0; 0"}, ["150 m in a step, 61.2 times the size of the body (2.45 m)"]),
            ({**pulled, motion: "100*t; 0; 0", "Time/Increments": "50"}, ["up to 100 m, 40.8 times"]),
            ({**BAR, "Time/Step": "0.1"}, ["Time/Step = 0.1 does nothing", "in Time/Increments = 2 steps", "Scene = dynamic"]),
            ({**BAR, "Initial/Velocity": "0; 0; 1"}, ["Initial/Velocity = 0; 0; 1 does nothing in a scene that is not dynamic"]),
            ({**BAR, "Scene": "dynamic"}, ["Time/Increments = 2 does nothing in a dynamic scene"]),
            ({**BAR, "Examples/Importance": "0.5"}, ["Examples/Importance = 0.5 does nothing without examples"]),
            ({**BAR, "Loads/Names": "tip", "Loads/tip/Select": "boundary 2"}, ["Loads/tip does nothing: its Force is 0; 0; 0."]),
            ({**BAR, "Material/Density": "7.8"}, ["density of 7.8 kg/m^3", "1000 are one g/cm^3"]),
            ({**pulled, motion: "x; y; z+0.5*t"}, ["Handles/right: at t = 0", "as if it gave places", "displacements"]),
            ({**pulled, motion: "0; y*(cos(4*pi*t)-1)-z*sin(4*pi*t); y*sin(4*pi*t)+z*(cos(4*pi*t)-1)"},
             ["Handles/right/Motion turns the held nodes by 360 degrees in a step", "Take 12 times as many steps"]),
            ({**pulled, motion: "0; 0; sin(90/180*t)"}, ["sin(90/180*t) divides by 180 without pi", "90*pi/180"]),
            ({**pulled, motion: "0; 0; 0.5", "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.02"},
             ["Handles/right: at t = 0 the held nodes are up to 0.5 m from where the body starts"]),
            ({**BAR, "Loads/Names": "tip", "Loads/tip/Select": "boundary 1", "Loads/tip/Force": "0; 0; 1"}, ["Loads/tip moves nothing: handles hold"]),
            ({**pulled, motion: "0; 0; t", "Handles/right/Components": "z", "Loads/Names": "tip", "Loads/tip/Select": "boundary 2",
              "Loads/tip/Force": "0; 0; 1"}, ["Loads/tip moves nothing", "in its direction", "free a component"]),
            ({**pulled, motion: "0; 0; t", "Handles/right/Components": "z", "Loads/Names": "tip", "Loads/tip/Select": "boundary 2",
              "Loads/tip/Force": "0; .1; 1"}, []),
            ({**pulled, motion: ".5*t; 0; t", "Handles/right/Components": "z"}, ["moves along x, too", "Add x to Components"]),
            ({**pulled, motion: "0; 0; z+.1*t", "Handles/right/Components": "z"}, ["as if it gave places"]),
            ({**pulled, motion: "0; 0; .1"}, ["up to 0.1 m from where the body starts", "in the first increment", "begin with 0"]),
            ({**pulled, motion: "0; 0; .1", "Time/Increments": "1"}, []),
            ({**pulled, motion: "0; 0; .2*sin(20*pi*t)", "Time/Increments": "20"}, ["swing to and fro within a step", "twenty for each swing"]),
            ({**pulled, motion: "0; 0; .2*sin(20*pi*t)", "Time/Increments": "100"}, []),
            ({**BAR, "Examples/Pose functions": "1.1*x; y; z", "Examples/Include rest pose": "false"},
             ["There is one example", "pulls at the body all the time", "Include rest pose = true"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.02", "Time/Mass damping": "1e6"},
             ["Time/Mass damping = 1e+06 per s stops all motion within 1e-06 s", "a rate in 1/s"]),
            ({**BAR, "Solver/Tolerance": "0.5"}, ["out of balance by 50 %", "The default is 1e-08"]),
            ({**BAR, "Examples/Pose functions": "1.1*x; y; z", "Examples/Weights": "prescribed", "Examples/Prescribed weights": "1-2*t; 2*t"},
             ["go from -1 to 2", "extrapolated", "min(t, 1)"]),
            ({**BAR, "Mesh/Box size": "2, 1, .001"}, ["The cells of the box have edges of", "proportions of Mesh/Box size"]),
            ({**BAR, "Material/Poisson's ratio": ".4999", "Model/Dilatation": "cells"}, ["linear tetrahedra without patches lock"]),
            ({**BAR, "Material/Poisson's ratio": ".4999"}, []),
            ({**BAR, "Material/Poisson's ratio": ".49999"}, ["Poisson's ratio of 0.49999 is beyond 0.4999"]),
            ({**BAR, "Solver/Step tolerance": "1e-6"}, ["Solver/Step tolerance = 1e-6 does nothing", "Solver/Tolerance"]),
            ({**BAR, "Examples/Pose functions": "1.1*x; y; z", "Examples/Attach": "100"}, ["Examples/Attach = 100 does nothing without a pose by a surface"]),
            ({**BAR, "Loads/Names": "tip", "Loads/tip/Select": "boundary 2", "Loads/tip/Force": "0; 0; 1e8"},
             ["The loads add up to 1e+08 N", "times E times the body's section", "a pressure is to be multiplied"]),
            ({**BAR, "Material/Young's modulus": "210"}, ["Young's modulus of 210 Pa is less than that of jelly", "210 GPa 2.1e11"]),
            ({**BAR, "Material/Young's modulus": "2.1e14"}, ["Young's modulus of 2.1e+14 Pa is beyond that of all materials"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.02", "Time/Stiffness damping": "5"},
             ["Time/Stiffness damping = 5 is longer than Time/End = 0.02"]),
            ({**BAR, "Mesh/Cells": "500"}, ["Mesh/Cells = 500 does nothing unless Mesh/File is a surface"]),
            *(({**BAR, f"Examples/{key}": value}, [f"Examples/{key} = {value} does nothing without examples"])
              for key, value in (("Yield", "10"), ("Creep viscosity", "10"), ("Acts on", "shape"), ("Weights per region", "true"),
                                 ("Weight penalty", "weak"))),
            ({**BAR, "Examples/Pose functions": "1.1*x; y; z", "Examples/Weights": "prescribed", "Examples/Prescribed weights": "1-t; t",
              "Examples/Weight penalty": "1"}, ["Examples/Weight penalty = 1 does nothing with prescribed weights"]),
            ({**BAR, "Mesh/Surface": "scene.prm"}, ["scene.prm is no surface", "an .obj, .ply or .stl file"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/End": "0.02", "Initial/Pose function": "x; y; z+1"},
             ["Handles/left: at t = 0 the held nodes are up to 1 m from where the body starts"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/End": "0.02", "Handles/left/From": "5"},
             ["none begins at From = 5 or later. Times of this scene go from 0 to 0.02"]),
            ({**BAR, "Examples/Importance": "0"}, []),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.5", "Time/End": "0.2"}, ["Time/Step = 0.5 is longer than Time/End = 0.2: one step"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Handles/left/Select": "sphere 0 -.5 -.5 .1"}, ["'left' holds a single node", "Select by 1.75 m"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Handles/left/Select": "sphere 0 -.5 -.5 1.85"}, []),
            ({**pulled, "Handles/right/Select": "sphere 2 .5 .5 .1", motion: "0; 0; .1*t"}, ["'right' pulls at the single node", "Select by"]),
            ({**pulled, "Handles/right/Select": "sphere 2 .5 .5 .1", motion: "0; 0; .1*t", "Handles/right/Components": "z"}, []),
            ({**pulled, "Handles/right/Select": "sphere 2 .5 .5 .1"}, []),
            ({**pulled, "Handles/right/Select": "box 1.9 2.1 -1 1 -1 1"}, ["Did you mean 'box 1.9 -1 -1 2.1 1 1'? If not, write 'box 1 -1 -1 1.9 2.1 1'"]),
            ({**pulled, "Handles/right/Select": "box 2.1 1 1 1.9 -1 -1"}, []),
            ({**BAR, "Examples/Pose functions": "0; 0; 0.1*x^2"}, ["makes the body flat", "did you mean 'x; y; z + 0.1*x^2'?"]),
            ({**BAR, "Initial/Pose function": "-.1; x > 1 ? .1 : 0; 0"}, ["did you mean 'x - .1; y + (x > 1 ? .1 : 0); z'?"]),
            ({**BAR, "Initial/Pose function": "x; y; 0"}, []),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "1e-7"}, ["10000000 steps and writes 10000000 frames", "Output/Every = 10000, for 1000 frames"]),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "1e-7", "Output/Every": "10000"}, []),
            (BAR, []),
            ({**pulled, "Material/Density": "1", "Material/Young's modulus": "1"}, []),  # nothing depends on them
            ({**pulled, motion: "0; 0; sin(90*pi/180*t)"}, []),
            ({**BAR, "Scene": "dynamic", "Time/Increments": None, "Loads/Gravity": "0, 0, -100", "Time/End": "0.01"}, []),  # has no time to sag
        )
        for keys, words in cases:
            with self.subTest(words=words):
                self.write("scene.prm", prm(keys))
                run = self.call("scene.prm", "--validate")
                self.assertEqual(run.status, 0, run.stderr)
                for word in words:
                    self.assertIn(word, run.stderr)
                if not words:
                    self.assertEqual(run.stderr, "")

    def test_a_long_soft_body_of_a_file(self):
        output = self.solve({**BAR, "Mesh/Box size": "40, 10, 10", "Loads/Gravity": None})  # a box is in metres
        scene = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": str(output / "final.msh")}
        for keys, is_warned in (({}, True), ({"Material/Young's modulus": "3e10"}, False), ({"Mesh/Scale": "0.9"}, False),
                                ({"Loads/Gravity": None}, False)):
            self.write("scene.prm", prm({**scene, **keys}))
            self.assertEqual("40 m long. If its mesh is in millimetres" in self.call("scene.prm", "--validate").stderr, is_warned)

    def test_warnings_are_kept(self):
        run = self.attempt({**BAR, "Mesh/Box size": "400, 100, 100", "Material/Density": "1"})
        self.assertEqual(run.status, 0, run.stderr)
        warnings = [line.removeprefix("Warning: ") for line in run.stderr.splitlines()]
        self.assertEqual(len(warnings), 2, run.stderr)
        self.assertEqual(read_summary(run.output)["warnings"], warnings)
        for line in run.stderr.splitlines():
            self.assertIn(line + "\n", (run.output / "log.txt").read_text())

    def test_a_bar_on_terminals_alone(self):
        """A process of mpirun has what looks like a terminal, and is written to a file."""
        self.write("scene.prm", prm(BAR))
        for environment, is_bar in (({}, True), ({"OMPI_COMM_WORLD_SIZE": "1"}, False)):
            ours, theirs = pty.openpty()
            subprocess.run([EXEMPLAR, "scene.prm"], cwd=self.directory, stdout=theirs, check=True,
                           env={**os.environ, **environment})
            os.close(theirs)
            shown = b""
            with open(ours, "rb", buffering=0) as terminal, contextlib.suppress(OSError):  # the end of it
                while part := terminal.read(4096):
                    shown += part
            self.assertIn(b"Where the time went", shown)
            self.assertEqual(b"\x1b[K" in shown, is_bar)

    def test_quiet(self):
        self.write("scene.prm", prm(BAR))
        self.assertEqual(self.call("scene.prm", "--quiet")[:3], (0, "", ""))

    def test_validate_writes_nothing(self):
        self.write("scene.prm", prm(BAR))
        run = self.call("scene.prm", "--validate")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertIn("scene.prm: valid; 12 cells, 12 nodes, 2 steps", run.stdout)
        self.assertEqual([file.name for file in self.directory.iterdir()], ["scene.prm"])

    def test_help_and_version(self):
        run = self.call("--help")
        self.assertEqual((run.status, run.stderr), (0, ""))
        for option in ("--set", "--output", "--resume", "--threads", "--quiet", "--validate",
                       "--print-parameters", "--version"):
            self.assertIn(option, run.stdout)
        run = self.call("--version")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertRegex(run.stdout, r"^exemplar \d+\.\d+\.\d+ ")

    def test_print_parameters(self):
        run = self.call("--print-parameters")
        self.assertEqual((run.status, run.stderr), (0, ""))
        keys, path = {}, []
        for line in map(str.strip, run.stdout.splitlines()):
            if line.startswith("subsection "):
                path.append(line[len("subsection "):])
            elif line == "end":
                path.pop()
            elif line.startswith("set "):
                key, value = line[len("set "):].split(" =", 1)
                keys["/".join(path + [key])] = value.strip()
        self.assertEqual(path, [])
        expected = {
            "": ["Scene"],
            "Mesh/": ["File", "Generator", "Box size", "Box cells", "Scale"],
            "Material/": ["Young's modulus", "Poisson's ratio", "Density", "Mass matrix"],
            "Material/region 1/": ["Young's modulus", "Poisson's ratio", "Density"],
            "Model/": ["Strain", "Gradient"],
            "Examples/": ["Poses", "Pose functions", "Include rest pose", "Importance",
                          "Weight penalty", "Energy", "Weights", "Prescribed weights"],
            "Handles/": ["Names"],
            "Handles/NAME/": ["Select", "Motion", "Components", "Follow pose", "Progress"],
            "Loads/": ["Gravity", "Names"],
            "Loads/NAME/": ["Select", "Force"],
            "Initial/": ["Pose", "Pose function", "Velocity"],
            "Time/": ["Scheme", "Step", "End", "Increments"],
            "Solver/": ["Method", "Tolerance", "Maximum iterations", "Linear solver"],
            "Output/": ["Directory", "Every", "Formats", "Checkpoint minutes"]}
        names = [section + key for section, section_keys in expected.items()
                 for key in section_keys]
        self.assertEqual([name for name in names if name not in keys], [])
        remarks = re.findall(r"# Allowed: .+\. Default: .+", run.stdout)
        self.assertEqual(len(remarks), len(keys))

        # it is a scene file, once the samples have gone and there is a mesh
        scene = {path: value for path, value in keys.items() if not re.search("NAME|region", path)}
        self.assertEqual(self.attempt({**scene, "Mesh/Generator": "box"}, "--validate").status, 0)


if __name__ == "__main__":
    unittest.main()
