"""Replay: position, speed and pause of a recording."""

from typing import Callable, List, Optional

from home_service_msgs.srv import Seek, SetPlaybackSpeed
from std_srvs.srv import SetBool

from cockpit.errors import CockpitError
from cockpit.page.controls import TwoWayControl
from cockpit.ros.background import BackgroundCall
from cockpit.ros.calls import LONG_SECONDS, call
from cockpit.ros.graph import TopicFeed
from cockpit.ros.tool import ToolContext

KIND, TOPIC = "home_service_msgs/Playback", "/playback"
PAUSE, SEEK, SPEED = "/pause_playback", "/seek", "/set_speed"
SPEEDS = ("0.1 x", "0.5 x", "1 x", "2 x", "5 x", "20 x", "as fast as possible")
FACTORS = (0.1, 0.5, 1.0, 2.0, 5.0, 20.0, 0.0)
STEP_SECONDS = 0.1


class ReplayTool:
    name, title, seconds = "replay", "Replay", 0.1

    def __init__(self, context: ToolContext):
        self._context = context
        self._feed: Optional[TopicFeed] = None
        self._player = ""
        self._background = BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._position = TwoWayControl(gui.add_slider("Time, s", 0.0, 1.0, STEP_SECONDS, 0.0))
        self._speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1 x")
        pause, resume = gui.add_button("Pause"), gui.add_button("Resume")
        self._status = gui.add_markdown("No recording is being played.")
        self._speed.on_update(guarded(self._set_speed))
        pause.on_click(guarded(lambda _: self._ask(PAUSE, SetBool, True)))
        resume.on_click(guarded(lambda _: self._ask(PAUSE, SetBool, False)))

    def update(self, now: float) -> None:
        if self._feed is None:
            self._subscribe()
        for answer in self._background.results():
            if not answer.success:
                raise CockpitError(answer.message)
        if self._position.is_changed() and not self._background.is_busy:
            self._background.start(self._service_call(SEEK, Seek, self._position.consume()))
        for playback in self._feed.messages() if self._feed is not None else ():
            self._show(playback)

    def pause(self) -> None:
        if self._feed is not None:
            self._feed.close()
            self._feed = None

    close = pause

    def _subscribe(self) -> None:
        found: List[str] = [topic for topic, kind in self._context.graph.topics().items() if kind == KIND]
        if found:
            self._player = found[0][: -len(TOPIC)]
            self._feed = self._context.graph.feed(found[0], KIND)

    def _show(self, playback) -> None:
        self._position.handle.max = max(playback.length, STEP_SECONDS)
        if not self._background.is_busy:
            self._position.show(min(playback.position, self._position.handle.max))
        state = "paused" if playback.is_paused else "playing"
        self._status.content = f"{state}: {playback.position:.1f} s of {playback.length:.1f} s"

    def _set_speed(self, event) -> None:
        if event.client is not None:
            self._ask(SPEED, SetPlaybackSpeed, FACTORS[SPEEDS.index(self._speed.value)])

    def _ask(self, service: str, kind: type, value) -> None:
        self._background.start(self._service_call(service, kind, value))

    def _service_call(self, service: str, kind: type, value) -> Callable:
        if not self._player:
            raise CockpitError("no recording is being played")
        name = self._player + service
        return lambda: call(name, kind, value, seconds=LONG_SECONDS)


TOOL = ReplayTool
