"""Errands under goals, cancels, failures, crashes and clocks that jump, in any order."""

import json
import math

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from pick_objects import (
    Delivery,
    DeliveryStage,
    DriveToPlace,
    Errand,
    ErrandSettings,
    ErrandState,
    FinishTask,
    GoalFailed,
    GoalReached,
    MeasurePathLengths,
    Mission,
    MissionError,
    PathLengthsMeasured,
    checkpoint_of,
    resume_errand,
)
from pick_objects.job import ENDED
from planar import Pose2
from planar.maps.places import NamedPlace

PLACES = {name: NamedPlace(name, Pose2(x, 0.0)) for x, name in enumerate(("kitchen", "hall", "bath", "bed"))}
DELIVERIES = (
    Delivery("tea", "cup", "kitchen", "hall"),
    Delivery("post", "letter", "bath", "kitchen", goal_timeout=20.0),
    Delivery("back", "cup", "hall", "bed"),
    Delivery("book", "book", "bed", "bath", after=("post",)),
)
UNDER_WAY = (
    DeliveryStage.FETCHING,
    DeliveryStage.PICKING_UP,
    DeliveryStage.CARRYING,
    DeliveryStage.SETTING_DOWN,
)
ON_ROBOT = (DeliveryStage.CARRYING, DeliveryStage.SETTING_DOWN)
FINAL = (ErrandState.DELIVERED, ErrandState.FAILED, ErrandState.CANCELLED)
# From the last event on, one attempt at every place lasts so long at most, seconds.
LONGEST_ATTEMPT = 60.0


class ErrandHistories(RuleBasedStateMachine):
    """What the node does with an errand; ``goal``: the one order that is pursued."""

    @initialize(
        count=st.integers(1, len(DELIVERIES)),
        order=st.sampled_from(("given", "shortest")),
        on_failure=st.sampled_from(("stop", "continue")),
        attempts=st.integers(1, 2),
    )
    def begin(self, count, order, on_failure, attempts):
        self.patience = ErrandSettings(5.0, 2.0, 30.0, attempts, 1.0, on_failure, order)
        self.errand = Errand(Mission("test", PLACES, DELIVERIES[:count], settings=self.patience))
        self.now, self.goal, self.end, self.ended = 100.0, None, None, {}

    def advance(self, event=None):
        is_over = self.end is not None
        order = self.errand.advance(self.now, event)
        assert order is None or not is_over, "an errand that is over gives no more orders"
        if order is not None:
            self.goal = order
        if isinstance(order, FinishTask):
            self.goal, self.end = None, order
            assert order.success is (self.errand.state is ErrandState.DELIVERED)

    @rule(seconds=st.sampled_from((0.02, 0.5, 1.0, 6.0, 25.0)))
    def time_passes(self, seconds):
        self.now += seconds
        self.advance()

    @rule(seconds=st.sampled_from((-90.0, -6.0, 1000.0)))
    def the_clock_jumps(self, seconds):
        self.now = max(self.now + seconds, 0.0)
        self.advance()

    @rule(is_set_back=st.booleans())
    def the_clock_jumps_ahead_and_back(self, is_set_back):
        self.now += 1e6
        self.advance()
        self.now -= 1e6 + 50.0 * is_set_back
        self.advance()

    @precondition(lambda self: isinstance(self.goal, DriveToPlace))
    @rule(
        event=st.sampled_from(
            (GoalReached(), GoalReached(), GoalFailed("blocked"), GoalFailed("taken", True))
        )
    )
    def the_goal_ends(self, event):
        self.goal = None
        self.advance(event)

    @precondition(lambda self: isinstance(self.goal, MeasurePathLengths))
    @rule(is_reachable=st.booleans())
    def the_path_lengths_are_measured(self, is_reachable):
        lengths = [1.0 + number if is_reachable else None for number in range(len(self.goal.legs))]
        self.goal = None
        self.advance(PathLengthsMeasured(tuple(lengths)))

    @rule(name=st.sampled_from(("", "", *(delivery.name for delivery in DELIVERIES), "milk")))
    def a_delivery_is_cancelled(self, name):
        try:
            self.errand.cancel(name)
        except MissionError:
            return
        named = [job for job in self.errand.jobs if name in ("", job.delivery.name)]
        assert {job.stage for job in named} <= set(ENDED)

    @rule(name=st.sampled_from(("cup", "vase")), source=st.sampled_from(sorted(PLACES)))
    def a_delivery_is_added(self, name, source):
        try:
            self.errand.add(Delivery("", name, source, "hall"))
        except MissionError:
            assert self.end is not None or source == "hall"

    @rule()
    def the_node_dies_and_is_respawned(self):
        locations = self.errand.object_locations
        again = resume_errand(self.errand.mission, json.loads(json.dumps(checkpoint_of(self.errand))))
        assert again is not None
        self.errand, self.goal = again, None
        assert self.errand.object_locations == locations
        was, self.end = self.end, None
        if was is not None:
            self.advance()
            assert self.end == was, "what had ended ends the same way"

    @invariant()
    def one_delivery_at_a_time_and_what_has_ended_stays_so(self):
        assert sum(job.stage in UNDER_WAY for job in self.errand.jobs) <= 1
        stages = {job.delivery.name: job.stage for job in self.errand.jobs}
        assert self.ended.items() <= stages.items()
        self.ended = {name: stage for name, stage in stages.items() if stage in ENDED}

    @invariant()
    def what_is_carried_is_of_the_delivery_under_way(self):
        carried = {name for name, where in self.errand.object_locations.items() if where.is_carried}
        assert carried == {job.delivery.object_name for job in self.errand.jobs if job.stage in ON_ROBOT}
        for where in self.errand.object_locations.values():
            assert where.place is None or not where.is_carried

    @invariant()
    def the_rest_is_a_share_and_a_time(self):
        assert 0.0 <= self.errand.progress <= 1.0
        assert 0.0 <= self.errand.time_left(self.now) < math.inf
        assert (self.errand.state in FINAL) is (self.end is not None)

    def teardown(self):
        """Whatever was, the errand comes to an end when nothing more goes wrong."""
        if not hasattr(self, "errand"):
            return
        longest = LONGEST_ATTEMPT * 2 * len(self.errand.jobs)
        deadline = self.now + longest
        while self.end is None and self.now < deadline:
            self.now += 0.5
            if isinstance(self.goal, MeasurePathLengths):
                self.the_path_lengths_are_measured(True)
            elif self.goal is not None:
                self.the_goal_ends(GoalReached())
            else:
                self.advance()
        assert self.end is not None, f"still {self.errand.state} after {longest} s"


ErrandHistories.TestCase.settings = settings(
    max_examples=150, stateful_step_count=30, deadline=None, derandomize=True, database=None
)
TestErrandHistories = ErrandHistories.TestCase
