# SPDX-License-Identifier: GPL-3.0-or-later
"""Obstacles on the page of exemplar live, and on that of exemplar export: where they are, and that they are seen.

Environment: EXEMPLAR, the program. SCREENSHOTS, a directory for pictures, may be set.
"""
import os
import tempfile
import unittest
from pathlib import Path

from live_browser import browser, complaints, needs_browser, wait
from live_client import Viewer
from live_server import BAR, Server, call_program, prm

SCENE = {
    **{key: value for key, value in BAR.items() if not key.startswith(("Examples", "Handles"))},
    "Material/Young's modulus": "1e5",
    "Loads/Gravity": "0, 0, -0.1",
    "Obstacles/Names": "step, roller",
    "Obstacles/step/Shape": "box -1 -2 -2  1 2 -1",
    "Obstacles/roller/Shape": "sphere 3 0 -2 0.5",
    "Obstacles/roller/Motion": "-t; 0; 0",
    "Time/End": "1",
}
# is an obstacle seen? its colour is grey, that of the body is orange
GREY = """
    const small = document.createElement("canvas"); small.width = 96; small.height = 72;
    const pen = small.getContext("2d"); pen.drawImage(document.getElementById("canvas"), 0, 0, 96, 72);
    const all = pen.getImageData(0, 0, 96, 72).data; let n = 0, sum = 0;
    for (let i = 0; i < all.length; i += 4)
        if (all[i + 3] === 255 && Math.abs(all[i] - all[i + 2]) < 40) { ++n; sum += (i / 4) % 96; }
    return [n, sum / n];"""


class Base(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.here = Path(directory.name)
        (self.here / "scene.prm").write_text(prm(SCENE))

    def serve(self, *arguments):
        server = Server(self.here / "scene.prm", *arguments, log=self.here / "log.txt")
        self.addCleanup(server.__exit__)
        return server

    def look(self, page, name):
        self.addCleanup(page.quit)
        if "SCREENSHOTS" in os.environ:
            page.save_screenshot(str(Path(os.environ["SCREENSHOTS"]) / f"{name}.png"))
        self.assertEqual(complaints(page), [])

    def page_of_run(self, *settings):
        """The page of a run of the scene, in a browser."""
        words = [word for setting in settings for word in ("--set", setting)]
        for call in ([self.here / "scene.prm", *words, "--output", self.here / "run", "--quiet"],
                     ["export", self.here / "run", "--html", self.here / "run.html"]):
            done = call_program(*call)
            self.assertEqual(done.returncode, 0, done.stderr)
        page = browser()
        page.get(f"file://{self.here}/run.html")
        return page

    def show(self, page, frame, time):
        page.execute_script("const bar = document.getElementById('scrub'); bar.value = arguments[0]; bar.oninput({ target: bar });", frame)
        wait(lambda: page.find_element("id", "time").text == f"t = {time:.2f} s")


class LiveObstacles(Base):
    def test_what_moves_goes_with_the_frames(self):
        with Viewer(self.serve("--floor", "-3")) as viewer:
            self.assertAlmostEqual(viewer.scene["floor"], -3, delta=1e-12)
            at_start = viewer.obstacles[0].places
            self.assertEqual(max(max(t) for t in viewer.triangles_of_obstacles) + 1, len(at_start))
            self.assertEqual(sorted({round(z, 3) for _, _, z in at_start[:8]}), [-2, -1])
            self.assertGreater(min(z for _, _, z in at_start), -2.51)  # the floor is no part of it
            viewer.wait_steps(20)
            frame = viewer.frames[-1]
            for before, after, way in ((at_start[0], frame.obstacles.places[0], 0), (at_start[-1], frame.obstacles.places[-1], -frame.time)):
                self.assertAlmostEqual(after[0] - before[0], way, delta=2e-3)

    def test_what_stands_is_said_once_and_without_obstacles_nothing(self):
        (self.here / "scene.prm").write_text(prm({**SCENE, "Obstacles/roller/Motion": None}))
        with Viewer(self.serve()) as viewer:
            viewer.wait_steps(3)
            self.assertEqual((len(viewer.obstacles), viewer.frames[-1].obstacles, viewer.scene["floor"]), (1, None, None))
        (self.here / "scene.prm").write_text(prm({key: value for key, value in SCENE.items() if "Obstacles" not in key}))
        with Viewer(self.serve()) as viewer:
            viewer.wait_steps(3)
            self.assertEqual((viewer.obstacles, viewer.frames[-1].obstacles), ([], None))

    def test_what_follows_a_track_is_no_ground(self):
        (self.here / "lift.txt").write_text("0 0 0 0 0 0 0\n1 0 0 0.1 0 0 0\n")
        floor = {key: value for key, value in SCENE.items() if not key.startswith("Obstacles")}
        floor.update({"Obstacles/Names": "floor", "Obstacles/floor/Shape": "plane 0 0 -2  0 0 1"})
        for more, level in (({}, -2), ({"Obstacles/floor/Follow track": str(self.here / "lift.txt")}, None), ({"Obstacles/floor/Until": "0.5"}, None)):
            (self.here / "scene.prm").write_text(prm({**floor, **more}))
            with Viewer(self.serve()) as viewer:
                self.assertEqual((viewer.scene["floor"], len(viewer.obstacles)), (level, 0 if level else 1))

    def test_forces_of_contact_are_colours(self):
        bars = Path(__file__).resolve().parents[2] / "prm/contact/two_bars.prm"
        server = Server(bars, log=self.here / "bars.txt")
        self.addCleanup(server.__exit__)
        with Viewer(server) as viewer:
            self.assertTrue(viewer.scene["has_contact"])
            viewer.send(type="colour", name="contact")
            viewer.until(lambda: viewer.frames[-1].has_colours and viewer.frames[-1].high > 10)  # the one lies on the other
            frame = viewer.frames[-1]
            pushed = [place for place, byte in zip(frame.places, frame.colours) if byte > 25]
            self.assertGreater(len(pushed), 1)
            self.assertLess(len(pushed), len(frame.places) / 4)
            self.assertLess(max(abs(x - 1) for x, _, _ in pushed), 0.3)  # where they cross
        (self.here / "scene.prm").write_text(prm({key: value for key, value in SCENE.items() if "Obstacles" not in key}))
        with Viewer(self.serve()) as viewer:
            self.assertFalse(viewer.scene["has_contact"])
            viewer.send(type="colour", name="contact")
            self.assertIn("no such colour", viewer.wait_for("refused")["text"])
        with Viewer(self.serve("--floor", "-3")) as viewer:
            self.assertTrue(viewer.scene["has_contact"])

    @needs_browser
    def test_the_page_shows_them(self):
        # it goes to and fro for ever, as a browser without a graphics card may show its first picture late
        (self.here / "scene.prm").write_text(prm({**SCENE, "Obstacles/roller/Motion": "cos(t) - 1; 0; 0"}))
        server = self.serve("--floor", "-3")
        page = browser()
        page.get(f"http://{server.host}/?token={server.token}")
        wait(lambda: "real time" in page.find_element("id", "strip").text)
        first, place = page.execute_script(GREY)
        self.assertGreater(first, 20)
        wait(lambda: abs(page.execute_script(GREY)[1] - place) > 1)
        level = page.execute_async_script("const done = arguments[0]; import('./app.js').then(({ view }) => done("
                                          "[view.ground.disc.position.z, view.ground.disc.visible, view.obstacles.mesh.visible]));")
        self.assertAlmostEqual(level[0], -3, places=5)
        self.assertEqual(level[1:], [True, True])
        self.assertFalse(page.find_element("id", "said").is_displayed())  # that nothing rests on the ground
        self.look(page, "live_obstacles")

    @needs_browser
    def test_a_page_of_a_run_shows_them_in_motion(self):
        page = self.page_of_run("Time/Step=0.02")
        seen = []
        for frame in (0, 49):
            self.show(page, frame, 0.02 * frame)
            wait(lambda: page.execute_script(GREY)[0] > 20)
            seen.append(page.execute_script(GREY)[1])
        self.assertLess(seen[1], seen[0] - 1)
        self.look(page, "export_obstacles")


class DrivenHandle(Base):
    """A handle that is dragged into an obstacle stops; nothing else is lost."""

    def test_it_stops_at_the_obstacle_and_the_session_goes_on(self):
        (self.here / "scene.prm").write_text(prm({**BAR, "Obstacles/Names": "wall", "Obstacles/wall/Shape": "box -3 -3 1.2  6 3 3"}))
        with Viewer(self.serve()) as viewer:
            left = viewer.scene["handles"][0]["vertices"]
            top = max(z for _, _, z in viewer.frames[0].places)
            viewer.send(type="handle", name="left", numbers=[0, 0, 3.])
            said = viewer.wait_for("warning")["text"]
            self.assertIn("stops here", said)
            state = viewer.wait_for("state")
            shift = state["handles"][0]["shift"][2]
            self.assertTrue(.3 < shift < 1.2 - top, shift)
            step = viewer.frames[-1].step
            viewer.wait_steps(20)
            self.assertEqual(viewer.frames[-1].step, step + 20)  # it has not begun again
            self.assertAlmostEqual(max(viewer.frames[-1].places[v][2] for v in left), top + shift, delta=1e-4)
            viewer.send(type="handle", name="left", numbers=[0, 0, 0])  # and goes back
            viewer.until(lambda: abs(max(viewer.frames[-1].places[v][2] for v in left) - top) < 1e-3)


class ByHand(Base):
    """Obstacles are put beside the body, carried against it and taken away; the recorded session ends in the same bytes."""

    def state(self, viewer):
        return [text for text in viewer.texts if text["type"] == "state"][-1]

    def test_a_session(self):
        (self.here / "scene.prm").write_text(prm({**BAR, "Time/Mass damping": "20"}))
        with Viewer(self.serve("--record", self.here / "session")) as viewer:
            def tip():
                return max(z for x, _, z in viewer.frames[-1].places if x > 3.9)
            self.assertEqual((self.state(viewer)["obstacles"], viewer.obstacles), ([], []))
            viewer.wait_steps(3)
            begin = tip()
            viewer.send(type="put", name="in the way", numbers=[3.5, 0, 0, .5, .5])
            self.assertIn("the body is there", viewer.wait_for("refused")["text"])
            viewer.send(type="put", name="ball 1", numbers=[3.5, 0, 2, .5, .5])
            viewer.until(lambda: viewer.obstacles)
            viewer.until(lambda: self.state(viewer)["obstacles"])
            (ball,) = self.state(viewer)["obstacles"]
            self.assertEqual((ball["name"], ball["movable"], ball["there"], ball["shift"]), ("ball 1", True, True, [0, 0, 0]))
            self.assertEqual(ball["triangles"], len(viewer.triangles_of_obstacles))
            viewer.send(type="carry", name="ball 1", numbers=[0, 0, -1.2])
            viewer.until(lambda: viewer.frames[-1].obstacles and abs(min(z for _, _, z in viewer.frames[-1].obstacles.places) - .3) < .01)
            viewer.wait_steps(10)
            pressed = tip()
            self.assertLess(pressed, begin - .1)
            viewer.send(type="put", name="block 1", numbers=[1, 1, 2, 2, 2, 3, .5])
            viewer.until(lambda: len(self.state(viewer)["obstacles"]) == 2)
            viewer.wait_steps(3)
            viewer.send(type="undo")  # the ball stays where it was carried to
            viewer.until(lambda: len(self.state(viewer)["obstacles"]) == 1)
            viewer.wait_steps(10)
            self.assertAlmostEqual(tip(), pressed, delta=.05)
            viewer.send(type="take away", name="ball 1")
            viewer.until(lambda: not self.state(viewer)["obstacles"][0]["there"])
            viewer.wait_steps(60)
            self.assertGreater(tip(), pressed + .05)
            for message in ({"type": "carry", "name": "ball 1", "numbers": [0, 0, 0]}, {"type": "take away", "name": "nobody"},
                            {"type": "put", "name": "ball 1", "numbers": [3.5, 0, 5, .5, .5]}, {"type": "put", "name": "b", "numbers": [1, 2]},
                            {"type": "put", "name": "c", "numbers": [3.5, 0, 5, -1, .5]}):
                viewer.send(**message)
                viewer.wait_for("refused")
            self.assertFalse([text for text in viewer.texts if text["type"] == "warning"])
            viewer.send(type="pause", on=True)
            viewer.until(lambda: viewer.wait_for("status")["paused"])
            viewer.send(type="save pose")
            saved = Path(viewer.wait_for("saved")["text"])
        done = call_program(self.here / "session/scene.prm", "--output", self.here / "again")
        self.assertEqual(done.returncode, 0, done.stderr)
        nodes = [file.read_text().split("$Nodes")[1].split("$EndNodes")[0] for file in (saved, self.here / "again/final.msh")]
        self.assertEqual(*nodes)

    def test_obstacles_of_the_scene_move_too(self):
        with Viewer(self.serve("--floor", "-3")) as viewer:
            self.assertEqual([(o["name"], o["movable"]) for o in self.state(viewer)["obstacles"]], [("step", True), ("roller", True)])
            low = min(z for _, _, z in viewer.obstacles[0].places)
            viewer.send(type="carry", name="step", numbers=[0, 0, -.5])
            viewer.until(lambda: viewer.frames[-1].obstacles and abs(min(z for _, _, z in viewer.frames[-1].obstacles.places) - low + .0) < 1e-3
                         and abs(viewer.frames[-1].obstacles.places[0][2] + 2.5) < 1e-3)
            viewer.send(type="take away", name="roller")
            viewer.until(lambda: [o["there"] for o in self.state(viewer)["obstacles"]] == [True, False])


class Sheets(Base):
    """A shell that falls on a ball and a floor."""

    def setUp(self):
        super().setUp()
        n = 8
        at = [(.5 * i / n - .25, .5 * j / n - .25) for j in range(n + 1) for i in range(n + 1)]
        corners = [j * (n + 1) + i + 1 for j in range(n) for i in range(n)]
        (self.here / "sheet.obj").write_text("".join(f"v {x} {y} 0\n" for x, y in at)
                                             + "".join(f"f {a} {a + 1} {a + n + 2} {a + n + 1}\n" for a in corners))
        self.sheet = {key: value for key, value in SCENE.items() if not key.startswith(("Mesh", "Obstacles", "Model"))}
        self.sheet.update({"Mesh/Kind": "shell", "Mesh/File": str(self.here / "sheet.obj"), "Material/Thickness": "2e-3",
                           "Material/Density": "300", "Material/Young's modulus": "1e6", "Loads/Gravity": "0, 0, -9.81",
                           "Obstacles/Names": "ball", "Obstacles/ball/Shape": "sphere 0 0 -0.13 0.1", "Obstacles/ball/Friction": "0.5"})
        (self.here / "scene.prm").write_text(prm(self.sheet))

    def test_it_lies_on_the_ball_and_the_floor(self):
        with Viewer(self.serve("--floor", "-0.15")) as viewer:
            self.assertEqual((viewer.scene["floor"], len(viewer.obstacles)), (-.15, 1))
            viewer.wait_steps(60)
            places = viewer.frames[-1].places
            self.assertGreater(min(z for _, _, z in places), -.15)
            self.assertLess(min(z for _, _, z in places), -.04)
            self.assertGreater(min(x * x + y * y + (z + .13) ** 2 for x, y, z in places), .1 ** 2)

    def test_hands_hold_it_hard_pin_it_and_drag_its_handle(self):
        """The edge that a handle holds with its slopes stays as it is turned; the recorded session ends in the same bytes."""
        self.sheet.update({"Obstacles/Names": None, "Obstacles/ball/Shape": None, "Obstacles/ball/Friction": None, "Loads/Gravity": "0, 0, -1",
                           "Handles/Names": "edge", "Handles/edge/Select": "box -1 -1 -1  -0.18 1 1"})
        (self.here / "scene.prm").write_text(prm(self.sheet))
        with Viewer(self.serve("--record", self.here / "session")) as viewer:
            edge = viewer.scene["handles"][0]["vertices"]
            viewer.wait_steps(5)
            viewer.send(type="handle", name="edge", numbers=[0, 0, .05])
            viewer.wait_steps(60)
            held = [viewer.frames[-1].places[v] for v in edge]
            self.assertLess(max(abs(z - .05) for _, _, z in held), 2e-4)
            viewer.grab(viewer.farthest(), hard=True)
            viewer.move((.22, 0, .1))
            viewer.wait_steps(20)
            corner = [v for v, (x, y, _) in enumerate(viewer.frames[0].places) if x > .15 and y > .15]
            viewer.send(type="pin", name="1", vertices=corner)
            viewer.wait_steps(3)
            pinned = [viewer.frames[-1].places[v] for v in corner]
            viewer.send(type="release", name="a")
            viewer.wait_steps(20)
            for place, before in zip((viewer.frames[-1].places[v] for v in corner), pinned):
                self.assertLess(max(abs(a - b) for a, b in zip(place, before)), 2e-4)
            free = min(range(len(viewer.frames[-1].places)), key=lambda v: viewer.frames[-1].places[v][1] - .1 * viewer.frames[-1].places[v][0])
            triangle = next(t for t, corners in enumerate(viewer.triangles) if free in corners)
            viewer.grab((triangle, [float(v == free) for v in viewer.triangles[triangle]], viewer.frames[-1].places[free]), hard=True)
            viewer.wait_steps(3)
            viewer.send(type="undo")  # the pin and the dragged handle stay
            viewer.wait_steps(5)
            for place, before in zip((viewer.frames[-1].places[v] for v in corner), pinned):
                self.assertLess(max(abs(a - b) for a, b in zip(place, before)), 2e-4)
            self.assertEqual([text for text in viewer.texts if text["type"] in ("warning", "refused")], [])
            viewer.send(type="pause", on=True)
            viewer.until(lambda: viewer.wait_for("status")["paused"])
            viewer.send(type="save pose")
            saved = Path(viewer.wait_for("saved")["text"])
        done = call_program(self.here / "session/scene.prm", "--output", self.here / "again")
        self.assertEqual(done.returncode, 0, done.stderr)
        nodes = [file.read_text().split("$Nodes")[1].split("$EndNodes")[0] for file in (saved, self.here / "again/final.msh")]
        self.assertEqual(*nodes)

    @needs_browser
    def test_the_page_of_a_run_shows_both(self):
        page = self.page_of_run("Time/End=0.2", "Obstacles/ball/Shape=box -0.1 -0.6 -0.2  0.1 0.6 -0.03")
        orange = GREY.replace("Math.abs(all[i] - all[i + 2]) < 40", "all[i] - all[i + 2] > 60")
        for frame in (0, 20):
            self.show(page, frame, 0.01 * frame)
            wait(lambda: page.execute_script(orange)[0] > 20)
        wait(lambda: page.execute_script(GREY)[0] > 5)
        self.look(page, "export_sheet")


if __name__ == "__main__":
    unittest.main()
