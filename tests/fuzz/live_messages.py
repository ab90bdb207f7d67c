# SPDX-License-Identifier: GPL-3.0-or-later
"""What no page would send: mutated commands, frames of WebSockets and requests of HTTP; the server lives on, and its recording plays.

Usage: python3 tests/fuzz/live_messages.py [--messages N] [--requests N] [--seed S]

Ends with status 1 if the server ended, a frame had a place that is no number, or the recording does not play to the same pose.
"""
import argparse
import json
import math
import os
import random
import socket
import sys
import tempfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "live"))
import mutations  # noqa: E402
from live_client import Closed, Viewer  # noqa: E402
from test_live_files import Recorded, pose, save_pose  # noqa: E402

COMMANDS = [{"type": "grab", "name": "a", "triangle": 3, "on": False, "numbers": [1, 0, 0, 4, 0, 0, 1], "sequence": 1},
            {"type": "grab", "name": "h", "triangle": 5, "on": True, "numbers": [.5, .5, 0, 3, 0, 0, 1]}, {"type": "move", "name": "a", "numbers": [4, .1, .2]},
            {"type": "release", "name": "a"}, {"type": "pin", "name": "1", "vertices": [5, 6, 7]}, {"type": "unpin", "name": "1"},
            {"type": "handle", "name": "left", "numbers": [0, .1, 0]}, {"type": "set", "name": "young", "numbers": [1e6]},
            {"type": "set", "name": "poisson", "numbers": [.3]}, {"type": "set", "name": "importance", "numbers": [.5]}, {"type": "weights", "numbers": [.5, .5]},
            {"type": "weights", "numbers": []}, {"type": "gravity", "numbers": [0, 0, -1]}, {"type": "damping", "numbers": [1, .001]}, {"type": "pause", "on": True},
            {"type": "pause", "on": False}, {"type": "step"}, {"type": "reset"}, {"type": "undo"}, {"type": "colour", "name": "energy"}, {"type": "save pose"}, {"type": "take mouse"}]
NAMES = ["a", "h", "1", "left", "", " a", "a ", "pin 1", "hand a", "a|b", "\n", "\x1b[1m", "é", "x" * 63, "x" * 65, "\ud800"]


def odd_value(r):
    return r.choice([None, True, [], {}, "", "x", -1, 0, 1, 1e-300, 1e30, 1e300, 2**31, 2**32, 2**63, [[1]], [None], ["1"], r.choice(mutations.TEXTS)[:500],
                     [r.uniform(-5, 5) for _ in range(r.randrange(9))], list(range(r.choice([0, 3, 30, 3000])))])


def spoilt(r):
    """The bytes of a command; many are right."""
    command = json.loads(json.dumps(r.choice(COMMANDS)))
    for _ in range(r.choice([0, 1, 1, 2])):
        key = r.choice(list(command) + ["name", "numbers", "type"])
        value = command.get(key)
        action = r.random()
        if action < .15:
            command.pop(key, None)
        elif key == "name" and action < .8:
            command[key] = r.choice(NAMES)
        elif isinstance(value, list) and value and action < .8:
            value[r.randrange(len(value))] = r.choice([r.uniform(-9, 9), 0, -1, 1e29, 1e31, 1e-30, 10**20, None, "1", 0.3])
        else:
            command[key] = odd_value(r)
    data = json.dumps(command).encode("utf-8", "surrogatepass")
    return mutations.damaged(r, data) if r.random() < .1 else data


def request(r, server):
    """The bytes of a request."""
    lines = [f"{r.choice(['GET', 'HEAD', 'POST', 'PUT', 'get', 'G' * 5000])} {r.choice(['/', '/ws', '/app.js', '/../etc/passwd', '//', '/?token=x', '/%00', '/' * 9000])} HTTP/{r.choice(['1.1', '1.0', '2', '9.9'])}",
             f"Host: {r.choice([server.host, '', 'evil.com', '127.0.0.1', '[::1]:x', 'a' * 9000])}", f"Cookie: {r.choice([server.cookie, '', 'x=' + 'y' * 9000])}",
             f"Origin: {r.choice(['http://' + server.host, 'null', 'http://evil.com'])}", "Upgrade: websocket", "Connection: Upgrade",
             f"Sec-WebSocket-Key: {r.choice(['dGhlIHNhbXBsZSBub25jZQ==', '', 'x'])}", f"Sec-WebSocket-Version: {r.choice(['13', '0', 'x'])}", f"Content-Length: {r.choice(['0', '-1', '99999999999999999999', 'x'])}"]
    keep = [lines[0]] + [line for line in lines[1:] if r.random() < .7]
    data = "\r\n".join([*keep, "", ""]).encode()
    return mutations.damaged(r, data) if r.random() < .3 else data


def ask(r, server):
    with socket.create_connection(("127.0.0.1", server.port), timeout=30) as sock:
        sock.settimeout(15)
        try:
            sock.sendall(request(r, server))
            if r.random() < .3:
                sock.sendall(bytes(r.randrange(256) for _ in range(r.randrange(200))))
            sock.shutdown(socket.SHUT_WR)
            while sock.recv(65536):
                pass
        except OSError:
            pass  # it has ended the connection


class Talk:
    """A viewer that comes back where it is sent away."""

    def __init__(self, server):
        self.server, self.viewer, self.n_returns = server, Viewer(server), 0
        self.viewer.send(type="take mouse")

    def say(self, data, opcode=1, final=True):
        try:
            self.viewer.send_raw(data, opcode=opcode, final=final)
        except OSError:
            self.come_back()

    def listen(self, n):
        """Read frames until the body has gone on by n steps, or the viewer is sent away."""
        goal = self.viewer.frames[-1].step + n
        for _ in range(5):  # a step that fails three times pauses the body at its beginning, of step 0
            try:
                self.viewer.send(type="pause", on=False)
                self.viewer.until(lambda: self.viewer.frames[-1].step >= min(goal, n), limit=20)
                break
            except AssertionError:
                continue
            except (Closed, OSError):
                self.come_back()
        bad = [place for frame in self.viewer.frames[-2:] for place in frame.places if not all(map(math.isfinite, place))]
        del self.viewer.frames[:-1], self.viewer.texts[:-50]
        return bool(bad)

    def come_back(self):
        self.viewer.socket.close()
        self.viewer = Viewer(self.server)
        self.viewer.send(type="take mouse")
        self.n_returns += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--messages", type=int, default=3000)
    parser.add_argument("--requests", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    r, faults = random.Random(options.seed), []
    with tempfile.TemporaryDirectory() as directory:
        bodies = Recorded(Path(directory))
        with bodies.serve() as server:
            talk = Talk(server)
            for i in range(options.messages):
                opcode = r.choice([1] * 30 + [0, 2, 3, 8, 9, 10, 15])
                talk.say(spoilt(r) if opcode == 1 else os.urandom(r.randrange(120)), opcode, r.random() < .97)
                if i % 10 == 9 and talk.listen(1):
                    faults.append(f"message {i}: a place is no number")
            for i in range(options.requests):
                ask(r, server)
            talk.come_back()
            step, saved = save_pose(talk.viewer)
            if server.process.poll() is not None:
                faults.append("the server has ended")
        if pose(bodies.play_until(step)) != pose(saved):
            faults.append("the recording plays otherwise")
        log = bodies.here.joinpath("log.txt").read_bytes()
        if any(byte < 32 and byte != 10 or byte > 126 for byte in log):
            faults.append("the log has bytes that strangers chose")
    print("\n".join([*faults, f"{options.messages} messages, {options.requests} requests, {talk.n_returns} times sent away: {len(faults)} faults"]))
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
