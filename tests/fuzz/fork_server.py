# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a program that has been linked once: the other end of fork_server.cc."""

import os
import re
import signal
import socket
import struct
import subprocess
import tempfile
import time
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

    def start(self, arguments, directory, environment, memory=None, file_size=1 << 50, stands_still=False):
        """A run with at most MOST_ARGUMENTS arguments, within `memory` (None: no limit) and files of `file_size` [bytes]; the next
        one starts when it has ended. One that stands still waits for SIGCONT before its main()."""
        def joined(words):
            return b"".join(os.fsencode(word) + b"\0" for word in words)

        words = joined([directory, *arguments])
        variables = joined(f"{name}={value}" for name, value in environment.items())
        out, err = tempfile.TemporaryFile(), tempfile.TemporaryFile()
        head = struct.pack("QQQQQ", len(words), len(variables), memory or 0, file_size, stands_still)
        socket.send_fds(self.socket, [head], [out.fileno(), err.fileno()])
        self.socket.sendall(words + variables)
        return ServedRun(self, self.number(), out, err)

    def run(self, arguments, directory, environment, memory, file_size, time_limit):
        """(status, stdout, stderr) of a run."""
        return self.start(arguments, directory, environment, memory, file_size).end(time_limit)


class ServedRun:
    """A run that a ForkServer has started, with the id of its process."""

    def __init__(self, server, pid, out, err):
        self.server, self.pid, self.streams = server, pid, (out, err)

    def end(self, time_limit=None):
        """(status, stdout, stderr), the status negative after a signal. After the time limit [s] it gets SIGTERM, ten seconds
        later SIGKILL."""
        limits = ((time_limit, signal.SIGTERM), (10., signal.SIGKILL)) if time_limit else ()
        for limit, after in (*limits, (None, None)):
            try:
                status = self.server.number(limit)
                break
            except TimeoutError:
                os.kill(self.pid, after)
        said = []
        for file in self.streams:
            with file:
                file.seek(0)
                said.append(file.read())
        return status, *said

    def wait_for_tracer(self, tracer):
        """Until strace, a process that was started for this, has come to the run, which then goes on. Fails if it ends before."""
        while "TracerPid:\t0\n" in Path(f"/proc/{self.pid}/status").read_text():
            if tracer.poll() is not None:
                os.kill(self.pid, signal.SIGKILL)
                self.end()
                raise RuntimeError("strace has ended")
            time.sleep(1e-3)
        os.kill(self.pid, signal.SIGCONT)
