# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills, interrupts and starves runs, resumes them, and holds what comes out to a run that nothing happened to.

Usage: python3 tests/fuzz/kills.py [--kills N] [--seed S] [--program P] [--fork-server L] [--trial NAME] [--keep DIRECTORY]

Runs are copies of one process that has loaded the program, but for those that need streams of their own or are two at once. A resumed run gives the same bytes, or is refused with a reason, and then a new run gives them. A trial that fails leaves the
directory as it was before --resume in fuzz_failures. Ends with status 1 if there was one.
"""

import argparse
import contextlib
import errno
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path

import bases
import oracle
from cases import prm_bytes
from fork_server import ForkServer

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scenes"))
from exemplar_runner import EXEMPLAR, results  # noqa: E402

SCENE = {**bases.SCENES[1], "Time/End": "0.12", "Output/Every": "2", "Output/Checkpoint minutes": "0",
         "Mesh/Surface": "surface.obj", "Output/Formats": "vtu, pc2"}
# the box's sides
SURFACE = "".join(f"v {x} {y} {z}\n" for x in (0, 2) for y in (-.5, .5) for z in (-.5, .5)) + (
    "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
CALLS = ["openat", "write", "pwrite64", "fsync", "fdatasync", "rename", "renameat", "renameat2", "unlink", "unlinkat", "mkdir",
         "rmdir", "ftruncate", "truncate", "close", "flock"]
RUN = ["scene.prm", "--output", "out", "--threads"]


class Trials:
    """One program, and what its run leaves when nobody disturbs it."""

    def __init__(self, program, library, seed):
        self.program, self.seed = os.path.abspath(program), seed
        self.server = ForkServer(self.program, library)
        with tempfile.TemporaryDirectory(prefix="fuzz") as holder:
            directory = self.prepare(Path(holder), False)
            begin = time.monotonic()
            status = self.end(directory).status
            self.seconds = time.monotonic() - begin
            if status:
                sys.exit(f"{program}: the undisturbed run ends with status {status}")
            self.whole = results(directory / "out")
            self.largest = max(file.stat().st_size for file in (directory / "out").iterdir())
        self.calls = self.system_calls() if shutil.which("strace") else []

    def prepare(self, directory, has_earlier):
        """A working directory with the scene, maybe with an earlier run of it in out."""
        (directory / "scene.prm").write_bytes(prm_bytes(SCENE.items()))
        (directory / "surface.obj").write_text(SURFACE)
        if has_earlier:
            self.end(directory)
        return directory

    def serve(self, directory, *more, threads="1", **keywords):
        """Start a run of the program server."""
        return self.server.start([*RUN, threads, *more], directory, oracle.environment(directory), **keywords)

    def end(self, directory, *more, run=None):
        """A run that is there, or a new one, to its end."""
        begin = time.monotonic()
        status, out, err = (run or self.serve(directory, *more)).end(60)
        return oracle.Ended(status, out, err, 0. if status >= 0 else time.monotonic() - begin)

    def under_strace(self, directory, log, *options):
        """How a run ended whose calls strace watched from main() on."""
        run = self.serve(directory, stands_still=True)
        with subprocess.Popen(["strace", "-f", "-qq", "-o", str(log), *options, "-p", str(run.pid)],
                              stderr=subprocess.DEVNULL) as tracer:
            run.wait_for_tracer(tracer)
            return self.end(directory, run=run)

    def start(self, directory, *more, threads="1", **keywords):
        """Start the program as it is called; what limits files would limit those that the server writes its words to, too."""
        streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
        return subprocess.Popen([self.program, *RUN, threads, *more], cwd=directory, env=oracle.environment(directory),
                                **{**streams, **keywords})

    def end_of_process(self, process):
        begin = time.monotonic()
        try:
            err = process.communicate(timeout=60)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            err = process.communicate()[1]
        return oracle.Ended(process.returncode, b"", err or b"", 0. if process.returncode >= 0 else time.monotonic() - begin)

    def system_calls(self):
        """[(name, how many of that name)] of all calls from the first one that concerns out, in a run that clears another."""
        with tempfile.TemporaryDirectory(prefix="fuzz") as holder:
            directory = self.prepare(Path(holder), True)
            log = directory / "log"
            try:
                if self.under_strace(directory, log, "-e", "trace=" + ",".join(CALLS)).status:
                    return []
            except RuntimeError:  # no right to it
                return []
            counts, found = defaultdict(int), []
            for line in log.read_text(errors="replace").splitlines():
                name = line.split(maxsplit=1)[1].split("(")[0]
                counts[name] += 1
                if name in CALLS and (found or '"out' in line):
                    found.append((name, counts[name]))
            return found

    def faults_of_results(self, directory):
        left = [file.name for file in (directory / "out").glob("*.tmp")]
        return oracle.faults_of_difference(directory / "out", self.whole) + [f"left: {', '.join(left)}"] * bool(left)

    def settle(self, directory):
        """--resume, and if that is refused a new run: the faults of what comes out."""
        ended = self.end(directory, "--resume")
        faults = [f"--resume: {fault}" for fault in oracle.faults_of_end(ended, allowed=(0, 1))]
        if ended.status == 1 and not faults:
            ended = self.end(directory)
            faults = [f"a new run: {fault}" for fault in oracle.faults_of_end(ended, allowed=(0,))]
        return faults or self.faults_of_results(directory)

    # the trials: (r, number of the trial, working directory) -> faults; some leave the directory for settle() by None

    def kill_at_moments(self, r, number, directory):
        self.prepare(directory, r.random() < 0.5)
        for more in [[], ["--resume"], ["--resume"]][:r.choice([1, 1, 2, 3])]:
            run = self.serve(directory, *more, threads=r.choice("12"))
            time.sleep(r.uniform(0, 1.1 * self.seconds))
            with contextlib.suppress(ProcessLookupError):
                os.kill(run.pid, signal.SIGKILL)
            run.end()

    def kill_at_calls(self, r, number, directory):
        self.prepare(directory, True)
        if number % 2:
            shutil.rmtree(directory / "out")
        name, count = self.calls[number * 7919 % len(self.calls)]  # evenly, and no two near in a row
        self.under_strace(directory, "/dev/null", "-e", "trace=" + name, "-e", f"inject={name}:signal=SIGKILL:when={count}")

    def interrupt(self, r, number, directory):
        self.prepare(directory, r.random() < 0.3)
        before = oracle.tree(directory)
        run = self.serve(directory, threads=r.choice("12"))
        time.sleep(r.uniform(0, 1.1 * self.seconds))
        sent = r.choice([signal.SIGINT, signal.SIGTERM])
        with contextlib.suppress(ProcessLookupError):
            os.kill(run.pid, sent)
        ended = self.end(directory, run=run)
        if ended.status == -sent:  # before the program was there
            return [] if oracle.tree(directory) == before else ["killed by the signal, but had written"]
        return oracle.faults_of_end(ended, allowed=(0, 130)) or None

    def full_disk(self, r, number, directory):
        self.prepare(directory, r.random() < 0.3)
        size = r.choice([0, 1, 100, r.randrange(self.largest), r.randrange(self.largest)])
        process = self.start(directory, threads=r.choice("12"),
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
        return oracle.faults_of_end(self.end_of_process(process)) or None

    def streams(self, r, number, directory):
        """Closed or broken streams change nothing."""
        self.prepare(directory, False)
        closed = r.choice([[], [0], [1], [2], [0, 1], [1, 2], [0, 1, 2]])
        out = r.choice([subprocess.DEVNULL, "/dev/full", "broken"])
        keywords = {}
        if out == "/dev/full":
            keywords = {"stdout": open(out, "wb"), "stderr": open(out, "wb")}
        elif out == "broken":
            read, write = os.pipe()
            os.close(read)
            keywords = {"stdout": write, "stderr": write}

        def close():
            signal.signal(signal.SIGPIPE, signal.SIG_DFL)
            for descriptor in closed:
                os.close(descriptor)

        process = self.start(directory, *r.choice([[], ["--verbose"]]), preexec_fn=close, **keywords)
        status = self.end_of_process(process).status
        for stream in keywords.values():
            try:
                stream.close() if hasattr(stream, "close") else os.close(stream)
            except OSError as error:
                assert error.errno == errno.EBADF  # the pipe's is there twice
        return [f"closed {closed}, output to {out}: status {status}"] if status else self.faults_of_results(directory)

    def two_runs(self, r, number, directory):
        """In one directory at once: the second waits for no one and harms no one."""
        has_earlier = r.random() < 0.5
        self.prepare(directory, has_earlier)
        processes = []
        for _ in range(2):
            processes.append(self.start(directory, *r.choice([[], ["--resume"]] if has_earlier else [[]])))
            time.sleep(r.choice([0, r.uniform(0, self.seconds)]))
        ends = [self.end_of_process(process) for process in processes]
        faults = [fault for ended in ends for fault in oracle.faults_of_end(ended, allowed=(0, 1))]
        if all(ended.status for ended in ends):
            faults.append("both were refused")
        return faults or self.faults_of_results(directory)

    def trial(self, name, number, keep):
        r = random.Random(f"{self.seed} {name} {number}")
        with tempfile.TemporaryDirectory(prefix="fuzz") as holder:
            directory, state = Path(holder) / "run", Path(holder) / "state"
            directory.mkdir()
            faults = getattr(self, name)(r, number, directory)
            shutil.copytree(directory, state)
            if faults is None:
                faults = self.settle(directory)
            if faults:
                place = Path(keep) / f"kills{self.seed}_{name}_{number}"
                shutil.rmtree(place, ignore_errors=True)
                shutil.copytree(state, place)
        return faults


# of 20 trials
SHARES = ["kill_at_calls"] * 8 + ["kill_at_moments"] * 6 + ["interrupt"] * 2 + ["full_disk"] * 2 + ["streams", "two_runs"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--kills", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", default=EXEMPLAR)
    parser.add_argument("--fork-server", help="library of fork_server.cc; that of the program's build without it")
    parser.add_argument("--trial", choices=sorted(set(SHARES)), help="this one alone")
    parser.add_argument("--keep", default="fuzz_failures")
    options = parser.parse_args()

    library = options.fork_server or Path(options.program).resolve().parent / "tests/libfork_server.so"
    trials = Trials(options.program, str(library), options.seed)
    names = [options.trial] if options.trial else SHARES if trials.calls else [name for name in SHARES if name != "kill_at_calls"]
    done, failed = Counter(), 0
    for i in range(options.kills):
        name = names[i * 7 % len(names)]
        faults = trials.trial(name, done[name], options.keep)
        if faults:
            failed += 1
            print(f"{name} {done[name]}: {'; '.join(faults)}", flush=True)
        done[name] += 1
    trials.server.close()
    print(f"{failed} of {options.kills} failed: " + ", ".join(f"{name} {n}" for name, n in done.items()))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
