"""Records what the report of a run needs, at little cost."""

import time
from typing import Callable, Dict, Mapping, Optional

import numpy as np

from evaluation.consumers.samples import Samples
from evaluation.event_stream import EventStream
from evaluation.events import (
    SHOW,
    BodiesTouched,
    CorrectionUpdated,
    GoalAccepted,
    LineLogged,
    MapPublished,
    MarkerUpdated,
    OdometryUpdated,
    PlanUpdated,
    StateUpdated,
    TruthUpdated,
)
from planar import OccupancyGrid, PlanarError, Pose2
from planar.maps.places import NamedPlace
from run_report import (
    CollisionEvent,
    GoalEvent,
    LoggedWarning,
    MarkerEvent,
    RunRecord,
    StateEvent,
    ZoneRecord,
)

MAX_WARNINGS = 200
MAX_EVENTS, MAX_PLANS, MAX_COLLISIONS = 300, 100, 1000


class RunRecorder:
    """Samples truth, estimate and odometry ten times a simulated second, and keeps the latest events.

    Args:
        places: Places by name.
        clock: Returns the wall-clock time [s].
    """

    def __init__(self, places: Mapping[str, NamedPlace], clock: Callable[[], float] = time.monotonic):
        self._places, self._clock = places, clock
        self._record = RunRecord()
        self._start_wall: Optional[float] = None
        self._truth, self._odometry, self._estimate = Samples(7), Samples(4), Samples(4)
        self._odom_in_map: Optional[Pose2] = None
        self._map: Optional[MapPublished] = None
        self._plans_missing = 0
        self._latest_markings: Dict[str, MarkerEvent] = {}

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        self._record.zones = [
            ZoneRecord(place.name, place.pose.x, place.pose.y, place.pose.yaw, place.radius)
            for place in self._places.values()
        ]
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(OdometryUpdated, self._on_odometry)
        events.subscribe(CorrectionUpdated, self._on_correction)
        events.subscribe(MapPublished, self._on_map)
        events.subscribe(StateUpdated, self._on_state)
        events.subscribe(BodiesTouched, self._on_contact)
        events.subscribe(MarkerUpdated, self._on_marker)
        events.subscribe(GoalAccepted, self._on_goal)
        events.subscribe(PlanUpdated, self._on_plan)
        events.subscribe(LineLogged, self._on_line)

    def record(self) -> RunRecord:
        """Return everything recorded so far."""
        record = self._record
        truth = self._truth.rows()
        record.truth, record.velocity, record.pace = truth[:, :4], truth[:, [0, 4, 5]], truth[:, [0, 6]]
        record.estimate = self._estimate.rows()
        record.odometry = _from_start(self._odometry.rows(), record.truth)
        record.grid = self._last_grid()
        return record

    def _last_grid(self) -> Optional[OccupancyGrid]:
        """Return the last map; None, and a warning once, if it cannot be read."""
        if self._map is None:
            return None
        try:
            return self._map.read()
        except PlanarError as error:
            warning = LoggedWarning(self._map.stamp, "report", f"no map: {error}")
            if warning not in self._record.warnings:
                self._record.warnings.append(warning)
            return None

    def _on_truth(self, event: TruthUpdated) -> None:
        if not self._truth.is_due(event.stamp):
            return
        wall = self._clock()
        self._start_wall = self._start_wall or wall
        pose, twist = event.pose, event.twist
        self._truth.add(event.stamp, pose.x, pose.y, pose.yaw, twist.v, twist.omega, wall - self._start_wall)

    def _on_correction(self, event: CorrectionUpdated) -> None:
        self._odom_in_map = event.odom_in_map

    def _on_odometry(self, event: OdometryUpdated) -> None:
        if not self._odometry.is_due(event.stamp):
            return
        base = event.base_in_odom
        self._odometry.add(event.stamp, base.x, base.y, base.yaw)
        if self._odom_in_map is not None:
            base = self._odom_in_map @ base
            self._estimate.add(event.stamp, base.x, base.y, base.yaw)

    def _on_map(self, event: MapPublished) -> None:
        self._map = event

    def _on_state(self, event: StateUpdated) -> None:
        self._append(self._record.states, StateEvent(event.stamp, event.text))

    def _on_contact(self, event: BodiesTouched) -> None:
        for name in event.names:
            self._append(self._record.collisions, CollisionEvent(event.stamp, name), MAX_COLLISIONS)

    def _on_marker(self, event: MarkerUpdated) -> None:
        name = f"{event.name} {event.number}"
        marking = MarkerEvent(event.stamp, name, event.action == SHOW, *event.position[:2])
        latest = self._latest_markings.get(name)
        if latest is None or latest[2:] != marking[2:]:
            self._latest_markings[name] = marking
            self._append(self._record.markings, marking)

    def _on_goal(self, event: GoalAccepted) -> None:
        goal = event.pose
        self._plans_missing += 1
        self._append(self._record.goals, GoalEvent(event.stamp, goal.x, goal.y, goal.yaw))

    def _on_plan(self, event: PlanUpdated) -> None:
        """Keep the first plan for each goal; later ones are its remainder."""
        if self._plans_missing:
            self._plans_missing -= 1
            self._append(self._record.plans, event.points_xy, MAX_PLANS)

    def _on_line(self, event: LineLogged) -> None:
        if event.is_warning and len(self._record.warnings) < MAX_WARNINGS:
            self._record.warnings.append(LoggedWarning(event.stamp, event.node, event.text))

    @staticmethod
    def _append(events: list, event: object, most: int = MAX_EVENTS) -> None:
        """Append an event and drop the oldest of a long run."""
        events.append(event)
        del events[:-most]


def _from_start(odometry: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Transform odometry (N, 4) so that it starts at the true start pose."""
    if not len(odometry) or not len(truth):
        return odometry
    nearest = odometry[np.argmin(np.abs(odometry[:, 0] - truth[0, 0]))]
    odom_in_map = Pose2.from_array(truth[0, 1:]) @ Pose2.from_array(nearest[1:]).inverse()
    moved = odometry.copy()
    moved[:, 1:3] = odom_in_map.transform_points(odometry[:, 1:3])
    moved[:, 3] = odometry[:, 3] + odom_in_map.yaw
    return moved
