"""Parameters: list, get, set and delete (rosparam)."""

import rospy
import yaml

from cockpit.errors import CockpitError
from cockpit.models.tables import table
from cockpit.models.text import flat, value_text
from cockpit.ros.tool import ToolContext
from planar.config.bounded_yaml import load_yaml

MOST_LISTED = 300
LONGEST = 10_000


class ParametersTool:
    name, title, seconds = "parameters", "Parameters", 1.0

    def __init__(self, context: ToolContext):
        self._context = context

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._filter = gui.add_text("Filter", "", hint="part of a parameter's name")
        self._list = gui.add_html("")
        self._name = gui.add_text("Name", "")
        gui.add_button("Get", color="gray").on_click(guarded(lambda _: self._get()))
        self._value = gui.add_text("Value", "", multiline=True, hint="YAML")
        gui.add_button("Set").on_click(guarded(lambda _: self._set()))
        gui.add_button("Remove", color="orange").on_click(guarded(lambda _: self._remove()))

    def update(self, now: float) -> None:
        known = flat(self._context.graph.parameter("/", {}))
        part = self._filter.value.lower()
        rows = [(name, value_text(value)) for name, value in sorted(known.items()) if part in name.lower()]
        more = [(f"... and {len(rows) - MOST_LISTED} more", "")] if len(rows) > MOST_LISTED else []
        content = table(("Parameter", "Value"), rows[:MOST_LISTED] + more)
        if self._list.content != content:
            self._list.content = content

    def pause(self) -> None:
        """Nothing to do: the tool has no subscriptions."""

    close = pause

    def _named(self) -> str:
        name = self._name.value.strip()
        if not name or name == "/":
            raise CockpitError("enter the name of a parameter first")
        return rospy.resolve_name("/" + name.lstrip("/"))

    def _get(self) -> None:
        name = self._named()
        value = self._context.graph.parameter(name)
        if value is None:
            raise CockpitError(f"there is no parameter {name}")
        self._value.value = yaml.safe_dump(value, default_flow_style=False).replace("\n...\n", "").strip()

    def _set(self) -> None:
        name = self._named()
        if len(self._value.value) > LONGEST:
            raise CockpitError(f"longer than {LONGEST} characters")
        try:
            value = load_yaml(self._value.value)
        except (yaml.YAMLError, ValueError) as error:
            raise CockpitError(f"{name}: not YAML ({getattr(error, 'problem', error)})") from None
        if value is None:
            raise CockpitError(f"{name}: enter a value first")
        rospy.set_param(name, value)
        self._context.notify(f"{name} is set; nodes that have read it already keep the old value")

    def _remove(self) -> None:
        name = self._named()
        try:
            rospy.delete_param(name)
        except KeyError:
            raise CockpitError(f"there is no parameter {name}") from None
        self._context.notify(f"{name} is removed")


TOOL = ParametersTool
