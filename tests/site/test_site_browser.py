"""The documentation in a browser, from file://, without a network."""

from urllib.parse import urlsplit

import pytest

pytestmark = pytest.mark.browser

WIDE = """() => {
    const width = document.documentElement.clientWidth;
    return document.documentElement.scrollWidth > width ? document.documentElement.scrollWidth : 0;
}"""


@pytest.fixture(params=[390, 1280], scope="module")
def page(browser, request):
    """An empty page of a width, as of a phone and of a desk."""
    context = browser.new_context(viewport={"width": request.param, "height": 844})
    page = context.new_page()
    page.outside = []
    page.on("request", lambda r: page.outside.append(r.url))
    yield page
    context.close()


def test_no_page_scrolls_sideways(page, site, pages):
    """At each width every page fits; tables, formulas and code scroll within their boxes."""
    wide = {}
    for path in pages:
        page.goto(f"file://{site / path}")
        if width := page.evaluate(WIDE):
            wide[str(path)] = width
    assert not wide
    assert {urlsplit(url).scheme for url in page.outside} <= {"file", "data"}


def test_search_finds_singularity(page, site):
    """The search box answers from file://, with a page that has the word."""
    page.goto(f"file://{site / 'index.html'}")
    box = page.locator("input[name=q]").first
    box.evaluate("(box) => { box.value = 'singularity'; box.form.submit(); }")
    page.locator("#search-results li a").first.wait_for()
    page.locator("#search-results li a").first.click()
    page.wait_for_load_state()
    assert "singular" in page.locator("article").inner_text().lower()
