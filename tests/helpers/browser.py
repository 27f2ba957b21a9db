"""A real headless Chromium looking at a view: where things are, and what it asked the net for."""

import math
import time
from pathlib import Path

import numpy as np

ARTIFACTS = Path(__file__).parents[2] / "artifacts"
CHROMIUM = ("/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome")
TIMEOUT = 120_000
"""Patience [ms] with a browser that renders without a GPU on a busy machine."""

ARGUMENTS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]

NO_NOTES = ".mantine-Notification-root { display: none }"
"""Keeps the browser's remark on slow rendering out of the pictures."""

FRAMES = """count => new Promise(done => {
    const next = left => left ? requestAnimationFrame(() => next(left - 1)) : done();
    next(count);
})"""


def chromium():
    """Path of the browser, None where there is none."""
    return next((path for path in CHROMIUM if Path(path).exists()), None)


class Visitor:
    """One page that shows a view; requests that leave the machine are stopped and kept.

    ``sharpness`` below one draws fewer pixels of the scene, for pages that draw many frames.
    """

    def __init__(self, browser, view, width=1280, height=800, sharpness=1.0):
        self.view, self.outside, self.sharpness = view, [], sharpness
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, accept_downloads=True
        )
        self.context.set_default_timeout(TIMEOUT)
        try:
            self._open()
        except BaseException:
            self.context.close()
            raise

    def _open(self):
        """Load the page and wait until it talks to the server and has drawn a frame."""
        view = self.view
        self.context.route("**/*", self._route)
        before = set(view._server.get_clients())
        self.page = self.context.new_page()
        self.page.on("websocket", self._socket)
        self.page.goto(f"{view.url}?fixedDpr={self.sharpness}")
        self.page.get_by_text("Names of axes").wait_for()
        wait_for(lambda: set(view._server.get_clients()) - before)
        (self.id,) = set(view._server.get_clients()) - before
        self.page.add_style_tag(content=NO_NOTES)
        self.frames(3)

    def frames(self, count):
        """Wait until the page has drawn some frames; what was sent before is in them."""
        self.page.evaluate(FRAMES, count)

    def _local(self, url):
        host = self.view.url.partition("://")[2]
        return url.startswith(("data:", "blob:", f"http://{host}", f"ws://{host}"))

    def _socket(self, socket):
        if not self._local(socket.url):
            self.outside.append(socket.url)

    def _route(self, route):
        if self._local(route.request.url):
            route.continue_()
        else:
            self.outside.append(route.request.url)
            route.abort()

    def tab(self, name):
        """Open a tab."""
        tab = self.page.get_by_role("tab", name=name)
        tab.click()
        wait_for(lambda: tab.get_attribute("aria-selected") == "true")
        self.frames(2)

    def field(self, label):
        """The visible input with a label."""
        shown = self.page.locator("label:visible").get_by_text(label, exact=True).first
        return shown.locator(
            "xpath=ancestor::div[2]//*[self::textarea or self::input[not(@type='hidden')]]"
        ).last

    def values(self):
        """What stands in the visible fields."""
        return [field.input_value() for field in self.page.locator("input:visible").all()]

    def fill(self, label, text, handle):
        """Type a text into the field with a label, until its handle on the server has it."""
        field = self.field(label)
        field.fill(text)
        field.press("Enter")
        field.press("Tab")
        wait_for(lambda: str(handle.value) == text)

    def choose(self, label, option):
        """Choose an option of a dropdown."""
        self.field(label).click()
        self.page.get_by_role("option", name=option, exact=True).click()
        wait_for(lambda: self.field(label).input_value() == option)

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
        """Press, move, release; every step is drawn before the next."""
        mouse = self.page.mouse
        mouse.move(start[0] + 1.0, start[1] + 1.0)
        self.frames(2)
        mouse.move(*start)
        self.frames(2)
        mouse.down()
        for k in range(1, steps + 1):
            mouse.move(*(a + (b - a) * k / steps for a, b in zip(start, end, strict=True)))
            self.frames(2)
        mouse.up()
        self.frames(2)

    def screenshot(self, name):
        """Keep a picture of the page among the artefacts, once it stands still."""
        ARTIFACTS.mkdir(exist_ok=True)
        self.view._server.flush()
        seen = [b""]

        def stands():
            self.frames(3)
            seen.append(self.page.screenshot(animations="disabled"))
            return seen[-1] == seen[-2]

        wait_for(stands)
        (ARTIFACTS / f"{name}.png").write_bytes(seen[-1])

    def close(self):
        """Close the page."""
        self.context.close()


def still(value, seconds=60.0):
    """What a changing array comes to rest at: the same on looks half a second apart."""
    looks = [value()]

    def rests():
        time.sleep(0.5)
        looks.append(value())
        return np.array_equal(looks[-1], looks[-2])

    wait_for(rests, seconds)
    return looks[-1]


def wait_for(condition, seconds=60.0):
    """Wait until a condition holds; fail where it does not in time."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "the page did not follow in time"
        time.sleep(0.1)
