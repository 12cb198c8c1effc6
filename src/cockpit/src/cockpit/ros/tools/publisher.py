"""Publisher: edit a message and publish it once or repeatedly (rqt_publisher, rostopic pub)."""

import time
from typing import Any, Optional

import rospy

from cockpit.errors import CockpitError
from cockpit.models.rates import PeriodicTimer
from cockpit.ros.calls import wait_for_subscribers
from cockpit.ros.message_yaml import filled, message_class, template
from cockpit.ros.tool import ToolContext

FASTEST = 20.0


class PublisherTool:
    name, title, seconds = "publisher", "Publisher", 0.05

    def __init__(self, context: ToolContext):
        self._context = context
        self._publisher: Optional[rospy.Publisher] = None
        self._message: Any = None
        self._repeating = PeriodicTimer()
        self._sent = 0

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._topic = gui.add_text("Topic", "/cmd_vel")
        self._kind = gui.add_text("Type", "", hint="message type; empty for the type of the topic")
        gui.add_button("Create the message", color="gray").on_click(guarded(self._fill_in))
        self._fields = gui.add_text("Message", "", multiline=True, hint="YAML; now is the current time")
        gui.add_button("Publish once").on_click(guarded(lambda _: self._send_once()))
        self._rate = gui.add_number("Hz", 1.0, min=0.1, max=FASTEST, step=0.1)
        self._repeats = gui.add_checkbox("Repeat", False)
        self._repeats.on_update(guarded(self._switch))
        self._status = gui.add_markdown("")

    def update(self, now: float) -> None:
        if self._message is not None and self._repeating.is_due(now):
            self._publish()

    def pause(self) -> None:
        """Stop publishing while no page is open."""
        self._stop()
        self._repeats.value = False
        if self._publisher is not None:
            self._publisher.unregister()
            self._publisher = None

    close = pause

    def _kind_name(self) -> str:
        if self._kind.value.strip():
            return self._kind.value.strip()
        known = self._context.graph.topics().get(self._topic.value.strip())
        if known is None:
            raise CockpitError(f"there is no topic {self._topic.value.strip()}; enter the type as well")
        return known

    def _fill_in(self, _event: Any) -> None:
        kind = self._kind_name()
        self._fields.value = template(message_class(kind))
        self._kind.value = kind

    def _send_once(self) -> None:
        self._prepare()
        self._publish()

    def _switch(self, _event: Any) -> None:
        if not self._repeats.value:
            self._stop()
            return
        try:
            self._prepare()
        except CockpitError:
            self._repeats.value = False
            raise
        self._repeating.start(time.monotonic(), 1.0 / self._rate.value)

    def _stop(self) -> None:
        self._repeating.stop()
        self._message = None

    def _prepare(self) -> None:
        """Create the message and a publisher with connected subscribers. Raises CockpitError."""
        kind, topic = message_class(self._kind_name()), self._topic.value.strip()
        message = filled(kind, self._fields.value)
        known = self._context.graph.topics().get(topic)
        if known not in (None, kind._type):
            raise CockpitError(f"{topic} has type {known}, not {kind._type}")
        old = self._publisher
        if old is None or old.resolved_name != rospy.resolve_name(topic) or old.data_class is not kind:
            if old is not None:
                old.unregister()
            try:
                self._publisher = rospy.Publisher(topic, kind, queue_size=10)
            except (ValueError, rospy.ROSException) as error:
                self._publisher = None
                raise CockpitError(f"{topic}: {error}") from None
            else:
                wait_for_subscribers(self._publisher)
        self._message = message

    def _publish(self) -> None:
        assert self._publisher is not None
        self._publisher.publish(self._message)
        self._sent += 1
        subscribers = self._publisher.get_num_connections()
        self._status.content = f"{self._sent} sent, {subscribers} subscribers"


TOOL = PublisherTool
