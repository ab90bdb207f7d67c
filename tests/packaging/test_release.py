# SPDX-License-Identifier: GPL-3.0-or-later
"""packaging/release in a repository of its own with the files that it reads: what it makes, and what it refuses.

Usage: python3 tests/packaging/test_release.py
"""
import hashlib
import os
import shutil
import subprocess
import tarfile
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
CHANGES = "# Changelog\n\n## 1.2.3, unreleased\n\n- Something new.\n\n## 1.2.2, 2020-01-01\n\n- Something old.\n"
FILES = {"CMakeLists.txt": "project(exemplar VERSION 1.2.3 LANGUAGES CXX)\n", "CITATION.cff": "version: 1.2.3\n",
         "codemeta.json": '{"version": "1.2.3"}\n', "CHANGELOG.md": CHANGES, ".gitignore": "build/\n"}
WHO = {f"GIT_{role}_{what}": "nobody@localhost" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}


class Release(unittest.TestCase):
    def setUp(self):
        self.directory = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.make_cmake("true")
        (self.directory / "packaging").mkdir()
        shutil.copy(TOP / "packaging/release", self.directory / "packaging")
        for name, text in FILES.items():
            Path(self.directory, name).write_text(text)
        self.git("init", "-q")
        self.commit()

    def make_cmake(self, answer):
        """In place of cmake, which would build the program: keeps what it is asked for."""
        self.tools = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.tools / "cmake").write_text(f'#!/bin/sh\necho "$@" >> {self.tools}/asked\n{answer}\n')
        (self.tools / "cmake").chmod(0o755)

    def asked(self):
        return (self.tools / "asked").read_text() if (self.tools / "asked").exists() else ""

    def call(self, *call):
        environment = {**os.environ, **WHO, "PATH": f"{self.tools}:{os.environ['PATH']}"}
        return subprocess.run(call, cwd=self.directory, env=environment, capture_output=True, text=True)

    def git(self, *words):
        done = self.call("git", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "files")

    def release(self, *words):
        return self.call("packaging/release", *words)

    def check_files(self):
        dist = self.directory / "build/dist"
        self.assertEqual((dist / "exemplar-1.2.3.changes.md").read_text().strip(), "- Something new.")
        with tarfile.open(dist / "exemplar-1.2.3.tar.gz") as archive:
            self.assertIn("exemplar-1.2.3/CMakeLists.txt", archive.getnames())
        for line in (dist / "SHA256SUMS").read_text().splitlines():
            digest, name = line.split()
            self.assertEqual(hashlib.sha256((dist / name).read_bytes()).hexdigest(), digest)
        self.assertEqual(len(list(dist.iterdir())), 3)

    def test_without_tag_only_files_are_made(self):
        done = self.release()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check_files()
        self.assertEqual((self.git("tag"), self.git("status", "--porcelain")), ("", ""))
        self.assertEqual(self.git("log", "--format=%s").split(), ["files"])
        self.assertEqual(self.asked(), "")

    def test_tag(self):
        done = self.release("--tag")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("--target tutorial_tables", self.asked())
        self.check_files()
        self.assertEqual(self.git("tag", "--format=%(contents)").strip(), "- Something new.")
        self.assertEqual(self.git("status", "--porcelain"), "")
        self.assertRegex(self.git("show", "v1.2.3:CHANGELOG.md"), r"\n## 1\.2\.3, \d{4}-\d\d-\d\d\n")
        self.assertIn("is there", self.release("--tag").stderr)

    def check_refused(self, word):
        done = self.release("--tag")
        self.assertEqual((done.returncode, self.git("tag")), (1, ""))
        self.assertIn(word, done.stderr)
        self.assertFalse((self.directory / "build").exists())

    def test_a_dirty_tree_is_refused(self):
        (self.directory / "new").write_text("x")
        self.check_refused("not committed")

    def test_tables_of_another_program_are_refused(self):
        self.make_cmake("false")
        self.check_refused("tables of the tutorial")

    def test_versions_that_differ_are_refused(self):
        for name in ("CITATION.cff", "codemeta.json", "CHANGELOG.md"):
            Path(self.directory, name).write_text(FILES[name].replace("1.2.3", "1.2.4"))
            self.commit()
            self.check_refused(name)
            Path(self.directory, name).write_text(FILES[name])

    def test_unknown_words_are_refused(self):
        done = self.release("--help")
        self.assertEqual((done.returncode, self.git("tag")), (1, ""))
        self.assertIn("packaging/release --tag", done.stderr)


unittest.main()
