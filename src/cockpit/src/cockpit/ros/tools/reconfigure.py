"""Reconfigure: the parameters of dynamic_reconfigure servers (rqt_reconfigure)."""

from typing import Any, Dict, List

from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, IntParameter, StrParameter
from dynamic_reconfigure.srv import Reconfigure as ReconfigureService

from cockpit.models.reconfigure import ReconfigurableParameter, parameters_from_description, values_of
from cockpit.page.controls import TwoWayControl
from cockpit.ros.background import BackgroundCall
from cockpit.ros.calls import call
from cockpit.ros.graph import TopicFeed
from cockpit.ros.tool import ToolContext

NONE = "(none)"
DESCRIPTIONS, UPDATES, SERVICE = "/parameter_descriptions", "/parameter_updates", "/set_parameters"
DESCRIPTION_TYPE = "dynamic_reconfigure/ConfigDescription"
LISTS = {
    "bool": ("bools", BoolParameter),
    "int": ("ints", IntParameter),
    "double": ("doubles", DoubleParameter),
    "str": ("strs", StrParameter),
}


class ReconfigureTool:
    name, title, seconds = "reconfigure", "Reconfigure", 0.2

    def __init__(self, context: ToolContext):
        self._context = context
        self._background = BackgroundCall()
        self._feeds: List[TopicFeed] = []
        self._server = NONE
        self._controls: Dict[str, ParameterControl] = {}

    def build(self) -> None:
        self._servers = self._context.gui.add_dropdown("Server", (NONE,))
        self._space = self._context.gui.add_folder("Parameters")
        self._servers.on_update(self._context.guarded(lambda _: self._choose(self._servers.value)))

    def update(self, now: float) -> None:
        types = self._context.graph.topics()
        found = sorted(
            topic[: -len(DESCRIPTIONS)]
            for topic, kind in types.items()
            if kind == DESCRIPTION_TYPE and topic.endswith(DESCRIPTIONS)
        )
        if self._servers.options != (NONE, *found):
            self._servers.options = (NONE, *found)
            self._choose(self._servers.value)
        if self._server != NONE and not self._feeds:
            self._subscribe()
        for config in self._background.results():
            self._show(values_of(config))
        self._read()
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

    def _subscribe(self) -> None:
        self._feeds = [
            self._context.graph.feed(self._server + DESCRIPTIONS, DESCRIPTION_TYPE),
            self._context.graph.feed(self._server + UPDATES, "dynamic_reconfigure/Config"),
        ]

    def _read(self) -> None:
        if not self._feeds:
            return
        for description in self._feeds[0].messages():
            self._clear()
            with self._space:
                for parameter in parameters_from_description(description):
                    self._controls[parameter.name] = ParameterControl(self._context.gui, parameter)
        if self._controls:
            for config in self._feeds[1].messages():
                self._show(values_of(config))

    def _send(self) -> None:
        """Send all changed values in one call."""
        changed = [control for control in self._controls.values() if control.widget.is_changed()]
        if not changed or self._background.is_busy:
            return
        config, service = Config(), self._server + SERVICE
        for control in changed:
            field, kind = LISTS[control.parameter.kind]
            getattr(config, field).append(kind(control.parameter.name, control.consume()))
        self._background.start(lambda: call(service, ReconfigureService, config).config)

    def _show(self, values: Dict[str, Any]) -> None:
        for name, value in values.items():
            if name in self._controls:
                self._controls[name].show(value)

    def _clear(self) -> None:
        for control in self._controls.values():
            control.widget.handle.remove()
        self._controls.clear()


class ParameterControl:
    """The control of one parameter: a slider between its bounds, a box, a list of choices."""

    def __init__(self, gui: Any, parameter: ReconfigurableParameter):
        self.parameter = parameter
        self._names = {value: name for name, value in parameter.choices}
        self._values = dict(parameter.choices)
        self.widget = TwoWayControl(self._made(gui))

    def consume(self) -> Any:
        """Return the changed value in the parameter's type."""
        value = self.widget.consume()
        if self._values:
            return self._values[value]
        return {"bool": bool, "int": int, "double": float, "str": str}[self.parameter.kind](value)

    def show(self, value: Any) -> None:
        """Display a value of the server."""
        shown = self._names.get(value, value) if self._values else value
        if not (self._values and shown not in self._values):
            self.widget.show(shown)

    def _made(self, gui: Any) -> Any:
        parameter, hint = self.parameter, self.parameter.meaning or None
        if parameter.choices:
            names = tuple(self._values)
            return gui.add_dropdown(
                parameter.name, names, initial_value=self._names.get(parameter.default), hint=hint
            )
        if parameter.kind == "bool":
            return gui.add_checkbox(parameter.name, bool(parameter.default), hint=hint)
        if parameter.kind == "str":
            return gui.add_text(parameter.name, str(parameter.default), hint=hint)
        if parameter.is_bounded:
            bounds = {"min": parameter.lowest, "max": parameter.highest, "step": parameter.step}
            return gui.add_slider(parameter.name, initial_value=parameter.default, hint=hint, **bounds)
        return gui.add_number(parameter.name, parameter.default, step=parameter.step, hint=hint)


TOOL = ReconfigureTool
