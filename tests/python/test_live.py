# SPDX-License-Identifier: GPL-3.0-or-later
"""problem.live() serves the page of the scene that the problem was made of, arrays and all; what the page would not have is refused by name."""
import gc
import itertools
import socket
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import exemplar

sys.path.append(str(Path(__file__).resolve().parents[1] / "live"))
from live_client import Address, Viewer  # noqa: E402
from live_server import BAR, prm  # noqa: E402

SCENE = prm(BAR)


def arrays():
    """A bar of bricks of six tetrahedra: nodes (n, 3), cells (m, 4), and a pose (n, 3)."""
    nodes = np.stack(np.meshgrid(np.linspace(0, 4, 5), np.linspace(0, 1, 2), np.linspace(0, 1, 2), indexing="ij"), -1)
    number = np.arange(nodes[..., 0].size).reshape(nodes.shape[:3])
    ways = np.cumsum([[[0] * 3, *np.eye(3, dtype=int)[list(p)]] for p in itertools.permutations(range(3))], axis=1)
    ways[[1, 2, 5]] = ways[[1, 2, 5]][:, [0, 2, 1, 3]]
    cells = np.concatenate([np.stack([number[i:4 + i, j:1 + j, k:1 + k].ravel() for i, j, k in way], -1) for way in ways])
    nodes = nodes.reshape(-1, 3)
    return nodes, cells, nodes + .02 * nodes[:, :1] ** 2 * [0, 0, 1]


class Page(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.here = Path(holder.name)

    def serve(self, problem, **how):
        page = problem.live(**how)
        self.addCleanup(page.close)
        return page

    def view(self, page):
        viewer = Viewer(Address(page.address))
        self.addCleanup(viewer.socket.close)
        return viewer

    def assertGone(self, page_address):
        address = Address(page_address)
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", address.port), timeout=10)

    def test_the_body_is_served_and_pulled(self):
        problem = exemplar.Problem(SCENE)
        with problem.live() as page:
            viewer = self.view(page)
            self.assertEqual((viewer.scene["cells"], len(viewer.poses)), (len(problem.cells), 2))
            self.assertIn(page.address, repr(page))
            viewer.grab(viewer.farthest(), strength=10.)
            viewer.move((4., 0., 2.), sequence=3)
            viewer.until(lambda: viewer.frames[-1].pointer == 3)
            viewer.wait_steps(10)
        self.assertGone(page.address)
        self.assertEqual(repr(page), "<exemplar live: closed>")
        page.close()
        self.assertEqual(problem.step_number, 0)

    def test_a_file_names_its_own_files(self):
        nodes, cells, _ = arrays()
        (self.here / "scenes").mkdir()
        (self.here / "scenes/mine.prm").write_text(SCENE.replace("boundary 1", "nodes list.txt"))
        (self.here / "scenes/list.txt").write_text("1 10 19 28 37 46 55 64 73")
        viewer = self.view(self.serve(exemplar.Problem(str(self.here / "scenes/mine.prm"))))
        self.assertEqual(viewer.scene["handles"][0]["name"], "left")

    def test_arrays_are_handed_over_and_the_session_is_kept(self):
        nodes, cells, pose = arrays()
        scene = {"Scene": "dynamic", "Mesh": {"Scale": 0.5}, "Handles": {"left": {"Select": ["box", 0, 0, 0, 0, 1, 1]}},
                 "Model": {"Dilatation": "cells"}}
        problem = exemplar.Problem(scene, mesh=(nodes, cells, np.arange(len(cells)) % 2), poses=[pose])
        record = self.here / "session"
        viewer = self.view(page := self.serve(problem, record=record))
        self.assertAlmostEqual(max(x for x, _, _ in viewer.frames[-1].places), 2., delta=1e-4)
        self.assertAlmostEqual(max(z for _, _, z in viewer.poses[1].places), .5 * pose[:, 2].max(), delta=1e-4)
        viewer.grab(viewer.farthest(), strength=5.)
        viewer.move((2., 0., 1.))
        viewer.wait_steps(20)
        viewer.send(type="pause", on=True)
        viewer.until(lambda: viewer.wait_for("status")["paused"])
        shown = sorted(viewer.frames[-1].places)
        page.close()
        again = exemplar.Problem(str(record / "scene.prm"))
        again.run()
        self.assertEqual(len(again.cells), len(cells))
        np.testing.assert_allclose(sorted(map(tuple, again.positions)), shown, atol=1e-4)

    def test_nobody_needs_it(self):
        page = exemplar.Problem(SCENE).live()
        address = page.address
        del page
        gc.collect()
        self.assertGone(address)

    def test_what_the_page_would_not_have_is_refused(self):
        def changed(change):
            problem = exemplar.Problem(SCENE)
            change(problem)
            with self.assertRaises(exemplar.UserError) as refusal:
                problem.live()
            return problem, str(refusal.exception)

        for change, words in ((lambda p: p.set_material(young=1e5), r"changed by set_material\(\)"), (lambda p: p.step(), r"gone on by step\(\)"),
                              (lambda p: p.set_motion("left", lambda rest, t: 0 * rest), r"changed by set_motion\(\)"),
                              (lambda p: setattr(p, "gravity", [0, 0, -1]), "changed by gravity"),
                              (lambda p: setattr(p, "state", p.state.replace(velocities=p.velocities + 1)), "gone on by state")):
            with self.subTest(words):
                self.assertRegex(changed(change)[1], words)
        problem, _ = changed(lambda p: p.step())
        problem.reset()
        self.view(self.serve(problem))

    def test_bad_arguments(self):
        (self.here / "mine.txt").write_text("mine")
        problem = exemplar.Problem(SCENE)
        static = exemplar.Problem(prm({**BAR, "Scene": "static"}))
        for call, words in ((lambda: static.live(), "only dynamic scenes"), (lambda: problem.live(port=70000), "port is 70000"),
                            (lambda: problem.live(port="x"), "port is 'x'"), (lambda: problem.live(record=self.here), "neither an empty directory"),
                            (lambda: problem.live(record=self.here / "mine.txt"), "no directory")):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                call()
        with self.assertRaisesRegex(TypeError, r"live is called as live\("):
            problem.live(1, 2, 3)
        taken = self.serve(problem)
        with self.assertRaisesRegex(exemplar.UserError, "Nobody can listen"):
            problem.live(port=Address(taken.address).port)
        self.assertEqual(sorted(file.name for file in self.here.iterdir()), ["mine.txt"])


if __name__ == "__main__":
    unittest.main()
