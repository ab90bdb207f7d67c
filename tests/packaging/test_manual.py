# SPDX-License-Identifier: GPL-3.0-or-later
"""Man pages and the completion of shells know every command and option of the program, and no other; --help tells examples and
exit statuses. A shell that is not installed, and pages that were not made, are left out and named.

Usage: python3 tests/packaging/test_manual.py BUILD_DIRECTORY       (EXEMPLAR is the program)
"""
import functools
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
COMPLETION = TOP / "packaging/completion"
PROGRAM = os.environ.get("EXEMPLAR", str(TOP / "build/release/exemplar"))
PAGES = Path(sys.argv.pop(), "man")
COMMANDS = ["study", "verify", "mesh", "pose", "export", "convert", "live"]


def output(*call, **settings):
    return subprocess.run(call, check=True, stdout=subprocess.PIPE, text=True, **settings).stdout


def options(text):
    return sorted(set(re.findall(r"--[a-z][a-z-]*", text)))


@functools.cache
def options_of(*command):
    """The options that --help lists, each at the beginning of a line."""
    return options("\n".join(re.findall(r"^  (?:-h,)?(--[a-z-]+)", output(PROGRAM, *command, "--help"), re.MULTILINE)))


def in_bash(*words):
    """What bash offers for the last of some words after the name of the program."""
    script = """source "$1"; COMP_WORDS=("${@:2}"); COMP_CWORD=$(($# - 2)); _exemplar; printf '%s\\n' "${COMPREPLY[@]}" """
    return sorted(output("bash", "-c", script, "bash", COMPLETION / "exemplar.bash", PROGRAM, *words).split())


def in_fish(*words):
    line = " ".join(["exemplar", *words])
    offered = output("fish", "--no-config", "-c", f"source {COMPLETION}/exemplar.fish; complete --do-complete '{line}'",
                     cwd=COMPLETION,
                     env={**os.environ, "PATH": f"{Path(PROGRAM).parent}:{os.environ['PATH']}"})
    return sorted(line.split("\t")[0] for line in offered.splitlines())


def in_zsh(*words):
    """The body of _exemplar with the two builtins of zsh that offer words replaced by prints."""
    body = (COMPLETION / "_exemplar").read_text()
    script = f"""compadd() {{ if [ $1 = -a ]; then print -l ${{(P)2}}; else shift; print -l -- $@; fi }}; _files() {{ }}
                 words=("$@"); CURRENT=$#; complete_it() {{ {body} }}; complete_it"""
    offered = output("zsh", "-f", "-c", script, "zsh", PROGRAM, *words).split()
    return sorted(word for word in offered if word.startswith(words[-1]))


class Help(unittest.TestCase):
    def test_the_commands_of_this_test_are_those_of_the_program(self):
        listed = output(PROGRAM, "--help").split("\nSubcommands:\n")[1].split("\n\n")[0]
        self.assertEqual(re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE), COMMANDS)

    def test_examples_and_exit_statuses(self):
        for command in [[], *([name] for name in COMMANDS)]:
            text = output(PROGRAM, *command, "--help")
            self.assertRegex(text, "\nExamples:\n  \\$ " + " ".join(["exemplar", *command]) + " ")
            self.assertEqual(re.findall(r"^  (\d+) +\S", text.split("Exit status:")[1], re.MULTILINE), ["0", "1", "2", "130"])


class Completion(unittest.TestCase):
    def check(self, offer):
        for command in [[], *([name] for name in COMMANDS)]:
            self.assertEqual(offer(*command, "--"), options_of(*command), command)
        self.assertEqual([word for word in offer("") if not word.startswith("-") and word in COMMANDS], sorted(COMMANDS))
        self.assertEqual(offer("m"), ["mesh"])
        self.assertNotIn("mesh", offer("verify", "m"))

    def test_bash(self):
        self.check(in_bash)

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish(self):
        self.check(in_fish)

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        self.check(in_zsh)


@unittest.skipUnless(PAGES.is_dir(), "no man pages: help2man is not installed")
class ManPages(unittest.TestCase):
    def test_a_page_for_the_program_and_each_command(self):
        self.assertEqual(sorted(page.name for page in PAGES.iterdir()),
                         sorted(["exemplar.1", *(f"exemplar-{command}.1" for command in COMMANDS)]))

    def test_the_options(self):
        for command in [[], *([name] for name in COMMANDS)]:
            name = "-".join(["exemplar", *command])
            text = (PAGES / f"{name}.1").read_text().replace("\\-", "-")
            self.assertIn(f".SH NAME\n{name} - ", text)
            listed = text.split(".SH OPTIONS")[1].split(".SH ")[0]
            self.assertEqual(options("\n".join(re.findall(r"^\\fB(.*)", listed, re.MULTILINE))), options_of(*command), name)
            self.assertIn("Exit status", text)


unittest.main()
