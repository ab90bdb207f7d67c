# SPDX-License-Identifier: GPL-3.0-or-later
"""Chromium without a window, for tests of pages. What needs it is left out where Chromium or selenium is not installed."""
import functools
import os
import shutil
import tempfile
import unittest
from pathlib import Path

from live_server import BAR, Server, prm, wait_until

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
except ImportError:
    webdriver = None

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
PICTURES = "SCREENSHOTS" in os.environ  # which are for people; else a quarter of the pixels is a third less to compute
needs_browser = unittest.skipUnless(webdriver and CHROMIUM and DRIVER, "chromium, chromedriver or selenium is not installed")
wait = functools.partial(wait_until, seconds=60, pause=.1)  # as each look is work for the browser


def browser(width=1280, height=800, dark=False, phone=False, downloads=None):
    """`phone`: with fingers, and as narrow as no window can be."""
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", f"--window-size={width},{height}",
                     f"--force-device-scale-factor={1 if PICTURES else .5}", f"--blink-settings=preferredColorScheme={0 if dark else 1}"):
        options.add_argument(argument)
    if phone:
        options.add_experimental_option("mobileEmulation", {"deviceMetrics": {"width": width, "height": height, "pixelRatio": 1.}})
    if downloads:
        options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


def complaints(page):
    """Of the console, but for those of graphics without a graphics card."""
    return [entry for entry in page.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")
            and "GPU stall" not in entry["message"] and "WebGL" not in entry["message"]]


class PageTest(unittest.TestCase):
    """A page of its own, of a server of its own."""
    page_options = {}

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.here = Path(directory.name)
        (self.here / "bar.prm").write_text(prm(BAR))
        self.server = Server(self.here / "bar.prm", log=self.here / "log.txt")
        self.addCleanup(self.server.__exit__)
        self.page = browser(**self.page_options, downloads=self.here)
        self.addCleanup(self.page.quit)
        self.open()

    def open(self):
        self.page.get(f"http://{self.server.host}/?token={self.server.token}")
        wait(lambda: "real time" in self.text("strip"))

    def tearDown(self):
        self.assertEqual(complaints(self.page), [])

    def find(self, name):
        return self.page.find_element("id", name)

    def text(self, name):
        return self.find(name).text

    def run_script(self, text, *arguments):
        return self.page.execute_script(text, *arguments)

    def of_view(self, expression):
        """What is known of `view`, which app.js exports."""
        return self.page.execute_async_script(f"const done = arguments[0]; import('./app.js').then(({{ view }}) => done({expression}));")

    def slide(self, name, value):
        """As a hand does that has not let go yet."""
        self.run_script("const slider = document.getElementById(arguments[0]); slider.value = arguments[1];"
                        "slider.dispatchEvent(new Event('input', { bubbles: true }));", name, value)

    def shown(self, name):
        return self.find(name).find_element("xpath", "preceding-sibling::output").text

    def spy(self):
        """What the page sends from now on is noted with its time."""
        self.run_script("window.sent = []; const send = WebSocket.prototype.send; WebSocket.prototype.send = function (text) {"
                        "if (text[0] === '{') window.sent.push({ at: performance.now(), ...JSON.parse(text) }); return send.call(this, text); };")

    def sent(self, kind):
        return self.run_script("return window.sent.filter(({ type }) => type === arguments[0]);", kind)

    def pin(self):
        """By a brush, in the middle of the bar."""
        self.page.find_element("css selector", "[value=pin]").click()
        ActionChains(self.page, duration=20).move_to_element(self.find("canvas")).click_and_hold().move_by_offset(6, 0).release().perform()

    def pins(self):
        return [item.text.split("\n")[0] for item in self.page.find_elements("css selector", "#pins li")]
