# SPDX-License-Identifier: GPL-3.0-or-later
"""A body made of an artist's surface on the page of exemplar live: the surface is drawn, with what it carries, up is along y, and gravity's
slider acts along the scene's gravity.

Environment: EXEMPLAR, the program. SCREENSHOTS, a directory for pictures, may be set.
"""
import http.client
import os
import struct
import tempfile
import unittest
from pathlib import Path

from live_browser import browser, complaints, needs_browser, wait
from live_client import Viewer
from live_server import Server, call_program, prm

SURFACES = Path(__file__).resolve().parents[2] / "meshes/surfaces/creature"
SCENE = {
    "Scene": "dynamic",
    "Mesh/File": str(SURFACES / "rest.obj"),
    "Mesh/Cells": "2000",
    "Material/Young's modulus": "1e5",
    "Material/Density": "1000",
    "Time/Step": "0.016666666666666666",
    "Time/End": "1",
}


class Surface:
    """surface.bin; doc/live.md."""

    def __init__(self, data):
        n, n_triangles, n_shares = struct.unpack_from("<3I", data)
        at = 12

        def take(letter, count):
            nonlocal at
            at += 4 * count
            return struct.unpack_from(f"<{count}{letter}", data, at - 4 * count)

        self.offsets, self.ends, self.nearest = take("f", 3 * n), take("I", n), take("I", n)
        self.nodes, self.values, self.triangles = take("I", n_shares), take("f", n_shares), take("I", 3 * n_triangles)
        assert at == len(data)

    def places(self, frame):
        nodes = frame.places + (frame.inner.places if frame.inner else [])
        result, i = [], 0
        for v, end in enumerate(self.ends):
            shares = [(self.values[k], nodes[self.nodes[k]]) for k in range(i, end)]
            result.append(tuple(self.offsets[3 * v + c] + sum(value * place[c] for value, place in shares) for c in range(3)))
            i = end
        return result


def vertices_of(file):
    return [tuple(map(float, line.split()[1:4])) for line in file.read_text().splitlines() if line.startswith("v ")]


class LiveSurface(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.here = Path(directory.name)

    def serve(self, scene, *arguments):
        (self.here / "scene.prm").write_text(prm(scene))
        server = Server(self.here / "scene.prm", *arguments, log=self.here / "log.txt")
        self.addCleanup(server.__exit__)
        return server

    @staticmethod
    def fetch(server, viewer_cookie=True):
        connection = http.client.HTTPConnection(server.host)
        connection.request("GET", f"/?token={server.token}")
        answer = connection.getresponse()
        answer.read()
        headers = {"Cookie": answer.getheader("Set-Cookie").split(";")[0]} if viewer_cookie else {}
        connection.request("GET", "/surface.bin", headers=headers)
        answer = connection.getresponse()
        result = answer.status, answer.read()
        connection.close()
        return result

    def test_vertices_are_those_of_the_file_and_of_frames(self):
        server = self.serve(SCENE, "--record", self.here / "record", "--up", "y")
        rest = vertices_of(Path(SCENE["Mesh/File"]))
        with Viewer(server) as viewer:
            self.assertTrue(viewer.scene["draws_surface"])
            self.assertEqual(viewer.scene["up"], [0, 1, 0])
            self.assertEqual(self.fetch(server, viewer_cookie=False)[0], 403)
            status, data = self.fetch(server)
            self.assertEqual(status, 200)
            surface = Surface(data)
            diagonal = viewer.scene["diameter"]
            for found, wanted in zip(surface.places(viewer.frames[0]), rest, strict=True):
                self.assertLess(max(abs(a - b) for a, b in zip(found, wanted)), 1e-4 * diagonal)
            viewer.send(type="gravity", numbers=[0., -30., 0.])
            viewer.wait_steps(20)
            viewer.send(type="pause", on=True)
            viewer.wait_for("state")
        server.__exit__()
        # what the session's frames hold is what the page has drawn
        self.assertEqual(call_program(self.here / "record/scene.prm", "--set", "Output/Formats=obj", "--set", "Output/Every=1",
                                      "--set", f"Output/Directory={self.here / 'played'}").returncode, 0)
        frame = next(frame for frame in reversed(viewer.frames) if (self.here / f"played/frame_{frame.step:04}.obj").exists())
        self.assertGreater(frame.step, 10)
        played = vertices_of(self.here / f"played/frame_{frame.step:04}.obj")
        self.assertGreater(max(abs(a[1] - b[1]) for a, b in zip(played, rest)), .01 * diagonal)
        for found, wanted in zip(surface.places(frame), played, strict=True):
            self.assertLess(max(abs(a - b) for a, b in zip(found, wanted)), 3e-4 * diagonal)

    def test_which_way_is_up(self):
        def up_of(scene, *arguments):
            server = self.serve(scene, *arguments)
            with Viewer(server) as viewer:
                return viewer.scene["up"]

        self.assertEqual(up_of(SCENE), [0, 0, 1])
        of_blender = self.here / "of_blender.obj"
        of_blender.write_text("# Blender 4.3.2\n" + Path(SCENE["Mesh/File"]).read_text())
        self.assertEqual(up_of({**SCENE, "Mesh/File": str(of_blender)}), [0, 1, 0])
        self.assertEqual(up_of({**SCENE, "Mesh/File": str(of_blender)}, "--up", "z"), [0, 0, 1])
        self.assertEqual(up_of({**SCENE, "Loads/Gravity": "-2, 0, 0"}, "--up", "y"), [1, 0, 0])

    def test_a_mesh_has_none(self):
        with Viewer(self.serve({**SCENE, "Mesh/File": None, "Mesh/Cells": None, "Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1",
                                "Mesh/Box cells": "4, 1, 1"})) as viewer:
            self.assertFalse(viewer.scene["draws_surface"])
            self.assertEqual(viewer.scene["up"], [0, 0, 1])

    @needs_browser
    def test_motion_is_saved_as_a_point_cache(self):
        server = self.serve({**SCENE, "Loads/Gravity": "0, -9, 0"}, "--record", self.here / "record")
        page = browser(downloads=self.here)
        self.addCleanup(page.quit)
        page.get(f"http://{server.host}/?token={server.token}")
        button = page.find_element("id", "motion")
        wait(lambda: button.is_displayed() and "real time" in page.find_element("id", "strip").text)
        self.assertEqual(button.text, "Record motion")
        button.click()
        self.assertEqual(button.text, "Save motion")

        def moments():
            return page.execute_async_script("const done = arguments[0]; import('./app.js').then(({ motion }) => "
                                             "done(motion.moments.map(({ time }) => time)));")
        wait(lambda: len(moments()) > 5 and moments()[-1] - moments()[0] > .4)
        page.find_element("id", "pause").click()
        wait(lambda: "Go on" in page.find_element("id", "pause").text)
        times = moments()
        button.click()
        file = self.here / "scene.pc2"
        wait(file.exists)
        self.assertEqual(complaints(page), [])
        page.get("about:blank")
        server.__exit__()
        self.assertEqual(call_program(self.here / "record/scene.prm", "--set", "Output/Formats=obj", "--set", "Output/Every=1",
                                      "--set", f"Output/Directory={self.here / 'played'}").returncode, 0)
        rest, data = vertices_of(Path(SCENE["Mesh/File"])), file.read_bytes()
        _, version, n, start, rate, n_samples = struct.unpack_from("<12siiffi", data)
        self.assertEqual((version, n, start, rate, n_samples), (1, len(rest), 0., 1., 1 + int((times[-1] - times[0]) * 24 + 1e-6)))
        self.assertEqual(len(data), 32 + 12 * n * n_samples)
        frames = {}

        def place(step, v):
            if step not in frames:
                frames[step] = vertices_of(self.here / f"played/frame_{step:04}.obj")
            return frames[step][v]
        size = max(max(x) - min(x) for x in zip(*rest))
        for k in range(n_samples):
            values = struct.unpack_from(f"<{3 * n}f", data, 32 + 12 * n * k)
            at = 60. * (times[0] + k / 24.)
            step, part = int(at), at - int(at)
            for v in range(0, n, 97):
                wanted = [a + part * (b - a) for a, b in zip(place(step, v), place(step + (part > 1e-6), v))]
                self.assertLess(max(abs(a - b) for a, b in zip(values[3 * v:3 * v + 3], wanted)), 2e-2 * size)
        fallen = struct.unpack_from("<3f", data, 32 + 12 * n * (n_samples - 1))[1] - struct.unpack_from("<3f", data, 32)[1]
        self.assertLess(fallen, -.1 * size)

    @needs_browser
    def test_it_is_drawn(self):
        server = self.serve({**SCENE, "Loads/Gravity": "0, -1, 0", "Handles/Names": "head",
                             "Handles/head/Select": "box -9 -9 -9  -1.2 9 9"})
        page = browser()
        self.addCleanup(page.quit)
        page.get(f"http://{server.host}/?token={server.token}")

        def of_view(expression):
            return page.execute_async_script(f"const done = arguments[0]; import('./app.js').then(({{ view }}) => done({expression}));")

        wait(lambda: of_view("Boolean(view.skin && view.hasPlace)"))
        self.assertEqual(of_view("[view.body.mesh.material.visible, view.skin.mesh.material.visible]"), [False, True])
        self.assertEqual(of_view("view.skin.data.nVertices"), len(vertices_of(Path(SCENE["Mesh/File"]))))
        self.assertEqual(of_view("view.eye.up.toArray()"), [0, 1, 0])
        # the pointer meets the body, which is not drawn
        self.assertTrue(of_view("""[0, 50, 100, 150].some((i) => {
            const { left, top } = view.canvas.getBoundingClientRect(), { x, y } = view.onPage(view.body.pointOf({ triangle: i, shares: [.4, .3, .3] }));
            return view.pick({ clientX: left + x, clientY: top + y });
        })"""))
        labels = [label.text for label in page.find_elements("css selector", "label.slider")]
        self.assertTrue(any("gravity along y" in text and "-1 m/s²" in text for text in labels), labels)
        page.find_element("css selector", "#colour option[value='energy']").click()
        wait(lambda: of_view("view.skin.drawn.hasColours"))
        if "SCREENSHOTS" in os.environ:
            page.save_screenshot(str(Path(os.environ["SCREENSHOTS"]) / "live_surface.png"))
        self.assertEqual(complaints(page), [])


if __name__ == "__main__":
    unittest.main()
