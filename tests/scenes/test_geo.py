# SPDX-License-Identifier: GPL-3.0-or-later
"""A .geo file is a program: it runs confined, does nothing but mesh, and does not outlive the run."""

import os
import signal
import subprocess
import unittest

from exemplar_runner import BAR, EXEMPLAR, SceneTest, prm, read_summary, wait_until
from process_table import children, is_alive

SCENE = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
         "Mesh/File": "box.geo"}
BOX = """Include "size.inc";
Point(1) = {0, 0, 0}; Extrude {length, 0, 0} { Point{1}; Layers{2}; }
Extrude {0, 1, 0} { Curve{1}; Layers{1}; } Extrude {0, 0, 1} { Surface{5}; Layers{1}; }
Physical Volume("body", 1) = {1}; Physical Surface("left", 1) = {14}; Physical Surface("right", 2) = {22};
"""


class GeoTest(SceneTest):
    def setUp(self):
        super().setUp()
        self.environment = {"XDG_CACHE_HOME": str(self.directory / "cache")}
        self.write("size.inc", "length = 2;\n")
        self.write("scene.prm", prm(SCENE))

    def run_with(self, geo, *arguments):
        self.write("box.geo", geo)
        return self.call("scene.prm", "--output", "out", "--quiet", *arguments, **self.environment)


class Meshing(GeoTest):
    def cached(self):
        return sorted(file.name for file in (self.directory / "cache/exemplar").iterdir())

    def test_a_script_meshes_and_does_nothing_else(self):
        run = self.run_with(BOX)
        self.assertEqual((run.status, run.stderr), (0, ""))
        names = {"box.geo", "cache", "out", "scene.prm", "size.inc"}
        self.assertEqual({file.name for file in self.directory.iterdir()}, names)
        self.assertRegex("".join(self.cached()), r"\A[0-9a-f]{64}\.msh\Z")
        walls = read_summary(self.directory / "out")["geo_confinement"]
        self.assertEqual(walls[0], "text")
        self.assertIn(walls[1], ("seccomp", "landlock"))
        self.write("size.inc", "length = 3;\n")  # another mesh, as an included file has changed
        self.assertEqual(self.run_with(BOX).status, 0)
        self.assertEqual(len(self.cached()), 2)

    def test_commands_are_refused_unless_allowed(self):
        trace = self.directory / "trace"
        for command in (f'SystemCall "touch {trace}";', f'Printf("x") > "{trace}";', f'Save "{trace}.msh";'):
            for arguments in ((), ("--validate",)):
                with self.subTest(command, arguments=arguments):
                    run = self.run_with(BOX + command, *arguments)
                    self.assertEqual((run.status, run.stdout), (1, ""))
                    self.assertIn("box.geo:5: ", run.stderr)
                    self.assertIn("--allow-commands", run.stderr)
                    self.assertEqual(list(self.directory.glob("trace*")), [])
                    self.assertFalse((self.directory / "out").exists())
        self.assertIn("A scene needs none: remove this line", self.run_with(BOX + 'Save "box.msh";').stderr)
        run = self.run_with(BOX + f'SystemCall "touch {trace}";', "--allow-commands")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertTrue(trace.exists())
        self.assertEqual(read_summary(self.directory / "out")["geo_confinement"], [])

    def test_a_group_of_what_there_is_not(self):
        for select in ("boundary 2", "boundary right"):
            self.write("scene.prm", prm({**SCENE, "Handles/left/Select": select}))
            run = self.run_with(BOX.replace("{22}", "{77}"))
            self.assertEqual(run.status, 1)
            self.assertIn("gmsh leaves out, without a word, a group of which no surface or volume exists", run.stderr)

    def test_what_a_script_lacks(self):
        for geo, words in (("Box(1) = {0, 0, 0, 1, 1, 1};\n", 'Write as its first line: SetFactory("OpenCASCADE");'),
                           ("Point(1) = {0, 0, 0}; Extrude {1, 0, 0} { Point{1}; } Extrude {0, 1, 0} { Curve{1}; }\n",
                            "box.geo: has no tetrahedra. It needs a Volume: Extrude a surface")):
            run = self.run_with(geo)
            self.assertEqual(run.status, 1, run.stderr)
            self.assertIn(words, run.stderr)

    def test_a_disguised_script_is_no_data(self):
        trace = self.directory / "trace"
        self.write("part.obj", f'SystemCall "touch {trace}";')
        run = self.run_with('Merge "part.obj";', "--validate")
        self.assertEqual(run.status, 1)
        self.assertIn("part.obj:1: the command SystemCall", run.stderr)
        self.assertFalse(trace.exists())

    def test_options_at_home_are_not_read(self):
        trace = self.directory / "trace"
        home = self.directory / "home"
        home.mkdir()
        for name in (".gmshrc", ".gmsh-options"):
            (home / name).write_text(f'SystemCall "touch {trace}";\n')
        self.environment["HOME"] = str(home)
        for arguments in ((), ("--allow-commands",)):
            self.assertEqual(self.run_with(BOX, *arguments).status, 0)
            self.assertFalse(trace.exists())

    def test_a_relative_home_is_no_place_for_the_cache(self):
        self.environment = {"XDG_CACHE_HOME": "", "HOME": "relative"}
        run = self.run_with(BOX)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn("XDG_CACHE_HOME", run.stderr)
        self.assertFalse((self.directory / "relative").exists())


class Ending(GeoTest):
    def test_gmsh_does_not_outlive_a_run(self):
        self.write("box.geo", "For i In {1:1e9}\nx = i;\nEndFor\n")
        for how in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
            for arguments in ([], ["--validate"]):
                with subprocess.Popen([EXEMPLAR, "scene.prm", "--output", "out", *arguments], cwd=self.directory,
                                      env={**os.environ, **self.environment}, stdin=subprocess.DEVNULL,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                    wait_until(lambda: children(process.pid), process)
                    mesher, *_ = children(process.pid)
                    process.send_signal(how)
                    process.wait(timeout=60)
                wait_until(lambda: not is_alive(mesher), seconds=30)


if __name__ == "__main__":
    unittest.main()
