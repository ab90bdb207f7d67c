# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the program inputs that are wrong in many ways, and holds it to doc/output.md.

Usage: python3 tests/fuzz/fuzz.py [--cases N] [--seed S] [--jobs J] [--program P] [--kind KIND] [--keep DIRECTORY]
       python3 tests/fuzz/fuzz.py --repeat DIRECTORY/CASE [--program P]

Case number i of a seed is always the same, for the same program's keys. A case that fails is kept as a directory: its input, the
call, and what was wrong; --repeat runs it again. Ends with status 1 if there was one.
"""

import argparse
import json
import math
import multiprocessing
import os
import random
import re
import shutil
import struct
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import mutations
import oracle
import runs
from cases import KINDS, Case, declared_keys, make_case
from formats import by_meshio
from fork_server import ForkServer

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scenes"))
from exemplar_runner import EXEMPLAR, read_msh, results  # noqa: E402
from gltf_reader import Gltf  # noqa: E402


class Fuzzer:
    """Runs cases with one program and its limits."""

    def __init__(self, options):
        self.program = os.path.abspath(options.program)
        self.time_limit = options.time_limit
        self.memory = None if oracle.has_sanitizer(self.program) else 3 << 30
        self.server = ForkServer(self.program, options.fork_server) if options.fork_server else None

    def call(self, directory, arguments):
        return oracle.run(self.program, arguments, directory, self.memory, self.time_limit, self.server)

    def write(self, case, directory):
        """The files of a case, and what its earlier runs and the damage make of them."""
        for name, content in case.files.items():
            (directory / name).write_bytes(content)
        for arguments in case.earlier:
            ended = self.call(directory, arguments)
            if ended.status:
                return [f"an earlier run ended with {ended.status}: {ended.stderr.decode(errors='replace')}"]
        for name, content in case.plants.items():
            self.plant(directory / name, content)
        if case.damage:
            file = directory / case.damage["file"]
            if case.damage.get("by"):
                shutil.copyfile(directory / case.damage["by"], file)
            else:
                how = runs.spoilt_frame if case.damage.get("how") == "spoilt_frame" else mutations.damaged
                file.write_bytes(how(random.Random(case.damage["seed"]), file.read_bytes()))
        return []

    @staticmethod
    def plant(file, content):
        if file.parent.is_file():
            file.parent.unlink()
        file.parent.mkdir(parents=True, exist_ok=True)
        if file.is_dir():
            return
        if content is not None:
            file.write_text(content)
            return
        file.unlink(missing_ok=True)
        file.mkdir()

    def check(self, case, directory):
        """The run of a case whose files are there: (how it ended, its faults)."""
        before = oracle.tree(directory)
        ended = self.call(directory, case.arguments)
        if self.memory is None and re.search(rb"out-of-memory|allocation-size-too-big|numbers::is_finite", ended.stderr):
            # without a sanitizer the former are tried within a limit of memory; the last is an assertion of deal.II's
            # Debug build, where a Release build finds the infinite residual itself
            return ended, []
        faults = oracle.faults_of_end(ended, time_limit=self.time_limit)
        if case.kind == "export":
            faults += self.faults_of_page(ended, directory, case.arguments)
        else:
            faults += oracle.faults_of_files(ended, before, oracle.tree(directory))
        if not faults and ended.status == 0 and case.check:
            faults += getattr(self, "check_" + case.check)(directory)
        if not faults and ended.status == 1 and case.check == "validate" and ended.stderr and self.validates(directory):
            faults.append("--validate finds nothing wrong where a run ends with status 1")
        return ended, faults

    @staticmethod
    def faults_of_page(ended, directory, arguments):
        """A page or glTF is there, with data that can be read, or there is none; nothing is left beside it."""
        page = directory / ("page.glb" if "--gltf" in arguments else "page.html")
        if page.exists() != (ended.status == 0):
            return [f"status {ended.status}, and the page is {'there' if page.exists() else 'not there'}"]
        faults = [f"{file.name} is left" for file in directory.iterdir() if file.name.startswith(page.name + ".")]
        if page.exists() and "--gltf" in arguments:
            try:
                gltf = Gltf(page)
                for number in range(len(gltf.json["accessors"])):
                    if not all(math.isfinite(x) for row in gltf.accessor(number) for x in row):
                        faults.append("a number in the glTF is not finite")
            except (ArithmeticError, AssertionError, LookupError, ValueError, struct.error) as error:
                faults.append(f"the glTF cannot be read: {error!r}")
        elif page.exists():
            try:
                json.loads(page.read_text().split('id="data">')[1].split("</script>")[0], parse_constant=lambda name: faults.append(f"{name} in the data"))
            except (ValueError, IndexError) as error:
                faults.append(f"the data of the page cannot be read: {error}")
        return faults

    def validates(self, directory):
        return self.call(directory, ["--validate", "scene.prm"]).status == 0

    def check_validate(self, directory):
        return [] if self.validates(directory) else ["--validate refuses what runs"]

    def check_again(self, directory):
        """parameters.prm, written by the run, gives the same results."""
        if not (directory / "out/parameters.prm").exists():
            return []
        ended = self.call(directory, ["out/parameters.prm", "--quiet", "--threads", "1", "--output", "again"])
        if ended.status:
            return [f"parameters.prm ends with {ended.status}: {ended.stderr.decode(errors='replace')}"]
        faults = oracle.faults_of_difference(directory / "again", results(directory / "out"))
        return ["parameters.prm: " + fault for fault in faults]

    @staticmethod
    def check_second_reader(directory):
        """What meshio finds in the file is what the program has read, or it finds nothing."""
        name = re.search(r"set File = (\S+)", (directory / "scene.prm").read_text()).group(1)
        other = by_meshio(directory / name)
        if other is None:
            return []
        places, cells = other
        msh = read_msh(directory / "out/final.msh")
        index = {number: i for i, number in enumerate(msh.nodes)}
        mine = [[index[n] for n in e[5:]] for e in msh.elements if e[1] == 4]
        if len(places) != len(msh.nodes) or mine != cells:
            return [f"meshio reads {len(places)} nodes and {len(cells)} cells, the program {len(msh.nodes)} and {len(mine)}, or others"]
        far = max(abs(a - b) / max(1, abs(a)) for x, y in zip(places, msh.nodes.values()) for a, b in zip(x, y))
        return [f"places differ by {far} from those that meshio reads"] if not far < 1e-6 else []

    def check_meshed(self, directory):
        """A scene takes the mesh, unless it lies where no scene can name it."""
        ended = self.call(directory, ["--validate", "use.prm"])
        if ended.status == 1 and b"Rename the file or its directory." in ended.stderr:
            return []
        return [] if ended.status == 0 else [f"a scene refuses the mesh: {ended.stderr.decode(errors='replace')}"]

    def check_resumed(self, directory):
        return oracle.faults_of_difference(directory / "out", results(directory / "whole"))


def keep(directory, case, ended, faults):
    """What repeats a case, beside its input."""
    told = {"kind": case.kind, "arguments": case.arguments, "check": case.check, "place": case.place, "faults": faults,
            "status": ended.status, "seconds": round(ended.seconds, 2), "stderr": ended.stderr.decode(errors="replace")[:3000]}
    (directory / "case.json").write_text(json.dumps(told, indent=1))


def run_case(fuzzer, keys, options, number):
    """(kind, status, faults) of one case; kept if it has faults."""
    case = make_case(random.Random(f"{options.seed} {number}"), keys, options.kind)
    with tempfile.TemporaryDirectory(prefix="fuzz") as holder:
        directory, kept = Path(holder) / case.place, Path(holder) / "kept"
        directory.mkdir()
        faults = fuzzer.write(case, directory)
        if faults:
            return case.kind, None, faults if case.place == "run" else []
        shutil.copytree(directory, kept / "input", symlinks=True)
        ended, faults = fuzzer.check(case, directory)
        if faults:
            keep(kept, case, ended, faults)
            place = Path(options.keep) / f"seed{options.seed}_{number:06}_{case.kind}"
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(kept, place, symlinks=True)
    return case.kind, ended.status, faults


def begin_worker(options):
    global fuzzer  # of this process
    fuzzer = Fuzzer(options)


def worker(job):
    options, keys, number = job
    try:
        return number, *run_case(fuzzer, keys, options, number)
    except Exception as error:  # a fault of the fuzzer must not stop the others
        return number, "fuzzer", None, [f"{type(error).__name__}: {error}"]


def repeat(options):
    told = json.loads((Path(options.repeat) / "case.json").read_text())
    with tempfile.TemporaryDirectory(prefix="fuzz") as holder:
        directory = Path(holder) / told["place"]
        shutil.copytree(Path(options.repeat) / "input", directory, symlinks=True)
        ended, faults = Fuzzer(options).check(Case(told["kind"], {}, told["arguments"], check=told["check"]), directory)
    print(f"status {ended.status}\n{ended.stderr.decode(errors='replace')[:3000]}")
    print("\n".join(faults) or "no fault")
    return len(faults)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cases", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--program", default=EXEMPLAR)
    parser.add_argument("--kind", choices=[maker.__name__[:-5] for maker, _ in KINDS])
    parser.add_argument("--fork-server", help="library of fork_server.cc: eight times as fast")
    parser.add_argument("--time-limit", type=float, default=20.)
    parser.add_argument("--keep", default="fuzz_failures", help="where failing cases go")
    parser.add_argument("--repeat", help="a kept case to run again")
    options = parser.parse_args()
    if options.repeat:
        return 1 if repeat(options) else 0

    begin, counts, causes = time.monotonic(), Counter(), Counter()
    keys = declared_keys(os.path.abspath(options.program))
    jobs = [(options, keys, number) for number in range(options.first, options.first + options.cases)]
    with multiprocessing.Pool(options.jobs, begin_worker, (options,)) as pool:
        for number, kind, status, faults in pool.imap_unordered(worker, jobs, chunksize=1):
            counts[kind, status] += 1
            if faults:
                causes[re.sub(r"\d+(\.\d+)?", "N", faults[0])[:100]] += 1
                print(f"case {number} ({kind}): {'; '.join(faults)[:300]}", flush=True)
    print(f"\n{options.cases} cases in {time.monotonic() - begin:.0f} s, seed {options.seed}")
    for kind in sorted({kind for kind, _ in counts}):
        ends = ", ".join(f"{status}: {n}" for (k, status), n in sorted(counts.items(), key=str) if k == kind)
        print(f"  {kind:11} by exit status  {ends}")
    for cause, n in causes.most_common():
        print(f"  {n:5} {cause}")
    if causes:
        print(f"{sum(causes.values())} failures, kept in {options.keep}; run one again by --repeat {options.keep}/CASE")
    return 1 if causes else 0


if __name__ == "__main__":
    sys.exit(main())
