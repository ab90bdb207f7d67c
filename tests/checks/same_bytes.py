# SPDX-License-Identifier: GPL-3.0-or-later
"""Hash what scenes leave on disk, and compare with the hashes of another build.

Usage: python3 tests/checks/same_bytes.py record FILE [--program P] [SCENE...]
       python3 tests/checks/same_bytes.py compare FILE [--program P] [SCENE...]

Frames, animation, final.msh and statistics.csv less its seconds, of every scene of prm/paper, prm/tutorial and
tests/benchmark/scenes (or of those named), with one and with two threads, and of a run that is stopped in its middle
and resumed. `compare` prints what differs and then exits with 1. All of it takes about ten minutes; results depend
on the CPU and on the BLAS, so both builds have to run on one machine. A change that only moves or splits code leaves
every byte.
"""
import argparse
import hashlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests/scenes"))
from exemplar_runner import read_csv, results  # noqa: E402

# What those scenes, all with the dilatation of cells, leave out: settings of small ones that reach other methods, models and solvers.
BAR, CAT = "prm/tutorial/step5_bar.prm", "prm/tutorial/step3_cat.prm"
FREE = ["Examples/Weights=free", "Examples/Weight penalty=paper"]
PATCHES = ["Model/Dilatation=patches"]
VARIANTS = {
    "newton": (BAR, ["Solver/Method=newton"]),
    "one pass": (BAR, ["Solver/Method=one pass", "Model/Gradient=frozen", "Material/Mass matrix=lumped"]),
    "predicted": (BAR, ["Solver/Method=one pass", "Model/Gradient=frozen", "Solver/Rotations=predicted"]),
    "frozen": (BAR, ["Model/Gradient=frozen", "Time/Stiffness damping=0.001", *FREE]),
    "umfpack": (BAR, ["Model/Gradient=frozen", "Solver/Linear solver=umfpack", *FREE]),
    "iterative": (BAR, ["Solver/Linear solver=iterative"]),
    "green": (BAR, ["Model/Strain=green"]),
    "linear": (BAR, ["Model/Strain=linear"]),
    "green newton": (BAR, ["Model/Strain=green", "Solver/Method=newton", "Examples/Energy=blended"]),
    "taken over by newton": (BAR, ["Time/Step=0.3", "Time/End=3", "Material/Density=1e-3"]),
    "bdf2": (BAR, ["Time/Scheme=bdf2", "Time/Mass damping=0.5", "Time/Stiffness damping=0.002"]),
    "bdf2 newton": (BAR, ["Time/Scheme=bdf2", "Solver/Method=newton", "Time/Stiffness damping=0.002"]),
    "patches": (BAR, PATCHES),
    "patches newton": (BAR, [*PATCHES, "Time/Scheme=bdf2", "Solver/Method=newton", "Time/Stiffness damping=0.002"]),
    "patches linear": (BAR, [*PATCHES, "Model/Strain=linear"]),
    "patches frozen": (BAR, [*PATCHES, "Model/Gradient=frozen", *FREE]),
    "patches iterative": (BAR, [*PATCHES, "Solver/Linear solver=iterative"]),
    "quadratic": (BAR, ["Model/Element=P2"]),
    "quadratic patches": (BAR, ["Model/Element=P2", *PATCHES]),
    "static patches": (CAT, [*PATCHES, "Time/Increments=2"]),
    "static green": (CAT, ["Model/Strain=green", "Time/Increments=2"]),
    "static frozen": (CAT, ["Model/Gradient=frozen", "Solver/Method=fixed point", "Solver/Tolerance=1e-4", "Time/Increments=2"]),
    "static free": (CAT, ["Time/Increments=2", *FREE]),
    "static iterative": (CAT, ["Time/Increments=2", "Solver/Linear solver=iterative"]),
    "static regions": (CAT, ["Time/Increments=2", "Examples/Weights per region=true"]),
}
FOLDERS = ["prm/paper", "prm/tutorial", "tests/benchmark/scenes"]
RESUMED = ["prm/paper/fig2a_cat.prm", "prm/tutorial/step4_horse.prm", "tests/benchmark/scenes/cat_mid60_examples.prm"]


def is_scene(file):
    return "\nset Vary" not in file.read_text()


def all_scenes():
    return [str(file.relative_to(TOP)) for folder in FOLDERS for file in sorted((TOP / folder).glob("*.prm"))
            if is_scene(file)]


def digest(output):
    content = {name: value if isinstance(value, bytes) else value.encode() for name, value in results(output).items()}
    whole = hashlib.sha256()
    for name in sorted(content):
        whole.update(name.encode() + b"\0" + hashlib.sha256(content[name]).digest())
    return whole.hexdigest()


def command(program, scene, output, threads, settings=()):
    sets = [word for setting in settings for word in ("--set", setting)]
    return [str(program), str(TOP / scene), "--quiet", "--threads", str(threads), "--output", str(output), *sets]


def run(program, scene, threads, settings=()):
    with tempfile.TemporaryDirectory() as directory:
        output = Path(directory) / "out"
        done = subprocess.run(command(program, scene, output, threads, settings), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True)
        return digest(output) if done.returncode == 0 else f"status {done.returncode}: {done.stderr.strip()}"


def run_resumed(program, scene):
    """Interrupt the run after some steps, then go on."""
    with tempfile.TemporaryDirectory() as directory:
        output = Path(directory) / "out"
        process = subprocess.Popen(command(program, scene, output, 1), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        statistics = output / "statistics.csv"
        while process.poll() is None and not (statistics.exists() and len(statistics.read_text().split("\n")) > 6):
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        if process.wait() == 0:
            return "was not interrupted"
        steps = len(read_csv(output)) - 1
        done = subprocess.run([*command(program, scene, output, 1), "--resume"], stderr=subprocess.PIPE, text=True)
        if done.returncode:
            return f"status {done.returncode} after step {steps}: {done.stderr.strip()}"
        return digest(output)


def all_digests(program, scenes):
    for scene in scenes:
        for threads in (1, 2):
            yield f"{scene} threads {threads}", run(program, scene, threads)
    for name, (scene, settings) in VARIANTS.items():
        if scene in scenes:
            yield f"{scene} {name}", run(program, scene, 1, settings)
    for scene in RESUMED:
        if scene in scenes:
            yield f"{scene} resumed", run_resumed(program, scene)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("action", choices=["record", "compare"])
    parser.add_argument("file", type=Path)
    parser.add_argument("--program", type=Path, default=TOP / "build/release/exemplar")
    parser.add_argument("scenes", nargs="*", help="scenes to run instead of all, relative to the repository")
    arguments = parser.parse_intermixed_args()
    os.chdir(TOP)

    recorded = json.loads(arguments.file.read_text()) if arguments.file.exists() else {}
    n_different = 0
    for name, found in all_digests(arguments.program.resolve(), arguments.scenes or all_scenes()):
        if arguments.action == "record":
            recorded[name] = found
            arguments.file.write_text(json.dumps(recorded, indent=1) + "\n")
        same = recorded.get(name) == found
        n_different += not same
        print(f"{'same' if same else 'DIFFERENT'}  {name}" + ("" if same else f"  {found}"), flush=True)
    print(f"{n_different} different")
    sys.exit(n_different > 0)


if __name__ == "__main__":
    main()
