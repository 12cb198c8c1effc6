"""Plot: any number in any topic over time (rqt_plot)."""

from typing import Any, Dict, List, Tuple

from cockpit.errors import CockpitError
from cockpit.models.tables import table
from cockpit.models.time_series import TimeSeries, expanded, number_at, numbers_in, suggested
from cockpit.ros.graph import TopicFeed
from cockpit.ros.message_yaml import message_class
from cockpit.ros.tool import ToolContext

NONE, ALL = "(none)", "(all)"
# Types of topics that are suggested before others.
PREFERRED = ("nav_msgs/Odometry", "geometry_msgs/Twist", "std_msgs/Float32", "std_msgs/Float64")
COLOURS = ("#1c7ed6", "#e8590c", "#2f9e44", "#ae3ec9", "#f59f00", "#0c8599", "#c92a2a", "#495057")
SECONDS, LONGEST = 20.0, 300.0


class PlotTool:
    name, title, seconds = "plot", "Plot", 0.2

    def __init__(self, context: ToolContext):
        self._context = context
        self._feeds: Dict[str, TopicFeed] = {}
        self._paths: Dict[str, Tuple[str, str]] = {}
        self._traces = TimeSeries(SECONDS)
        self._chart: Any = None
        self._awaited = [name for word in context.words for name in expanded(word)]
        # Paths of the numbers of each message type.
        self._numbers: Dict[str, List[str]] = {}

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._topic = gui.add_dropdown("Topic", (ALL,), hint="topics with numbers")
        self._number = gui.add_dropdown("Number", (NONE,), hint="type a part of its name to find it")
        self._typed = gui.add_text("or type it", "", hint="/odom/twist/twist/linear/x, /scan/ranges[3]")
        gui.add_button("Add").on_click(guarded(self._add))
        self._shown = gui.add_dropdown("Shown", (NONE,))
        gui.add_button("Remove", color="gray").on_click(guarded(self._remove))
        self._span = gui.add_number("Seconds", SECONDS, min=1.0, max=LONGEST, step=1.0)
        self._space = gui.add_folder("Over the last seconds")
        self._values = gui.add_html("")
        self._topic.on_update(guarded(lambda _: self._offer_numbers()))

    def update(self, now: float) -> None:
        self._offer_numbers()
        self._add_awaited()
        self._subscribe()
        self._read()
        self._traces.seconds = self._span.value
        names = sorted(self._paths)
        rows = [(name, f"{self._traces.newest(name):.6g}") for name in names]
        self._values.content = table(("Number", "Now"), rows) if rows else ""
        if self._chart is not None:
            self._chart.data = self._traces.drawn(names, now)

    def pause(self) -> None:
        for feed in self._feeds.values():
            feed.close()
        self._feeds.clear()

    close = pause

    def _offer_numbers(self) -> None:
        """Offer the topics with numbers, and the numbers of the selected topic or the first ones of all."""
        kinds = self._context.graph.topics()
        topics = sorted(kinds, key=lambda topic: (kinds[topic] not in PREFERRED, topic))
        found = {topic: self._numbers_of(kinds[topic]) for topic in topics if self._numbers_of(kinds[topic])}
        _offer(self._topic, (ALL, *sorted(found)))
        chosen = self._topic.value
        paths = suggested(found) if chosen == ALL else [(chosen, path) for path in found.get(chosen, ())]
        _offer(self._number, tuple(_name(*each) for each in paths) or (NONE,))

    def _numbers_of(self, kind: str) -> List[str]:
        if kind not in self._numbers:
            try:
                self._numbers[kind] = numbers_in(message_class(kind)())
            except CockpitError:  # of a type that is not installed
                self._numbers[kind] = []
        return self._numbers[kind]

    def _add(self, _event: Any) -> None:
        names = expanded(self._typed.value.strip()) or [self._number.value]
        if NONE in names:
            raise CockpitError("no topic has numbers yet")
        found = [self._split(name) for name in names]
        self._paths.update({_name(*each): each for each in found})
        self._typed.value = ""
        self._rebuild()

    def _add_awaited(self) -> None:
        """Add the requested numbers whose topics exist by now."""
        topics = self._context.graph.topics()
        come = [name for name in self._awaited if any(name.startswith(f"{topic}/") for topic in topics)]
        if come:
            self._awaited = [name for name in self._awaited if name not in come]
            self._paths.update({_name(*each): each for each in map(self._split, come)})
            self._rebuild()

    def _split(self, typed: str) -> Tuple[str, str]:
        """Split a field path of rqt_plot into topic and field."""
        known = [name for name in self._context.graph.topics() if typed.startswith(f"{name}/")]
        if not known:
            raise CockpitError(f"'{typed}' does not begin with the name of a topic")
        topic = max(known, key=len)
        return topic, typed[len(topic) + 1 :].replace("/", ".")

    def _remove(self, _event: Any) -> None:
        name = self._shown.value
        if self._paths.pop(name, None) is not None:
            self._traces.remove(name)
            self._rebuild()

    def _rebuild(self) -> None:
        """Recreate the chart with one line per number."""
        names = sorted(self._paths)
        self._shown.options = tuple(names) or (NONE,)
        if self._chart is not None:
            self._chart.remove()
            self._chart = None
        if names:
            series: List[dict] = [{"label": "s"}]
            for number, name in enumerate(names):
                series.append({"label": name, "stroke": COLOURS[number % len(COLOURS)], "width": 2})
            with self._space:
                self._chart = self._context.gui.add_uplot(
                    self._traces.drawn(names, 0.0), tuple(series), scales={"x": {"time": False}}, height=260
                )

    def _subscribe(self) -> None:
        wanted = {topic for topic, _ in self._paths.values()}
        for topic in set(self._feeds) - wanted:
            self._feeds.pop(topic).close()
        for topic in wanted - set(self._feeds):
            if topic in self._context.graph.topics():  # a topic may disappear and return
                self._feeds[topic] = self._context.graph.feed(topic, all_of_them=True)

    def _read(self) -> None:
        for topic, feed in self._feeds.items():
            wanted = [(name, path) for name, (source, path) in self._paths.items() if source == topic]
            for at, message, _ in feed.stamped_messages():
                for name, path in wanted:
                    self._traces.add(name, at, number_at(message, path))


def _offer(dropdown: Any, options: Tuple[str, ...]) -> None:
    if dropdown.options != options:
        dropdown.options = options


def _name(topic: str, path: str) -> str:
    """Format a number as rqt_plot does."""
    return f"{topic}/{path.replace('.', '/')}"


TOOL = PlotTool
