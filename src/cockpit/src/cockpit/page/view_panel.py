"""The View tab: layers, fixed frame and camera."""

from typing import Any, Callable, Dict, Tuple

from cockpit.layer import DisplayLayer

AUTOMATIC = "automatic"


class ViewPanel:
    """A checkbox for each topic of a layer, the fixed frame, and the camera.

    Args:
        gui: The gui of viser.
        tab: The tab's context.
        on_cut: Called with the height above which the world is hidden [m].
    """

    def __init__(self, gui, tab, on_cut: Callable[[float], None]):
        self._gui, self._tab = gui, tab
        self._folders: Dict[str, Any] = {}
        self._boxes: Dict[str, Any] = {}
        self._chosen: Dict[str, bool] = {}
        with tab:
            self._build()
        self.height.on_update(lambda _: on_cut(self.height.value))

    def _build(self) -> None:
        gui = self._gui
        self.status = gui.add_html("")
        self.follow = gui.add_checkbox("Follow the robot", False, hint="moves the camera with the robot")
        self.fixed = gui.add_dropdown(
            "Fixed frame", (AUTOMATIC,), hint="frame in which everything is displayed"
        )
        self.height = gui.add_slider(
            "Cut at (m)", min=0.2, max=3.0, step=0.1, initial_value=1.2, hint="hides what is higher"
        )
        with gui.add_folder("World"):
            self.world = gui.add_checkbox("World", True)
            self.robots = gui.add_checkbox("Robots", True)
            self.frames = gui.add_checkbox("Frames (tf)", False)

    def offer_frames(self, names: Tuple[str, ...]) -> None:
        if self.fixed.options != (AUTOMATIC, *names):
            self.fixed.options = (AUTOMATIC, *names)

    def offer(self, topic: str, layer: DisplayLayer) -> None:
        """Add a checkbox for a topic, with its state when it was last listed.

        Args:
            topic: Name of the topic.
            layer: Layer that draws it.
        """
        if topic in self._boxes:
            return
        if layer.title not in self._folders:
            with self._tab:
                folder = self._gui.add_folder(layer.title, expand_by_default=bool(layer.shown))
            self._folders[layer.title] = folder
        self._folders[layer.title].visible = True
        with self._folders[layer.title]:
            box = self._gui.add_checkbox(topic, self._chosen.get(topic, layer.is_shown_at_first(topic)))
        self._boxes[topic] = box

    def withdraw(self, topic: str) -> None:
        """Remove the checkbox of a topic that has disappeared."""
        box = self._boxes.pop(topic)
        self._chosen[topic] = box.value
        box.remove()

    def offered(self) -> Dict[str, bool]:
        """Return the listed topics and whether each is enabled."""
        return {topic: box.value for topic, box in self._boxes.items()}

    def show_status(self, text: str) -> None:
        """Show a status line (HTML)."""
        if self.status.content != text:
            self.status.content = text
