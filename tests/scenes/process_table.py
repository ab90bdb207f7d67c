# SPDX-License-Identifier: GPL-3.0-or-later
"""What the system knows of other processes, which may end at any time: a file below /proc is gone then or cannot be read."""

import os
import re
from pathlib import Path


def file_of(pid, name):
    """The text of /proc/PID/NAME; empty if the process has ended."""
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes().decode(errors="replace")
    except OSError:
        return ""


def is_alive(pid):
    """Whether it goes on: one that its parent has not waited for (Z) does not."""
    state = file_of(pid, "stat").rpartition(")")[2].split()[:1]
    return state not in ([], ["Z"])


def children(pid):
    """The ids of the processes that go on and that a process has started."""
    try:
        tasks = os.listdir(f"/proc/{pid}/task")
    except OSError:
        return []
    found = [child for task in tasks for child in file_of(pid, f"task/{task}/children").split()]
    return [int(child) for child in found if is_alive(child)]


def handles(pid, signal):
    """Whether it has a handler for a signal."""
    caught = re.search(r"SigCgt:\s*(\w+)", file_of(pid, "status"))
    return caught is not None and bool(int(caught[1], 16) >> signal - 1 & 1)
