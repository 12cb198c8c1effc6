"""Days of service in the simulator, in one process."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest

from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from planar import Pose2
from planar.maps.places import NamedPlace
from service.day.day_report import day_report
from service.day.preparation import MIDNIGHT, DayPlan, furniture_moves, prepare_day
from service.day.requests_by_hour import DaySettings, TimedRequest
from service.day.simulated_day import FurnitureMove
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


def plan(**values):
    grid = true_map(ROOM)
    requests = DaySettings(requests=0)
    return DayPlan(ROOM, robot_named("turtlebot_lidar"), grid, PLACES, DOCK, requests, **values)


def day(requests, seed=1, settings=SimulationSettings(), furniture=(), **values):
    conditions = EpisodeConditions(simulation=settings)
    made = prepare_day(plan(**values), conditions.navigation(NAVIGATION_CONFIG), conditions, seed)
    made._service._coming, made._furniture = deque(requests), list(furniture)
    return made


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


def test_furniture_is_moved_where_the_robot_is_not():
    made = day((), furniture=[FurnitureMove(MIDNIGHT + 60.0, "pillar", Pose2(-2.6, 0.2))])
    made.run(MIDNIGHT + 120.0)
    models = made._episode.simulation.scene.models
    assert models.state("pillar").pose[0, 3] == pytest.approx(0.5)
    made._furniture = [replace(made._furniture[0], pose=Pose2(1.0, 1.0))]
    made.run(MIDNIGHT + 240.0)
    assert models.state("pillar").pose[:2, 3] == pytest.approx((1.0, 1.0))


def test_furniture_stays_near_its_place():
    moves = furniture_moves(plan(furniture={"pillar": Pose2(1.0, 1.0)}, moves=9), np.random.default_rng(0))
    assert len(moves) == 9 and [move.stamp for move in moves] == sorted(move.stamp for move in moves)
    assert all(move.pose.distance_to(Pose2(1.0, 1.0)) < 0.5 for move in moves)
