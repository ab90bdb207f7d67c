# SPDX-License-Identifier: GPL-3.0-or-later
"""What pages of other sites, other users and broken programs may try at the server of exemplar live: refused, told, and nothing else.

Environment: EXEMPLAR, the program.
"""
import socket
import tempfile
import time
import unittest
from pathlib import Path

from live_client import Closed, Viewer
from live_server import BAR, Server, call_program, prm


class StrangersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.here = Path(cls.directory.name)
        (cls.here / "bar.prm").write_text(prm(BAR))
        cls.server = Server(cls.here / "bar.prm", "--allow-host", "Proxy.example", log=cls.here / "log.txt")

    @classmethod
    def tearDownClass(cls):
        cls.server.__exit__()
        cls.directory.cleanup()

    def tearDown(self):
        """The user looks on."""
        with_user = Viewer(self.server)
        with_user.wait_steps(3)
        with_user.socket.close()

    def refused(self, **headers):
        sock, status = self.server.handshake(**headers)
        sock.close()
        self.assertEqual(status, 403, headers)

    def test_token_becomes_cookie(self):
        status, headers, body = self.server.get(f"/?token={self.server.token}")
        self.assertEqual((status, headers["location"], body), (303, "./", b""))
        self.assertRegex(headers["set-cookie"], r"^exemplar_[0-9a-f]{8}=[0-9a-f]{32}; Path=/; HttpOnly; SameSite=Lax$")
        self.assertNotIn(self.server.token, headers["set-cookie"])
        status, headers, body = self.server.get("/", Cookie="theme=dark; " + self.server.cookie)
        self.assertEqual(status, 200)
        self.assertIn(b"<!DOCTYPE html>", body)
        self.assertNotIn("set-cookie", headers)
        policy = headers["content-security-policy"]
        self.assertIn("default-src 'none'; script-src 'self'", policy)
        self.assertNotIn("unsafe", policy)
        self.assertEqual((headers["x-content-type-options"], headers["referrer-policy"], headers["cache-control"]),
                         ("nosniff", "no-referrer", "no-store"))
        self.assertFalse([name for name in headers if name.startswith("access-control")])

    def test_without_cookie(self):
        name, value = self.server.cookie.split("=")
        for cookie in (None, "", value, f"{name}=", f"{name}={value[:-1]}", f"{name}={value}0", f"x{name}={value}", f"{name}={'0' * 32}"):
            for path in ("/", "/app.js", "/three/build/three.module.js", "/nothing"):
                self.assertEqual(self.server.get(path, Cookie=cookie)[0], 403, cookie)
            self.refused(Cookie=cookie)

    def test_wrong_and_old_tokens(self):
        for token in ("0" * 32, self.server.token[:-1], self.server.token + "0", self.server.token.upper() + "x", "%00"):
            status, headers, _ = self.server.get(f"/?token={token}")
            self.assertEqual(status, 403)
            self.assertNotIn("set-cookie", headers)
        with Server(self.here / "bar.prm", log=self.here / "other.txt") as other:
            self.assertNotEqual(other.cookie.split("=")[0], self.server.cookie.split("=")[0])
            self.assertEqual(other.get(f"/?token={self.server.token}")[0], 403)
            self.assertEqual(other.get("/", Cookie=self.server.cookie)[0], 403)

    def test_rebound_host(self):
        for host in ("evil.com", "evil.com:80", f"127.0.0.1.evil.com:{self.server.port}", "localhost.evil.com", "localhost:80@evil.com", "", None,
                     "127.0.0.1:x", "127.0.0.1:", "0.0.0.0", "[::2]", "proxy.example.evil.com"):
            self.assertIn(self.server.get("/", Host=host, Cookie=self.server.cookie)[0], (400, 403), host)
            if host is not None:
                self.refused(Host=host, Origin=f"http://{host}")
        for host in ("localhost", "localhost:8080", "127.0.0.1:9", "[::1]:5000", "LOCALHOST:1", "proxy.example", "proxy.example:443"):
            self.assertEqual(self.server.get("/", Host=host, Cookie=self.server.cookie)[0], 200, host)

    def test_other_origin(self):
        port = self.server.port
        for origin in ("http://evil.com", f"http://evil.com:{port}", "null", None, "", f"http://localhost:{port}", f"http://127.0.0.1:{port + 1}",
                       f"http://127.0.0.1:{port}.evil.com", f"ftp://127.0.0.1:{port}", f"http://127.0.0.1:{port}/"):
            self.refused(Origin=origin)
        self.assertEqual(self.server.get("/", Origin="http://evil.com", Cookie=self.server.cookie)[0], 403)

    def test_tunnels_and_proxies(self):
        for host, origin in (("localhost:8080", "http://localhost:8080"), ("proxy.example", "https://proxy.example")):
            sock, status = self.server.handshake(Host=host, Origin=origin)
            sock.close()
            self.assertEqual(status, 101)

    def test_paths(self):
        for path in ("/../etc/passwd", "/..%2f..%2fetc/passwd", "/%2e%2e/etc/passwd", "//etc/passwd", "/three/../../../etc/passwd", "/app.js/",
                     "/app.js%00", "/./app.js", "/three/build/", "/index.html/..", "/etc/passwd", "/bar.prm", "/\\..\\etc", "/" + "a" * 4000):
            status, _, body = self.server.get(path, Cookie=self.server.cookie)
            self.assertEqual(status, 404, path)
            self.assertNotIn(b"root:", body)
        self.assertIn(self.server.get("http://evil.com/", Cookie=self.server.cookie)[0], (400, 403, 404))

    def test_methods(self):
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE"):
            self.assertEqual(self.server.get("/", method, Cookie=self.server.cookie)[0], 405)
        status, headers, body = self.server.get("/", "HEAD", Cookie=self.server.cookie)
        self.assertEqual((status, body), (200, b""))

    def test_what_is_no_request(self):
        for garbage in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(200), b"GET\r\n\r\n", b"\r\n" * 5000, b"GET / HTTP/9.9\r\n\r\n",
                        b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 100000, b"SSH-2.0-x\r\n",
                        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n",
                        b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.com\r\n\r\n"):
            with self.server.connect() as sock:
                try:
                    sock.sendall(garbage)
                    sock.shutdown(socket.SHUT_WR)
                    answer = sock.recv(65536)
                except OSError:
                    answer = b""
                self.assertTrue(answer == b"" or b" 403 " in answer or b" 400 " in answer, (garbage[:50], answer))

    def test_thousand_connections(self):
        user = Viewer(self.server)
        self.addCleanup(user.socket.close)
        strangers = []
        for _ in range(1000):
            try:
                strangers.append(self.server.connect())
            except OSError:
                break
        self.assertGreater(len(strangers), 900)
        user.wait_steps(30)  # goes on
        for stranger in strangers:
            stranger.close()
        until = time.monotonic() + 20
        while time.monotonic() < until:  # and others come again
            try:
                if self.server.get("/", Cookie=self.server.cookie)[0] == 200:
                    break
            except OSError:
                time.sleep(.1)
        self.assertEqual(self.server.get("/", Cookie=self.server.cookie)[0], 200)

    def test_more_viewers_than_may_be(self):
        viewers = [Viewer(self.server) for _ in range(8)]
        sock, status = self.server.handshake()
        self.assertEqual(status, 101)
        self.assertEqual(sock.recv(4)[:1], b"\x88")  # closed at once
        sock.close()
        for viewer in viewers:
            viewer.socket.close()
        until = time.monotonic() + 10
        while time.monotonic() < until:
            try:
                Viewer(self.server).socket.close()
                break
            except Closed:
                time.sleep(.1)

    def test_log_is_printable_and_short(self):
        for _ in range(100):
            self.server.get("/", Host="evil\xff.com", Cookie=self.server.cookie)
        log = self.server.log.read_bytes()
        self.assertIn(b"Refused", log)
        self.assertNotIn(b"\xff", log)
        self.assertNotIn(self.server.token.encode(), log)
        self.assertLess(log.count(b"evil?.com"), 31)

    def test_unix_socket(self):
        path = self.here / "live.socket"
        with Server(self.here / "bar.prm", "--bind", f"unix:{path}", log=self.here / "unix.txt") as server:
            self.assertEqual(path.stat().st_mode & 0o777, 0o600)
            with socket.socket(socket.AF_UNIX) as sock:
                sock.connect(str(path))
                sock.sendall(f"GET /?token={server.token} HTTP/1.1\r\nHost: localhost:8080\r\n\r\n".encode())
                self.assertIn(b" 303 ", sock.recv(4096))
        self.assertFalse(path.exists())

    def test_user_errors(self):
        (self.here / "static.prm").write_text(prm({**BAR, "Scene": "static"}))
        (self.here / "file").write_text("mine")
        for arguments, words in ((["static.prm"], "only dynamic"), (["."], "animation.pvd"), ([".", "--record", "x"], "Leave out"), (["bar.prm", "bar.prm"], "takes one scene"),
                                  (["nothing.prm"], "nothing.prm"), ([], "SCENE"), (["bar.prm", "--port", "99999"], "port"),
                                 (["bar.prm", "--port", str(self.server.port)], "--port"), (["bar.prm", "--bind", "unix:file"], "this is a file"),
                                 (["bar.prm", "--record", "."], "Nothing has been changed"), (["bar.prm", "--bind", "nowhere"], "--bind")):
            done = call_program("live", *arguments, cwd=self.here, timeout=60)
            self.assertEqual((done.returncode, done.stdout), (1, ""), arguments)
            self.assertIn(words, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertEqual((self.here / "file").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
