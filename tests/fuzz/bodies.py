# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are wrong in their bytes, in what they hold, or in where their nodes lie."""

import bases
import mutations


def spoilt_mesh(r, mesh):
    """A .msh file of any version and form: other tokens or other bytes."""
    binary = r.random() < 0.5
    tokens = r.choice([bases.version_2, bases.version_4])(mesh, binary)
    action = r.random()
    if action < 0.65:
        tokens = mutations.spoilt_tokens(r, tokens)
    data = bases.msh_bytes(tokens, binary)
    return mutations.damaged(r, data) if action > 0.6 else data


def spoilt_body(r, mesh):
    """A mesh whose file is right, but whose body is odd: elements missing, doubled, turned, joined or of other kinds."""
    for _ in range(r.choice([1, 1, 2, 4])):
        at = r.randrange(len(mesh.elements))
        number, kind, physical, elementary, corners = mesh.elements[at]
        odd = r.choice(mutations.INTEGERS)
        action = r.randrange(8)
        if action == 0:
            del mesh.elements[at]
        elif action == 1:
            mesh.elements.append((r.choice([number, 99]), kind, physical, elementary, corners))
        elif action == 2:
            mesh.elements[at] = number, kind, physical, elementary, r.sample(corners, len(corners))
        elif action == 3:
            mesh.elements[at] = number, kind, physical, elementary, [r.choice(mesh.nodes)[0] for _ in corners]
        elif action == 4:
            mesh.elements[at] = odd, kind, r.choice([physical, odd]), r.choice([elementary, odd]), corners
        elif action == 5:
            mesh.elements.append((99, *r.choice([(15, 0, 0, corners[:1]), (1, 5, 5, corners[:2]), (2, 1, 1, corners[:3]),
                                                 (5, 1, 1, corners * 2), (11, 1, 1, (corners * 3)[:10])])))
        elif action == 6:
            mesh.nodes.append((r.choice([odd, 99, number]), [r.choice([0., 0.5, 9., 1e300]) for _ in range(3)]))
        elif action == 7:
            r.shuffle(mesh.elements)
    if r.random() < 0.3:
        name = r.choice(["left", "a\"b", "", "é", "\x1b[1m", "\udcff", "n" * 5000])
        mesh.names = [(r.choice([2, 3, odd]), r.choice([1, 2, odd]), name)]
    binary = r.random() < 0.5
    return bases.msh_bytes(r.choice([bases.version_2, bases.version_4])(mesh, binary), binary)


def odd_geometry(r, nodes):
    """Nodes of a mesh moved to where no body would be."""
    factor = r.choice([0., -1., 1e-300, 1e-160, 1e-20, 1e-3, 1e3, 1e10, 1e78, 1e154, 1e300])
    axis, one = r.randrange(3), r.randrange(len(nodes))

    def moved(i, x):
        x = list(x)
        if action == 0:
            x = [factor * c for c in x]
        elif action == 1:
            x[axis] *= factor
        elif action == 2 and i == one:
            x[axis] += factor
        elif action == 3:
            x = [r.uniform(-1, 1) for _ in x]
        elif action == 4:
            x[axis] += factor
        elif action == 5 and i % 3 == 0:
            x = list(nodes[one][1])
        elif action == 6:
            x = [x[1], x[0], x[2]]
        return x

    action = r.randrange(7)
    return [(number, moved(i, x)) for i, (number, x) in enumerate(nodes)]
