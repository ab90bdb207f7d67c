# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw doc/figures/live.png: the page of exemplar live, with the cat pulled up by its back.

Usage: python3 doc/scripts/render_live.py
It needs Debian's chromium, chromium-driver and python3-selenium.
Environment: EXEMPLAR, the program.
"""
import os
import sys
import tempfile
import time
from pathlib import Path

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

TOP = Path(__file__).resolve().parents[2]
os.environ.setdefault("SCREENSHOTS", "")  # live_browser.py then takes all pixels
sys.path.insert(0, str(TOP / "tests/live"))
from live_browser import browser  # noqa: E402
from live_server import Server  # noqa: E402

PLACE = (12, -12)  # of the back, from the middle of the canvas [pixels]
STEPS = 12  # of the way of the pointer, upwards


def simulated(page):
    """[s]"""
    return float(page.execute_script("return parseFloat((document.querySelector('#numbers dd') || {}).textContent) || 0;"))


def wait_for(page, seconds):
    """Of simulated time."""
    goal = simulated(page) + seconds
    while simulated(page) < goal:
        time.sleep(.1)


def main():
    with tempfile.TemporaryDirectory() as directory, Server(TOP / "prm/live/cat.prm", log=Path(directory) / "log.txt") as server:
        page = browser(1100, 760)
        try:
            page.get(f"http://{server.host}/?token={server.token}")
            wait_for(page, .5)
            canvas = page.find_element("id", "canvas")
            page.execute_script("for (let i = 0; i < 5; ++i) arguments[0].dispatchEvent(new WheelEvent('wheel', { deltaY: 100 }));", canvas)
            hand = ActionChains(page, duration=20)
            hand.move_to_element_with_offset(canvas, *PLACE).click_and_hold()
            for _ in range(STEPS):
                hand.move_by_offset(4, -13)
            hand.perform()
            wait_for(page, 2.5)
            page.find_element("id", "pause").send_keys(Keys.SPACE)  # the strip is then that of no machine
            time.sleep(1.)
            page.save_screenshot(str(TOP / "doc/figures/live.png"))
        finally:
            page.quit()


if __name__ == "__main__":
    main()
