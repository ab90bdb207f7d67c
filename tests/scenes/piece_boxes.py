# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files of several boxes that have no node in common, of six tetrahedra a brick; no program is needed."""

from collections import namedtuple
from itertools import permutations, product

from exemplar_runner import Msh, write_msh

# From `low` to `high`, in n bricks along each axis, with nodes moved by `place`.
Box = namedtuple("Box", "low high n place", defaults=((1, 1, 1), lambda x, y, z: (x, y, z)))


def tetrahedra_of(box):
    """Places and cells, with positive volumes."""
    places, cells = {}, []

    def number(i):
        return places.setdefault(i, len(places))

    for brick in product(*map(range, box.n)):
        for order in permutations(range(3)):  # from one corner to the opposite one, axis by axis
            corner, path = list(brick), [number(tuple(brick))]
            for axis in order:
                corner[axis] += 1
                path.append(number(tuple(corner)))
            odd = sum(order[a] > order[b] for a in range(3) for b in range(a + 1, 3)) % 2
            cells.append([path[0], path[2], path[1], path[3]] if odd else path)
    straight = [[low + (high - low) * i / n for low, high, i, n in zip(box.low, box.high, place, box.n)] for place in places]
    return [box.place(*x) for x in straight], cells


def write_boxes(file, *boxes):
    """The mesh file; the places of the nodes, the cells, and the box of each node, as lists."""
    nodes, elements, owners, cells = {}, [], [], []
    for b, box in enumerate(boxes):
        places, of_box = tetrahedra_of(box)
        first = len(nodes)
        for cell in of_box:
            elements.append((len(elements) + 1, 4, 2, 0, 1, *(first + 1 + i for i in cell)))
            cells.append([first + i for i in cell])
        nodes.update({first + 1 + i: tuple(place) for i, place in enumerate(places)})
        owners += [b] * len(places)
    write_msh(file, Msh(nodes, elements, []))
    return list(nodes.values()), cells, owners
