# SPDX-License-Identifier: GPL-3.0-or-later
"""The body's surface by matplotlib. The module imports this file when a problem draws or is asked for its surface, and matplotlib
when it draws."""
import numpy as np

from exemplar import UserError

# the faces of a cell (from its nodes), seen from outside in right-handed order
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
LIGHT = np.array([-0.4, -0.7, 0.6])


def surface(cells):
    """Triangles (k, 3) of nodes that belong to one cell alone, or all of a shell, and these cells (k,)."""
    if cells.shape[1] == 3:
        return cells, np.arange(len(cells))
    faces = cells[:, FACES].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = np.sort(first[count == 1])
    return faces[outer], outer // 4


def real_numbers(values, what, allowed):
    """As an array of floats; complex numbers would lose their imaginary parts."""
    try:
        if not np.iscomplexobj(values):
            return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        pass
    raise UserError(f"{what} no array of real numbers. Allowed: {allowed}.")


def values_of_faces(problem, values, triangles, cells):
    """One number per triangle (k,), and the label of the displacements; that of other values is not known."""
    n, m = len(problem.positions), len(problem.cells)
    if values is None:
        return displacements_of_faces(problem, problem.positions, triangles), "displacement [m]"
    allowed = f"one number a node ({n},) or a cell ({m},)"
    values = real_numbers(values, "plot: values are", allowed)
    if values.shape not in ((n,), (m,)):
        raise UserError(f"plot: values have shape {values.shape}. Allowed: {allowed}. "
                        "Of vectors take a component or np.linalg.norm(values, axis=1).")
    if not np.isfinite(values).all():
        raise UserError(f"plot: values[{np.flatnonzero(~np.isfinite(values))[0]}] is not finite. Allowed: finite numbers.")
    return (values[triangles].mean(axis=1) if values.shape == (n,) else values[cells]), ""


def displacements_of_faces(problem, positions, triangles):
    return np.linalg.norm(positions - problem.rest_positions, axis=1)[triangles].mean(axis=1)


def new_axes(call):
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError(f"problem.{call}() needs matplotlib, which this Python cannot import. Install it (Debian: "
                          "apt-get install python3-matplotlib; elsewhere: pip install matplotlib).") from error
    return plt.figure().add_subplot(projection="3d")


def axes_of_space(axes, call):
    """These, or those of a new figure."""
    axes = new_axes(call) if axes is None else axes
    if getattr(axes, "name", None) != "3d":
        raise UserError(f"{call}: axes are not of space. Make them by plt.figure().add_subplot(projection='3d').")
    return axes


def shaded(colours, corners):
    """Colours (k, 4) of triangles (k, 3, 3), darker where they turn away from the light."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    cosines = normals @ LIGHT / (np.linalg.norm(normals, axis=1) * np.linalg.norm(LIGHT) + 1e-300)
    colours[:, :3] *= (0.75 + 0.25 * cosines)[:, None]
    return colours


def scale_of(numbers):
    """From the least to the greatest of these."""
    from matplotlib.cm import ScalarMappable

    scale = ScalarMappable(cmap="viridis")
    scale.set_array(numbers)
    scale.autoscale()
    return scale


def set_box(axes, points):
    """Axes around all points, of one scale."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.maximum(high - low, 1e-3 * (high - low).max())
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]), xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    for name, part in zip("xyz", size / size.max()):  # ticks of short axes would overlap
        axes.locator_params(axis=name, nbins=max(1, round(4 * part)))
    axes.set_box_aspect(size)


def draw(axes, corners, numbers, scale, label):
    """The surface in these colours, with their bar."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    drawn = Poly3DCollection(corners, facecolors=shaded(scale.to_rgba(numbers), corners))
    axes.add_collection3d(drawn)
    axes.figure.colorbar(scale, ax=axes, shrink=0.6, pad=0.15, label=label)
    return drawn


def plot(problem, values, axes, label):
    if label is not None and not isinstance(label, str):
        raise UserError(f"plot: label is {label!r}. Allowed: a text such as \"stress [Pa]\", or None.")
    triangles, cells = surface(problem.cells)
    numbers, usual = values_of_faces(problem, values, triangles, cells)
    label = usual if label is None else label
    axes = axes_of_space(axes, "plot")
    draw(axes, problem.positions[triangles], numbers, scale_of(numbers), label)
    set_box(axes, problem.positions)
    return axes


def frames_of(problem, positions):
    """A list of arrays (n, 3)."""
    shape = problem.positions.shape
    allowed = f"a list of at least two arrays of shape {shape}, such as trajectory.positions"
    frames = [real_numbers(frame, f"animate: positions[{i}] is", allowed) for i, frame in enumerate(positions)]
    for i, frame in enumerate(frames):
        if frame.shape != shape or not np.isfinite(frame).all():
            raise UserError(f"animate: positions[{i}] has shape {frame.shape}, or is not finite. Allowed: {allowed}.")
    if len(frames) < 2:
        raise UserError(f"animate: there are {len(frames)} positions to show. Allowed: {allowed}. Of a problem that is at its end: reset() it before.")
    return frames


def animate(problem, positions, interval, axes):
    frames = frames_of(problem, positions)
    triangles, _ = surface(problem.cells)
    numbers = [displacements_of_faces(problem, frame, triangles) for frame in frames]
    axes = axes_of_space(axes, "animate")
    scale = scale_of(np.concatenate(numbers))
    drawn = draw(axes, frames[0][triangles], numbers[0], scale, "displacement [m]")
    set_box(axes, np.concatenate(frames))

    def show(i):
        corners = frames[i][triangles]
        drawn.set_verts(corners)
        drawn.set_facecolor(shaded(scale.to_rgba(numbers[i]), corners))
        return (drawn,)

    return player(axes.figure, show, len(frames), interval)


def player(figure, show, n_frames, interval):
    """An animation that notebooks show at once."""
    from matplotlib.animation import FuncAnimation

    animation = FuncAnimation(figure, show, frames=n_frames, interval=interval)
    animation._repr_html_ = animation.to_jshtml  # matplotlib shows one only if rcParams say so
    return animation
