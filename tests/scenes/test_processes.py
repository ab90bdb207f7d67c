# SPDX-License-Identifier: GPL-3.0-or-later
"""Two runs in one directory, standard streams that are closed, full or broken, and signals at any time."""

import itertools
import os
import signal
import subprocess
import time
import unittest

from exemplar_runner import (BAR, EXEMPLAR, SceneTest, needs_trilinos, own_words, prm, read_csv, read_summary, results,
                             wait_until)
from process_table import handles

DYNAMIC = {**BAR, "Scene": "dynamic", "Time/Increments": None, "Material/Young's modulus": "1e4", "Time/Step": "0.01", "Time/End": "0.1"}
ENDLESS = {**DYNAMIC, "Time/Step": "1e-9", "Output/Every": "1000", "Output/Checkpoint minutes": "0"}
BUSY = "Another run is writing into the output directory out. Wait for its end or stop it. Give another one by "
BEFORE = "exemplar: Interrupted before a run had begun.\n"


signal.signal(signal.SIGHUP, signal.SIG_DFL)  # whoever starts the tests in the background may have it ignored, and programs inherit that
os.environ["UCX_DEBUG_SIGNO"] = "SIGUSR2"  # UCX, which Open MPI 5 loads, swallows SIGHUP until the program has its own handler


class ProcessTest(SceneTest):
    def start(self, *arguments, **how):
        process = subprocess.Popen([EXEMPLAR, *arguments], cwd=self.directory, text=True,
                                   **{"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL,
                                      "stderr": subprocess.PIPE, **how})
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def result_of(self, process):
        """Its status and what it says on stderr."""
        said = process.communicate(timeout=300)[1]
        return process.returncode, own_words(said) if said else said

    def rows(self, output="out"):
        file = self.directory / output / "statistics.csv"
        try:
            return file.read_bytes().count(b"\n")
        except FileNotFoundError:  # not there yet, or being cleared
            return 0

    def tree(self):
        return {file: file.read_bytes() if file.is_file() else None for file in self.directory.rglob("*")}


class TwoRuns(ProcessTest):
    def start_endless(self, *arguments):
        """Start a run that would take years; return when it makes steps."""
        earlier = self.rows() if "--resume" in arguments else 0
        process = self.start("scene.prm", "--output", "out", "--quiet", *arguments)
        wait_until(lambda: self.rows() > earlier + 3, process)
        return process

    def refuse_all(self):
        for arguments in ((), ("--resume",)):
            run = self.call("scene.prm", "--output", "out", "--quiet", *arguments)
            self.assertEqual((run.status, run.stdout), (1, ""))
            self.assertTrue(run.stderr.startswith("exemplar: " + BUSY), run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1)

    def test_the_second_is_refused(self):
        self.write("scene.prm", prm(ENDLESS))
        first = self.start_endless()
        self.refuse_all()
        first.send_signal(signal.SIGINT)
        self.assertEqual(self.result_of(first)[0], 130)
        summary, rows = read_summary(self.directory / "out"), read_csv(self.directory / "out")
        self.assertEqual([row["step"] for row in rows], list(range(summary["steps"] + 1)))

        # the same while a resumed one lives; what it leaves when it is killed hurts nobody
        second = self.start_endless("--resume")
        self.refuse_all()
        second.kill()
        self.assertEqual(self.result_of(second)[0], -signal.SIGKILL)
        self.write("scene.prm", prm(DYNAMIC))
        self.solve(DYNAMIC)
        self.assertEqual(results(self.directory / "out"), results(self.solve(DYNAMIC, output="whole")))
        self.assertEqual({file.name for file in (self.directory / "out").iterdir()},
                         {file.name for file in (self.directory / "whole").iterdir()})

    def test_started_at_once(self):
        self.write("scene.prm", prm(ENDLESS))
        for _ in range(3):
            both = [self.start("scene.prm", "--output", "out", "--quiet") for _ in range(2)]
            wait_until(lambda: any(process.poll() is not None for process in both))
            refused, alive = sorted(both, key=lambda process: process.poll() is None)
            status, message = self.result_of(refused)
            self.assertEqual(status, 1)
            self.assertIn(BUSY, message)
            wait_until(lambda: self.rows() > 3, alive)
            alive.send_signal(signal.SIGTERM)
            self.assertEqual(self.result_of(alive)[0], 130)
            rows = read_csv(self.directory / "out")
            self.assertEqual([row["step"] for row in rows], list(range(len(rows))))

    def test_a_directory_that_is_replaced(self):
        # the first run's directory goes, and a second run has another one under the same name
        whole = results(self.solve(DYNAMIC, output="whole"))
        self.write("scene.prm", prm(ENDLESS))
        first = self.start_endless()
        os.kill(first.pid, signal.SIGSTOP)
        (self.directory / "out").rename(self.directory / "old")
        self.assertEqual(results(self.solve(DYNAMIC, file="second.prm")), whole)
        os.kill(first.pid, signal.SIGCONT)
        status, message = self.result_of(first)
        self.assertEqual(status, 2)
        self.assertRegex(message, "^exemplar: (The output directory out has been removed or replaced|Cannot replace out/)")
        self.assertEqual(results(self.directory / "out"), whole)


class Streams(ProcessTest):
    def setUp(self):
        super().setUp()
        self.whole = results(self.solve(DYNAMIC, output="whole"))
        self.files = {file.name for file in (self.directory / "whole").iterdir()}

    def check(self, status, output):
        self.assertEqual(status, 0)
        self.assertEqual(results(output), self.whole)
        self.assertEqual({file.name for file in output.iterdir()}, self.files)

    def close_and_run(self, descriptors, *arguments):
        """The status of the program that is called with some of its streams closed."""

        def close():
            for descriptor in descriptors:
                os.close(descriptor)

        return subprocess.run([EXEMPLAR, *arguments], cwd=self.directory, check=False, timeout=300, preexec_fn=close,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE).returncode

    def test_closed(self):
        self.write("scene.prm", prm(DYNAMIC))
        for closed in itertools.chain.from_iterable(itertools.combinations(range(3), n) for n in (1, 2, 3)):
            for threads in ("1", "2"):
                with self.subTest(closed=closed, threads=threads):
                    self.check(self.close_and_run(closed, "scene.prm", "--output", "out", "--verbose", "--threads",
                                                  threads), self.directory / "out")

    def test_closed_with_warnings_and_errors(self):
        self.write("scene.prm", prm({**DYNAMIC, "Handles/left/Motion": "0; 0; min(1, 0/t)"}))
        warned = {**DYNAMIC, "Handles/left/Motion": "(x-1)*(cos(3*t)-1) - z*sin(3*t); 0; (x-1)*sin(3*t) + z*(cos(3*t)-1)",
                  "Time/End": "0.02"}
        self.write("warned.prm", prm(warned))
        self.write("bad.prm", prm({**DYNAMIC, "Scene": "x"}))
        self.assertEqual(self.close_and_run((1, 2), "bad.prm", "--output", "bad"), 1)
        self.assertFalse((self.directory / "bad").exists())
        self.assertEqual(self.close_and_run((1, 2), "warned.prm", "--output", "out"), 0)
        self.assertEqual(results(self.directory / "out"), results(self.solve_loudly(warned)))

    def solve_loudly(self, scene):
        run = self.attempt(scene, output="loud")
        self.assertEqual(run.status, 0)
        return run.output

    def test_closed_in_a_study(self):
        self.write("scene.prm", prm(DYNAMIC))
        self.write("study.prm", prm({"Scene": "scene.prm", "Vary": "Time/Step: 0.05 0.1", "Repeats": "1"}))
        self.assertEqual(self.close_and_run((0, 1, 2), "study", "study.prm", "--output", "out"), 0)
        for name in ("study.csv", "study.md", "study.prm"):
            self.assertNotIn("The tables are in", (self.directory / "out" / name).read_text())
        self.assertEqual(len((self.directory / "out/study.csv").read_text().splitlines()), 3)

    def test_full(self):
        self.write("scene.prm", prm(DYNAMIC))
        with open("/dev/full", "w", encoding="ascii") as full:
            process = self.start("scene.prm", "--output", "out", "--verbose", stdout=full, stderr=full)
            self.result_of(process)
        self.check(process.returncode, self.directory / "out")

    def test_what_is_printed_is_whole_or_an_error(self):
        for arguments in (["--print-parameters"], ["study", "--print-parameters"], ["verify", "--list"]):
            with self.subTest(arguments), open("/dev/full", "w", encoding="ascii") as full:
                status, message = self.result_of(self.start(*arguments, stdout=full))
                self.assertEqual(status, 1)
                self.assertRegex(message, r"\Aexemplar: Standard output cannot be written[^\n]*\n\Z")
                done = subprocess.run(["bash", "-c", '"$0" "$@" | true; exit ${PIPESTATUS[0]}', EXEMPLAR, *arguments],
                                      cwd=self.directory, check=False, stderr=subprocess.PIPE, timeout=300)
                self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_a_reader_that_goes_away(self):
        self.write("scene.prm", prm(DYNAMIC))
        for redirect in ("| head -1", "2>&1 | head -1", "| true"):
            with self.subTest(redirect):
                done = subprocess.run(
                    ["bash", "-c", f'"$0" scene.prm --output out --verbose {redirect}; exit ${{PIPESTATUS[0]}}', EXEMPLAR],
                    cwd=self.directory, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=300)
                self.assertEqual(done.stderr, b"")
                self.check(done.returncode, self.directory / "out")

    def test_a_reader_that_goes_away_from_what_fails(self):
        limit = {**DYNAMIC, "Solver/Method": "fixed point", "Solver/Maximum iterations": "1", "Solver/Tolerance": "1e-14"}
        for scene, status in ((limit, 2), ({**DYNAMIC, "Scene": "x"}, 1)):
            self.write("scene.prm", prm(scene))
            done = subprocess.run(
                ["bash", "-c", '"$0" scene.prm --output out --verbose 2>&1 | true; exit ${PIPESTATUS[0]}', EXEMPLAR],
                cwd=self.directory, check=False, timeout=300)
            self.assertEqual(done.returncode, status)


class Signals(ProcessTest):
    def interrupt(self, which, *arguments, **how):
        """Send a signal as soon as the program can know what to do; its status and what it says."""
        process = self.start(*arguments, **how)
        wait_until(lambda: handles(process.pid, which), process)
        process.send_signal(which)
        return self.result_of(process)

    def test_before_the_first_step(self):
        self.write("scene.prm", prm({**DYNAMIC, "Mesh/Box cells": "60, 60, 60"}))
        self.write("study.prm", prm({"Scene": "scene.prm", "Vary": "Time/Step: 0.05 0.1"}))
        before = self.tree()
        for which in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for arguments in (["scene.prm"], ["scene.prm", "--validate"], ["study", "study.prm"]):
                with self.subTest(which=which, arguments=arguments):
                    self.assertEqual(self.interrupt(which, *arguments), (130, BEFORE))
                    self.assertEqual(self.tree(), before)

    def test_reference_cases(self):
        self.assertEqual(self.interrupt(signal.SIGINT, "verify"), (130, BEFORE))

    def test_at_any_time(self):
        # with handlers from the first moment on, no time is left at which the status is another
        scene = {**DYNAMIC, "Mesh/Box cells": "12, 6, 6", "Time/End": "0.3", "Output/Every": "1"}
        whole = results(self.solve(scene, output="whole"))
        for i in range(12):
            process = self.start("scene.prm", "--output", "out", "--quiet")
            wait_until(lambda: handles(process.pid, signal.SIGINT), process)
            time.sleep(0.03 * i)
            process.send_signal(signal.SIGINT)
            status, message = self.result_of(process)
            if (status, message) == (130, BEFORE):
                continue
            if status != 0:
                self.assertRegex(message, r"^exemplar: Interrupted after step \d+\. Go on with --resume\.\n$")
                self.assertEqual(status, 130)
            self.solve(scene, "--resume")
            self.assertEqual(results(self.directory / "out"), whole)

    def test_a_second_signal(self):
        # the first iteration of a large body takes a while
        self.write("scene.prm", prm({**DYNAMIC, "Mesh/Box cells": "24, 24, 24", "Output/Every": "0"}))
        process = self.start("scene.prm", "--output", "out", "--quiet")
        wait_until(lambda: (self.directory / "out/checkpoint.bin").exists(), process)
        process.send_signal(signal.SIGINT)
        time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        status, message = self.result_of(process)
        self.assertEqual(status, 130)
        self.assertRegex(message, "^exemplar: Interrupted .*--resume")

    def test_hangup(self):
        self.write("scene.prm", prm(ENDLESS))
        process = self.start("scene.prm", "--output", "out", "--quiet")
        wait_until(lambda: self.rows() > 3, process)
        process.send_signal(signal.SIGHUP)
        status, message = self.result_of(process)
        self.assertEqual(status, 130)
        self.assertRegex(message, "^exemplar: Interrupted after step ")

        # nohup has it ignored
        process = self.start("scene.prm", "--output", "out", "--quiet",
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        wait_until(lambda: self.rows() > 3, process)
        rows = self.rows()
        process.send_signal(signal.SIGHUP)
        wait_until(lambda: self.rows() > rows + 3, process)


class Surroundings(ProcessTest):
    def without(self, folder, *command):
        """Run a command where a folder of the system is empty; skip the test where that cannot be had."""
        hide = f'mount -t tmpfs none {folder} && exec "$@"'
        for kind in (["unshare", "-m"], ["unshare", "-rm"]):
            try:
                subprocess.run([*kind, "sh", "-c", hide, "sh", "true"], check=True, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
            except (OSError, subprocess.CalledProcessError):
                continue
            return subprocess.run([*kind, "sh", "-c", hide, "sh", *command], cwd=self.directory, check=False, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
        return self.skipTest("no right to hide a folder here")

    @needs_trilinos
    def test_without_sys(self):
        self.write("scene.prm", prm({**BAR, "Solver/Linear solver": "iterative"}))
        done = self.without("/sys", EXEMPLAR, "scene.prm", "--output", "out", "--quiet")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_what_others_say_is_no_word_of_ours(self):
        ours = "exemplar: a message\n"
        self.assertEqual(own_words(ours), ours)
        self.assertEqual(own_words(""), "")


if __name__ == "__main__":
    unittest.main()
