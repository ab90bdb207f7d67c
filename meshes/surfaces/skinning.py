# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses of a surface by bones: linear blend skinning with smooth weights.

A skeleton is {name: (parent or None, head, tail)}; a pose is {name: (axis, angle in degrees)}, turns of bones about
their heads on top of their parents' turns, in world axes at rest.
"""
import numpy as np


def rotation(axis, degrees):
    """3x3, about an axis through the origin (Rodrigues)."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def distances_to_bones(points, skeleton):
    """(n points, n bones), to the segments."""
    columns = []
    for _, head, tail in skeleton.values():
        head, tail = np.asarray(head, float), np.asarray(tail, float)
        along = tail - head
        share = np.clip((points - head) @ along / (along @ along), 0, 1)
        columns.append(np.linalg.norm(points - head - share[:, None] * along, axis=1))
    return np.array(columns).T


def weights(points, skeleton, width):
    """Smooth shares of the bones: Gaussians of how much farther than the nearest bone each is."""
    distance = distances_to_bones(points, skeleton)
    beyond = distance - distance.min(axis=1, keepdims=True)
    share = np.exp(-(beyond / width) ** 2)
    return share / share.sum(axis=1, keepdims=True)


def smoothed(share, faces, n_times):
    """Means over the neighbours on the surface, so that legs that are near in space are not in shares."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    count = np.bincount(edges.ravel(), minlength=len(share))[:, None]
    for _ in range(n_times):
        total = np.zeros_like(share)
        np.add.at(total, edges[:, 0], share[edges[:, 1]])
        np.add.at(total, edges[:, 1], share[edges[:, 0]])
        share = 0.5 * share + 0.5 * total / count
    return share


def mild(pose):
    """The same way, less far."""
    return {bone: (axis, .4 * degrees) for bone, (axis, degrees) in pose.items()}


def transformations(skeleton, pose):
    """{bone: (R, t)}, x -> R x + t."""
    result = {}
    for name, (parent, head, _) in skeleton.items():
        R, t = result[parent] if parent else (np.eye(3), np.zeros(3))
        if name in pose:
            axis, degrees = pose[name]
            turn = rotation(axis, degrees)
            head = np.asarray(head, float)
            R, t = R @ turn, R @ (head - turn @ head) + t
        result[name] = R, t
    return result


def posed(points, share, skeleton, pose):
    """Points where a pose takes them."""
    result = np.zeros_like(points)
    for column, (R, t) in enumerate(transformations(skeleton, pose).values()):
        result += share[:, [column]] * (points @ R.T + t)
    return result


def write_obj(path, points, faces):
    with open(path, "w") as file:
        for point in points:
            file.write("v %.9g %.9g %.9g\n" % tuple(point))
        for face in faces:
            file.write("f %s\n" % " ".join(str(v + 1) for v in face))


def read_obj(path):
    points, faces = [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                points.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return np.array(points), np.array(faces)
