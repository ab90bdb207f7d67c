# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that was killed or interrupted and resumed leaves the bytes of one that was not."""

import signal
import subprocess
import time
import unittest

from exemplar_runner import (EXEMPLAR, SceneTest, needs_trilinos, own_words, prm, read_csv, read_pvd, read_summary, results,
                             timeless_statistics, wait_until)

EACH_STEP = ["--set", "Output/Checkpoint minutes=0"]

BOX = {
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "6, 3, 3",
    "Material/Young's modulus": "1e4",
    "Material/Density": "10",
    "Examples/Pose functions": "1.3*x; y; z | x; y; z+0.2*x^2",
    "Solver/Tolerance": "1e-6",
    "Output/Every": "7",
}
HANDLES = {
    "Handles/Names": "left, right end",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Motion": "0; 0; 0.1*sin(6*t)",
    "Handles/right end/Select": "boundary 2",
    "Handles/right end/Motion": "0.2*t; 0; 0",
    "Handles/right end/Components": "x",
    "Loads/Gravity": "0, 0, -9.81",
}
DYNAMIC = {**BOX, **HANDLES, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.7"}
ITERATIVE = {"Solver/Linear solver": "iterative"}
STATIC = {**BOX, **HANDLES, "Scene": "static", "Time/Increments": "70"}
INTERPOLATION = {**BOX, "Scene": "interpolation", "Time/Increments": "70",
                 "Examples/Prescribed weights": "1-t; t; 0"}


class Resume(SceneTest):
    def stop(self, scene, how, after, *arguments, delay=0.):
        """Run a scene and send it a signal after so many steps. Return the status and stderr."""
        self.write("scene.prm", prm(scene))
        rows = self.directory / "out/statistics.csv"
        earlier = rows.read_bytes().count(b"\n") if "--resume" in arguments else 0
        self.assertGreater(after + 2, earlier, "the run has come further already")
        process = subprocess.Popen(
            [EXEMPLAR, "scene.prm", "--output", "out", "--quiet", *arguments], cwd=self.directory,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        with process:
            # the header, the initial state and the steps
            wait_until(lambda: rows.exists() and rows.read_bytes().count(b"\n") >= after + 2, process)
            time.sleep(delay)
            process.send_signal(how)
            message = process.communicate(timeout=300)[1]
        return process.returncode, message

    def check_kills(self, scene, moments):
        whole = results(self.solve(scene, output="whole"))
        self.assertIn("final.msh", whole)
        arguments = EACH_STEP
        for after, delay in moments:
            status, message = self.stop(scene, signal.SIGKILL, after, *arguments, delay=delay)
            self.assertEqual((status, own_words(message)), (-signal.SIGKILL, ""), "not hit in the middle")
            self.assertFalse((self.directory / "out/final.msh").exists())
            arguments = [*EACH_STEP, "--resume"]
        resumed = self.solve(scene, *arguments)
        self.assert_same(results(resumed), whole)
        self.assertEqual([file.name for file in resumed.iterdir() if file.suffix == ".tmp"], [])
        self.assertEqual({name: read_summary(resumed)[name] for name in ("steps", "iterations",
                                                                         "worst_residual")},
                         {name: read_summary(resumed.parent / "whole")[name]
                          for name in ("steps", "iterations", "worst_residual")})

    def assert_same(self, found, expected):
        self.assertEqual(found["statistics.csv"], expected["statistics.csv"])
        self.assertEqual(found.keys(), expected.keys())
        self.assertEqual([name for name in found if found[name] != expected[name]], [])

    def test_killed_scene_with_keys_that_add_up(self):
        self.check_kills({**DYNAMIC, "Examples/Weights": "additive", "Examples/Yield": "0.1", "Examples/Creep viscosity": "1"}, [(30, 0.)])

    def test_killed_scene_with_regions_that_are_found(self):
        ends = "x; y; z+0.3*max(0,0.8-x)^2 | x; y; z+0.3*max(0,x-1.2)^2"
        self.check_kills({**DYNAMIC, "Mesh/Box cells": "12, 3, 3", "Mesh/Box size": "2, .5, .5", "Examples/Pose functions": ends,
                          "Examples/Regions": "auto"}, [(30, 0.)])
        self.assertIn("weight_2_2", read_csv(self.directory / "whole")[-1])

    def test_killed_dynamic_scene(self):
        self.check_kills({**DYNAMIC, "Examples/Weights": "free"}, [(2, 0.), (11, 0.003), (22, 0.006), (36, 0.001)])
        rows = read_csv(self.directory / "whole")  # something must have moved
        self.assertGreater(max(row["energy_kinetic"] for row in rows), 1.)
        self.assertGreater(max(row["weight_2"] for row in rows) -
                           min(row["weight_2"] for row in rows), 0.1)

    def test_killed_scene_of_second_order_with_damping(self):
        # BDF2 needs the step before, damping its strains
        self.check_kills({**DYNAMIC, "Time/Scheme": "bdf2", "Time/Stiffness damping": "0.01",
                          "Time/Mass damping": "0.1"}, [(1, 0.), (20, 0.003)])

    def check_memory(self, method):
        self.check_kills({**DYNAMIC, "Examples/Yield": "30", "Examples/Creep viscosity": "10", "Time/Scheme": "bdf2",
                          "Solver/Method": method}, [(2, 0.), (25, 0.001)])
        rows = read_csv(self.directory / "whole")
        self.assertGreater(rows[-1]["energy_dissipated"], 1.)

    def test_killed_scene_with_weights_that_remember(self):
        self.check_memory("quasi newton")

    def test_killed_scene_of_newton_with_weights_that_remember(self):
        self.check_memory("newton")

    def test_killed_static_scene_with_weights_that_remember(self):
        self.check_kills({**STATIC, "Examples/Yield": "30"}, [(20, 0.)])
        self.assertGreater(read_csv(self.directory / "whole")[-1]["energy_dissipated"], 0.1)

    def test_killed_scene_with_predicted_rotations(self):
        self.check_kills({**DYNAMIC, "Solver/Method": "one pass", "Solver/Rotations": "predicted"}, [(7, 0.), (20, 0.003)])

    def test_killed_static_scene(self):
        self.check_kills(STATIC, [(20, 0.)])

    @needs_trilinos
    def test_killed_dynamic_scene_with_iterative_solver(self):
        # multigrid hierarchies know nothing of those before
        self.check_kills({**DYNAMIC, **ITERATIVE}, [(11, 0.003), (36, 0.001)])

    @needs_trilinos
    def test_killed_static_scene_with_iterative_solver(self):
        self.check_kills({**STATIC, **ITERATIVE}, [(20, 0.)])

    def test_killed_interpolation(self):
        self.check_kills(INTERPOLATION, [(20, 0.)])

    def test_interrupt_writes_a_checkpoint(self):
        scene = {**DYNAMIC, "Time/Step": "0.002"}  # so many steps that a signal comes in time
        whole = results(self.solve(scene, output="whole"))
        arguments = []
        for how, after in ((signal.SIGINT, 5), (signal.SIGTERM, 200)):
            status, message = self.stop(scene, how, after, *arguments)
            self.assertEqual(status, 130, message)
            self.assertRegex(message,
                             r"^exemplar: Interrupted after step \d+\. Go on with --resume\.\n$")
            output = self.directory / "out"
            summary, rows = read_summary(output), read_csv(output)
            self.assertEqual(summary["status"], "interrupted")
            self.assertEqual(summary["steps"], rows[-1]["step"])
            self.assertGreaterEqual(summary["steps"], after)
            self.assertLess(summary["steps"], 350)
            arguments = ["--resume"]
        self.assert_same(results(self.solve(scene, "--resume")), whole)
        self.assertEqual(read_summary(self.directory / "out")["status"], "converged")

    def test_a_later_end(self):
        scene = {**DYNAMIC, "Time/End": "0.28"}
        whole = results(self.solve(scene, output="whole"))
        self.solve({**scene, "Time/End": "0.14"})
        # nothing is left to do: the same again
        half = results(self.directory / "out")
        self.assert_same(results(self.solve({**scene, "Time/End": "0.14"}, "--resume")), half)
        output = self.solve(scene, "--resume")
        self.assert_same(results(output), whole)
        self.assertIn("set End = 0.28\n", (output / "parameters.prm").read_text())

    def test_other_frames(self):
        scene = {**DYNAMIC, "Time/End": "0.12", "Output/Every": "4"}
        self.solve(scene)
        output = self.solve({**scene, "Time/End": "0.18", "Output/Every": "3"}, "--resume")
        frames = [f"frame_{step:04}.vtu" for step in (0, 4, 8, 12, 15, 18)]
        self.assertEqual([name for _, name in read_pvd(output)], frames)
        self.assertEqual(sorted(file.name for file in output.glob("frame_*")), frames)
        whole = self.solve({**scene, "Time/End": "0.18"}, output="whole")
        self.assertEqual(timeless_statistics(output), timeless_statistics(whole))


if __name__ == "__main__":
    unittest.main()
