#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/body_contact.png: four moments of each scene of prm/contact in which a body meets itself or another one.

Usage, from the top folder: /usr/bin/python3 doc/scripts/render_body_contact.py build/release/exemplar

It takes two minutes and no display. Debian: python3-pil, python3-numpy.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from render_moving_cat import GREY, ORANGE, array, skin_of

TOP = Path(__file__).resolve().parents[2]
WIDTH, HEIGHT, FINE = 300, 240, 3  # of a panel in pixels, and how many times finer it is drawn
WHITE, IRIS, SKIN = (240, 240, 236), (82, 58, 40), (226, 166, 136)


def pieces_of(n, cells):
    """The number of the piece of each node: the least node that cells join it with."""
    piece = np.arange(n)
    while True:
        least = piece[cells].min(1)
        before = piece.copy()
        np.minimum.at(piece, cells, least[:, None])
        if (piece == before).all():
            return piece


def orange(rest, triangles, piece):
    return np.where((piece[triangles[:, 0]] == 0)[:, None], ORANGE, GREY)


def eye_colours(rest, triangles, piece):
    middles = rest[triangles].mean(1)
    ball = piece[triangles[:, 0]] == 0
    iris = ball & (middles[:, 0] > 0) & (np.linalg.norm(middles[:, 1:], axis=1) < .0052)
    return np.where(iris[:, None], IRIS, np.where(ball[:, None], WHITE, SKIN))


# scene, its step [s], times [s], where one looks, middle of the picture [m], its width [m], colours of triangles
ROWS = [("cat_washes", .02, (.4, .8, 1.12, 2.2), (-.7, .7, -.15), (.27, 0, .62), 1.35, orange),
        ("folded_plate", .02, (.6, 1.4, 2, 3), (.5, 1, -.6), (.55, 0, .2), 1.35, orange),
        ("two_cats", .02, (.08, .24, .4, .64), (-.25, 1, -.2), (.95, 0, .6), 2.5, orange),
        ("eye_in_socket", .02, (0, .52, .76, 1), (-1, .35, -.25), (0, 0, 0), .052, eye_colours)]


def shades(places, triangles, light):
    """At the corners of triangles: of the mean normal at a node, but of the triangle's own one beside a sharp edge."""
    normals = np.cross(places[triangles[:, 1]] - places[triangles[:, 0]], places[triangles[:, 2]] - places[triangles[:, 0]])
    smooth = np.zeros_like(places)
    for i in range(3):
        np.add.at(smooth, triangles[:, i], normals)
    smooth = smooth[triangles] / (np.linalg.norm(smooth, axis=1)[triangles][:, :, None] + 1e-30)
    normals /= np.linalg.norm(normals, axis=1)[:, None] + 1e-30
    is_smooth = np.einsum("ijk,ik->ij", smooth, normals) > .85
    return .35 + .65 * np.clip(np.where(is_smooth[:, :, None], smooth, normals[:, None]) @ light, 0, 1)


def panel(places, triangles, colours, look, middle, width, size=(WIDTH, HEIGHT)):
    """The surface with what is in front hiding what is behind, pixel by pixel."""
    look = np.array(look) / np.linalg.norm(look)
    right = np.cross(look, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    light = .6 * up - .7 * look - .35 * right
    shade = shades(places, triangles, light / np.linalg.norm(light))
    x = places - np.array(middle)
    n_x, n_y = size[0] * FINE, size[1] * FINE
    unit = n_x / width
    seen = np.stack([n_x / 2 + unit * x @ right, n_y / 2 - unit * x @ up, x @ look], -1)
    depth, picture = np.full((n_y, n_x), np.inf), np.full((n_y, n_x, 3), 255.)
    for corners, light_of, colour in zip(seen[triangles], shade, colours):
        (a, b, c), (x0, y0) = corners, np.maximum(corners[:, :2].min(0).astype(int), 0)
        x1, y1 = np.minimum(corners[:, :2].max(0).astype(int) + 2, (n_x, n_y))
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if x0 >= x1 or y0 >= y1 or area >= 0:  # outside, or seen from behind
            continue
        u, v = np.meshgrid(np.arange(x0, x1) + .5 - a[0], np.arange(y0, y1) + .5 - a[1])
        of_b = (u * (c[1] - a[1]) - v * (c[0] - a[0])) / area
        of_c = (v * (b[0] - a[0]) - u * (b[1] - a[1])) / area
        share = np.stack([1 - of_b - of_c, of_b, of_c], -1)
        far = share @ corners[:, 2]
        nearer = (share >= -1e-9).all(-1) & (far < depth[y0:y1, x0:x1])
        depth[y0:y1, x0:x1][nearer] = far[nearer]
        picture[y0:y1, x0:x1][nearer] = (share @ light_of)[nearer][:, None] * colour
    return Image.fromarray(picture.astype(np.uint8)).resize(size, Image.LANCZOS)


def main():
    program = Path(sys.argv[1]).resolve()
    sheet = Image.new("RGB", (4 * WIDTH, len(ROWS) * HEIGHT), "white")
    with tempfile.TemporaryDirectory() as folder:
        for row, (scene, step, times, look, middle, width, paint) in enumerate(ROWS):
            output = Path(folder, scene)
            subprocess.run([program, TOP / f"prm/contact/{scene}.prm", "--quiet", "--output", output], check=True)
            rest = array((output / "frame_0000.vtu").read_text(errors="replace"), "Points").reshape(-1, 3)
            for column, time in enumerate(times):
                text = (output / f"frame_{round(time / step):04}.vtu").read_text(errors="replace")
                places, cells = array(text, "Points").reshape(-1, 3).astype(float), array(text, "connectivity").reshape(-1, 4)
                triangles = skin_of(cells)
                colours = paint(rest, triangles, pieces_of(len(rest), cells))
                sheet.paste(panel(places, triangles, colours, look, middle, width), (column * WIDTH, row * HEIGHT))
    sheet.quantize(256, dither=Image.Dither.NONE).save(TOP / "doc/figures/body_contact.png", optimize=True)


if __name__ == "__main__":
    main()
