"""The Navigator under goals, cancels, other maps, silence and clocks that jump, in any order."""

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
HOPELESS = ("in a wall", "off the map")


class NavigatorHistories(RuleBasedStateMachine):
    """What the node does with a Navigator; ``goal``: the name of the one that is pursued."""

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
        """A goal ends once, the robot being told to stop, and nothing is left of it."""
        assert decision.command == Twist2()
        assert self.goal not in HOPELESS or decision.status is not Status.SUCCEEDED
        assert decision.outcome.seconds >= 0.0
        assert decision.outcome.recoveries >= 0
        self.goal = None

    @rule(name=st.sampled_from(sorted(GOALS)))
    def a_goal_comes(self, name):
        self.navigator.set_goal(GOALS[name])
        self.goal = name

    @rule(count=st.sampled_from((1, 1, 3, 10)))
    def time_passes(self, count):
        for _ in range(count):
            self.tick()

    @rule()
    def somebody_cancels(self):
        decision = self.navigator.cancel(self.robot.now)
        if self.goal is None:
            assert decision.status is Status.IDLE
            assert decision.command is decision.outcome is None
        else:
            assert decision.status is Status.CANCELLED
            self.check_end(decision)

    @rule(is_walled=st.booleans())
    def another_map_comes(self, is_walled):
        self.navigator.set_map(WALLED if is_walled else ROOM)

    @rule()
    def settings_change(self):
        now = self.navigator.settings
        slower = replace(now.controller, max_vel_x=0.7 - now.controller.max_vel_x)
        self.navigator.update_settings(replace(now, controller=slower))

    @rule()
    def somebody_clears(self):
        self.navigator.clear_costmaps()

    @rule()
    def the_laser_falls_silent_or_speaks_again(self):
        self.robot.has_laser = not self.robot.has_laser

    @rule(seconds=st.sampled_from((5.0, 1e6)))
    def the_clock_jumps(self, seconds):
        self.robot.now += seconds
        self.tick()

    @precondition(lambda self: self.robot.now > 5.0)
    @rule()
    def the_clock_is_set_back(self):
        """The node has the Navigator forget then."""
        self.robot.now -= 5.0
        self.navigator.reset()
        self.goal = None

    @invariant()
    def there_is_one_goal_or_none(self):
        assert self.navigator.is_active is (self.goal is not None)

    def teardown(self):
        """Whatever was, a goal comes to its end when nothing more goes wrong."""
        if not hasattr(self, "robot"):
            return
        self.robot.has_laser = True
        self.navigator.set_map(ROOM)
        self.a_goal_comes("near" if self.robot.pose.distance_to(START) < 0.2 else "here")
        for _ in range(MOST_TICKS):
            decision = self.tick()
            if self.goal is None:
                break
        assert decision.status is Status.SUCCEEDED, decision


NavigatorHistories.TestCase.settings = settings(
    max_examples=25, stateful_step_count=20, deadline=None, derandomize=True, database=None
)
TestNavigatorHistories = NavigatorHistories.TestCase
