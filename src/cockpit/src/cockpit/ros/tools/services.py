"""Services: providers, and a call of one (rqt_service_caller)."""

from typing import Any, Dict

import rosservice

from cockpit.errors import CockpitError
from cockpit.models.tables import preformatted, table
from cockpit.models.text import outline
from cockpit.ros.background import BackgroundCall
from cockpit.ros.calls import LONG_SECONDS, call
from cockpit.ros.message_yaml import filled, service_class, template
from cockpit.ros.tool import ToolContext

NONE = "(none)"
# Services that every node, or every node of a kind, has.
COMMON = ("/get_loggers", "/set_logger_level", "/tf2_frames")


class ServicesTool:
    name, title, seconds = "services", "Services", 0.5

    def __init__(self, context: ToolContext):
        self._context = context
        self._types: Dict[str, str] = {}
        self._asking, self._calling = BackgroundCall(), BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._filter = gui.add_text("Filter", "", hint="part of a service's name")
        self._common = gui.add_checkbox("Include logger services", False)
        self._list = gui.add_html("")
        self._chosen = gui.add_dropdown("Service", (NONE,))
        self._kind = gui.add_markdown("")
        self._fields = gui.add_text("Request", "", multiline=True, hint="YAML")
        gui.add_button("Call").on_click(guarded(self._call))
        self._answer = gui.add_html("")
        self._chosen.on_update(guarded(self._choose))

    def update(self, now: float) -> None:
        providers = {
            name: ", ".join(nodes)
            for name, nodes in sorted(self._context.graph.services().items())
            if self._filter.value.lower() in name.lower()
            and (self._common.value or not name.endswith(COMMON))
        }
        content = table(("Service", "Node"), providers.items())
        if self._list.content != content:
            self._list.content = content
        if self._chosen.options != (NONE, *providers):
            self._chosen.options = (NONE, *providers)
        for name, kind in self._asking.results():
            self._show_request(name, kind)
        for answer in self._calling.results():
            self._answer.content = outline(answer) if answer.__slots__ else preformatted("done")

    def pause(self) -> None:
        """Nothing to do: the tool has no subscriptions."""

    close = pause

    def _choose(self, _event: Any) -> None:
        name = self._chosen.value
        self._kind.content = self._fields.value = self._answer.content = ""
        if name != NONE:
            self._asking.restart(lambda: (name, _type_of(name)))

    def _show_request(self, name: str, kind: str) -> None:
        if name != self._chosen.value:
            return
        self._types[name] = kind
        self._kind.content = kind
        self._fields.value = template(service_class(kind)._request_class)

    def _call(self, _event: Any) -> None:
        name = self._chosen.value
        if name not in self._types:
            raise CockpitError("choose a service first")
        kind = service_class(self._types[name])
        request = filled(kind._request_class, self._fields.value)
        self._calling.start(lambda: call(name, kind, request, seconds=LONG_SECONDS))
        self._answer.content = preformatted("...")


def _type_of(name: str) -> str:
    try:
        kind = rosservice.get_service_type(name)
    except rosservice.ROSServiceException as error:
        raise CockpitError(f"{name}: {error}") from None
    if kind is None:
        raise CockpitError(f"{name}: the service does not report its type")
    return kind


TOOL = ServicesTool
