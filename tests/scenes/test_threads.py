# SPDX-License-Identifier: GPL-3.0-or-later
"""With one thread, and with two, of which one writes frames while the next step is computed."""

import glob
import os
import resource
import shutil
import signal
import subprocess
import unittest
from pathlib import Path

from exemplar_runner import EXEMPLAR, SceneTest, prm, read_csv, read_pvd, read_summary, results, wait_until

# a frame a step, which takes about as long to write as the step to compute
BOX = {
    "Scene": "dynamic",
    "Mesh/Generator": "box",
    "Mesh/Box size": "2, 1, 1",
    "Mesh/Box cells": "8, 4, 4",
    "Material/Young's modulus": "1e4",
    "Material/Density": "10",
    "Examples/Pose functions": "1.3*x; y; z",
    "Solver/Method": "one pass",
    "Model/Gradient": "frozen",
    "Handles/Names": "left",
    "Handles/left/Select": "boundary 1",
    "Handles/left/Motion": "0; 0; 0.1*sin(6*t)",
    "Loads/Gravity": "0, 0, -9.81",
    "Time/Step": "0.01",
    "Time/End": "0.3",
}
# nothing moves before t = 0.1, then one iteration is not enough
FAILING = {**BOX, "Loads/Gravity": None, "Solver/Method": "fixed point",
           "Examples/Pose functions": None, "Solver/Maximum iterations": "1",
           "Handles/left/Motion": "0; 0; max(0, t-0.1)"}
# large enough that loops, factors and solves are shared by threads
LARGE = {**BOX, "Mesh/Box cells": "24, 12, 12", "Time/End": "0.03", "Output/Every": "0", "Solver/Method": "quasi newton",
         "Model/Gradient": "consistent"}
BOTH = (["--threads", "1"], ["--threads", "2"])
EACH_STEP = ["--set", "Output/Checkpoint minutes=0"]


def frame(step):
    return f"frame_{step:04}.vtu"


def frames(output):
    return sorted(file.name for file in output.glob("frame_*"))


class Threads(SceneTest):
    def assert_same(self, found, expected):
        self.assertEqual(found["statistics.csv"], expected["statistics.csv"])
        self.assertEqual(found.keys(), expected.keys())
        self.assertEqual([name for name in found if found[name] != expected[name]], [])

    def test_same_bytes(self):
        whole = results(self.solve(BOX, "--threads", "1", output="one"))
        self.assertEqual(len(whole), 31 + 3)
        for threads in ("2", "5"):
            output = self.solve(BOX, "--threads", threads)
            self.assert_same(results(output), whole)
            self.assertEqual(read_summary(output)["threads"], int(threads))
        self.assertEqual(read_summary(self.directory / "one")["threads"], 1)

    def test_same_bytes_of_a_body_that_threads_share(self):
        alone = results(self.solve(LARGE, "--threads", "1"))
        for threads in ("2", "3", "4"):
            self.assert_same(results(self.solve(LARGE, "--threads", threads)), alone)

    def test_parts_sum_to_the_step(self):
        for arguments in BOTH:
            with self.subTest(arguments):
                for row in read_csv(self.solve(BOX, *arguments))[1:]:
                    parts = [value for name, value in row.items()
                             if name.startswith("seconds_") and name != "seconds_step"]
                    self.assertEqual(len(parts), 5)
                    self.assertAlmostEqual(sum(parts), row["seconds_step"],
                                           delta=0.02 * row["seconds_step"])

    def test_number_of_threads(self):
        self.write("scene.prm", prm({**BOX, "Time/End": "0.02"}))

        def threads(*command):
            done = subprocess.run([*command, "--output", "out"], cwd=self.directory, text=True,
                                  stdout=subprocess.PIPE, check=True)
            number = read_summary(self.directory / "out")["threads"]
            self.assertIn(f"; {number} thread" + ("s; " if number > 1 else "; "), done.stdout)
            return number

        self.assertEqual(threads(EXEMPLAR, "scene.prm", "--threads", "3"), 3)
        cores = sorted(os.sched_getaffinity(0))
        self.assertIn(threads(EXEMPLAR, "scene.prm"), range(1, len(cores) + 1))  # a container may have less
        self.assertEqual(threads("taskset", "-c", str(cores[-1]), EXEMPLAR, "scene.prm"), 1)

    def resume_and_obstruct_15(self, output, *arguments):
        """Go on from step 10 and, as soon as step 11 has its frame, put a directory in place of that of step 15. What is
        there at the beginning is refused. Status and stderr; None if the run was too fast for that."""
        with subprocess.Popen([EXEMPLAR, "scene.prm", "--output", "out", "--quiet", "--resume", *arguments],
                              cwd=self.directory, text=True, stderr=subprocess.PIPE) as run:
            while run.poll() is None and not (output / frame(11)).exists():
                pass
            if run.poll() is None:
                run.send_signal(signal.SIGSTOP)
                os.waitid(os.P_PID, run.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
            in_time = run.poll() is None and not (output / frame(14)).exists()
            if in_time:
                (output / frame(15)).mkdir()
            if run.poll() is None:
                run.send_signal(signal.SIGCONT)
            message = run.communicate()[1]
        return (run.returncode, message) if in_time else None

    def fail_at_15(self, scene, *arguments):
        """Run to step 10 and from there on with a directory in place of the frame of step 15."""
        output = self.solve({**BOX, "Time/End": "0.1"}, *arguments)
        shutil.copytree(output, self.directory / "kept")
        ends = ("final.msh", "animation.pvd", "summary.json")
        before = {name: (output / name).read_bytes() for name in ends}
        self.write("scene.prm", prm(scene))
        for _ in range(100):
            ended = self.resume_and_obstruct_15(output, *arguments)
            if ended:
                break
            shutil.rmtree(output)
            shutil.copytree(self.directory / "kept", output)
        shutil.rmtree(self.directory / "kept")
        self.assertEqual(ended, (2, f"exemplar: Cannot replace out/{frame(15)}: Is a directory.\n"))
        self.assertEqual(frames(output), [frame(step) for step in range(16)])
        self.assertEqual([name for name in ends if (output / name).read_bytes() != before[name]],
                         [])
        (output / frame(15)).rmdir()

    def test_a_frame_that_cannot_be_written(self):
        whole = results(self.solve(BOX, output="whole"))
        for arguments in BOTH:
            with self.subTest(arguments):
                # the error comes with that frame, a later one, or at the end
                for last in (15, 16, 30):
                    self.fail_at_15({**BOX, "Time/End": str(last / 100)}, *arguments)
                # with checkpoints each step, none says that step 15 is there
                self.fail_at_15(BOX, *EACH_STEP, *arguments)
                self.assert_same(results(self.solve(BOX, "--resume", *arguments)), whole)

    def test_a_full_disk(self):
        size = lambda name: (self.directory / "whole" / name).stat().st_size
        self.solve(BOX, output="whole")
        limit = size(frame(1)) - 1
        for name in (frame(0), "checkpoint.bin", "parameters.prm"):
            self.assertLess(size(name), limit)
        for arguments in BOTH:
            with self.subTest(arguments):
                self.write("scene.prm", prm(BOX))
                done = subprocess.run(
                    [EXEMPLAR, "scene.prm", "--output", "out", "--quiet", *arguments],
                    cwd=self.directory, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                self.assertEqual(done.stderr, f"exemplar: Cannot write out/{frame(1)}.tmp: "
                                              "File too large.\n")
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertEqual({file.name for file in (self.directory / "out").iterdir()},
                                 {frame(0), "statistics.csv", "original.prm", "parameters.prm",
                                  "checkpoint.bin", "log.txt"})

    def check_frames_up_to(self, step, output, whole):
        self.assertEqual(frames(output), [frame(i) for i in range(step + 1)])
        self.assertEqual([name for _, name in read_pvd(output)], frames(output))
        for name in frames(output):
            self.assertEqual((output / name).read_bytes(), whole[name])

    def test_interrupted(self):
        scene = {**BOX, "Time/End": "0.6"}
        whole = results(self.solve(scene, output="whole"))
        for arguments in BOTH:
            with self.subTest(arguments):
                self.write("scene.prm", prm(scene))
                process = subprocess.Popen([EXEMPLAR, "scene.prm", "--output", "out", *arguments],
                                           cwd=self.directory, text=True, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.PIPE)
                output = self.directory / "out"
                with process:
                    wait_until((output / frame(8)).exists, process)
                    process.send_signal(signal.SIGINT)
                    message = process.communicate(timeout=300)[1]
                self.assertEqual(process.returncode, 130, message)
                summary = read_summary(output)
                self.assertEqual(summary["status"], "interrupted")
                self.assertLess(summary["steps"], 60)
                self.check_frames_up_to(summary["steps"], output, whole)
                self.assert_same(results(self.solve(scene, "--resume", *arguments)), whole)
                for file in output.iterdir():
                    file.unlink()

    def test_failed_step(self):
        whole = results(self.solve({**FAILING, "Time/End": "0.1"}, output="whole"))
        for arguments in BOTH:
            with self.subTest(arguments):
                run = self.attempt(FAILING, *arguments)
                self.assertEqual(run.status, 2)
                self.assertRegex(run.stderr, "^exemplar: Step 11 stopped at its iteration limit")
                self.assertEqual(read_summary(run.output)["steps"], 10)
                self.check_frames_up_to(10, run.output, whole)

    def test_warning_of_the_reference_blas(self):
        folders = [str(Path(file).parent) for library in ("blas", "lapack")
                   for file in glob.glob(f"/usr/lib/*/{library}/lib{library}.so.3")]
        if not folders:
            self.skipTest("no reference BLAS here")
        self.write("scene.prm", prm({**BOX, "Time/End": "0.02"}))
        environment = {**os.environ, "LD_LIBRARY_PATH": ":".join(folders)}
        done = subprocess.run([EXEMPLAR, "scene.prm", "--output", "out", "--quiet"],
                              cwd=self.directory, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual((done.returncode, done.stdout), (0, ""))
        self.assertRegex(done.stderr, r"^Warning: BLAS is not OpenBLAS but /\S+/libblas\.so\.3\. "
                                      r".*libopenblas0-pthread.*\n$")
        summary = read_summary(self.directory / "out")
        self.assertEqual([summary[name] for name in ("blas", "blas_core", "blas_threads")],
                         ["unknown", "", 1])


if __name__ == "__main__":
    unittest.main()
