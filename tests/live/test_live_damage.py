# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs with damaged files, and names that look like code: export and live refuse them with a message, or show them right.

Environment: EXEMPLAR, the program.
"""
import base64
import os
import re
import shutil
import struct
import subprocess
import tempfile
import time
import unittest
import zlib
from pathlib import Path

from live_server import BAR, Server, call_program, prm


def array(text, name):
    """(begin, end) of an array's text in a frame."""
    begin = text.index(">", text.index(f' Name="{name}"')) + 1
    return begin, text.index("<", begin)


def encoded(data):
    packed = zlib.compress(data)
    return base64.b64encode(struct.pack("<4Q", 1, len(data), len(data), len(packed))).decode() + base64.b64encode(packed).decode()


def with_array(text, name, change):
    """A frame with another array: change(bytes) gives its bytes."""
    begin, end = array(text, name)
    data = zlib.decompress(base64.b64decode(text[begin + 44:end]))
    return text[:begin] + encoded(change(data)) + text[end:]


class DamageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.here = Path(temporary.name)
        (cls.here / "bar.prm").write_text(prm({**BAR, "Mesh/Box cells": "4, 1, 1", "Time/Step": ".02", "Time/End": ".06",
                                               "Loads/Gravity": "0, 0, -1", "Output/Every": "1"}))
        done = call_program("bar.prm", "--output", "good", cwd=cls.here, timeout=60)
        assert done.returncode == 0, done.stderr
        cls.frame = (cls.here / "good/frame_0000.vtu").read_text()
        cls.n_copies = 0

    def copy(self, name=None):
        DamageTest.n_copies += 1
        directory = self.here / (name or f"run{self.n_copies}")
        shutil.copytree(self.here / "good", directory)
        return directory

    def export(self, *directories, html="page.html"):
        return call_program("export", *directories, "--html", html, cwd=self.here, timeout=60)

    def assert_refused(self, directory, words):
        for call in (lambda: self.export(directory), lambda: call_program("live", directory, cwd=self.here, timeout=60)):
            done = call()
            message = re.sub(r"\s+", " ", done.stderr)
            self.assertEqual((done.returncode, done.stdout), (1, ""), message)
            self.assertIn(words, message)
            self.assertIn(directory.name, message)
        self.assertFalse((self.here / "page.html").exists())

    def test_frames(self):
        n_points = len(zlib.decompress(base64.b64decode(self.frame[slice(*(lambda b, e: (b + 44, e))(*array(self.frame, "Points")))]))) // 24
        changes = (("connectivity", lambda data: b"", "fewer than four nodes"), ("offsets", lambda data: b"", "no cells"),
                   ("connectivity", lambda data: bytes(len(data)), "a node twice"),
                   ("connectivity", lambda data: struct.pack("<i", -1) + data[4:], "not there"),
                   ("connectivity", lambda data: struct.pack("<i", n_points) + data[4:], "not there"),
                   ("connectivity", lambda data: struct.pack("<i", 0x55555556) + data[4:], "not there"),
                   ("offsets", lambda data: struct.pack("<i", -4) + data[4:], "fewer than four"),
                   ("Points", lambda data: b"", "not there"), ("Points", lambda data: struct.pack("<d", float("nan")) + data[8:], "no finite place"),
                   ("Points", lambda data: struct.pack("<d", float("inf")) + data[8:], "no finite place"),
                   ("Points", lambda data: data[:24], "not there"))
        for name, change, words in changes:
            directory = self.copy()
            (directory / "frame_0000.vtu").write_text(with_array(self.frame, name, change))
            self.assert_refused(directory, words)

    def test_later_frames(self):
        directory = self.copy()
        (directory / "frame_0002.vtu").write_text(with_array(self.frame, "Points", lambda data: data[:-24]))
        self.assert_refused(directory, "other nodes than the first frame")

    def test_damaged_text(self):
        begin, end = array(self.frame, "Points")
        for text in (self.frame[:begin] + "!" * 60 + self.frame[end:], self.frame[:begin + 60] + "\x00" + self.frame[begin + 61:],
                     self.frame[:begin + 30], self.frame[:begin] + encoded(b"x" * 24)[:44] + self.frame[end:], "", "x" * 1000):
            directory = self.copy()
            (directory / "frame_0000.vtu").write_text(text)
            self.assert_refused(directory, "frame_0000.vtu")

    def test_size_that_is_a_lie(self):
        begin, _ = array(self.frame, "Points")
        lie = base64.b64encode(struct.pack("<4Q", 1, 1 << 31, 1 << 31, 100)).decode()
        directory = self.copy()
        (directory / "frame_0000.vtu").write_text(self.frame[:begin] + lie + self.frame[begin + 44:])
        self.assert_refused(directory, "another size")

    def test_animation(self):
        text = (self.here / "good/animation.pvd").read_text()
        for changed in (text.replace('file="frame_0000.vtu"', 'file="' + "x" * 300000 + '.vtu"'), text.replace('timestep="0"', 'timestep="nan"'),
                        re.sub('timestep="[^"]*"', "", text), text.replace("frame_0001", "../good/frame_0001"), "<DataSet", ""):
            self.assertNotEqual(changed, text)
            directory = self.copy()
            (directory / "animation.pvd").write_text(changed)
            done = self.export(directory)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertLess(len(done.stderr), 5000)
        directory = self.copy()
        (directory / "animation.pvd").write_text(text.replace("<DataSet", f'<DataSet note="{"y" * 300000}"'))
        self.assertEqual(self.export(directory).returncode, 0)
        (self.here / "page.html").unlink()

    def test_pipes(self):
        for name in ("animation.pvd", "frame_0000.vtu"):
            directory = self.copy()
            (directory / name).unlink()
            os.mkfifo(directory / name)
            self.assert_refused(directory, "no regular file")
        directory = self.copy()
        for name in ("statistics.csv", "summary.json"):
            (directory / name).unlink()
            os.mkfifo(directory / name)
        self.assertEqual(self.export(directory).returncode, 0)
        (self.here / "page.html").unlink()

    def test_names_are_no_code(self):
        for name in ("@RUNS@", "@DATA@", "<!--<script>", "<script>alert(1)</script>", "a&b\"'", "</script>"):
            directory = self.copy(name.replace("/", "∕"))
            done = self.export(directory)
            self.assertEqual(done.returncode, 0, done.stderr)
            page = (self.here / "page.html").read_text()
            data = page.split('id="data">')[1].split("</script>")[0]
            self.assertNotIn("<", data)
            self.assertEqual(page.count('id="frames-0"'), 1)
            self.assertEqual(page.count('id="data"'), 1)
            (self.here / "page.html").unlink()

    def test_what_a_page_replaces(self):
        mine = self.here / "mine.txt"
        mine.write_text("mine")
        for name, words in (("page.mp4", "ends in .html"), ("link.html", "is a link"), ("mine.html", "not written by exemplar")):
            if name == "link.html":
                (self.here / name).symlink_to(mine)
            elif name == "mine.html":
                (self.here / name).write_text("mine")
            done = self.export("good", html=name)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, re.sub(r"\s+", " ", done.stderr))
        for is_link in (False, True):
            temporary = self.here / "new.html.tmp"
            temporary.symlink_to(mine) if is_link else temporary.write_text("mine")
            done = self.export("good", html="new.html")
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertEqual(temporary.read_text(), "mine")
            temporary.unlink()
        self.assertEqual(mine.read_text(), "mine")
        for _ in range(2):
            self.assertEqual(self.export("good", html="new.html").returncode, 0)
        for runs, page in ((["good"], "good.html"), (["good/", "good"], "good_good.html")):  # without --html
            done = call_program("export", *runs, cwd=self.here, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(page, done.stdout)
            self.assertTrue((self.here / page).exists())


class AddressTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.here = Path(temporary.name)
        (cls.here / "bar.prm").write_text(prm({**BAR, "Mesh/Box cells": "4, 1, 1"}))

    def test_printed_address_works(self):
        import socket
        import urllib.request
        addresses = ["127.0.0.1", "127.0.0.2", "0.0.0.0"]
        with socket.socket(socket.AF_INET6) as sock:
            try:
                sock.bind(("::1", 0))
                addresses += ["::1"]
            except OSError:
                pass
        for address in addresses:
            with Server(self.here / "bar.prm", "--bind", address, log=self.here / "log.txt") as server:
                url = re.search(r"http://\S+", server.line)[0]
                opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
                self.assertEqual(opener.open(url, timeout=30).status, 200, address)

    def test_hosts(self):
        for host in ("box:8080", "http://box", "*", "", "a b", "box/"):
            done = call_program("live", self.here / "bar.prm", "--allow-host", host, timeout=60)
            self.assertEqual((done.returncode, done.stdout), (1, ""), host)
            self.assertIn("--allow-host", done.stderr)

    def test_socket_of_a_running_server(self):
        path = self.here / "socket"
        with Server(self.here / "bar.prm", "--bind", f"unix:{path}", log=self.here / "log.txt"):
            done = call_program("live", self.here / "bar.prm", "--bind", f"unix:{path}", timeout=60)
            self.assertEqual(done.returncode, 1)
            self.assertIn("another server", done.stderr)
            self.assertTrue(path.exists())
        with subprocess.Popen(["python3", "-c", f"import socket; s = socket.socket(socket.AF_UNIX); s.bind({str(path)!r})"]) as process:
            process.wait()
        with Server(self.here / "bar.prm", "--bind", f"unix:{path}", log=self.here / "log.txt"):
            pass  # what a killed server has left

    def test_page_comes_over_a_slow_line(self):
        """A page of some megabytes at a rate that takes it longer than a request may."""
        import socket
        done = call_program(self.here / "bar.prm", "--output", self.here / "long", "--set", "Mesh/Box cells=24, 12, 12", "--set", "Time/Step=.01",
                            "--set", "Time/End=.01", "--set", "Output/Every=1", timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        pvd = self.here / "long/animation.pvd"  # the same frame a thousand times is as long as a long run
        entry = re.search(r"\s*<DataSet[^>]*/>", pvd.read_text())[0]
        pvd.write_text(pvd.read_text().replace(entry, "".join(re.sub('timestep="[^"]*"', f'timestep="{i}"', entry) for i in range(1200)), 1))
        with Server(self.here / "long", log=self.here / "log.txt") as server, socket.socket() as sock:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
            sock.connect(("127.0.0.1", server.port))
            sock.settimeout(30)
            sock.sendall(f"GET / HTTP/1.1\r\nHost: {server.host}\r\nCookie: {server.cookie}\r\nConnection: close\r\n\r\n".encode())
            head = b""
            while b"\r\n\r\n" not in head:
                head += sock.recv(1000)
            size = int(re.search(rb"Content-Length: (\d+)", head)[1])
            self.assertGreater(size, 12e6)  # more than a socket takes at once
            received = len(head.split(b"\r\n\r\n", 1)[1])
            begin = time.monotonic()
            while received < size:
                if received / size > (time.monotonic() - begin) / 14:  # 14 s in all
                    time.sleep(.05)
                    continue
                more = sock.recv(65536)
                if not more:
                    break
                received += len(more)
            self.assertEqual(received, size)


if __name__ == "__main__":
    unittest.main()
