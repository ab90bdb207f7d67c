# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of exemplar live, in Chromium without a window: it shows the server's state, and its sliders act while they are dragged.

Environment: EXEMPLAR, the program.
"""
import unittest

from live_browser import PageTest, needs_browser, wait
from live_client import Viewer

try:
    from selenium.webdriver.common.action_chains import ActionChains
except ImportError:
    pass


@needs_browser
class StateOnPageTest(PageTest):
    def test_reload_and_second_viewer(self):
        self.pin()
        wait(lambda: self.pins() == ["pin 1"])
        wanted = {"young": (6.3, "2 MPa"), "poisson": (.45, "0.45"), "importance": (.9, "0.9"), "damping": (3.5, "3.5 /s"), "gravity": (-1.5, "-1.5 m/s²")}
        for name, (value, _) in wanted.items():
            self.slide(name, value)
        self.page.find_element("css selector", "#colour option[value='det F']").click()

        def check():
            wait(lambda: {name: self.shown(name) for name in wanted} == {name: text for name, (_, text) in wanted.items()})
            self.assertEqual({name: float(self.find(name).get_attribute("value")) for name in wanted}, {name: value for name, (value, _) in wanted.items()})
            self.assertEqual((self.pins(), self.find("colour").get_attribute("value")), (["pin 1"], "det F"))
            self.assertGreater(self.of_view("view.marks.group.children.filter(({ userData }) => userData.name === '1').length"), 0)

        check()
        self.page.refresh()
        check()
        self.page.switch_to.new_window("tab")
        self.open()
        check()
        self.assertFalse(self.find("young").is_enabled())  # another has the mouse
        self.find("take").click()
        wait(self.find("young").is_enabled)

    def test_reset_and_undo(self):
        for _ in range(2):
            self.pin()
            wait(lambda: self.pins() == ["pin 1"])
            self.find("undo").click()
            wait(lambda: self.pins() == [])
        self.assertFalse(self.find("undo").is_enabled())
        self.pin()
        self.slide("gravity", -2)
        wait(lambda: (self.pins(), self.shown("gravity")) == (["pin 1"], "-2 m/s²"))
        self.find("reset").click()
        wait(lambda: (self.pins(), self.shown("gravity"), self.find("gravity").get_attribute("value")) == ([], "0 m/s²", "0"))
        self.assertFalse(self.find("notice").is_displayed())  # nothing was refused
        self.page.find_element("css selector", "[value='by hand']").click()
        wait(self.page.find_element("css selector", ".weight input").is_displayed)
        self.find("reset").click()
        wait(lambda: self.page.find_element("css selector", "[value=automatic]").is_selected())

    def test_who_loses_the_mouse_lets_go(self):
        ActionChains(self.page).move_to_element(self.find("canvas")).click_and_hold().move_by_offset(0, -30).perform()
        wait(lambda: self.find("canvas").get_attribute("data-over") == "pull")
        with Viewer(self.server) as other:
            other.send(type="take mouse")
            wait(lambda: self.find("canvas").get_attribute("data-over") != "pull")
            ActionChains(self.page).move_by_offset(0, -30).release().perform()
            self.assertFalse(self.find("notice").is_displayed())  # nothing was asked for that would be refused

    def test_a_refused_slider_goes_back(self):
        shown, place = self.shown("poisson"), self.find("poisson").get_attribute("value")
        self.run_script("document.getElementById('poisson').max = 2;")
        self.slide("poisson", 1.5)
        wait(self.find("notice").is_displayed)
        wait(lambda: (self.shown("poisson"), self.find("poisson").get_attribute("value")) == (shown, place))

    def test_numbers_of_sliders_are_round(self):
        for name, pattern in (("importance", r"0\.\d\d?|1"), ("poisson", r"0(\.\d\d?)?"), ("damping", r"\d+(\.\d)? /s"), ("gravity", r"-?\d+(\.\d)? m/s²"),
                              ("young", r"\d(\.\d)? [kM]Pa|\d\d\d? [kM]Pa")):
            before = self.shown(name)
            for share in (.13, .45, .77):
                self.run_script("const s = document.getElementById(arguments[0]); const [a, b] = [Number(s.min), Number(s.max)];"
                                "s.value = a + arguments[1] * (b - a); s.dispatchEvent(new Event('input', { bubbles: true }));", name, share)
                wait(lambda: self.shown(name) != before)
                before = self.shown(name)
                self.assertRegex(before, f"^({pattern})$")

    def test_sliders_act_while_they_are_dragged(self):
        self.spy()
        for name, kind, least in (("gravity", "gravity", 100), ("young", "set", 250)):
            script = """const [name, done] = arguments; const slider = document.getElementById(name); let i = 0;
                const next = () => { slider.value = Number(slider.min) + (i + 1) * Number(slider.step);
                    slider.dispatchEvent(new Event('input', { bubbles: true })); ++i < 60 ? setTimeout(next, 25) : done(Number(slider.value)); }; next();"""
            last = self.page.execute_async_script(script, name)
            while_dragged = len(self.sent(kind))
            self.assertGreater(while_dragged, 2)
            wait(lambda: self.sent(kind)[-1]["numbers"][-1] == (float(f"{10 ** last:.1e}") if name == "young" else last))
            times = [message["at"] for message in self.sent(kind)]
            self.assertGreaterEqual(min(b - a for a, b in zip(times, times[1:])), least - 2)  # timers are of whole milliseconds
        wait(lambda: (self.shown("gravity"), self.shown("young")) == ("-14 m/s²", "10 MPa"))

    def test_with_and_without_examples(self):
        switch = self.find("with")
        self.assertTrue(switch.is_selected())
        self.slide("importance", .6)
        wait(lambda: self.shown("importance") == "0.6")
        with Viewer(self.server) as other:
            ActionChains(self.page).send_keys("e").perform()
            wait(lambda: (switch.is_selected(), self.shown("importance")) == (False, "0.001"))
            other.until(lambda: [text for text in other.texts if text["type"] == "state"][-1]["with_examples"] is False)
            self.page.refresh()
            wait(lambda: not self.find("with").is_selected())
            self.find("take").is_displayed() and self.find("take").click()
            wait(self.find("with").is_enabled)
            self.find("with").click()
            wait(lambda: (self.find("with").is_selected(), self.shown("importance")) == (True, "0.6"))


if __name__ == "__main__":
    unittest.main()
