# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts the program by mpirun: what that needs of the environment, and whether all processes make the same collective calls.

    python3 tests/scenes/mpirun.py N PROGRAM [ARGUMENT...]

The environment variable COLLECTIVE_CHECKER names the library of tests/mpi/collective_checker.cc. Where it is set, every run here
is under the checker.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from exemplar_runner import EXEMPLAR, messages_in, without_what_is_meant

# Of Open MPI 4, and of 5 with its PRRTE: it may be root who starts more processes than there are cores, and those that wait for
# others leave them the core.
MPI_ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "PRTE_ALLOW_RUN_AS_ROOT": "1", "PRTE_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    "OMPI_MCA_hwloc_base_binding_policy": "none", "PRTE_MCA_hwloc_default_binding_policy": "none",
    "OMPI_MCA_mpi_yield_when_idle": "1", "HWLOC_HIDE_ERRORS": "2",
    "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
}


def mpi_environment(more=None):
    """That of this process, and what mpirun needs."""
    return {**os.environ, **MPI_ENVIRONMENT, **(more or {})}


def calls_by_communicator(text):
    """{name of a communicator: its calls in their order} of what the checker has written in a process."""
    calls = {}
    for line in text.splitlines():
        communicator, call = line.split(" ", 1)
        calls.setdefault(communicator, []).append(call)
    return calls


def first_difference(mine, other, has_ended):
    """(number from 1, call, other's call) of the first calls that differ, or None. One that was aborted may lack the last ones."""
    for number, (a, b) in enumerate(zip(mine, other), 1):
        if a != b:
            return number, a, b
    if len(mine) == len(other) or not has_ended:
        return None
    number = min(len(mine), len(other))
    return number + 1, *(calls[number] if number < len(calls) else "missing" for calls in (mine, other))


def mismatch(directory, n, has_ended=True):
    """How the collective calls differ that n processes have made, in words; empty if they do not. `has_ended`: by itself."""
    files = [Path(directory) / f"rank.{rank}" for rank in range(n)]
    texts = [file.read_text() if file.exists() else "" for file in files]
    if all(text == texts[0] for text in texts):
        return ""
    of_ranks = [calls_by_communicator(text) for text in texts]
    for communicator in dict.fromkeys(name for calls in of_ranks for name in calls):
        members = [rank for rank in range(n) if communicator in of_ranks[rank] or "of" not in communicator]
        for rank in members[1:]:
            first, other = (of_ranks[r].get(communicator, []) for r in (members[0], rank))
            found = first_difference(first, other, has_ended)
            if found:
                number, mine, others = found
                return (f"collective call {number} on {communicator} of rank {members[0]} is {mine}, and of rank {rank} {others}; "
                        f"the last that agree: {first[max(0, number - 4):number - 1]}")
    return ""


def run_until(command, timeout, **how):
    """A run of mpirun, which ends its processes if it must end before it has ended by itself."""
    process = subprocess.Popen(command, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **how)
    try:
        stdout, stderr = process.communicate(timeout=timeout)
        return subprocess.CompletedProcess(command, process.returncode, stdout, stderr), True
    except subprocess.TimeoutExpired:
        process.terminate()
        try:
            stdout, stderr = process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            stdout, stderr = process.communicate()
        return subprocess.CompletedProcess(command, process.returncode, stdout, stderr), False


def run_processes(n, *command, environment=None, timeout=240, cwd=None):
    """mpirun -n N COMMAND. Fails if its processes make different collective calls, or do not end in time."""
    checker = os.environ.get("COLLECTIVE_CHECKER")
    with tempfile.TemporaryDirectory() as calls:
        checked = ["env", f"LD_PRELOAD={checker}", f"COLLECTIVES={calls}"] if checker else []
        done, in_time = run_until(["mpirun", "-n", str(n), *checked, *map(str, command)], timeout, cwd=cwd,
                                  env=mpi_environment(environment))
        difference = mismatch(calls, n, in_time and done.returncode == 0)
        if checker and n > 1 and not any(Path(calls).iterdir()):
            difference = "the checker has noted nothing"
    if difference:
        raise AssertionError(f"{difference}\n{done.stderr}")
    if not in_time:
        raise AssertionError(f"{n} processes have not ended in {timeout} s\n{done.stderr}")
    return done


def launch(n, *arguments, program=EXEMPLAR, **how):
    """mpirun -n N exemplar ...: its status, what it said on stderr of our own words, and all of it."""
    done = run_processes(n, program, *arguments, **how)
    return done.returncode, without_what_is_meant(messages_in(done.stderr)), done


if __name__ == "__main__":
    run = run_processes(int(sys.argv[1]), *sys.argv[2:])
    print(run.stdout + run.stderr, end="")
    sys.exit(run.returncode)
