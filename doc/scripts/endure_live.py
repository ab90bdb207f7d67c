# SPDX-License-Identifier: GPL-3.0-or-later
"""What exemplar live bears: random hands for minutes, and their recording played again.

Usage: python3 doc/scripts/endure_live.py [--minutes 30] [--scene prm/live/cat.prm] [--seed 1] [--set KEY=VALUE]...
Springs of all strengths and hard hands pull random points of the body to random places, also through it; sliders, pins and handles are
moved. In the end all is let go of, and the body has 30 seconds of its own time to come to rest. Printed: the load of the machine, steps, warnings, numbers
that are not finite, the memory of the server at some times, how far the body ends from its rest, and whether the recording, played
again, ends in the same bytes. The exit status is 1 if a number was not finite or bytes differ.
Environment: EXEMPLAR, the program.
"""
import argparse
import math
import os
import random
import select
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests/live"))
from live_client import Viewer  # noqa: E402
from live_server import EXEMPLAR, Server  # noqa: E402

N_MEMORIES = 10


def free_name(letter, used):
    """Names are taken again, as the page does: a handle that was let go of is still known by its name."""
    return next(f"{letter}{i}" for i in range(len(used) + 1) if f"{letter}{i}" not in used)


class Hands:
    """Random commands, with what is held at present."""

    def __init__(self, viewer, seed):
        self.viewer, self.draw = viewer, random.Random(seed)
        self.size = viewer.scene["diameter"]
        self.pulls, self.pins = {}, {}  # name: when it is let go
        self.targets = {}
        self.rest = viewer.frames[-1].places

    def somewhere(self):
        place = self.draw.choice(self.rest)
        return [x + self.draw.uniform(-.3, .3) * self.size for x in place]

    def grab(self, now):
        name, triangle = free_name("h", self.pulls), self.draw.randrange(len(self.viewer.triangles))
        corners = self.viewer.triangles[triangle]
        places = self.viewer.frames[-1].places
        place = [sum(places[i][c] for i in corners) / 3 for c in range(3)]
        self.viewer.grab((triangle, [1 / 3] * 3, place), name=name, strength=10 ** self.draw.uniform(-1, 1.5), hard=self.draw.random() < .2)
        self.pulls[name] = now + self.draw.uniform(.3, 3.)
        self.targets[name] = self.somewhere()

    def pin(self, now):
        name = free_name("p", self.pins)
        places, middle = self.viewer.frames[-1].places, self.draw.choice(self.viewer.frames[-1].places)
        near = [i for i, place in enumerate(places) if math.dist(place, middle) < .08 * self.size]
        self.viewer.send(type="pin", name=name, vertices=near)
        self.pins[name] = now + self.draw.uniform(1., 6.)

    def slide(self, _now):
        scene, draw, send = self.viewer.scene, self.draw, self.viewer.send
        values = [draw.random() for _ in scene["examples"]]
        draw.choice([
            lambda: send(type="set", name="young", numbers=[scene["young"] * 10 ** draw.uniform(-1, 1)]),
            lambda: send(type="set", name="poisson", numbers=[draw.uniform(.2, .47)]),
            lambda: send(type="set", name="importance", numbers=[draw.uniform(.2, 1.)]),
            lambda: send(type="gravity", numbers=[0., 0., draw.uniform(-5., 5.)]),
            lambda: send(type="damping", numbers=[draw.uniform(0., 10.), scene["damping"][1]]),
            lambda: send(type="weights", numbers=draw.choice([[], [value / sum(values) for value in values]])),
        ])()

    def drag_handle(self, _now):
        for handle in self.viewer.scene["handles"]:
            self.viewer.send(type="handle", name=handle["name"], numbers=[self.draw.uniform(-.2, .2) * self.size for _ in range(3)])

    def act(self, now):
        """Once a frame."""
        for name in [name for name, until in self.pulls.items() if until < now]:
            self.viewer.send(type="release", name=name)
            del self.pulls[name], self.targets[name]
        for name in [name for name, until in self.pins.items() if until < now]:
            self.viewer.send(type="unpin", name=name)
            del self.pins[name]
        for name in self.pulls:
            if self.draw.random() < .03:
                self.targets[name] = self.somewhere()
            self.viewer.move(self.targets[name], name=name)
        if len(self.pulls) < 3 and self.draw.random() < .02:
            self.grab(now)
        elif self.draw.random() < .01:
            self.draw.choice([self.pin, self.slide, self.slide, self.drag_handle])(now)

    def let_go_of_all(self):
        self.act(math.inf)
        scene, send = self.viewer.scene, self.viewer.send
        for name in ("young", "poisson", "importance"):
            send(type="set", name=name, numbers=[scene[name]])
        for handle in scene["handles"]:
            send(type="handle", name=handle["name"], numbers=[0., 0., 0.])
        send(type="weights", numbers=[])
        send(type="gravity", numbers=scene["gravity"])
        send(type="damping", numbers=[4., scene["damping"][1]])


def memory_of(server):
    """[MB]; of exemplar-live, which the process has become."""
    status = Path(f"/proc/{server.process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0]) / 1024


def is_finite(viewer, n_texts):
    numbers = [*viewer.frames[-1].box]
    for text in viewer.texts[n_texts:]:
        if text["type"] == "status":
            numbers += [math.nan if text[name] is None else text[name] for name in ("energy", "min_det_F", "residual")]
    return all(map(math.isfinite, numbers))


def play(viewer, server, hands, seconds):
    """(memories [MB], how often numbers were not finite, warnings)."""
    begin = time.perf_counter()
    due, memories, n_bad, warnings = begin, [], 0, []
    while (now := time.perf_counter()) < begin + seconds:
        if now >= due:
            hands.act(now)
            due = max(due + 1 / 60, now - .1)
            if now - begin >= seconds * (len(memories) + 1) / N_MEMORIES:
                memories.append(memory_of(server))
        if viewer.buffer or select.select([viewer.socket], [], [], max(0, due - time.perf_counter()))[0]:
            viewer.read()
            n_bad += not is_finite(viewer, 0)
            warnings += [text["text"] for text in viewer.texts if text["type"] in ("warning", "refused")]
            del viewer.frames[:-1], viewer.texts[:]
    return [*memories, memory_of(server)], n_bad, warnings


def rest(viewer, seconds):
    """Let the body have these seconds of its own; (how often numbers were not finite, warnings)."""
    end, n_bad, warnings = viewer.frames[-1].time + seconds, 0, []
    while viewer.frames[-1].time < end:
        viewer.read()
        n_bad += not is_finite(viewer, 0)
        warnings += [text["text"] for text in viewer.texts if text["type"] in ("warning", "refused")]
        del viewer.frames[:-1], viewer.texts[:]
    return n_bad, warnings


def ends_alike(record, saved, directory):
    """Whether the recording, played again, ends in the pose that was saved."""
    subprocess.run([EXEMPLAR, str(record / "scene.prm"), "--output", str(directory / "again"), "--quiet", "--set", "Output/Every=0",
                    "--threads", "1"], check=True)

    def nodes(file):
        return file.read_text().split("$Nodes")[1].split("$EndNodes")[0]

    return nodes(directory / "again/final.msh") == nodes(saved)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--minutes", type=float, default=30.)
    parser.add_argument("--scene", default=TOP / "prm/live/cat.prm")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    words = [word for setting in arguments.set for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as directory:
        directory = Path(directory)
        record = directory / "session"
        with Server(arguments.scene, *words, "--record", record, log=directory / "log.txt") as server, Viewer(server) as viewer:
            hands = Hands(viewer, arguments.seed)
            memories, n_bad, warnings = play(viewer, server, hands, 60 * arguments.minutes)
            hands.let_go_of_all()
            more_bad, more_warnings = rest(viewer, 30.)
            viewer.send(type="pause", on=True)
            viewer.until(lambda: viewer.wait_for("status")["paused"])
            viewer.send(type="save pose")
            saved = Path(viewer.wait_for("saved")["text"])
            status = viewer.wait_for("status")
            size = viewer.scene["diameter"]
            distances = [max(map(math.dist, viewer.frames[-1].places, pose.places)) / size for pose in viewer.poses]
        n_bad, warnings = n_bad + more_bad, warnings + more_warnings
        print(f"load of the machine: {' '.join(Path('/proc/loadavg').read_text().split()[:3])} on {os.cpu_count()} cores")
        print(f"steps: {status['step']}; warnings and refusals: {len(warnings)}")
        for warning in sorted(set(warnings)):
            print(f"  {warnings.count(warning)} times: {warning}")
        print(f"messages with numbers that are not finite: {n_bad}")
        print("memory of the server [MB], from begin to end: " + " ".join(f"{memory:.0f}" for memory in memories))
        print("let go, the body ends at this distance from each example (1: its diameter): " + " ".join(f"{d:.1e}" for d in distances)
              + f"; weights {[round(weight, 3) for weight in status['weights']]}; least det F {status['min_det_F']:.2f}")
        begin = time.perf_counter()
        same = ends_alike(record, saved, directory)
        print(f"played again in {time.perf_counter() - begin:.0f} s: {'the same bytes' if same else 'OTHER BYTES'}")
    sys.exit(n_bad > 0 or not same)


if __name__ == "__main__":
    main()
