# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing is removed or replaced that no run has written, and a kill at any call leaves a directory that can be used."""

import functools
import os
import re
import shutil
import signal
import subprocess
import unittest
from pathlib import Path

from exemplar_runner import BAR, SceneTest, fork_server, own_words, prm, results

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Material/Young's modulus": "1e4", "Time/Step": "0.1", "Time/End": "0.4",
           "Output/Every": "2"}
OF_FILE = {**DYNAMIC, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "bar.msh"}
OWN = ("original.prm", "parameters.prm", "statistics.csv", "summary.json", "final.msh", "checkpoint.bin",
       "log.txt", "animation.pvd", "frame_0000.vtu", "frame_0002.vtu", "frame_0004.vtu")


def tree(directory):
    """Everything in a directory: content of files, places of links, modes."""
    return {path: (os.readlink(path) if path.is_symlink() else path.read_bytes() if path.is_file() else None,
                   path.lstat().st_mode) for path in Path(directory).rglob("*")}


@functools.lru_cache(maxsize=None)
def strace_works():
    """Whether calls of a run of the program server can be counted and answered by a kill."""
    if fork_server() is None or not shutil.which("strace"):
        return False
    run = fork_server().start(["--version"], Path.cwd(), os.environ, stands_still=True)
    with subprocess.Popen(["strace", "-o", "/dev/null", "-e", "inject=write:signal=KILL:when=1", "-p", str(run.pid)],
                          stderr=subprocess.DEVNULL) as tracer:
        try:
            run.wait_for_tracer(tracer)
        except RuntimeError:
            return False
        return run.end()[0] == -signal.SIGKILL


class DirectoryTest(SceneTest):
    def setUp(self):
        super().setUp()
        self.output = self.directory / "out"

    def assert_refused(self, arguments, *words):
        """Status 1, one message with these words, and nothing changed."""
        before = tree(self.directory)
        run = self.call(*arguments)
        self.assertEqual((run.status, run.stdout), (1, ""), run.stderr)
        self.assertRegex(run.stderr, r"\Aexemplar: [^\n]*\n\Z")
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertEqual(tree(self.directory), before)

    def run_killed(self, prepare, *arguments, follow=True):
        """Run the program again and again, each time killed at another of the system calls that change a directory;
        `prepare` is called before each, and what is yielded after each tells it. `follow`: also threads and children."""
        for call in ("unlink", "unlinkat", "rename", "renameat", "mkdir", "truncate"):
            number = 1
            prepare()
            while self.is_killed(call, number, arguments, follow):
                yield f"{call} {number}"
                number += 1
                prepare()

    def is_killed(self, call, number, arguments, follow):
        """Run the program, killed at so manieth of these calls; whether it came to that."""
        run = fork_server().start(arguments, self.directory, os.environ, stands_still=True)
        with subprocess.Popen(["strace", *(["-f"] if follow else []), "-o", "/dev/null", "-e", f"trace={call}", "-e",
                               f"inject={call}:signal=KILL:when={number}", "-p", str(run.pid)],
                              stderr=subprocess.DEVNULL) as tracer:
            run.wait_for_tracer(tracer)
            status, _, stderr = run.end(300)
        return status != 0 or "KILL" in own_words(stderr.decode())


class WhatIsNotOurs(DirectoryTest):
    def put(self, name, kind):
        """Something of the user's in place of a file of the run, or beside them."""
        file = self.output / name
        if file.exists() and kind != "protected":
            file.unlink()
        if kind == "empty directory":
            file.mkdir()
        elif kind == "directory":
            file.mkdir()
            (file / "thesis.txt").write_text("mine")
        elif kind == "link":
            self.write("mine.txt", "mine")
            file.symlink_to("../mine.txt")
        elif kind == "dangling link":
            file.symlink_to("../nowhere.txt")
        elif kind == "text":
            file.write_text("mine\n")
        elif kind == "pipe":
            os.mkfifo(file)
        elif kind == "protected":
            file.chmod(0o444)

    def test_a_new_run(self):
        things = [(name, kind) for name in (*OWN, "frame_0123.vtu", "frame_12345.vtu", "checkpoint.bin.tmp")
                  for kind in ("directory", "empty directory", "link", "dangling link", "pipe")]
        things += [(name, "text") for name in ("statistics.csv", "summary.json", "final.msh", "animation.pvd",
                                               "frame_0002.vtu", "frame_0123.vtu")]
        things += [(name, "protected") for name in ("final.msh", "frame_0002.vtu", "statistics.csv")]
        self.solve(DYNAMIC)
        shutil.copytree(self.output, self.directory / "kept")
        for name, kind in things:
            with self.subTest(name=name, kind=kind):
                shutil.rmtree(self.output)
                shutil.copytree(self.directory / "kept", self.output)
                self.put(name, kind)
                words = [name, "Move it away"] if name != "parameters.prm" else ["was not written by exemplar"]
                self.assert_refused(["scene.prm", "--output", "out"], "out", *words, "--output")

    def test_a_resumed_run(self):
        self.solve(DYNAMIC)
        shutil.copytree(self.output, self.directory / "kept")
        things = [(name, kind) for name in ("statistics.csv", "final.msh", "checkpoint.bin", "checkpoint.bin.tmp",
                                            "frame_0006.vtu.tmp", "frame_0002.vtu", "frame_0006.vtu", "animation.pvd")
                  for kind in ("directory", "link", "pipe")]
        things += [(name, "text") for name in ("final.msh", "final.msh.tmp", "frame_0002.vtu", "frame_0006.vtu",
                                               "animation.pvd", "summary.json")]
        self.write("scene.prm", prm({**DYNAMIC, "Time/End": "0.6"}))
        for name, kind in things:
            with self.subTest(name=name, kind=kind):
                shutil.rmtree(self.output)
                shutil.copytree(self.directory / "kept", self.output)
                self.put(name, kind)
                self.assert_refused(["scene.prm", "--output", "out", "--resume"], "out", name, "Move it away",
                                    "without --resume")

    def test_names_that_no_run_writes(self):
        self.solve(DYNAMIC)
        mine = ("frame_1.vtu", "frame_00001.vtu", "frame_0001.VTU", "frame_0001.vtk", "frame_0001.vtu.bak", "final.msh~",
                "statistics.csv.tmp.tmp2", "tmp", ".tmp", "study.csv")
        for name in mine:
            (self.output / name).write_text("mine")
        (self.output / "figures").mkdir()
        self.solve(DYNAMIC)
        for name in mine:
            self.assertEqual((self.output / name).read_text(), "mine")
        self.assertTrue((self.output / "figures").exists())

    def test_files_cut_short_when_the_machine_failed(self):
        whole = results(self.solve(DYNAMIC))
        for name in OWN:
            if name != "parameters.prm":
                os.truncate(self.output / name, 7)
        os.truncate(self.output / "frame_0002.vtu", 0)
        self.assertEqual(results(self.solve(DYNAMIC)), whole)


class Inputs(DirectoryTest):
    """A file that the scene names is neither cleared away nor replaced."""

    def setUp(self):
        super().setUp()
        self.write_box(BAR, "bar.msh")
        self.solve(OF_FILE)

    def check(self, keys, name):
        words = ["holds the input file", name, "--output"]
        self.write("second.prm", prm({**OF_FILE, **keys}))
        self.assert_refused(["second.prm", "--output", "out"], *words)
        self.assert_refused(["second.prm", "--output", "./out/../out"], *words)
        (self.directory / "alias").symlink_to("out")
        self.assert_refused(["second.prm", "--output", "alias"], *words)
        (self.directory / "alias").unlink()

    def test_poses_without_importance(self):
        self.check({"Examples/Poses": "out/final.msh", "Examples/Importance": "0"}, "final.msh")
        self.check({"Examples/Poses": "bar.msh, out/final.msh", "Examples/Importance": "0"}, "final.msh")

    def test_all_kinds(self):
        (self.directory / "linked.msh").symlink_to("out/final.msh")
        os.link(self.output / "final.msh", self.directory / "hard.msh")
        shutil.copy(self.directory / "bar.msh", self.output / "final.msh.tmp")
        (self.output / "original.prm").write_text("1\n2\n3\n")
        for keys, name in (({"Examples/Poses": "out/final.msh"}, "final.msh"),
                           ({"Examples/Poses": "linked.msh", "Examples/Importance": "0"}, "linked.msh"),
                           ({"Mesh/File": "out/final.msh.tmp"}, "final.msh.tmp"),
                           ({"Mesh/File": "linked.msh"}, "linked.msh"),
                           ({"Initial/Pose": "out/final.msh"}, "final.msh"),
                           ({"Handles/left/Follow pose": "out/final.msh"}, "final.msh"),
                           ({"Handles/left/Select": "nodes out/original.prm"}, "original.prm")):
            with self.subTest(keys):
                self.check(keys, name)

    def test_the_scene(self):
        self.solve(DYNAMIC)
        for name in ("original.prm", "parameters.prm"):
            self.assert_refused([f"out/{name}", "--output", "out"], f"out/{name}", "clear away")

    def test_a_pose_that_is_not_there_is_not_missed(self):
        self.solve({**OF_FILE, "Examples/Poses": "absent.msh", "Examples/Importance": "0"})

    def test_the_directory_of_the_scene_and_of_its_mesh(self):
        (self.directory / "work").mkdir()
        for name in ("scene.prm", "bar.msh"):
            shutil.copy(self.directory / name, self.directory / "work" / name)
        before = tree(self.directory / "work")
        for output in (".", "work"):
            self.assert_refused(["work/scene.prm", "--output", output], "not empty")
        # also where a run has left its parameters
        shutil.copy(self.output / "parameters.prm", self.directory / "work/parameters.prm")
        run = self.call("work/scene.prm", "--output", "work", "--quiet")
        self.assertEqual((run.status, run.stderr), (0, ""))
        after = tree(self.directory / "work")
        self.assertEqual({file: after[file] for file in before}, before)


class Temporaries(DirectoryTest):
    def test_a_lone_one_does_not_bar_the_directory(self):
        names = ("parameters.prm.tmp", "checkpoint.bin.tmp", "frame_0000.vtu.tmp", "final.msh.tmp")
        for name in names:
            with self.subTest(name):
                self.output.mkdir()
                (self.output / name).write_text("")
                self.solve(DYNAMIC)
                self.assertEqual(sorted(file.name for file in self.output.iterdir()), sorted(OWN))
                shutil.rmtree(self.output)

    def test_with_something_else_it_does(self):
        self.output.mkdir()
        (self.output / "parameters.prm.tmp").write_text("")
        (self.output / "notes.txt").write_text("mine")
        self.write("scene.prm", prm(DYNAMIC))
        self.assert_refused(["scene.prm", "--output", "out"], "not empty")

    def test_what_no_run_has_begun_stays(self):
        self.solve(DYNAMIC)
        (self.output / "final.msh.tmp").write_text("mine")
        self.assert_refused(["scene.prm", "--output", "out"], "final.msh.tmp, which was not written by exemplar")

    def test_of_a_study(self):
        self.write("scene.prm", prm(DYNAMIC))
        self.write("study.prm", prm({"Scene": "scene.prm", "Vary": "Time/Step: 0.1 0.2", "Repeats": "1"}))
        self.output.mkdir()
        (self.output / "study.prm.tmp").write_text("")
        self.assertEqual(self.call("study", "study.prm", "--output", "out", "--quiet"), (0, "", "", None))


class Kills(DirectoryTest):
    def prepare(self, scene):
        """The directory of a run that has ended, with something of the user's."""

        def run():
            self.solve(scene, file="other.prm")
            (self.output / "notes.txt").write_text("mine")

        return run

    @unittest.skipUnless(strace_works(), "no strace here, or no right to it")
    def test_while_a_run_begins(self):
        whole = results(self.solve(DYNAMIC, output="whole"))
        self.write("scene.prm", prm(DYNAMIC))
        words = ["scene.prm", "--output", "out", "--quiet"]
        kills, n_resumed = [], 0
        for kill in self.run_killed(self.prepare({**DYNAMIC, "Time/End": "0.5"}), *words):
            with self.subTest(kill):
                kills.append(kill)
                run = self.call(*words, "--resume")
                if run.status == 0:
                    n_resumed += 1
                    self.assertEqual(results(self.output), whole)
                else:
                    self.assertEqual(run.status, 1)
                    self.assertRegex(run.stderr, "there is no checkpoint to resume from|no step of a run to Time/End")
                self.assertEqual(results(self.solve(DYNAMIC)), whole)
                self.assertEqual((self.output / "notes.txt").read_text(), "mine")
        self.assertGreater(len(kills), 15)
        self.assertGreater(n_resumed, 3)

    @unittest.skipUnless(strace_works(), "no strace here, or no right to it")
    def test_while_a_longer_run_resumes(self):
        # it drops the last frame, which is none of a longer run, and then goes on as the shorter one
        short = {**DYNAMIC, "Time/End": "0.3"}
        whole = results(self.solve(short, output="whole"))
        self.write("long.prm", prm({**DYNAMIC, "Time/End": "0.6"}))
        kills = []
        for kill in self.run_killed(self.prepare(short), "long.prm", "--output", "out", "--quiet", "--resume"):
            with self.subTest(kill):
                kills.append(kill)
                run = self.attempt(short, "--resume")
                if run.status == 0:
                    self.assertEqual(results(self.output), whole)
                else:
                    self.assertIn("which is no step of a run to Time/End = 0.3", run.stderr)
        self.assertGreater(len(kills), 5)

    def test_a_frame_that_is_missing_at_the_checkpoint(self):
        whole = results(self.solve(DYNAMIC))
        (self.output / "frame_0004.vtu").unlink()
        self.assertEqual(results(self.solve(DYNAMIC, "--resume")), whole)


class Copies(DirectoryTest):
    def test_a_copied_directory_is_used_as_the_first(self):
        whole = results(self.solve(DYNAMIC))
        shutil.copytree(self.output, self.directory / "copy")
        self.assertEqual(results(self.solve(DYNAMIC, output="copy")), whole)
        self.assertEqual(results(self.solve(DYNAMIC, "--resume", output="copy")), whole)
        names = {re.sub(r"\d+", "N", file.name) for file in (self.directory / "copy").iterdir()}
        self.assertEqual(names, {re.sub(r"\d+", "N", name) for name in OWN})


if __name__ == "__main__":
    unittest.main()
