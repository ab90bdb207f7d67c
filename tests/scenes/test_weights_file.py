# SPDX-License-Identifier: GPL-3.0-or-later
"""Prescribed weights from a table, Examples/Weights file."""

import shutil
import unittest

from exemplar_runner import SceneTest, bend, has_trilinos, read_csv, results, twist
from mpirun import launch

SCENE = {
    "Scene": "static", "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "4, 1, 1",
    "Examples/Pose functions": f"{bend('1')} | {twist('0.7')}", "Examples/Weights": "prescribed",
    "Handles/Names": "left", "Handles/left/Select": "boundary 1", "Time/Increments": "5", "Output/Every": "1",
}
DYNAMIC = {**SCENE, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.05", "Time/End": "0.5"}
FILE = {"Examples/Weights file": "weights.csv"}
# at the times of the steps, lines that the formulas below agree with
FORMULAS = {"Examples/Prescribed weights": "1 - min(t, .4) - 2*max(0, t-.4)/3; min(t, .4)/2 + max(0, t-.4); min(t, .4)/2 - max(0, t-.4)/3"}
TABLE = "t,bent,twisted\n0,0,0\n0.4,0.2,0.2\n1,0.8,0\n"
WEIGHTS = ("weight_0", "weight_1", "weight_2")


def at(rows, time):
    """Weights at a time by linear interpolation between rows of (t, weights...)."""
    if time <= rows[0][0]:
        return rows[0][1:]
    for before, after in zip(rows, rows[1:]):
        if time <= after[0]:
            share = (time - before[0]) / (after[0] - before[0])
            return [a + share * (b - a) for a, b in zip(before[1:], after[1:])]
    return rows[-1][1:]


class WeightsFile(SceneTest):
    def columns(self, output):
        return [[row[name] for name in WEIGHTS] for row in read_csv(output)]

    def test_a_table_gives_what_formulas_give(self):
        self.write("weights.csv", TABLE)
        for scene in (SCENE, DYNAMIC):
            with self.subTest(scene["Scene"]):
                of_file = read_csv(self.solve({**scene, **FILE}, output="file"))
                of_formulas = read_csv(self.solve({**scene, **FORMULAS}, output="formulas"))
                for a, b in zip(of_file, of_formulas, strict=True):
                    for name in (*WEIGHTS, "energy_elastic"):
                        self.assertAlmostEqual(a[name], b[name], delta=1e-7 * max(1, abs(b[name])))

    def test_forms_of_a_table(self):
        rows = [(.1, .5, -.2), (.3, 0, 1.005), (.35, 1, 1)]
        text = "\n".join(",".join(map(str, row)) for row in rows)
        with_rest = "\n".join(f"{t}, {1 - a - b!r} , {a},{b}" for t, a, b in rows)
        expected = [[1 - a - b, a, b] for a, b in (at(rows, step * .05) for step in range(11))]
        self.write("weights.csv", text + "\n")
        self.attempt({**DYNAMIC, **FILE}, output="plain")
        for row, weights in zip(self.columns(self.directory / "plain"), expected, strict=True):
            for a, b in zip(row, weights):
                self.assertAlmostEqual(a, b, delta=1e-14)
        for name, other in {"windows": "\ufeff\"Time [s]\",\"a, b\",twisted\r\n# a comment\r\n\r\n" + text.replace("\n", "\r\n"),
                            "rest": "t,rest,a,b\n" + with_rest}.items():
            self.write("weights.csv", other)
            self.attempt({**DYNAMIC, **FILE}, output=name)
            for a, b in zip(self.columns(self.directory / name), expected, strict=True):
                for x, y in zip(a, b):
                    self.assertAlmostEqual(x, y, delta=1e-12)

    def test_relative_to_the_scene_resumed_and_of_an_interpolation(self):
        (self.directory / "scenes/tables").mkdir(parents=True)
        self.write("scenes/tables/weights.csv", TABLE)
        scene = {**DYNAMIC, "Examples/Weights file": "tables/weights.csv"}
        whole = self.solve(scene, file="scenes/scene.prm", output="whole")
        self.solve({**scene, "Time/End": "0.2"}, file="scenes/scene.prm", output="resumed")
        resumed = self.solve(scene, "--resume", file="scenes/scene.prm", output="resumed")
        self.assertEqual(results(resumed), results(whole))
        self.write("scenes/tables/weights.csv", TABLE.replace("0.8", "0.7"))
        run = self.attempt({**scene, "Time/End": "0.6"}, "--resume", file="scenes/scene.prm", output="resumed")
        self.assertEqual(run.status, 1)
        self.assertIn("weights.csv has changed since", run.stderr)
        interpolation = {**SCENE, "Scene": "interpolation", "Handles/Names": None, "Handles/left/Select": None}
        rows = self.columns(self.solve({**interpolation, "Examples/Weights file": "tables/weights.csv"}, file="scenes/scene.prm", output="way"))
        self.assertAlmostEqual(rows[1][1], .1, delta=1e-14)
        self.assertAlmostEqual(rows[-1][1], .7, delta=1e-14)

    @unittest.skipUnless(shutil.which("mpirun") and has_trilinos(), "without mpirun, or built without Trilinos")
    def test_two_processes(self):
        self.write("weights.csv", TABLE)
        one = self.columns(self.solve({**SCENE, **FILE}, output="one"))
        status, own, done = launch(2, self.directory / "scene.prm", "--quiet", "--output", self.directory / "two")
        self.assertEqual((status, own), (0, []), done.stderr)
        self.assertEqual(self.columns(self.directory / "two"), one)

    def test_a_column_in_the_wrong_place(self):
        self.write_box(SCENE, "up.msh")
        shutil.copy(self.directory / "up.msh", self.directory / "down.msh")
        scene = {**SCENE, **FILE, "Examples/Pose functions": None, "Examples/Poses": "up.msh, down.msh"}
        self.write("weights.csv", "t,down,up\n0,0,1\n")
        run = self.attempt(scene)
        self.assertEqual(run.status, 1)
        self.assertIn("line 1: column 2 is named 'down', but has the weights of 'up'. Write the columns in the order", run.stderr)
        for names, weights in (("t,up,down", "0.5,0.5"), ("t,smile,frown", "0.5,0.5"), ("t,rest,up,down", "0,0.5,0.5")):
            self.write("weights.csv", f"{names}\n0,{weights}\n1,{weights}\n")
            run = self.attempt(scene)
            self.assertEqual(run.status, 0, run.stderr)
            self.assertNotIn("column", run.stderr, names)

    def test_faults_are_named_with_file_line_and_remedy(self):
        for text, words in (
                (None, ("weights.csv: cannot be opened", "a table of weights in CSV")),
                ("", ("weights.csv has no weights", "one weight per example")),
                ("t,a,b\n", ("has no weights",)),
                ("0,1\n", ("line 1: it has 1 column of weights", "2 after t, or 3 with the rest pose as the first one")),
                ("0,1,0\n1,0\n", ("line 2: it has 2 cells, but the first line has 3",)),
                ("0,1,0\n1,x,0\n", ("line 2: 'x' is not a finite number",)),
                ("0,1,0\n1,nan,0\n", ("line 2: 'nan' is not a finite number",)),
                ("0,1,0\n1,,0\n", ("line 2: '' is not a finite number",)),
                ("t,a,b\n0,1,0\n0,0,0\n", ("line 3: t = 0 is not later than t = 0 in the line before", "Sort the lines by t")),
                ("0,1,0,0\n1,.5,0,.4\n", ("line 2: the weights sum to 0.9, not to 1", "Leave the column of the rest pose out")),
                ("frame,a,b\n1,0,0\n", ("line 1: the first column is 'frame', but must be 't'", "frames per second")),
                ("t;a;b\n0;1;0\n", ("line 1: the cells are separated by semicolons", "by commas"))):
            with self.subTest(text=text):
                (self.directory / "weights.csv").unlink(missing_ok=True)
                if text is not None:
                    self.write("weights.csv", text)
                run = self.attempt({**SCENE, **FILE})
                self.assertEqual(run.status, 1, run.stderr)
                self.assertIn("Examples/Weights file: ", run.stderr)
                self.assertFalse(run.output.exists())
                for word in words:
                    self.assertIn(word, run.stderr)
        self.write("weights.csv", TABLE)
        for keys, words in (({"Examples/Weights": "simplex"}, ("Examples/Weights file is given, but", "'prescribed'")),
                            (FORMULAS, ("Examples/Prescribed weights and Examples/Weights file are both given",)),
                            ({"Examples/Include rest pose": "false"}, ("line 3: the weights sum to 0.4, not to 1",))):
            text = TABLE.replace("0,0,0", "0,1,0")
            self.write("weights.csv", text)
            run = self.attempt({**SCENE, **FILE, **keys})
            self.assertEqual(run.status, 1)
            for word in words:
                self.assertIn(word, run.stderr)

    def test_times_that_a_scene_does_not_reach(self):
        for scene, text, words in ((SCENE, "0,0,0\n5,1,0\n", "goes to t = 5, but t of a scene that is not dynamic ends at 1"),
                                   (DYNAMIC, "0.5,0,0\n5,1,0\n", "begins at t = 0.5, and the scene ends at t = 0.5"),
                                   (DYNAMIC, "0,0,0\n5,1,0\n", ""), (SCENE, "3,1,0\n", "")):
            self.write("weights.csv", text)
            run = self.attempt({**scene, **FILE})
            self.assertEqual(run.status, 0)
            self.assertIn(words, run.stderr)
            self.assertEqual(run.stderr == "", words == "")

    def test_keys_that_act_together_extrapolate_nothing(self):
        self.write("weights.csv", "0,0,0\n1,1,1\n")
        self.solve({**SCENE, **FILE})
        self.write("weights.csv", "0,0,0\n1,1,1.5\n")
        self.assertIn("Examples/Weights file goes from -1.5 to 1.5", self.attempt({**SCENE, **FILE}).stderr)

    def test_the_remedy_for_sums_of_formulas(self):
        for keys, words in (({"Examples/Prescribed weights": "-t; t; t"},
                             ("'-t; t; t' sum to 0 at t = 0, not to 1", "Make the first one, that of the rest pose, 1 minus the others: 1 - (t) - (t).")),
                            ({"Examples/Prescribed weights": "1-t; 2*t", "Examples/Include rest pose": "false"},
                             ("sum to 1.2", "Make the last one 1 minus the others: 1 - (1-t)."))):
            run = self.attempt({**SCENE, **keys})
            self.assertEqual(run.status, 1)
            for word in words:
                self.assertIn(word, run.stderr)


if __name__ == "__main__":
    unittest.main()
