# SPDX-License-Identifier: GPL-3.0-or-later
"""The program in the background: a run, how far it is and what it has said, and the search for faults of a surface."""
import csv
import re
import signal
import subprocess

from .exemplar_blender import Failure, read_pc2

INTERRUPTED = 130
GRACE = 0.8  # [s] that a run has to end by itself


def start(program, arguments, directory, log=subprocess.DEVNULL):
    try:
        return subprocess.Popen([program, *arguments], cwd=directory, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
    except OSError as error:
        raise Failure(f"{program} cannot be run ({error.strerror}). Give the program exemplar in the add-on's preferences.") from error


class Job:
    """Runs a scene file; its output directory is `output` beside it."""

    def __init__(self, program, scene_file, n_frames, steps=1):
        self.program = program
        self.directory = scene_file.parent
        self.output = self.directory / "output"
        for file in (*self.output.glob("frame_*.pc2"), self.output / "log.txt"):
            file.unlink(missing_ok=True)  # so that all that is there is of this run
        self.n_frames, self.steps = n_frames, steps  # frames after the first one, and the steps of each
        self.log = self.directory / "log.txt"
        self.shown = -1  # last frame that was asked for
        self.cancelled = False
        with open(self.log, "wb") as log:
            self.process = start(program, [scene_file.name, "--output", "output", "--quiet"], self.directory, log)

    def is_running(self):
        return self.process.poll() is None

    def newest_frame(self):
        """Places of the newest frame, if there is one since this was called last."""
        newest = self.shown
        while newest < self.n_frames and self._frame_file(newest + 1).exists():
            newest += 1
        if newest == self.shown:
            return None
        self.shown = newest
        return read_pc2(self._frame_file(newest))[0]

    def _frame_file(self, frame):
        return self.output / f"frame_{frame * self.steps:04d}.pc2"

    def cancel(self):
        """Within a second: a run that does not end after its step is killed."""
        self.cancelled = True
        if self.is_running():
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(GRACE)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    def messages(self):
        """Lines of the program's own: warnings, and what it ended with."""
        lines = [line for line in self.log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
        first = next((i for i, line in enumerate(lines) if line.startswith(("exemplar: ", "Warning: "))), len(lines))
        return lines[first:]

    def pairs_left_out(self):
        """How many parts of the surface touch or cross others at rest, which contact leaves out, and the place of the first [m]; or None."""
        log = self.output / "log.txt"
        said = log.read_text(encoding="utf-8", errors="replace") if log.exists() else ""
        found = re.search(r"Contact leaves out (\d+) pairs of parts of the surface that touch or cross at rest, the first near \(([^)]*)\) m", said)
        return (int(found[1]), [float(number) for number in found[2].split(",")]) if found else None

    def place_of_overlap(self):
        """Where two pieces overlap at the beginning [m], if this was the run's error; else None."""
        found = re.search(r"pieces of the mesh overlap near \(([^)]*)\) m", "\n".join(self.messages()))
        return [float(number) for number in found[1].split(",")] if found else None

    def failure(self):
        """In words, when it has ended; None: it was well."""
        if self.process.returncode == 0:
            return None
        if self.cancelled or self.process.returncode == INTERRUPTED:
            return "Cancelled."
        return "\n".join(self.messages()) or f"exemplar has ended with status {self.process.returncode}. See {self.log}."


class FaultSearch:
    """Looks for the faces and vertices of a surface that keep it from bounding a body."""

    def __init__(self, job):
        self.table = job.directory / "faults.csv"
        self.table.unlink(missing_ok=True)
        self.process = start(job.program, ["mesh", "--surface", "body.obj", "--list-faults", self.table.name, "--quiet"], job.directory)

    def is_running(self):
        return self.process.poll() is None

    def found(self):
        """(indices of faces, indices of vertices), counted from 0."""
        indices = {"face": set(), "vertex": set()}
        if self.table.exists():
            with open(self.table, newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    indices[row["element"]].add(int(row["number"]) - 1)
        return indices["face"], indices["vertex"]
