# SPDX-License-Identifier: GPL-3.0-or-later
"""A second implementation of bodies that meet obstacles, in numpy, from the formulas of doc/contact.md alone.

Linear tetrahedra with corotational strain by a polar decomposition, consistent masses, implicit Euler, and the barrier of a
half space or a sphere (nodes, triangles), with stiffness 0.1 E A. A step is solved by Newton's method with dense matrices and
a tangent by differences of the elastic force, so that nothing is shared with the program but the formulas. For meshes of some
dozen nodes."""

import numpy as np


def volumes_and_gradients(x, cells):
    """Of each cell: its volume, and the gradients of its four shape functions."""
    corners = x[cells]
    edges = corners[:, 1:] - corners[:, :1]
    volumes = np.linalg.det(edges) / 6
    inner = np.linalg.inv(edges).transpose(0, 2, 1)
    return volumes, np.concatenate([-inner.sum(1, keepdims=True), inner], axis=1)


def boundary(cells):
    """The triangles of one cell only."""
    seen = {}
    for cell in cells:
        for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)):
            corners = tuple(cell[i] for i in face)
            seen.setdefault(tuple(sorted(corners)), []).append(corners)
    return np.array([faces[0] for faces in seen.values() if len(faces) == 1])


class Reference:
    def __init__(self, nodes, cells, young, poisson, density, gravity, width):
        self.rest, self.cells, self.young = nodes, cells, young
        self.volumes, self.gradients = volumes_and_gradients(nodes, cells)
        assert (self.volumes > 0).all()
        self.mu = young / (2 * (1 + poisson))
        self.lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        n = len(nodes)
        self.mass = np.zeros((n, n))
        for cell, volume in zip(cells, self.volumes):
            self.mass[np.ix_(cell, cell)] += density * volume / 20 * (1 + np.eye(4))
        self.weight = self.mass.sum(1)[:, None] * np.asarray(gravity)
        self.triangles = boundary(cells)
        a, b, c = (nodes[self.triangles[:, k]] for k in range(3))
        self.areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        self.node_areas = np.zeros(n)
        np.add.at(self.node_areas, self.triangles, self.areas[:, None] / 3)
        self.width = width

    def elastic_force(self, x):
        """Derivative of sum V (mu |e|^2 + lambda/2 (tr e)^2) with e = sym(R^T F) - 1 at the rotation R of F."""
        F = np.einsum("cai,caj->cij", x[self.cells], self.gradients)
        u, s, v = np.linalg.svd(F)
        sign = np.sign(np.linalg.det(u @ v))
        u[:, :, 2] *= sign[:, None]
        s[:, 2] *= sign
        e = s - 1
        P = np.einsum("cik,ck,ckj->cij", u, 2 * self.mu * e + self.lame * e.sum(1, keepdims=True), v)
        energy = (self.volumes * (self.mu * (e ** 2).sum(1) + self.lame / 2 * e.sum(1) ** 2)).sum()
        force = np.zeros_like(x)
        np.add.at(force, self.cells, np.einsum("c,cij,caj->cai", self.volumes, P, self.gradients))
        return energy, force

    def barrier(self, d, k):
        """Energy, first and second derivative."""
        s = np.minimum(d / self.width, 1)
        if (s <= 0).any():
            return np.inf, np.zeros_like(s), np.zeros_like(s)
        log, r = np.log(s), (s - 1) / s
        return ((-k * self.width * (s - 1) ** 2 * log).sum(), -k * (2 * (s - 1) * log + (s - 1) ** 2 / s),
                -k / self.width * (2 * log + 4 * r - r ** 2))

    def plane(self, point, normal):
        normal = np.asarray(normal, float) / np.linalg.norm(normal)
        k = 0.1 * self.young * self.node_areas

        def contact(x):
            energy, slope, curvature = self.barrier((x - point) @ normal, k)
            matrix = np.zeros((x.size, x.size))
            for i, c in enumerate(curvature):
                matrix[3 * i:3 * i + 3, 3 * i:3 * i + 3] = c * np.outer(normal, normal)
            return energy, slope[:, None] * normal, matrix
        return contact

    def sphere(self, centre, radius):
        k = 0.1 * self.young * self.areas

        def contact(x):
            energy, force, matrix = 0.0, np.zeros_like(x), np.zeros((x.size, x.size))
            middles = x[self.triangles].mean(1)
            sizes = np.linalg.norm(x[self.triangles] - middles[:, None], axis=2).max(1)
            near = np.linalg.norm(middles - centre, axis=1) - sizes < radius + self.width
            for corners, stiffness in zip(self.triangles[near], k[near]):
                share = nearest_in_triangle(x[corners], centre)
                way = share @ x[corners] - centre
                length = np.linalg.norm(way)
                if length - radius >= self.width:
                    continue
                value, slope, curvature = self.barrier(np.array([length - radius]), stiffness)
                energy += value
                direction = np.outer(share, way / length)
                force[corners] += slope[0] * direction
                dofs = (3 * corners[:, None] + np.arange(3)).ravel()
                matrix[np.ix_(dofs, dofs)] += curvature[0] * np.outer(direction, direction)
            return energy, force, matrix
        return contact

    def step(self, x, v, h, contact):
        """To the minimum of |y - x - h v|_M^2 / 2 h^2 + elastic + contact - weight, to rounding."""
        mass = np.kron(self.mass, np.eye(3)) / h ** 2
        predicted = x + h * v

        def all_of(y):
            elastic, force = self.elastic_force(y)
            energy, of_contact, curvature = contact(y)
            away = (y - predicted).ravel()
            return (0.5 * away @ mass @ away + elastic + energy - (self.weight * y).sum(),
                    mass @ away + (force + of_contact - self.weight).ravel(), curvature)

        y = x.copy()
        for _ in range(200):
            energy, gradient, curvature = all_of(y)
            stiffness = np.empty_like(mass)
            for i in range(y.size):
                step = np.zeros(y.size)
                step[i] = 1e-6 * self.width
                step = step.reshape(y.shape)
                stiffness[:, i] = ((self.elastic_force(y + step)[1] - self.elastic_force(y - step)[1]) / (2e-6 * self.width)).ravel()
            values, vectors = np.linalg.eigh(mass + (stiffness + stiffness.T) / 2 + curvature)
            direction = -(vectors @ ((vectors.T @ gradient) / np.abs(values))).reshape(y.shape)  # descends where it is indefinite, too
            if np.abs(direction).max() < 1e-14:
                break
            part = 1.0
            slope = gradient @ direction.ravel()
            while part > 1e-12:
                after = all_of(y + part * direction)
                at_rounding = abs(part * slope) < 1e-10 * abs(energy)
                if after[0] <= energy + 1e-4 * part * slope or \
                        at_rounding and np.isfinite(after[0]) and np.linalg.norm(after[1]) < np.linalg.norm(gradient):
                    break
                part /= 2
            y = y + part * direction
        return y, (y - x) / h


def nearest_in_triangle(x, point):
    """Barycentric coordinates of the nearest point, by a least square with bounds: the best of face, edges, corners."""
    best, least = None, np.inf
    for corners in ((0, 1, 2), (0, 1), (1, 2), (2, 0), (0,), (1,), (2,)):
        base = x[corners[0]]
        edges = np.array([x[c] - base for c in corners[1:]]).reshape(-1, 3)
        shares = np.linalg.lstsq(edges.T, point - base, rcond=None)[0] if len(edges) else np.zeros(0)
        if (shares < 0).any() or shares.sum() > 1:
            continue
        all_shares = np.zeros(3)
        all_shares[corners[0]] = 1 - shares.sum()
        for c, share in zip(corners[1:], shares):
            all_shares[c] = share
        distance = np.linalg.norm(all_shares @ x - point)
        if distance < least:
            best, least = all_shares, distance
    return best


def nearest_on_edges(x):
    """Shares (s, t) of the nearest points of the edges x[0] x[1] and x[2] x[3]: the best of the inner point, sides and corners."""
    e, f, r = x[1] - x[0], x[3] - x[2], x[0] - x[2]
    candidates = [(s, t) for s in (0.0, 1.0) for t in (0.0, 1.0)]
    candidates += [(s, (r + s * e) @ f / (f @ f)) for s in (0.0, 1.0)] + [((t * f - r) @ e / (e @ e), t) for t in (0.0, 1.0)]
    candidates.append(tuple(np.linalg.lstsq(np.array([e, -f]).T, -r, rcond=None)[0]))
    inside = [c for c in candidates if 0 <= c[0] <= 1 and 0 <= c[1] <= 1]
    return min(inside, key=lambda c: np.linalg.norm(r + c[0] * e - c[1] * f))


def part_of_edges(x, rest):
    """What edges that are almost parallel have of their energy."""
    square = (np.cross(x[1] - x[0], x[3] - x[2]) ** 2).sum()
    p = square / (1e-3 * ((rest[1] - rest[0]) ** 2).sum() * ((rest[3] - rest[2]) ** 2).sum())
    return p * (2 - p) if p < 1 else 1.0


def pairs(body, owners):
    """The contact of pieces with each other, for Reference.step(); `owners` are the pieces of the nodes."""
    edges = sorted({tuple(sorted((t[k], t[(k + 1) % 3]))) for t in body.triangles for k in range(3)})
    edge_areas = {edge: sum(a / 3 for t, a in zip(body.triangles, body.areas) if set(edge) <= set(t)) for edge in edges}
    of_nodes = sorted(set(body.triangles.ravel()))
    candidates = [((*t, n), min(body.node_areas[n], a)) for n in of_nodes for t, a in zip(body.triangles, body.areas)
                  if owners[n] != owners[t[0]]]
    n_triangles = len(candidates)
    candidates += [((*e, *f), min(edge_areas[e], edge_areas[f])) for e in edges for f in edges if e < f and owners[e[0]] != owners[f[0]]]

    def contact(x):
        energy, force, matrix = 0.0, np.zeros_like(x), np.zeros((x.size, x.size))
        for number, (nodes, area) in enumerate(candidates):
            nodes = np.array(nodes)
            places = x[nodes]
            is_edges = number >= n_triangles
            first = places[:2] if is_edges else places[:3]
            second = places[len(first):]
            if (first.min(0) > second.max(0) + body.width).any() or (second.min(0) > first.max(0) + body.width).any():
                continue
            if is_edges:
                s, t = nearest_on_edges(places)
                shares = np.array([1 - s, s, t - 1, -t])
            else:
                shares = np.append(nearest_in_triangle(places[:3], places[3]), -1.0)
            way = shares @ places
            length = np.linalg.norm(way)
            if length >= body.width:
                continue
            value, slope, curvature = body.barrier(np.array([length]), 0.1 * body.young * area)
            part = part_of_edges(places, body.rest[nodes]) if is_edges else 1.0
            direction = np.outer(shares, way / length)
            energy += part * value
            force[nodes] += part * slope[0] * direction
            if part < 1:
                for i in range(4):
                    for c in range(3):
                        step = np.zeros_like(places)
                        step[i, c] = 1e-4 * np.sqrt(area)
                        more, less = (part_of_edges(places + sign * step, body.rest[nodes]) for sign in (1, -1))
                        force[nodes[i], c] += value * (more - less) / (2 * step[i, c])
            dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
            matrix[np.ix_(dofs, dofs)] += part * curvature[0] * np.outer(direction, direction)
        return energy, force, matrix
    return contact
