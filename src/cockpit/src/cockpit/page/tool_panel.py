"""The Tools tab."""

from typing import Any, Callable, Dict, Iterable, Tuple


class ToolPanel:
    """The Tools tab, with a checkbox for each tool.

    Args:
        gui: The gui of viser.
        tools: Name and title of each tool.
        on_switch: Called with a tool's name and whether it should be open.
    """

    def __init__(self, gui, tools: Iterable[Tuple[str, str]], on_switch: Callable[[str, bool], None]):
        self._boxes: Dict[str, Any] = {}
        gui.add_markdown("Each tool opens a window that can be moved and docked.")
        for name, title in tools:
            box = gui.add_checkbox(title, False)
            box.on_update(lambda _, name=name, box=box: on_switch(name, box.value))
            self._boxes[name] = box

    def open(self, name: str) -> None:
        """Tick the checkbox of a tool."""
        self._boxes[name].value = True
