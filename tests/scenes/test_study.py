# SPDX-License-Identifier: GPL-3.0-or-later
"""exemplar study: rows, observed orders, runs that fail, and studies that are stopped and go on."""

import csv
import os
import re
import shutil
import signal
import subprocess
import sys
import unittest

from exemplar_runner import BAR, EXEMPLAR, REPOSITORY, SceneTest, prm, wait_until
from process_table import children, is_alive

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Material/Young's modulus": "1e4", "Time/Step": "0.1",
           "Time/End": "0.4"}
FREE_FALL = {**DYNAMIC, "Handles/Names": None, "Handles/left/Select": None, "Time/End": "1"}

MEASURES = ["status", "error_position_l2", "error_position_max", "error_energy", "seconds_median",
            "seconds_min", "steps", "iterations", "factorizations", "residual", "kkt_residual",
            "condition_matrix", "condition_schur", "min_det_F", "energy_growth",
            "bound_excess", "max_displacement", "peak_memory_mib", "exit_status", "run", "message"]


class Studies(SceneTest):
    def prepare(self, scene, vary, **keys):
        self.write("scene.prm", prm(scene))
        self.write("study.prm", prm({"Scene": "scene.prm", "Vary": vary, "Repeats": "1", **keys}))

    def study(self, *arguments, status=0, **environment):
        """Run the study; its rows."""
        run = self.call("study", "study.prm", "--output", "out", *arguments, **environment)
        self.assertEqual(run.status, status, run.stderr)
        self.run_of_study = run
        return self.rows() if status == 0 else None

    def rows(self):
        with open(self.directory / "out/study.csv", newline="") as file:
            return list(csv.DictReader(file))

    def timeless(self):
        return [{name: value for name, value in row.items()
                 if not name.startswith("seconds_") and name != "peak_memory_mib"}
                for row in self.rows()]

    def report(self):
        return (self.directory / "out/study.md").read_text()

    def records(self):
        """When the record of each finished run was written. A run that is still in `running` is not finished: its
        directory is renamed after its record is written."""
        return {file.parent.name: file.stat().st_mtime_ns
                for file in self.directory.glob("out/runs/*/record.json")
                if file.parent.name != "running"}

    def start(self, wait_for):
        """Start the study and wait for something that it has done."""
        process = subprocess.Popen([EXEMPLAR, "study", "study.prm", "--output", "out"],
                                   cwd=self.directory, text=True, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        wait_until(lambda: wait_for(process), process)
        return process

    def is_running(self):
        return (self.directory / "out/runs/running/statistics.csv").exists()

    def test_rows(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.05 | Solver/Method: one pass, newton",
                     Base="Time/End=0.3", Reference="Time/Step=0.01; Time/Scheme=bdf2", Repeats="3")
        rows = self.study()
        self.assertEqual(list(rows[0]), ["Time/Step", "Solver/Method", *MEASURES])
        self.assertEqual([(row["Time/Step"], row["Solver/Method"], row["status"]) for row in rows],
                         [("0.1", "one pass", "one pass"), ("0.1", "newton", "converged"),
                          ("0.05", "one pass", "one pass"), ("0.05", "newton", "converged")])
        for row in rows:
            self.assertEqual((row["exit_status"], row["message"]), ("0", ""))
            self.assertEqual(int(row["steps"]), round(0.3 / float(row["Time/Step"])))
            self.assertLessEqual(float(row["seconds_min"]), float(row["seconds_median"]))
            for column in MEASURES[1:4]:
                self.assertTrue(0 < float(row[column]) < 1, (column, row[column]))
            results = {file.name for file in (self.directory / "out/runs" / row["run"]).iterdir()}
            self.assertLessEqual({"record.json", "final.msh", "statistics.csv", "summary.json",
                                  "log.txt", "parameters.prm"}, results)
            self.assertNotIn("checkpoint.bin", results)
            self.assertEqual([name for name in results if name.endswith(".vtu")], [])
        self.assertEqual({file.name for file in (self.directory / "out/runs").iterdir()},
                         set(self.records()))
        self.assertEqual(len(self.records()), 5)  # with the reference
        self.assertTrue((self.directory / "out/study.prm").read_text().endswith(
            (self.directory / "study.prm").read_text()))
        self.assertIn("## Solver/Method = newton\n", self.report())

    def test_output_is_named_after_the_study(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.2")
        self.assertEqual(self.call("study", "study.prm", "--quiet"), (0, "", "", None))
        self.assertTrue((self.directory / "output/study/study.csv").exists())

    def test_orders_of_free_fall(self):
        # implicit Euler falls by g t (t + h) / 2 in a time t: the error is h / t
        self.prepare(FREE_FALL, "Time/Step: 0.1 0.05 0.025 | Time/Scheme: implicit euler, bdf2",
                     Reference="Time/Step=1e-3; Time/Scheme=bdf2")
        rows = self.study()
        for row in rows:
            if row["Time/Scheme"] == "implicit euler":
                for error in ("error_position_l2", "error_position_max"):
                    self.assertAlmostEqual(float(row[error]), float(row["Time/Step"]), delta=1e-3)
        for scheme, order in (("implicit euler", 1), ("bdf2", 2)):
            section = self.report().split(f"## Time/Scheme = {scheme}\n")[1].split("\n## ")[0]
            lines = [line.split("|") for line in section.splitlines() if line.startswith("| 0.")]
            self.assertEqual(len(lines), 3)
            self.assertEqual(lines[0][4].strip(), "")
            for line in lines[1:]:
                self.assertAlmostEqual(float(line[4]), order, delta=0.02 * order)

    def test_columns_and_probe(self):
        self.prepare(FREE_FALL, "Time/Step: 0.1 0.05", Columns="momentum_z", Probe="9, 9, 9")
        rows = self.study()
        for row in rows:
            run = self.directory / "out/runs" / row["run"]
            with open(run / "statistics.csv", newline="") as file:
                last = list(csv.DictReader(file))[-1]
            self.assertEqual(row["momentum_z"], last["momentum_z"])
            fall = (1 + float(row["Time/Step"])) / 2  # in a second, by gravity 1
            self.assertAlmostEqual(float(row["probe_z"]), -fall, delta=1e-9)
            self.assertAlmostEqual(float(row["probe_x"]), 0, delta=1e-9)
        self.assertIn("| probe_z |", self.report())
        self.assertRegex(self.run_of_study.stderr, r"^Warning: study.prm:\d, Probe: 9, 9, 9 lies .* m outside the box around the body: .*nearest")
        self.prepare(FREE_FALL, "Time/Step: 0.1 0.05", Probe="0.1, 0, 0")
        self.study()
        self.assertEqual(self.run_of_study.stderr, "")

    def test_columns_of_some_runs(self):
        self.prepare({**BAR, "Examples/Pose functions": "x; y; z + 0.1*x^2"}, "Examples/Importance: 0 0.5", Columns="weight_1")
        without, with_examples = self.study()
        self.assertEqual(without["weight_1"], "")
        self.assertNotEqual(with_examples["weight_1"], "")

    def test_refined_meshes_are_compared_at_common_nodes(self):
        self.prepare(BAR, "Mesh/Box cells: 2, 1, 1; 4, 2, 2; 3, 1, 1",
                     Reference="Mesh/Box cells=8, 4, 4")
        coarse, fine, other = self.study()
        self.assertEqual(coarse["Mesh/Box cells"], "2, 1, 1")
        self.assertTrue(0 < float(fine["error_position_l2"])
                        < float(coarse["error_position_l2"]) < 1)
        # this one's nodes are not all nodes of the reference
        self.assertEqual((other["status"], other["error_position_l2"]), ("converged", ""))
        self.assertNotEqual(other["error_energy"], "")

    def test_without_reference(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.2")
        for row in self.study():
            self.assertEqual([row[name] for name in MEASURES[1:4]], ["", "", ""])
            self.assertEqual(float(row["energy_growth"]), 0)
            self.assertGreater(float(row["max_displacement"]), 0)
        self.assertFalse((self.directory / "out/study.svg").exists())
        self.assertIn("energy growth", self.report())

    def test_rows_of_runs_that_fail(self):
        self.prepare(DYNAMIC, "Material/Poisson's ratio + Solver/Maximum iterations: "
                     "0.3 + 50; 0.6 + 50; 0.3 + 1", Repeats="2",
                     Base="Solver/Method=fixed point", Reference="Time/Step=0.01")
        good, refused, limit = self.study()
        self.assertEqual((good["status"], good["exit_status"]), ("converged", "0"))
        self.assertEqual((refused["status"], refused["exit_status"]), ("refused", "1"))
        self.assertIn("Material/Poisson's ratio = '0.6' is not allowed", refused["message"])
        self.assertEqual((refused["seconds_median"], refused["steps"]), ("", ""))
        self.assertRegex(self.run_of_study.stderr, "^Warning: Runs will be refused, as their rows will say: study.prm:2, Vary: "
                         "Material/Poisson's ratio = '0.6' is not allowed")
        self.assertRegex(self.run_of_study.stdout, r"\n1 refused: .*Material/Poisson's ratio = '0.6' is not allowed")
        self.assertEqual((limit["status"], limit["exit_status"]), ("iteration limit", "2"))
        self.assertIn("stopped at its iteration limit", limit["message"])
        self.assertEqual((limit["steps"], limit["error_position_l2"]), ("0", ""))
        self.assertIn("What failed", self.report())
        self.assertIn(limit["message"], self.report())
        self.assertEqual(self.study()[2], limit)  # as its record says, without another run

    def test_a_reference_that_fails(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.2", Base="Solver/Method=fixed point",
                     Reference="Solver/Maximum iterations=1")
        self.study(status=2)
        self.assertIn("reference run has ended with the status iteration limit",
                      self.run_of_study.stderr)
        self.assertIn("Change Reference", self.run_of_study.stderr)
        self.assertEqual(len(self.records()), 1)  # no other run was made

    def test_a_crash_is_a_row(self):
        self.prepare({**DYNAMIC, "Time/End": "0.1"}, "Time/Step: 1e-9 0.1")  # a hundred million steps
        os.environ["UCX_ERROR_SIGNALS"] = ""  # a library of MPI would write about the crash
        self.addCleanup(os.environ.pop, "UCX_ERROR_SIGNALS")
        process = self.start(lambda process: self.is_running())
        os.kill(children(process.pid)[0], signal.SIGSEGV)
        self.assertEqual((process.communicate(timeout=300)[1], process.returncode), ("", 0))
        crash, good = self.rows()
        self.assertEqual((crash["status"], crash["exit_status"]), ("crash", str(128 + 11)))
        self.assertIn("signal 11 (Segmentation fault)", crash["message"])
        self.assertNotEqual(crash["seconds_median"], "")
        self.assertEqual(good["status"], "converged")

    def test_timeout(self):
        self.prepare({**DYNAMIC, "Time/End": "0.1"}, "Time/Step: 1e-9 0.1", Timeout="5")
        endless, good = self.study()
        self.assertEqual((endless["status"], good["status"]), ("timeout", "converged"))
        self.assertIn("5 s of processor time", endless["message"])
        before = self.records()
        self.study()
        self.assertEqual(self.records(), before)
        self.prepare({**DYNAMIC, "Time/End": "0.1"}, "Time/Step: 1e-9 0.1", Timeout="6")
        self.assertIn("6 s of processor time", self.study()[0]["message"])
        after = self.records()
        self.assertEqual([run for run in after if after[run] != before[run]], [endless["run"]])

    def check_stop(self, how):
        vary = {"vary": "Time/Step: 0.1 0.05 5e-5 0.02", "Reference": "Time/Step=0.01",
                "Repeats": "2"}
        self.prepare(DYNAMIC, **vary)
        process = self.start(lambda process: len(self.records()) >= 3)
        process.send_signal(how)
        message = process.communicate(timeout=300)[1]
        finished = len(self.records())
        self.assertLess(finished, 5, "too late: the first repeat of all runs is there")
        self.assertFalse((self.directory / "out/study.csv").exists())
        rows = self.study()
        self.assertIn(f"{finished} of them are there", self.run_of_study.stdout)
        self.assertEqual([row["status"] for row in rows], ["converged"] * 4)
        stopped = self.timeless()
        shutil.rmtree(self.directory / "out")
        self.study()
        self.assertEqual(self.timeless(), stopped)
        return process.returncode, message, finished

    def test_goes_on_after_a_kill(self):
        self.assertEqual(self.check_stop(signal.SIGKILL)[:2], (-signal.SIGKILL, ""))

    def test_goes_on_after_an_interrupt(self):
        status, message, finished = self.check_stop(signal.SIGINT)
        self.assertEqual(status, 130)
        self.assertEqual(message, f"exemplar: Interrupted after {finished} of 9 runs. The same "
                         "command goes on with the others.\n")

    def test_one_study_at_a_time(self):
        self.prepare({**DYNAMIC, "Time/End": "0.1"}, "Time/Step: 1e-9 0.1")  # a hundred million steps
        process = self.start(lambda process: self.is_running())
        self.study(status=1)
        self.assertIn("Another study is running in the output directory out. Give another",
                      self.run_of_study.stderr)
        [run] = children(process.pid)
        process.kill()
        process.communicate(timeout=300)
        wait_until(lambda: not is_alive(run), seconds=60)  # it would take minutes by itself

    def test_only_what_has_changed_is_run_anew(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.05", Reference="Time/Step=0.01")
        first = self.study()
        before = self.records()
        self.assertEqual(self.study(), first)
        self.assertEqual(self.records(), before)
        self.assertIn("3 of them are there", self.run_of_study.stdout)

        self.prepare(DYNAMIC, "Time/Step: 0.1 0.2", Reference="Time/Step=0.01")
        self.assertEqual(self.study()[0], first[0])
        self.assertIn("1 others are there, of other settings", self.run_of_study.stdout)
        after = self.records()
        self.assertEqual(set(before) - set(after), {first[1]["run"]})
        for run in set(after) & set(before):
            self.assertEqual(after[run], before[run])

        self.prepare({**DYNAMIC, "Material/Density": "1001"}, "Time/Step: 0.1 0.2",
                     Reference="Time/Step=0.01")
        self.study()
        self.assertEqual(set(self.records()) & set(after), set())

    def test_a_changed_input_file_counts(self):
        self.write_box(BAR, "bar.msh")
        scene = {**DYNAMIC, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
                 "Mesh/File": "bar.msh"}
        self.prepare(scene, "Time/Step: 0.1 0.2")
        before = [row["run"] for row in self.study()]
        self.write("bar.msh", (self.directory / "bar.msh").read_text() + "\n")
        after = [row["run"] for row in self.study()]
        self.assertEqual(set(before) & set(after), set())

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_figure(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.05 | Solver/Method: one pass, newton",
                     Reference="Time/Step=0.01")
        self.study()
        figure = (self.directory / "out/study.svg").read_text()
        for words in ("one pass", "newton", "Pareto front", "seconds of time stepping"):
            self.assertIn(f"<text>{words}</text>", figure)
        self.assertEqual(self.run_of_study.stderr, "")

    def test_colours_are_those_of_the_pages(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.05 | Model/Strain: corotational, linear, green", Reference="Time/Step=0.02")
        self.study()
        script = (self.directory / "out/study.gnuplot").read_text()
        sys.path.insert(0, str(REPOSITORY / "doc/scripts"))
        from plots import PALETTE, line
        for number in range(3):
            self.assertIn(f"with {line(number)} title", script)
        source = (REPOSITORY / "source/study/study_report.cc").read_text()
        self.assertEqual(tuple(re.findall('"(#[0-9a-f]{6})"', source)), PALETTE)

    def test_without_gnuplot(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.05", Reference="Time/Step=0.01")
        self.assertEqual(len(self.study(PATH="")), 2)
        self.assertRegex(self.run_of_study.stderr, r"^Warning: There is no gnuplot.*gnuplot-nox")
        self.assertFalse((self.directory / "out/study.svg").exists())
        self.assertIn("| 0.05 | converged |", self.report())

    def test_validate(self):
        self.prepare(DYNAMIC, "Time/Step: 0.1 0.05 | Material/Poisson's ratio: 0.3 0.6",
                     Reference="Time/Step=0.01")
        before = set(self.directory.rglob("*"))
        run = self.call("--validate", "study.prm")
        self.assertEqual((run.status, run.stderr.count("Warning: ")), (0, 1))
        self.assertIn("Warning: Runs will be refused, as their rows will say: study.prm:2, Vary: Material/Poisson's ratio = '0.6'", run.stderr)
        self.assertRegex(run.stdout, "^study.prm: valid; 4 combinations")
        self.assertEqual(set(self.directory.rglob("*")), before)


if __name__ == "__main__":
    unittest.main()
