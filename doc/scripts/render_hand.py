#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/hand.png: a hand whose middle fingertip is taken half of the way to the fist, by poses that guide and that lead.

Usage, from the top folder: /usr/bin/python3 doc/scripts/render_hand.py build/release/exemplar

It takes two minutes and no display. Debian: python3-pil, python3-numpy.
"""
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from scene_runs import read_csv, read_msh, run_scene, write_scene

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests/scenes"))
from hand_mesh import Hand, half_way  # noqa: E402
from render_contact import boundary  # noqa: E402

WIDTH, HEIGHT, FINE = 400, 330, 3  # of a panel in pixels, and how many times finer it is drawn
SKIN, INK, MARK = np.array((222, 168, 134)), (40, 44, 52), (31, 111, 235)
VIEW = np.array(((.80, -.60, 0.), (-.30, -.40, .866), (-.52, -.693, -.5)))  # right, up and away from the eye
MIDDLE, SIZE = np.array((.034, .06, -.013)), .20  # of the picture [m]
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def seen(places):
    """(x, y in pixels, depth) of places."""
    view = (places - MIDDLE) @ VIEW.T
    return np.stack([(view[:, 0] / SIZE + .5) * WIDTH * FINE, (.5 - view[:, 1] / SIZE * WIDTH / HEIGHT) * HEIGHT * FINE, view[:, 2]], axis=1)


def normals_at(points, faces):
    corners = points[faces]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = np.zeros_like(points)
    for k in range(3):
        np.add.at(sums, faces[:, k], flat)
    return sums / np.maximum(np.linalg.norm(sums, axis=1), 1e-30)[:, None]


def outwards(points, cells):
    """Faces of the boundary, counterclockwise seen from outside."""
    opposite = {tuple(sorted(np.delete(cell, k))): cell[k] for cell in cells for k in range(4)}
    faces = boundary(cells)
    for face in faces:
        a, b, c = points[face]
        if np.dot(np.cross(b - a, c - a), points[opposite[tuple(face)]] - a) > 0:
            face[1], face[2] = face[2], face[1]
    return faces


def panel(points, faces, tip, title):
    picture = Image.new("RGB", (WIDTH * FINE, HEIGHT * FINE), "white")
    draw = ImageDraw.Draw(picture)
    at, normals = seen(points), normals_at(points, faces)
    light = np.array((.25, -.55, .8)) / np.linalg.norm((.25, -.55, .8))
    shade = np.clip(.5 + .5 * (normals @ light)[faces].mean(1), .25, 1.)
    for i in np.argsort(-at[faces, 2].mean(1)):
        draw.polygon([tuple(at[v, :2]) for v in faces[i]], fill=tuple((SKIN * shade[i]).astype(int)))
    x, y, _ = seen(tip[None])[0]
    r = 5 * FINE
    draw.ellipse((x - r, y - r, x + r, y + r), outline=MARK, width=2 * FINE)
    picture = picture.resize((WIDTH, HEIGHT), Image.LANCZOS)
    ImageDraw.Draw(picture).text((WIDTH / 2, HEIGHT - 14), title, fill=INK, font=ImageFont.truetype(FONT, 15), anchor="ms")
    return picture


def main():
    program, hand = Path(sys.argv[1]).resolve(), Hand(4)
    sheet = Image.new("RGB", (3 * WIDTH, HEIGHT), "white")
    with tempfile.TemporaryDirectory() as folder:
        hand.write(folder)
        scene = write_scene(Path(folder, "hand.prm"), half_way(hand))
        mesh = read_msh(Path(folder, "hand.msh"))
        number = {name: i for i, name in enumerate(mesh.nodes)}
        cells = np.array([[number[node] for node in element[5:]] for element in mesh.elements if element[1] == 4])
        rest = np.array(list(mesh.nodes.values()))
        faces = outwards(rest, cells)
        sheet.paste(panel(rest, faces, np.array(hand.fingertip(1, False)), "at rest"), (0, 0))
        for column, (word, energy) in enumerate((("guide", "mixed"), ("lead", "scaled")), 1):
            run = run_scene(program, scene, Path(folder, word), {"Examples/Energy": energy})
            weight = read_csv(run.output)[-1]["weight_1"]
            points = np.array(list(read_msh(run.output / "final.msh").nodes.values()))
            tip = points[np.argmin(np.linalg.norm(rest - hand.fingertip(1, False), axis=1))]
            print(word, weight)
            sheet.paste(panel(points, faces, tip, f"{word}: weight of the fist {weight:.2f}"), (column * WIDTH, 0))
    sheet.save(TOP / "doc/figures/hand.png")


if __name__ == "__main__":
    main()
