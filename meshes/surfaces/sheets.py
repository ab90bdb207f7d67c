# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the flat sheets of shells beside this file: cloth.obj of prm/shells, strip*.obj of the tutorial's step 12.

    python3 meshes/surfaces/sheets.py
"""

from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def corners(nx, ny, alternating):
    """Triangles of nx times ny squares, by the numbers of their vertices, x fastest; diagonals all alike or in turn."""
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i + 1
            b, c, d = a + 1, a + nx + 2, a + nx + 1
            yield from ((a, b, d), (b, c, d)) if alternating and (i + j) % 2 else ((a, b, c), (a, c, d))


def write(name, what, x, y, nx, ny, alternating):
    """A sheet over intervals x and y [m]."""
    lines = [f"# {what}, in {2 * nx * ny} triangles; by exemplar, GPL-3.0-or-later"]
    lines += [f"v {x[0] + (x[1] - x[0]) * i / nx:.6g} {y[0] + (y[1] - y[0]) * j / ny:.6g} 0" for j in range(ny + 1) for i in range(nx + 1)]
    lines += [f"f {a} {b} {c}" for a, b, c in corners(nx, ny, alternating)]
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def main():
    write("cloth.obj", "a cloth of 1 m x 0.8 m", (-.5, .5), (-.4, .4), 28, 22, True)
    # the column beyond 0.3 m is held
    strip, x, y = "a strip of 0.3 m x 0.06 m with a column more", (-.0125, .3), (-.03, .03)
    write("strip.obj", strip, x, y, 25, 5, False)
    write("strip_turned.obj", strip + " and its diagonals in turn", x, y, 25, 5, True)
    write("strip_fine.obj", strip, x, y, 50, 10, False)


if __name__ == "__main__":
    main()
