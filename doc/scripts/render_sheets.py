# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws doc/figures/cloth.png, three moments of prm/shells/cloth.prm and its end without examples, and doc/tutorial/figures/step12_strip.png, of the strip of step 12.

    EXEMPLAR=build/release/exemplar /usr/bin/python3 doc/scripts/render_sheets.py

It takes a minute and no display. Debian: python3-pil, python3-numpy.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/scenes"))
from exemplar_runner import run_program  # noqa: E402

FINE = 3  # how many times finer a picture is drawn
LIGHT = np.array((-.6, .3, .6)) / .9
CLOTH, LINING, WOOD = (86, 130, 190), (200, 120, 110), (170, 128, 84)


def read_obj(file):
    """Vertices (n, 3) and triangles (m, 3), into which polygons are cut."""
    lines = [line.split() for line in file.read_text().splitlines() if line[:2] in ("v ", "f ")]
    polygons = [[int(word.split("/")[0]) - 1 for word in line[1:]] for line in lines if line[0] == "f"]
    return (np.array([line[1:4] for line in lines if line[0] == "v"], float),
            np.array([(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]))


def view(azimuth, elevation):
    """Axes to the right, up and to the viewer, in rows."""
    a, e = np.radians((azimuth, elevation))
    back = np.array((np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)))
    right = np.array((-np.sin(a), np.cos(a), 0))
    return np.array((right, np.cross(back, right), back))


class Picture:
    """Triangles with a depth for each pixel."""

    def __init__(self, axes, middle, width, size):
        self.axes, self.middle, self.scale, self.size = axes, np.array(middle), size[0] * FINE / width, size
        self.depth = np.full((size[1] * FINE, size[0] * FINE), -np.inf)
        self.colours = np.full((*self.depth.shape, 3), 255.)

    def draw(self, vertices, triangles, front, behind, smooth):
        x = (vertices - self.middle) @ self.axes.T
        normals = np.cross(x[triangles[:, 1]] - x[triangles[:, 0]], x[triangles[:, 2]] - x[triangles[:, 0]])
        at_corners = np.repeat(normals[:, None], 3, 1)
        if smooth:
            at_vertices = np.zeros_like(x)
            for k in range(3):
                np.add.at(at_vertices, triangles[:, k], normals)
            at_corners = at_vertices[triangles]
        at_corners = at_corners / np.maximum(np.linalg.norm(at_corners, axis=2, keepdims=True), 1e-30)
        for corners, normal, of_corners in zip(x[triangles], normals, at_corners):
            self.fill(corners, of_corners if normal[2] > 0 else -of_corners, front if normal[2] > 0 else behind)

    def fill(self, corners, normals, colour):
        height, width = self.depth.shape
        p = corners[:, :2] * (self.scale, -self.scale) + (.5 * width, .5 * height)
        low = np.maximum(np.floor(p.min(0)).astype(int), 0)
        high = np.minimum(np.ceil(p.max(0)).astype(int) + 1, (width, height))
        (ax, ay), (bx, by) = p[1] - p[0], p[2] - p[0]
        area = ax * by - ay * bx
        if (high <= low).any() or abs(area) < 1e-9:
            return
        x, y = np.meshgrid(np.arange(low[0], high[0]) + .5 - p[0, 0], np.arange(low[1], high[1]) + .5 - p[0, 1])
        second, third = (x * by - y * bx) / area, (ax * y - ay * x) / area
        shares = np.stack((1 - second - third, second, third), -1)
        block = (slice(low[1], high[1]), slice(low[0], high[0]))
        depth = shares @ corners[:, 2]
        seen = (shares >= 0).all(-1) & (depth > self.depth[block])
        normal = shares @ normals
        normal /= np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-30)
        self.depth[block][seen] = depth[seen]
        self.colours[block][seen] = (np.array(colour) * (.42 + .58 * np.clip(normal @ LIGHT, 0, 1))[..., None])[seen]

    def image(self):
        return Image.fromarray(np.clip(self.colours, 0, 255).astype(np.uint8)).resize(self.size, Image.LANCZOS)


def strip_of(panels, file):
    """Pictures beside each other."""
    width, height = panels[0].size
    whole = Image.new("RGB", (width * len(panels), height), "white")
    for k, panel in enumerate(panels):
        whole.paste(panel, (k * width, 0))
    whole.save(file, optimize=True)


def frames_of(scene, directory, *settings):
    words = [word for setting in settings for word in ("--set", setting)]
    run = run_program(scene, "--quiet", "--output", directory, *words)
    assert run.status == 0, run.stderr
    return directory


def cloth(directory):
    panels = []
    pleated = frames_of(ROOT / "prm/shells/cloth.prm", directory / "pleated")
    plain = frames_of(ROOT / "prm/shells/cloth.prm", directory / "plain", "Examples/Importance=0")
    for run, step in ((pleated, 15), (pleated, 35), (pleated, 100), (plain, 100)):
        picture = Picture(view(-135, 22), (0, 0, -.42), 1.35, (330, 360))
        picture.draw(*read_obj(run / f"frame_{step:04d}_obstacles.obj"), WOOD, WOOD, False)
        picture.draw(*read_obj(run / f"frame_{step:04d}.obj"), CLOTH, LINING, True)
        panels.append(picture.image())
    strip_of(panels, ROOT / "doc/figures/cloth.png")


def strip(directory):
    panels = []
    run = frames_of(ROOT / "prm/tutorial/step12_strip.prm", directory, "Output/Formats=obj")
    for step in (1, 10, 15, 20):
        picture = Picture(view(-70, 18), (.14, 0, .02), .42, (300, 330))
        picture.draw(*read_obj(run / f"frame_{step:04d}.obj"), CLOTH, LINING, True)
        panels.append(picture.image())
    strip_of(panels, ROOT / "doc/tutorial/figures/step12_strip.png")


def main():
    with tempfile.TemporaryDirectory() as directory:
        strip(Path(directory) / "strip")
        cloth(Path(directory))


if __name__ == "__main__":
    main()
