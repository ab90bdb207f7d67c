#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/cat_moves.webp, the moving picture of README.md: the paper's Figure 2 d by the default method, without examples
beside with them.

Usage, from the top folder: /usr/bin/python3 doc/scripts/render_moving_cat.py build/release/exemplar

It takes half a minute and no display. Debian: python3-pil, python3-numpy.
"""
import base64
import re
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

TOP = Path(__file__).resolve().parents[2]
SETTINGS = ["Model/Gradient=consistent", "Model/Dilatation=auto", "Examples/Weights=simplex", "Examples/Weight penalty=auto",
            "Examples/Energy=mixed", "Solver/Method=auto", "Output/Every=2"]
GREY, ORANGE, HELD, MOVED = (158, 178, 199), (242, 173, 92), (26, 64, 217), (217, 13, 26)
WIDTH, HEIGHT, FINE = 420, 380, 2  # of a panel in pixels, and how many times finer it is drawn
CENTRE, SCALE = np.array([-0.12, 0, 0.55]), 0.76  # [m], and half the height of a panel
HELD_BOX, MOVED_BOX = ((-.52, -.2, -.01), (-.27, .2, .08)), ((.26, -.2, -.01), (.5, .2, .08))


def array(text, name):
    """One array of a .vtu file: blocks by zlib behind a header of their sizes, both in base64."""
    kind, data = re.search(rf'<DataArray type="(\w+)" Name="{name}"[^>]*>\s*([^<\s]*)', text).groups()
    n_blocks = int.from_bytes(base64.b64decode(data[:12])[:8], "little")
    width = 4 * -(-8 * (3 + n_blocks) // 3)
    sizes = np.frombuffer(base64.b64decode(data[:width])[:8 * (3 + n_blocks)], "<u8")[3:]
    packed, ends = base64.b64decode(data[width:]), np.cumsum(sizes)
    blocks = b"".join(zlib.decompress(packed[end - size:end]) for size, end in zip(sizes, ends))
    return np.frombuffer(blocks, {"Float64": "<f8", "Float32": "<f4", "Int32": "<i4", "Int64": "<i8"}[kind])


def skin_of(cells):
    """Triangles of tetrahedra that belong to one alone, outwards."""
    faces = np.concatenate([cells[:, list(corners)] for corners in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def frames_of(program, directory, *settings):
    """(places at rest, triangles of the surface, places of each frame)."""
    sets = [word for setting in (*SETTINGS, *settings) for word in ("--set", setting)]
    subprocess.run([program, str(TOP / "prm/paper/fig2d_cat.prm"), "--quiet", "--output", directory, *sets], check=True)
    texts = [file.read_text() for file in sorted(Path(directory).glob("frame_*.vtu"))]
    places = [array(text, "Points").reshape(-1, 3).astype(float) for text in texts]
    triangles = skin_of(array(texts[0], "connectivity").reshape(-1, 4))
    return places[0], triangles, places


def panel(rest, triangles, places, colour, text, font):
    """The surface from its side, painted from back to front."""
    look = np.array([-0.35, 1, -0.32])
    look /= np.linalg.norm(look)
    right = np.cross(look, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    unit = HEIGHT * FINE / (2 * SCALE)

    def pixels(x):
        return np.stack([WIDTH * FINE / 2 + unit * (x - CENTRE) @ right, HEIGHT * FINE / 2 - unit * (x - CENTRE) @ up], -1)

    corners = places[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    # smooth enough by the mean at the nodes
    smooth = np.zeros_like(places)
    for i in range(3):
        np.add.at(smooth, triangles[:, i], normals)
    smooth = smooth[triangles].mean(1)
    smooth /= np.linalg.norm(smooth, axis=1)[:, None] + 1e-12
    light = np.clip(.45 + .55 * np.clip(smooth @ (-look * .8 + up * .5 - right * .2), 0, 1), 0, 1)
    image = Image.new("RGB", (WIDTH * FINE, HEIGHT * FINE), "white")
    draw = ImageDraw.Draw(image)
    flat = pixels(corners)
    for i in np.argsort(-(corners.mean(1) @ look)):
        if normals[i] @ look < 0:
            draw.polygon([tuple(p) for p in flat[i]], fill=tuple(int(c * light[i]) for c in colour))
    for (low, high), paint in ((HELD_BOX, HELD), (MOVED_BOX, MOVED)):
        for x, y in pixels(places[((rest >= low) & (rest <= high)).all(1)]):
            draw.ellipse((x - 4, y - 4, x + 4, y + 4), fill=paint)
    draw.text((12, 8), text, fill=(30, 30, 30), font=font)
    return image.resize((WIDTH, HEIGHT), Image.LANCZOS)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    font = ImageFont.truetype(str(next(Path("/usr/share/fonts").rglob("DejaVuSans.ttf"))), 17 * FINE)
    program, pictures = str(Path(sys.argv[1]).resolve()), []
    with tempfile.TemporaryDirectory() as directory:
        runs = [frames_of(program, f"{directory}/plain", "Examples/Importance=0"), frames_of(program, f"{directory}/examples")]
    for plain, examples in zip(runs[0][2], runs[1][2]):
        picture = Image.new("RGB", (2 * WIDTH, HEIGHT), "white")
        picture.paste(panel(*runs[0][:2], plain, GREY, "without examples", font), (0, 0))
        picture.paste(panel(*runs[1][:2], examples, ORANGE, "with two examples", font), (WIDTH, 0))
        pictures.append(picture)
    durations = [40] * (len(pictures) - 1) + [1500]
    pictures[0].save(TOP / "doc/figures/cat_moves.webp", save_all=True, append_images=pictures[1:], duration=durations, loop=0,
                     quality=70, method=4)


if __name__ == "__main__":
    main()
