# SPDX-License-Identifier: GPL-3.0-or-later
"""The volume that a shell encloses (Material/Volume stiffness) against numpy, closed forms, and what is refused of it."""

import math
import unittest

import numpy as np

import shell_reference as reference
from exemplar_runner import SceneTest, greatest_distance, nodes_of, read_csv
from shell_meshes import ball, obj_text, strip

E, NU, THICKNESS = 1e5, .3, .02
BALL = {"Scene": "static", "Mesh/Kind": "shell", "Mesh/File": "ball.obj", "Material/Thickness": str(THICKNESS), "Material/Young's modulus": str(E),
        "Material/Poisson's ratio": str(NU), "Output/Every": "0", "Solver/Tolerance": "1e-10", "Time/Increments": "1"}
PRESSED = {"Handles/Names": "low, high", "Handles/low/Select": "box -2 -2 -2 2 2 -0.6", "Handles/high/Select": "box -2 -2 0.6 2 2 2",
           "Handles/low/Slopes": "free", "Handles/high/Slopes": "free", "Handles/high/Motion": "0; 0; -0.3*t"}
SQUASHED = {"Examples/Pose functions": "1.2*x; 1.2*y; 0.7*z", "Examples/Importance": "0.9", "Examples/Weight penalty": "1e-3",
            "Examples/Energy": "scaled"}


def places(directory):
    """Vertices of final.msh, in their order."""
    return np.array([place for _, place in sorted(nodes_of(directory / "final.msh").items())])


def volume(vertices, triangles):
    a, b, c = (vertices[np.array(triangles)[:, i]] for i in range(3))
    return np.sum(a * np.cross(b, c)) / 6.


class EnclosedVolumes(SceneTest):
    def press(self, keys, *arguments, halvings=2, output="out", at=(0., 0., 0.)):
        points, self.triangles = ball(halvings)
        self.write("ball.obj", obj_text([tuple(x + d for x, d in zip(p, at)) for p in points], self.triangles))
        return self.solve({**BALL, **PRESSED, **keys}, *arguments, output=output)

    def change(self, output):
        rest, _ = ball(2)
        return volume(places(output), self.triangles) / volume(np.array(rest), self.triangles) - 1.

    def test_a_pressed_ball_keeps_its_volume_the_better_the_stiffer(self):
        for kind in ("plate", "hinges"):
            changes = {K: self.change(self.press({"Model/Shell": kind, "Material/Volume stiffness": K}, output=f"{kind}{K}"))
                       for K in ("0", "1e5", "1e7", "1e8")}
            self.assertLess(changes["0"], -.1)
            self.assertLess(abs(changes["1e5"]), .3 * abs(changes["0"]))
            self.assertAlmostEqual(changes["1e8"] / changes["1e7"], .1, delta=2e-3)  # the pressure is that of a body that keeps it

    def test_positions_and_weights_are_those_of_another_program(self):
        points, triangles = ball(1)
        unit = 5e3 * volume(np.array(points), triangles)
        shell = reference.Shell(points, triangles, THICKNESS)
        C = reference.stiffness(E, NU)
        posed = np.array(points) * (1.2, 1.2, .7)
        full = shell.positions(posed, reference.least_bending_slopes(shell, posed, C))
        targets = .9 * np.stack([np.zeros((len(triangles), 6)), shell.strains(full[shell.local]).real])
        volumes = .9 * np.array([0., shell.enclosed(full)[0]])
        held = np.abs(shell.rest[:, 2]) > .6
        start = shell.positions(shell.rest - np.outer(shell.rest[:, 2] > .6, (0., 0., .3)))
        free = np.array([d for d in range(3 * len(points)) if not held[d // 3]]
                        + [3 * (len(points) + k) for k in range(len(shell.edges))])
        x, w = reference.equilibrium(shell, C, free, start, np.zeros(shell.n_dofs), targets, [.5, .5], 1e-3 * np.eye(2), True, 1e-11,
                                     unit, volumes)
        self.assertTrue(.1 < w[1] < .9)
        output = self.press({"Material/Volume stiffness": "5e3", **SQUASHED}, halvings=1)
        self.assertLess(np.abs(places(output) - x[:3 * len(points)].reshape(-1, 3)).max(), 1e-9)
        self.assertAlmostEqual(read_csv(output)[-1]["weight_1"], w[1], delta=1e-9)
        loose = self.press({**SQUASHED}, halvings=1, output="loose")
        self.assertGreater(greatest_distance(nodes_of(output / "final.msh"), nodes_of(loose / "final.msh")), 1e-3)

    def test_a_blend_of_sizes_has_the_volume_in_between(self):
        """All strains and the volume ask for the same: a ball of 1 + .2 w of its radius has none but the volume's cubic excess."""
        output = self.press({"Scene": "interpolation", "Handles/Names": "", "Handles/low/Select": None, "Handles/high/Select": None,
                             "Handles/low/Slopes": None, "Handles/high/Slopes": None, "Handles/high/Motion": None,
                             "Material/Volume stiffness": "1e9", "Examples/Pose functions": "1.2*x; 1.2*y; 1.2*z",
                             "Examples/Importance": "1", "Examples/Prescribed weights": "0.5; 0.5"})
        self.assertAlmostEqual(self.change(output), .5 * (1.2**3 - 1.), delta=1e-5)
        radii = np.linalg.norm(places(output), axis=1)
        self.assertAlmostEqual(radii.mean(), (1. + .5 * (1.2**3 - 1.))**(1. / 3.), delta=1e-3)

    def test_a_falling_ball_keeps_momentum_volume_and_bytes(self):
        keys = {"Scene": "dynamic", "Time/Step": "0.01", "Time/End": "0.1", "Time/Increments": None, "Material/Volume stiffness": "1e7",
                "Handles/high/Until": "0.05", "Handles/low/Until": "0.05", "Handles/high/Motion": "0; 0; -2*t", "Time/Stiffness damping": "1e-3",
                "Examples/Pose functions": "1.2*x; 1.2*y; 0.7*z", "Solver/Step tolerance": "1e-9", "Solver/Tolerance": None}
        one = self.press(keys, output="one")
        self.assertLess(abs(self.change(one)), 2e-3)
        rows = read_csv(one)
        self.assertAlmostEqual(rows[-1]["momentum_z"], rows[-3]["momentum_z"], delta=1e-6 * abs(rows[-1]["momentum_z"]))
        self.assertEqual((one / "final.msh").read_bytes(), (self.press(keys, "--threads", "2", output="two") / "final.msh").read_bytes())
        half = self.press({**keys, "Time/End": "0.06"}, output="half")
        self.assertEqual(self.attempt({**BALL, **PRESSED, **keys}, "--resume", output="half").status, 0)
        self.assertEqual((one / "final.msh").read_bytes(), (half / "final.msh").read_bytes())

    def test_two_balls_far_from_the_origin(self):
        points, triangles = ball(1)
        both = [(x, y, z) for x, y, z in points] + [(x + 3., y, z) for x, y, z in points]
        faces = triangles + [tuple(v + len(points) for v in face) for face in triangles]
        found = []
        for name, far in (("near", 0.), ("far", 1e3)):
            self.write("ball.obj", obj_text([(x + far, y, z) for x, y, z in both], faces))
            output = self.solve({**BALL, **PRESSED, "Material/Volume stiffness": "1e6", "Solver/Tolerance": "1e-8",
                                 "Handles/low/Select": f"box {far - 2} -2 -2 {far + 5} 2 -0.6",
                                 "Handles/high/Select": f"box {far - 2} -2 0.6 {far + 1.5} 2 2"}, output=name)
            found.append(places(output) - (far, 0., 0.))
        self.assertLess(np.abs(found[0] - found[1]).max(), 1e-8)
        second = found[0][len(points):] - (3., 0., 0.)
        self.assertLess(np.abs(second - np.array(points)).max(), 1e-9)  # nothing presses it

    def test_what_is_refused(self):
        def refuse(words, keys, vertices, faces):
            self.write("ball.obj", obj_text(vertices, faces))
            run = self.attempt({**BALL, "Material/Volume stiffness": "1e6", **keys})
            self.assertEqual(run.status, 1)
            self.assertIn(words, run.stderr)
        points, triangles = ball(1)
        refuse("open at the edge from (", {}, points, triangles[1:])
        refuse("open at the edge from (", {}, *strip(1., 1., 4, 4))
        flattened = [(x, y, 0.) for x, y, _ in points]
        refuse("encloses no volume at rest", {}, flattened, triangles)
        refuse("Linear solver", {"Solver/Linear solver": "umfpack"}, points, triangles)
        refuse("Linear solver", {"Solver/Linear solver": "iterative"}, points, triangles)


if __name__ == "__main__":
    unittest.main()
