"""HTML report of an evaluation."""

from laboratory.page.page import page_html

__all__ = ["page_html"]
