# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of exemplar live, and one of exemplar export, in Chromium without a window: the body is seen, follows the mouse, and nothing
is complained of in the console. Left out where Chromium or selenium is not installed.

Environment: EXEMPLAR, the program. SCREENSHOTS, a directory for pictures, may be set.
"""
import os
import tempfile
import unittest
from pathlib import Path

from live_browser import browser, complaints, needs_browser, wait
from live_server import BAR, Server, call_program, prm

try:
    from selenium.webdriver.common.action_chains import ActionChains
except ImportError:
    pass


@needs_browser
class BrowserTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.here = Path(cls.directory.name)
        (cls.here / "bar.prm").write_text(prm(BAR))

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def picture(self, page, name):
        if "SCREENSHOTS" in os.environ:
            page.save_screenshot(str(Path(os.environ["SCREENSHOTS"]) / f"{name}.png"))

    def pixels(self, page, half=None):
        """What the canvas shows, small; of its left (0) or right half (1), if one is asked for."""
        width, begin = (64, 0) if half is None else (32, 32 * half)
        return page.execute_script(f"""
            const small = document.createElement("canvas"); small.width = 64; small.height = 48;
            const pen = small.getContext("2d"); pen.drawImage(document.getElementById("canvas"), 0, 0, 64, 48);
            return Array.from(pen.getImageData({begin}, 0, {width}, 48).data);""")

    def assertNothingInConsole(self, page):
        self.assertEqual(complaints(page), [])

    def test_drag(self):
        with Server(self.here / "bar.prm", log=self.here / "log.txt") as server:
            page = browser()
            self.addCleanup(page.quit)
            page.get(f"http://{server.host}/?token={server.token}")
            self.assertEqual(page.current_url, f"http://{server.host}/")
            wait(lambda: "real time" in page.find_element("id", "strip").text)
            before = self.pixels(page)
            self.assertGreater(sum(alpha > 0 for alpha in before[3::4]), 100)  # a body
            self.picture(page, "live_light")
            canvas = page.find_element("id", "canvas")
            ActionChains(page).move_to_element(canvas).click_and_hold().move_by_offset(20, -60).move_by_offset(20, -60).perform()
            wait(lambda: sum(abs(a - b) > 20 for a, b in zip(before, self.pixels(page))) > 100)
            self.picture(page, "live_pulled")
            ActionChains(page).release().perform()
            ActionChains(page).send_keys(" ").perform()
            wait(lambda: page.find_element("id", "pause").text == "Go on")
            self.assertNothingInConsole(page)

    def test_weights_by_hand(self):
        with Server(self.here / "bar.prm", log=self.here / "log.txt") as server:
            page = browser()
            self.addCleanup(page.quit)
            page.get(f"http://{server.host}/?token={server.token}")
            wait(lambda: "real time" in page.find_element("id", "strip").text)
            slider, shown = (page.find_element("css selector", f".weight:last-child {name}") for name in ("input", "output"))
            self.assertFalse(slider.is_displayed())
            page.find_element("css selector", "[value='by hand']").click()
            wait(slider.is_displayed)
            page.execute_script("arguments[0].value = 0.75; arguments[0].oninput();", slider)
            wait(lambda: shown.text == "0.75")
            self.picture(page, "live_weights")
            page.find_element("css selector", "[value='automatic']").click()
            wait(lambda: not slider.is_displayed())
            self.assertNothingInConsole(page)

    def test_phone_and_dark(self):
        with Server(self.here / "bar.prm", log=self.here / "log.txt") as server:
            page = browser(500, 900, dark=True)
            self.addCleanup(page.quit)
            page.get(f"http://{server.host}/?token={server.token}")
            wait(lambda: "real time" in page.find_element("id", "strip").text)
            self.assertLessEqual(page.execute_script("return document.documentElement.scrollWidth - innerWidth"), 0)
            colour = page.execute_script("return getComputedStyle(document.body).backgroundColor")
            self.assertEqual(colour, "rgb(20, 23, 28)")
            self.picture(page, "live_phone_dark")
            self.assertNothingInConsole(page)

    def test_exported_page(self):
        scene = self.here / "run.prm"
        scene.write_text(prm({**BAR, "Loads/Gravity": "0, 0, -10", "Time/Step": "0.05", "Time/End": "1"}))
        output, html = self.here / "run", self.here / "run.html"
        for call in ([scene, "--output", output], ["export", output, "--html", html]):
            done = call_program(*call, timeout=120)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("21 frames", done.stdout)
        self.assertLess(html.stat().st_size, 1.5e6)
        page = browser()
        self.addCleanup(page.quit)
        page.get(f"file://{html}")
        wait(lambda: page.find_element("id", "time").text not in ("", "t = 0.00 s"))
        self.picture(page, "export")
        self.assertNothingInConsole(page)
        self.play_two(page, output)

    def play_two(self, page, output):
        """By the server, side by side."""
        with Server(output, output, log=self.here / "log.txt") as server:
            page.get(f"http://{server.host}/?token={server.token}")
            self.assertEqual(page.current_url, f"http://{server.host}/")
            self.assertEqual(page.find_element("id", "name").text, "run | run")
            page.find_element("id", "play").click()
            page.execute_script("const scrub = document.getElementById('scrub'); scrub.value = 12; scrub.oninput({ target: scrub });")
            self.assertEqual(page.find_element("id", "time").text, "t = 0.60 s")
            wait(lambda: all(any(self.pixels(page, half)[3::4]) for half in (0, 1)))
            self.picture(page, "live_runs")
            self.assertNothingInConsole(page)
            sock, status = server.handshake()
            sock.close()
            self.assertEqual(status, 404)

    def test_export_refuses(self):
        (self.here / "mine.html").write_text("mine")
        (self.here / "empty").mkdir()
        for call, words in ((["empty", "--html", "x.html"], "animation.pvd"), (["nothing", "--html", "x.html"], "nothing is no directory"),
                            (["empty", "--html", "mine.html"], "Nothing has been changed"), (["empty", "--html", "no/x.html"], "no directory")):
            done = call_program("export", *call, cwd=self.here, timeout=60)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.stderr)
        self.assertEqual((self.here / "mine.html").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
