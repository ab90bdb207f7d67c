# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws doc/figures/face.png: the face of prm/shells at three of its increments.

    EXEMPLAR=build/release/exemplar python3 doc/scripts/render_face.py
"""

import csv
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.colors import LightSource
from render_leaf import ROOT, read_obj, run_program


def main():
    figure = plt.figure(figsize=(10, 4.2))
    with tempfile.TemporaryDirectory() as directory:
        output = Path(directory) / "face"
        run = run_program(ROOT / "prm/shells/face.prm", "--quiet", "--output", output)
        assert run.status == 0, run.stderr
        rows = list(csv.DictReader((output / "statistics.csv").open()))
        for k, step in enumerate((0, 5, 10)):
            x, triangles = read_obj(output / f"frame_{step:04d}.obj")
            axes = figure.add_subplot(1, 3, k + 1, projection="3d")
            axes.plot_trisurf(x[:, 0], x[:, 2], x[:, 1], triangles=triangles, color="#d9a585", linewidth=0, antialiased=False,
                              lightsource=LightSource(azdeg=150, altdeg=35))
            axes.set(xlim=(-.07, .07), ylim=(-.07, .07), zlim=(-.09, .09))
            axes.set_box_aspect((.14, .14, .18))
            axes.view_init(8, 75)
            axes.set_axis_off()
            weights = ", ".join(f"{float(rows[step][f'weight_{i}']):.2f}" for i in (1, 2, 3))
            axes.set_title(f"weights {weights}", fontsize=9, y=-.02)
    plt.subplots_adjust(0, 0, 1, 1, 0, 0)
    plt.savefig(ROOT / "doc/figures/face.png", dpi=110)


if __name__ == "__main__":
    main()
