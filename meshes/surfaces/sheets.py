# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the sheets of shells beside this file: cloth.obj and face.obj of prm/shells, strip*.obj of the tutorial's step 12, sheet.obj of
benchmarks.

    python3 meshes/surfaces/sheets.py
"""

from math import exp, sqrt
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def corners(nx, ny, alternating):
    """Triangles of nx times ny squares, by the numbers of their vertices, x fastest; diagonals all alike or in turn."""
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i + 1
            b, c, d = a + 1, a + nx + 2, a + nx + 1
            yield from ((a, b, d), (b, c, d)) if alternating and (i + j) % 2 else ((a, b, c), (a, c, d))


def face_place(u, v):
    """Of a mask, for u and v in [-1, 1] [m]: a dome with brows, sockets of eyes, a nose, lips and a chin."""
    x, y = .07 * u * sqrt(1. - .35 * v * v), .095 * v * sqrt(1. - .35 * u * u)

    def bump(x0, y0, width, height):
        return exp(-((x - x0) / width)**2 - ((y - y0) / height)**2)
    dome = .06 * (1. - (x / .09)**2 - .5 * (y / .12)**2)
    eyes = bump(.028, .022, .014, .01) + bump(-.028, .022, .014, .01)
    brows = bump(.027, .04, .02, .008) + bump(-.027, .04, .02, .008)
    lips = bump(0., -.043, .02, .004) + bump(0., -.052, .018, .004)
    nose = bump(0., -.012, .009, .012) + .5 * bump(0., .012, .008, .02)
    return x, y, dome - .009 * eyes + .004 * brows + .02 * nose + .004 * lips + .006 * bump(0., -.08, .02, .012)


def write_face(nx, ny):
    lines = [f"# a face, in {2 * nx * ny} triangles; by exemplar, GPL-3.0-or-later"]
    lines += ["v {:.6g} {:.6g} {:.6g}".format(*face_place(2. * i / nx - 1., 2. * j / ny - 1.)) for j in range(ny + 1) for i in range(nx + 1)]
    lines += [f"f {a} {b} {c}" for a, b, c in corners(nx, ny, True)]
    (FOLDER / "face.obj").write_text("\n".join(lines) + "\n")


def write(name, what, x, y, nx, ny, alternating):
    """A sheet over intervals x and y [m]."""
    lines = [f"# {what}, in {2 * nx * ny} triangles; by exemplar, GPL-3.0-or-later"]
    lines += [f"v {x[0] + (x[1] - x[0]) * i / nx:.6g} {y[0] + (y[1] - y[0]) * j / ny:.6g} 0" for j in range(ny + 1) for i in range(nx + 1)]
    lines += [f"f {a} {b} {c}" for a, b, c in corners(nx, ny, alternating)]
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def main():
    write("cloth.obj", "a cloth of 1 m x 0.8 m", (-.5, .5), (-.4, .4), 28, 22, True)
    write("sheet.obj", "a sheet of 1 m x 1 m", (-.5, .5), (-.5, .5), 50, 50, True)
    write_face(40, 50)
    # the column beyond 0.3 m is held
    strip, x, y = "a strip of 0.3 m x 0.06 m with a column more", (-.0125, .3), (-.03, .03)
    write("strip.obj", strip, x, y, 25, 5, False)
    write("strip_turned.obj", strip + " and its diagonals in turn", x, y, 25, 5, True)
    write("strip_fine.obj", strip, x, y, 50, 10, False)


if __name__ == "__main__":
    main()
