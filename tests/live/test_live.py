# SPDX-License-Identifier: GPL-3.0-or-later
"""A body is pulled over a WebSocket: it follows, lets go, pauses, is reset, keeps its hands' marks for others, and bears bad messages.

Environment: EXEMPLAR, the program.
"""
import random
import resource
import string
import tempfile
import unittest
from pathlib import Path

from live_client import Closed, Viewer
from live_server import BAR, Server, prm


class LiveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.scene = Path(cls.directory.name) / "bar.prm"
        cls.scene.write_text(prm({**BAR, "Examples/Energy": "mixed"}))  # so that it comes back when it is released
        cls.server = Server(cls.scene, log=Path(cls.directory.name) / "log.txt")

    @classmethod
    def tearDownClass(cls):
        cls.server.__exit__()
        cls.directory.cleanup()

    def viewer(self):
        viewer = Viewer(self.server)
        self.addCleanup(viewer.socket.close)
        viewer.send(type="pause", on=True)  # or a slow machine might not see the first steps
        viewer.send(type="reset")
        viewer.until(lambda: viewer.frames[-1].step == 0 and viewer.frames[-1].number)
        viewer.send(type="pause", on=False)
        return viewer

    def end_of_bar(self, viewer):
        return max(place[0] for place in viewer.frames[-1].places), viewer.farthest()[2][2]

    def test_scene_and_topology(self):
        viewer = self.viewer()
        self.assertEqual(viewer.scene["examples"][0], "rest pose")
        self.assertEqual(len(viewer.poses), len(viewer.scene["examples"]))
        self.assertEqual(len(viewer.triangles), viewer.scene["triangles"])
        edges = {}
        for triangle in viewer.triangles:  # closed, and turned alike: each edge once to and once fro
            for a, b in zip(triangle, triangle[1:] + triangle[:1]):
                edges[a, b] = edges.get((a, b), 0) + 1
        self.assertTrue(all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items()))
        places = viewer.frames[-1].places
        volume = 0.
        for a, b, c in viewer.triangles:
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = places[a], places[b], places[c]
            volume += (ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)) / 6
        self.assertAlmostEqual(volume, 4., delta=.01)  # outwards
        self.assertEqual(min(x for x, _, _ in places), 0.)

    def test_pull_follows_and_recovers(self):
        viewer = self.viewer()
        hit = viewer.farthest()
        rest = hit[2]
        viewer.grab(hit, strength=10., sequence=7)
        viewer.move((rest[0], rest[1], rest[2] + 1.5), sequence=8)
        viewer.wait_steps(60)
        self.assertEqual(viewer.frames[-1].pointer, 8)
        self.assertGreater(viewer.farthest(2)[2][2], rest[2] + .5)
        self.assertGreater(viewer.wait_for("status")["weights"][-1], .05)
        viewer.send(type="release", name="a")
        viewer.send(type="damping", numbers=[10., 0.])
        viewer.wait_steps(240)
        self.assertAlmostEqual(viewer.farthest()[2][0], 4., delta=.1)

    def test_hard_grab_is_where_the_pointer_is(self):
        viewer = self.viewer()
        triangle, shares, place = hit = viewer.farthest()
        viewer.grab(hit, hard=True)
        goal = (place[0] - .3, place[1], place[2] + .4)
        viewer.move(goal)
        viewer.wait_steps(150)
        corners = viewer.triangles[triangle]
        at = [sum(s * viewer.frames[-1].places[i][c] for s, i in zip(shares, corners)) for c in range(3)]
        for found, wanted in zip(at, goal):
            self.assertAlmostEqual(found, wanted, delta=2e-4)
        viewer.send(type="release", name="a")
        viewer.wait_steps(5)

    def test_pins_stay_until_let_go(self):
        viewer = self.viewer()
        hit = viewer.farthest()
        vertices = [i for i, place in enumerate(viewer.frames[-1].places) if abs(place[0] - 2.) < .01]
        viewer.send(type="pin", name="1", vertices=vertices)
        viewer.grab(hit, strength=10.)
        viewer.move((3., 0., 2.))
        before = [viewer.frames[-1].places[i] for i in vertices]
        viewer.wait_steps(30)
        after = [viewer.frames[-1].places[i] for i in vertices]
        self.assertLess(max(abs(x - y) for a, b in zip(before, after) for x, y in zip(a, b)), 3e-3)
        viewer.send(type="unpin", name="1")
        viewer.wait_steps(20)
        after = [viewer.frames[-1].places[i] for i in vertices]
        self.assertGreater(max(abs(x - y) for a, b in zip(before, after) for x, y in zip(a, b)), .02)

    def test_handle_is_moved(self):
        viewer = self.viewer()
        left = viewer.scene["handles"][0]["vertices"]
        before = min(viewer.frames[-1].places[i][2] for i in left)
        viewer.send(type="handle", name="left", numbers=[0., 0., .25])
        viewer.wait_steps(120)
        self.assertAlmostEqual(min(viewer.frames[-1].places[i][2] for i in left), before + .25, delta=1e-3)

    def test_pause_step_undo_reset(self):
        viewer = self.viewer()
        viewer.send(type="pause", on=True)
        viewer.until(lambda: viewer.wait_for("status")["paused"])
        step = viewer.wait_for("status")["step"]
        self.assertEqual(viewer.wait_for("status")["step"], step)
        viewer.send(type="step")
        viewer.send(type="step")
        viewer.until(lambda: viewer.wait_for("status")["step"] == step + 2)
        viewer.grab(viewer.farthest())
        viewer.send(type="pause", on=False)
        viewer.wait_steps(10)
        viewer.send(type="undo")
        viewer.until(lambda: viewer.frames[-1].step == step + 2)
        viewer.send(type="undo")
        self.assertIn("nothing is kept", viewer.wait_for("refused")["text"])
        viewer.send(type="reset")
        viewer.until(lambda: viewer.frames[-1].step == 0)

    def test_full_disk_costs_undo_alone(self):
        with Server(self.scene, log=Path(self.directory.name) / "full.txt") as server, Viewer(server) as viewer:
            viewer.wait_steps(10)  # so that the solver knows something
            resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (5000, 5000))  # less than that
            top = max(z for _, _, z in viewer.frames[-1].places)
            viewer.grab(viewer.farthest())
            self.assertIn("Undo does not come back to here", viewer.wait_for("warning")["text"])
            viewer.move((4., 0., 1.))
            viewer.wait_steps(10)
            self.assertGreater(max(z for _, _, z in viewer.frames[-1].places), top + .02)
            viewer.send(type="undo")
            self.assertIn("nothing is kept", viewer.wait_for("refused")["text"])

    def test_weights_by_hand(self):
        viewer = self.viewer()
        self.assertTrue(viewer.scene["finds_weights"] and not viewer.scene["weights_add"])
        self.assertFalse(viewer.wait_for("status")["weights_by_hand"])
        viewer.send(type="damping", numbers=[10., 0.])
        viewer.send(type="weights", numbers=[.25, .75])
        viewer.wait_steps(120)
        status = viewer.wait_for("status")
        self.assertTrue(status["weights_by_hand"])
        self.assertEqual([round(weight, 12) for weight in status["weights"]], [.25, .75])
        self.assertGreater(viewer.farthest()[2][2], .7)  # it bends by itself, as that example does
        for wrong in ([1.], [.5, .6], [-.5, 1.5], [.5, .25, .25]):
            viewer.send(type="weights", numbers=wrong)
            self.assertIn("sum 1", viewer.wait_for("refused")["text"])
        viewer.send(type="weights", numbers=[])
        viewer.wait_steps(240)
        status = viewer.wait_for("status")
        self.assertFalse(status["weights_by_hand"])
        self.assertLess(status["weights"][1], .6)  # found by the steps, and falling
        viewer.send(type="weights", numbers=[1., 0.])
        viewer.send(type="reset")
        viewer.until(lambda: not viewer.wait_for("status")["weights_by_hand"])

    def test_keys_that_add_up_by_hand(self):
        scene = Path(self.directory.name) / "keys.prm"
        scene.write_text(prm({**BAR, "Examples/Pose functions": BAR["Examples/Pose functions"] + " | 1.2*x; y; z", "Examples/Weights": "additive"}))
        with Server(scene, log=Path(self.directory.name) / "keys.txt") as server, Viewer(server) as viewer:
            self.assertTrue(viewer.scene["finds_weights"] and viewer.scene["weights_add"])
            self.assertEqual(viewer.scene["examples"], ["example 1", "example 2"])
            viewer.send(type="weights", numbers=[.75, 1.])
            viewer.wait_steps(120)
            self.assertEqual([round(weight, 12) for weight in viewer.wait_for("status")["weights"]], [.75, 1.])
            for wrong in ([1.], [.5, 1.1], [-.5, 1.], [0., .5, .5]):
                viewer.send(type="weights", numbers=wrong)
                self.assertIn("one a key, between 0 and 1", viewer.wait_for("refused")["text"])
            viewer.send(type="weights", numbers=[])
            viewer.until(lambda: not viewer.wait_for("status")["weights_by_hand"])

    def test_numbers_are_set_and_refused(self):
        viewer = self.viewer()
        viewer.send(type="gravity", numbers=[0., 0., -10.])
        viewer.wait_steps(20)
        self.assertLess(viewer.farthest()[2][2], .99)
        for name, value in (("young", -1.), ("young", 1e40), ("poisson", .5), ("importance", 0.), ("directory", 1.)):
            viewer.send(type="set", name=name, numbers=[value])
            self.assertIn("refused", viewer.wait_for("refused")["type"])
        for name, value in (("young", 2e6), ("poisson", .3), ("importance", .5)):
            viewer.send(type="set", name=name, numbers=[value])
        viewer.wait_steps(5)
        self.assertFalse([text for text in viewer.texts if text["type"] == "warning"])

    def test_colours(self):
        viewer = self.viewer()
        viewer.send(type="gravity", numbers=[0., 0., -10.])
        for field in ("energy", "det F", "pose 0"):
            viewer.send(type="colour", name=field)
            viewer.until(lambda: viewer.frames[-1].has_colours)
            viewer.wait_steps(3)
            frame = viewer.frames[-1]
            self.assertEqual(len(frame.colours), len(frame.places))
            self.assertLess(frame.low, frame.high)
            self.assertEqual((min(frame.colours), max(frame.colours)), (0, 255))
        viewer.send(type="colour", name="none")
        viewer.until(lambda: not viewer.frames[-1].has_colours)

    def test_slow_viewer_gets_two_frames_and_the_newest(self):
        viewer = self.viewer()
        other = Viewer(self.server)
        self.addCleanup(other.socket.close)
        other.acknowledges = False
        n = len(other.frames)
        for _ in range(20):  # statuses of two seconds
            other.wait_for("status")
        self.assertLessEqual(len(other.frames) - n, 2)
        other.send_raw(f"ack {other.frames[-1].number}".encode())
        n, before = len(other.frames), other.frames[-1].step
        other.until(lambda: len(other.frames) > n)
        self.assertGreater(other.frames[n].step, before + 30)
        viewer.send(type="pause", on=False)

    def test_one_holds_the_mouse(self):
        first, second = self.viewer(), Viewer(self.server)
        self.addCleanup(second.socket.close)
        self.assertFalse([text for text in second.texts if text["type"] == "mouse"][-1]["yours"])
        second.grab(second.farthest())
        self.assertIn("mouse", second.wait_for("refused")["text"])
        first.grab(first.farthest())
        first.move((4., 0., 3.))
        second.send(type="take mouse")
        self.assertTrue(second.wait_for("mouse")["yours"])
        first.until(lambda: not [text for text in first.texts if text["type"] == "mouse"][-1]["yours"])
        second.grab(second.farthest(), name="a")  # free, as what the other held was let go of
        second.move((4., 0., 0.), sequence=3)
        second.until(lambda: second.frames[-1].pointer == 3)

    def test_disconnect_in_mid_drag(self):
        viewer = self.viewer()
        viewer.grab(viewer.farthest(), strength=10.)
        viewer.move((4., 0., 3.))
        viewer.wait_steps(30)
        viewer.socket.close()
        other = Viewer(self.server)
        self.addCleanup(other.socket.close)
        other.until(lambda: [text for text in other.texts if text["type"] == "mouse"][-1]["yours"])
        other.send(type="damping", numbers=[1.5, 0.])  # more would only slow it
        other.wait_steps(240)
        self.assertAlmostEqual(other.farthest()[2][0], 4., delta=.1)

    def test_bad_messages(self):
        viewer = self.viewer()
        bad = ["", "x", "[]", "{}", "null", '{"type":1}', '{"type":"fly"}', '{"type":"grab"}', '{"type":"move","name":"a","numbers":[1,2]}',
               '{"type":"move","name":"a","numbers":[1,2,"x"]}', '{"type":"move","name":"a","numbers":[1,2,1e999]}', "[" * 60000,
               '{"type":"pin","name":"p|q","vertices":[1]}', '{"type":"pin","name":"p","vertices":[-1]}', "ack", "ack -1", "ack x",
               '{"type":"save pose"}', '{"type":"move","name":"a","numbers":[0,0,0]}', '{"type":"pin","name":"p","vertices":[99999]}',
               '{"type":"grab","name":"a","triangle":99999,"on":false,"numbers":[1,0,0,0,0,0,1]}',
               '{"type":"grab","name":"a","triangle":0,"on":false,"numbers":[2,-1,0,0,0,0,1]}',
               '{"type":"grab","name":"a","triangle":0,"on":false,"numbers":[1,0,0,1e9,0,0,1]}',
               '{"type":"grab","name":"a","triangle":0,"on":false,"numbers":[1,0,0,0,0,0,0]}',
               '{"type":"handle","name":"right","numbers":[0,0,0]}', '{"type":"unpin","name":"nobody"}', '{"type":"let go of all"}']
        for message in bad:
            viewer.send_raw(message.encode())
            self.assertTrue(viewer.wait_for("refused")["text"], message)
        viewer.wait_steps(3)

    def test_messages_that_break_the_protocol(self):
        for payload, opcode, code in ((b"x" * 70000, 1, 1009), (b"\xff\xfe", 1, 1007), (b"x", 2, 1003), (b"x", 3, 1002)):
            viewer = Viewer(self.server)
            viewer.acknowledges = False
            viewer.send_raw(payload, opcode)
            with self.assertRaises(Closed) as closed:
                viewer.until(lambda: False)
            self.assertEqual(closed.exception.args[0], code)
            viewer.socket.close()
        self.viewer().wait_steps(3)

    def test_random_messages(self):
        draw = random.Random(1)
        words = ["type", "grab", "move", "release", "pin", "unpin", "handle", "set", "step", "colour", "name", "numbers", "vertices", "triangle",
                 "on", "a", "left", "young", "energy"]
        sent = 0
        while sent < 2000:
            viewer = Viewer(self.server)
            try:
                for _ in range(150):
                    message = {draw.choice(words): draw.choice([draw.choice(words), draw.uniform(-1e3, 1e3), [draw.randrange(9)] * 3, None])
                               for _ in range(4)}
                    message["type"] = draw.choice(words)
                    text = str(message) if draw.random() < .1 else "".join(draw.choices(string.printable, k=9)) if draw.random() < .1 else None
                    viewer.send_raw(text.encode()) if text else viewer.send(**message)
                    sent += 1
                viewer.until(lambda: False)
            except (Closed, OSError):
                pass
            viewer.socket.close()
        self.viewer().wait_steps(5)


if __name__ == "__main__":
    unittest.main()
