# SPDX-License-Identifier: GPL-3.0-or-later
"""What is set, held and asked for is told by the server: to who joins, to all when it changes, and after Reset, Undo and a refusal.

Environment: EXEMPLAR, the program.
"""
import tempfile
import unittest
from pathlib import Path

from live_client import Viewer
from live_server import BAR, Msh, Server, exemplar_runner, prm, write_msh


class StateTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        scene = Path(directory.name) / "bar.prm"
        scene.write_text(prm(BAR))
        self.server = Server(scene, log=Path(directory.name) / "log.txt")
        self.addCleanup(self.server.__exit__)
        self.first = self.viewer()

    def viewer(self):
        viewer = Viewer(self.server)
        self.addCleanup(viewer.socket.close)
        return viewer

    def state(self, viewer):
        return [text for text in viewer.texts if text["type"] == "state"][-1]

    def wait(self, viewer, is_so):
        viewer.until(lambda: is_so(self.state(viewer)))
        return self.state(viewer)

    def at(self, x):
        """Vertices of a cross section of the bar."""
        return [i for i, place in enumerate(self.first.frames[0].places) if abs(place[0] - x) < .01]

    def test_who_joins_is_told(self):
        self.assertEqual([text["type"] for text in self.first.texts[:2]], ["scene", "state"])
        state, scene = self.state(self.first), self.first.scene
        self.assertEqual(state["settings"], {**{name: scene[name] for name in ("young", "poisson", "importance", "energy", "gravity", "damping")}, "tensions": {}})
        self.assertEqual({name: state[name] for name in ("pins", "handles", "colour", "undo", "paused", "weights_by_hand", "weights_wanted", "means")},
                         {"pins": [], "handles": [], "colour": "none", "undo": 0, "paused": False, "weights_by_hand": False, "weights_wanted": [],
                          "means": []})
        self.assertEqual(scene["bounds"]["importance"], [1e-3, 1.])
        self.assertAlmostEqual(scene["grab_radius"], .1 * scene["diameter"])
        self.assertFalse(scene["saves_poses"])

    def test_all_are_told_what_changes(self):
        first, second, middle = self.first, self.viewer(), self.at(2.)
        for name, value in (("young", 2e6), ("poisson", .45), ("importance", .9)):
            first.send(type="set", name=name, numbers=[value])
        first.send(type="gravity", numbers=[0., 0., -1.5])
        first.send(type="damping", numbers=[3., .001])
        first.send(type="pin", name="1", vertices=middle)
        first.send(type="handle", name="left", numbers=[0., 0., .25])
        first.send(type="energy", name="mixed")
        first.send(type="weights", numbers=[.25, .75])
        first.send(type="colour", name="det F")
        first.send(type="pause", on=True)
        for viewer in first, second:
            state = self.wait(viewer, lambda state: state["paused"])
            self.assertEqual(state["settings"], {"young": 2e6, "poisson": .45, "importance": .9, "gravity": [0., 0., -1.5], "damping": [3., .001], "tensions": {}, "energy": "mixed"})
            self.assertEqual(state["pins"], [{"name": "1", "vertices": middle}])
            self.assertEqual(state["handles"], [{"name": "left", "shift": [0., 0., .25]}])
            self.assertEqual((state["colour"], state["weights_by_hand"], state["weights_wanted"]), ("det F", True, [.25, .75]))
        later = self.viewer()
        self.assertEqual(later.texts[1], state)

    def test_reset(self):
        before = self.state(self.first)
        self.first.send(type="gravity", numbers=[0., 0., -1.5])
        self.first.send(type="set", name="young", numbers=[3e6])
        self.first.send(type="pin", name="1", vertices=self.at(2.))
        self.first.send(type="handle", name="left", numbers=[0., 0., .25])
        self.wait(self.first, lambda state: state["handles"] and state["pins"])
        self.first.send(type="reset")
        self.assertEqual(self.wait(self.first, lambda state: not state["pins"]), before)

    def test_undo(self):
        first, middle = self.first, self.at(2.)
        first.send(type="pin", name="1", vertices=middle)
        self.wait(first, lambda state: state["undo"] == 1)
        first.send(type="set", name="poisson", numbers=[.2])
        first.send(type="pin", name="2", vertices=self.at(4.) + middle)
        state = self.wait(first, lambda state: len(state["pins"]) == 2)
        self.assertEqual(state["pins"][1]["vertices"], self.at(4.))  # the others are held already
        first.send(type="set", name="young", numbers=[3e6])
        first.send(type="undo")
        state = self.wait(first, lambda state: len(state["pins"]) == 1)
        self.assertEqual((state["undo"], state["settings"]["poisson"], state["settings"]["young"]), (1, .2, 1e6))
        first.send(type="undo")
        state = self.wait(first, lambda state: not state["pins"])
        self.assertEqual((state["undo"], state["settings"]["poisson"]), (0, first.scene["poisson"]))
        first.send(type="pin", name="1", vertices=middle)  # the name is free again
        self.wait(first, lambda state: state["pins"])
        self.assertFalse([text for text in first.texts if text["type"] == "refused"])

    def test_a_refusal_is_followed_by_the_state(self):
        for message in ({"type": "set", "name": "young", "numbers": [-1.]}, {"type": "colour", "name": "pose 7"}, {"type": "undo"}):
            self.first.send(**message)
            self.first.wait_for("refused")
            self.assertEqual(self.first.wait_for("state")["settings"]["young"], 1e6)
        self.assertEqual(self.state(self.first)["colour"], "none")

    def test_without_examples_and_back(self):
        first, second = self.first, self.viewer()
        self.assertTrue(self.state(first)["with_examples"])
        first.send(type="set", name="importance", numbers=[.6])
        first.send(type="set", name="importance", numbers=[first.scene["bounds"]["importance"][0]])
        for viewer in first, second, self.viewer():
            state = self.wait(viewer, lambda state: not state["with_examples"])
            self.assertEqual((state["settings"]["importance"], state["importance_with_examples"]), (1e-3, .6))
        first.send(type="reset")
        state = self.wait(first, lambda state: state["with_examples"])
        self.assertEqual((state["settings"]["importance"], state["importance_with_examples"]), (.8, .8))

    def test_a_pose_becomes_an_example(self):
        first, second = self.first, self.viewer()
        begun = first.scene
        first.send(type="gravity", numbers=[0., 0., -30.])
        first.wait_steps(40)
        n = len(second.texts)
        first.send(type="add example")
        scene = first.wait_for("scene")
        second.until(lambda: any(text["type"] == "scene" for text in second.texts[n:]))
        self.assertEqual((begun["examples"], scene["examples"]), (["rest pose", "example 1"], ["rest pose", "by_hand_1", "example 2"]))
        state = first.wait_for("state")
        self.assertEqual((state["undo"], state["settings"]["gravity"], scene["gravity"]), (0, begun["gravity"], begun["gravity"]))
        self.assertEqual(self.viewer().texts[0], scene)
        first.send(type="weights", numbers=[0.] * len(begun["examples"]) + [1.])
        self.wait(first, lambda state: state["weights_by_hand"])

    def test_rest_becomes_no_example_and_shows_no_noise(self):
        """Two examples that are alike would share one weight as rounding decides."""
        first = self.first
        first.wait_steps(5)
        first.send(type="add example")
        self.assertIn("hardly away from rest", first.wait_for("refused")["text"])
        for name, least, most in (("energy", 0, 0), ("det F", 120, 135)):
            first.send(type="colour", name=name)
            self.wait(first, lambda state: state["colour"] == name)
            first.wait_steps(3)
            frame = first.frames[-1]
            self.assertTrue(least <= min(frame.colours) and max(frame.colours) <= most, (name, min(frame.colours), max(frame.colours)))
            self.assertGreater(frame.high, frame.low)
        first.send(type="gravity", numbers=[0., 0., -30.])
        first.wait_steps(20)  # and a body that is bent has all colours
        self.assertEqual((min(first.frames[-1].colours), max(first.frames[-1].colours)), (0, 255))

    def test_poses_lead_or_guide(self):
        """The scaled energy, which leads, is the page's own choice; a body that is dragged takes more of a pose with it."""
        here, first = self.server.log.parent, self.first
        self.assertEqual((first.scene["energy"], first.scene["chooses_energy"]), ("scaled", True))
        first.send(type="damping", numbers=[10., .01])
        first.grab(first.farthest(), hard=True)
        first.move((3.6, 0., 1.))

        def weight():
            first.wait_steps(60)
            return first.wait_for("status")["weights"][1]
        leads = weight()
        first.send(type="energy", name="mixed")
        guides = weight()
        self.assertEqual(self.state(first)["settings"]["energy"], "mixed")
        first.send(type="energy", name="scaled")
        self.assertAlmostEqual(weight(), leads, delta=.02)
        self.assertGreater(leads, 1.05 * guides)
        first.send(type="energy", name="gentle")
        self.assertIn("no such energy", first.wait_for("refused")["text"])
        for energy in "mixed", "blended":
            (here / "own.prm").write_text(prm({**BAR, "Examples/Energy": energy}))
            with Server(here / "own.prm", log=here / "own.txt") as server, Viewer(server) as viewer:
                self.assertEqual((viewer.scene["energy"], viewer.scene["chooses_energy"]), (energy, energy == "mixed"))

    def test_an_example_by_hand_is_recorded(self):
        here = self.server.log.parent
        with Server(here / "bar.prm", "--record", here / "record", log=here / "record.txt") as server, Viewer(server) as viewer:
            viewer.send(type="gravity", numbers=[0., 0., -30.])
            viewer.wait_steps(40)
            viewer.send(type="add example")
            self.assertEqual(viewer.wait_for("scene")["examples"], ["rest pose", "pose_0001", "example 2"])
            viewer.until(lambda: viewer.frames[-1].step < 30)
            viewer.send(type="gravity", numbers=[0., 0., -10.])
            viewer.wait_steps(20)
            viewer.send(type="pause", on=True)
            viewer.until(lambda: viewer.wait_for("status")["paused"])
            last = viewer.wait_for("status")["step"]
            viewer.send(type="save pose")
            saved = Path(viewer.wait_for("saved")["text"])
        self.assertTrue((here / "record/scene_0001.prm").exists())  # what led to the example
        played = exemplar_runner.run_program(here / "record/scene.prm", "--quiet", "--output", here / "played", "--set", "Output/Every=0")
        self.assertEqual((played.status, played.stderr), (0, ""))
        self.assertGreaterEqual(last, 20)
        text = [file.read_text().split("$Nodes")[1].split("$EndNodes")[0] for file in (saved, here / "played/final.msh")]
        self.assertEqual(*text)

    def test_tensions_of_regions(self):
        here = self.server.log.parent
        scene = here / "muscle.prm"
        scene.write_text(prm({**BAR, "Material/Fibre tension": "1e3", "Material/Fibre direction": "1; 0; 0"}))
        with Server(scene, log=here / "muscle.txt") as server, Viewer(server) as viewer:
            self.assertEqual(viewer.scene["tensions"], [{"name": "Material", "value": 1e3, "most": 1e6}])
            self.assertEqual(self.state(viewer)["settings"]["tensions"], {"Material": None})
            viewer.send(type="tension", name="Material", numbers=[2e4])
            self.wait(viewer, lambda state: state["settings"]["tensions"] == {"Material": 2e4})
            for name, number in (("arm", 1.), ("Material", -1.)):
                viewer.send(type="tension", name=name, numbers=[number])
                self.assertIn("Material/Fibre tension: ", viewer.wait_for("refused")["text"])
            viewer.send(type="reset")
            self.wait(viewer, lambda state: state["settings"]["tensions"] == {"Material": None})

    def test_a_mean_is_called_one(self):
        here = self.server.log.parent
        nodes = {1: (0, 0, 0), 2: (1, 0, 0), 3: (0, 1, 0), 4: (0, 0, 1), 5: (1, 1, 1)}
        write_msh(here / "two.msh", Msh(nodes, [(1, 4, 2, 1, 1, 1, 2, 3, 4), (2, 4, 2, 2, 2, 2, 3, 4, 5)], []))
        scene = here / "two.prm"
        scene.write_text(prm({**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "two.msh",
                              "Handles/left/Select": "sphere 0 0 0 0.1", "Material/region 2/Young's modulus": "2e6"}))
        with Server(scene, log=here / "two.txt") as server, Viewer(server) as viewer:
            self.assertEqual(self.state(viewer)["means"], ["young"])
            viewer.send(type="set", name="young", numbers=[2e6])
            self.assertEqual(self.wait(viewer, lambda state: not state["means"])["settings"]["young"], 2e6)


if __name__ == "__main__":
    unittest.main()
