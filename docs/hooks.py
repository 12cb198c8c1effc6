"""For the site: what lies outside of docs/ is named, not linked, as it is not part of it."""

import re
from typing import Any

OUTSIDE = re.compile(r"(?<!!)\[([^\]]*)\]\((\.\./[^)\s]*)\)")


def on_page_markdown(markdown: str, **_: Any) -> str:
    return OUTSIDE.sub(lambda link: f"{link[1]} ({link[2][3:].partition('#')[0]})", markdown)
