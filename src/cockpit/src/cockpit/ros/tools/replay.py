"""Replay: where in a recording one is; another place, another pace, a pause."""

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
PACES = ("0.1 x", "0.5 x", "1 x", "2 x", "5 x", "20 x", "as fast as it goes")
FACTORS = (0.1, 0.5, 1.0, 2.0, 5.0, 20.0, 0.0)
STEP_SECONDS = 0.1


class ReplayTool:
    name, title, seconds, width = "replay", "Replay", 0.1, 420

    def __init__(self, context: ToolContext):
        self._context = context
        self._feed: Optional[TopicFeed] = None
        self._player = ""
        self._background = BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._place = TwoWayControl(gui.add_slider("Time, s", 0.0, 1.0, STEP_SECONDS, 0.0))
        self._pace = gui.add_dropdown("Pace", PACES, initial_value="1 x")
        pause, go_on = gui.add_button("Pause"), gui.add_button("Go on")
        self._status = gui.add_markdown("No recording is played.")
        self._pace.on_update(guarded(self._paced))
        pause.on_click(guarded(lambda _: self._ask(PAUSE, SetBool, True)))
        go_on.on_click(guarded(lambda _: self._ask(PAUSE, SetBool, False)))

    def update(self, now: float) -> None:
        if self._feed is None:
            self._listen()
        for answer in self._background.results():
            if not answer.success:
                raise CockpitError(answer.message)
        if self._place.is_changed() and not self._background.is_busy:
            self._background.start(self._calling(SEEK, Seek, self._place.consume()))
        for playback in self._feed.messages() if self._feed is not None else ():
            self._show(playback)

    def pause(self) -> None:
        if self._feed is not None:
            self._feed.close()
            self._feed = None

    close = pause

    def _listen(self) -> None:
        found: List[str] = [topic for topic, kind in self._context.graph.topics().items() if kind == KIND]
        if found:
            self._player = found[0][: -len(TOPIC)]
            self._feed = self._context.graph.feed(found[0], KIND)

    def _show(self, playback) -> None:
        self._place.handle.max = max(playback.length, STEP_SECONDS)
        if not self._background.is_busy:
            self._place.show(min(playback.position, self._place.handle.max))
        state = "paused" if playback.is_paused else "playing"
        self._status.content = f"{state}: {playback.position:.1f} s of {playback.length:.1f} s"

    def _paced(self, event) -> None:
        if event.client is not None:
            self._ask(SPEED, SetPlaybackSpeed, FACTORS[PACES.index(self._pace.value)])

    def _ask(self, service: str, kind: type, value) -> None:
        self._background.start(self._calling(service, kind, value))

    def _calling(self, service: str, kind: type, value) -> Callable:
        if not self._player:
            raise CockpitError("no recording is played")
        name = self._player + service
        return lambda: call(name, kind, value, seconds=LONG_SECONDS)


TOOL = ReplayTool
