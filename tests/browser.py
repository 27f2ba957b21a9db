"""A real headless Chromium looking at a view: where things are, and what it asked the net for."""

import math
import time
from pathlib import Path

import numpy as np

ARTIFACTS = Path(__file__).parents[1] / "artifacts"
CHROMIUM = ("/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome")
TIMEOUT = 120_000
"""Patience [ms] with a browser that renders without a GPU on a busy machine."""

ARGUMENTS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]


def chromium():
    """Path of the browser, None where there is none."""
    return next((path for path in CHROMIUM if Path(path).exists()), None)


class Visitor:
    """One page that shows a view; requests that leave the machine are stopped and kept."""

    def __init__(self, browser, view, width=1400, height=860):
        self.view, self.outside = view, []
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, accept_downloads=True
        )
        try:
            self._open()
        except BaseException:
            self.context.close()
            raise

    def _open(self):
        """Load the page and wait until it talks to the server."""
        view = self.view
        self.context.route("**/*", self._route)
        before = set(view._server.get_clients())
        self.page = self.context.new_page()
        self.page.set_default_timeout(TIMEOUT)
        self.page.goto(view.url)
        self.page.get_by_text("Names of axes").wait_for()
        wait_for(lambda: set(view._server.get_clients()) - before, 60)
        (self.id,) = set(view._server.get_clients()) - before
        note = self.page.locator(".mantine-Notification-closeButton")
        if note.count():
            note.first.evaluate("button => button.click()")

    def _route(self, route):
        url = route.request.url
        if url.startswith((self.view.url, "data:", "blob:")):
            route.continue_()
        else:
            self.outside.append(url)
            route.abort()

    def tab(self, name):
        """Open a tab."""
        self.page.get_by_role("tab", name=name).click()
        time.sleep(0.5)

    def field(self, label):
        """The visible input with a label."""
        shown = self.page.locator("label:visible").get_by_text(label, exact=True).first
        return shown.locator(
            "xpath=ancestor::div[2]//*[self::textarea or self::input[not(@type='hidden')]]"
        ).last

    def values(self):
        """What stands in the visible fields."""
        return [field.input_value() for field in self.page.locator("input:visible").all()]

    def fill(self, label, text):
        """Type a text into a field."""
        field = self.field(label)
        field.fill(text)
        field.press("Enter")
        field.press("Tab")
        time.sleep(0.4)

    def choose(self, label, option):
        """Choose an option of a dropdown."""
        self.field(label).click()
        time.sleep(0.3)
        self.page.get_by_role("option", name=option, exact=True).click()
        time.sleep(0.5)

    def button(self, name):
        """A button by its text."""
        return self.page.get_by_role("button", name=name, exact=True)

    def pixel(self, point):
        """Where a point of the scene is on the page."""
        camera = self.view._server.get_clients()[self.id].camera
        box = self.page.locator("canvas").first.bounding_box()
        position, target = np.asarray(camera.position), np.asarray(camera.look_at)
        ahead = (target - position) / np.linalg.norm(target - position)
        right = np.cross(ahead, [0, 0, 1])
        right /= np.linalg.norm(right)
        up = np.cross(right, ahead)
        way = np.asarray(point) - position
        scale = box["height"] / 2 / math.tan(camera.fov / 2) / (way @ ahead)
        return (
            box["x"] + box["width"] / 2 + scale * (way @ right),
            box["y"] + box["height"] / 2 - scale * (way @ up),
        )

    def drag(self, start, end, steps=4):
        """Press, move slowly, release; the pointer rests first until a frame has seen it."""
        self.page.mouse.move(start[0] + 1.0, start[1] + 1.0)
        time.sleep(0.7)
        self.page.mouse.move(*start)
        time.sleep(2.0)
        self.page.mouse.down()
        time.sleep(0.3)
        for k in range(1, steps + 1):
            x, y = (a + (b - a) * k / steps for a, b in zip(start, end, strict=True))
            self.page.mouse.move(x, y)
            time.sleep(0.3)
        self.page.mouse.up()
        time.sleep(0.5)

    def screenshot(self, name):
        """Keep a picture of the page among the artefacts."""
        ARTIFACTS.mkdir(exist_ok=True)
        time.sleep(1.5)
        self.page.screenshot(path=ARTIFACTS / f"{name}.png")

    def close(self):
        """Close the page."""
        self.context.close()


def wait_for(condition, seconds=40.0):
    """Wait until a condition holds; fail where it does not in time."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "the page did not follow in time"
        time.sleep(0.1)
