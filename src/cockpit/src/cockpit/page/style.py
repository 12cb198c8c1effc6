"""The style sheet of the page, for what viser has no options for."""

from cockpit.page.toolbar import MARK, TOOLS

_BUTTONS = f"div:has(> .{MARK}{{which}}) + div"
_SELECTED = ", ".join(
    f'{_BUTTONS.format(which=f"""[data-selected="{number}"]""")} button:nth-child({number})'
    for number in range(1, len(TOOLS) + 1)
)
_HAS_BOX = ":has(> .mantine-Checkbox-root, > div > .mantine-Checkbox-root)"
_HAS_ROW = ":has(> div > .mantine-Checkbox-root, > div > div > .mantine-Checkbox-root)"
# viser gives all labels the same narrow column and breaks longer ones anywhere. Those of checkboxes, which
# are names of topics, have the rest of the row instead.
SHEET = f"""
.mantine-Flex-root{_HAS_ROW} {{ flex-direction: row-reverse; justify-content: flex-end; gap: 8px; }}
.mantine-Flex-root{_HAS_ROW} > div:first-child {{ width: auto !important; flex-shrink: 1 !important; }}
.mantine-Flex-root{_HAS_ROW} > div{_HAS_BOX} {{ flex-grow: 0 !important; }}
.mantine-Text-root:has(> label) {{ overflow-wrap: break-word !important; }}
{_BUTTONS.format(which="")} .mantine-Flex-root > div:has(label) {{ display: none; }}
{_SELECTED} {{ background: var(--mantine-primary-color-filled); color: white; }}
"""


def sheet_html() -> str:
    """Return the style sheet as an element."""
    return f"<style>{SHEET}</style>"
