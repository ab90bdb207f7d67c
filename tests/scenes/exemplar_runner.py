# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program on scenes and reads back what it wrote: for the tests of scenes, the benchmarks and the scripts of doc/.

The binary is named by the environment variable EXEMPLAR.
"""

import atexit
import base64
import csv
import functools
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree
import zlib
from collections import namedtuple
from math import cos, pi, sin
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.append(str(REPOSITORY / "tests/fuzz"))
from fork_server import MOST_ARGUMENTS, ForkServer  # noqa: E402

EXEMPLAR = os.path.abspath(os.environ.get("EXEMPLAR", REPOSITORY / "build/release/exemplar"))

# A bar along x of 2 bricks, held at x = 0, under its weight.
BAR = {
    "Scene": "static",
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "2, 1, 1",
    "Time/Increments": "2",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Gravity": "0, 0, -1",
}

# What pulls a bar along x from 0 to 4 and lets it become thinner
TENSED = {
    "Handles/Names": "x0, y0, z0, pull",
    "Handles/x0/Select": "box 0 -1 -1 0 1 1",
    "Handles/x0/Components": "x",
    "Handles/y0/Select": "box 0 -0.5 -1 4 -0.5 1",
    "Handles/y0/Components": "y",
    "Handles/z0/Select": "box 0 -1 -0.5 4 1 -0.5",
    "Handles/z0/Components": "z",
    "Handles/pull/Select": "box 4 -1 -1 4 1 1",
    "Handles/pull/Components": "x",
}

Run = namedtuple("Run", "status stdout stderr output")
SceneRun = namedtuple("SceneRun", "status stderr output rows summary")


def call_program(*arguments, program=EXEMPLAR, cwd=None, timeout=None, environment=None):
    return subprocess.run([str(program), *map(str, arguments)], cwd=cwd, text=True,
                          env={**os.environ, **(environment or {})},
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=timeout)


def run_program(*arguments, program=EXEMPLAR, **how):
    """Run the program as it is called, with changes to the environment; without what libraries say."""
    done = call_program(*arguments, program=program, **how)
    return Run(done.returncode, done.stdout, own_words(done.stderr, program), None)


def wait_until(is_so, process=None, seconds=120, pause=1e-3):
    """Until something is so. Fails if it is not by then, or if the process ends before."""
    end = time.monotonic() + seconds
    while not is_so():
        if process is not None and process.poll() is not None:
            raise AssertionError("the program has ended already")
        if time.monotonic() > end:
            raise AssertionError("it does not happen")
        time.sleep(pause)


def without_numbers(line):
    return re.sub(r"[0-9]+", "0", line)


@functools.lru_cache(maxsize=None)
def words_of_libraries(program):
    """Lines, but for their numbers, that libraries write on stderr here in a run that starts all of them."""
    with tempfile.TemporaryDirectory() as directory:
        scene = write_scene(Path(directory) / "scene.prm", {**BAR, "Solver/Linear solver": "iterative"})
        stderr = call_program(scene, "--quiet", "--output", Path(directory) / "out", program=program).stderr
    return {without_numbers(line) for line in stderr.splitlines()
            if not line.startswith(("exemplar: ", "Warning: "))}


MEANT = re.compile("Warning: (Its own weight makes this body sag|This body can hardly stand|With a Poisson's ratio of .* linear tetrahedra without patches lock"
                   "|Cells have turned by up to .* but Model/Strain = linear|No step ends near Obstacles/)")


def without_what_is_meant(lines):
    """Bodies of tests are soft, so that they move, and some lock, turn or miss obstacles on purpose: they are warned of, which other tests
    look at."""
    return [line for line in lines if not MEANT.match(line)]


def messages_in(stderr):
    """Errors and warnings of the program among what launchers say, who may end their words by a zero byte (PRRTE does)."""
    return [line for line in stderr.replace("\0", "").splitlines() if line.startswith(("exemplar: ", "Warning: "))]


def own_words(stderr, program=EXEMPLAR):
    """What the program itself has said: tests must not depend on what MPI misses on a machine."""
    if not stderr:
        return stderr
    return "".join(line for line in stderr.splitlines(keepends=True)
                   if without_numbers(line.rstrip("\n")) not in words_of_libraries(program))


def set_words(settings):
    """{"Section/Key": value} on the command line."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def run_scene(program, scene, output, settings=None, check=True, arguments=()):
    """Run a scene file with {"Section/Key": value} set, without frames unless asked for; what it left."""
    words = set_words({"Output/Every": "0", **(settings or {})})
    run = run_program(scene, "--quiet", "--output", output, *words, *arguments, program=program)
    if check and run.status:
        sys.exit(f"{scene}: {run.stderr}")
    output = Path(output)
    written = (output / "summary.json").exists()
    return SceneRun(run.status, run.stderr, output, read_csv(output) if written else [],
                    read_summary(output) if written else {})


@functools.lru_cache(maxsize=None)
def has_trilinos():
    """Whether the program under test has Linear solver = iterative."""
    return "without Trilinos" not in run_program("--version").stdout


def needs_trilinos(test):
    return unittest.skipUnless(has_trilinos(), "built without Trilinos")(test)


def prm(keys):
    """A scene file of {"Section/Key": value}; keys whose value is None are left out."""
    lines = []
    for path, value in keys.items():
        *subsections, key = path.split("/")
        if value is not None:
            lines += [f"subsection {name}" for name in subsections]
            lines += [f"set {key} = {value}"]
            lines += ["end"] * len(subsections)
    return "\n".join(lines) + "\n"


def write_scene(file, keys):
    """A scene file of {"Section/Key": value}."""
    Path(file).write_text(prm(keys))
    return Path(file)


# Poses of a bar along x from 0 to 4, as functions for a scene and of a place.


def twist(angle):
    """Pose function of the bar twisted by a muParser expression over its length."""
    a = f"({angle})*x/4"
    return f"x; y*cos({a}) - z*sin({a}); y*sin({a}) + z*cos({a})"


def bend(angle):
    """Pose function of the bar bent to an arc; its centre line keeps its length."""
    r = f"(4/({angle}))"
    return f"({r}-z)*sin(x/{r}); y; {r} - ({r}-z)*cos(x/{r})"


def twisted(x, y, z, angle=2 * pi):
    """By an angle over its length."""
    a = angle * x / 4
    return x, y * cos(a) - z * sin(a), y * sin(a) + z * cos(a)


def bent(x, y, z, angle=pi):
    """To an arc of an angle."""
    r = 4 / angle
    return (r - z) * sin(x / r), y, r - (r - z) * cos(x / r)


@functools.lru_cache(maxsize=None)
def fork_server():
    """FORK_SERVER names the library of fork_server.cc, with which the program need not be linked anew for each run; None without
    it."""
    library = os.environ.get("FORK_SERVER")
    if not library:
        return None
    server = ForkServer(EXEMPLAR, library)
    atexit.register(server.close)
    return server


# What libraries read when they are loaded.
READ_BY_LIBRARIES = ("LD_", "OMP_", "GOMP_", "OPENBLAS_", "MALLOC_")


def serve(words, cwd, environment, timeout=300):
    """A run of the program as it is linked already; None where that cannot be. After `timeout` [s] it gets a signal."""
    server = fork_server()
    if server is None or "" in words or len(words) > MOST_ARGUMENTS or any(name.startswith(READ_BY_LIBRARIES) for name in environment):
        return None
    status, stdout, stderr = server.run(words, cwd, {**os.environ, **environment}, None, 1 << 50, timeout)
    return Run(status, stdout.decode(), own_words(stderr.decode()), None)


class SceneTest(unittest.TestCase):
    """Every test has a temporary working directory of its own."""

    maxDiff = 2000

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.directory = Path(holder.name)

    def write(self, name, text):
        file = self.directory / name
        file.write_text(text)
        return file

    def call(self, *arguments, **environment):
        """Run the program as it is called, with changes to the environment."""
        return (serve([str(argument) for argument in arguments], self.directory, environment)
                or run_program(*arguments, cwd=self.directory, timeout=300, environment=environment))

    def attempt(self, scene, *arguments, output="out", file="scene.prm"):
        """Run a scene, given as text or as a dictionary of keys."""
        self.write(file, scene if isinstance(scene, str) else prm(scene))
        run = self.call(file, "--output", output, *arguments)
        said = "".join(without_what_is_meant(run.stderr.splitlines(keepends=True)))
        return run._replace(output=self.directory / output, stderr=said)

    def solve(self, scene, *arguments, **keywords):
        """Run a scene that must succeed, without a word on stderr; its output directory."""
        run = self.attempt(scene, *arguments, **keywords)
        self.assertEqual((run.status, run.stderr), (0, ""))
        return run.output

    def run_file(self, scene, output, *overrides):
        """Run a scene file, which must succeed, without frames; its output directory."""
        words = [word for override in ("Output/Every=0", *overrides) for word in ("--set", override)]
        run = self.call(scene, "--quiet", "--output", output, *words)
        self.assertEqual(run.status, 0, run.stderr)
        return self.directory / output

    def write_box(self, keys, file, place=lambda x, y, z: (x, y, z)):
        """Write the box of a scene as a mesh file, its nodes moved; return it."""
        box = {**{path: value for path, value in keys.items() if path.startswith("Mesh/")},
               "Scene": "dynamic", "Time/End": "1e-9", "Time/Step": "1e-9", "Solver/Method": "one pass"}
        written = read_msh(self.solve(box, output="box", file="box.prm") / "final.msh")
        # the free body has stayed but for rounding
        rest = {number: tuple(round(x, 9) for x in position)
                for number, position in written.nodes.items()}
        return write_msh(self.directory / file, written._replace(nodes=rest), place)


def read_csv(output):
    """statistics.csv: a list of rows, each a dictionary; numbers are floats, empty cells None."""

    def value(text):
        try:
            return float(text) if text else None
        except ValueError:
            return text

    with open(output / "statistics.csv", newline="") as file:
        return [{name: value(text) for name, text in row.items()} for row in csv.DictReader(file)]


def timeless_statistics(output):
    """statistics.csv as text, without what differs from run to run."""
    with open(output / "statistics.csv", newline="") as file:
        rows = list(csv.reader(file))
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith("seconds_")]
    return "\n".join(",".join(row[i] for i in kept) for row in rows)


def results(output):
    """All that must not differ between two runs of a scene: {file name: content}."""
    same = {file.name: file.read_bytes() for file in output.iterdir()
            if re.fullmatch(r"(frame_\d+|animation)\.(vtu|pvd|obj|ply|mdd|pc2|usda)|(rest|weight_[0-9_]+)\.obj|final\.msh", file.name)}
    same["statistics.csv"] = timeless_statistics(output)
    return same


def read_summary(output):
    return json.loads((output / "summary.json").read_text())


Msh = namedtuple("Msh", "nodes elements names")


def read_msh(file):
    """MSH 2.2 ASCII: nodes {number: (x, y, z)} and elements, the lines as integers."""
    lines = Path(file).read_text(errors="surrogateescape").split("\n")

    def section(name):
        if "$" + name not in lines:
            return []
        begin = lines.index("$" + name)
        return lines[begin + 2:lines.index("$End" + name)]

    nodes = {}
    for line in section("Nodes"):
        number, *position = line.split()
        nodes[int(number)] = tuple(map(float, position))
    elements = [tuple(map(int, line.split())) for line in section("Elements")]
    return Msh(nodes, elements, section("PhysicalNames"))


def nodes_of(file):
    return read_msh(file).nodes


def write_msh(file, msh, place=lambda x, y, z: (x, y, z)):
    """Write a mesh with its nodes moved: a pose. Return it."""
    moved = msh._replace(nodes={number: place(*x) for number, x in msh.nodes.items()})
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(moved.nodes))]
    lines += [f"{number} " + " ".join(map(repr, map(float, x)))
              for number, x in moved.nodes.items()]
    lines += ["$EndNodes", "$Elements", str(len(msh.elements))]
    lines += [" ".join(map(str, element)) for element in msh.elements]
    lines += ["$EndElements", ""]
    Path(file).write_text("\n".join(lines))
    return moved


def distance(a, b):
    return sum((p - q) ** 2 for p, q in zip(a, b)) ** 0.5


def greatest_distance(a, b):
    """Between the nodes of two poses."""
    assert a.keys() == b.keys()
    return max(distance(a[number], b[number]) for number in a)


def read_vtu(file):
    """{(section, array name): list of numbers} and the counts of points and cells."""
    formats = {"Float64": "d", "Int32": "i", "UInt8": "B"}
    piece = xml.etree.ElementTree.parse(file).getroot().find("UnstructuredGrid/Piece")
    arrays = {}
    for section in piece:
        for array in section:
            text = array.text.strip()
            # the header of four UInt64 is 32 bytes, 44 characters of base64
            blocks, size, last, compressed_size = struct.unpack(
                "<4Q", base64.b64decode(text[:44], validate=True))
            assert (blocks, last) == (1, size)
            compressed = base64.b64decode(text[44:], validate=True)
            assert len(compressed) == compressed_size
            data = zlib.decompress(compressed)
            assert len(data) == size
            arrays[section.tag, array.get("Name")] = [
                number for number, in struct.iter_unpack("<" + formats[array.get("type")], data)]
    return arrays, int(piece.get("NumberOfPoints")), int(piece.get("NumberOfCells"))


def read_pvd(output):
    """[(time, file name)]"""
    root = xml.etree.ElementTree.parse(output / "animation.pvd").getroot()
    return [(float(frame.get("timestep")), frame.get("file")) for frame in root.iter("DataSet")]
