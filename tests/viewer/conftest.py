"""Fixtures of the tests in a real Chromium."""

from contextlib import ExitStack, closing

import pytest
from browser import Visitor


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
