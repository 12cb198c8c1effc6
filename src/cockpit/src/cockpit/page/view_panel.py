"""What is shown and from where: the page's tab of layers."""

from typing import Any, Callable, Dict, Tuple

from cockpit.layer import DisplayLayer

AUTOMATIC = "automatic"


class ViewPanel:
    """Checkboxes of layers, which come and go with their topics; the fixed frame; the camera."""

    def __init__(self, gui, tab, on_cut: Callable[[float], None]):
        """``tab``: what the controls are in."""
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
        self.follow = gui.add_checkbox("Follow the robot", False, hint="the camera keeps its view of it")
        self.fixed = gui.add_dropdown("Fixed frame", (AUTOMATIC,), hint="in which everything is shown")
        self.height = gui.add_slider(
            "Cut at (m)", min=0.2, max=3.0, step=0.1, initial_value=1.2, hint="what is higher is taken off"
        )
        with gui.add_folder("World"):
            self.world = gui.add_checkbox("World", True)
            self.robots = gui.add_checkbox("Robots", True)
            self.frames = gui.add_checkbox("Frames (tf)", False)

    def offer_frames(self, names: Tuple[str, ...]) -> None:
        if self.fixed.options != (AUTOMATIC, *names):
            self.fixed.options = (AUTOMATIC, *names)

    def offer(self, topic: str, layer: DisplayLayer) -> None:
        """A box for a topic, as it was last left."""
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
        """The topic is gone."""
        box = self._boxes.pop(topic)
        self._chosen[topic] = box.value
        box.remove()

    def offered(self) -> Dict[str, bool]:
        """The topics that have a box, and whether they are switched on."""
        return {topic: box.value for topic, box in self._boxes.items()}

    def show_status(self, text: str) -> None:
        """How things stand, as HTML."""
        if self.status.content != text:
            self.status.content = text
