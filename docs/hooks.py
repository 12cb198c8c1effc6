"""For the site: a link to a file outside of docs/ becomes its name, as the site does not contain it."""

import posixpath
import re
from typing import Any

LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((\.\./[^)\s]*)\)")


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    folder = posixpath.dirname(page.file.src_uri)

    def as_name(link: "re.Match[str]") -> str:
        path = posixpath.normpath(posixpath.join(folder, link[2].partition("#")[0]))
        return f"{link[1]} ({path.replace('../', '', 1)})" if path.startswith("../") else link[0]

    return LINK.sub(as_name, markdown)
