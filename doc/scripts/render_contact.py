#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/contact.png: three moments of each scene of prm/contact, seen from the side.

Usage, from the top folder: /usr/bin/python3 doc/scripts/render_contact.py build/release/exemplar

It takes a minute and no display. Debian: python3-pil, python3-numpy.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from render_moving_cat import array

TOP = Path(__file__).resolve().parents[2]
WIDTH, HEIGHT, FINE = 420, 300, 3  # of a panel in pixels, and how many times finer it is drawn
BODY, STONE = np.array((158, 178, 199)), (120, 110, 104)
# scene, times [s], middle of the picture (x, z) [m], its width [m]
PANELS = [("cat_on_stairs", (0.14, 0.24, 1.0), (0, 0.35), 2.2), ("anvil_and_slope", (0.14, 0.3, 1.4), (0.3, -0.4), 1.8),
          ("rollers", (0.1, 0.5, 1.4), (1.0, 0), 2.2)]


def obstacles(scene, time):
    """Outlines in (x, z) of the obstacles as the scene file has them."""
    text = (TOP / f"prm/contact/{scene}.prm").read_text()
    for block in re.findall(r"set Shape = (.*(?:\n +set .*)*)", text):
        kind, *numbers = block.split("\n")[0].split()
        n = [float(x) for x in numbers]
        motion = re.search(r"set Motion = (.*)", block)
        x, z = (eval(f, {"min": min, "t": time}) for f in motion.group(1).split(";")[::2]) if motion else (0, 0)
        if kind == "box":
            yield [(n[0], n[2]), (n[3], n[2]), (n[3], n[5]), (n[0], n[5])]
        elif kind == "plane":  # with y in the plane
            along, down = np.array((n[5], -n[3])) * 9, np.array((n[3], n[5])) * -9
            p = np.array((n[0], n[2]))
            yield [tuple(q) for q in (p - along, p + along, p + along + down, p - along + down)]
        else:  # a capsule along y
            yield [(n[0] + x + n[6] * np.cos(a), n[2] + z + n[6] * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 60)]


def boundary(cells):
    faces = np.sort(np.concatenate([cells[:, k] for k in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))]), axis=1)
    unique, count = np.unique(faces, axis=0, return_counts=True)
    return unique[count == 1]


def panel(scene, frame, time, middle, width):
    text = frame.read_text(errors="replace")
    points, cells = array(text, "Points").reshape(-1, 3), array(text, "connectivity").reshape(-1, 4)
    picture = Image.new("RGB", (WIDTH * FINE, HEIGHT * FINE), "white")
    draw = ImageDraw.Draw(picture)

    def place(x, z):
        return ((x - middle[0]) / width + 0.5) * WIDTH * FINE, HEIGHT * FINE / 2 - (z - middle[1]) / width * WIDTH * FINE
    for outline in obstacles(scene, time):
        draw.polygon([place(*p) for p in outline], fill=STONE)
    faces = boundary(cells)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    shade = 0.55 + 0.45 * np.abs(normals @ (0.3, -0.8, 0.52)) / np.linalg.norm(normals, axis=1)
    for i in np.argsort(-corners[:, :, 1].mean(1)):
        draw.polygon([place(x, z) for x, _, z in corners[i]], fill=tuple((BODY * shade[i]).astype(int)))
    return picture.resize((WIDTH, HEIGHT), Image.LANCZOS)


def main():
    program = Path(sys.argv[1]).resolve()
    sheet = Image.new("RGB", (3 * WIDTH, len(PANELS) * HEIGHT), "white")
    with tempfile.TemporaryDirectory() as folder:
        for row, (scene, times, middle, width) in enumerate(PANELS):
            output = Path(folder, scene)
            subprocess.run([program, TOP / f"prm/contact/{scene}.prm", "--quiet", "--output", output], check=True)
            for column, time in enumerate(times):
                frame = output / f"frame_{round(time / 0.01):04}.vtu"
                sheet.paste(panel(scene, frame, time, middle, width), (column * WIDTH, row * HEIGHT))
    sheet.save(TOP / "doc/figures/contact.png")


if __name__ == "__main__":
    main()
