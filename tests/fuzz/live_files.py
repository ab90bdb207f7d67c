# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of a live scene are saved, moved and replaced while it is pulled, and servers are killed: nothing is lost, and recordings play.

Usage: python3 tests/fuzz/live_files.py [--changes N] [--kills N] [--seed S]

A change comes at a random place among drags, Undo and Reset, of a body that is recorded. A kill comes at a random moment of a drag.
Afterwards each recording is played: its pose at a step at which one was saved must have the same bytes, and the last frame that was
seen must be that of the step, as far as frames are rounded. Ends with status 1 if something was otherwise.
"""
import argparse
import random
import re
import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "live"))
from live_client import Closed, Viewer  # noqa: E402
from test_live_files import KilledServer, Recorded, drag, places_of, pose, save_pose  # noqa: E402


def spoil(r, bodies):
    """One change of the files of the scene; which one."""
    mesh, scene, good, other = bodies.mesh, bodies.scene, bodies.bytes, bodies.here / "other.msh"
    changes = {"removed": lambda: mesh.unlink(missing_ok=True), "half saved": lambda: mesh.write_bytes(good[:r.randrange(len(good))]),
               "another mesh": lambda: shutil.copy(other, mesh), "as it was": lambda: mesh.write_bytes(good), "empty": lambda: mesh.write_bytes(b""),
               "moved": lambda: mesh.exists() and mesh.rename(bodies.here / f"moved{r.randrange(10**9)}.msh"),
               "scene removed": lambda: scene.unlink(missing_ok=True), "scene half saved": lambda: scene.write_text("set Scene = dyn")}
    name = r.choice(list(changes))
    changes[name]()
    return name


def change_files(r, bodies, n):
    """Faults of a session in which files change n times."""
    faults = []
    with bodies.serve() as server, Viewer(server) as viewer:
        for i in range(n):
            drag(viewer, r.randrange(1, 4), name=f"d{i}")
            what = spoil(r, bodies)
            command = r.choice(["undo", "undo", "reset", None])
            if command:
                viewer.send(type=command)
                viewer.wait_for("status")
            viewer.wait_steps(1)
            if viewer.frames[-1].places and len(viewer.frames[-1].places) != len(viewer.frames[0].places):
                faults.append(f"change {i} ({what}): another body")
        drag(viewer, 3, name="last")
        step, saved = save_pose(viewer)
        faults += [text["text"] for text in viewer.texts if text["type"] == "warning"]
    if pose(bodies.play_until(step)) != pose(saved):
        faults.append("the recording plays otherwise")
    return faults


def kill(r, bodies):
    """Faults of a recording whose server was killed."""
    with KilledServer(bodies.scene, "--record", bodies.record, log=bodies.here / "log.txt") as server, Viewer(server) as viewer:
        drag(viewer, 3)
        step, saved = save_pose(viewer)
        viewer.grab(viewer.farthest(), name="b", strength=5.)
        end = time.monotonic() + r.uniform(.02, .5)
        try:
            while time.monotonic() < end:
                viewer.move((4., r.uniform(-.5, .5), r.uniform(-.5, .5)), name="b")
                viewer.read()
        finally:
            server.process.kill()
            server.process.wait()
        last = viewer.frames[-1]
    text = (bodies.record / "scene.prm").read_text()
    n_steps = round(float(re.search(r"set End = (\S+)", text)[1]) * 60)
    faults = [] if n_steps >= last.step else [f"step {last.step} was seen, and {n_steps} are played"]
    if pose(bodies.play_until(step)) != pose(saved):
        faults.append("the saved pose is another one")
    played, rounding = places_of(bodies.play_until(last.step)), max(last.box[3:]) / 32767
    if any(min(max(abs(a - b) for a, b in zip(place, other)) for other in played) > rounding for place in last.places[::7]):
        faults.append(f"step {last.step} is not what was seen")
    bodies.play()  # all of it
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--changes", type=int, default=100)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    r = random.Random(options.seed)
    n_faults = 0
    for name, job, times in (("changes", lambda bodies: change_files(r, bodies, options.changes), 1 if options.changes else 0), ("kill", lambda bodies: kill(r, bodies), options.kills)):
        for i in range(times):
            with tempfile.TemporaryDirectory() as directory:
                try:
                    faults = job(Recorded(Path(directory)))
                except (AssertionError, RuntimeError, Closed, OSError) as error:
                    faults = [repr(error)]
            for fault in faults:
                print(f"{name} {i}: {fault}", flush=True)
            n_faults += len(faults)
    print(f"{options.changes} changes of files, {options.kills} kills: {n_faults} faults")
    sys.exit(n_faults > 0)


if __name__ == "__main__":
    main()
