# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program within limits and says what is wrong with how it ended and with what it left."""

import csv
import json
import math
import os
import re
import resource
import signal
import subprocess
import sys
import time
from collections import namedtuple
from pathlib import Path

from fork_server import MOST_ARGUMENTS, SANITIZER_OPTIONS

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scenes"))
from exemplar_runner import read_csv, read_msh, read_pvd, read_vtu, results  # noqa: E402

Ended = namedtuple("Ended", "status stdout stderr seconds")

# What a crash, an exception of a library or a sanitizer would print.
RAW = re.compile(r"^-{20}|terminate called|what\(\)|std::|bad_alloc|json\.exception|boost|deal\.II|dealii|muparser\b|mu::|"
                 r"Exemplar::|An error occurred|filesystem error|basic_string|length_error|out_of_range|\bsto[idul]+\b|"
                 r"vector::|map::at|backtrace|core dumped|runtime error:|Sanitizer|[Aa]ssertion|not allowed\"|libgomp|"
                 r"[Ll]ogic error|Segmentation", re.M)
# ours, or what gmsh said, which is indented
LINE = re.compile(r"exemplar: |Warning: |  |Try it with: ")
MARK = b"# exemplar: all parameters in force"
PRECIOUS = b"precious"  # how files begin that the program has not written
LONGEST_MESSAGE = 4000  # characters
LARGEST_FILE = 200 << 20  # bytes
ALWAYS = ("parameters.prm", "original.prm", "statistics.csv", "summary.json", "final.msh", "log.txt", "checkpoint.bin")


def limit_resources(memory, file_size=LARGEST_FILE):
    """For subprocess' preexec_fn; `memory` in bytes of address space, None: no limit."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))
        if memory is not None:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    return limit


def has_sanitizer(program):
    return b"__asan_init" in Path(program).read_bytes()


def environment(directory):
    return {**os.environ, "HOME": str(directory / "cache"), "XDG_CACHE_HOME": str(directory / "cache"), **SANITIZER_OPTIONS}


def run(program, arguments, directory, memory, time_limit=20., server=None):
    """One run, by the fork server of the program if there is one. After the limit it gets SIGTERM, ten seconds later SIGKILL."""
    begin = time.monotonic()
    if server is not None and len(arguments) <= MOST_ARGUMENTS:
        ended = server.run(arguments, directory, environment(directory), memory, LARGEST_FILE, time_limit)
        return Ended(*ended, time.monotonic() - begin)
    with subprocess.Popen([program, *map(os.fsencode, arguments)], cwd=directory, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(directory),
                          preexec_fn=limit_resources(memory)) as process:
        for limit, after in ((time_limit, signal.SIGTERM), (10., signal.SIGKILL), (None, None)):
            try:
                out, err = process.communicate(timeout=limit)
                break
            except subprocess.TimeoutExpired:
                process.send_signal(after)
    return Ended(process.returncode, out, err, time.monotonic() - begin)


def tree(directory):
    """{name: bytes, or the target of a link} of all files below; the cache of meshes may change."""
    found = {}  # names are of bytes
    for path, folders, files in os.walk(os.fsencode(directory)):
        if path == os.fsencode(directory) and b"cache" in folders:
            folders.remove(b"cache")
        for name in folders:
            found[os.path.join(path, name)] = None
        for name in files:
            file = os.path.join(path, name)
            found[file] = os.readlink(file) if os.path.islink(file) else Path(os.fsdecode(file)).read_bytes()
    return found


def differences(before, after):
    return sorted(os.fsdecode(os.path.basename(name)) for name in before.keys() | after.keys()
                  if before.get(name, 0) != after.get(name, 0))


def faults_of_end(ended, allowed=(0, 1, 2), time_limit=20.):
    """What is wrong with the exit status and the words on stderr: a list of sentences."""
    faults = []
    if ended.seconds > time_limit:
        faults.append(f"took longer than {time_limit:g} s (status {ended.status} after SIGTERM)")
    elif ended.status < 0:
        faults.append(f"killed by signal {-ended.status}")
    elif ended.status not in allowed:
        faults.append(f"exit status {ended.status}")
    try:
        text = ended.stderr.decode()
    except UnicodeDecodeError:
        faults.append("stderr is no UTF-8")
        text = ended.stderr.decode(errors="replace")
    if match := RAW.search(text):
        faults.append(f"raw words '{match.group()}' on stderr")
    lines = text.splitlines()
    messages = sum(line.startswith("exemplar: ") for line in lines)
    if messages != (0 if ended.status == 0 else 1) and ended.status in allowed:
        faults.append(f"{messages} messages with exit status {ended.status}")
    if any(not LINE.match(line) for line in lines):
        faults.append("stderr has a line that is no message")
    if re.search(r"[\x00-\x08\x0b-\x1f\x7f]", text):
        faults.append("control characters on stderr")
    if len(text) > LONGEST_MESSAGE:
        faults.append(f"a message of {len(text)} characters")
    return faults


def no_constant(word):
    raise ValueError(f"{word} in JSON")


def faults_of_numbers(output):
    """Exceptions of the readers, or NaN and infinite numbers, in the files of a run."""
    def attempt(name, check):
        try:
            return check()
        except Exception as error:  # whatever a reader does not like is a fault of the file
            return f"{name} cannot be read: {type(error).__name__}: {error}"

    def finite(values):
        return all(map(math.isfinite, values))

    def check_frame(file):
        arrays, points, _ = read_vtu(file)
        bad = [name for (_, name), values in arrays.items() if not finite(values)]
        if len(arrays["Points", "Points"]) != 3 * points:
            bad.append("the number of points")
        return f"{file.name}: bad {', '.join(bad)}" if bad else None

    def check_rows():
        rows = read_csv(output)
        cells = [value for row in rows for value in row.values() if isinstance(value, float)]
        complete = all(None not in row and len(row) == len(rows[0]) for row in rows)
        return None if finite(cells) and complete and rows else "statistics.csv: not finite or incomplete"

    def check_summary():
        summary = json.loads((output / "summary.json").read_bytes().decode(), parse_constant=no_constant)
        return None if summary["status"] else "summary.json has no status"

    def check_final():
        positions = read_msh(output / "final.msh").nodes.values()
        return None if positions and finite(x for node in positions for x in node) else "final.msh: not finite or empty"

    def check_animation():
        missing = [name for _, name in read_pvd(output) if not (output / name).is_file()]
        return f"animation.pvd names {missing[0]}, which is missing" if missing else None

    checks = {file.name: lambda file=file: check_frame(file) for file in output.glob("frame_*.vtu")
              if file.is_file() and file.read_bytes()[:8] != PRECIOUS}
    checks |= {"statistics.csv": check_rows, "summary.json": check_summary, "final.msh": check_final}
    if (output / "animation.pvd").exists():
        checks["animation.pvd"] = check_animation
    return [fault for name, check in checks.items() if (fault := attempt(name, check))]


def faults_of_study(table):
    """The columns before `status` and the message hold what the user wrote."""
    head, *rows = csv.reader(table.decode(errors="replace").splitlines())
    words = {cell for row in rows for cell in row[head.index("status"):-1]}
    return [f"study.csv says '{word}'" for word in ("nan", "-nan", "inf", "-inf", "crash") if word in words]


def faults_of_made(table, text, meshes):
    """What `exemplar mesh` or `exemplar pose` has left, its table and meshes or poses."""
    faults = []
    rows = list(csv.reader(text.decode().splitlines()))
    if not all(math.isfinite(float(cell)) for row in rows[1:] for cell in row[1:]):
        faults.append(f"{os.fsdecode(os.path.basename(table))}: not finite")
    if "inverted_cells" in rows[0] and any(row[1] != "0" for row in rows[1:]) and meshes:
        faults.append("a pose with inverted cells")
    for mesh in meshes:
        positions = read_msh(os.fsdecode(mesh)).nodes.values()
        if not positions or not all(math.isfinite(x) for node in positions for x in node):
            faults.append(f"{os.fsdecode(os.path.basename(mesh))}: not finite or empty")
    return faults


def faults_of_difference(output, expected):
    """What a run left in place of the expected results()."""
    try:
        found = results(output)
    except Exception as error:
        return [f"the results cannot be read: {type(error).__name__}: {error}"]
    other = sorted(name for name in found.keys() | expected.keys() if found.get(name) != expected.get(name))
    return [f"a silent other result: {', '.join(other)}"] if other else []


def with_parents(directory):
    path = Path(os.fsdecode(directory))
    return {os.fsencode(parent) for parent in (path, *path.parents)}


def output_directories(after):
    """Those below a directory, given as its tree, that a run has written."""
    return [Path(os.fsdecode(os.path.dirname(name))) for name, content in after.items()
            if os.path.basename(name) == b"parameters.prm" and content is not None and content.startswith(MARK)]


def was_out_of_time(output, ended, after):
    """Whether a study says that it has ended runs by its Timeout: in its table or, of the reference, in a warning."""
    table = after.get(os.fsencode(output.parent.parent / "study.csv"), b"") or b""
    return b"the study's Timeout" in ended.stderr + table


def faults_of_files(ended, before, after):
    """What is wrong with the files that a run left, given the trees before and after."""
    changed = differences(before, after)
    lost = sorted(os.fsdecode(name) for name, content in before.items()
                  if content is not None and content[:8] == PRECIOUS[:8] and after.get(name) != content)
    if lost:
        return [f"removed or changed {lost[0]}, which no run has written"]
    if ended.status == 1:
        return [f"exit 1, but changed {', '.join(changed[:4])}"] if changed else []
    new = {name for name in after if before.get(name, 0) != after[name]}
    faults, covered = [], set()
    for study in {name for name in new if os.path.basename(name) == b"study.csv"}:
        inside = {name for name in after if name.startswith(os.path.dirname(study) + b"/")}
        covered |= inside | with_parents(os.path.dirname(study))
        faults += faults_of_study(after[study])
    for output in output_directories(after):
        inside = {name for name in after if name.startswith(os.fsencode(output))}
        is_of_study = output.parent.name == "runs"
        if is_of_study and not (output / "summary.json").exists() and was_out_of_time(output, ended, after):
            pass  # the study has killed it
        elif inside & new:
            faults += faults_of_numbers(output)
            kept = [name for name in ALWAYS if name != "checkpoint.bin" or not is_of_study]  # a study's runs leave no checkpoint
            faults += [f"{name} is missing" for name in kept if not (output / name).exists()]
            faults += [f"{os.fsdecode(name)} is left" for name in inside & new if name.endswith(b".tmp")]
        covered |= inside | with_parents(os.fsencode(output))
    for table in new:
        if after[table] is not None and after[table].startswith((b"quantity,value", b"pose,inverted_cells")):
            inside = {name for name in new if os.path.dirname(name) == os.path.dirname(table)}
            covered |= {table, os.path.dirname(table)} | {name for name in inside if name.endswith(b".msh")}
            faults += faults_of_made(table, after[table], [name for name in inside if name.endswith(b".msh")])
    strays = sorted(os.fsdecode(os.path.basename(name)) for name in new - covered)
    return faults + [f"wrote {name} outside the output directory" for name in strays[:3]]
