# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a program that has been linked once: the other end of fork_server.cc."""

import os
import re
import signal
import socket
import struct
import subprocess
import tempfile
from pathlib import Path

MOST_ARGUMENTS = 200
SANITIZER_OPTIONS = {"ASAN_OPTIONS": "detect_leaks=0:abort_on_error=0:exitcode=99:detect_stack_use_after_return=0",
                     "UBSAN_OPTIONS": "print_stacktrace=1:halt_on_error=1:exitcode=99"}


def right_core_type():
    """What the program would start itself again for, as OpenBLAS reads it before."""
    flags = Path("/proc/cpuinfo").read_text()
    return "SKYLAKEX" if "avx512vl" in flags else "HASWELL" if "avx2" in flags else ""


def sanitizer_of(program):
    """The library of the address sanitizer, which must be loaded before all others, if the program needs it."""
    needed = subprocess.run(["ldd", program], capture_output=True, text=True, check=False).stdout
    return re.findall(r"=> (\S*libasan\S*)", needed)


class ForkServer:
    """A process of `program` that forks a run when it is asked to. Ends with the object."""

    def __init__(self, program, library):
        ours, theirs = socket.socketpair()
        # threads of OpenBLAS would not survive a fork
        variables = {"OPENBLAS_CORETYPE": right_core_type(), **os.environ, "OPENBLAS_NUM_THREADS": "1", **SANITIZER_OPTIONS,
                     "LD_PRELOAD": ":".join([*sanitizer_of(program), library]), "FORK_SERVER_SOCKET": str(theirs.fileno())}
        self.process = subprocess.Popen([program] + ["room"] * MOST_ARGUMENTS, env=variables, pass_fds=[theirs.fileno()],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        theirs.close()
        self.socket = ours

    def close(self):
        self.socket.close()
        self.process.wait()

    def number(self, time_limit=None):
        self.socket.settimeout(time_limit)
        answer = self.socket.recv(8, socket.MSG_WAITALL)
        if len(answer) < 8:
            raise RuntimeError("the fork server has ended")
        return struct.unpack("q", answer)[0]

    def run(self, arguments, directory, environment, memory, file_size, time_limit):
        """(status, stdout, stderr) of a run with at most MOST_ARGUMENTS arguments, within `memory` (None: no limit) and files
        of `file_size` [bytes]. After the time limit [s] it gets SIGTERM, ten seconds later SIGKILL."""
        def joined(words):
            return b"".join(os.fsencode(word) + b"\0" for word in words)

        words = joined([directory, *arguments])
        variables = joined(f"{name}={value}" for name, value in environment.items())
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            head = struct.pack("QQQQ", len(words), len(variables), memory or 0, file_size)
            socket.send_fds(self.socket, [head], [out.fileno(), err.fileno()])
            self.socket.sendall(words + variables)
            run = self.number()
            for limit, after in ((time_limit, signal.SIGTERM), (10., signal.SIGKILL), (None, None)):
                try:
                    status = self.number(limit)
                    break
                except TimeoutError:
                    os.kill(run, after)
            return status, *(file.seek(0) or file.read() for file in (out, err))
