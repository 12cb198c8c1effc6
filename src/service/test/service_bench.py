"""A small site and a robot without physics, for tests of the service."""

import numpy as np

from planar import Pose2
from planar.maps.places import NamedPlace
from service.day.kinematic_robot import KinematicRobot, KinematicSettings
from service.plan.rollout import PlanningModel
from service.request_service import RequestService, Site
from service.requests.parser import Knowledge
from service.task_book import Snapshot

# 2026-11-30 08:00 UTC.
NOW = 1796025600.0
PLACES = {
    name: NamedPlace(name, Pose2(x, y)) for name, x, y in (("kitchen", 0, 0), ("desk", 6, 0), ("hall", 0, 6))
}
DOCK = Pose2(1.0, 1.0)


class StraightLines:
    """Drives along straight lines at 0.3 m/s."""

    def seconds(self, start, end):
        return start.distance_to(end) / 0.3


def site(zone=None, has_dock=True, **surroundings):
    around = PlanningModel(StraightLines(), dock=DOCK if has_dock else None, **surroundings)
    return Site(PLACES, around, Knowledge(tuple(PLACES), has_dock, zone))


def ideal_robot(**options):
    """A robot whose drives take as long as planned and never fail."""
    settings = KinematicSettings(spread=0.0, failure=0.0, docking_failure=0.0)
    return KinematicRobot(StraightLines(), DOCK, np.random.default_rng(0), settings, **options)


class Bench:
    """A service and its robot; ``store`` is called with the changes before an order is carried out."""

    def __init__(self, snapshot=Snapshot(), robot=None, store=None, where=None, **options):
        self.service = RequestService(where or site(), snapshot=snapshot, **options)
        self.robot = robot or ideal_robot()
        self.now, self.orders, self.ended, self.log = NOW, [], {}, []
        self._store = store

    def send(self, text="", **document):
        """Send a request as text, or as a document; return its task."""
        return self.service.submit({**({"text": text} if text else {}), **document}, self.now)

    def tick(self, seconds=0.5):
        self.now += seconds
        event = self.robot.event(self.now)
        order = self.service.advance(self.now, self.robot.inputs(self.now), event)
        self.keep()
        self.robot.carry_out(order, self.now)
        if order is not None:
            self.orders.append(order)

    def keep(self):
        changes = self.service.take_changes()
        if self._store is not None and changes:
            self._store(changes, self.service.book.next_number)
        self.ended.update({task.id: task for task in changes.tasks.values() if not task.is_open})
        self.log += changes.log

    def run(self, seconds):
        end = self.now + seconds
        while self.now < end:
            self.tick()

    def run_until(self, is_over, seconds=2000.0):
        end = self.now + seconds
        while not is_over():
            assert self.now < end, self.service.state(self.now)
            self.tick()

    def finish(self, *tasks):
        self.run_until(lambda: all(task.id in self.ended for task in tasks))
        return [self.ended[task.id] for task in tasks]
