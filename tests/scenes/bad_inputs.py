# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bad input must lead to: status 1, one message, and nothing written; files that are bad in many ways."""

import re

from exemplar_runner import BAR, SceneTest, prm, write_msh

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.1", "Time/End": "0.2"}
FILE = {**BAR, "Mesh/Generator": None, "Mesh/Box size": None, "Mesh/Box cells": None}

# What a crash, a deal.II exception or a C++ library would print.
NO_MESSAGE = re.compile(r"-----|terminate|what\(\)|std::|dealii|Exemplar::|An error occurred|"
                        r"filesystem error|backtrace|\(core dumped\)")


class BadInputTest(SceneTest):
    def setUp(self):
        super().setUp()
        for name in ("a directory", "broken"):
            (self.directory / name).mkdir()
        self.write("a directory/letter.txt", "not of exemplar\n")
        self.write("broken/parameters.prm", "# exemplar: all parameters in force\n")
        (self.directory / "broken/checkpoint.bin").write_bytes(b"\x16\0\0\0\0\0\0\0serialization"
                                                               b"::archive" + b"\xff" * 200)
        self.write("empty.txt", "")
        self.write("nodes.txt", "1\n77\n")
        self.write("long.txt", "x" * 300000)
        self.write("bad.prm", prm({**BAR, "Scene": "statics"}))
        small = self.write_box({**BAR, "Mesh/Box cells": "1, 1, 1"}, "small.msh")
        self.assertEqual(len(small.nodes), 8)
        bar = self.write_box(BAR, "bar.msh")
        text = (self.directory / "bar.msh").read_text()
        self.write("truncated.msh", text[:text.index("$EndElements") - 30])
        tetrahedra = [i for i, element in enumerate(bar.elements) if element[1] == 4]
        i, j = tetrahedra[1:3]
        bar.elements[i], bar.elements[j] = bar.elements[j], bar.elements[i]
        write_msh(self.directory / "other.msh", bar)

    def tree(self):
        """Every file below the working directory, with its content."""
        return {file: file.read_bytes() if file.is_file() else None
                for file in self.directory.rglob("*")}

    def check(self, run, expected, before):
        self.assertEqual(run.status, 1, run.stderr)
        self.assertEqual(run.stdout, "")
        lines = run.stderr.splitlines()
        self.assertEqual(len(lines), 1, run.stderr)
        self.assertTrue(lines[0].startswith("exemplar: "), run.stderr)
        self.assertEqual(run.stderr.count("exemplar: "), 1, run.stderr)
        self.assertLess(len(run.stderr), 4000)
        self.assertNotRegex(run.stderr.rstrip("\n"), "[\x00-\x1f\x7f-\x9f]")
        self.assertNotRegex(run.stderr, NO_MESSAGE)
        for words in expected:
            self.assertIn(words, run.stderr)
        self.assertEqual(self.tree(), before)
