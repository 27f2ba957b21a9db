"""The built documentation: links, anchors, nothing from outside."""

from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

import pytest

pytestmark = pytest.mark.site

LOADED = {"script": "src", "img": "src", "link": "href", "source": "src", "iframe": "src"}
"""Elements that a browser fetches something for, and the attribute that says what."""


class Page(HTMLParser):
    """Anchors of a page, where it links to, and what it loads."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loads = {"", "top"}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        """Keep what an element says."""
        given = dict(attrs)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if given.get(LOADED.get(tag)):
            self.loads.append(given[LOADED[tag]])


@pytest.fixture(scope="module")
def read(site, pages):
    """Every page, read."""
    return {site / page: Page((site / page).read_text(encoding="utf-8")) for page in pages}


def test_every_link_leads_somewhere(read):
    """Each link within the site has its page, and its anchor there."""
    dead = []
    for path, page in read.items():
        for link in page.links + page.loads:
            parts = urlsplit(link)
            if parts.scheme:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            there = read.get(target)
            if not target.is_file() or (there and unquote(parts.fragment) not in there.anchors):
                dead.append((path.name, link))
    assert not dead


def test_nothing_is_loaded_from_outside(read):
    """Pages load files beside them only, and links are relative: they work from file://."""
    for path, page in read.items():
        assert not [x for x in page.loads if urlsplit(x).scheme not in ("", "data")], path
        assert not [x for x in page.links if x.startswith("/")], path
