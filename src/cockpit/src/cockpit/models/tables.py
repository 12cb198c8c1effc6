"""HTML tables and paragraphs; all text from the graph is escaped."""

from html import escape
from typing import Iterable, Sequence

STYLE = (
    "font-size:11px;line-height:1.5;font-family:ui-monospace,monospace;max-height:320px;overflow:auto;"
    "margin:0 12px 8px 12px"
)
CELL = "padding:0 10px 0 0;vertical-align:top;text-align:left"
LINE, TEXT = ";white-space:nowrap", ";white-space:pre-wrap;overflow-wrap:break-word;min-width:180px"
LONGEST_LINE = 48


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Format a table; cells are converted with ``str``."""
    head = "".join(f'<th style="{CELL};opacity:.6;font-weight:600">{escape(text)}</th>' for text in heads)
    body = "".join("<tr>" + "".join(_cell(str(cell)) for cell in row) + "</tr>" for row in rows)
    return f'<div style="{STYLE}"><table style="border-collapse:collapse"><tr>{head}</tr>{body}</table></div>'


def _cell(text: str) -> str:
    """Format a cell; long texts are broken between words, and names never."""
    is_line = len(text) <= LONGEST_LINE or not any(map(str.isspace, text))
    return f'<td style="{CELL}{LINE if is_line else TEXT}">{escape(text)}</td>'


def paragraph(text: str) -> str:
    """Format a short paragraph."""
    return f'<div style="margin:0 12px 6px 12px;font-size:12px;opacity:.75">{escape(text)}</div>'


def preformatted(text: str) -> str:
    return f'<div style="{STYLE};white-space:pre">{escape(text)}</div>'
