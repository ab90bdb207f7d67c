# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that run the program hundreds of times."""

import os
import sys

from exemplar_runner import EXEMPLAR, REPOSITORY, Run, SceneTest

sys.path.append(str(REPOSITORY / "tests/fuzz"))
from fork_server import ForkServer  # noqa: E402


class ServedTest(SceneTest):
    """FORK_SERVER names the library of fork_server.cc, with which the program need not be linked anew for each run."""

    server = None

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if library := os.environ.get("FORK_SERVER"):
            cls.server = ForkServer(EXEMPLAR, library)
            cls.addClassCleanup(cls.server.close)

    def call(self, *arguments, **environment):
        words = [str(argument) for argument in arguments]
        if self.server is None or "" in words:
            return super().call(*arguments, **environment)
        status, stdout, stderr = self.server.run(words, self.directory, environment, None, 1 << 30, 60)
        return Run(status, stdout.decode(), stderr.decode(), None)
