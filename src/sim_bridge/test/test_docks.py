"""Docks in a simulated world: signals, what hides them, contacts and charging."""

import math
from dataclasses import replace

import numpy as np
import pytest

from planar import Pose2, SettingsError, Twist2
from planar.geometry.dock_field import CENTRE, ROBOT_FRONT
from planar.geometry.pose import pose_of_text
from sim_bridge import Simulation, SimulationSettings, load_world
from sim_bridge.docks import DOCK_NAME, with_dock
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Plane
from sim_bridge.physics.kinematics import at_rest
from sim_bridge.sdf.reader import MODELS
from sim_bridge.simulation import ROBOT_NAME, box_on_floor
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
EMPTY = World("empty", (FLOOR,))
AHEAD = Pose2(1.5, 0.0, math.pi)


def simulated(world: World = EMPTY, base: Pose2 = AHEAD, dock: Pose2 = Pose2(), **settings) -> Simulation:
    """Return a simulation with a dock, whose robot has its infrared receivers and Kobuki sensors enabled."""
    simulation = Simulation(
        with_dock(world, dock), base_in_world=base, settings=SimulationSettings(**settings)
    )
    for name in ("dock_ir", "kobuki"):
        simulation.scene.robot(ROBOT_NAME).enable_sensor(name)
    return simulation


def signals(simulation: Simulation):
    return simulation.step().readings["dock_ir"].value


def test_a_robot_senses_the_dock_ahead():
    assert signals(simulated()) == (0, CENTRE & 56, 0)


def test_a_wall_or_furniture_hides_the_dock():
    box = box_on_floor("box", (0.1, 0.4, 0.5), Pose2(0.7, 0.0))
    assert signals(simulated(replace(EMPTY, bodies=(FLOOR, box)))) == (0, 0, 0)


def test_a_box_that_is_added_hides_the_dock_and_a_removed_one_does_not():
    simulation = simulated()
    simulation.add_box("box", (0.1, 0.4, 0.5), Pose2(0.7, 0.0), mass=1.0)
    assert signals(simulation) == (0, 0, 0)
    simulation.scene.remove_model("box")
    assert signals(simulation)[1]


def test_signals_of_two_docks_add_up():
    world = with_dock(EMPTY, Pose2(0.0, 1.2, 0.0), "second")
    right, centre, left = signals(simulated(world))
    assert centre & (CENTRE & 56) and centre & 32 and not left


def test_without_a_dock_there_is_no_signal_and_none_after_it_was_removed():
    simulation = simulated()
    simulation.scene.remove_model(DOCK_NAME)
    assert signals(simulation) == (0, 0, 0)


def test_a_moved_dock_takes_its_signals_along():
    simulation = simulated()
    simulation.scene.set_model_state(DOCK_NAME, at_rest(from_pose2(Pose2(0.0, -1.0, 0.0))))
    assert signals(simulation)[1] == 16


def test_a_docked_robot_charges_and_leaves():
    simulation = simulated(base=Pose2(ROBOT_FRONT + 0.02, 0.0, math.pi), battery_charge=0.5)
    assert simulation.step().kobuki.power.charger == 6
    before = simulation.step().power.charge
    for _ in range(150):
        step = simulation.step()
    assert step.power.charge > before and step.power.current > 0.0
    for _ in range(100):
        step = simulation.step(Twist2(-0.2))
    assert step.kobuki.power.charger == 0 and step.power.current < 0.0


def test_a_robot_drives_up_to_the_dock_and_charges():
    simulation = simulated(base=Pose2(0.5, 0.0, math.pi))
    for _ in range(500):
        step = simulation.step(Twist2(0.1))
        if step.kobuki.power.charger:
            break
    assert 0.0 < step.base_in_world.x - ROBOT_FRONT <= 0.031 and not step.contacts


def test_an_empty_robot_stops_for_good():
    simulation = simulated(battery_charge=0.0002, battery_capacity=1.0)
    moved = [simulation.step(Twist2(0.2)).base_in_world.x for _ in range(300)]
    assert moved[0] - moved[-1] > 0.1 and moved[-1] == pytest.approx(moved[-50], abs=1e-3)
    robot = simulation.scene.robot(ROBOT_NAME)
    robot.switch_motors(True)
    for _ in range(50):
        step = simulation.step(Twist2(0.2))
    assert step.power.is_empty and step.base_in_world.x == pytest.approx(moved[-1], abs=1e-3)


def test_a_restarted_scene_has_a_charged_battery():
    simulation = simulated(battery_charge=0.5)
    simulation.mark()
    for _ in range(300):
        step = simulation.step(Twist2(0.2))
    assert step.power.charge < 0.5
    simulation.rewind(0)
    assert simulation.step().power.charge == 0.5


def test_a_world_includes_the_dock_by_its_name(tmp_path):
    world = tmp_path / "docked.world"
    world.write_text(
        "<sdf version='1.6'><world name='w'><include><uri>model://ground_plane</uri></include><include>"
        "<uri>model://kobuki_dock</uri><name>base</name><pose>1 2 0 0 0 0.5</pose></include></world></sdf>"
    )
    loaded = load_world(world)
    assert [body.name for body in loaded.bodies if body.is_dock] == ["base::link"] and not loaded.warnings
    assert (MODELS / "kobuki_dock/model.config").is_file()


@pytest.mark.parametrize("text", ["", "1 2", "1 2 x", "1 2 3 4", "nan 0 0", "1e9 0 0"])
def test_a_pose_that_is_none_is_an_error(text):
    with pytest.raises(SettingsError, match="~dock must be a pose, x y yaw"):
        pose_of_text(text, "~dock")
