"""The arm as a page of its own: one HTML file that works offline, with sliders and lessons."""

from dh2urdf.page.standalone import page_html, save_page

__all__ = ["page_html", "save_page"]
