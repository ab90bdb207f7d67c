# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes by one, two and three processes: each process makes the same collective calls of MPI as the others, and the results are those
of one process, or all refuse the scene by the same message.

    python3 tests/scenes/test_collectives.py                     what ctest does: the first steps of each scene
    python3 tests/scenes/test_collectives.py --measure [NAME...]  the whole scenes, or those with NAME in their path: prints a table
"""

import math
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

from exemplar_runner import (REPOSITORY, SceneTest, greatest_distance, has_trilinos, messages_in, nodes_of, run_program, serve, set_words,
                             write_msh, write_scene)
from mpirun import first_difference, launch, mismatch
from surface_bar import bar_surface, obj_text

TIGHT = {"Solver/Tolerance": "1e-12", "Solver/Step tolerance": "1e-12"}
BOX = {"Mesh/Generator": "box", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2"}
BAR = {**BOX, "Scene": "static", "Time/Increments": "2", "Loads/Gravity": "0, 0, -1", "Handles/Names": "left",
       "Handles/left/Select": "boundary 1", "Output/Every": "0"}
CORNER = {**BAR, "Mesh/Box size": "1, 1, 1", "Mesh/Box cells": "6, 6, 6", "Handles/Names": "left, corner",
          "Handles/corner/Select": "sphere 0 -0.5 -0.5 0.2"}
EXAMPLE = {"Examples/Pose functions": "x; y; z + 0.1*x^2", "Examples/Importance": "0.8"}
ELSEWHERE = "1/(x - 4)"  # is no number at nodes of one process alone
TWO = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None, "Mesh/File": "two.msh"}
PAINTED = {**BAR, "Mesh/Surface": "bar.obj", "Examples/Pose functions": "1.2*x; y; z", "Examples/Importance": "0.8"}

# What one process alone has of a body: shared nodes of handles, an importance, all nodes held, formulas that fail.
OF_ONE_PROCESS = {
    "shared corner": {**CORNER, "Handles/left/Components": "x"},
    "bar on a floor": {**BAR, "Mesh/Box cells": "16, 4, 4", "Handles/Names": "left, floor", "Handles/floor/Select": "boundary 5",
                       "Handles/floor/Components": "z"},
    "corner that is moved in two ways": {**CORNER, "Handles/corner/Motion": "0.1*t; 0; 0"},
    "corner that is caught": {**CORNER, "Handles/corner/From": "0.5"},
    "many nodes that are moved in two ways": {**BAR, "Handles/Names": "left, all", "Handles/all/Select": "box 0 -1 -1 4 1 1",
                                              "Handles/all/Motion": "0; 0; 0.1*t*(x>1)"},
    "importance of a region": {**TWO, "Scene": "interpolation", "Handles/Names": None, "Handles/left/Select": None,
                               "Loads/Gravity": None, "Examples/Pose functions": "x; y; z + 0.1*x^2", "Examples/Importance": "1",
                               "Examples/Include rest pose": "true", "Examples/Prescribed weights": "1-t; t",
                               "Material/region 2/Importance factor": "0.5"},
    "a region that yields": {**TWO, "Material/region 2/Yield stress": "1e3"},
    "no node of a process is free from now on": {**BAR, **EXAMPLE, "Examples/Weights": "free", "Time/Increments": "4",
                                                 "Handles/Names": "left, half", "Handles/half/Select": "box 0.1 -1 -1 2.6 1 1",
                                                 "Handles/half/From": "0.5"},
    "painted weights": {**PAINTED, "Examples/Weight maps": "right.csv"},
    "painted weights of two regions": {**PAINTED, "Examples/Weight maps": "left.csv, right.csv"},
    "motion that is no number in between": {**BAR, "Time/Increments": "8", "Handles/Names": "left, right", "Handles/right/Select": "boundary 2",
                                "Handles/right/Motion": "0; 0; 0.01/(t - 0.5)"},
    "pose that is no number": {**BAR, **EXAMPLE, "Examples/Pose functions": f"x; y; {ELSEWHERE}"},
    "start that is no number": {**BAR, "Initial/Pose function": f"x; y; {ELSEWHERE}"},
    "a turn along straight lines": {**BAR, "Time/Increments": "4", "Handles/Names": "left, right", "Handles/right/Select": "boundary 2",
                                    "Handles/right/Motion": "0; -2*t*y; -2*t*z"},
}

# What several processes refuse, as scenes of prm/ have it.
OF_ONE_PROCESS_ALONE = r"^ *set (Kind *= *shell|(Bodies|Self) *= *true)"

# Their bodies collapse on the way and may come out of it in several shapes, so that messages alone are compared.
AMBIGUOUS = {"a turn along straight lines"}


def files_of_scenes():
    """Those of prm/ that are scenes, and no studies."""
    return [file for file in sorted(REPOSITORY.glob("prm/**/*.prm"))
            if re.search("^set Scene *= *(static|dynamic|interpolation)", file.read_text(), re.M)]


def is_of_one_process_alone(file):
    return re.search(OF_ONE_PROCESS_ALONE, file.read_text(), re.M) is not None


def first_steps(file):
    """Two steps of dynamics, and few increments of other scenes."""
    text = file.read_text()
    if "Scene = dynamic" in text:
        return {"Time/End": 2 * float(re.search(r"^ *set Step *= *(\S+)", text, re.M).group(1))}
    return {"Time/Increments": 4 if "Scene = interpolation" in text else 1 if "Increments = 1\n" in text else 2}


def write_two_regions(directory, box):
    """The box, of which region 2 lies at the far end."""
    def region(element):
        return 2 if sum(box.nodes[node][0] for node in element[-4:]) > 15. else 1
    marked = [(*element[:3], region(element), *element[4:]) if element[1] == 4 else element for element in box.elements]
    write_msh(directory / "two.msh", box._replace(elements=marked))


def write_painted_surface(directory):
    """The bar's surface, and maps that are 1 at one of its ends and 0 at the other."""
    surface = bar_surface()
    (directory / "bar.obj").write_text(obj_text(surface))
    for name, place in (("left", lambda x: 2. - x), ("right", lambda x: x - 2.)):
        (directory / f"{name}.csv").write_text("\n".join(str(min(1., max(0., place(x)))) for x, _, _ in surface.vertices) + "\n")


class Outcome:
    """What a number of processes makes of a scene: final nodes, or the message by which it is refused; and warnings."""

    def __init__(self, n, file, settings, directory, timeout=120):
        output = Path(directory) / f"on_{n}"
        words = [file, "--quiet", "--output", output, *set_words({"Output/Every": 0, "Output/Formats": "vtu", **settings})]
        if n == 1:
            run = serve(list(map(str, words)), directory, {}) or run_program(*words, cwd=directory, timeout=timeout)
            self.status, stderr = run.status, run.stderr
        else:
            self.status, _, done = launch(n, *words, cwd=directory, timeout=timeout)
            stderr = done.stderr
        self.messages = messages_in(stderr)
        self.nodes = nodes_of(output / "final.msh") if self.status == 0 else {}
        shutil.rmtree(output, ignore_errors=True)

    def is_like(self, other):
        return (self.status, self.messages) == (other.status, other.messages)

    def size(self):
        return sum((max(x) - min(x)) ** 2 for x in zip(*self.nodes.values())) ** 0.5

    def disagreement(self, other):
        """Greatest distance of a node, over the body's size."""
        return greatest_distance(self.nodes, other.nodes) / other.size()


@unittest.skipUnless(shutil.which("mpirun") and has_trilinos(), "without mpirun, or built without Trilinos")
class Collectives(SceneTest):
    def compare(self, file, settings, tolerance, ranks=(2, 3)):
        one = Outcome(1, file, settings, self.directory)
        for n in ranks:
            with self.subTest(scene=str(file), processes=n):
                several = Outcome(n, file, settings, self.directory)
                self.assertEqual((several.status, several.messages), (one.status, one.messages))
                if one.status == 0:
                    self.assertLess(several.disagreement(one), tolerance)
        return one

    def test_scenes_of_prm(self):
        self.assertGreater(len(files_of_scenes()), 40)
        for file in files_of_scenes():
            if not is_of_one_process_alone(file):
                self.compare(file, {**TIGHT, **first_steps(file)}, 1e-9, ranks=(3,))

    def test_scenes_that_several_processes_refuse(self):
        refused = [file for file in files_of_scenes() if is_of_one_process_alone(file)]
        self.assertGreater(len(refused), 5)
        for file in refused:
            outcome = Outcome(2, file, {}, self.directory)
            self.assertEqual(outcome.status, 1, file)
            self.assertIn("not for several processes", " ".join(outcome.messages))

    def test_what_one_process_has_alone(self):
        write_two_regions(self.directory, self.write_box(BOX, "box.msh"))
        write_painted_surface(self.directory)
        refused = set()
        for name, scene in OF_ONE_PROCESS.items():
            tolerance = math.inf if name in AMBIGUOUS else 1e-9
            if self.compare(write_scene(self.directory / f"{name}.prm", scene), TIGHT, tolerance).status:
                refused.add(name)
        self.assertEqual(refused, {name for name in OF_ONE_PROCESS if re.search("two ways|caught|no number", name)})

    def test_the_checker_finds_differences(self):
        self.assertIsNone(first_difference(["a", "b"], ["a", "b"], True))
        self.assertEqual(first_difference(["a", "b"], ["a", "c"], True), (2, "b", "c"))
        self.assertEqual(first_difference(["a", "b"], ["a"], True), (2, "b", "missing"))
        self.assertIsNone(first_difference(["a", "b"], ["a"], False))
        for rank, calls in enumerate(("world Barrier()\nworld/1 Bcast(1 x MPI_INT, root 0)\n",
                                      "world Barrier()\nworld/1 Allreduce(1 x MPI_INT, SUM)\n")):
            self.write(f"rank.{rank}", calls)
        self.assertIn("call 1 on world/1 of rank 0 is Bcast(1 x MPI_INT, root 0), and of rank 1 Allreduce(1 x MPI_INT, SUM)",
                      mismatch(self.directory, 2))


def measure(names):
    """A line a scene: how two and three processes differ from one, with tight tolerances and with those of the scene."""
    print(f"{'scene':44}" + "".join(f"{text:>12}" for text in ("2, 1e-12", "3, 1e-12", "2, default", "3, default")))
    for file in files_of_scenes():
        name = str(file.relative_to(REPOSITORY))
        if names and not any(part in name for part in names):
            continue
        with tempfile.TemporaryDirectory() as directory:
            cells = []
            for settings in (TIGHT, {}):
                one = Outcome(1, file, settings, directory, timeout=None)
                for n in (2, 3):
                    several = Outcome(n, file, settings, directory, timeout=None)
                    cells.append("differs" if not several.is_like(one) else "refused" if one.status
                                 else f"{several.disagreement(one):.1e}")
        print(f"{name:44}" + "".join(f"{cell:>12}" for cell in cells), flush=True)


if __name__ == "__main__":
    if "--measure" in sys.argv[1:]:
        measure([word for word in sys.argv[1:] if word != "--measure"])
    else:
        unittest.main()
