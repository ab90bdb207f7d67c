# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad command lines, studies, output directories and checkpoints: status 1, one message that says what, where, what is
allowed and the remedy, and nothing written."""

import os
import unittest

from bad_inputs import DYNAMIC, FILE, BadInputTest
from exemplar_runner import BAR, prm, read_msh

# name, arguments after a good scene.prm, what stderr must contain
COMMANDS = [
    ("missing scene", ["absent.prm"], ["absent.prm", "cannot be read", "existing .prm"]),
    ("scene is a directory", ["a directory"], ["a directory", "cannot be read", "existing .prm"]),
    ("no scene", [], ["SCENE is required", "--help"]),
    ("unknown option", ["scene.prm", "--outputs", "out"], ["--outputs", "--help"]),
    ("a long name without a dot", ["x" * 5000], ["neither a scene nor a command"]),
    ("two commands", ["verify", "study", "scene.prm"], ["study", "exemplar verify --list"]),
    ("two scenes", ["scene.prm", "scene.prm"], ["scene.prm", "--help"]),
    ("--set without =", ["scene.prm", "--set", "Time/Increments"],
     ["--set 'Time/Increments'", "'='", "Section/Key=value"]),
    ("--set without key", ["scene.prm", "--set", "=3"], ["--set '=3'", "Section/Key=value"]),
    ("--set without value", ["scene.prm", "--set"], ["--set", "--help"]),
    ("--set of an unknown key", ["scene.prm", "--set", "Time/Increment=3"],
     ["--set", "'Time/Increment'", "Did you mean --set \"Time/Increments=3\""]),
    ("--set of a bad value", ["scene.prm", "--set", "Time/Increments=x"],
     ["--set", "Time/Increments = 'x'", "Allowed: an integer"]),
    ("no threads", ["scene.prm", "--threads", "0"], ["--threads", "0", "1 to 1024", "--help"]),
    ("threads in words", ["scene.prm", "--threads", "all"], ["--threads", "all", "1 to 1024"]),
    ("--resume without checkpoint", ["scene.prm", "--output", "out", "--resume"],
     ["out/checkpoint.bin", "no checkpoint", "without --resume"]),
    ("--resume from a broken checkpoint", ["scene.prm", "--output", "broken", "--resume"],
     ["broken/checkpoint.bin", "is damaged", "checksum", "without --resume"]),
    ("output directory of others", ["scene.prm", "--output", "a directory"],
     ["a directory", "not empty", "not written by exemplar", "--output"]),
    ("output directory is a file", ["scene.prm", "--output", "small.msh"],
     ["small.msh", "is a file", "--output"]),
    ("output below a file", ["scene.prm", "--output", "small.msh/out"],
     ["small.msh/out", "is a file", "--output"]),
    ("output where nobody can write", ["scene.prm", "--output", "/proc/exemplar/out"],
     ["/proc/exemplar/out", "cannot be made", "--output"]),
    ("working directory as output", ["scene.prm", "--output", "."], ["not empty", "--output"]),
    ("no study", ["study"], ["STUDY is required", "--help"]),
    ("study that is absent", ["study", "absent.prm"], ["absent.prm", "cannot be read"]),
    ("study run as a scene", ["study.prm"], ["study.prm is a study", "exemplar study study.prm"]),
    ("options of scenes in a study", ["study", "study.prm", "--set", "Time/End=1"],
     ["--set", "set Base = Section/Key=value", "--help"]),
    ("threads of a study", ["study", "study.prm", "--threads", "2"], ["set Threads = 2"]),
    ("resumed study", ["study", "study.prm", "--resume"], ["goes on by itself"]),
    ("output directory of others for a study",
     ["study", "study.prm", "--output", "a directory"],
     ["a directory", "not empty", "no study", "--output"]),
    ("output directory of a run for a study", ["study", "study.prm", "--output", "broken"],
     ["broken", "not empty", "no study", "--output"]),
    ("output of a study is a file", ["study", "study.prm", "--output", "small.msh"],
     ["small.msh", "is a file", "--output"]),
    ("output of a study where nobody can write",
     ["study", "study.prm", "--output", "/proc/exemplar/out"],
     ["/proc/exemplar/out", "cannot be made", "--output"]),
    ("--validate of a bad scene", ["bad.prm", "--validate"], ["Scene = 'statics'"]),
]

STUDY = {"Scene": "scene.prm", "Vary": "Time/Increments: 1 2"}

# name, study (text or keys), what stderr must contain
STUDIES = [
    ("unknown key of a study", {**STUDY, "Repeat": "2"},
     ["study.prm:", "'Repeat'", "Did you mean 'Repeats'"]),
    ("Vary misspelt", {"Scene": "scene.prm", "Vari": "Time/Increments: 1 2"}, ["study.prm:2: a study has no key 'Vari'. Did you mean 'Vary'?"]),
    ("subsection in a study", prm(STUDY) + "subsection Time\nset Increments = 3\nend\n",
     ["study.prm:4: a study has no subsections", "set Base = Time/Increments=3"]),
    ("range", {**STUDY, "Vary": "Time/Increments: 1..4"}, ["study.prm:2, Vary", "'1..4' is no value", "written out, value by value"]),
    ("formulas without quotes", {**STUDY, "Vary": "Handles/left/Motion: 0;0;t 0;0;2*t"}, ["lists '0' twice", "double quotes"]),
    ("joined values without +", {**STUDY, "Vary": "Time/Increments + Solver/Method: 1 newton, 2 newton"}, ["'+', too: 1 + newton."]),
    ("value with blanks", {**STUDY, "Vary": "Solver/Method: one pass newton"},
     ["study.prm:2, Vary", "no value 'one', but 'one pass'", "separated by commas: Solver/Method: one pass,"]),
    ("column that no run has", {**STUDY, "Columns": "energy"}, ["study.prm:3, Columns", "no run has the column 'energy'", "There are: step,", "energy_elastic"]),
    ("column misspelt", {**STUDY, "Columns": "reaction_lfet_z"}, ["study.prm:3, Columns", "Did you mean 'reaction_left_z'?"]),
    ("a scene", prm(BAR), ["study.prm", "Vary is not set", "set Vary ="]),
    ("no scene in a study", {**STUDY, "Scene": None}, ["study.prm", "Scene is not set"]),
    ("absent scene of a study", {**STUDY, "Scene": "absent.prm"},
     ["/absent.prm", "cannot be read", "existing .prm"]),
    ("bad scene of a study", {**STUDY, "Scene": "bad.prm"}, ["Scene = 'statics'"]),
    ("unknown key in Vary", {**STUDY, "Vary": "Time/Increment: 1 2"},
     ["study.prm:2, Vary", "'Time/Increment'", "Did you mean 'Time/Increments'"]),
    ("unknown key in Base", {**STUDY, "Base": "Time/Ends=1"},
     ["study.prm:3, Base", "'Time/Ends'", "Did you mean 'Time/End'"]),
    ("unknown key in Reference", {**STUDY, "Reference": "Time/Ends=1"},
     ["study.prm:3, Reference", "'Time/Ends'", "Did you mean 'Time/End'"]),
    ("unknown handle in Vary", {**STUDY, "Vary": "Handles/top/Motion: t"},
     ["study.prm:2, Vary", "Handles/top", "not in Handles/Names"]),
    ("axis without values", {**STUDY, "Vary": "Time/Increments:"},
     ["study.prm:2, Vary", "Time/Increments has no values", "Section/Key: value"]),
    ("decimal commas in Vary", {**STUDY, "Vary": "Material/Density: 0,3 0,5"},
     ["study.prm:2, Vary: Material/Density", "'0,3 0,5'", "decimal sign is a point", "'0.3 0.5'"]),
    ("axes by commas", {**STUDY, "Vary": "Material/Density: 1 2, Time/Increments: 1 2"},
     ["study.prm:2, Vary: Material/Density", "second key", "'|'"]),
    ("keys of Base by commas", {**STUDY, "Base": "Material/Density=1, Output/Every=1"},
     ["study.prm:3, Base: Material/Density", "second key", "';'"]),
    ("values in brackets", {**STUDY, "Vary": "Material/Density: [1, 2]"}, ["begins with a bracket"]),
    ("axis without colon", {**STUDY, "Vary": "Time/Increments 1 2"},
     ["study.prm:2, Vary", "no ':'", "Section/Key: value"]),
    ("assignment without =", {**STUDY, "Base": "Time/End"},
     ["study.prm:3, Base", "'Time/End'", "no '='", "Section/Key=value"]),
    ("key in Base and Vary", {**STUDY, "Base": "Time/Increments=3"},
     ["study.prm:3, Base", "Time/Increments", "Vary varies it", "Remove"]),
    ("output of a study's runs", {**STUDY, "Base": "Output/Directory=x"},
     ["study.prm:3, Base", "Output/Directory", "Remove", "--output"]),
    ("refused reference", {**STUDY, "Reference": "Material/Poisson's ratio=0.6"},
     ["study.prm:3, Reference", "Material/Poisson's ratio = '0.6'", "0.5"]),
    ("all runs refused", {**STUDY, "Vary": "Material/Poisson's ratio: 0.6 0.7"},
     ["study.prm:2, Vary", "Material/Poisson's ratio = '0.6'", "0.5"]),
    ("mesh of a study", {**STUDY, "Base": "Mesh/Generator=none; Mesh/File=absent.msh",
                         "Reference": "Time/Increments=9"}, ["/absent.msh", "cannot be opened"]),
    ("no repeats", {**STUDY, "Repeats": "0"}, ["Repeats = '0'", "an integer >= 1"]),
    ("negative timeout", {**STUDY, "Timeout": "-1"}, ["Timeout = '-1'", "a number >= 0"]),
]


# every option that takes a number, and what it asks for; unit tests have more texts
POSE = ["pose", "--mesh", "small.msh", "--rest", "a.obj", "--pose", "b.obj", "--output", "out"]
NO_NUMBERS = ["nan", "-inf", "1e400", "0x10", "", " 5", "5 ", "+5", "-1"]
NO_WHOLE_NUMBERS = [*NO_NUMBERS, "1.5", "4294967301"]
NUMBERS = [
    ("--threads", ["scene.prm"], [*NO_WHOLE_NUMBERS, "0", "1025"], "whole number from 1 to 1024"),
    ("--resume-from", ["scene.prm"], [*NO_WHOLE_NUMBERS, "1000000001"], "whole number from 0 to 1000000000"),
    ("--cells", ["mesh", "--surface", "a.obj", "--output", "a.msh"], [*NO_WHOLE_NUMBERS, "9", "10000001"],
     "whole number from 10 to 10000000"),
    ("--attach", POSE, [*NO_NUMBERS, "-0", "1e-400", "9e-4", "1000001"], "number from 0.001 to 1e+06"),
]


class BadInputs(BadInputTest):
    def test_numbers(self):
        self.write("scene.prm", prm(BAR))
        before = self.tree()
        for name, arguments, texts, allowed in NUMBERS:
            for text in texts:
                with self.subTest(name=name, text=text):
                    self.check(self.call(*arguments, f"{name}={text}"), [name, allowed] if text else [name], before)

    def test_commands(self):
        self.write("scene.prm", prm(BAR))
        self.write("study.prm", prm(STUDY))
        before = self.tree()
        for name, arguments, expected in COMMANDS:
            with self.subTest(name):
                self.check(self.call(*arguments), expected, before)

    def test_studies(self):
        self.write("scene.prm", prm(BAR))
        for name, study, expected in STUDIES:
            with self.subTest(name):
                self.write("study.prm", study if isinstance(study, str) else prm(study))
                before = self.tree()
                self.check(self.call("study", "study.prm"), expected, before)
                if "Vary" in study:
                    self.check(self.call("--validate", "study.prm"), expected, before)

    @unittest.skipIf(os.geteuid() == 0, "root writes everywhere")
    def test_output_without_the_right_to_write(self):
        locked = self.directory / "locked"
        locked.mkdir(mode=0o555)
        self.write("scene.prm", prm(BAR))
        self.check(self.call("scene.prm", "--output", "locked/out"),
                   ["locked/out", "no right to write", "--output"], self.tree())

    def test_resume_of_a_changed_scene(self):
        # the pose is an example, too, but not in use
        scene = {**FILE, "Mesh/File": "bar.msh", "Handles/left/Select": "nodes held.txt",
                 "Handles/left/Follow pose": "pose.msh",
                 "Examples/Poses": "pose.msh", "Examples/Importance": "0"}
        nodes = read_msh(self.directory / "bar.msh").nodes
        self.write("pose.msh", (self.directory / "bar.msh").read_text())
        self.write("held.txt", "\n".join(str(n) for n, x in nodes.items() if x[0] == 0))
        good = prm(scene)
        self.solve(good)

        def refused(expected, text=good):
            self.write("scene.prm", text)
            before = self.tree()
            run = self.attempt(text, "--resume")
            self.check(run, ["out/checkpoint.bin", *expected], before)
            return run

        refused(["Material/Density was '1000' and is now '1001'", "Change it back",
                 "Only Time/End", "--resume-from"], prm({**scene, "Material/Density": "1001"}))
        refused(["Handles/left/Progress was 't' and is now 't^2'"],
                prm({**scene, "Handles/left/Progress": "t^2"}))
        refused(["Material/region 1/Density was '(absent)' and is now '1000'"],
                prm({**scene, "Material/region 1/Density": "1000"}))
        for file in ("bar.msh", "held.txt", "pose.msh"):
            original = (self.directory / file).read_text()
            self.write(file, original + "\n")
            run = refused([f"/{file} has changed"])
            self.assertEqual("--resume-from" in run.stderr, file != "bar.msh")  # which takes no other mesh
            self.write(file, original)
        run = refused(["Time/Increments was '2' and is now '4'", "from its start"], prm({**scene, "Time/Increments": "4"}))
        self.assertNotIn("--resume-from", run.stderr)
        with open(self.directory / "out/statistics.csv", "r+") as statistics:
            statistics.truncate(10)
        self.check(self.attempt(good, "--resume"), ["out/statistics.csv", "without --resume"],
                   self.tree())

    def test_resume_from_what_was_damaged(self):
        self.solve(DYNAMIC)
        text = prm(DYNAMIC)
        for name, expected in (("checkpoint.bin", "is damaged"), ("statistics.csv", "has changed")):
            file = self.directory / "out" / name
            whole = file.read_bytes()
            flipped = bytearray(whole)
            flipped[len(whole) // 2] ^= 4
            for kind, content in (("flipped", flipped), ("truncated", whole[:-40]),
                                  ("appended", whole + b"x"), ("empty", b""), (None, None)):
                if name == "statistics.csv" and kind == "appended":
                    continue  # rows behind the checkpoint are those of a run that was killed
                with self.subTest(name, kind=kind):
                    file.unlink()
                    if content is None:
                        file.mkdir()
                        (file / "a file").touch()
                    else:
                        file.write_bytes(content)
                    known = {"flipped": [expected], None: ["is a directory"]}.get(kind, [])
                    try:
                        self.check(self.attempt(text, "--resume"), [name, "without --resume", *known], self.tree())
                    finally:
                        if content is None:
                            (file / "a file").unlink()
                            file.rmdir()
                        file.write_bytes(whole)
        self.solve(DYNAMIC, "--resume")

    def test_resume_beyond_the_end(self):
        self.solve(DYNAMIC)
        changed = prm({**DYNAMIC, "Time/End": "0.1"})
        self.write("scene.prm", changed)
        self.check(self.attempt(changed, "--resume"), ["t = 0.2", "Time/End = 0.1", "later end"],
                   self.tree())


if __name__ == "__main__":
    unittest.main()
