"""Fixtures of the tests in a real Chromium."""

from contextlib import ExitStack, closing

import pytest
from browser import ARGUMENTS, Visitor, chromium


@pytest.fixture(scope="module")
def browser():
    """One browser for the module."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
    with sync_api.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=chromium(), args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def shown(browser):
    """Views with a visitor each, closed after the test; nothing may have left the machine."""
    with ExitStack() as stack:
        visitors = []

        def show(robot, q=None, **size):
            view = stack.enter_context(robot.view(q, port=0))
            visitors.append(stack.enter_context(closing(Visitor(browser, view, **size))))
            return view, visitors[-1]

        yield show
    assert [url for visitor in visitors for url in visitor.outside] == []
