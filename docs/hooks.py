"""For the site: what a search finds, and names instead of links to files outside of docs/."""

import posixpath
import re
from typing import Any

# Weight of search results by folder: tasks come before the API.
BOOST = {"get_started": 3.0, "how_to": 1.5, "reference/api": 0.5}

# Listings and signatures; those of the scripts are the text of their page.
CODE = re.compile(r'<div class="[^"]*\bhighlight\b[^"]*"')
LISTS_USAGE = "reference/scripts.md"

LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((\.\./[^)\s]*)\)")


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    folder = posixpath.dirname(page.file.src_uri)
    page.meta.setdefault("search", {"boost": BOOST.get(folder, 1.0)})

    def as_name(link: "re.Match[str]") -> str:
        path = posixpath.normpath(posixpath.join(folder, link[2].partition("#")[0]))
        return f"{link[1]} ({path.replace('../', '', 1)})" if path.startswith("../") else link[0]

    return LINK.sub(as_name, markdown)


def on_page_content(html: str, page: Any, **_: Any) -> str:
    """Leave code out of the search, whose results would show it without lines and colours."""
    if page.file.src_uri == LISTS_USAGE:
        return html
    return CODE.sub(lambda found: f"{found[0]} data-search-exclude", html)
