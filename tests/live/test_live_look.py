# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen of the page of exemplar live, in Chromium without a window: views, ground, cues, help, contrast; by mouse, keys and fingers.

Environment: EXEMPLAR, the program.
"""
import re
import time
import unittest
from pathlib import Path

from live_browser import PageTest, needs_browser, wait

try:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass

CONTRASTS = """
    const numbers = (text) => text.match(/[\\d.]+/g).map(Number);
    const light = ([r, g, b]) => [r, g, b].map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
        .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
    const contrast = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    const behind = (element) => {
        for (; element; element = element.parentElement) {
            const colour = numbers(getComputedStyle(element).backgroundColor);
            if (colour.length === 3 || colour[3] === 1) return colour;
        }
        return null;
    };
    const seen = (element) => element.checkVisibility({ checkVisibilityCSS: true }) && !element.closest(":disabled");
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const found = [];
    for (let node = walker.nextNode(); node; node = walker.nextNode())
        if (node.textContent.trim() && seen(node.parentElement))
            found.push([node.textContent.trim(), contrast(light(numbers(getComputedStyle(node.parentElement).color)), light(behind(node.parentElement)))]);
    return found;"""


def contrast(one, other):
    """Of two colours of style.css (WCAG 2)."""
    def light(colour):
        parts = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
        return sum(share * (c / 12.92 if c <= .04045 else ((c + .055) / 1.055) ** 2.4) for share, c in zip((.2126, .7152, .0722), parts))
    most, least = sorted((light(one), light(other)), reverse=True)
    return (most + .05) / (least + .05)


@needs_browser
class LookTest(PageTest):
    def camera(self):
        return self.of_view("view.eye.camera.position.clone().sub(view.controls.target).toArray()")

    def assertNear(self, one, other, delta):
        self.assertLess(max(abs(a - b) for a, b in zip(one, other)), delta)

    def turn(self):
        ActionChains(self.page, duration=20).move_to_element_with_offset(self.find("canvas"), -300, 200).click_and_hold().move_by_offset(150, -80).release().perform()

    def test_views(self):
        home = self.camera()
        self.turn()
        self.assertGreater(max(abs(a - b) for a, b in zip(home, self.camera())), 1.)
        target = self.of_view("view.controls.target.toArray()")
        ActionChains(self.page).key_down(Keys.SHIFT).perform()
        self.turn()  # which shifts the view then
        ActionChains(self.page).key_up(Keys.SHIFT).perform()
        self.assertGreater(max(abs(a - b) for a, b in zip(target, self.of_view("view.controls.target.toArray()"))), .3)
        self.find("fit").click()
        wait(lambda: max(abs(a - b) for a, b in zip(home, self.camera())) < .05)
        self.assertNear(target, self.of_view("view.controls.target.toArray()"), .02)
        for key, name, axis, sign in (("1", "front", 1, -1), ("2", "side", 0, 1), ("3", "top", 2, 1)):
            for act in (lambda: self.find(name).click(), lambda: ActionChains(self.page).send_keys(key).perform()):
                self.turn()
                act()
                wait(lambda: sign * self.camera()[axis] > .999 * sum(x * x for x in self.camera()) ** .5)
        self.find("canvas").send_keys(Keys.ARROW_DOWN + Keys.ARROW_DOWN + Keys.ARROW_RIGHT)
        wait(lambda: abs(self.camera()[0]) > .1)
        before = sum(x * x for x in self.camera()) ** .5
        self.find("canvas").send_keys("+")
        wait(lambda: sum(x * x for x in self.camera()) ** .5 < .95 * before)

    def test_ground_is_drawn(self):
        lowest = self.of_view("Math.min(...view.body.places.filter((_, i) => i % 3 === 2))")
        ground = self.of_view("view.ground.shade.position.z")
        self.assertLess(ground, lowest)
        self.assertGreater(ground, lowest - .1)
        script = """const done = arguments[0]; import('./app.js').then(({ view }) => { view.draw(); const gl = view.renderer.getContext();
            done([-0.56, -2].map((y) => { const at = view.onPage(view.ground.shade.position.clone().add({ x: 0, y, z: 0 }));
                const k = view.renderer.getPixelRatio(); const out = new Uint8Array(4);
                gl.readPixels(at.x * k, view.renderer.domElement.height - at.y * k, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out); return Array.from(out); })); });"""
        near, far = self.page.execute_async_script(script)
        self.assertGreater(far[3], 40)  # a ground
        self.assertLess(max(near[:3]) / near[3], .9 * max(far[:3]) / far[3])  # darker beside the body
        ActionChains(self.page).send_keys("g").perform()
        self.assertEqual(self.find("ground").get_attribute("aria-pressed"), "false")
        self.assertEqual([pixel[3] for pixel in self.page.execute_async_script(script)], [0, 0])
        self.assertIn("drawn only", self.text("said"))

    def test_cue_before_and_hint_until_the_first_pull(self):
        canvas, hint = self.find("canvas"), self.find("hint")
        wait(hint.is_displayed)
        ActionChains(self.page).move_to_element(canvas).perform()
        wait(lambda: canvas.get_attribute("data-over") == "body")
        self.assertGreater(self.of_view("view.body.patch.patchRadius.value"), .1)
        self.assertEqual(self.run_script("return getComputedStyle(arguments[0]).cursor", canvas), "grab")
        ActionChains(self.page).move_to_element_with_offset(canvas, -300, 200).perform()
        wait(lambda: canvas.get_attribute("data-over") == "beside")
        self.assertEqual(self.of_view("view.body.patch.patchRadius.value"), 0)
        ActionChains(self.page).move_to_element(canvas).click_and_hold().move_by_offset(0, -30).perform()
        wait(lambda: not hint.is_displayed())
        self.assertEqual(self.run_script("return getComputedStyle(arguments[0]).cursor", canvas), "grabbing")
        ActionChains(self.page).release().perform()
        time.sleep(.5)
        self.assertFalse(hint.is_displayed())

    def test_help(self):
        overlay = self.find("overlay")
        ActionChains(self.page).send_keys("?").perform()
        wait(overlay.is_displayed)
        for word in ("Space", "pinch", "drag the body", "with or without examples"):
            self.assertIn(word, overlay.text)
        self.assertEqual(self.page.switch_to.active_element.get_attribute("id"), "close")
        ActionChains(self.page).send_keys("r").send_keys(Keys.ESCAPE).perform()
        wait(lambda: not overlay.is_displayed())
        self.find("help").click()
        wait(overlay.is_displayed)
        self.find("close").click()
        self.assertFalse(overlay.is_displayed())

    def test_words_for_who_is_no_engineer(self):
        self.assertRegex(self.text("strip"), r"^(real time|slow motion: \d+ % of real time)$")
        self.find("strip").find_element("css selector", "summary").click()
        for word in ("behind the clock", "step error", "iterations"):
            self.assertIn(word, self.text("numbers"))
        words = self.page.execute_async_script("const done = arguments[0]; import('./words.js').then((w) => done([w.speedWords(true, 1), w.speedWords(false, 1.02),"
                                               "w.speedWords(false, 0.4), w.short(0), w.short(1.25e6), w.withUnit(1.25e6, 'Pa'), w.short(0.9000000001)]));")
        self.assertEqual(words, ["paused", "real time", "slow motion: 40 % of real time", "0", "1.25e6", "1.25 MPa", "0.9"])

    def test_picture(self):
        self.find("picture").click()
        wait(lambda: (self.here / "exemplar-bar.png").exists())
        self.assertEqual((self.here / "exemplar-bar.png").read_bytes()[:4], b"\x89PNG")

    def test_all_is_reached_by_tab(self):
        reached = set()
        self.run_script("document.activeElement.blur();")
        for _ in range(60):
            ActionChains(self.page).send_keys(Keys.TAB).perform()
            reached.add(self.run_script("const e = document.activeElement; return e.id || e.getAttribute('name') || e.tagName;"))
        self.assertLessEqual({"canvas", "fit", "front", "side", "top", "ground", "picture", "help", "SUMMARY", "with", "rule", "pause", "reset", "tool", "strength",
                              "importance", "young", "poisson", "damping", "gravity", "colour", "energy", "ball", "block"}, reached)

    def test_nothing_moves_by_itself(self):
        self.run_script("window.shift = 0; new PerformanceObserver((list) => list.getEntries().forEach(({ value }) => (window.shift += value)))"
                        ".observe({ type: 'layout-shift', buffered: true });")
        self.page.find_element("css selector", "[value='by hand']").click()
        self.page.find_element("css selector", "#colour option[value='energy']").click()
        self.find("pause").click()
        time.sleep(1.5)
        self.assertLess(self.run_script("return window.shift;"), .02)

    def test_who_wants_no_motion_sees_none(self):
        self.assertEqual(self.run_script("return document.getAnimations().length"), 1)  # of the hint
        self.page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]})
        wait(lambda: self.run_script("return document.getAnimations().length") == 0)
        self.assertIsNone(self.of_view("(view.look('side'), view.eye.flight)"))


@needs_browser
class ColoursTest(unittest.TestCase):
    def check(self, dark):
        page_test = PageTest("open")
        page_test.page_options = {"dark": dark}
        self.addCleanup(page_test.doCleanups)
        page_test.setUp()
        page_test.find("strip").find_element("css selector", "summary").click()
        page_test.run_script("document.getElementById('notice').hidden = false; document.getElementById('notice').textContent = 'words';")
        found = page_test.run_script(CONTRASTS)
        page_test.find("help").click()
        found += page_test.run_script(CONTRASTS)
        self.assertGreater(len(found), 60)
        self.assertEqual([(text, round(value, 2)) for text, value in found if value < 4.5], [])

    def test_light(self):
        self.check(False)

    def test_dark(self):
        self.check(True)

    def test_marks(self):
        css = (Path(__file__).resolve().parents[2] / "source/live/style.css").read_text()
        themes = [dict(re.findall(r"--([\w-]+): (#\w{6})", part)) for part in css.split("@media (prefers-color-scheme: dark)")[:2]]
        for colours in (themes[0], {**themes[0], **{name: value for name, value in themes[1].items() if name in themes[0]}}):
            for name in ("handle", "pin", "spring"):  # bright, within a dark edge
                self.assertGreater(contrast(colours[name], colours["edge"]), 3.)
            self.assertGreater(contrast(colours["edge"], colours["body"]), 3.)
            for name in ("border", "accent"):
                for behind in ("panel", "back"):
                    self.assertGreater(contrast(colours[name], colours[behind]), 3., f"{name} on {behind}")


@needs_browser
class PhoneTest(PageTest):
    page_options = {"width": 390, "height": 844, "phone": True}

    def test_bars_are_in_view(self):
        self.assertEqual(self.run_script("return innerWidth"), 390)
        self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), 390)
        boxes = self.run_script("return [...document.querySelectorAll('.weight')].flatMap((e) => [...e.querySelectorAll('canvas, .bar, output')])"
                                ".map((e) => e.getBoundingClientRect().toJSON());")
        self.assertEqual(len(boxes), 6)
        for box in boxes:
            self.assertGreater(box["width"], 10)
            self.assertTrue(box["left"] >= 0 and box["right"] <= 390 and box["bottom"] <= 844 and box["top"] > 0, box)
        self.assertEqual(self.run_script("return [...document.querySelectorAll('input, select, summary')].filter((e) => e.checkVisibility())"
                                         ".map((e) => (e.closest('label') || e).getBoundingClientRect()).filter(({ height }) => height < 40).length;"), 0)
        small = self.run_script("return [...document.querySelectorAll('button')].filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect())"
                                ".filter(({ width, height }) => width < 24 || height < 40).length;")
        self.assertEqual(small, 0)

    def touch(self, kind, *points):
        self.page.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})

    def distance(self):
        return self.of_view("view.eye.camera.position.distanceTo(view.controls.target)")

    def test_fingers(self):
        before, place = self.distance(), self.of_view("view.eye.camera.position.toArray()")
        self.touch("touchStart", (60, 400))  # beside the body
        self.touch("touchMove", (120, 400))
        self.touch("touchEnd")
        wait(lambda: max(abs(a - b) for a, b in zip(place, self.of_view("view.eye.camera.position.toArray()"))) > .5)
        self.find("fit").click()
        wait(lambda: self.of_view("view.eye.flight") is None)
        self.spy()
        middle = (195, 240)
        self.touch("touchStart", middle)  # on the body: a pull
        wait(lambda: self.sent("grab"))
        self.touch("touchMove", (195, 200))
        wait(lambda: self.sent("move"))
        self.touch("touchEnd")
        wait(lambda: self.sent("release"))
        self.page.execute_script("arguments[0].scrollIntoView();", self.find("pause"))
        self.find("pause").click()
        self.find("reset").click()  # as the body swings away
        wait(lambda: not self.find("undo").is_enabled())
        time.sleep(.3)  # the frame comes by itself
        self.touch("touchStart", middle)  # a pinch that begins there
        wait(lambda: len(self.sent("grab")) == 2)
        self.touch("touchStart", middle, (195, 300))
        wait(lambda: len(self.sent("release")) == 2)
        for way in range(10, 60, 10):
            self.touch("touchMove", (195, 240 - way), (195, 300 + way))
        self.touch("touchEnd")
        wait(lambda: self.distance() < .8 * before)


if __name__ == "__main__":
    unittest.main()
