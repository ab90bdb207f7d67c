# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs that go on from a step that is kept, with the same scene or an edited one."""

import shutil
import unittest

from exemplar_runner import SceneTest, prm, read_csv, read_summary, results

BOX = {
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "4, 2, 2",
    "Material/Young's modulus": "1e4",
    "Material/Density": "10",
    "Examples/Pose functions": "1.3*x; y; z | x; y; z+0.2*x^2",
    "Solver/Tolerance": "1e-6",
    "Output/Every": "4",
    "Output/Keep states": "true",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Motion": "0; 0; 0.1*sin(6*t)",
    "Loads/Gravity": "0, 0, -9.81",
}
DYNAMIC = {**BOX, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.18"}
STATIC = {**BOX, "Scene": "static", "Time/Increments": "10"}
# Friction, anchors of springs, obstacles that go, and tensions make the tangent, whose factor serves the next increment, too.
FLOOR = {"Obstacles/Names": "floor", "Obstacles/floor/Shape": "box 1 -2 -3  3 2 -0.55", "Obstacles/floor/Motion": "0.1*t; 0; 0.3*t"}
PLATES = {"Handles/Names": None, "Handles/left/Select": None, "Handles/left/Motion": None, "Loads/Gravity": None,
          "Obstacles/Names": "below, above", "Obstacles/below/Shape": "plane 0 0 -0.5  0 0 1", "Obstacles/below/Friction": "0.5",
          "Obstacles/above/Shape": "plane 0 0 0.5  0 0 -1", "Obstacles/above/Motion": "0.05*t; 0; -0.2*t", "Obstacles/above/Friction": "0.5"}
OF_STEPS = {"friction": {**FLOOR, "Obstacles/floor/Friction": "0.5"}, "a floor that goes": {**FLOOR, "Obstacles/floor/Until": "0.5"},
            "tension": {"Material/Fibre direction": "1; 0.2; 0", "Material/Fibre tension": "1000*t"},
            "held by friction": {**PLATES, "Obstacles/Free": "friction"}, "held by springs": {**PLATES, "Obstacles/Free": "weak springs"}}


def sheet(n, m):
    """A curved sheet of 2 m x 1 m, as an .obj."""
    lines = [f"v {2 * x / n:.9g} {y / m:.9g} {0.1 * (x / n) * (1 - x / n):.9g}\n" for y in range(m + 1) for x in range(n + 1)]
    corners = [y * (n + 1) + x + 1 for y in range(m) for x in range(n)]
    return "".join(lines + [f"f {a} {a + 1} {a + n + 2}\nf {a} {a + n + 2} {a + n + 1}\n" for a in corners])


def names(output):
    return sorted(file.name for file in output.iterdir())


class ResumeFrom(SceneTest):
    def contents(self, output):
        """Of all files that must be the same; states hold seconds, so their names alone."""
        return {**results(output), "names": names(output)}

    def check_unchanged(self, scene, step):
        whole = self.contents(self.solve(scene, output="whole"))
        self.solve(scene)
        self.assertEqual(self.contents(self.solve(scene, "--resume-from", step)), whole)
        self.assertNotIn("edits", read_summary(self.directory / "out"))

    def test_unchanged_scenes(self):
        for name, scene in {"quasi newton": DYNAMIC, "newton": {**DYNAMIC, "Solver/Method": "newton"},
                            "bdf2": {**DYNAMIC, "Time/Scheme": "bdf2", "Time/Stiffness damping": "0.01"},
                            "green": {**DYNAMIC, "Model/Strain": "green"}, "static": STATIC}.items():
            with self.subTest(name):
                self.check_unchanged(scene, "8")

    def test_static_scenes_whose_tangent_is_that_of_a_step(self):
        for name, changes in OF_STEPS.items():
            with self.subTest(name):
                self.check_unchanged({**STATIC, "Examples/Pose functions": None, "Mesh/Box cells": "2, 1, 1", "Time/Increments": "5",
                                      "Output/Every": "2", **changes}, "2")

    def test_a_shell_whose_edge_is_let_go_at_that_step(self):
        self.write("sheet.obj", sheet(8, 4))
        shell = {"Scene": "dynamic", "Time/Scheme": "bdf2", "Time/Step": "0.01", "Time/End": "0.12", "Mesh/Kind": "shell",
                 "Mesh/File": "sheet.obj", "Material/Thickness": "0.02", "Material/Young's modulus": "1e6", "Output/Every": "4",
                 "Output/Keep states": "true", "Loads/Gravity": "0, 0, -9.81", "Handles/Names": "left, right",
                 "Handles/left/Select": "box -1 -1 -1 1e-6 9 9", "Handles/right/Select": "box 1.99 -1 -1 9 9 9", "Handles/right/Slopes": "held",
                 "Handles/right/Motion": "0; 0; t", "Handles/right/Until": "0.08"}
        self.check_unchanged(shell, "8")

    def test_from_the_start_and_from_the_checkpoint(self):
        self.check_unchanged(DYNAMIC, "0")
        self.check_unchanged(DYNAMIC, "18")
        lean = {**DYNAMIC, "Output/Keep states": "false"}  # the checkpoint alone
        whole = self.contents(self.solve(lean, output="whole"))
        self.solve({**lean, "Time/End": "0.1"})
        self.assertEqual(self.contents(self.solve(lean, "--resume-from", "10")), whole)

    def test_an_edited_scene(self):
        before = self.solve(DYNAMIC)
        rows, frame, text = read_csv(before), (before / "frame_0008.vtu").read_bytes(), (before / "statistics.csv").read_bytes()
        scene = (before / "original.prm").read_bytes()
        edited = {**DYNAMIC, "Material/Young's modulus": "2e4", "Handles/Names": "left, right", "Handles/right/Select":
                  "boundary 2", "Handles/right/Motion": "0.5*(t-0.08); 0; 0", "Handles/right/Components": "x",
                  "Examples/Importance": "0.5", "Loads/Gravity": "0, 0, 0"}
        out = self.solve(edited, "--resume-from", "8")
        self.assertEqual((out / "original_1.prm").read_bytes(), scene)
        self.assertEqual((out / "statistics_1.csv").read_bytes(), text)
        self.assertEqual((out / "original.prm").read_text(), prm(edited))
        self.assertIn("# after step 8; the scene before is original_1.prm\n", (out / "parameters.prm").read_text())
        self.assertEqual(read_summary(out)["edits"], [{"step": 8, "scene_before": "original_1.prm"}])
        self.assertEqual((out / "frame_0008.vtu").read_bytes(), frame)
        new = read_csv(out)
        self.assertEqual([row["step"] for row in new], list(range(19)))
        for row, old in zip(new[:9], rows[:9]):
            self.assertIsNone(row["reaction_right_x"])
            shared = row.keys() & old.keys()
            self.assertEqual({k: row[k] for k in shared}, {k: old[k] for k in shared})
        self.assertNotIn("work_gravity", new[0])
        self.assertGreater(abs(new[-1]["reaction_right_x"]), 1.)
        # it can be killed, resumed, and gone back to
        self.assertEqual(self.contents(self.solve(edited, "--resume")), self.contents(out))
        again = {**edited, "Material/Density": "20"}
        self.solve(again, "--resume-from", "12")
        self.assertEqual(read_summary(out)["edits"], [{"step": 8, "scene_before": "original_1.prm"},
                                                      {"step": 12, "scene_before": "original_2.prm"}])
        # back to the first scene, from before the edits: the bytes of the first run
        self.solve(DYNAMIC, "--resume-from", "4")
        whole = self.solve(DYNAMIC, output="whole")
        self.assertNotIn("edits", read_summary(out))
        found, expected = results(out), results(whole)
        self.assertEqual([name for name in expected if found[name] != expected[name] and name != "statistics.csv"], [])
        for row, other in zip(read_csv(out), read_csv(whole)):  # columns that the edit had not are empty up to there
            self.assertEqual([k for k in other if row[k] != other[k] and not k.startswith("seconds") and
                              (row["step"] > 4 or row[k] is not None)], [])
        # a new run clears it all
        self.assertEqual(names(self.solve(DYNAMIC)), names(whole))

    def test_the_edit_acts_as_another_run_does(self):
        # what changes nothing changes nothing: the scene is edited, but its parts do the same
        out = self.solve({**DYNAMIC, "Solver/Method": "newton", "Solver/Tolerance": "1e-11"})
        expected = read_csv(out)
        same = {**DYNAMIC, "Solver/Method": "newton", "Solver/Tolerance": "1e-11", "Handles/left/Motion": "0; 0; sin(6*t)/10"}
        out = self.solve(same, "--resume-from", "8")
        self.assertEqual(len(read_summary(out)["edits"]), 1)
        for row, other in zip(read_csv(out), expected):
            self.assertAlmostEqual(row["energy_elastic"], other["energy_elastic"], delta=1e-6 * expected[-1]["energy_elastic"])

    def test_other_weights(self):
        self.solve(DYNAMIC)
        run = self.attempt({**DYNAMIC, "Examples/Pose functions": "1.3*x; y; z"}, "--resume-from", "8")
        self.assertEqual(run.status, 0)
        self.assertIn("The example weights are others than those of step 8", run.stderr)
        run = self.attempt({**DYNAMIC, "Examples/Pose functions": "1.3*x; y; z", "Initial/Velocity": "1; 0; 0"},
                           "--resume-from", "12")
        self.assertEqual(run.status, 0)
        self.assertIn("at the start of a run alone", run.stderr)

    def test_another_scheme(self):
        self.solve({**DYNAMIC, "Time/Scheme": "bdf2"})
        self.solve(DYNAMIC, "--resume-from", "8")
        self.solve({**DYNAMIC, "Time/Scheme": "bdf2"}, "--resume-from", "12")

    def test_after_a_failed_run(self):
        stiff = {**STATIC, "Material/Density": "300", "Solver/Tolerance": "1e-10"}
        run = self.attempt({**stiff, "Solver/Method": "fixed point", "Solver/Maximum iterations": "2"})
        self.assertEqual(run.status, 2, run.stderr)
        out = self.solve(stiff, "--resume-from", "0")
        self.assertEqual(read_summary(out)["status"], "converged")
        self.assertEqual(read_csv(out)[1]["status"], "converged")

    def refused(self, scene, step, *words):
        before = {file.name: file.read_bytes() for file in (self.directory / "out").iterdir()}
        run = self.attempt(scene, "--resume-from", step)
        self.assertEqual(run.status, 1, run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertEqual({file.name: file.read_bytes() for file in run.output.iterdir()}, before)

    def put(self, source, name):
        shutil.copy(self.directory / source, self.directory / "out" / name)

    def test_what_is_not_of_the_step(self):
        out = self.solve(DYNAMIC)
        for name in ("state_0008.bin", "checkpoint.bin"):
            self.put("out/" + name, "state_0004.bin")
            self.refused(DYNAMIC, "4", "state_0004.bin is not the state of step 4, but of step "
                         + ("8" if name.startswith("state") else "18"))
        self.put("out/state_0008.bin", "state_0005.bin")
        self.refused(DYNAMIC, "5", "is not the state of step 5")
        text = (out / "statistics.csv").read_text()
        lines = text.split("\n")
        for at in (1, 8, 15):  # before the step and after it: the checkpoint speaks for all
            changed = [line.replace("0", "1", 1) if i == at else line for i, line in enumerate(lines)]
            (out / "statistics.csv").write_text("\n".join(changed))
            self.refused(DYNAMIC, "8", "statistics.csv has changed since the checkpoint")
        (out / "statistics.csv").write_text(text)
        self.solve(DYNAMIC, "--resume-from", "8")

    def test_states_of_other_runs(self):
        stiffer = {**DYNAMIC, "Material/Young's modulus": "2e4"}
        self.solve(stiffer, output="other")
        whole = results(self.solve(DYNAMIC, output="whole"))
        out = self.solve(DYNAMIC)
        for scene in (DYNAMIC, stiffer):
            self.put("other/state_0008.bin", "state_0008.bin")
            self.refused(scene, "8", "state_0008.bin is the state of another run")
        # of what this run was before it was edited, and of another edit
        self.put("whole/state_0008.bin", "state_0008.bin")
        softer = {**DYNAMIC, "Material/Young's modulus": "5e3"}
        self.assertEqual(self.solve(stiffer, "--resume-from", "8"), out)
        shutil.copytree(out, self.directory / "edited")
        self.put("whole/state_0012.bin", "state_0012.bin")
        self.refused(stiffer, "12", "is the state of another run")
        self.solve(softer, "--resume-from", "8")
        self.put("edited/state_0012.bin", "state_0012.bin")
        self.refused(softer, "12", "is the state of another run")
        # the same scene gives the same states
        self.solve(DYNAMIC, "--resume-from", "4")
        self.put("whole/state_0008.bin", "state_0008.bin")
        self.solve(DYNAMIC, "--resume-from", "8")
        self.assertEqual({name: content for name, content in results(out).items() if name != "statistics.csv"},
                         {name: content for name, content in whole.items() if name != "statistics.csv"})
        # all from the start, by the table that an edit has left
        self.solve(DYNAMIC, "--resume-from", "0")

    def test_behind_the_checkpoint(self):
        # a run that was killed has states that are later than its checkpoint
        self.solve({**DYNAMIC, "Time/End": "0.08"}, output="half")
        out = self.solve(DYNAMIC)
        whole = self.contents(out)
        self.put("half/checkpoint.bin", "checkpoint.bin")
        text = (out / "statistics.csv").read_text()
        lines = text.split("\n")
        lines[11] = lines[11].replace("0", "1", 1)
        (out / "statistics.csv").write_text("\n".join(lines))
        self.refused(DYNAMIC, "12", "statistics.csv has changed since the checkpoint")
        (out / "statistics.csv").write_text(text)
        self.assertEqual(self.contents(self.solve(DYNAMIC, "--resume-from", "12")), whole)

    def test_not_together_with_resume(self):
        self.solve(DYNAMIC)
        before = {file.name: file.read_bytes() for file in (self.directory / "out").iterdir()}
        run = self.attempt(DYNAMIC, "--resume", "--resume-from", "8")
        self.assertEqual((run.status, run.stdout), (1, ""))
        self.assertIn("--resume goes on from the last checkpoint, --resume-from from the step that it names: give one",
                      run.stderr)
        self.assertEqual({file.name: file.read_bytes() for file in run.output.iterdir()}, before)

    def test_refused(self):
        out = self.solve(DYNAMIC)
        self.refused(DYNAMIC, "5", "no state of step 5", "0, 4, 8, 12, 16, 18. Choose", "Keep states")
        self.refused({**DYNAMIC, "Mesh/Box size": "2, 1, 2"}, "8", "Mesh/Box size was", "must stay")
        self.refused({**DYNAMIC, "Time/Step": "0.02"}, "8", "Time/Step was", "must stay")
        self.refused({**STATIC, "Time/Increments": "18"}, "8", "Scene was")
        self.refused({**DYNAMIC, "Time/End": "0.05"}, "8", "which is no step of a run to Time/End = 0.05")
        run = self.attempt({**DYNAMIC, "Material/Density": "11"}, "--resume")
        self.assertEqual(run.status, 1)
        self.assertIn("--resume-from 18", run.stderr)
        content = bytearray((out / "state_0008.bin").read_bytes())
        content[len(content) // 2] ^= 1
        (out / "state_0008.bin").write_bytes(content)
        self.refused(DYNAMIC, "8", "is damaged")
        (out / "statistics.csv").write_text("step,time,status,\n")
        self.refused(DYNAMIC, "4", "is missing or shorter than at the checkpoint", "--resume-from")
        run = self.attempt(DYNAMIC, "--resume-from", "4", output="new")
        self.assertEqual(run.status, 1)
        self.assertIn("no checkpoint of a run to go on with", run.stderr)
        run = self.attempt({**DYNAMIC, "Output/Every": "0"})
        self.assertIn("Output/Every = 0 makes no frames", run.stderr)


if __name__ == "__main__":
    unittest.main()
