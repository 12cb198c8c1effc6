"""The errand in an episode, as the node pick_objects carries it out."""

from typing import Optional

from headless_mission.navigation import EpisodeMoveBaseClient, NavigationHooks
from pick_objects import Errand, FinishTask, GoalDriver, Mission, SearchArea
from pick_objects.errand import Event
from sim_bridge import Episode, EpisodeHooks, StepResult
from sim_bridge.config import LATENCY
from sim_bridge.sensors.object_detector import ObjectDetector

# Time from the first estimate until the client of move_base has connected: two messages, a request and its
# answer [s]. Stamps that differ by less than SAME are equal [s].
CONNECTION_SECONDS, SAME = 2.0 * LATENCY, 1e-6


class ErrandHooks(EpisodeHooks):
    """Advances the errand once a control period.

    Args:
        mission: Mission to carry out.
        navigation: move_base in the episode.
        client: Client of move_base.
        start: Simulated time from which on the mission may start [s]; None: once the client has connected.
        area: Where objects can be searched; None if there is no semantic map.

    Attributes:
        errand: State of the mission.
        driver: Carries out its orders.
        is_started: Whether it has started.
        end: End of the mission; None before it.
    """

    def __init__(
        self,
        mission: Mission,
        navigation: NavigationHooks,
        client: EpisodeMoveBaseClient,
        start: Optional[float] = None,
        area: Optional[SearchArea] = None,
    ):
        self.errand, self.driver = Errand(mission, area), GoalDriver(client)
        self.is_started = False
        self.end: Optional[FinishTask] = None
        self._navigation, self._start = navigation, start

    def after_step(self, episode: Episode, step: StepResult) -> None:
        reading = step.readings.get(ObjectDetector.name)
        if reading is not None:
            self.driver.add_detections(reading.stamp, reading.value)

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        if self._navigation.base_in_map is None:
            return
        if self._start is None:
            self._start = step.stamp + CONNECTION_SECONDS
        self.is_started = self.is_started or step.stamp > self._start - SAME
        if self.is_started:
            self.driver.odometry = self._navigation.poses.base_in_odom()
            self._advance(step.stamp)

    def _advance(self, now: float) -> None:
        event: Optional[Event] = self.driver.event(now)
        while True:
            self.errand.base_in_map = self.driver.base_in_map
            order = self.errand.advance(now, event)
            event = self.driver.carry_out(order)
            if event is None:
                break
        if isinstance(order, FinishTask):
            self.end = order
