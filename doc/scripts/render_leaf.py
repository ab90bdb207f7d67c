# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws doc/figures/shells.png: the leaf of prm/shells at four of its increments.

    EXEMPLAR=build/release/exemplar python3 doc/scripts/render_leaf.py
"""

import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.colors import LightSource  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/scenes"))
from exemplar_runner import run_program  # noqa: E402


def read_obj(file):
    lines = [line.split() for line in file.read_text().splitlines() if line[:2] in ("v ", "f ")]
    return (np.array([line[1:4] for line in lines if line[0] == "v"], float),
            np.array([[int(word.split("/")[0]) - 1 for word in line[1:4]] for line in lines if line[0] == "f"]))


def main():
    figure = plt.figure(figsize=(12, 3.2))
    with tempfile.TemporaryDirectory() as directory:
        run = run_program(ROOT / "prm/shells/leaf.prm", "--quiet", "--output", Path(directory) / "leaf")
        assert run.status == 0, run.stderr
        for k, step in enumerate((0, 7, 14, 20)):
            x, triangles = read_obj(Path(directory) / "leaf" / f"frame_{step:04d}.obj")
            axes = figure.add_subplot(1, 4, k + 1, projection="3d")
            axes.plot_trisurf(*x.T, triangles=triangles, color="#5a9e48", linewidth=0, antialiased=False,
                              lightsource=LightSource(azdeg=200, altdeg=50))
            axes.set(xlim=(0, .12), ylim=(-.06, .06), zlim=(-.09, .03))
            axes.set_box_aspect((1, 1, 1))
            axes.view_init(28, -55)
            axes.set_axis_off()
            axes.set_title(f"t = {step / 20:g}", fontsize=9, y=-.02)
    plt.subplots_adjust(0, 0, 1, 1, 0, 0)
    plt.savefig(ROOT / "doc/figures/shells.png", dpi=110)


if __name__ == "__main__":
    main()
