"""Days of service in the simulator, in one process."""

import numpy as np
import pytest

from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from planar import Pose2
from planar.maps.places import NamedPlace
from service.day.day_report import day_report
from service.day.preparation import MIDNIGHT, DayPlan, prepare_day
from service.requests.timed_requests import TimedRequest
from service.task import TaskStatus
from sim_bridge import SimulationSettings, robot_named
from sim_bridge.geometry.shapes import Plane
from sim_bridge.simulation import box_on_floor
from sim_bridge.views.true_map import true_map
from sim_bridge.world import Body, Collision, World

SIDES = (
    ((0.1, 6.0), (-3.0, 0.0)),
    ((0.1, 6.0), (3.0, 0.0)),
    ((6.0, 0.1), (0.0, 3.0)),
    ((6.0, 0.1), (0.0, -3.0)),
)
ROOM = World(
    "room",
    (
        Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),)),
        *(
            box_on_floor(f"wall{number}", (*size, 1.0), Pose2(*middle))
            for number, (size, middle) in enumerate(SIDES)
        ),
        box_on_floor("pillar", (0.4, 0.4, 1.0), Pose2(0.5, 1.4)),
    ),
)
PLACES = {name: NamedPlace(name, Pose2(x, y)) for name, x, y in (("kitchen", 1.8, 1.8), ("desk", 1.8, -1.8))}
DOCK = Pose2(-2.9, 0.0)
HOUR = 3600.0


def plan(dock=DOCK):
    grid = true_map(ROOM)
    return DayPlan(ROOM, robot_named("turtlebot_lidar"), grid, PLACES, dock)


def day(requests, seed=1, settings=SimulationSettings(), dock=DOCK):
    conditions = EpisodeConditions(simulation=settings)
    return prepare_day(plan(dock), requests, conditions.navigation(NAVIGATION_CONFIG), conditions, seed)


def request(hours, text, minutes=10.0):
    stamp = MIDNIGHT + hours * HOUR
    document = {"text": text, "unix_millis_deadline": round(1000.0 * (stamp + 60.0 * minutes))}
    return TimedRequest(stamp, document)


def test_requests_are_carried_out_and_the_time_between_them_is_skipped():
    requests = request(2.0, "deliver cup from kitchen to desk"), request(5.0, "go attic")
    runs = [day(requests) for _ in range(2)]
    first, second = (made.run(MIDNIGHT + 6.0 * HOUR) for made in runs)
    assert [task.status for task in first.ended] == [TaskStatus.COMPLETED]
    assert len(first.kept) == 1 and not first.contacts and first.empty_at is None
    assert first.idle_seconds > 5.0 * HOUR
    assert first.end == pytest.approx(MIDNIGHT + 6.0 * HOUR, abs=0.2)
    assert "attic" in first.refused[0]
    assert first.activities[-1][1] == "charging"
    assert first.track == second.track and first.log == second.log

    page = day_report(first, plan().grid, MIDNIGHT, "Day")
    for text in ("1 of 1", "deliver cup from kitchen to desk", "charging", "data:image/png"):
        assert text in page


def test_a_robot_that_cannot_charge_stands_with_an_empty_battery():
    settings = SimulationSettings(battery_capacity=0.02, battery_charge=0.5)
    record = day([request(0.01, "wait 1h at desk", 100.0)], settings=settings).run(MIDNIGHT + HOUR)
    assert record.empty_at is not None and record.lowest_charge == 0.0
    assert not record.kept


def test_the_robot_drives_around_its_dock_that_the_scan_does_not_see():
    requests = [
        request(0.02 * number, f"go {name}") for number, name in enumerate(("kitchen", "desk") * 3, start=1)
    ]
    record = day(requests, dock=Pose2(1.8, 0.0, np.pi)).run(MIDNIGHT + 0.2 * HOUR)
    assert len(record.kept) == 6
    assert not record.contacts
