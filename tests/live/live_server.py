# SPDX-License-Identifier: GPL-3.0-or-later
"""A server of exemplar live, and the bar that tests pull. The program is named by the environment variable EXEMPLAR."""
import signal
import subprocess
import sys
from math import pi
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "scenes"))
import exemplar_runner  # noqa: E402
from exemplar_runner import EXEMPLAR, Msh, bend, call_program, prm, wait_until, write_msh  # noqa: E402, F401
from live_client import Address  # noqa: E402

# Without weight, and with an example that is bent by a right angle.
BAR = {**exemplar_runner.BAR, "Scene": "dynamic", "Mesh/Box size": "4, 1, 1", "Mesh/Box cells": "8, 2, 2", "Time/Increments": None,
       "Loads/Gravity": None, "Examples/Pose functions": bend(pi / 2), "Examples/Importance": "0.8"}


class Server(Address):
    """The program on a scene; a context."""

    def __init__(self, scene, *arguments, log):
        self.log = Path(log)
        with open(self.log, "w") as errors:
            self.process = subprocess.Popen([EXEMPLAR, "live", str(scene), *map(str, arguments)], stdin=subprocess.DEVNULL,
                                            stdout=subprocess.PIPE, stderr=errors, text=True)
        self.line = ""
        while "Open http" not in self.line:
            self.line = self.process.stdout.readline()
            if not self.line:
                raise RuntimeError(self.log.read_text())
        super().__init__(self.line)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        status = self.process.wait(timeout=60)
        self.process.stdout.close()
        if status != 130:
            raise RuntimeError(f"the server ended with {status}: {self.log.read_text()}")
