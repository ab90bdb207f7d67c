# SPDX-License-Identifier: GPL-3.0-or-later
"""Several processes under mpirun that fail, are killed or interrupted: no hang, one message, one status, and what was computed is good.

That all processes are told the same of a wrong scene, and of all kinds of those, is held by tests/mpi/refusals_test.cc in one start.
"""

import contextlib
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

from exemplar_runner import EXEMPLAR, Run, SceneTest, has_trilinos, messages_in, prm, read_csv, read_summary, results, without_what_is_meant, wait_until
from mpirun import mpi_environment
from process_table import children, file_of, handles, is_alive

BODY = {
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "6, 3, 3",
    "Material/Young's modulus": "1e4",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Loads/Gravity": "0, 0, -1",
    "Output/Checkpoint minutes": "0",
}
STATIC = {**BODY, "Scene": "static", "Time/Increments": "2"}
DYNAMIC = {**BODY, "Scene": "dynamic", "Time/Increments": None, "Time/Step": "0.01", "Time/End": "0.2", "Output/Every": "8"}
LAST_STEP = 20
ENDLESS = {**DYNAMIC, "Time/Step": "1e-8", "Output/Every": "1000"}
FAILING = {**STATIC, "Loads/Gravity": "0, 0, -1e9", "Solver/Maximum iterations": "1", "Time/Increments": "1"}

# One process is started by this shell script instead, with the same arguments.
ONE_BY_SCRIPT = 'if [ "$OMPI_COMM_WORLD_RANK" = {} ]; then {}; fi; exec "$0" "$@"'


def needs_mpi(test):
    return unittest.skipUnless(has_trilinos() and shutil.which("mpirun"), "needs Trilinos and mpirun")(test)


@needs_mpi
class MpiTest(SceneTest):
    n = 2  # processes
    whole = None  # what a run of DYNAMIC leaves that nothing happens to

    def start(self, *arguments, launcher=(), script=None):
        process = subprocess.Popen([*(launcher or ["mpirun", "-n", str(self.n)]), *(["sh", "-c", script] if script else []), EXEMPLAR,
                                    *map(str, arguments)], cwd=self.directory, text=True, env=mpi_environment(),
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        if process.poll() is None:
            for rank in self.ranks(process):
                os.kill(rank, signal.SIGKILL)
            process.kill()
        process.communicate()

    def result_of(self, process):
        """What it says ends within a minute."""
        stdout, stderr = process.communicate(timeout=60)
        return Run(process.returncode, stdout, stderr, self.directory / "out")

    def run_all(self, scene, *arguments, output="out", **how):
        self.write("scene.prm", prm(scene))
        return self.result_of(self.start("scene.prm", "--output", output, *arguments, **how))

    def solve_all(self, scene, *arguments, **how):
        run = self.run_all(scene, *arguments, **how)
        self.assertEqual((run.status, self.messages(run)), (0, []), run.stderr)
        return run.output

    def messages(self, run):
        return [line[len("exemplar: "):] for line in messages_in(run.stderr) if line.startswith("exemplar: ")]

    def check_end(self, run, status, message, of=None):
        """One message of ours, of all processes or of one that has failed alone."""
        said = self.messages(run)
        self.assertEqual(len(said), 1, run.stderr)
        self.assertRegex(said[0], message)
        places = [] if of is None else [str(of)]
        self.assertEqual(re.findall(f" [(]process ([0-9]+) of {self.n}, on .*[)]$", said[0]), places, said[0])
        self.assertEqual(run.status, status, run.stderr)

    def refuse(self, scene, message, *arguments, of=None, **how):
        """Refused with nothing written."""
        run = self.run_all(scene, *arguments, **how)
        self.check_end(run, 1, message, of)
        self.assertFalse((self.directory / "out").exists())

    def ranks(self, process):
        """Ids of the processes that mpirun has started, in their order."""
        found = {}
        for child in children(process.pid):
            if number := re.search(r"\0OMPI_COMM_WORLD_RANK=(\d+)\0", file_of(child, "environ")):
                found[int(number[1])] = child
        return [found[number] for number in sorted(found)]

    def all_take(self, process, how):
        """Whether no process would end by the signal."""
        ranks = self.ranks(process)
        return len(ranks) == self.n and all(handles(rank, how) for rank in ranks)

    def rows(self):
        try:
            return (self.directory / "out/statistics.csv").read_bytes().count(b"\n")
        except FileNotFoundError:
            return 0

    def start_and_wait(self, scene, *arguments, rows=6, **how):
        """Start a run; return when it has made steps."""
        self.write("scene.prm", prm(scene))
        process = self.start("scene.prm", "--output", "out", "--quiet", *arguments, **how)
        wait_until(lambda: self.rows() >= rows, process, seconds=60)
        return process

    def stop_in_the_middle(self):
        """A run of DYNAMIC whose processes all stand still after some steps and before the last; these processes."""
        while True:
            process = self.start_and_wait(DYNAMIC)
            ranks = self.ranks(process)
            with contextlib.suppress(ProcessLookupError):
                for rank in ranks:
                    os.kill(rank, signal.SIGSTOP)
            if len(ranks) == self.n and self.rows() < LAST_STEP:
                return process, ranks
            self.end(process)  # a busy machine has let this one come too near to its end
            shutil.rmtree(self.directory / "out")

    def go_on(self, ranks):
        for rank in ranks:
            os.kill(rank, signal.SIGCONT)

    def check_resumed(self):
        """What is in out goes on to the bytes of a run that nothing happened to; then remove it."""
        resumed = results(self.solve_all(DYNAMIC, "--resume"))
        shutil.rmtree(self.directory / "out")
        if MpiTest.whole is None:
            MpiTest.whole = results(self.solve_all(DYNAMIC))
            shutil.rmtree(self.directory / "out")
        self.assertEqual(resumed, MpiTest.whole)


class Start(MpiTest):
    def test_one_process_is_as_without_mpirun(self):
        without = results(self.solve(DYNAMIC, output="without"))
        self.assertEqual(results(self.solve_all(DYNAMIC, launcher=["mpirun", "-n", "1"])), without)

    def test_one_process_that_fails_says_so_alone(self):
        alone = {"launcher": ["mpirun", "-n", "1"]}
        for scene, status, message in (({**STATIC, "Scene": "x"}, 1, "^scene.prm:[0-9]+: Scene"), (FAILING, 2, "^Step 1 stopped"),
                                       ({**FAILING, "Solver/Linear solver": "iterative"}, 2, "^Step 1 stopped")):
            run = self.run_all(scene, "--quiet", **alone)
            self.assertEqual((run.status, len(without_what_is_meant(run.stderr.splitlines()))), (status, 1), run.stderr)
            self.check_end(run, status, message)
        # mpirun lives on with who has started the program
        run = self.run_all({**STATIC, "Scene": "x"}, script='"$0" "$@"; echo "status $?"; exit 0', **alone)
        self.assertEqual((run.status, run.stdout), (0, "status 1\n"), run.stderr)

    def test_commands_for_one_process(self):
        self.write("scene.prm", prm(STATIC))
        for arguments, name in ((["study", "study.prm"], "exemplar study"),
                                (["mesh", "--surface", "a.obj", "--cells", "100", "--output", "a.msh"], "exemplar mesh"),
                                (["pose", "--mesh", "a.msh", "--rest", "a.obj", "--pose", "b.obj", "--output", "out"],
                                 "exemplar pose"),
                                (["scene.prm", "--validate"], "--validate"), (["--print-parameters"], "--print-parameters")):
            with self.subTest(name):
                run = self.result_of(self.start(*arguments))
                self.check_end(run, 1, f"^{name} cannot be done by several processes. Call it without mpirun.$")
                self.assertEqual(run.stdout, "")

    def test_version_is_said_once(self):
        run = self.result_of(self.start("--version"))
        self.assertEqual((run.status, run.stdout.count("\n"), messages_in(run.stderr)), (0, 1, []))

    def test_another_program(self):
        other = self.directory / "other"
        shutil.copy(EXEMPLAR, other)
        with open(other, "ab") as file:
            file.write(b"\n")  # still the same program, but not the same bytes
        self.refuse(STATIC, "^Process 1 of 2 is another program than process 0. Install the same exemplar .* on all machines.$",
                    script=ONE_BY_SCRIPT.format(1, f'exec "{other}" "$@"'))

    def test_other_arguments(self):
        self.refuse(STATIC, "^Process 1 of 2 was given other arguments than process 0. Start all by one command: mpirun -n 2",
                    script=ONE_BY_SCRIPT.format(1, 'exec "$0" "$@" --verbose'))

    def test_another_scene_behind_the_same_name(self):
        (self.directory / "elsewhere").mkdir()
        self.write("elsewhere/scene.prm", prm({**STATIC, "Loads/Gravity": "0, 0, -2"}))
        self.refuse(STATIC, "^Process 1 of 2 reads another scene than process 0. Let all machines see the same files.$",
                    script=ONE_BY_SCRIPT.format(1, "cd elsewhere"))

    def test_a_scene_that_one_process_cannot_read(self):
        self.refuse(STATIC, r"^scene.prm: cannot be read \(", of=1,
                    script=ONE_BY_SCRIPT.format(1, "cd /"))

    def test_another_mpi_library(self):
        # as MPICH's mpiexec would start it
        for rank in range(2):
            run = self.call("nothing.prm", PMI_SIZE="2", PMI_RANK=str(rank))
            self.assertEqual(run.status, 1)
            if rank == 0:
                self.check_end(run, 1, "^mpiexec has started 2 processes that do not find each other: it belongs to another "
                                       "MPI library than exemplar, which uses Open MPI v")
            else:
                self.assertEqual(run.stderr, "")

    def test_srun_without_mpi(self):
        run = self.call("nothing.prm", SLURM_STEP_NUM_TASKS="2", SLURM_PROCID="0")
        self.check_end(run, 1, "^srun has started 2 processes that do not find each other: it does not prepare them for MPI.")
        run = self.call("nothing.prm", SLURM_STEP_NUM_TASKS="2", SLURM_PROCID="1")
        self.assertEqual((run.status, run.stderr), (1, ""))
        self.write("scene.prm", prm(STATIC))
        run = self.call("scene.prm", SLURM_STEP_NUM_TASKS="2", SLURM_PROCID="0", SLURM_PTY_PORT="1")  # a shell of srun --pty
        self.assertEqual((run.status, without_what_is_meant(run.stderr.splitlines())), (0, []))


class Input(MpiTest):
    def test_bad_scene(self):
        self.refuse({**STATIC, "Scene": "x"}, "^scene.prm:[0-9]+: Scene")

    def test_a_mesh_that_the_root_cannot_read(self):
        self.refuse({**STATIC, "Mesh/Generator": None, "Mesh/File": "nothing.msh", "Mesh/Box size": None, "Mesh/Box cells": None},
                    "nothing.msh")

    def test_directories(self):
        self.write("file", "")
        self.check_end(self.run_all(STATIC, output="file/out"), 1, "file")
        self.write("scene.prm", prm(ENDLESS))
        self.start_and_wait(ENDLESS)
        run = self.result_of(self.start("scene.prm", "--output", "out"))
        self.check_end(run, 1, "^Another run is writing into the output directory out.")

    def test_damaged_checkpoint(self):
        output = self.solve_all(STATIC)
        whole = results(output)
        checkpoint = output / "checkpoint.bin"
        data = bytearray(checkpoint.read_bytes())
        data[len(data) // 2] ^= 1
        checkpoint.write_bytes(data)
        self.check_end(self.run_all({**STATIC, "Time/Increments": "2"}, "--resume"), 1, "checkpoint")
        self.assertEqual(results(output), whole)

    def test_numbers_that_fail_in_all_processes(self):
        run = self.run_all(FAILING)
        self.check_end(run, 2, "^Step 1 stopped at its iteration limit")
        self.assertTrue((run.output / "summary.json").exists())


class Death(MpiTest):
    n = 3  # a middle one has two neighbours

    def test_killed(self):
        for killed in range(self.n):
            with self.subTest(killed=killed):
                process, ranks = self.stop_in_the_middle()
                os.kill(ranks[killed], signal.SIGKILL)
                self.go_on(ranks)
                run = self.result_of(process)
                self.assertEqual((run.status, self.messages(run)), (128 + signal.SIGKILL, []))
                self.assertRegex(run.stderr, f"process rank {killed} .* exited on signal 9")  # by mpirun
                self.check_resumed()

    def test_full_disk(self):
        for number in (0, 1):  # of the first process and of one that writes pieces of frames alone
            with self.subTest(number=number):
                process, ranks = self.stop_in_the_middle()
                resource.prlimit(ranks[number], resource.RLIMIT_FSIZE, (2000, 2000))
                self.go_on(ranks)
                run = self.result_of(process)
                said = self.messages(run)
                self.assertEqual((run.status, len(said)), (2, 1), run.stderr)
                # the first process writes the table of steps, too
                self.assertRegex(said[0], r"out/.*: File too large|File too large.*out/|out/.* cannot be written; is the disk full"
                                 if number == 0 else "process_0001.vtu")
                self.check_resumed()

    def test_replaced_directory(self):
        scene = {**DYNAMIC, "Time/End": "1000", "Output/Every": "1", "Output/Keep states": "true"}
        for processes, moments in ((self.n, 4), (1, 2)):
            for moment in range(moments):
                with self.subTest(processes=processes, moment=moment):
                    process = self.start_and_wait(scene, launcher=["mpirun", "-n", str(processes)])
                    time.sleep(0.007 * moment)
                    (self.directory / "out").rename(self.directory / "moved")
                    (self.directory / "out").mkdir()
                    run = self.result_of(process)
                    said = self.messages(run)
                    self.assertEqual((run.status, len(said)), (2, 1), run.stderr)
                    self.assertRegex(said[0], "has been removed or replaced while")
                    self.assertEqual(list((self.directory / "out").iterdir()), [])
                    for name in ("out", "moved"):
                        shutil.rmtree(self.directory / name)

    def test_memory(self):
        # enough to start, not enough for the matrix: a library ends the program, or this throws
        big = {**STATIC, "Mesh/Box cells": "60, 30, 30", "Time/Increments": "1"}
        for kib in (750000, 1000000):
            with self.subTest(kib):
                run = self.run_all(big, script=ONE_BY_SCRIPT.format(1, f"ulimit -v {kib}"))
                self.assertEqual(len(self.messages(run)), 1, run.stderr)
                self.assertIn("memory", self.messages(run)[0])
                self.assertEqual(run.status, 2, run.stderr)

    def test_interrupted(self):
        """SIGUSR1, which mpirun passes on and then waits for."""
        process, ranks = self.stop_in_the_middle()
        process.send_signal(signal.SIGUSR1)
        self.go_on(ranks)
        self.check_end(self.result_of(process), 130, r"^Interrupted after step \d+\. Go on with --resume\.$")
        self.assertEqual(read_summary(self.directory / "out")["status"], "interrupted")
        self.check_resumed()

    def test_one_interrupted(self):
        for number, how in ((0, signal.SIGINT), (1, signal.SIGTERM), (2, signal.SIGXCPU)):
            with self.subTest(number=number, how=how):
                process = self.start_and_wait(ENDLESS)
                os.kill(self.ranks(process)[number], how)
                self.check_end(self.result_of(process), 130, r"^Interrupted after step \d+\. Go on with --resume\.$")
                rows = read_csv(self.directory / "out")
                self.assertEqual([row["step"] for row in rows], list(range(len(rows))))
                shutil.rmtree(self.directory / "out")

    def test_interrupted_before_the_first_step(self):
        # it waits for the run, which then ends at once
        self.write("scene.prm", prm({**ENDLESS, "Mesh/Box cells": "24, 12, 12"}))
        process = self.start("scene.prm", "--output", "out", "--quiet")
        wait_until(lambda: self.all_take(process, signal.SIGUSR1), process)
        process.send_signal(signal.SIGUSR1)
        self.check_end(self.result_of(process), 130, r"^Interrupted after step \d+\. Go on with --resume\.$")

    def test_mpirun_interrupted(self):
        """Its own status is 1. It leaves the processes a second, which is enough for a small body."""
        for how in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(how):
                process, ranks = self.stop_in_the_middle()
                process.send_signal(how)
                self.go_on(ranks)
                run = self.result_of(process)
                self.assertEqual(run.status, 1)
                self.assertLessEqual(len(self.messages(run)), 1, run.stderr)
                wait_until(lambda: not any(map(is_alive, ranks)), seconds=20)
                self.check_resumed()

    def test_mpirun_killed(self):
        process = self.start_and_wait(ENDLESS)
        ranks = self.ranks(process)
        process.kill()
        process.communicate(timeout=60)
        wait_until(lambda: not any(map(is_alive, ranks)), seconds=20)

    def test_interrupted_twice(self):
        process = self.start_and_wait({**ENDLESS, "Mesh/Box cells": "24, 12, 12"}, rows=3)
        os.kill(self.ranks(process)[1], signal.SIGSTOP)  # so that nobody gets on
        root = self.ranks(process)[0]
        os.kill(root, signal.SIGTERM)
        time.sleep(0.2)
        os.kill(root, signal.SIGTERM)
        self.check_end(self.result_of(process), 130, "^Interrupted again, and ended at once.")


if __name__ == "__main__":
    unittest.main()
