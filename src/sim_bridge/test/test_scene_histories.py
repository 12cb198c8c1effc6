"""Random sequences of operations on a scene with robots, models, pedestrians, doors and faults."""

import math

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from planar import PlanarError, Pose2, Twist2
from sim_bridge import ROBOTS, Scene, SimulationSettings
from sim_bridge.doorway import Door
from sim_bridge.errors import WorldError
from sim_bridge.faults import KINDS, Fault, FaultContext, FaultInjector, default_strength
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.people.walker import Walker
from sim_bridge.physics.forces import LinkWrench
from sim_bridge.physics.kinematics import at_rest
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
ACTOR = Body(
    "actor::link", pose3(3.0, -3.0, 0.5), (Collision(Box((0.3, 0.3, 1.0)), np.eye(4)),), is_kinematic=True
)
WORLD = World(
    "w",
    (
        FLOOR,
        box_on_floor("wall", (0.2, 8.0, 1.0), Pose2(4.0, 0.0)),
        box_on_floor("crate", (0.4, 0.4, 0.4), Pose2(2.0, 1.0), mass=2.0),
        ACTOR,
    ),
    trajectories=(
        ScriptedTrajectory(
            "actor::link", np.array([0.0, 2.0, 4.0]), np.array([[3.0, -3.0], [1.0, -3.0], [3.0, -3.0]])
        ),
    ),
    walkers=(Walker("anna", np.array([[-2.0, 2.0], [2.0, 2.5]])),),
    doors=(Door("door", Pose2(-3.0, 0.0), 1.0, 0.5, 1.0),),
)
SETTINGS = SimulationSettings(scan_rate=10)
PROFILES = ("turtlebot_lidar", "turtlebot3_burger")
NAMES = ("wall", "crate", "actor", "anna", "door", "robot", "other", "box", "nobody", "fault_wall")
OF_HOME = ("way_closed", "object_in_way", "kidnapped")
PLACES = (
    Pose2(0.0, 0.0),
    Pose2(-1.0, 1.0, 2.0),
    Pose2(4.0, 0.0),
    Pose2(900.0, 900.0),
    Pose2(1e6, 0.0, 9000.0),
)
COMMANDS = (
    Twist2(0.5, 0.5),
    Twist2(1e300, -1e300),
    Twist2(math.nan, 0.0),
    Twist2(0.0, math.inf),
    Twist2(-math.inf, math.nan),
)


class SceneHistories(RuleBasedStateMachine):
    """The operations of the ROS node on a Scene; ``models`` and ``robots`` are the expected names."""

    @initialize()
    def begin(self):
        self.faults = FaultInjector((), extendable=True)
        self.scene = Scene(WORLD, SETTINGS, wrappers=self.faults.wrappers)
        self.scene.add_robot("robot", ROBOTS["turtlebot_lidar"])
        self.models, self.robots = set(self.scene.models.names()), {"robot"}

    @rule(
        count=st.sampled_from((1, 5, 20)),
        name=st.sampled_from(("robot", "other")),
        twist=st.sampled_from(COMMANDS),
    )
    def time_passes(self, count, name, twist):
        for _ in range(count):
            stamp = self.scene.stamp
            seen = self.scene.step({name: twist} if name in self.robots else {})
            assert self.scene.stamp == pytest.approx(stamp + self.scene.step_seconds)
            assert set(seen) == self.robots
            for observation in seen.values():
                self.check(observation)
            for robot, observation in list(seen.items())[:1]:
                stage = FaultContext(self.scene, robot, observation.base_in_world)
                self.faults.update(self.scene.stamp, stage)
            # Faults add and remove obstacles.
            in_way = {model for model in self.scene.models.names() if model.startswith("fault_")}
            self.models = {model for model in self.models if not model.startswith("fault_")} | in_way

    def check(self, observation):
        assert observation.stamp == self.scene.stamp
        assert observation.base_in_world.is_finite()
        assert observation.twist.is_finite()
        assert math.isfinite(observation.tilt)
        assert np.isfinite((*observation.wheel_angles, *observation.wheel_speeds)).all()
        assert observation.odometry.base_in_odom.is_finite()

    @rule(name=st.sampled_from(NAMES), place=st.sampled_from(PLACES), mass=st.sampled_from((None, 1e-3, 5.0)))
    def a_box_is_added(self, name, place, mass):
        try:
            self.scene.add([box_on_floor(name, (0.3, 0.3, 0.3), place, mass)])
        except WorldError:
            assert name in self.models or not place.is_in_range()
        else:
            assert name not in self.models
            self.models.add(name)

    @rule(
        name=st.sampled_from(("robot", "other", "crate")),
        profile=st.sampled_from(PROFILES),
        place=st.sampled_from(PLACES),
    )
    def a_robot_is_added(self, name, profile, place):
        try:
            self.scene.add_robot(name, ROBOTS[profile], place)
        except WorldError:
            return
        assert name not in self.models
        self.models.add(name)
        self.robots.add(name)

    @rule(name=st.sampled_from(NAMES))
    def a_model_is_deleted(self, name):
        try:
            self.scene.remove_model(name)
        except WorldError:
            assert name not in self.models
        else:
            self.models.remove(name)
            self.robots.discard(name)

    @rule(name=st.sampled_from(NAMES), place=st.sampled_from(PLACES), z=st.sampled_from((0.3, 2.0, -5.0)))
    def a_model_is_moved(self, name, place, z):
        try:
            self.scene.set_model_state(name, at_rest(pose3(place.x, place.y, z, yaw=place.yaw)))
        except WorldError:
            assert name not in self.models
        else:
            assert self.scene.models.state(name).pose2.distance_to(place) < 1e-3 * max(1.0, place.x)

    @rule(first=st.sampled_from(NAMES), second=st.sampled_from(NAMES), detach=st.booleans())
    def links_are_attached_or_detached(self, first, second, detach):
        links = [
            self.scene.models.links_of(name)[0] if name in self.models else name for name in (first, second)
        ]
        try:
            (self.scene.detach if detach else self.scene.attach)(*links)
        except WorldError:
            assert detach or not {first, second} <= self.models or first == second

    @rule(
        name=st.sampled_from(NAMES),
        force=st.sampled_from((20.0, -300.0)),
        seconds=st.sampled_from((0.1, math.inf)),
    )
    def a_wrench_is_applied(self, name, force, seconds):
        link = self.scene.models.links_of(name)[0] if name in self.models else name
        start = self.scene.stamp
        try:
            self.scene.forces.apply_link_wrench(
                LinkWrench(link, np.array([force, 0.0, 0.0]), np.zeros(3), start, start + seconds)
            )
        except WorldError:
            assert name not in self.models

    @rule(mass=st.sampled_from((3.0, 1e-6, 0.0, -1.0, math.nan, math.inf)))
    def the_mass_of_the_crate_is_set(self, mass):
        try:
            self.scene.models.set_mass("crate::link", mass, (0.1, 0.1, 0.1), has_gravity=True)
        except WorldError:
            assert "crate" not in self.models or not 1e-6 <= mass < math.inf

    @rule(kind=st.sampled_from((*sorted(KINDS), *(4 * OF_HOME))), seconds=st.sampled_from((0.2, math.inf)))
    def a_fault_is_added(self, kind, seconds):
        now = self.scene.stamp
        self.faults.add(Fault(kind, now, now + seconds, default_strength(kind)))

    @rule(rate=st.sampled_from((50, 200, 1000, 30, 0)))
    def the_physics_rate_is_set(self, rate):
        before = self.scene.settings
        try:
            self.scene.set_physics_rate(rate)
        except PlanarError:
            assert rate in (30, 0)
            assert self.scene.settings == before

    @rule(gravity=st.sampled_from((9.8, 0.0, -2.0, 1e3)))
    def gravity_is_set(self, gravity):
        self.scene.set_gravity(gravity)

    @rule()
    def poses_are_reset(self):
        stamp = self.scene.stamp
        self.scene.reset_poses()
        assert self.scene.stamp == stamp

    @rule()
    def the_scene_is_reset(self):
        self.scene.reset()
        assert self.scene.stamp == 0.0

    @rule(name=st.sampled_from(("robot", "other")), on=st.booleans())
    def motors_are_switched(self, name, on):
        if name in self.robots:
            self.scene.robot(name).switch_motors(on)
            self.scene.robot(name).reset_odometry()

    @invariant()
    def all_expected_models_exist(self):
        assert set(self.scene.models.names()) == self.models

    @invariant()
    def all_states_are_finite(self):
        for name in self.models:
            state = self.scene.models.state(name)
            assert np.isfinite(state.pose).all(), name
            assert np.isfinite(state.linear).all(), name
            assert np.isfinite(state.angular).all(), name

    def teardown(self):
        """Whatever was done, the scene can be stepped, reset and closed."""
        if not hasattr(self, "scene"):
            return
        try:
            self.time_passes(2, "robot", COMMANDS[0])
            self.the_scene_is_reset()
            self.time_passes(2, "robot", COMMANDS[0])
            self.all_expected_models_exist()
            self.all_states_are_finite()
        finally:
            self.scene.close()


SceneHistories.TestCase.settings = settings(
    max_examples=60, stateful_step_count=15, deadline=None, derandomize=True, database=None
)
TestSceneHistories = SceneHistories.TestCase
