# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of files while a body is pulled: a scene's files are saved anew, moved and replaced, earlier recordings and poses stay,
and a server that is killed leaves a recording that plays up to the last finished step.

Environment: EXEMPLAR, the program.
"""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from live_client import Viewer
from live_server import BAR, Server, call_program, prm

STEP = 1 / 60


def pose(file):
    """Places of the nodes in an .msh, as text."""
    return Path(file).read_text().split("$Nodes")[1].split("$EndNodes")[0].split("\n", 2)[2]


def save_pose(viewer):
    """(step, file) of the body at rest in time."""
    viewer.send(type="pause", on=True)
    viewer.until(lambda: viewer.wait_for("status")["paused"])
    step = viewer.wait_for("status")["step"]
    viewer.send(type="save pose")
    file = viewer.wait_for("saved")["text"]
    viewer.send(type="pause", on=False)
    return step, file


def drag(viewer, n=10, name="a"):
    viewer.grab(viewer.farthest(), name=name, strength=5.)
    for i in range(n):
        viewer.move((4. - .02 * i, .02 * i, .5 + .03 * i), name=name)
        viewer.wait_steps(1)
    viewer.send(type="release", name=name)


class KilledServer(Server):
    """A server that is expected to be killed."""

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait(timeout=60)
        self.process.stdout.close()


def places_of(file):
    return [tuple(map(float, line.split()[1:])) for line in pose(file).splitlines() if line]


class Recorded:
    """A scene of a mesh in a directory, and the recording of its servers."""

    def __init__(self, here):
        self.here = here
        self.record = here / "session"
        made = here / "made.prm"
        made.write_text(prm({**BAR, "Time/Step": "0.01", "Time/End": "0.01", "Examples/Pose functions": None, "Examples/Importance": None}))
        for name, size in (("bar", "4, 1, 1"), ("other", "3, 1, 1")):
            done = call_program(made, "--output", here / f"out_{name}", "--set", f"Mesh/Box size={size}",
                                "--set", f"Mesh/Box cells={'8' if name == 'bar' else '5'}, 2, 2", timeout=60)
            assert done.returncode == 0, done.stderr
            shutil.copy(here / f"out_{name}/final.msh", here / f"{name}.msh")
        self.mesh = here / "bar.msh"
        self.bytes = self.mesh.read_bytes()
        self.scene = here / "bar.prm"
        self.scene.write_text(prm({**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "bar.msh"}))

    def serve(self, *arguments):
        return Server(self.scene, "--record", self.record, *arguments, log=self.here / "log.txt")

    def play(self, scene="scene.prm", *arguments):
        output = self.here / f"played{len(list(self.here.glob('played*')))}"
        done = call_program(self.record / scene, "--output", output, *arguments, timeout=120)
        assert done.returncode == 0, done.stderr
        return output / "final.msh"

    def play_until(self, step, scene="scene.prm"):
        return self.play(scene, "--set", f"Time/End={step * STEP}")


class FilesTest(unittest.TestCase, Recorded):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        Recorded.__init__(self, Path(temporary.name))

    def test_files_are_read_once(self):
        changes = (lambda: self.mesh.unlink(), lambda: self.mesh.write_bytes(self.bytes[:len(self.bytes) // 2]),
                   lambda: shutil.copy(self.here / "other.msh", self.mesh), lambda: self.scene.unlink(missing_ok=True),
                   lambda: self.mesh.write_bytes(b""))
        with self.serve() as server, Viewer(server) as viewer:
            for change in changes:
                drag(viewer, 3)
                change()
                for command in ("undo", "reset"):
                    viewer.send(type=command)
                    viewer.wait_for("status")
                    n = len(viewer.frames)
                    viewer.until(lambda n=n: len(viewer.frames) > n + 3)
                    if command == "undo":
                        drag(viewer, 2)
            drag(viewer, 5)
            step, saved = save_pose(viewer)
        self.assertEqual([text for text in viewer.texts if text["type"] in ("refused", "warning")], [])
        self.assertEqual(pose(self.play_until(step)), pose(saved))
        for number in range(1, len(changes) + 1):  # each was reset, with something done
            self.play(f"scene_{number:04}.prm")

    def test_recording_has_its_own_inputs(self):
        with self.serve() as server, Viewer(server) as viewer:
            drag(viewer, 5)
            step, saved = save_pose(viewer)
        shutil.copy(self.here / "other.msh", self.mesh)
        moved = self.here / "moved"
        self.record.rename(moved)
        self.record = moved
        self.assertEqual(pose(self.play_until(step)), pose(moved / Path(saved).name))

    def test_earlier_recording_stays(self):
        poses = []
        for _ in range(2):
            with self.serve() as server, Viewer(server) as viewer:
                drag(viewer, 4)
                poses.append(save_pose(viewer))
        self.assertIn("scene_0001.prm", (self.here / "log.txt").read_text())
        self.assertEqual(pose(self.play_until(poses[0][0], "scene_0001.prm")), pose(poses[0][1]))
        self.assertEqual(pose(self.play_until(poses[1][0])), pose(poses[1][1]))

    def test_reset_keeps_what_was_recorded(self):
        with self.serve() as server, Viewer(server) as viewer:
            drag(viewer, 4)
            step, saved = save_pose(viewer)
            viewer.send(type="reset")
            viewer.wait_for("status")
        self.assertEqual(pose(self.play_until(step, "scene_0001.prm")), pose(saved))
        self.assertEqual((self.record / "session.txt").read_text(), "exemplar session 1\n")

    def test_refused_server_changes_nothing(self):
        with self.serve() as server, Viewer(server) as viewer:
            drag(viewer, 2)
        before = {file: file.read_bytes() for file in self.record.rglob("*") if file.is_file()}
        with Server(self.scene, log=self.here / "log2.txt") as other:
            done = call_program("live", self.scene, "--record", self.record, "--port", str(other.port), timeout=60)
        self.assertEqual(done.returncode, 1)
        self.mesh.unlink()
        done = call_program("live", self.scene, "--record", self.record, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertEqual({file: file.read_bytes() for file in self.record.rglob("*") if file.is_file()}, before)

    def test_start_that_fails_late_changes_nothing(self):
        with self.serve() as server, Viewer(server) as viewer:
            drag(viewer, 2)
        before = {file: file.read_bytes() for file in self.record.rglob("*") if file.is_file()}
        shutil.copy(self.here / "other.msh", self.mesh)
        (self.record / "inputs").chmod(0o500)
        if os.geteuid():  # root may write anywhere
            self.assertEqual(call_program("live", self.scene, "--record", self.record, timeout=60).returncode, 1)
        (self.record / "inputs").chmod(0o700)
        self.assertEqual({file: file.read_bytes() for file in self.record.rglob("*") if file.is_file()}, before)
        for name in ("inputs/0123456789abcdef.tmp", "inputs"):  # what a killed start has left
            shutil.rmtree(self.record)
            (self.record / name).mkdir(parents=True)
            with self.serve():
                pass

    def test_second_server_is_refused(self):
        with self.serve() as server, Viewer(server) as viewer:
            drag(viewer, 2)
            done = call_program("live", self.scene, "--record", self.record, timeout=60)
            self.assertEqual(done.returncode, 1)
            self.assertIn("another server records there", done.stderr)
            drag(viewer, 2)
            step, saved = save_pose(viewer)
        self.assertEqual(pose(self.play_until(step)), pose(saved))

    def test_geo_that_takes_in_another(self):
        (self.here / "size.geo").write_text("h = 0.5;\n")
        (self.here / "body.geo").write_text('Include "size.geo";\nSetFactory("OpenCASCADE");\nBox(1) = {0, -.5, -.5, 4, 1, 1};\nMesh.MeshSizeMax = h;\nMesh.MeshSizeMin = h;\n')
        self.scene.write_text(prm({**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "body.geo",
                                   "Handles/left/Select": "box -1 -1 -1 0.1 1 1"}))
        with self.serve() as server, Viewer(server) as viewer:
            drag(viewer, 3)
            step, saved = save_pose(viewer)
        for name in ("size.geo", "body.geo"):
            (self.here / name).unlink()
        self.assertEqual(pose(self.play_until(step)), pose(saved))

    def test_poses_are_not_replaced(self):
        self.record.mkdir()
        (self.record / "pose_0002.msh").write_text("mine")
        with self.serve() as server, Viewer(server) as viewer:
            names = [Path(save_pose(viewer)[1]).name for _ in range(2)]
        self.assertEqual(names, ["pose_0003.msh", "pose_0004.msh"])
        self.assertEqual((self.record / "pose_0002.msh").read_text(), "mine")

    def test_links_are_not_followed(self):
        mine = self.here / "mine.txt"
        mine.write_text("mine")
        with self.serve():
            pass
        for name in ("scene.prm.tmp", "session.txt", "scene.prm"):
            (self.record / name).unlink(missing_ok=True)
            (self.record / name).symlink_to(mine)
            done = call_program("live", self.scene, "--record", self.record, timeout=60)
            self.assertEqual(done.returncode, 1, name)
            self.assertIn(name if name != "scene.prm" else "Nothing has been changed", done.stderr)
            (self.record / name).unlink()
            with Server(self.scene, "--record", self.here / f"new_{name}", log=self.here / "log.txt"):
                pass
            self.record = self.here / f"new_{name}"
        self.assertEqual(mine.read_text(), "mine")

    def test_pipe_is_no_input_of_a_recording(self):
        self.mesh.unlink()
        subprocess.run(["mkfifo", self.mesh], check=True)
        done = call_program("live", self.scene, "--record", self.record, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("no regular file", done.stderr)

    def test_killed_server(self):
        with KilledServer(self.scene, "--record", self.record, log=self.here / "log.txt") as server, Viewer(server) as viewer:
            drag(viewer, 5)
            step, saved = save_pose(viewer)
            viewer.grab(viewer.farthest(), name="b", strength=5.)
            for i in range(15):
                viewer.move((4., .05 * i, .5), name="b")
                viewer.wait_steps(1)
            server.process.kill()
            server.process.wait(timeout=60)
            last = viewer.frames[-1]
        end = float(re.search(r"set End = (\S+)", (self.record / "scene.prm").read_text())[1])
        self.assertGreaterEqual(round(end / STEP), last.step)
        self.assertEqual(pose(self.play_until(step)), pose(saved))
        places = places_of(self.play_until(last.step))
        rounding = max(last.box[3:]) / 32767
        for place in last.places:  # of the surface's vertices
            self.assertTrue(any(all(abs(a - b) <= rounding for a, b in zip(place, other)) for other in places), place)
        self.play()


class SessionTest(unittest.TestCase):
    """Sessions that no server has written so are refused before anything is written; a line that is cut is left out."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.here = Path(temporary.name)
        (cls.here / "scene.prm").write_text(prm({**BAR, "Time/Step": ".02", "Time/End": ".1", "Session/File": "session.txt"}))
        cls.head = "exemplar session 1\n1 | gravity | | | 0 0 -3\n2 | grab | a | 0 | 1 0 0 0 4 0 1 100\n"

    def run_session(self, text, *arguments):
        (self.here / "session.txt").write_bytes(text if isinstance(text, bytes) else text.encode())
        shutil.rmtree(self.here / "out", ignore_errors=True)
        return call_program("scene.prm", "--output", "out", *arguments, cwd=self.here, timeout=60)

    def test_bad_events(self):
        for line, words in (("3 | fly | a | | 1", "cannot be done to a body"), ("3 | move | b | | 1 2 3", "no such spring"),
                            ("3 | move | a | | 1 2", "takes 0 nodes and 3 numbers"), ("3 | hold | h | 2 1 | 0 0 0 0 0 0", "ascending order"),
                            ("3 | hold | h | 99999 | 0 0 0", "no node 99999"), ("3 | shift | h | | 0 0 0", "held by hand"), ("3 | hold | h | 0 | 0 0 0", "holds node 0 already"),
                            ("3 | let go | h | | ", "no handle"), ("3 | young | | | -1", "oung"), ("3 | poisson | | | 0.5", "oisson"),
                            ("3 | density | | | 0", "ensity"), ("3 | importance | | | 2", "mportance"), ("3 | weights | | | 1 2 3 4", "weights"),
                            ("3 | damping | | | -1 0", "damping"), ("3 | release | a | |\n3 | release | a | |", "no such spring"),
                            ("3 | grab | a | 0 | 1 0 0 0 4 0 1 -100", "above 0"), ("3 | grab | " + "x" * 1000 + " | 0 | 1 0 0 0 4 0 1 1", "no name of a session"),
                            ("3 | grab | \x1b[2J | 0 | 1 0 0 0 4 0 1 1", "no name of a session")):
            for arguments in ([], ["--validate"]):
                done = self.run_session(self.head + line + "\n", *arguments)
                message = re.sub(r"\s+", " ", done.stderr)
                self.assertEqual(done.returncode, 1, (line[:60], message))
                self.assertIn(words, message)
                self.assertRegex(message, r"session\.txt:[45]\b")
                self.assertLess(len(message), 600)
                self.assertNotIn("\x1b", done.stderr)
                self.assertFalse((self.here / "out").exists())

    def test_cut_line(self):
        text = self.head + "3 | move | a | | 4.125 0.25 1.5\n"
        whole = self.run_session(self.head)
        self.assertEqual((whole.returncode, "no end" in whole.stderr), (0, False), whole.stderr)
        without = (self.here / "out/final.msh").read_bytes()
        for n in range(1, len("3 | move | a | | 4.125 0.25 1.5\n"), 5):
            done = self.run_session(text[:-n])
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("session.txt:4: the last line has no end", re.sub(r"\s+", " ", done.stderr))
            self.assertEqual((self.here / "out/final.msh").read_bytes(), without)

    def test_no_idle_warning(self):
        done = self.run_session(self.head)
        self.assertNotIn("nothing will happen", done.stderr)


if __name__ == "__main__":
    unittest.main()
