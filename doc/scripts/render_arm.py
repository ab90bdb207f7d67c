#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/tutorial/figures/step11_arm.png: the arm of step 11 at rest, flexed and extended, without the flesh that is nearer than its bones.

Usage, from the top folder: /usr/bin/python3 doc/scripts/render_arm.py build/release/exemplar

It takes half a minute and no display. Debian: python3-pil, python3-numpy.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from render_body_contact import panel
from render_moving_cat import array, skin_of

TOP = Path(__file__).resolve().parents[2]
SIZE = (460, 420)
FLESH, UPPER, LOWER, BICEPS, TRICEPS = range(1, 6)  # regions of the mesh
COLOURS = {FLESH: (238, 190, 160), UPPER: (240, 236, 220), LOWER: (240, 236, 220)}
PULLS, SLACK = (206, 30, 26), (168, 104, 98)
MOMENTS = [(0, "at rest", None), (5, "flexed: the biceps pulls with 9 kPa", BICEPS), (15, "extended: the triceps pulls with 4 kPa", TRICEPS)]


def main():
    program = Path(sys.argv[1]).resolve()
    font = ImageFont.truetype(str(next(Path("/usr/share/fonts").rglob("DejaVuSans.ttf"))), 16)
    sheet = Image.new("RGB", (len(MOMENTS) * SIZE[0], SIZE[1]), "white")
    with tempfile.TemporaryDirectory() as output:
        subprocess.run([program, TOP / "prm/tutorial/step11_arm.prm", "--quiet", "--output", output], check=True)
        frames = [Path(output, f"frame_{step:04}.vtu").read_text(errors="replace") for step, _, _ in MOMENTS]
    rest = array(frames[0], "Points").reshape(-1, 3)
    cells, region = array(frames[0], "connectivity").reshape(-1, 4), array(frames[0], "region")
    far = rest[cells][:, :, 1].mean(1) > 0
    skins = {part: skin_of(cells[(region == part) & (far | (part != FLESH))]) for part in range(FLESH, TRICEPS + 1)}
    for column, (text, (_, words, pulling)) in enumerate(zip(frames, MOMENTS)):
        paint = {**COLOURS, BICEPS: SLACK, TRICEPS: SLACK, **({pulling: PULLS} if pulling else {})}
        colours = np.concatenate([np.tile(paint[part], (len(skin), 1)) for part, skin in skins.items()])
        picture = panel(array(text, "Points").reshape(-1, 3).astype(float), np.concatenate(list(skins.values())), colours,
                        (-.25, 1, -.25), (.29, 0, .04), .62, SIZE)
        ImageDraw.Draw(picture).text((14, 10), words, fill=(30, 30, 30), font=font)
        sheet.paste(picture, (column * SIZE[0], 0))
    sheet.save(TOP / "doc/tutorial/figures/step11_arm.png", optimize=True)


if __name__ == "__main__":
    main()
