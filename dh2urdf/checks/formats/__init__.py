"""What was found in files, as people and as programs read it.

`text` is for a terminal, `page` for a browser, `sarif` and `junit` for services that show findings
beside the lines of a change.
"""

from collections.abc import Callable, Sequence

from dh2urdf.checks.formats.checked import Checked, Unread
from dh2urdf.checks.formats.junit import junit_text
from dh2urdf.checks.formats.page import html_page
from dh2urdf.checks.formats.sarif import sarif_text
from dh2urdf.checks.formats.text import plain_text

REPORTS: dict[str, Callable[[Sequence[Checked], Sequence[Unread]], str]] = {
    "sarif": sarif_text,
    "junit": junit_text,
    "html": html_page,
}
"""By the name of a format, what writes a report of the files read and of those that were not."""
