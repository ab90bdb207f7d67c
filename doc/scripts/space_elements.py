# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear elasticity by linear and quadratic tetrahedra in numpy and scipy, written from textbooks and independent of the program.

Linear elements may have their mean dilatation over patches of cells. Sparse factors are CHOLMOD's, called through ctypes: scipy's
own take ten times as long, and CHOLMOD counts its operations. Needs python3-scipy, libcholmod.so.3 and, for clusters, libmetis.so.5.
"""
import ctypes
import itertools
import math
import os
import subprocess
import tempfile
from collections import defaultdict
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402
import scipy.sparse as sp  # noqa: E402
import scipy.sparse.linalg as spl  # noqa: E402

EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
FACES = [(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)]


# Meshes

def read_mesh(file):
    """Node places and cells (by index) of an ASCII mesh in format 2.2; a .geo is meshed by gmsh first."""
    if str(file).endswith(".geo"):
        return gmsh_mesh(file)
    lines = Path(file).read_text().split("\n")
    start = lines.index("$Nodes")
    count = int(lines[start + 1])
    table = [line.split() for line in lines[start + 2:start + 2 + count]]
    index = {row[0]: i for i, row in enumerate(table)}
    start = lines.index("$Elements")
    elements = [line.split() for line in lines[start + 2:start + 2 + int(lines[start + 1])]]
    cells = [[index[number] for number in e[-4:]] for e in elements if e[1] == "4"]
    return oriented(np.array([[float(v) for v in row[1:4]] for row in table]), np.array(cells))


def gmsh_mesh(geo, **numbers):
    """The mesh of a .geo file, with numbers for its DefineConstant parameters."""
    with tempfile.TemporaryDirectory() as folder:
        msh = Path(folder) / "mesh.msh"
        sets = [word for name, value in numbers.items() for word in ("-setnumber", name, str(value))]
        subprocess.run(["gmsh", "-3", "-format", "msh22", str(geo), "-o", str(msh), *sets], check=True, stdout=subprocess.DEVNULL)
        return read_mesh(msh)


def oriented(places, cells):
    """The same cells, all of positive volume, and without the nodes that no cell has."""
    used, inverse = np.unique(cells, return_inverse=True)
    places, cells = places[used], inverse.reshape(cells.shape)
    edges = places[cells[:, 1:]] - places[cells[:, :1]]
    mirrored = np.linalg.det(edges) < 0
    cells[mirrored] = cells[mirrored][:, [0, 2, 1, 3]]
    return places, cells


def box_mesh(size, counts):
    """A box from the origin, its cuboids cut into six tetrahedra around one diagonal (Kuhn)."""
    n = np.array(counts)
    grid = [np.linspace(0, size[c], n[c] + 1) for c in range(3)]
    places = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 3)
    strides = np.array([(n[1] + 1) * (n[2] + 1), n[2] + 1, 1])
    corners = np.array(list(itertools.product(*(range(k) for k in n)))) @ strides
    cells = []
    for order in itertools.permutations(range(3)):
        steps = np.concatenate([[0], np.cumsum(strides[list(order)])])
        cells.append(corners[:, None] + steps)
    return oriented(places, np.stack(cells, axis=1).reshape(-1, 4))


def refined(places, cells):
    """Each cell cut into eight at the middles of its edges, the inner octahedron along its shortest diagonal. Children of cell c are
    8 c to 8 c + 7. The new places follow the old ones in the order of edges_of()."""
    ends, of_cell = edges_of(cells)
    middles = len(places) + of_cell
    places = np.concatenate([places, places[ends].mean(axis=1)])
    m = {pair: middles[:, e] for e, pair in enumerate(EDGES)}
    m.update({(b, a): v for (a, b), v in m.items()})
    corners = [np.stack([cells[:, a]] + [m[a, b] for b in range(4) if b != a], axis=1) for a in range(4)]
    diagonals = [((0, 1), (2, 3)), ((0, 2), (1, 3)), ((0, 3), (1, 2))]
    lengths = np.stack([np.linalg.norm(places[m[p]] - places[m[q]], axis=1) for p, q in diagonals], axis=1)
    inner = np.empty((len(cells), 4, 4), int)
    for d, (p, q) in enumerate(diagonals):
        chosen = lengths.argmin(axis=1) == d
        (a, b), (c, e) = p, q
        ring = [m[a, c], m[c, b], m[b, e], m[e, a]]
        for i in range(4):
            inner[chosen, i] = np.stack([m[p], m[q], ring[i], ring[(i + 1) % 4]], axis=1)[chosen]
    children = np.concatenate([np.stack(corners, axis=1), inner], axis=1).reshape(-1, 4)
    edges = places[children[:, 1:]] - places[children[:, :1]]
    mirrored = np.linalg.det(edges) < 0
    children[mirrored] = children[mirrored][:, [0, 2, 1, 3]]
    return places, children


def edges_of(cells):
    """Edges of the mesh in ascending order of (lesser, greater) vertex, and the six of each cell."""
    pairs = np.sort(np.stack([cells[:, list(pair)] for pair in EDGES], axis=1), axis=2).reshape(-1, 2)
    ends, inverse = np.unique(pairs, axis=0, return_inverse=True)
    return ends, inverse.reshape(-1, 6)


def boundary_faces(cells):
    """Vertices of the faces that one cell alone has."""
    faces = np.concatenate([cells[:, list(face)] for face in FACES])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def inner_faces(cells):
    """Pairs of neighbouring cells, and the vertices of the face between them."""
    faces = np.sort(np.concatenate([cells[:, list(face)] for face in FACES]), axis=1)
    owner = np.tile(np.arange(len(cells)), 4)
    order = np.lexsort(faces.T[::-1])
    same = (faces[order[1:]] == faces[order[:-1]]).all(axis=1)
    return np.stack([owner[order[:-1][same]], owner[order[1:][same]]], axis=1), faces[order[:-1][same]]


def face_areas(places, faces):
    a, b, c = (places[faces[:, i]] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


# Elements

class Elements:
    """The matrices of a mesh of linear ("P1") or quadratic ("P2") tetrahedra. Degree of freedom 3 i + c is component c of node i;
    for P2 a node in the middle of each edge follows the vertices."""

    def __init__(self, places, cells, element="P1"):
        self.element, self.cells = element, cells
        edges = np.swapaxes(places[cells[:, 1:]] - places[cells[:, :1]], 1, 2)
        self.volume = np.linalg.det(edges) / 6
        last = np.linalg.inv(edges)
        g = np.concatenate([-last.sum(axis=1, keepdims=True), last], axis=1)
        if element == "P1":
            self.places, self.nodes = places, cells
            self.points = [(g, self.volume)]
        else:
            self.ends, of_cell = edges_of(cells)
            self.places = np.concatenate([places, places[self.ends].mean(axis=1)])
            self.nodes = np.concatenate([cells, len(places) + of_cell], axis=1)
            near, far = (5 + 3 * math.sqrt(5)) / 20, (5 - math.sqrt(5)) / 20
            self.points = []
            for p in range(4):
                L = np.full(4, far)
                L[p] = near
                corner = (4 * L - 1)[None, :, None] * g
                middle = np.stack([4 * (L[a] * g[:, b] + L[b] * g[:, a]) for a, b in EDGES], axis=1)
                self.points.append((np.concatenate([corner, middle], axis=1), self.volume / 4))
        self.n_dofs = 3 * len(self.places)

    def divergence(self):
        """Rows: the integral of div u over each point, points of a cell consecutive; and the points' cells."""
        n_cells, n_points = len(self.cells), len(self.points)
        data = np.stack([w[:, None, None] * g for g, w in self.points], axis=1)
        dofs = 3 * self.nodes[:, None, :, None] + np.arange(3)
        columns = np.broadcast_to(dofs, data.shape).ravel()
        rows = np.repeat(np.arange(n_cells * n_points), data[0, 0].size)
        matrix = sp.csr_matrix((data.ravel(), (rows, columns)), shape=(n_cells * n_points, self.n_dofs))
        return matrix, np.repeat(np.arange(n_cells), n_points)

    def shear(self):
        """Of the energy: the integral of |eps|^2, half of it, for mu = 1/2; so K = 2 mu times it + lambda times that of the volume."""
        k = self.nodes.shape[1]
        blocks = np.zeros((len(self.cells), k, 3, k, 3))
        for g, w in self.points:
            gg = np.einsum("cai,cbi->cab", g, g) * w[:, None, None]
            blocks += 0.5 * np.einsum("cai,cbj,c->cajbi", g, g, w)
            for i in range(3):
                blocks[:, :, i, :, i] += 0.5 * gg
        return self._assembled(blocks.reshape(len(self.cells), 3 * k, 3 * k))

    def mass(self):
        """The consistent mass for the density 1."""
        local = reference_mass(self.element)
        blocks = np.einsum("c,ab,ij->caibj", self.volume, local, np.eye(3))
        return self._assembled(blocks.reshape(len(self.cells), 3 * len(local), -1))

    def _assembled(self, blocks):
        dofs = (3 * self.nodes[:, :, None] + np.arange(3)).reshape(len(self.cells), -1)
        shape = blocks.shape
        rows = np.broadcast_to(dofs[:, :, None], shape).ravel()
        columns = np.broadcast_to(dofs[:, None, :], shape).ravel()
        return sp.csc_matrix((blocks.ravel(), (rows, columns)), shape=(self.n_dofs, self.n_dofs))

    def gravity(self, direction):
        """Nodal forces of a body force."""
        weights = reference_mass(self.element).sum(axis=1)
        forces = np.zeros((len(self.places), 3))
        np.add.at(forces, self.nodes, self.volume[:, None, None] * weights[:, None] * np.asarray(direction, float))
        return forces.ravel()

    def traction(self, faces, vector):
        """Nodal forces of tractions on boundary faces: vector (3) or an array with a row a face."""
        areas = face_areas(self.places, faces)
        share = areas[:, None] / 3 * np.broadcast_to(vector, (len(faces), 3))
        forces = np.zeros((len(self.places), 3))
        for k in range(3):
            nodes = faces[:, k] if self.element == "P1" else self.middles(faces[:, k], faces[:, (k + 1) % 3])
            np.add.at(forces, nodes, share)
        return forces.ravel()

    def middles(self, a, b):
        """P2's nodes in the middles of the edges from vertices a to b."""
        n = self.ends.max() + 1
        low, high = np.minimum(a, b), np.maximum(a, b)
        return n + np.searchsorted(self.ends[:, 0] * n + self.ends[:, 1], low * n + high)

    def held(self, chosen):
        """Nodes of a selection of vertices: a middle node belongs to it if both ends do."""
        return chosen if self.element == "P1" else np.concatenate([chosen, chosen[self.ends].all(axis=1)])


def reference_mass(element):
    """Mass matrix of a cell of volume 1: exact integrals of the products of shape functions."""
    pairs = [(i, i) for i in range(4)] + EDGES if element == "P2" else None
    if element == "P1":
        return (np.ones((4, 4)) + np.eye(4)) / 20
    def integral(powers):  # of L1^a L2^b L3^c L4^d over a cell of volume 1
        return 6 * math.prod(math.factorial(p) for p in powers) / math.factorial(sum(powers) + 3)
    def powers(*ij):
        return [sum(i == k for i in ij) for k in range(4)]
    monomials = np.array([[integral(powers(*p, *q)) for q in pairs] for p in pairs])
    shape = np.zeros((10, 10))  # N_i = L_i^2 - sum over j of L_i L_j; N_ij = 4 L_i L_j
    for i in range(4):
        shape[i, i] = 1
    for e, pair in enumerate(EDGES):
        shape[4 + e, 4 + e] = 4
        shape[list(pair), 4 + e] = -1
    return shape @ monomials @ shape.T


def lame(young, nu):
    return young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))


class Solid:
    """Elements with the dilatation of each point, or its mean over patches: `patches` holds a patch number a cell."""

    def __init__(self, elements, fixed_dofs, patches=None):
        self.elements = elements
        self.free = np.setdiff1d(np.arange(elements.n_dofs), fixed_dofs)
        divergence, cell_of = elements.divergence()
        weights = np.concatenate([w[:, None] for _, w in elements.points], axis=1).ravel()
        if patches is not None:
            patch_of = np.asarray(patches)[cell_of]
            gather = sp.csr_matrix((np.ones(len(patch_of)), (patch_of, np.arange(len(patch_of)))))
            divergence, weights = gather @ divergence, gather @ weights
        self.B, self.patch_volume = divergence, weights
        self.B_free = divergence.tocsc()[:, self.free].tocsr()
        self.D_free = elements.shear()[self.free][:, self.free]

    def stiffness(self, young, nu):
        lam, mu = lame(young, nu)
        scaled = sp.diags(lam / self.patch_volume) @ self.B_free
        return (2 * mu * self.D_free + self.B_free.T @ scaled).tocsc()

    def solve(self, young, nu, forces):
        """Displacements under nodal forces, all nodes, a row a node; and the factor."""
        factor = Factor(self.stiffness(young, nu))
        u = np.zeros(self.elements.n_dofs)
        u[self.free] = factor.solve(forces[self.free])
        u[self.free] += factor.solve(forces[self.free] - factor.matrix @ u[self.free])
        return u, factor

    def pressure(self, young, nu, u):
        """lambda times the mean dilatation of each patch."""
        return lame(young, nu)[0] * (self.B @ u) / self.patch_volume

    def frequencies(self, factor, count):
        """The least eigenvalues of free vibration (squares of angular frequencies) for the density 1, with the factor of solve()."""
        K = factor.matrix
        M = self.elements.mass()[self.free][:, self.free]
        inverse = spl.LinearOperator(K.shape, matvec=factor.solve)
        start = np.random.default_rng(1).standard_normal(K.shape[0])
        return np.sort(spl.eigsh(K, count, M, sigma=0, OPinv=inverse, v0=start, return_eigenvectors=False, tol=1e-8))

    def inf_sup(self):
        """The least beta with sup (q, div u) / |eps(u)| >= beta |q| for all q that are constant on patches, and the next ones. Patches
        whose nodes are all held have no part in it."""
        scaled = (sp.diags(self.patch_volume ** -.5) @ self.B_free).tocsr()
        scaled = scaled[np.abs(scaled).sum(axis=1).A1 > 1e-9 * np.abs(scaled).sum() / len(self.patch_volume)]
        n = scaled.shape[0]
        if n > self.B_free.shape[1]:
            return np.zeros(3)
        factor = Factor(self.D_free)
        schur = np.empty((n, n))
        for first in range(0, n, 256):
            schur[:, first:first + 256] = scaled @ factor.solve(scaled[first:first + 256].toarray().T)
        return np.sqrt(np.maximum(np.linalg.eigvalsh((schur + schur.T) / 2), 0))


# CHOLMOD

class Sparse(ctypes.Structure):
    _fields_ = [(n, ctypes.c_size_t) for n in ("nrow", "ncol", "nzmax")] + \
        [(n, ctypes.c_void_p) for n in ("p", "i", "nz", "x", "z")] + \
        [(n, ctypes.c_int) for n in ("stype", "itype", "xtype", "dtype", "sorted", "packed")]


class Dense(ctypes.Structure):
    _fields_ = [(n, ctypes.c_size_t) for n in ("nrow", "ncol", "nzmax", "d")] + \
        [("x", ctypes.c_void_p), ("z", ctypes.c_void_p), ("xtype", ctypes.c_int), ("dtype", ctypes.c_int)]


class Factor:
    """The Cholesky factor of a symmetric positive definite matrix; `operations` and `entries` count it."""

    library = None

    def __init__(self, A, numeric=True):
        c = Factor._library()
        self.n, self.matrix = A.shape[0], A
        upper = sp.triu(A, format="csc")
        upper.sort_indices()
        arrays = upper.indptr.astype(np.int32), upper.indices.astype(np.int32), upper.data.astype(float)
        at = [array.ctypes.data for array in arrays]
        matrix = Sparse(self.n, self.n, upper.nnz, at[0], at[1], None, at[2], None, 1, 0, 1, 0, 1, 1)
        self.common = Factor.common
        self.factor = c.cholmod_analyze(ctypes.byref(matrix), self.common)
        column_counts = ctypes.cast(self.factor + 24, ctypes.POINTER(ctypes.c_void_p))[0]
        counts = np.ctypeslib.as_array(ctypes.cast(column_counts, ctypes.POINTER(ctypes.c_int)), (self.n,)).astype(float)
        self.operations, self.entries = (counts ** 2).sum(), counts.sum()
        if numeric and not c.cholmod_factorize(ctypes.byref(matrix), self.factor, self.common):
            raise ArithmeticError("CHOLMOD failed")
        minor = ctypes.cast(self.factor + 8, ctypes.POINTER(ctypes.c_size_t))[0]
        if numeric and minor != self.n:
            raise ArithmeticError("the matrix is not positive definite")

    def solve(self, right):
        c = Factor.library
        columns = np.asfortranarray(right.reshape(self.n, -1), dtype=float)
        dense = Dense(self.n, columns.shape[1], columns.size, self.n, columns.ctypes.data, None, 1, 0)
        result = c.cholmod_solve(0, self.factor, ctypes.byref(dense), self.common)
        x = ctypes.cast(result, ctypes.POINTER(Dense)).contents.x
        values = np.ctypeslib.as_array(ctypes.cast(x, ctypes.POINTER(ctypes.c_double)), (columns.size,)).copy()
        c.cholmod_free_dense(ctypes.byref(ctypes.c_void_p(result)), self.common)
        return values.reshape(columns.shape, order="F").reshape(right.shape)

    def __del__(self):
        if getattr(self, "factor", None):
            Factor.library.cholmod_free_factor(ctypes.byref(ctypes.c_void_p(self.factor)), self.common)

    @staticmethod
    def _library():
        if Factor.library is None:
            c = ctypes.CDLL("libcholmod.so.3")
            for name in ("cholmod_analyze", "cholmod_solve"):
                getattr(c, name).restype = ctypes.c_void_p
            c.cholmod_solve.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
            c.cholmod_factorize.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
            Factor.common = ctypes.create_string_buffer(1 << 16)
            c.cholmod_start(Factor.common)
            Factor.library = c
        return Factor.library


# Patches of cells

def stars(cells, n_nodes, least=1):
    """Node stars: nodes in order of how many unassigned cells they have, most first, take all of them; cells of nodes that would
    take fewer than `least` join the neighbouring patch with which they share most faces, the smaller one of equals."""
    import heapq
    around = [[] for _ in range(n_nodes)]
    for c, cell in enumerate(cells):
        for a in cell:
            around[a].append(c)
    patch = np.full(len(cells), -1)
    left = np.array([len(cs) for cs in around])
    queue = [(-left[a], a) for a in range(n_nodes)]
    heapq.heapify(queue)
    n_patches = 0
    while queue:
        count, a = heapq.heappop(queue)
        if -count != left[a]:
            if left[a]:
                heapq.heappush(queue, (-left[a], a))
            continue
        if left[a] < least:
            break
        for c in around[a]:
            if patch[c] < 0:
                patch[c] = n_patches
                left[cells[c]] -= 1
        n_patches += 1
    return joined(cells, patch)


def joined(cells, patch):
    """Cells without a patch (-1) join the neighbouring patch with which they share most faces, the smaller of equals; those that share
    most go first."""
    import heapq
    pairs, _ = inner_faces(cells)
    neighbours = defaultdict(list)
    for c, d in pairs:
        neighbours[c].append(d)
        neighbours[d].append(c)
    sizes = np.bincount(patch[patch >= 0])

    def best(c):
        votes = defaultdict(int)
        for d in neighbours[c]:
            if patch[d] >= 0:
                votes[patch[d]] += 1
        return min(((-count, sizes[p], c, p) for p, count in votes.items()), default=None)
    queue = [choice for choice in map(best, np.nonzero(patch < 0)[0]) if choice]
    heapq.heapify(queue)
    while queue:
        choice = heapq.heappop(queue)
        c = choice[2]
        if patch[c] >= 0:
            continue
        if best(c) != choice:
            heapq.heappush(queue, best(c))
            continue
        patch[c] = choice[3]
        sizes[choice[3]] += 1
        for d in neighbours[c]:
            if patch[d] < 0:
                heapq.heappush(queue, best(d))
    if (patch < 0).any():
        raise ValueError("cells that no patch reaches")
    return patch


def program_stars(cells, n_nodes, thresholds=(18, 9)):
    """The patches of Model/Dilatation = patches, from the description in include/exemplar/body/patches.h, for one material: stars of
    18 cells or more, cells that lie within a patch join it, stars of 9 or more, again, and what is left joins neighbours."""
    import heapq
    around = [[] for _ in range(n_nodes)]
    for c, cell in enumerate(cells):
        for a in cell:
            around[a].append(c)
    pairs, _ = inner_faces(cells)
    neighbours = defaultdict(list)
    for c, d in pairs:
        neighbours[c].append(d)
        neighbours[d].append(c)
    patch, nodes, sizes = np.full(len(cells), -1), [], []

    def assign(c, p):
        patch[c] = p
        sizes[p] += 1
        nodes[p].update(cells[c])

    def take(least):
        def free(a):
            return [c for c in around[a] if patch[c] < 0]
        queue = [(-len(free(a)), a) for a in range(n_nodes)]
        heapq.heapify(queue)
        while queue:
            count, a = heapq.heappop(queue)
            star = free(a)
            if len(star) < least:
                continue
            if len(star) != -count:
                heapq.heappush(queue, (-len(star), a))
                continue
            nodes.append(set())
            sizes.append(0)
            for c in star:
                assign(c, len(sizes) - 1)

    def best(c):
        faces = defaultdict(int)
        for d in neighbours[c]:
            if patch[d] >= 0:
                faces[patch[d]] += 1
        return min(((4 - len(nodes[p].intersection(cells[c])), -n, sizes[p], c, p) for p, n in faces.items()), default=(4,))

    def join(most):
        queue = []

        def push(c):
            if patch[c] < 0:
                choice = best(c)
                if choice[0] <= most:
                    heapq.heappush(queue, choice)
        for c in range(len(cells)):
            push(c)
        while queue:
            choice = heapq.heappop(queue)
            c = choice[3]
            if patch[c] >= 0 or choice != best(c):
                push(c)
                continue
            assign(c, choice[4])
            for d in {d for a in cells[c] for d in around[a]}:
                push(d)
    for least in thresholds:
        take(least)
        join(0)
    join(1)
    take(1)
    return patch


def clusters(cells, size=8):
    """Clusters of about `size` cells: METIS on the graph of faces."""
    pairs, _ = inner_faces(cells)
    n = len(cells)
    graph = sp.csr_matrix((np.ones(2 * len(pairs)), (np.r_[pairs[:, 0], pairs[:, 1]], np.r_[pairs[:, 1], pairs[:, 0]])), shape=(n, n))
    metis = ctypes.CDLL("libmetis.so.5")
    number = ctypes.c_int
    xadj, adjacent, part = graph.indptr.astype(np.int32), graph.indices.astype(np.int32), np.zeros(n, np.int32)
    at = lambda array: array.ctypes.data_as(ctypes.c_void_p)  # noqa: E731
    status = metis.METIS_PartGraphKway(*(ctypes.byref(number(v)) for v in (n, 1)), at(xadj), at(adjacent), None, None, None,
                                       ctypes.byref(number(max(n // size, 1))), None, None, None, ctypes.byref(number()), at(part))
    if status != 1:
        raise RuntimeError("METIS failed")
    return np.unique(part, return_inverse=True)[1]


def face_pairs(cells):
    """Pairs of cells with a common face, made greedily: cells with the fewest free neighbours first."""
    pairs, _ = inner_faces(cells)
    neighbours = defaultdict(set)
    for c, d in pairs:
        neighbours[c].add(d)
        neighbours[d].add(c)
    patch = np.full(len(cells), -1)
    n = 0
    open_cells = {c: len(neighbours[c]) for c in range(len(cells))}
    import heapq
    queue = [(k, c) for c, k in open_cells.items()]
    heapq.heapify(queue)
    while queue:
        _, c = heapq.heappop(queue)
        if patch[c] >= 0:
            continue
        free = [d for d in neighbours[c] if patch[d] < 0]
        members = [c] + ([min(free, key=lambda d: (sum(patch[e] < 0 for e in neighbours[d]), d))] if free else [])
        for m in members:
            patch[m] = n
        for m in members:
            for d in neighbours[m]:
                if patch[d] < 0:
                    heapq.heappush(queue, (sum(patch[e] < 0 for e in neighbours[d]), d))
        n += 1
    return patch
