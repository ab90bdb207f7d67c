# SPDX-License-Identifier: GPL-3.0-or-later
"""How exemplar live keeps up with hands.

Usage: python3 doc/scripts/measure_live.py [--seconds 60] [--scene prm/live/cat.prm] [--set KEY=VALUE]...
Hands that are slow, fast and jerked pull the muzzle, or whatever is farthest along x, for that long each. Printed for each: the share of
statuses (ten a second) in which the body was more than two frames behind, the longest step, steps that failed, the time from a place that
was sent to the first frame that holds it (median and 99 %), frames and bytes a second.
Environment: EXEMPLAR, the program.
"""
import argparse
import math
import random
import select
import sys
import tempfile
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests/live"))
from live_client import Viewer  # noqa: E402
from live_server import Server  # noqa: E402

PERIOD = 1 / 60


def slow(t, size, _draw):
    return (-.15 * size * math.sin(.8 * t), .1 * size * math.sin(.5 * t), .15 * size * math.sin(.6 * t))


def fast(t, size, _draw):
    return (-.15 * size * math.sin(6 * t), .15 * size * math.sin(5 * t), .15 * size * math.sin(7 * t))


def jerked(t, size, _draw):
    draw = random.Random(int(2 * t))  # elsewhere twice a second
    return tuple(draw.uniform(-.2, .2) * size for _ in range(3))


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else math.nan


def drag(viewer, hand, seconds):
    """Pull as the hand does; (statuses, latencies, frames, bytes, warnings)."""
    hit = viewer.farthest()
    viewer.grab(hit)
    sent, latencies, draw = {}, [], random.Random(1)
    n_texts, n_frames, n_bytes = len(viewer.texts), len(viewer.frames), viewer.n_bytes
    begin = time.perf_counter()
    due, sequence = begin, viewer.frames[-1].pointer
    while (now := time.perf_counter()) < begin + seconds:
        if now >= due:
            sequence += 1
            move = hand(now - begin, viewer.scene["diameter"], draw)
            viewer.move([x + d for x, d in zip(hit[2], move)], sequence=sequence)
            sent[sequence] = now
            due += PERIOD
        if viewer.buffer or select.select([viewer.socket], [], [], max(0, due - time.perf_counter()))[0]:
            before = len(viewer.frames)
            viewer.read()
            for frame in viewer.frames[before:]:
                known = [s for s in sent if s <= frame.pointer]
                latencies += [time.perf_counter() - sent.pop(s) for s in known]
    viewer.send(type="release", name="a")
    viewer.wait_steps(30)
    texts = viewer.texts[n_texts:]
    return ([text for text in texts if text["type"] == "status"], latencies, len(viewer.frames) - n_frames, viewer.n_bytes - n_bytes,
            [text["text"] for text in texts if text["type"] in ("warning", "refused")])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--seconds", type=float, default=60.)
    parser.add_argument("--scene", default=TOP / "prm/live/cat.prm")
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    overrides = [word for setting in arguments.set for word in ("--set", setting)]
    print("| hand | > 2 frames behind | longest step, median of tenths of a second | 99 % | most | the same in processor time | 99 % | most | step error | failed | latency, median | 99 % | frames a second | MB/s |")
    print("|---" * 14 + "|")
    with tempfile.TemporaryDirectory() as directory:
        for hand in (slow, fast, jerked):
            with Server(arguments.scene, *overrides, log=Path(directory) / "log.txt") as server, Viewer(server) as viewer:
                viewer.wait_steps(30)
                statuses, latencies, n_frames, n_bytes, warnings = drag(viewer, hand, arguments.seconds)
            times = lambda name: " | ".join(f"{percentile([s[name] for s in statuses], p):.0f} ms" for p in (.5, .99, 1.))
            behind = sum(status["behind"] > 2 for status in statuses) / len(statuses)
            print(f"| {hand.__name__} | {100 * behind:.1f} % | {times('milliseconds')} | {times('processor_milliseconds')} "
                  f"| {max(s['residual'] or 0 for s in statuses):.0e} | {len(warnings)} | {1e3 * percentile(latencies, .5):.0f} ms "
                  f"| {1e3 * percentile(latencies, .99):.0f} ms | {n_frames / arguments.seconds:.1f} | {1e-6 * n_bytes / arguments.seconds:.2f} |",
                  flush=True)
            for warning in warnings[:3]:
                print(f"  {warning}")


if __name__ == "__main__":
    main()
