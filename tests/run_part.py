# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests of a file without some of them, or these alone. Which these are, tests/CMakeLists.txt says.

Usage: run_part.py FILE --without|--only NAME..., a NAME being that of a class, or CLASS.TEST
"""

import importlib
import os
import sys
import unittest


def tests_in(suite):
    """All of a suite, which may hold others, in their order."""
    for test in suite:
        yield from tests_in(test) if isinstance(test, unittest.TestSuite) else [test]


def names_of(test):
    """CLASS.TEST and CLASS."""
    name = test.id().split(".", 1)[1]
    return {name, name.split(".")[0]}


def main():
    file, how, *named = sys.argv[1:]
    sys.path.insert(0, os.path.dirname(file))
    module = importlib.import_module(os.path.basename(file)[:-len(".py")])
    tests = list(tests_in(unittest.defaultTestLoader.loadTestsFromModule(module)))
    missing = set(named).difference(*map(names_of, tests))
    if missing or how not in ("--without", "--only"):
        sys.exit(f"{file} has no {', '.join(sorted(missing))}" if missing else __doc__)
    chosen = [test for test in tests if names_of(test).isdisjoint(named) == (how == "--without")]
    result = unittest.TextTestRunner().run(unittest.TestSuite(chosen))
    return 0 if result.wasSuccessful() and chosen else 1


if __name__ == "__main__":
    sys.exit(main())
