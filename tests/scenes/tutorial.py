# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of prm/tutorial share: its scenes and studies, made small, and measures of meshes."""

import csv
import itertools
import re

from exemplar_runner import REPOSITORY, SceneTest

FOLDER = REPOSITORY / "prm/tutorial"
SHOWN = {}  # the test of each file


def shows(*files):
    """Names the files of prm/tutorial that a test is about."""
    def note(test):
        SHOWN.update({file: test.__name__ for file in files})
        return test
    return note


def tetrahedra(mesh):
    return [element[-4:] for element in mesh.elements if element[1] == 4]


def edges(mesh):
    return sorted({tuple(sorted(edge)) for cell in tetrahedra(mesh) for edge in itertools.combinations(cell, 2)})


def volume(mesh, nodes=None):
    total = 0
    for cell in tetrahedra(mesh):
        o, a, b, c = ((nodes or mesh.nodes)[number] for number in cell)
        a, b, c = ([p - q for p, q in zip(x, o)] for x in (a, b, c))
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


class Tutorial(SceneTest):
    def scene(self, name, output, *settings):
        """Run a scene; its output directory."""
        return self.run_file(FOLDER / f"{name}.prm", output, *settings)

    def study(self, name, base="", shorter=None):
        """Run a study with more in its Base, and with parts of the file in other words; its rows."""
        text = (FOLDER / f"{name}.prm").read_text()
        for words, others in {"\\\n": "", **(shorter or {})}.items():
            self.assertTrue(words in text or words == "\\\n", f"{name}.prm has no '{words}'")
            text = text.replace(words, others)
        for words, others in ((r"^set Scene *= *", f"\\g<0>{FOLDER}/"), (r"^(set Repeats *=).*", r"\g<1> 1")):
            text, places = re.subn("(?m)" + words, others, text)
            self.assertEqual(places, 1, words)
        if base:
            text, places = re.subn(r"(?m)^set Base *= *", f"\\g<0>{base}; ", text)
            text += "" if places else f"set Base = {base}\n"
        run = self.call("study", self.write(f"{name}.prm", text), "--quiet", "--output", name)
        self.assertEqual(run.status, 0, run.stderr)
        with open(self.directory / name / "study.csv", newline="") as file:
            return list(csv.DictReader(file))

    def of(self, rows, **wanted):
        """The rows, one at least, in which some keys, named by their last word, have some values."""
        found = [row for row in rows
                 if all(row[next(key for key in row if key.split("/")[-1].split()[-1] == word)] == value
                        for word, value in wanted.items())]
        self.assertNotEqual(found, [], wanted)
        return found

    def numbers(self, rows, column):
        for row in rows:
            self.assertNotEqual(row[column], "", row)
        return [float(row[column]) for row in rows]

    def assert_grows(self, values):
        self.assertEqual(values, sorted(values))
        self.assertGreater(values[-1], values[0])
