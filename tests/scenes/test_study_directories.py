# SPDX-License-Identifier: GPL-3.0-or-later
"""A study removes and replaces nothing that it has not made."""

import shutil
import unittest

from exemplar_runner import BAR, prm
from test_directories import DirectoryTest, strace_works, tree

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Material/Young's modulus": "1e4", "Time/Step": "0.1", "Time/End": "0.4"}
HEX = "0123456789abcdef"
STUDY = ["study", "study.prm", "--output", "out"]


class StudyDirectories(DirectoryTest):
    def setUp(self):
        super().setUp()
        self.runs = self.output / "runs"
        self.write("scene.prm", prm(DYNAMIC))
        self.prepare("0.1 0.2")
        self.study()

    def prepare(self, steps, **keys):
        self.write("study.prm", prm({"Scene": "scene.prm", "Vary": f"Time/Step: {steps}", "Repeats": "1", **keys}))

    def study(self, words=None):
        """Run the study, with a warning that has these words, or without one."""
        run = self.call(*STUDY, "--quiet")
        self.assertEqual((run.status, run.stdout), (0, ""), run.stderr)
        if words is None:
            self.assertEqual(run.stderr, "")
        for word in words or []:
            self.assertIn(word, run.stderr)

    def names(self):
        return {run.name for run in self.runs.iterdir()}

    def test_what_looks_like_a_run_stays(self):
        # a folder with the name of a run, empty, of texts, and a copy of a run without its record; a file; a link
        (self.runs / HEX).mkdir()
        (self.runs / HEX[::-1]).mkdir()
        (self.runs / HEX[::-1] / "thesis.txt").write_text("mine")
        (self.runs / ("a" * 16)).write_text("mine")
        (self.directory / "elsewhere").mkdir()
        (self.directory / "elsewhere/thesis.txt").write_text("mine")
        (self.runs / ("b" * 16)).symlink_to("../../elsewhere")
        (self.runs / "my plots").mkdir()
        before = {name: tree(self.runs / name) for name in self.names()}
        mine = {HEX, HEX[::-1], "a" * 16, "b" * 16, "my plots"}
        self.prepare("0.1 0.05")
        self.study()
        self.assertLess(mine, self.names())
        self.assertEqual(len(self.names() - mine), 2)  # that of 0.2 has gone
        for name in mine:
            self.assertEqual(tree(self.runs / name), before[name])

    def test_a_run_to_which_something_was_added_stays(self):
        for run in self.runs.iterdir():
            (run / "notes.txt").write_text("mine")
        before = {name: tree(self.runs / name) for name in self.names()}
        self.prepare("0.05 0.025")
        self.study(["Warning: ", "holds notes.txt, which no run writes", "stays"])
        for name, content in before.items():
            self.assertEqual(tree(self.runs / name), content)
        self.assertEqual(len(self.names()), 4)

    def test_inputs_in_the_directory(self):
        run = next(self.runs.iterdir())
        shutil.copytree(run, self.runs / HEX)
        (self.runs / "running").mkdir()
        shutil.copy(run / "original.prm", self.runs / "running/original.prm")
        for place in (f"runs/{run.name}", f"runs/{HEX}", "runs/running"):
            with self.subTest(place):
                self.prepare("0.1 0.2", Scene=f"out/{place}/original.prm")
                self.assert_refused(STUDY, "holds the input file", f"{place}/original.prm", "--output")
        (self.directory / "linked.prm").symlink_to(f"out/runs/{HEX}/original.prm")
        self.prepare("0.1 0.2", Scene="linked.prm")
        self.assert_refused(STUDY, "holds the input file", "linked.prm")
        shutil.rmtree(self.runs / "running")

        self.write_box(BAR, "bar.msh")
        shutil.copy(self.directory / "bar.msh", self.runs / HEX / "final.msh")
        for base in (f"Examples/Poses=out/runs/{HEX}/final.msh; Examples/Importance=0",
                     f"Mesh/Generator=none; Mesh/File=out/runs/{HEX}/final.msh"):
            with self.subTest(base):
                self.prepare("0.1 0.2", Base=base)
                self.assert_refused(STUDY, "holds the input file", "final.msh", "--output")
        self.prepare("0.1 0.2")
        self.assert_refused(["study", "out/study.prm", "--output", "out"], "out/")

    def test_an_input_beside_the_runs(self):
        (self.runs / "scenes").mkdir()
        shutil.copy(self.directory / "scene.prm", self.runs / "scenes/scene.prm")
        self.prepare("0.1 0.2", Scene="out/runs/scenes/scene.prm")
        self.study()
        self.assertTrue((self.runs / "scenes/scene.prm").exists())

    def test_what_stands_in_place_of_results(self):
        for name, kind in (("study.csv", "directory"), ("study.csv", "text"), ("study.csv.tmp", "text"), ("study.md", "text"), ("study.svg", "link"),
                           ("study.md.tmp", "directory"), ("study.gnuplot", "text"), ("runs/gnuplot.log", "directory")):
            with self.subTest(name=name, kind=kind):
                file = self.output / name
                kept = file.read_bytes() if file.exists() else None
                file.unlink(missing_ok=True)
                if kind == "directory":
                    file.mkdir()
                elif kind == "link":
                    file.symlink_to("../mine.txt")
                else:
                    file.write_text("mine")
                self.assert_refused(STUDY, file.name, "Move it away", "--output")
                if kind == "directory":
                    file.rmdir()
                else:
                    file.unlink()
                if kept is not None:
                    file.write_bytes(kept)
        self.study()

    def test_where_a_run_is_to_be_made(self):
        run = next(self.runs.iterdir())
        (run / "record.json").unlink()
        (run / "notes.txt").write_text("mine")
        self.assert_refused(STUDY, run.name, "holds notes.txt", "Move away")
        (run / "notes.txt").unlink()
        self.study()
        (self.runs / "running").mkdir()
        (self.runs / "running/thesis.txt").write_text("mine")
        self.assert_refused(STUDY, "running", "holds thesis.txt", "Move away")

    def test_a_run_in_its_directory(self):
        self.assert_refused(["scene.prm", "--output", "out"], "out holds a study. Give another one")

    def test_runs_is_a_file(self):
        shutil.rmtree(self.runs)
        self.runs.write_text("mine")
        self.assert_refused(STUDY, "runs", "no directory")

    def test_a_record_that_is_none(self):
        run = next(self.runs.iterdir())
        text = (run / "record.json").read_text()
        for record in ("", "{", "[]", "null", text.replace('"seconds": [', '"seconds": [], "x": ['), text.replace("0", "-")):
            with self.subTest(record):
                (run / "record.json").write_text(record)
                if not record.startswith("{"):
                    (run / "record.json").unlink()
                self.study()
                self.assertEqual(len((self.output / "study.csv").read_text().splitlines()), 3)

    @unittest.skipUnless(strace_works(), "no strace here, or no right to it")
    def test_kills(self):
        rows = self.rows()

        def prepare():
            self.prepare("0.05")
            self.study()
            self.prepare("0.1 0.2")

        kills = []
        for kill in self.run_killed(prepare, *STUDY, "--quiet", follow=False):
            with self.subTest(kill):
                kills.append(kill)
                self.study()
                self.assertEqual(self.rows(), rows)
                self.assertEqual(len(self.names()), 2)
        self.assertGreater(len(kills), 15)

    def rows(self):
        """study.csv without what differs from run to run."""
        lines = [line.split(",") for line in (self.output / "study.csv").read_text().splitlines()]
        kept = [i for i, name in enumerate(lines[0]) if not name.startswith(("seconds_", "peak_memory"))]
        return [[line[i] for i in kept] for line in lines]


if __name__ == "__main__":
    unittest.main()
