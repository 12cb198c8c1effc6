"""One HTML file that shows what came of suites."""

from laboratory.page.page import page_html

__all__ = ["page_html"]
