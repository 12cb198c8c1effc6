"""The Tools tab with a checkbox for each tool, and the windows of open tools."""

from typing import Any, Callable, Dict, Iterable, Tuple

WIDTH = 420


class ToolPanel:
    """The Tools tab, with a checkbox for each tool.

    Args:
        gui: The gui of viser.
        tools: Name and title of each tool.
        on_switch: Called with a tool's name and whether it should be open.
    """

    def __init__(self, gui, tools: Iterable[Tuple[str, str]], on_switch: Callable[[str, bool], None]):
        self._gui = gui
        self._boxes: Dict[str, Any] = {}
        gui.add_markdown("Each tool opens a window that can be moved and docked.")
        for name, title in tools:
            box = gui.add_checkbox(title, False)
            box.on_update(lambda _, name=name, box=box: on_switch(name, box.value))
            self._boxes[name] = box

    def open(self, name: str) -> None:
        """Tick the checkbox of a tool."""
        self._boxes[name].value = True

    def window(self, title: str, width: int) -> Any:
        """Create a window; controls are created within its context.

        Args:
            title: Title of the window.
            width: Width of the window [pixels].
        """
        return ToolWindow(self._gui, title, width)


class ToolWindow:
    """A movable window of the page.

    Args:
        gui: The gui of viser.
        title: Title of the window.
        width: Width of the window [pixels].
    """

    def __init__(self, gui, title: str, width: int = WIDTH):
        self._panel = gui.add_panel()
        self._tab = self._panel.add_tab(title)
        self._panel.dock_left()
        self._panel.set_width(width)

    def __enter__(self):
        return self._tab.__enter__()

    def __exit__(self, *error):
        return self._tab.__exit__(*error)

    def remove(self) -> None:
        self._panel.remove()
