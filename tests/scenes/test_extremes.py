# SPDX-License-Identifier: GPL-3.0-or-later
"""Extreme scenes end as they say: what is written is finite, whatever happens, and other text than ASCII survives."""

import json
import math
import os
import subprocess
import unittest

from exemplar_runner import BAR, EXEMPLAR, SceneTest, nodes_of, prm, read_csv, read_vtu

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.1", "Time/End": "0.3"}
PULLED = {**BAR, "Handles/Names": "left, right", "Handles/right/Select": "boundary 2"}
INTERPOLATION = {**BAR, "Scene": "interpolation", "Handles/Names": None, "Handles/left/Select": None,
                 "Loads/Gravity": None, "Examples/Pose functions": "1.1*x; y; z"}

EXTREMES = [
    *({**INTERPOLATION, "Mesh/Scale": scale} for scale in ("1e-90", "1e-40", "1e30", "1e45", "1e49", "1e78", "1e200")),
    *({**PULLED, "Handles/right/Motion": f"{size}*t; 0; 0"} for size in ("1e20", "1e70", "1e140", "1e151", "1e160", "1e300")),
    *({**scene, "Initial/Pose function": f"{size}*x; y; z"} for scene in (BAR, DYNAMIC)
      for size in ("1e30", "1e70", "1e100", "1e140", "1e150")),
    *({**DYNAMIC, "Initial/Velocity": f"{size}; 0; 0"} for size in ("1e50", "1e140", "1e155")),
    *({**scene, "Material/Young's modulus": value} for scene in (BAR, DYNAMIC, INTERPOLATION)
      for value in ("1e-300", "1e-160", "1e160", "1e300")),
    *({**scene, "Loads/Gravity": f"0, 0, {value}"} for scene in (BAR, DYNAMIC) for value in ("1e100", "1e160", "1e300")),
    *({**BAR, "Model/Strain": "linear", "Loads/Gravity": f"{value}, 0, 0"} for value in ("1e100", "1e106", "1e112", "1e118")),
    *({**DYNAMIC, "Material/Density": value} for value in ("1e-300", "1e160", "1e300")),
    {**PULLED, "Handles/right/Motion": "t; 0; 0", "Material/Young's modulus": "1e160"},
    *({**DYNAMIC, "Time/Step": value, "Time/End": value} for value in ("1e-160", "1e-300", "1e160")),
]


class Extremes(SceneTest):
    def check_finite(self, output):
        """Every number of the files of a run."""
        for position in nodes_of(output / "final.msh").values():
            self.assertTrue(all(map(math.isfinite, position)), "final.msh")
        json.loads((output / "summary.json").read_text(), parse_constant=self.fail)
        for row in read_csv(output):
            for name, value in row.items():
                self.assertTrue(not isinstance(value, float) or math.isfinite(value), name)
                if row["status"] in ("initial", "converged", "one pass") and not name.startswith("seconds"):
                    self.assertIsNotNone(value, f"{name} of step {row['step']}")
        for frame in output.glob("*.vtu"):
            for name, values in read_vtu(frame)[0].items():
                self.assertTrue(all(map(math.isfinite, values)), f"{name} of {frame.name}")

    def test_no_file_holds_what_is_not_finite(self):
        for i, scene in enumerate(EXTREMES):
            changed = {key: value for key, value in scene.items() if BAR.get(key) != value}
            with self.subTest(changed):
                run = self.attempt(scene, "--quiet", output=f"out{i}")
                self.assertIn(run.status, (0, 1, 2), run.stderr)
                self.assertEqual(run.status != 0, "exemplar: " in run.stderr, run.stderr)
                if run.status == 1:
                    self.assertFalse(run.output.exists(), run.stderr)
                else:
                    self.check_finite(run.output)

    def test_a_pull_beyond_all_numbers_says_so(self):
        run = self.attempt({**PULLED, "Handles/right/Motion": "1e151*t; 0; 0"}, "--quiet")
        self.assertEqual(run.status, 2)
        self.assertRegex(run.stderr, "exemplar: Step 1 .*(not finite|not a finite)")


class OddText(SceneTest):
    def test_paths_of_any_bytes(self):
        for name in ("räum e", b"la\xe4tin", b"new\nline", b"\x1bescape"):
            name = os.fsencode(name)
            with self.subTest(name):
                directory = os.path.join(os.fsencode(self.directory), name)
                os.mkdir(directory)
                with open(os.path.join(directory, b"scene.prm"), "w") as file:
                    file.write(prm({**BAR, "Output/Directory": "out"}))
                done = subprocess.run([EXEMPLAR, os.path.join(name, b"scene.prm"), "--output", name.hex()],
                                      cwd=self.directory, stdin=subprocess.DEVNULL, capture_output=True)
                self.assertEqual((done.returncode, done.stderr), (0, b""))
                done.stdout.decode("utf-8")
                self.assertNotIn(b"\x1b", done.stdout)
                scene = json.loads((self.directory / name.hex() / "summary.json").read_bytes())["scene"]
                self.assertIn("ä" if b"\xc3" in name else "\\x", scene)

    def test_values_are_text(self):
        file = os.path.join(os.fsencode(self.directory), b"scene.prm")
        for line in (b"set Density = 1\xe4", b"set Density = 1\x1b", b"set D\xff = 1"):
            with self.subTest(line):
                with open(file, "wb") as scene:
                    scene.write(prm(BAR).encode() + b"subsection Material\n" + line + b" # caf\xe9\nend\n")
                done = subprocess.run([EXEMPLAR, "scene.prm"], cwd=self.directory, capture_output=True)
                self.assertEqual((done.returncode, done.stdout), (1, b""))
                self.assertRegex(done.stderr.decode("ascii"), r"^exemplar: scene\.prm:\d+: '\\x.." + "' is no text")
        with open(file, "wb") as scene:  # comments are nobody's business
            scene.write(prm(BAR).encode() + b"# caf\xe9\n")
        done = subprocess.run([EXEMPLAR, "scene.prm", "--validate"], cwd=self.directory, capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        for argument in (b"--set=Material/Density=1\xe4", b"--output=\xe4"):
            done = subprocess.run([os.fsencode(EXEMPLAR), b"scene.prm", argument], cwd=self.directory, capture_output=True)
            self.assertEqual((done.returncode, done.stdout), (1, b""))
            self.assertIn("is no text", done.stderr.decode("ascii"))

    def test_too_little_memory_is_said(self):
        scene = self.write("scene.prm", prm({**BAR, "Mesh/Box cells": "300, 300, 300"}))
        limited = f"ulimit -v 1500000; exec {EXEMPLAR} {scene} --output out --threads 1"
        done = subprocess.run(["sh", "-c", limited], cwd=self.directory, capture_output=True, text=True)
        self.assertIn(done.returncode, (1, 2), done.stderr)
        self.assertIn("not enough memory", done.stderr)


class Selections(SceneTest):
    def test_names_select_as_ids_do(self):
        by_id = self.solve({**BAR, "Material/region 1/Density": "2000"}, "--quiet", output="ids")
        by_name = self.solve({**BAR, "Handles/left/Select": 'boundary "x-"', "Material/region box/Density": "2000"},
                             "--quiet", output="names")
        self.assertEqual((by_id / "final.msh").read_bytes(), (by_name / "final.msh").read_bytes())
        again = self.call("names/parameters.prm", "--output", "again", "--quiet")
        self.assertEqual((again.status, again.stderr), (0, ""))

    def test_an_interpolation_between_two_needs_no_weights(self):
        given = self.solve({**INTERPOLATION, "Examples/Prescribed weights": "1-t; t"}, "--quiet", output="given")
        default = self.solve(INTERPOLATION, "--quiet", output="default")
        self.assertEqual((given / "final.msh").read_bytes(), (default / "final.msh").read_bytes())
        self.assertIn("set Prescribed weights = 1-t; t\n", (default / "parameters.prm").read_text())


if __name__ == "__main__":
    unittest.main()
