"""Reconfigure: every dynamic_reconfigure server, its parameters with their bounds (rqt_reconfigure)."""

from typing import Any, Dict, List

from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, IntParameter, StrParameter
from dynamic_reconfigure.srv import Reconfigure as ReconfigureService

from cockpit.models.knobs import Knob, knobs_of, values_of
from cockpit.page.dial import Dial
from cockpit.ros.aside import Aside
from cockpit.ros.calls import call
from cockpit.ros.graph import Feed
from cockpit.ros.tool import Desk

NONE = "(none)"
DESCRIPTIONS, UPDATES, SERVICE = "/parameter_descriptions", "/parameter_updates", "/set_parameters"
DESCRIPTION_TYPE = "dynamic_reconfigure/ConfigDescription"
LISTS = {
    "bool": ("bools", BoolParameter),
    "int": ("ints", IntParameter),
    "double": ("doubles", DoubleParameter),
    "str": ("strs", StrParameter),
}


class Reconfigure:
    name, title, seconds, width = "reconfigure", "Reconfigure", 0.2, 480

    def __init__(self, desk: Desk):
        self._desk = desk
        self._aside = Aside()
        self._feeds: List[Feed] = []
        self._server = NONE
        self._controls: Dict[str, Control] = {}

    def build(self) -> None:
        self._servers = self._desk.gui.add_dropdown("Server", (NONE,))
        self._space = self._desk.gui.add_folder("Parameters")
        self._servers.on_update(self._desk.guarded(lambda _: self._choose(self._servers.value)))

    def update(self, now: float) -> None:
        types = self._desk.graph.topics()
        found = sorted(
            topic[: -len(DESCRIPTIONS)]
            for topic, kind in types.items()
            if kind == DESCRIPTION_TYPE and topic.endswith(DESCRIPTIONS)
        )
        if self._servers.options != (NONE, *found):
            self._servers.options = (NONE, *found)
            self._choose(self._servers.value)
        if self._server != NONE and not self._feeds:
            self._listen()
        for config in self._aside.take():
            self._show(values_of(config))
        self._take()
        self._send()

    def pause(self) -> None:
        for feed in self._feeds:
            feed.close()
        self._feeds = []

    close = pause

    def _choose(self, server: str) -> None:
        if server != self._server:
            self.pause()
            self._server = server
            self._clear()

    def _listen(self) -> None:
        self._feeds = [
            self._desk.graph.feed(self._server + DESCRIPTIONS, DESCRIPTION_TYPE),
            self._desk.graph.feed(self._server + UPDATES, "dynamic_reconfigure/Config"),
        ]

    def _take(self) -> None:
        if not self._feeds:
            return
        for description in self._feeds[0].take():
            self._clear()
            with self._space:
                for knob in knobs_of(description):
                    self._controls[knob.name] = Control(self._desk.gui, knob)
        if self._controls:
            for config in self._feeds[1].take():
                self._show(values_of(config))

    def _send(self) -> None:
        """What was turned since the last answer, in one call."""
        turned = [control for control in self._controls.values() if control.dial.is_turned()]
        if not turned or self._aside.is_busy:
            return
        config, service = Config(), self._server + SERVICE
        for control in turned:
            field, kind = LISTS[control.knob.kind]
            getattr(config, field).append(kind(control.knob.name, control.taken()))
        self._aside.start(lambda: call(service, ReconfigureService, config).config)

    def _show(self, values: Dict[str, Any]) -> None:
        for name, value in values.items():
            if name in self._controls:
                self._controls[name].show(value)

    def _clear(self) -> None:
        for control in self._controls.values():
            control.dial.handle.remove()
        self._controls.clear()


class Control:
    """The control of one parameter: a slider between its bounds, a box, a list of choices."""

    def __init__(self, gui: Any, knob: Knob):
        self.knob = knob
        self._names = {value: name for name, value in knob.choices}
        self._values = dict(knob.choices)
        self.dial = Dial(self._made(gui))

    def taken(self) -> Any:
        """What it was turned to."""
        told = self.dial.taken()
        if self._values:
            return self._values[told]
        return {"bool": bool, "int": int, "double": float, "str": str}[self.knob.kind](told)

    def show(self, value: Any) -> None:
        """What the server says."""
        told = self._names.get(value, value) if self._values else value
        if not (self._values and told not in self._values):
            self.dial.show(told)

    def _made(self, gui: Any) -> Any:
        knob, hint = self.knob, self.knob.meaning or None
        if knob.choices:
            names = tuple(self._values)
            return gui.add_dropdown(knob.name, names, initial_value=self._names.get(knob.default), hint=hint)
        if knob.kind == "bool":
            return gui.add_checkbox(knob.name, bool(knob.default), hint=hint)
        if knob.kind == "str":
            return gui.add_text(knob.name, str(knob.default), hint=hint)
        if knob.is_bounded:
            bounds = {"min": knob.lowest, "max": knob.highest, "step": knob.step}
            return gui.add_slider(knob.name, initial_value=knob.default, hint=hint, **bounds)
        return gui.add_number(knob.name, knob.default, step=knob.step, hint=hint)


TOOL = Reconfigure
