# SPDX-License-Identifier: GPL-3.0-or-later
"""The body's surface by matplotlib. The module imports this file when problem.plot() is called, and matplotlib then."""
import numpy as np

from exemplar import UserError

# the faces of a cell (from its nodes), seen from outside in right-handed order
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
LIGHT = np.array([-0.4, -0.7, 0.6])


def surface(cells):
    """Triangles (k, 3) of nodes that belong to one cell alone, and these cells (k,)."""
    faces = cells[:, FACES].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = np.sort(first[count == 1])
    return faces[outer], outer // 4


def values_of_faces(problem, values, triangles, cells):
    """One number a triangle (k,), and what they are called."""
    n, m = len(problem.positions), len(problem.cells)
    if values is None:
        lengths = np.linalg.norm(problem.positions - problem.rest_positions, axis=1)
        return lengths[triangles].mean(axis=1), "displacement [m]"
    try:
        values = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise UserError(f"plot: values are no array of numbers. Allowed: one number a node ({n},) or a cell ({m},).") from None
    if values.shape not in ((n,), (m,)):
        raise UserError(f"plot: values have shape {values.shape}. Allowed: one number a node ({n},) or a cell ({m},). "
                        "Of vectors take a component or np.linalg.norm(values, axis=1).")
    if not np.isfinite(values).all():
        raise UserError(f"plot: values[{np.flatnonzero(~np.isfinite(values))[0]}] is not finite. Allowed: finite numbers.")
    return (values[triangles].mean(axis=1) if values.shape == (n,) else values[cells]), ""


def new_axes():
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("problem.plot() needs matplotlib, which this Python cannot import. Install it (Debian: "
                          "apt-get install python3-matplotlib; elsewhere: pip install matplotlib).") from error
    return plt.figure().add_subplot(projection="3d")


def shaded(colours, corners):
    """Colours (k, 4) of triangles (k, 3, 3), darker where they turn away from the light."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    cosines = normals @ LIGHT / (np.linalg.norm(normals, axis=1) * np.linalg.norm(LIGHT) + 1e-300)
    colours[:, :3] *= (0.75 + 0.25 * cosines)[:, None]
    return colours


def plot(problem, values, axes):
    triangles, cells = surface(problem.cells)
    numbers, label = values_of_faces(problem, values, triangles, cells)
    axes = new_axes() if axes is None else axes
    if getattr(axes, "name", None) != "3d":
        raise UserError("plot: axes are not of space. Make them by plt.figure().add_subplot(projection='3d').")
    from matplotlib.cm import ScalarMappable
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    scale = ScalarMappable(cmap="viridis")
    scale.set_array(numbers)
    scale.autoscale()
    corners = problem.positions[triangles]
    axes.add_collection3d(Poly3DCollection(corners, facecolors=shaded(scale.to_rgba(numbers), corners)))
    low, high = problem.positions.min(axis=0), problem.positions.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]), xlabel="x", ylabel="y", zlabel="z")
    axes.locator_params(nbins=4)
    axes.set_box_aspect(np.maximum(high - low, 1e-3 * (high - low).max()))
    axes.figure.colorbar(scale, ax=axes, shrink=0.6, pad=0.15, label=label)
    return axes
