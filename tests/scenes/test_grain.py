# SPDX-License-Identifier: GPL-3.0-or-later
"""Fibres and orthotropy in whole scenes, against linear elasticity and by what must not change."""

import math
import unittest

from exemplar_runner import SceneTest, greatest_distance, nodes_of, read_csv, results

E, NU, ALPHA = 1e5, 0.3, 4e5
SMALL = 1e-6  # a strain at which the model is linear
BLOCK = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "1, 1, 1",
    "Mesh/Box cells": "2, 2, 2",
    "Material/Young's modulus": str(E),
    "Material/Poisson's ratio": str(NU),
    "Material/Fibre stiffness": str(ALPHA),
    "Solver/Tolerance": "1e-12",
    "Time/Increments": "1",
    "Output/Every": "0",
    "Handles/Names": "x-, y-, z-, x+",
    "Handles/x+/Select": "boundary 2",
    "Handles/x+/Components": "x",
    "Handles/x+/Motion": f"{SMALL}*t; 0; 0",
    **{f"Handles/{name}/{key}": value
       for name, side, component in (("x-", 1, "x"), ("y-", 3, "y"), ("z-", 5, "z"))
       for key, value in (("Select", f"boundary {side}"), ("Components", component))}}
BAR = {
    "Mesh/Generator": "box",
    "Mesh/Box size": "4, 1, 1",
    "Mesh/Box cells": "8, 2, 2",
    "Material/Young's modulus": "1e5",
    "Material/Fibre stiffness": "1e6",
    "Material/Fibre direction": "0.5; -z; y",
    "Output/Every": "0",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1"}
EXAMPLE = {"Examples/Pose functions": "(8/pi-z)*sin(pi*x/8); y; 8/pi-(8/pi-z)*cos(pi*x/8)"}


def modulus_in(direction):
    """Of a tension along x where fibres lie in `direction`, without shear stress: 1/(a.S a)."""
    # C = C_iso + alpha (aa)(aa), so S = S_iso - (S_iso:aa)(S_iso:aa) / (1/alpha + 1/E); S_iso:aa has the xx entry
    c = direction[0] ** 2 / sum(d * d for d in direction)
    along_x = ((1 + NU) * c - NU) / E
    return 1 / (1 / E - along_x ** 2 / (1 / ALPHA + 1 / E))


class Grain(SceneTest):
    def last_row(self, scene, **keywords):
        return read_csv(self.solve(scene, **keywords))[-1]

    def test_tension(self):
        """Along the fibres and across, and where they lie at an angle and nothing but x is held."""
        for direction in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
            for model in ({"Model/Dilatation": "cells"}, {"Model/Dilatation": "patches"}, {"Model/Element": "P2"}):
                with self.subTest(direction=direction, **{key.split("/")[1]: value for key, value in model.items()}):
                    row = self.last_row({**BLOCK, **model, "Material/Fibre direction": "; ".join(map(str, direction))})
                    self.assertAlmostEqual(abs(row["reaction_x+_x"]) / (SMALL * modulus_in(direction)), 1, delta=1e-5)

    def test_tension_at_an_angle(self):
        """The end may move sideways: shear follows the pull, and the stress stays a tension along x."""
        for direction in ((1, 1, 0), (2, 0, 1), (1, 2, 2)):
            scene = {**BLOCK, "Material/Fibre direction": "; ".join(map(str, direction)), "Handles/Names": "x-, o, p, x+",
                     **{f"Handles/{name}/{key}": None for name in ("y-", "z-") for key in ("Select", "Components")},
                     **{f"Handles/{name}/{key}": value
                        for name, place, components in (("o", "0 -0.5 -0.5", "y, z"), ("p", "0 0.5 -0.5", "z"))
                        for key, value in (("Select", f"sphere {place} 0.01"), ("Components", components))}}
            with self.subTest(direction=direction):
                row = self.last_row(scene)
                # x- holds the plane x = 0 in x, so that shear in it is free and nothing resists
                self.assertAlmostEqual(abs(row["reaction_x+_x"]) / (SMALL * modulus_in(direction)), 1, delta=1e-5)

    def test_nine_constants(self):
        """A tension along each axis of an orthotropic block has its modulus."""
        constants = "3e5, 1e5, 5e4, 0.3, 0.4, 0.35, 2e4, 3e4, 4e4"
        for along, across, modulus in (("1; 0; 0", "0; 1; 0", 3e5), ("0; 1; 0", "1; 0; 0", 1e5),
                                       ("0; 0; 1", "0; 1; 0", 5e4), ("0; 0; 1", "1; 0; 0", 1e5)):
            for model in ({"Model/Dilatation": "patches"}, {"Model/Element": "P2"}):
                scene = {**BLOCK, **model, "Material/Fibre stiffness": "0", "Material/Orthotropy": constants,
                         "Material/Fibre direction": along, "Material/Cross direction": across}
                with self.subTest(along=along, across=across, **{"m": str(model)}):
                    self.assertAlmostEqual(abs(self.last_row(scene)["reaction_x+_x"]) / (SMALL * modulus), 1, delta=1e-5)

    def test_isotropic_regions_beside_orthotropic_ones(self):
        """Where one region has nine constants that are isotropic, the others stay as they were."""
        scene = {**BLOCK, "Material/Fibre stiffness": None}
        shear = E / (2 * (1 + NU))
        of_region = {"Material/region 1/Orthotropy": f"{E}, {E}, {E}, {NU}, {NU}, {NU}, {shear}, {shear}, {shear}",
                     "Material/region 1/Fibre direction": "1; 2; 3"}
        row = self.last_row({**scene, **of_region})
        self.assertAlmostEqual(abs(row["reaction_x+_x"]) / (SMALL * E), 1, delta=1e-5)
        elsewhere = {"Material/Orthotropy": of_region["Material/region 1/Orthotropy"], "Material/Fibre direction": "1; 2; 3",
                     "Material/region 1/Orthotropy": ""}
        row = self.last_row({**scene, **elsewhere})
        self.assertAlmostEqual(abs(row["reaction_x+_x"]) / (SMALL * E), 1, delta=1e-5)

    def test_pulled_bar_twists(self):
        scene = {**BAR, "Scene": "static", "Time/Increments": "2", "Handles/Names": "left, right",
                 "Handles/right/Select": "boundary 2", "Handles/right/Motion": "0.8*t; 0; 0",
                 "Handles/right/Components": "x"}
        for method, pull, least in (("newton", 0.8, 5), ("fixed point", 0.04, 0.2)):
            with self.subTest(method):
                scene["Handles/right/Motion"] = f"{pull}*t; 0; 0"
                corner = self.corner({**scene, "Solver/Method": method})
                angle = math.degrees(math.atan2(corner[2], corner[1])) - 45
                self.assertGreater(abs(angle), least)
                mirrored = self.corner({**scene, "Solver/Method": method,
                                        "Material/Fibre direction": "0.5; z; -y"})
                back = math.degrees(math.atan2(mirrored[2], mirrored[1])) - 45
                self.assertLess(angle * back, 0)

    def corner(self, scene):
        """Where the corner (4, 0.5, 0.5), the last node of the box, has come to."""
        return list(nodes_of(self.solve(scene) / "final.msh").values())[-1]

    def test_without_stiffness_nothing_changes(self):
        scene = {**BAR, **EXAMPLE, "Scene": "dynamic", "Loads/Gravity": "0, 0, -9.81", "Time/Step": "0.02", "Time/End": "0.1"}
        run = self.attempt({**scene, "Material/Fibre stiffness": "0"}, output="zero")
        self.assertIn("Material/Fibre direction = 0.5; -z; y does nothing without a Material/Fibre stiffness", run.stderr)
        with_keys = results(run.output)
        without = results(self.solve({**scene, "Material/Fibre stiffness": None, "Material/Fibre direction": None}))
        self.assertEqual(with_keys, without)

    def test_resumed_run_has_the_same_bytes(self):
        scene = {**BAR, **EXAMPLE, "Scene": "dynamic", "Loads/Gravity": "0, 0, -9.81", "Time/Step": "0.02", "Time/End": "0.1"}
        whole = results(self.solve(scene, output="whole"))
        self.solve({**scene, "Time/End": "0.04"})
        self.assertEqual(results(self.solve(scene, "--resume")), whole)

    def test_every_way_to_one_step(self):
        """Newton's and the quasi-Newton method agree, with examples, damping, and several threads."""
        scene = {**BAR, **EXAMPLE, "Scene": "dynamic", "Loads/Gravity": "0, 0, -9.81", "Time/Step": "0.02", "Time/End": "0.2",
                 "Time/Stiffness damping": "0.01", "Solver/Tolerance": "1e-10", "Solver/Step tolerance": "1e-9"}
        first = nodes_of(self.solve({**scene, "Solver/Method": "newton"}) / "final.msh")
        for other in ({"Solver/Method": "quasi newton"}, {"Solver/Linear solver": "iterative"}):
            with self.subTest(**{"o": str(other)}):
                places = nodes_of(self.solve({**scene, **other}) / "final.msh")
                self.assertLess(greatest_distance(first, places), 1e-6)

    def test_examples_act_on_a_part_of_the_strain(self):
        """Without load and with importance 1 the block takes that part of its example's strain, 0.1 along x."""
        pull = 0.1
        for acts_on, stretches in (("all", (pull, 0, 0)), ("volume", (pull / 3,) * 3),
                                   ("shape", (2 * pull / 3, -pull / 3, -pull / 3)),
                                   ("along fibres", (pull, -NU * pull, -NU * pull)),
                                   ("across fibres", (0, NU * pull, NU * pull))):
            stiffness, direction = (str(ALPHA), "1; 0; 0") if "fibres" in acts_on else ("0", None)
            scene = {**BLOCK, "Handles/Names": "x-, y-, z-", "Examples/Pose functions": f"{1 + pull}*x; y; z",
                     **{f"Handles/x+/{key}": None for key in ("Select", "Components", "Motion")},
                     "Examples/Importance": "1", "Examples/Weights": "prescribed", "Examples/Prescribed weights": "0; 1",
                     "Examples/Acts on": acts_on, "Material/Fibre stiffness": stiffness, "Material/Fibre direction": direction}
            with self.subTest(acts_on):
                places = nodes_of(self.solve(scene) / "final.msh").values()
                for component, stretch in enumerate(stretches):
                    extent = max(x[component] for x in places) - min(x[component] for x in places)
                    self.assertAlmostEqual(extent, 1 + stretch, delta=1e-8)

    def test_refused_in_words(self):
        for changes, words in (
                ({"Model/Gradient": "frozen", "Solver/Method": "fixed point"}, "frozen force would turn"),
                ({"Model/Strain": "green"}, "are for Model/Strain = corotational"),
                ({"Material/Fibre direction": None}, "needs to know the direction of the fibres"),
                ({"Material/Fibre direction": "0; 0; 0"}, "is 0 in"),
                ({"Material/Fibre direction": "from boundary 1"}, "from SELECTION to SELECTION"),
                ({"Material/Fibre stiffness": "0", "Examples/Acts on": "along fibres", **EXAMPLE}, "no material has any"),
                ({"Material/Orthotropy": "1, 2, 3"}, "nine numbers"),
                ({"Material/Orthotropy": "1e5, 1e5, 1e5, 0.6, 0.6, 0.6, 1e5, 1e5, 1e5",
                  "Material/Cross direction": "0; 0; 1"}, "makes no elastic material"),
                ({"Material/Orthotropy": "3e5, 1e5, 5e4, 0.3, 0.4, 0.35, 2e4, 3e4, 4e4"}, "Cross direction")):
            with self.subTest(words):
                run = self.attempt({**BAR, "Scene": "static", **changes})
                self.assertEqual(run.status, 1)
                self.assertIn(words, " ".join(run.stderr.split()))


if __name__ == "__main__":
    unittest.main()
