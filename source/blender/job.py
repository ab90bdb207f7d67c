# SPDX-License-Identifier: GPL-3.0-or-later
"""A run of the program in the background: how far it is, its newest frame, and what it has said."""
import csv
import signal
import subprocess

from .exemplar_blender import Failure, read_pc2

INTERRUPTED = 130
GRACE = 0.8  # [s] that a run has to end by itself


class Job:
    """Runs a scene file; its output directory is `output` beside it."""

    def __init__(self, program, scene_file, n_steps):
        self.output = scene_file.parent / "output"
        remove_frames(self.output)
        self.n_steps = n_steps
        self.log = scene_file.parent / "log.txt"
        self.shown = -1       # step of the last frame that was asked for
        self.cancelled = False
        try:
            with open(self.log, "wb") as log:
                self.process = subprocess.Popen([program, scene_file.name, "--output", "output", "--quiet"], cwd=scene_file.parent,
                                                stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        except OSError as error:
            raise Failure(f"{program} cannot be run ({error.strerror}). Give the program exemplar in the add-on's preferences.") from error

    def is_running(self):
        return self.process.poll() is None

    def newest_frame(self):
        """Places of the newest frame, if there is one since this was called last."""
        for step in range(self.n_steps, self.shown, -1):
            file = self.output / f"frame_{step:04d}.pc2"
            if file.exists():
                self.shown = step
                return read_pc2(file)[0]
        return None

    def cancel(self):
        """Within a second."""
        self.cancelled = True
        if self.is_running():
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(GRACE)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    def messages(self):
        return [line for line in self.log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]

    def status(self):
        """In words, when it has ended; None: it was well."""
        if self.process.returncode == 0:
            return None
        if self.cancelled or self.process.returncode == INTERRUPTED:
            return "Cancelled."
        return "\n".join(self.messages()[-3:]) or f"exemplar has ended with status {self.process.returncode}."


def remove_frames(directory):
    """Those of an earlier run, so that what is there is of this one."""
    for file in directory.glob("frame_*.pc2"):
        file.unlink()


def find_faults(program, surface):
    """(indices of faces, indices of vertices) with faults, counted from 0."""
    table = surface.with_name("faults.csv")
    subprocess.run([program, "mesh", "--surface", surface.name, "--list-faults", table.name, "--quiet"], cwd=surface.parent,
                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False, timeout=600)
    found = {"face": set(), "vertex": set()}
    if table.exists():
        with open(table, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                found[row["element"]].add(int(row["number"]) - 1)
    return sorted(found["face"]), sorted(found["vertex"])
