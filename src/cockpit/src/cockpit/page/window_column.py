"""Windows in the column of the main panel, which leaves the rest of the page to the view."""

from typing import Any, Dict

# Width of the column: two thirds of 1400 pixels are left.
WIDTH = 440


class WindowColumn:
    """Docks each new window below the tallest one, so that all can be read and the main panel stays.

    Args:
        gui: The gui of viser.
    """

    def __init__(self, gui):
        self._gui = gui
        gui.main_panel.dock_right()
        gui.main_panel.set_width(WIDTH)
        # The share of the height that viser gives each panel: a new one has half of that above it, and what
        # the others have does not change when one is removed.
        self._main_share = 1.0
        self._shares: Dict[ColumnWindow, float] = {}

    def open(self, title: str) -> "ColumnWindow":
        """Open a window; controls are created within its context.

        Args:
            title: Title of the window.
        """
        above = max(self._shares, key=self._shares.__getitem__, default=None)
        if above is None or self._main_share > self._shares[above]:
            share = self._main_share = self._main_share / 2.0
            anchor = self._gui.main_panel
        else:
            share = self._shares[above] = self._shares[above] / 2.0
            anchor = above.panel
        window = ColumnWindow(self._gui, title, anchor)
        self._shares[window] = share
        return window

    def remove(self, window: "ColumnWindow") -> None:
        """Close a window."""
        del self._shares[window]
        window.panel.remove()


class ColumnWindow:
    """A window that a person can move and dock elsewhere.

    Args:
        gui: The gui of viser.
        title: Title of the window.
        anchor: Panel below which it is docked at first.

    Attributes:
        panel: The panel of viser.
    """

    def __init__(self, gui, title: str, anchor: Any):
        self.panel = gui.add_panel()
        self._tab = self.panel.add_tab(title)
        self.panel.dock_below(anchor)

    def __enter__(self):
        return self._tab.__enter__()

    def __exit__(self, *error):
        return self._tab.__exit__(*error)
