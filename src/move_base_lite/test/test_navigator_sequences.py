"""The Navigator under random sequences of goals, cancellations, maps, missing scans and jumps of time."""

from dataclasses import replace

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from robot_in_picture import SETTINGS, Robot, room, with_block

from move_base_lite import Navigator, Status
from planar import Pose2, Twist2

START, NEAR = Pose2(1.0, 1.5), Pose2(1.4, 1.5)
ROOM = room(3.0, 3.0)
WALLED = with_block(ROOM, 1.8, 0.0, 1.9, 3.0)
GOALS = {
    "here": START,
    "near": NEAR,
    "across": Pose2(2.4, 1.5, 3.0),
    "in a wall": Pose2(0.02, 1.5),
    "off the map": Pose2(50.0, 0.0),
}
MOST_TICKS = 200
UNREACHABLE = ("in a wall", "off the map")


class NavigatorSequences(RuleBasedStateMachine):
    """Calls of the node on a Navigator; ``goal`` is the name of the goal in progress."""

    @initialize()
    def begin(self):
        self.robot, self.goal = Robot(ROOM, START), None
        self.navigator = Navigator(SETTINGS, ROOM)

    def tick(self):
        decision = self.robot.tick(self.navigator)
        if self.goal is None:
            assert decision.status is Status.IDLE
            assert decision.command is decision.outcome is decision.progress is None
            return decision
        assert decision.command is not None
        assert decision.status not in (Status.IDLE, Status.CANCELLED)
        assert decision.status.is_final is (decision.outcome is not None)
        if decision.status.is_final:
            self.check_end(decision)
        return decision

    def check_end(self, decision):
        """A goal ends once, with a stop command."""
        assert decision.command == Twist2()
        assert self.goal not in UNREACHABLE or decision.status is not Status.SUCCEEDED
        assert decision.outcome.seconds >= 0.0
        assert decision.outcome.recoveries >= 0
        self.goal = None

    @rule(name=st.sampled_from(sorted(GOALS)))
    def set_goal(self, name):
        self.navigator.set_goal(GOALS[name])
        self.goal = name

    @rule(count=st.sampled_from((1, 1, 3, 10)))
    def tick_several_times(self, count):
        for _ in range(count):
            self.tick()

    @rule()
    def cancel(self):
        decision = self.navigator.cancel(self.robot.now)
        if self.goal is None:
            assert decision.status is Status.IDLE
            assert decision.command is decision.outcome is None
        else:
            assert decision.status is Status.CANCELLED
            self.check_end(decision)

    @rule(is_walled=st.booleans())
    def set_map(self, is_walled):
        self.navigator.set_map(WALLED if is_walled else ROOM)

    @rule()
    def change_settings(self):
        now = self.navigator.settings
        slower = replace(now.controller, max_vel_x=0.7 - now.controller.max_vel_x)
        self.navigator.update_settings(replace(now, controller=slower))

    @rule()
    def clear_costmaps(self):
        self.navigator.clear_costmaps()

    @rule()
    def switch_laser(self):
        self.robot.has_laser = not self.robot.has_laser

    @rule(seconds=st.sampled_from((5.0, 1e6)))
    def jump_forward(self, seconds):
        self.robot.now += seconds
        self.tick()

    @precondition(lambda self: self.robot.now > 5.0)
    @rule()
    def jump_back(self):
        """The node resets the Navigator then."""
        self.robot.now -= 5.0
        self.navigator.reset()
        self.goal = None

    @invariant()
    def is_active_while_there_is_a_goal(self):
        assert self.navigator.is_active is (self.goal is not None)

    def teardown(self):
        """Whatever happened, a goal is reached when there are no more faults."""
        if not hasattr(self, "robot"):
            return
        self.robot.has_laser = True
        self.navigator.set_map(ROOM)
        self.set_goal("near" if self.robot.pose.distance_to(START) < 0.2 else "here")
        for _ in range(MOST_TICKS):
            decision = self.tick()
            if self.goal is None:
                break
        assert decision.status is Status.SUCCEEDED, decision


NavigatorSequences.TestCase.settings = settings(
    max_examples=25, stateful_step_count=20, deadline=None, derandomize=True, database=None
)
TestNavigatorSequences = NavigatorSequences.TestCase
