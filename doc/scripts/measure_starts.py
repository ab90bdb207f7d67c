# SPDX-License-Identifier: GPL-3.0-or-later
"""Print how often a static scene ends in the pose that was meant: the cat with four examples, of which some parts follow one pose.

Usage: python3 doc/scripts/measure_starts.py [BINARY]     (ten minutes of one core)
Forty scenes: ten choices of parts that follow, each of the four poses.
"""
import sys
import tempfile
from pathlib import Path

from scene_runs import PROGRAM, TOP, print_table, run_scene, write_scene

PARTS = {"hind paws": "box -0.52 -0.2 -0.01 -0.27 0.2 0.08", "left fore paw": "box 0.26 0 -0.01 0.5 0.2 0.08",
         "right fore paw": "box 0.26 -0.2 -0.01 0.5 0 0.08", "back": "box -0.06 -0.2 0.5 0.06 0.2 0.7",
         "head": "sphere 0.585 0 0.75 0.1", "tail tip": "box -0.7 -0.1 0.98 -0.5 0.1 1.1"}
CHOICES = [("hind paws", "right fore paw", "head"), ("hind paws", "left fore paw", "head"), ("hind paws", "back", "head"),
           ("hind paws", "left fore paw", "right fore paw", "head"), ("hind paws", "head", "tail tip"),
           ("hind paws", "right fore paw", "tail tip"), ("hind paws", "left fore paw", "tail tip"),
           ("left fore paw", "right fore paw", "head", "tail tip"), ("hind paws", "back", "tail tip"),
           ("hind paws", "left fore paw", "right fore paw", "back", "head", "tail tip")]
POSES = ["arch", "paw", "rear", "turn"]
FILES = {name: TOP / f"meshes/poses/cat_{name}.msh" for name in POSES}
SCENE = {"Scene": "static", "Mesh/File": TOP / "meshes/cat.msh", "Examples/Poses": ", ".join(map(str, FILES.values())),
         "Examples/Importance": 0.9, "Time/Increments": 1}


def main():
    program = Path(sys.argv[1]) if len(sys.argv) > 1 else PROGRAM
    rows = [("parts that follow", *POSES)]
    counts = {"state": 0, "examples": 0}
    warned = missed = 0
    with tempfile.TemporaryDirectory() as directory:
        for parts in CHOICES:
            row = []
            for meant in POSES:
                handles = {"Handles/Names": ", ".join(parts)}
                for part in parts:
                    handles[f"Handles/{part}/Select"] = PARTS[part]
                    handles[f"Handles/{part}/Follow pose"] = FILES[meant]
                words = []
                for starts in counts:
                    file = write_scene(Path(directory) / "scene.prm", {**SCENE, **handles, "Solver/Starts": starts})
                    run = run_scene(program, file, Path(directory) / "output", check=False, arguments=("--threads", "1"))
                    if run.status:
                        words.append("failed")
                        continue
                    weights = {name: float(run.rows[-1][f"weight_{i}"]) for i, name in enumerate(["rest", *POSES])}
                    found = max(weights, key=weights.get)
                    counts[starts] += found == meant
                    words.append(f"{found} {weights[found]:.2f}")
                    has_warning = any("Solver/Starts" in str(warning) for warning in run.summary["warnings"])
                    if starts == "state":
                        warned += has_warning and found != meant
                        missed += found != meant
                row.append("; ".join(words))
                print(", ".join(parts), "of", meant, ":", row[-1], file=sys.stderr, flush=True)
            rows.append((", ".join(parts), *row))
    print_table(*rows)
    for starts, count in counts.items():
        print(f"Starts = {starts}: {count} of {len(CHOICES) * len(POSES)} end in the pose that was meant")
    print(f"Starts = state: {warned} of the {missed} others are warned of")


if __name__ == "__main__":
    main()
