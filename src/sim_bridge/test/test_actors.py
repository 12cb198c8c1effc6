"""Actors of worlds walk their trajectories."""

import pytest

from sim_bridge import Simulation, SimulationSettings, WorldError
from sim_bridge.sdf import load_world
from sim_bridge.views.true_map import outlines_of

EXACT = SimulationSettings(range_noise=0.0, wheel_slip=0.0)
WALK = [(0.0, 3.0), (2.0, 1.0), (4.0, 3.0)]


def waypoints(walk):
    return "".join(
        f"<waypoint><time>{time}</time><pose>{x} 0 1.0 0 0 0</pose></waypoint>" for time, x in walk
    )


def actor(script, more=""):
    skin = "<skin><filename>walk.dae</filename></skin><animation name='walking'/>"
    return f"<actor name='walker'><pose>5 1 0 0 0 0</pose>{skin}{script}{more}</actor>"


def script(walk, settings=""):
    trajectory = f"<trajectory id='0' type='walking'>{waypoints(walk)}</trajectory>"
    return f"<script>{settings}{trajectory}</script>"


@pytest.fixture
def load(tmp_path):
    def load_text(content):
        ground = "<include><uri>model://ground_plane</uri></include>"
        file = tmp_path / "test.world"
        file.write_text(f"<sdf version='1.6'><world name='w'>{ground}{content}</world></sdf>")
        return load_world(file)

    return load_text


def places(world, *stamps):
    return [world.trajectories[0].at(stamp)[0] for stamp in stamps]


def test_an_actor_follows_its_waypoints_and_repeats_them(load):
    world = load(actor(script(WALK)))
    assert places(world, 0.0, 1.0, 2.0, 3.0, 5.0) == pytest.approx([3.0, 2.0, 1.0, 2.0, 2.0])
    assert world.warnings == ()


def test_an_actor_respects_its_start_delay_and_stays_at_the_end_without_loop(load):
    world = load(actor(script(WALK, "<loop>false</loop><delay_start>1.0</delay_start>")))
    assert places(world, 0.5, 2.0, 5.0, 100.0) == pytest.approx([3.0, 2.0, 3.0, 3.0])


def test_a_laser_sees_it_where_it_is_and_the_map_does_not(load):
    world = load(actor(script(WALK)))
    simulation = Simulation(world, settings=EXACT)
    seen = [simulation.step() for _ in range(round(2.0 / simulation.step_seconds))]
    scans = [one.scan for one in seen if one.scan is not None]
    middle = len(scans[0].ranges) // 2
    assert scans[0].ranges[middle] - scans[-1].ranges[middle] > 1.8
    assert outlines_of(world, 0.3, 0.3) == []


def test_without_a_trajectory_it_stands_where_it_is(load):
    world = load(actor("<script><loop>true</loop></script>"))
    assert world.trajectories == ()
    assert world.bodies[-1].pose_in_world[:2, 3] == pytest.approx([5.0, 1.0])
    assert world.bodies[-1].is_static


def test_a_plugin_that_would_move_it_is_named(load):
    world = load(actor(script(WALK), "<plugin name='p' filename='libActorPlugin.so'/>"))
    assert len(world.warnings) == 1
    assert "libActorPlugin.so" in world.warnings[0]


def test_a_waypoint_without_a_place_is_an_error_that_names_it(load):
    with pytest.raises(
        WorldError, match=r"actor 'walker' > script > trajectory .*waypoint: <pose> is missing"
    ):
        load(actor("<script><trajectory id='0'><waypoint><time>0</time></waypoint></trajectory></script>"))
