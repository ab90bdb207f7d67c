# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewer of exemplar live without a browser: WebSockets by the standard library alone, so that tests can also send what no
well-behaved client would.

    with Viewer(Address("http://127.0.0.1:43695/?token=...")) as viewer:
        viewer.grab(viewer.farthest())
        viewer.wait_steps(10)
"""
import base64
import functools
import http.client
import json
import os
import re
import socket
import struct


class Address:
    """What the program says is to be opened."""

    def __init__(self, address):
        self.port, self.token = re.search(r":(\d+)/\?token=(\w+)", address).groups()
        self.port = int(self.port)
        self.host = f"127.0.0.1:{self.port}"
        self._cookie = None

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port), timeout=30)

    def get(self, path, method="GET", **headers):
        """(status, headers, body); underscores of header names are hyphens; None leaves a header out."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        everything = {"Host": self.host, **{name.replace("_", "-"): value for name, value in headers.items()}}
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        for name, value in everything.items():
            if value is not None:
                connection.putheader(name, value)
        connection.endheaders()
        answer = connection.getresponse()
        result = answer.status, {name.lower(): value for name, value in answer.getheaders()}, answer.read()
        connection.close()
        return result

    @property
    def cookie(self):
        if self._cookie is None:
            self._cookie = self.get(f"/?token={self.token}")[1]["set-cookie"].split(";")[0]
        return self._cookie

    def handshake(self, **headers):
        """(socket, status) after asking for a WebSocket; headers as in get()."""
        wanted = {"Host": self.host, "Origin": f"http://{self.host}", "Cookie": self.cookie, "Upgrade": "websocket",
                  "Connection": "Upgrade", "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
                  "Sec-WebSocket-Version": "13", **headers}
        sock = self.connect()
        lines = [f"{name}: {value}" for name, value in wanted.items() if value is not None]
        sock.sendall("\r\n".join(["GET /ws HTTP/1.1", *lines, "", ""]).encode())
        head = b""
        while b"\r\n\r\n" not in head:
            byte = sock.recv(1)
            if not byte:
                break
            head += byte
        return sock, int(head.split()[1]) if head else 0


class Closed(Exception):
    """The server has closed the WebSocket, with this code."""


class Frame:
    """What a binary message of places holds; doc/live.md."""

    def __init__(self, data):
        (self.kind, self.number, self.step, self.pointer, self.time, *box, n, self.has_colours, self.low,
         self.high) = struct.unpack_from("<4Id6f2I2f", data)
        end = 64 + (7 if self.has_colours else 6) * n
        self.box, self.colours, self._shorts = box, data[64 + 6 * n:end], data[64:64 + 6 * n]
        tails = {}
        tail = Frame(data[end:]) if data[end:] else None
        while tail:  # obstacles that have moved, inner nodes of a drawn surface
            tails[tail.kind], tail = tail, tail.next
        self.obstacles, self.inner = tails.get(4), tails.get(5)
        self.next = next(iter(tails.values()), None)

    @functools.cached_property
    def places(self):
        box, shorts = self.box, struct.unpack(f"<{len(self._shorts) // 2}h", self._shorts)
        return [tuple(box[c] + (shorts[i + c] / 32767 + 1) / 2 * box[3 + c] for c in range(3)) for i in range(0, len(shorts), 3)]


class Viewer:
    """A WebSocket; a context."""

    def __init__(self, server):
        self.socket, status = server.handshake()
        if status != 101:
            raise Closed(status)
        self.buffer = b""
        self.texts, self.frames, self.poses, self.obstacles = [], [], [], []
        self.n_bytes, self.acknowledges = 0, True
        self.triangles = self.triangles_of_obstacles = None
        self.until(lambda: self.frames and any(text["type"] == "mouse" for text in self.texts))
        self.scene = next(text for text in self.texts if text["type"] == "scene")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send_raw(self, payload, opcode=1, final=True):
        mask = os.urandom(4)
        n = len(payload)
        length = bytes([0x80 | n]) if n < 126 else struct.pack(">BH", 0xFE, n) if n < 65536 else struct.pack(">BQ", 0xFF, n)
        key = (mask * (n // 4 + 1))[:n]
        masked = (int.from_bytes(payload, "little") ^ int.from_bytes(key, "little")).to_bytes(n, "little")
        self.socket.sendall(bytes([(0x80 if final else 0) | opcode]) + length + mask + masked)

    def send(self, **message):
        self.send_raw(json.dumps(message).encode())

    def _exactly(self, n):
        while len(self.buffer) < n:
            more = self.socket.recv(65536)
            if not more:
                raise Closed(1006)
            self.buffer += more
        taken, self.buffer = self.buffer[:n], self.buffer[n:]
        return taken

    def read(self):
        """Take one message, and return it decoded."""
        first, second = self._exactly(2)
        n = second & 0x7F
        if n >= 126:
            n = struct.unpack(">H", self._exactly(2))[0] if n == 126 else struct.unpack(">Q", self._exactly(8))[0]
        data = self._exactly(n)
        self.n_bytes += n
        opcode = first & 0xF
        if opcode == 8:
            raise Closed(struct.unpack(">H", data[:2])[0] if data else 1005)
        if opcode == 9:
            self.send_raw(data, opcode=10)
            return None
        if opcode == 10:
            return None
        if opcode == 1:
            self.texts.append(json.loads(data))
            return self.texts[-1]
        return self._take_binary(data)

    def _take_binary(self, data):
        kind, n, m = struct.unpack_from("<3I", data)
        if kind in (0, 3):
            flat = struct.unpack_from(f"<{3 * m}I", data, 12)
            triangles = [flat[i:i + 3] for i in range(0, 3 * m, 3)]
            if kind == 0:
                self.triangles = triangles
            else:
                self.triangles_of_obstacles = triangles
            return None
        frame = Frame(data)
        {1: self.frames, 2: self.poses, 4: self.obstacles}[kind].append(frame)
        if frame.kind == 1 and frame.number and self.acknowledges:
            self.send_raw(f"ack {frame.number}".encode())
        return frame

    def until(self, is_so, limit=3000):
        """Read until this is so; at most that many messages."""
        for _ in range(limit):
            if is_so():
                return
            self.read()
        raise AssertionError("this has not come")

    def wait_for(self, kind):
        """The next text of a type."""
        n = len(self.texts)
        self.until(lambda: any(text["type"] == kind for text in self.texts[n:]))
        return next(text for text in self.texts[n:] if text["type"] == kind)

    def wait_steps(self, n):
        """Until the body has made n more steps."""
        goal = self.frames[-1].step + n
        self.until(lambda: self.frames[-1].step >= goal)

    def farthest(self, axis=0):
        """(triangle, shares, place) of a corner of the body that is farthest along an axis."""
        places = self.frames[-1].places
        vertex = max(range(len(places)), key=lambda i: places[i][axis])
        triangle = next(t for t, corners in enumerate(self.triangles) if vertex in corners)
        shares = [float(corner == vertex) for corner in self.triangles[triangle]]
        return triangle, shares, places[vertex]

    def grab(self, hit, name="a", strength=1., hard=False, sequence=0):
        triangle, shares, place = hit
        self.send(type="grab", name=name, triangle=triangle, on=hard, numbers=[*shares, *place, strength], sequence=sequence)

    def move(self, place, name="a", sequence=0):
        self.send(type="move", name=name, numbers=list(place), sequence=sequence)
