# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded session is a scene: it ends in the same bytes, with undo, pins and changed numbers; and it goes to other solvers and elements.

Environment: EXEMPLAR, the program.
"""
import re
import tempfile
import unittest
from pathlib import Path

from live_client import Viewer
from live_server import BAR, Server, call_program, prm


def pose(file):
    """Places of the nodes in an .msh, as text."""
    return file.read_text().split("$Nodes")[1].split("$EndNodes")[0].split("\n", 2)[2]


def numbers(file):
    return [float(word) for line in pose(file).splitlines() if line for word in line.split()[1:]]


class RecordingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """One session with all that a hand can do; its last pose is saved."""
        cls.directory = tempfile.TemporaryDirectory()
        cls.here = Path(cls.directory.name)
        (cls.here / "bar.prm").write_text(prm(BAR))
        cls.record = cls.here / "session"
        with Server(cls.here / "bar.prm", "--record", cls.record, log=cls.here / "log.txt") as server, Viewer(server) as viewer:
            cls.drag(viewer)
            viewer.send(type="pause", on=True)
            viewer.until(lambda: viewer.wait_for("status")["paused"])
            viewer.send(type="save pose")
            cls.saved = Path(viewer.wait_for("saved")["text"])
            cls.step = viewer.wait_for("status")["step"]
            cls.warnings = [text for text in viewer.texts if text["type"] in ("warning", "refused")]

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    @staticmethod
    def drag(viewer):
        hit = viewer.farthest()
        viewer.grab(hit, strength=5.)
        for i in range(30):
            viewer.move((4. - .02 * i, .02 * i, .5 + .03 * i))
            viewer.wait_steps(1)
        viewer.send(type="release", name="a")
        viewer.send(type="gravity", numbers=[0., 0., -3.])
        viewer.send(type="damping", numbers=[1., .001])
        viewer.wait_steps(10)
        viewer.grab(viewer.farthest(), hard=True)
        viewer.move((3.5, 0., 1.))
        viewer.wait_steps(15)
        viewer.send(type="undo")
        viewer.wait_for("status")
        n = len(viewer.frames)
        viewer.until(lambda: len(viewer.frames) > n + 5)
        viewer.grab(viewer.farthest(), hard=True, name="b")
        viewer.move((3.8, 0., .7), name="b")
        viewer.wait_steps(10)
        viewer.send(type="pin", name="1", vertices=[i for i, place in enumerate(viewer.frames[-1].places) if 1.4 < place[0] < 2.2])
        viewer.send(type="set", name="young", numbers=[5e5])
        viewer.send(type="set", name="importance", numbers=[.5])
        viewer.send(type="energy", name="mixed")
        viewer.send(type="weights", numbers=[.3, .7])
        viewer.wait_steps(10)
        viewer.send(type="release", name="b")
        viewer.send(type="handle", name="left", numbers=[0., .1, 0.])
        viewer.wait_steps(10)
        viewer.send(type="weights", numbers=[])
        viewer.send(type="unpin", name="1")
        viewer.send(type="set", name="poisson", numbers=[.3])
        viewer.wait_steps(10)

    def play(self, output, *arguments):
        done = call_program(self.record / "scene.prm", "--output", self.here / output, *arguments, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.here / output

    def test_nothing_was_refused(self):
        self.assertEqual(self.warnings, [])

    def test_same_bytes(self):
        output = self.play("same", "--threads", "1")
        self.assertEqual((output / "statistics.csv").read_text().splitlines()[-1].split(",")[0], str(self.step))
        self.assertEqual(pose(output / "final.msh"), pose(self.saved))
        rows = [line.count(",") for line in (output / "statistics.csv").read_text().splitlines()]  # also of what was held later
        self.assertEqual(set(rows), {rows[0]}, rows)
        again = self.play("threads", "--threads", "2")
        self.assertEqual((again / "final.msh").read_bytes(), (output / "final.msh").read_bytes())

    def test_steps_are_those_of_hands(self):
        keys = [line.strip() for line in (self.record / "scene.prm").read_text().splitlines()]
        for key in ("set Step = 0.016666666666666666", "set Background factor = true", "set Prediction order = 3", "set Every = 2"):
            self.assertIn(key, keys)

    def test_session_is_text(self):
        lines = (self.record / "session.txt").read_text().splitlines()
        self.assertEqual(lines[0], "exemplar session 1")
        words = {line.split(" | ")[1] for line in lines[1:]}
        self.assertTrue({"grab", "move", "release", "hold", "shift", "let go", "gravity", "damping", "young", "poisson", "importance", "energy", "weights"} <= words, words)

    def test_other_tolerance_and_elements(self):
        exact = numbers(self.play("exact", "--set", "Solver/Method=newton") / "final.msh")
        live = numbers(self.saved)
        self.assertLess(max(abs(a - b) for a, b in zip(exact, live)), .02)
        self.assertTrue(exact != live)
        quadratic = numbers(self.play("quadratic", "--set", "Model/Element=P2") / "final.msh")
        self.assertLess(max(abs(a - b) for a, b in zip(quadratic, live)), 1.)

    def test_resume(self):
        half = self.play("resumed", "--set", f"Time/End={self.step // 2 / 60}")
        self.play("resumed", "--resume")
        self.assertEqual(pose(half / "final.msh"), pose(self.saved))

    def test_pose_is_an_example(self):
        scene = self.here / "example.prm"
        scene.write_text(prm({**BAR, "Examples/Pose functions": None, "Examples/Poses": self.saved}))
        done = call_program("--validate", scene, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_bad_sessions(self):
        good = (self.record / "session.txt").read_text()
        scene = (self.record / "scene.prm").read_text()
        for i, (text, words) in enumerate(((good.replace("exemplar session 1", "x"), "does not begin with"),
                                           (good + "3 | move\n", "STEP | WHAT"), (good + "1 | release | a | |\n", "must ascend"),
                                           (good + "9999 | move | a | | 1 2 x\n", "'x' is no number"), (good + "0 | move | a | | 1 2 3\n", "no number of a step"))):
            directory = self.here / f"bad{i}"
            directory.mkdir()
            (directory / "session.txt").write_text(text)
            (directory / "scene.prm").write_text(scene)
            done = call_program(directory / "scene.prm", "--output", directory / "out", timeout=60)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn(words, re.sub(r"\s+", " ", done.stderr))
            self.assertFalse((directory / "out").exists())

    def test_recording_is_not_live_again(self):
        done = call_program("live", self.record / "scene.prm", timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn("recorded session", done.stderr)


if __name__ == "__main__":
    unittest.main()
