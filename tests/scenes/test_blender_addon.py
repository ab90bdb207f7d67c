# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on of source/blender in Blender without a window: from an object with a shape key and an armature to the animated result."""

import json
import math
import os
import subprocess
import sys
import unittest

from exemplar_runner import EXEMPLAR, REPOSITORY, SceneTest
from test_blender import BLENDER, ENVIRONMENT


def use_addon(directory, script, *arguments):
    """Pack the add-on and let Blender run a script of tests/blender with it; what the script has found."""
    addon, result = directory / "exemplar_addon.zip", directory / "result.json"
    subprocess.run([sys.executable, REPOSITORY / "source/blender/pack_addon.py", addon], check=True)
    own = {"BLENDER_USER_CONFIG": str(directory / "config"), "BLENDER_USER_SCRIPTS": str(directory / "scripts")}
    done = subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                           REPOSITORY / "tests/blender" / script, "--", addon, EXEMPLAR, directory, result, *arguments],
                          cwd=directory, text=True, env={**os.environ, **ENVIRONMENT, **own}, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=300)
    if done.returncode != 0:
        raise AssertionError(done.stdout)
    return json.loads(result.read_text())


def farthest(places, others):
    return max(math.dist(x, y) for x, y in zip(places, others))


def middle_of(places):
    return [sum(x[c] for x in places) / len(places) for c in range(3)]


@unittest.skipUnless(BLENDER, "there is no blender (Debian: apt-get install blender)")
class AddOn(SceneTest):
    def test_from_keys_and_an_armature_to_the_result(self):
        found = use_addon(self.directory, "run_addon.py")
        self.assertEqual(found["said"], "Done.")
        self.assertEqual((found["keys"], found["range"]), (["Basis", "bent"], [3, 18]))
        self.assertGreater(found["frames seen"], 1)
        # the upper end is where the armature has it, the lower one where it was, and the shape key is recognised
        high = [i for i, x in enumerate(found["rest"]) if abs(x[2] - 5.) < 1e-5]
        low = [i for i, x in enumerate(found["rest"]) if abs(x[2] - 1.) < 1e-5]
        self.assertEqual((len(high), len(low)), (25, 25))
        self.assertLess(max(math.dist(found["end"][i], found["rig"][i]) for i in high), 1e-2)
        self.assertGreater(min(math.dist(found["rest"][i], found["rig"][i]) for i in high), 1.5)
        self.assertLess(max(math.dist(found["end"][i], found["rest"][i]) for i in low), 1e-2)
        self.assertEqual(found["weights"][0], 0.)
        self.assertGreater(found["weights"][-1], .8)

        # what it wears lies .05 above the upper end, whose normal turns by 60 degrees
        end = [found["end"][i] for i in high]
        middle = [sum(x[c] for x in end) / 25 for c in range(3)]
        hat = [sum(x[c] for x in found["hat"]) / 4 for c in range(3)]
        self.assertLess(math.dist(hat, [middle[0] + .05 * math.sin(math.pi / 3), middle[1], middle[2] + .025]), .02)

        # what an artist may run again, without Blender
        self.assertEqual(found["directory"], str(self.directory / "my film_bar"))
        scene = self.directory / "kept/scene.prm"
        self.assertIn("set Young's modulus map = groups.csv:stiffness from 0.1 to 10", scene.read_text())
        output = self.solve(scene.read_text(), "--quiet", output="again", file="kept/scene.prm")
        self.assertEqual((output / "animation.pc2").read_bytes(), (self.directory / "kept/output/animation.pc2").read_bytes())

        # a mirrored body runs as well, and what was renamed stays
        self.assertEqual(found["mirrored"], "Done.")
        self.assertLess(max(math.dist(found["second end"][i], found["second rig"][i]) for i in high), 1e-2)
        self.assertIn("is the result of a run", found["result"])

        self.assertEqual((found["status"], found["timer"]), ("{'FINISHED'}", True))
        self.assertIn("bar is running. Cancel that first", found["twice"])
        self.assertIn("cannot be written (File exists). Save the .blend elsewhere", found["no directory"])
        self.assertIn("Save the .blend first", found["unsaved"])
        self.assertIn("bar has no vertex group 'gone'", found["no group"])
        self.assertEqual((found["cancelled"], found["hidden"]), ("Cancelled.", False))
        self.assertEqual(found["objects"], ["bar", "bar residual", "bar residual.001", "bar result", "hat", "hat result", "hat result.001", "mine", "rig"])
        self.assertIn("holes: 1", found["hole"])
        self.assertIn("0 faces and 4 vertices with faults are selected", found["hole"])
        self.assertEqual(found["selected"], [0, 1, 2, 3])


@unittest.skipUnless(BLENDER, "there is no blender (Debian: apt-get install blender)")
class Characters(SceneTest):
    """Bodies as artists have them: tests/blender/run_character.py."""

    def use(self, case):
        return use_addon(self.directory, "run_character.py", case)

    def assert_shows_the_run(self, found):
        self.assertEqual(len(found["shown"]), 16)
        for shown, of_run in zip(found["shown"], found["run"]):
            self.assertLess(farthest(shown, of_run), 2e-6)

    def test_a_rigged_character_comes_back_as_it_was(self):
        found = self.use("character")
        self.assertEqual(found["said"], "Done.")
        self.assertEqual(found["after"], found["before"])
        self.assertEqual(found["modifiers"], [["rig", False, False], ["exemplar residual", True, True], ["fine", True, True]])
        self.assertGreater(found["fine"], 3 * len(found["run"][0]))
        self.assertEqual(found["hidden"], [True, True])  # the original, also from renders
        self.assert_shows_the_run(found)
        # examples are keys that move something and are not muted, each as it is seen
        self.assertEqual(sorted(found["values"]), ['key_blocks["bent"].value', 'key_blocks["more"].value'])
        self.assertGreater(found["values"]['key_blocks["bent"].value'], .9)
        self.assertGreater(farthest(found["more"], found["before places"]), .5)
        self.assertLess(farthest(found["more"], found["pose 2"]), 1e-6)

        # it begins as the rig has it, held and balanced, and does not jump
        self.assertGreater(farthest(found["rig"][0], found["before places"]), .5)
        self.assertLess(farthest(found["rig"][0], found["run"][0]), 1e-3)
        self.assertLess(farthest(found["run"][0], found["run"][1]), .1)
        self.assertIn("set Balanced = true", found["prm"])
        head = [i for i, x in enumerate(found["before places"]) if abs(x[2] - 5.) < 1e-5]
        feet = [i for i, x in enumerate(found["before places"]) if abs(x[2] - 1.) < 1e-5]
        self.assertLess(max(math.dist(found["run"][-1][i], found["rig"][1][i]) for i in head), 1e-2)
        self.assertLess(max(math.dist(found["run"][-1][i], found["rig"][0][i]) for i in feet), 1e-2)

        # what the armature or a bone carries goes along, with its modifiers, and nothing else is taken for clothes
        self.assertEqual(found["collar"], [["rig", False, False], ["exemplar", True, True], ["cloth", True, True], ["hug", False, True]])
        self.assertEqual((found["hug"], found["curves"]), ("bar result", ['modifiers["fine"].levels']))
        self.assertEqual(found["eye"], [["exemplar", True, True]])
        self.assertEqual([name for name in found["objects"] if name.endswith("result")], ["bar result", "collar result", "eye result"])
        self.assertEqual(len(found["collar ends"][0]), 8)
        for name in ("collar ends", "eye ends"):
            self.assertLess(math.dist(*map(middle_of, found[name])), .15)

        self.assertEqual(sorted(found["caches"]), [f"//film_bar/take_1_{name}.pc2" for name in ("residual", "worn_1", "worn_2")])
        self.assertLess(farthest(found["moved folder"], found["run"][-1]), 2e-6)

    def test_half_of_a_body_is_mirrored(self):
        found = self.use("half")
        self.assertEqual((found["said"], found["vertices"]), ("Done.", 226))
        self.assertEqual(found["modifiers"],
                         [["other side", False, False], ["rig", False, False], ["exemplar residual", True, True], ["fine", True, True]])
        after = found["after"]
        self.assertEqual((after["keys"], after["groups"]), ([["Basis", False], ["thick", False]], ["feet", "low", "head", "high"]))
        self.assertEqual((after["materials"], after["uv name"], set(after["smooth"])), (["fur"], "skin", {True}))
        self.assertEqual(sum(0 in groups for groups in after["group of"]), 25)
        self.assert_shows_the_run(found)
        self.assertEqual(found["stray keys"], 0)
        self.assertEqual(found["without rig"], ["Done.", 226])

    def test_the_unit_of_the_scene(self):
        found = self.use("centimetres")
        self.assertEqual((found["metres said"], found["centimetres said"]), ("Done.", "Done."))
        self.assertLess(min(x[2] for x in found["metres"]), 1.)
        self.assertLess(farthest(found["metres"], found["centimetres"]), .05)
        self.assertEqual([round(g, 4) for g in found["gravity"]], [0., 0., -9.81])  # -981 cm/s^2

    def test_keys_that_add_up(self):
        found = self.use("added")
        self.assertEqual(found["said"], "Done.")
        self.assertIn("set Weights = additive\n", found["prm"])
        self.assertIn("set Energy = scaled\n", found["prm"])  # keys lead
        self.assertEqual(found["keys"], ["Basis", "bent"])
        self.assert_shows_the_run(found)

    def test_keyed_values_are_the_weights(self):
        """Through the program and back they are the same to .1 %, in each frame."""
        found = self.use("keyed_weights")
        self.assertIn("shape keys of bar are 0 in all frames", found["still"])
        self.assertIn("Regions are Found", found["painted"])
        self.assertIn("Done.", found["said"])
        for line in ("Weights = prescribed", "Weights file = weights.csv"):
            self.assertIn(f"set {line}\n", found["prm"])
        self.assertNotIn("set Energy", found["prm"])
        self.assertGreater(max(sum(row) for row in found["wanted"]), 1.2)
        self.assertEqual(len(found["values"]), 16)
        for values, wanted in zip(found["values"], found["wanted"]):
            self.assertLess(max(abs(a - b) for a, b in zip(values, wanted)), 1e-3)
        self.assert_shows_the_run(found)

    def test_regions_weights_and_damping(self):
        found = self.use("regions")
        self.assertEqual(found["said"], "Done.")
        self.assertEqual(found["keys"], ["Basis", "bent", "bent elsewhere", "bent top", "bent foot"])
        for line in ("Weights = free", "Weight maps = groups.csv:region_1, groups.csv:region_2", "Mass damping = 1",
                     "Stiffness damping = 0.01", "Every = 2"):
            self.assertIn(f"set {line}\n", found["prm"])
        self.assert_shows_the_run(found)

    def test_what_has_collision_physics_is_not_passed(self):
        found = self.use("obstacles")
        self.assertIn("Done.", found["said"])
        self.assertIn("floor: bar may not pass them, and Balanced does nothing", found["said"])
        for line in ("Names = obstacle 1", "Shape = surface obstacle_1.obj", "Friction = 0.25", "Follow cache = obstacle_1.mdd", "Balanced = false"):
            self.assertIn(f"set {line}\n", found["prm"])
        self.assertEqual(len(found["least"]), 16)
        for frame, least in enumerate(found["least"]):
            self.assertGreater(least, .7 + .2 * frame / 15 - .01)  # between frames Blender eases, the floor is lower than on the straight way
        self.assertLess(min(found["least"]), .95)  # it has fallen from 1
        self.assertGreater(found["least"][-1], .9)
        self.assertLess(found["least"][-1], 1.)
        self.assertIn("What has Collision physics keeps its vertices", found["grows"])

    def test_a_shell(self):
        found = self.use("shell")
        self.assertIn("Done.", found["said"])
        self.assertIn("badge: a shell carries nothing, so what bar wears stays where it is.", found["said"])
        for line in ("Kind = shell", "Thickness = 0.005", "Thickness map = groups.csv:thickness from 0.1 to 10.0", "Poses = pose_1.obj",
                     "Select = map groups.csv:pin above 0.5", "Shape = surface obstacle_1.obj"):
            self.assertIn(f"set {line}\n", found["prm"])
        for key in ("Cells", "Repair", "Carry", "Balanced = true"):
            self.assertNotIn(key, found["prm"])
        self.assertEqual(found["keys"], ["Basis", "curl"])
        self.assert_shows_the_run(found)
        least = [min(z for _, _, z in frame) for frame in found["run"]]
        self.assertGreater(min(least), .6)  # half of the thickness above the table at least
        self.assertLess(least[-1], .65)
        self.assertIn("Regions that are found are of solid bodies, and bar is a shell", found["found regions"])
        self.assertIn("Muscles are in solid bodies", found["muscle"])

    def test_a_body_that_touches_itself(self):
        found = self.use("touches_itself")
        self.assertIn("bar touches itself, and Balanced does nothing beside that", found["said"])
        self.assertIn("set Self = true\n", found["prm"])
        self.assertLess(found["least"][-1], 4.1)  # from 4.3
        self.assertTrue(all(least > top - .02 for least, top in zip(found["least"], found["top"])), (found["least"], found["top"]))

    def test_several_bodies(self):
        found = self.use("bodies")
        self.assertIn("bar, second do not pass through each other, and Balanced does nothing beside that", found["said"])
        for line in ("Bodies = true", "Friction = 0.25", "Poses = pose_1.obj, pose_2.obj", "Carry = worn_1.obj, worn_2.obj", "Balanced = false"):
            self.assertIn(f"set {line}\n", found["prm"])
        for key in ("subsection Obstacles", "Self = true", "Follow cache"):
            self.assertNotIn(key, found["prm"])
        self.assertEqual(found["overlaps"], 16 * [0])
        middle = [middle_of(frame)[2] for frame in found["run"][1]]
        self.assertLess(middle[-1], middle[0] - .05)  # it has fallen, and lies on the other one
        self.assertGreater(min(middle), 4.8)
        # each object shows its slice of the run, and has what it had
        for shown, of_run in zip(found["shown"], found["run"]):
            self.assert_shows_the_run({"shown": shown, "run": of_run})
        self.assertEqual(found["after"], found["before"])
        self.assertEqual(found["modifiers"], [[["exemplar residual", True, True], ["touch", True, True]],
                                              [["exemplar residual", True, True], ["fine", True, True], ["touch", True, True]]])
        self.assertEqual(found["keyed"], [['key_blocks["bent"].value'], ['key_blocks["arched"].value']])
        self.assertEqual(found["parents"], ["bar result", "second result"])
        self.assertEqual(found["hidden"], 2 * [[True, True]])
        self.assertEqual([name for name in found["objects"] if name.endswith("result")],
                         [f"{name} result" for name in ("bar", "belt", "flag", "second")])
        self.assertEqual(found["caches"], [f"//film_bar/take_1_{name}.pc2" for name in ("residual", "residual_2", "worn_1", "worn_2")])

    def test_bodies_that_change_while_they_run(self):
        found = self.use("bodies_that_change")
        self.assertEqual(found["refused"], "")
        for line in ("Names = follow, pin", "Select = map groups.csv:pin above 0.5", "Follow cache = rig.mdd", "Bodies = true"):
            self.assertIn(f"set {line}\n", found["prm"])
        n = len(found["run"][0][0])
        # what has no painted stiffness has the factor .1 + 9.9 / 11 = 1
        self.assertEqual([set(found["stiffness"][:n]), set(found["stiffness"][n:])], [{"0.0909091"}, {"1"}])
        self.assertIn("second has other faces since the run began. The result is a surface without materials and modifiers.", found["said"])
        self.assertNotIn("bar has other faces", found["said"])
        self.assertEqual(found["overlaps"], 16 * [0])
        for shown, of_run in zip(found["shown"], found["run"]):
            self.assert_shows_the_run({"shown": shown, "run": of_run})
        self.assertEqual(found["hidden"], [True, True])
        for frame, led in zip((0, -1), found["led"]):
            self.assertEqual(len(led), 25)
            for place in led:
                self.assertLess(min(math.dist(place, x) for x in found["run"][1][frame]), 1e-2)
        self.assertEqual(found["preview"], [2 * n])
        self.assertEqual((found["hidden meanwhile"], found["cancelled"], found["seen"]), ([True, True], "Cancelled.", [True, True]))
        self.assertEqual([name for name in found["objects"] if "running" in name], [])
        self.assertIn("second is no more. The result is a surface without materials and modifiers.", found["deleted"])
        for shown, of_run in zip(found["shown of deleted"], found["run of deleted"]):
            self.assertLess(farthest(shown, of_run[-1]), 2e-6)

    def test_a_body_on_a_bone_of_another_one_and_regions_of_both(self):
        found = self.use("bodies_with_regions")
        self.assertIn("Done.", found["said"])
        self.assertIn("set Weight maps = groups.csv:region_1, groups.csv:region_2, groups.csv:region_3\n", found["prm"])
        self.assertIn("set Poses = pose_1.obj\n", found["prm"])
        self.assertNotIn("Carry", found["prm"])  # what is a body is not worn
        self.assertLess(farthest(found["written"], found["at rest"]), 1e-6)
        self.assertGreater(farthest(found["posed"], found["at rest"]), .5)
        self.assertLess(farthest(found["run"][1][0], found["posed"]), 1e-3)
        for shown, of_run in zip(found["shown"], found["run"]):
            self.assert_shows_the_run({"shown": shown, "run": of_run})
        for keys in found["keys"]:
            self.assertEqual(keys, ["Basis", "bent", *(f"bent {name}" for name in ("elsewhere", "top", "foot", "lens"))])
        self.assertIn("Repair drops what has less than 1 % of the volume of all bodies, as eye has.", found["small"])

    def test_mistakes_of_bodies_are_named(self):
        found = self.use("mistakes_of_bodies")
        self.assertIn("second has no vertex group 'gone'", found["no group"])
        self.assertIn("Shells meet no other bodies, and second is a shell", found["a shell"])
        self.assertIn("Shells meet no other bodies, and bar is a shell", found["shells"])
        self.assertRegex(found["parted by keys"], r"pieces of the mesh overlap near .* where the scene begins.* would separate them")
        self.assertIn(f"{sum(found['near'])} vertices near this place are selected", found["parted by keys"])
        self.assertGreater(sum(found["near"]), 0)
        self.assertIn("'bar', 'second': the surface does not bound a body", found["crossing"])
        self.assertIn("faces and 0 vertices with faults are selected", found["crossing"])
        self.assertGreater(min(found["selected"]), 0)
        self.assertIn("second lies inside of bar, and would be a part of it", found["inside"])
        self.assertIn("More bodies: these have become one piece.", found["one piece"])
        self.assertIn("More bodies: things has no other mesh that is seen, so bar moves alone.", found["alone"])
        self.assertNotIn("subsection Contact", found["alone prm"])
        for said in (found[name] for name in found if name not in ("selected", "near", "alone prm")):
            self.assertNotRegex(said, r"\b[A-Z][a-z]+/[A-Z]|\.obj|\.csv|exemplar: ")

    def test_the_muscle_of_one_of_several_bodies(self):
        found = self.use("bodies_with_a_muscle")
        self.assertIn("Done.", found["said"])
        self.assertIn("set Fibre tension map = groups.csv:muscle\n", found["prm"])
        of_first, of_second = ([max(x[axis] for x in frame) - min(x[axis] for x in frame) for frame in of_part]
                               for of_part, axis in zip(found["run"], (2, 0)))
        self.assertLess(of_first[-1], of_first[0] - .1)
        self.assertLess(max(abs(length - of_second[0]) for length in of_second), 1e-3)

    def test_pairs_that_touch_at_rest_are_selected(self):
        found = self.use("pairs_left_out")
        self.assertRegex(found["said"], r"\n\d+ pairs of parts of bar touch or cross at rest, and may pass through each other. "
                                        rf"{len(found['selected'])} vertices near the first pair are selected: see them in edit mode\.")
        self.assertTrue(found["selected"])
        self.assertTrue(all(min(x[2], 4. - x[2]) < 1. for x in found["selected"]), found["selected"])  # near the ends, which cross
        self.assertLess(max(math.dist(x, y) for x in found["at rest"] for y in found["at rest"]), 1.)

    def test_a_bone_drives_a_muscle(self):
        found = self.use("tension")
        self.assertIn("no vertex with a weight above 0.5 in a vertex group 'exemplar fibres from'", found["missing"])
        self.assertEqual(found["said"], "Done.")
        self.assertIn("set Fibre direction = from map groups.csv:fibres_from above 0.5 to map groups.csv:fibres_to above 0.5\n", found["prm"])
        self.assertRegex(found["prm"], r"set Fibre tension = max\(0,[-+.e0-9]+\*?.*min\(max\(24\*t-0,0\),1\)")
        lengths = [max(x[2] for x in frame) - min(x[2] for x in frame) for frame in found["run"]]
        self.assertAlmostEqual(lengths[0], 4, delta=1e-6)
        self.assertLess(lengths[-1], 3.9)  # it has drawn itself up
        for frame in found["nowhere run"]:
            self.assertLess(farthest(frame, found["nowhere run"][0]), 1e-3)

    def test_caught_and_let_go(self):
        found = self.use("spans")
        self.assertEqual(found["said"], "Done.")
        self.assertIn(f"set Until = {7 / 24:.9g}\n", found["prm"])
        self.assertIn(f"set From = {2 / 24:.9g}\n", found["prm"])
        self.assertIn("Follow is caught and let go in the same frame, 10.", found["same"])

    def test_messages_are_in_the_words_of_the_panel(self):
        found = self.use("words")
        self.assertIn("Balanced: the rest pose is an equilibrium, but no stable one", found["soft"])
        self.assertIn("its stiffness: Stiffness = ", found["soft"])
        self.assertIn("Its own weight makes this body sag", found["unbalanced"])
        self.assertIn("Nothing holds bar in the first frame, so it falls, and Balanced does nothing", found["nothing holds"])
        self.assertIn("set Balanced = false", found["nothing holds prm"])
        self.assertIn("has a weight above 0.5 in the vertex group 'nobody'", found["empty group"])
        self.assertIn("shape key 'inside out' is no pose of 'bar': it is a mirror image", found["bad key"])
        for said in (found[name] for name in found if not name.endswith("prm")):
            self.assertNotRegex(said, r"\b[A-Z][a-z]+/[A-Z]|\.obj|\.csv|exemplar: ")


if __name__ == "__main__":
    unittest.main()
