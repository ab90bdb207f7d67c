# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig: the weights of the cat's poses from the places of a few markers on its skin, frame by frame.

Usage: python3 doc/python/follow_markers.py [FRAMES [PICTURE]]
The picture needs matplotlib.
"""
import sys
from pathlib import Path

import numpy as np

import exemplar

top = Path(__file__).resolve().parents[2]
names = ["arch", "rear", "turn"]
n_frames = int(sys.argv[1]) if len(sys.argv) > 1 else 8
exemplar.use_one_blas_thread()


def cat(**examples):
    """The cat on its hind paws, with the rest pose and three others."""
    return exemplar.Problem({
        "Scene": "static",
        "Mesh": {"File": top / "meshes/cat.msh"},
        "Examples": {"Poses": [top / f"meshes/poses/cat_{name}.msh" for name in names], "Importance": 1, **examples},
        "Handles": {"hind paws": {"Select": "box -0.52 -0.2 -0.01  -0.27 0.2 0.08"}},
        "Time": {"Increments": n_frames},
    })


# what a camera would see: an actor that plays these weights, and markers that are 1 mm off
times = np.arange(1, n_frames + 1) / n_frames
played = np.stack([0.2 + 0 * times, 0.7 * (1 - times), 0.1 + 0.4 * times, 0.3 * times], axis=1)
played /= played.sum(axis=1, keepdims=True)
table = ["(0.2)", "(0.7*(1-t))", "(0.1+0.4*t)", "(0.3*t)"]
actor = cat(Weights="prescribed", **{"Prescribed weights": [f"{part}/({'+'.join(table)})" for part in table]})
random = np.random.default_rng(1)
free = np.flatnonzero(actor.rest_positions[:, 2] > 0.12)
markers = np.sort(random.choice(free, 30, replace=False))
seen = []
for _ in times:
    actor.step()
    seen.append(actor.positions[markers] + random.normal(scale=1e-3, size=(len(markers), 3)))

# the rig: the markers are handles, and the step finds the weights with which the body likes best to be there
rig = cat()
rig.grab("markers", markers, lambda rest, t: seen[round(t * n_frames) - 1] - rest if t > 0 else 0 * rest)
print("   t        rest           arch           rear           turn     (played, found)")
found = []
for time, weights in zip(times, played):
    rig.step()
    found.append(rig.weights)
    print(f"{time:5.2f}", *(f"{a:7.3f} {b:6.3f}" for a, b in zip(weights, rig.weights)))
print(f"The greatest difference is {abs(np.array(found) - played).max():.3f}.")
if len(sys.argv) > 2:
    import matplotlib.pyplot as plt
    for i, name in enumerate(["rest", *names]):
        plt.plot(times, played[:, i], f"C{i}", label=name)
        plt.plot(times, np.array(found)[:, i], f"C{i}o")
    plt.gca().set(xlabel="t", ylabel="weight: played (lines) and found (dots)")
    plt.legend()
    plt.savefig(sys.argv[2], dpi=90)
