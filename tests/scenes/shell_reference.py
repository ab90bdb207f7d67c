# SPDX-License-Identifier: GPL-3.0-or-later
"""Statics of shells by example in numpy, as a second implementation for tests.

It shares no formula with the program but the energy: strains are differentiated by complex steps, their second
derivatives by differences, and the system of positions, slopes and weights is solved whole. Small meshes only.
"""

import numpy as np


def angle(y, x):
    """arctan2 that carries an imaginary step."""
    return np.arctan2(y.real, x.real) + 1j * (x.real * y.imag - y.real * x.imag) / (x.real**2 + y.real**2)


def unit(a):
    return a / np.sqrt(np.sum(a * a, -1))[..., None]


def dot(a, b):
    return np.sum(a * b, -1)


class Shell:
    """Triangles with a thickness: six strains each, of 21 local numbers: three vertices, what is beyond each edge (a
    vertex, or the tip of the director of a held edge), and three slopes."""

    def __init__(self, vertices, triangles, thickness, held_edges=()):
        """`held_edges` are pairs of vertices in ascending order."""
        self.rest = np.asarray(vertices, float)
        self.triangles = np.asarray(triangles, int)
        self.thickness = np.broadcast_to(np.asarray(thickness, float), len(self.triangles))
        at = {}
        for t, triangle in enumerate(self.triangles):
            for i in range(3):
                at.setdefault(tuple(sorted((triangle[i], triangle[(i + 1) % 3]))), []).append((t, i))
        self.edges = sorted(at)
        self.number = {edge: k for k, edge in enumerate(self.edges)}
        self.held = np.array([edge in set(held_edges) for edge in self.edges])
        n = len(self.rest)
        self.n_dofs = 3 * (n + len(self.edges))
        self.local = np.zeros((len(self.triangles), 21), int)
        self.is_border = np.zeros((len(self.triangles), 3), bool)
        self.is_held = np.zeros((len(self.triangles), 3), bool)
        self.sign = np.zeros((len(self.triangles), 3))
        for t, triangle in enumerate(self.triangles):
            for a in range(3):
                self.local[t, 3 * a:3 * a + 3] = 3 * triangle[a] + np.arange(3)
        for k, edge in enumerate(self.edges):
            slope = 3 * (n + k)
            sides = sorted(at[edge], key=lambda s: self.triangles[s[0]][s[1]] != edge[0])  # first: ascending
            for side, (t, i) in enumerate(sides):
                self.sign[t, i] = 1. if side == 0 else -1.
                self.is_border[t, i] = len(sides) == 1
                self.is_held[t, i] = self.held[k]
                self.local[t, 18 + i] = slope
                beyond = slope
                if len(sides) == 2 and not self.held[k]:
                    other, j = sides[1 - side]
                    beyond = 3 * self.triangles[other][(j + 2) % 3]
                elif not self.held[k]:
                    beyond = 3 * triangle_apex(self.triangles[t], i)  # not used
                self.local[t, 9 + 3 * i:12 + 3 * i] = beyond + np.arange(3)
        self._rest_shape()

    def _rest_shape(self):
        x = self.rest[self.triangles]
        first = unit(x[:, 1] - x[:, 0])
        normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
        self.area = 0.5 * np.sqrt(dot(normal, normal))
        self.normal = unit(normal)
        frame = np.stack([first, np.cross(self.normal, first)], 1)
        plane = np.einsum('tij,tkj->tki', frame, x - x[:, :1])
        self.inverse = np.linalg.inv(np.stack([plane[:, 1], plane[:, 2]], 2))
        step = np.roll(plane, -1, 1) - plane
        self.length = np.sqrt(dot(step, step))
        out = np.stack([step[..., 1], -step[..., 0]], 2) / self.length[..., None]
        factor = self.thickness[:, None] / np.sqrt(12.) * self.length / self.area[:, None]
        self.bending = factor[:, None, :] * np.stack([out[..., 0]**2, out[..., 1]**2, out[..., 0] * out[..., 1]], 1)
        self.volume = self.area * self.thickness
        self.rest_angle = np.zeros((len(self.triangles), 3))
        self.rest_angle = self._angles(self.positions(self.rest)[self.local]).real

    def positions(self, vertices, slopes=None):
        """Positions by degree of freedom, with directors as they are at rest."""
        x = np.zeros(self.n_dofs)
        n = len(self.rest)
        x[:3 * n] = np.asarray(vertices, float).ravel()
        normals = {}
        for t, triangle in enumerate(self.triangles):
            for i in range(3):
                edge = tuple(sorted((triangle[i], triangle[(i + 1) % 3])))
                normals[edge] = normals.get(edge, 0.) + self.normal[t]
        for k, (a, b) in enumerate(self.edges):
            if self.held[k]:
                length = np.linalg.norm(self.rest[b] - self.rest[a])
                x[3 * (n + k):3 * (n + k) + 3] = (self.rest[a] + self.rest[b]) / 2 + length * unit(normals[a, b])
            elif slopes is not None:
                x[3 * (n + k)] = slopes[k]
        return x

    def _angles(self, q):
        """Angles between the planes of each triangle and of what is beyond its edges."""
        v = q[:, :9].reshape(-1, 3, 3)
        result = []
        for i in range(3):
            a, b, apex, beyond = v[:, i], v[:, (i + 1) % 3], v[:, (i + 2) % 3], q[:, 9 + 3 * i:12 + 3 * i]
            edge = unit(b - a)
            n1, n2 = unit(np.cross(b - a, apex - a)), unit(np.cross(beyond - a, b - a))
            result.append(angle(dot(edge, np.cross(n1, n2)), dot(n1, n2)))
        return np.stack(result, 1)

    def strains(self, q):
        """Six numbers of each triangle for its local numbers, which may be complex."""
        v = q[:, :9].reshape(-1, 3, 3)
        F = np.einsum('tia,taj->tij', np.stack([v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]], 2), self.inverse)
        C = np.einsum('tij,tik->tjk', F, F)
        det = np.sqrt(C[:, 0, 0] * C[:, 1, 1] - C[:, 0, 1]**2)
        root = np.sqrt(C[:, 0, 0] + C[:, 1, 1] + 2 * det)
        membrane = [(C[:, 0, 0] + det) / root - 1, (C[:, 1, 1] + det) / root - 1, C[:, 0, 1] / root]
        change = self._angles(q) - self.rest_angle
        slope = self.sign * q[:, 18:21] / self.length
        turn = np.where(self.is_held, change, np.where(self.is_border, slope, change / 2 + slope))
        return np.concatenate([np.stack(membrane, 1), np.einsum('tki,ti->tk', self.bending, turn)], 1)

    def enclosed(self, x):
        """The volume that a closed shell encloses over that at rest, less 1; and its derivative by positions."""
        def volume(vertices):
            a, b, c = (vertices[self.triangles[:, i]] for i in range(3))
            return np.sum(dot(a, np.cross(b, c))) / 6.
        n = len(self.rest)
        vertices, derivative = x[:3 * n].reshape(-1, 3), np.zeros(self.n_dofs)
        for i in range(3):
            b, c = (vertices[self.triangles[:, (i + k) % 3]] for k in (1, 2))
            np.add.at(derivative[:3 * n].reshape(-1, 3), self.triangles[:, i], np.cross(b, c) / 6.)
        return volume(vertices) / volume(self.rest) - 1., derivative / volume(self.rest)

    def slopes_of_strains(self, q):
        """Their derivatives, 6 x 21 of each triangle."""
        columns = []
        for p in range(21):
            moved = q.astype(complex)
            moved[:, p] += 1e-30j
            columns.append(self.strains(moved).imag / 1e-30)
        return np.stack(columns, 2)


def triangle_apex(triangle, i):
    return triangle[(i + 2) % 3]


def stiffness(E, nu):
    """C of six strains, with xy twice in products."""
    half = E / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, 2 * (1 - nu)]])
    return np.block([[half, np.zeros((3, 3))], [np.zeros((3, 3)), half]])


def equilibrium(shell, C, free, start, load, targets=None, weights=None, penalty=None, unknown=False, tolerance=1e-13, unit=0.,
                volumes=None):
    """Positions and weights at a minimum of the energy: `free` degrees of freedom from `start` on, under a `load`.

    `targets` are importance times the strains of the examples (examples, triangles, 6). With `unknown` weights sum to one
    and have the quadratic form `penalty`; all must turn out to be positive. `unit` is the stiffness of the enclosed volume times
    that volume, and `volumes` what the examples ask for."""
    x = start.copy()
    targets = np.zeros((0, len(shell.triangles), 6)) if targets is None else targets
    w = np.zeros(len(targets)) if weights is None else np.array(weights, float)
    penalty = np.zeros((len(w), len(w))) if penalty is None else penalty
    volumes = np.zeros(len(w)) if volumes is None else np.asarray(volumes)
    n, n_w = len(free), len(w) if unknown else 0
    volume = shell.volume[:, None]
    index = np.full(shell.n_dofs, -1)
    index[free] = np.arange(n)

    def energy(x, w):
        r = shell.strains(x[shell.local]).real - np.tensordot(w, targets, 1)
        excess = shell.enclosed(x)[0] - w @ volumes
        return 0.5 * np.sum(volume * r * (r @ C)) + 0.5 * unit * excess**2 + 0.5 * w @ penalty @ w - load @ x

    def local_forces(q, w):
        r = shell.strains(q).real - np.tensordot(w, targets, 1)
        B = shell.slopes_of_strains(q)
        return np.einsum('tk,tkp->tp', volume * (r @ C), B), B, r

    for iteration in range(200):
        q = x[shell.local]
        f, B, r = local_forces(q, w)
        gradient = np.zeros(shell.n_dofs)
        np.add.at(gradient, shell.local.ravel(), f.ravel())
        change, slope = shell.enclosed(x)
        pressure = unit * (change - w @ volumes)
        gradient = (gradient - load + pressure * slope)[free]
        by_weights = -np.einsum('itk,tk->i', targets, volume * (r @ C)) + penalty @ w - pressure * volumes
        gauss = np.einsum('tkp,kl,tlq->tpq', B, C, B) * volume[..., None]
        exact = np.zeros_like(gauss)
        step = 1e-6
        for p in range(21):
            up, down = q.copy(), q.copy()
            up[:, p] += step
            down[:, p] -= step
            exact[:, :, p] = (local_forces(up, w)[0] - local_forces(down, w)[0]) / (2 * step)
        columns = np.zeros((shell.n_dofs, len(w)))
        for i in range(len(w)):
            np.add.at(columns[:, i], shell.local.ravel(),
                      np.einsum('tkp,tk->tp', B, volume * (targets[i] @ C)).ravel())
        columns += unit * np.outer(slope, volumes)
        gram = np.einsum('itk,kl,jtl,t->ij', targets, C, targets, shell.volume) + penalty + unit * np.outer(volumes, volumes)
        curved = np.zeros((shell.n_dofs, shell.n_dofs))
        if unit > 0.:
            for d in range(3 * len(shell.rest)):
                up, down = x.copy(), x.copy()
                up[d] += 1e-3  # a volume is cubic, so that differences are exact
                down[d] -= 1e-3
                curved[d] = pressure * (shell.enclosed(up)[1] - shell.enclosed(down)[1]) / 2e-3
        for matrix in (0.5 * (exact + exact.transpose(0, 2, 1)), gauss):
            K = unit * np.outer(slope, slope) + (curved if matrix is not gauss else 0.)
            for p in range(21):
                for s in range(21):
                    np.add.at(K, (shell.local[:, p], shell.local[:, s]), matrix[:, p, s])
            A = np.zeros((n + n_w, n + n_w))
            A[:n, :n] = K[np.ix_(free, free)]
            rhs = -gradient
            if n_w:
                A[:n, n:] = -columns[free]
                A[n:, :n] = -columns[free].T
                A[n:, n:] = gram
                rhs = np.concatenate([rhs, -by_weights])
                # weights less their sum
                T = np.eye(n + n_w)[:, :-1]
                T[n + n_w - 1, n:] = -1.
                A, rhs = T.T @ A @ T, T.T @ rhs
            try:
                np.linalg.cholesky(A)
                break
            except np.linalg.LinAlgError:
                continue
        direction = np.linalg.solve(A, rhs)
        full = T @ direction if n_w else direction
        part, before = 1., energy(x, w)
        while True:
            new_x, new_w = x.copy(), w.copy()
            new_x[free] += part * full[:n]
            if n_w:
                new_w += part * full[n:]
            if part < 1e-8 or energy(new_x, new_w) <= before + 1e-14 * abs(before):
                break
            part /= 2
        x, w = new_x, new_w
        if part == 1. and np.max(np.abs(full)) < tolerance:
            return x, w
    raise RuntimeError('The reference does not converge.')


def rectangle(nx, ny, length, width):
    """Vertices and triangles of a strip in the plane."""
    vertices = [(length * i / nx, width * j / ny, 0.) for j in range(ny + 1) for i in range(nx + 1)]
    triangles = []
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i
            triangles += [(a, a + 1, a + nx + 2), (a, a + nx + 2, a + nx + 1)]
    return np.array(vertices), np.array(triangles)


def rolled(vertices, angle_of_strip, n):
    """The strip bent along x by an angle in all, n + 1 rows of vertices, without stretch: its chords keep their length."""
    length = vertices[:, 0].max()
    turns = angle_of_strip / n * np.arange(n)
    x = np.concatenate([[0.], np.cumsum(np.cos(turns))]) * length / n
    z = -np.concatenate([[0.], np.cumsum(np.sin(turns))]) * length / n
    row = np.rint(vertices[:, 0] / length * n).astype(int)
    return np.stack([x[row], vertices[:, 1], z[row]], 1)


def least_bending_slopes(shell, vertices, C):
    """The slopes of least energy for given vertices, of a shell that holds none."""
    x = shell.positions(vertices)
    free = 3 * (len(shell.rest) + np.arange(len(shell.edges)))
    B = shell.slopes_of_strains(x[shell.local])[:, :, 18:]
    r = shell.strains(x[shell.local]).real
    K = np.zeros((shell.n_dofs, shell.n_dofs))
    f = np.zeros(shell.n_dofs)
    of = np.einsum('tkp,kl,tlq,t->tpq', B, C, B, shell.volume)
    np.add.at(f, shell.local[:, 18:].ravel(), np.einsum('tkp,tk,t->tp', B, r @ C, shell.volume).ravel())
    for p in range(3):
        for s in range(3):
            np.add.at(K, (shell.local[:, 18 + p], shell.local[:, 18 + s]), of[:, p, s])
    return np.linalg.solve(K[np.ix_(free, free)], -f[free])


def main():
    """Strips between a flat example and a half cylinder: cylinders of their angles, and weights that are found."""
    n, width = 12, 0.25
    vertices, triangles = rectangle(n, 2, 1., width)
    C, eta = stiffness(1e6, 0.3), 0.9
    shell = Shell(vertices, triangles, 0.01)
    slopes = least_bending_slopes(shell, rolled(vertices, np.pi, n), C)
    half = shell.positions(rolled(vertices, np.pi, n), slopes)
    targets = eta * np.stack([0. * shell.strains(half[shell.local]), shell.strains(half[shell.local])]).real
    distances = lambda x: np.linalg.norm(x[:, None] - x[None], axis=2)
    m = len(vertices)
    support = {0, 1, 2, 5, 3 * 2 * (n + 1), 3 * 2 * (n + 1) + 2}
    all_free = [d for d in range(3 * m) if d not in support] + [3 * (m + k) for k in range(len(shell.edges))]
    x = shell.positions(vertices)
    for w in (0.25, 0.5, 0.75):
        x, _ = equilibrium(shell, C, np.array(all_free), x, np.zeros(shell.n_dofs), targets, [1 - w, w / eta])
        error = np.abs(distances(x[:3 * m].reshape(-1, 3)) - distances(rolled(vertices, w * np.pi, n))).max()
        print(f'weight {w}: {error:.1e} of the length from the cylinder')
        assert error < 1e-9
    # the ends held as those of the cylinder of weight .35
    ends = {i for i in range(m) if vertices[i, 0] < 1.5 / n or vertices[i, 0] > 1 - 1.5 / n}
    start = shell.positions(rolled(vertices, 0.35 * np.pi, n))
    free = np.array([d for d in range(3 * m) if d // 3 not in ends] + [3 * (m + k) for k in range(len(shell.edges))])
    x, w = equilibrium(shell, C, free, start, np.zeros(shell.n_dofs), targets, [0.5, 0.5],
                       1e-9 * np.eye(2), True)
    print(f'ends held as at weight .35: {w * eta}')
    assert abs(w[1] * eta - 0.35) < 1e-6


if __name__ == '__main__':
    main()
