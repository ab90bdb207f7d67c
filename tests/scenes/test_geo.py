# SPDX-License-Identifier: GPL-3.0-or-later
"""A .geo file is a program: it runs confined, does nothing but mesh, and does not outlive the run."""

import os
import shutil
import signal
import subprocess
import time
import unittest

from exemplar_runner import BAR, EXEMPLAR, SceneTest, prm

SCENE = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None,
         "Mesh/File": "box.geo"}
BOX = """Include "size.inc";
Point(1) = {0, 0, 0}; Extrude {length, 0, 0} { Point{1}; Layers{2}; }
Extrude {0, 1, 0} { Curve{1}; Layers{1}; } Extrude {0, 0, 1} { Surface{5}; Layers{1}; }
Physical Volume("body", 1) = {1}; Physical Surface("left", 1) = {14}; Physical Surface("right", 2) = {22};
"""


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return ") Z " not in file.read()
    except FileNotFoundError:
        return False


class GeoTest(SceneTest):
    def setUp(self):
        super().setUp()
        self.environment = {"XDG_CACHE_HOME": str(self.directory / "cache")}
        self.write("size.inc", "length = 2;\n")
        self.write("scene.prm", prm(SCENE))

    def run_with(self, geo, *arguments):
        self.write("box.geo", geo)
        return self.call("scene.prm", "--output", "out", "--quiet", *arguments, **self.environment)


@unittest.skipUnless(shutil.which("gmsh"), "gmsh is not installed")
class RealGmsh(GeoTest):
    def test_a_script_meshes_and_does_nothing_else(self):
        run = self.run_with(BOX)
        self.assertEqual((run.status, run.stderr), (0, ""))
        names = {"box.geo", "cache", "out", "scene.prm", "size.inc"}
        self.assertEqual({file.name for file in self.directory.iterdir()}, names)
        cached = list((self.directory / "cache/exemplar").iterdir())
        self.assertEqual([file.suffix for file in cached], [".msh"])
        self.write("size.inc", "length = 3;\n")  # another mesh, as an included file has changed
        self.assertEqual(self.run_with(BOX).status, 0)
        self.assertEqual(len(list((self.directory / "cache/exemplar").iterdir())), 2)

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
        run = self.run_with(BOX + f'SystemCall "touch {trace}";', "--allow-commands")
        self.assertEqual((run.status, run.stderr), (0, ""))
        self.assertTrue(trace.exists())


class FakeGmsh(GeoTest):
    def setUp(self):
        super().setUp()
        (self.directory / "bin").mkdir()
        script = self.write("bin/gmsh", '#!/bin/sh\nif [ "$1" = --version ]; then echo 4; exit 0; fi\n'
                            f"echo $$ > '{self.directory}/pid.new'; mv '{self.directory}/pid.new' '{self.directory}/pid'\n"
                            "exec sleep 1000\n")
        script.chmod(0o755)
        self.environment["PATH"] = f"{self.directory}/bin:{os.environ['PATH']}"

    def test_gmsh_does_not_outlive_a_run(self):
        self.write("box.geo", BOX)
        for how in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
            for arguments in ([], ["--validate"]):
                pid_file = self.directory / "pid"
                pid_file.unlink(missing_ok=True)
                with subprocess.Popen([EXEMPLAR, "scene.prm", "--output", "out", *arguments], cwd=self.directory,
                                      env={**os.environ, **self.environment}, stdin=subprocess.DEVNULL,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                    while not pid_file.exists():
                        self.assertIsNone(process.poll())
                        time.sleep(0.01)
                    pid = int(pid_file.read_text())
                    process.send_signal(how)
                    process.wait(timeout=60)
                end = time.monotonic() + 30
                while is_alive(pid):
                    self.assertLess(time.monotonic(), end, "gmsh goes on")
                    time.sleep(0.01)


if __name__ == "__main__":
    unittest.main()
