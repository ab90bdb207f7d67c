# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand made of formulas: a palm with four fingers and a thumb, at rest and as a fist, as meshes of tetrahedra.

    python3 tests/scenes/hand_mesh.py FOLDER [N]

writes hand.msh and fist.msh, with N cells across a finger (2), lengths in metres. The fingers point along y, the fist closes towards -z.
"""
import itertools
import math
import sys
from pathlib import Path

WIDTH = .016                        # of a finger [m]
LENGTHS = (.064, .076, .070, .056)  # of the fingers [m]
THUMB, PALM = .05, .08              # lengths [m]
# where a joint begins and ends, as parts of the finger's length, and its angle in the fist [rad]
FINGER = ((.02, .26, 1.35), (.40, .62, 1.45), (.72, .90, .95))
OF_THUMB = ((.02, .3, .9), (.5, .72, .8))
# a cube's tetrahedra, by bits of its corners; odd ones are turned over
KUHN = [(0, a, a | b, 7) if (a, b) in ((1, 2), (2, 4), (4, 1)) else (0, a | b, a, 7) for a, b in itertools.permutations((1, 2, 4), 2)]


def bent(s, length, joints, parts=100):
    """(along, down, angle) of the middle line of a finger at the distance s from its root."""
    def angle(u):
        return sum(phi * min(1., max(0., (u - a) / (b - a))) for a, b, phi in joints)
    turns = [angle((i + .5) / parts * s / length) for i in range(parts)]
    return s * sum(map(math.cos, turns)) / parts, s * sum(map(math.sin, turns)) / parts, angle(s / length)


class Hand:
    def __init__(self, n=2):
        self.n, self.h, gap = n, WIDTH / n, max(1, n // 2)
        self.side = max(1, n // 4)  # cells by which the palm is thicker than a finger, above and below
        self.thick, self.rows = n + 2 * self.side, round(PALM / self.h)
        self.first = [f * (n + gap) for f in range(4)]  # columns of the fingers
        self.n_rows = [round(length / self.h) for length in LENGTHS]
        self.thumb_row, n_thumb = round(.3 * self.rows), round(THUMB / self.h)
        self.cubes = list(itertools.product(range(self.first[3] + n), range(self.rows), range(self.thick)))
        for first, rows in zip(self.first, self.n_rows):
            self.cubes += [(first + i, self.rows + j, self.side + k) for i, j, k in itertools.product(range(n), range(rows), range(n))]
        self.cubes += [(-1 - i, self.thumb_row + j, self.side + k) for i, j, k in itertools.product(range(n_thumb), range(n), range(n))]

    def place(self, corner, is_fist):
        """Of a corner of the grid."""
        i, j, k = corner
        up = (k - self.thick / 2) * self.h
        finger = next((f for f, first in enumerate(self.first) if j > self.rows and first <= i <= first + self.n), None)
        if finger is None and i >= 0:
            return i * self.h, j * self.h, up
        if finger is None:
            s, across, length, joints = -i * self.h, (j - self.thumb_row - self.n / 2) * self.h, THUMB, OF_THUMB
        else:
            s, across, length, joints = (j - self.rows) * self.h, (i - self.first[finger] - self.n / 2) * self.h, LENGTHS[finger], FINGER
        r = WIDTH / 2
        u, v, soft = across / r, up / r, min(1., s / (1.5 * r))  # square at the root, round beyond
        across = r * u * (1 - soft + soft * math.sqrt(1 - v * v / 2))
        up = r * v * (1 - soft + soft * math.sqrt(1 - u * u / 2))
        along, down, angle = bent(s, length, joints) if is_fist else (s, 0., 0.)
        along, up = along + up * math.sin(angle), up * math.cos(angle) - down
        if finger is None:
            return -along, (self.thumb_row + self.n / 2) * self.h + across, up
        return (self.first[finger] + self.n / 2) * self.h + across, self.rows * self.h + along, up

    def fingertip(self, finger, is_fist):
        return self.place((self.first[finger] + self.n // 2, self.rows + self.n_rows[finger], self.side + self.n // 2), is_fist)

    def write(self, folder):
        """hand.msh and fist.msh."""
        number, cells = {}, []
        for cube in self.cubes:
            corners = [number.setdefault(tuple(cube[c] + (bit >> c & 1) for c in range(3)), len(number) + 1) for bit in range(8)]
            cells += [[corners[bit] for bit in bits] for bits in KUHN]
        for name, is_fist in (("hand", False), ("fist", True)):
            lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", len(number)]
            lines += [f"{i} {' '.join(map(repr, self.place(corner, is_fist)))}" for corner, i in number.items()]
            lines += ["$EndNodes", "$Elements", len(cells)]
            lines += [f"{i} 4 2 1 1 {' '.join(map(str, cell))}" for i, cell in enumerate(cells, 1)]
            Path(folder, f"{name}.msh").write_text("\n".join(map(str, [*lines, "$EndElements", ""])))

def half_way(hand):
    """Keys of a scene that takes the middle fingertip half of the way to its place in the fist, on a straight line."""
    begin, end = (hand.fingertip(1, is_fist) for is_fist in (False, True))
    return {"Mesh/File": "hand.msh", "Examples/Poses": "fist.msh", "Material/Young's modulus": "1e5", "Material/Poisson's ratio": "0.45",
            "Scene": "static", "Time/Increments": "10", "Handles/Names": "wrist, tip", "Handles/wrist/Select": "box -1 -0.001 -1  1 0.001 1",
            "Handles/tip/Select": "sphere " + " ".join(map(str, begin)) + " 0.001",
            "Handles/tip/Motion": "; ".join(f"{(b - a) / 2} * t" for a, b in zip(begin, end))}


if __name__ == "__main__":
    Hand(*map(int, sys.argv[2:])).write(sys.argv[1])
