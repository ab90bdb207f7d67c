# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads binary glTF as players do, as far as runs have it: places of vertices in a frame, none of it the program's."""

import json
import math
import struct

COMPONENTS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
NUMBERS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def turned(q, x):
    """x turned by a quaternion (x, y, z, w) of any length."""
    n = math.hypot(*q)
    u, w = [a / n for a in q[:3]], q[3] / n
    t = [2 * (u[(i + 1) % 3] * x[(i + 2) % 3] - u[(i + 2) % 3] * x[(i + 1) % 3]) for i in range(3)]
    return [x[i] + w * t[i] + u[(i + 1) % 3] * t[(i + 2) % 3] - u[(i + 2) % 3] * t[(i + 1) % 3] for i in range(3)]


class Gltf:
    def __init__(self, file):
        data = file.read_bytes()
        magic, version, size, n_text, kind = struct.unpack_from("<4s4I", data)
        assert (magic, version, size, kind) == (b"glTF", 2, len(data), 0x4E4F534A)
        self.json = json.loads(data[20:20 + n_text], parse_constant=lambda name: 1 / 0)
        n_bytes, kind = struct.unpack_from("<2I", data, 20 + n_text)
        assert kind == 0x004E4942 and 28 + n_text + n_bytes == size and n_text % 4 == n_bytes % 4 == 0
        self.bytes = data[28 + n_text:]
        assert self.json["buffers"] == [{"byteLength": n_bytes}]
        self.animation, = self.json["animations"]
        self.times = [time for time, in self.accessor(self.animation["samplers"][0]["input"])]
        assert all(sampler["input"] == self.animation["samplers"][0]["input"] and sampler["interpolation"] == "LINEAR"
                   for sampler in self.animation["samplers"])

    def accessor(self, number):
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        letter, n = COMPONENTS[accessor["componentType"]], NUMBERS[accessor["type"]]
        assert view["byteOffset"] % 4 == 0 and view["byteLength"] == struct.calcsize(letter) * n * accessor["count"]
        values = struct.unpack_from(f"<{n * accessor['count']}{letter}", self.bytes, view["byteOffset"])
        rows = [values[i:i + n] for i in range(0, len(values), n)]
        for name, of in (("min", min), ("max", max)):
            if name in accessor:
                assert [of(column) for column in zip(*rows)] == accessor[name]
        return rows

    def keys(self, node, path):
        """What a channel says, a row a frame; None without one."""
        for channel in self.animation["channels"]:
            if channel["target"] == {"node": node, "path": path}:
                rows = self.accessor(self.animation["samplers"][channel["sampler"]]["output"])
                n = len(rows) // len(self.times)
                return rows if path != "weights" else [[w for w, in rows[n * k:n * (k + 1)]] for k in range(len(self.times))]
        return None

    def meshes(self):
        """{name: (number of its node, mesh)}."""
        return {node["name"]: (i, self.json["meshes"][node["mesh"]]) for i, node in enumerate(self.json["nodes"]) if "mesh" in node}

    def frames(self, name, attribute="POSITION"):
        """Of each frame the places (or normals, not of unit length) of a mesh's vertices, which all of its primitives share, in the axes of
        the run."""
        node, mesh = self.meshes()[name]
        motion, = (i for i, other in enumerate(self.json["nodes"]) if node in other.get("children", []))
        assert self.json["nodes"][0]["children"][0] == motion and self.json["scenes"][self.json["scene"]]["nodes"] == [0]
        rotations, translations, weights = (self.keys(*what) for what in ((motion, "rotation"), (motion, "translation"), (node, "weights")))
        first = mesh["primitives"][0]
        assert all({**primitive, "indices": 0, "material": 0} == {**first, "indices": 0, "material": 0} for primitive in mesh["primitives"])
        rest = self.accessor(first["attributes"][attribute])
        targets = [self.accessor(target[attribute]) for target in first.get("targets", [])]
        for k, q in enumerate(rotations):
            t = translations[k] if attribute == "POSITION" else (0, 0, 0)
            row = []
            for v, x in enumerate(rest):
                x = [x[c] + sum(w * target[v][c] for w, target in zip(weights[k] if targets else [], targets, strict=True)) for c in range(3)]
                row.append([a + b for a, b in zip(turned(q, x), t)])
            yield row
