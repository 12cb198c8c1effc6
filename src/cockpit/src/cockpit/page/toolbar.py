"""The toolbar: what a click on the floor does, with the names of rviz's tools."""

from typing import Any, Callable

from cockpit.models.tables import paragraph

MOVE_CAMERA, NAV_GOAL, POSE_ESTIMATE = "Move Camera", "Nav Goal", "Pose Estimate"
PUBLISH_POINT, DROP_BOX, MOVE_MODEL = "Publish Point", "Drop a box", "Move the model"
TOOLS = (MOVE_CAMERA, NAV_GOAL, POSE_ESTIMATE, PUBLISH_POINT)
HINTS = {
    MOVE_CAMERA: "The mouse turns the camera.",
    NAV_GOAL: "Press on the floor, turn, release: the robot drives there.",
    POSE_ESTIMATE: "Press where the robot is, turn it the way it looks, release.",
    PUBLISH_POINT: "Click a place: it is published.",
    DROP_BOX: "Click a place: a box is dropped there.",
    MOVE_MODEL: "Press the new position of the model; drag to turn it; release.",
}
# Marks the element behind which the buttons are, for the style sheet.
MARK = "cockpit-toolbar"


class Toolbar:
    """A row of buttons and, below it, what the selected one does.

    Args:
        gui: The gui of viser; the buttons are created in its current container.
        on_mode: Called with the selected tool or mode.
        guarded: Wraps callbacks of controls so that exceptions are reported on the page.

    Attributes:
        mark: Element before the buttons, from which the style sheet takes the selected one.
        mode: The selected tool, DROP_BOX or MOVE_MODEL.
    """

    def __init__(self, gui, on_mode: Callable[[str], None], guarded: Callable[[Callable], Callable]):
        self.mode = MOVE_CAMERA
        self._on_mode = on_mode
        self.mark = gui.add_html(_mark(MOVE_CAMERA))
        self._buttons = gui.add_button_group("Mouse", TOOLS)
        self._hint = gui.add_html(paragraph(HINTS[MOVE_CAMERA]))
        self._buttons.on_click(guarded(self._click))

    def select(self, mode: str) -> None:
        """Select a tool or mode.

        Args:
            mode: One of HINTS.
        """
        self.mode = mode
        self._on_mode(mode)
        self.mark.content = _mark(mode)
        self._hint.content = paragraph(HINTS[mode])  # the hint confirms the switch

    def _click(self, _event: Any) -> None:
        self.select(self._buttons.value)


def _mark(mode: str) -> str:
    """Return the element that precedes the buttons: it fills the selected one."""
    number = TOOLS.index(mode) + 1 if mode in TOOLS else 0
    return f'<div class="{MARK}" data-selected="{number}"></div>'
