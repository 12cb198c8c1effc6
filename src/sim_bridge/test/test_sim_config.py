"""Settings, robots and the shipped configuration files."""

import dataclasses
from pathlib import Path

import pytest
import yaml

from planar import SettingsError
from sim_bridge.config import BridgeSettings, SimulationSettings
from sim_bridge.errors import RobotError
from sim_bridge.noise import NOISE_PROFILES, noise_named
from sim_bridge.robots import ROBOTS, robot_named

FOLDER = Path(__file__).resolve().parents[1] / "config"
CONFIG = FOLDER / "sim_bridge.yaml"
# Parameters that are set by the launch file's arguments.
ARGUMENTS = {"world", "dock", "objects_file", "seed", "speed", "wait_for", "pace", "static_publishers"}


def test_the_shipped_configuration_holds_every_default():
    defaults = {**dataclasses.asdict(SimulationSettings()), **dataclasses.asdict(BridgeSettings(world="w"))}
    other_files = ARGUMENTS | set(NOISE_PROFILES["ideal"].__dict__)
    expected = {name: value for name, value in defaults.items() if name not in other_files}
    assert yaml.safe_load(CONFIG.read_text()) == expected


def test_the_shipped_noise_profiles_are_those_of_the_code():
    shipped = yaml.safe_load((FOLDER / "noise.yaml").read_text())
    assert shipped == {name: dataclasses.asdict(noise) for name, noise in NOISE_PROFILES.items()}


def test_the_default_noise_is_that_of_the_turtlebot():
    assert SimulationSettings() == SimulationSettings(**noise_named("turtlebot"))
    assert BridgeSettings(world="w").noise == "turtlebot"


def test_an_unknown_noise_profile_is_refused_with_the_nearest_name():
    with pytest.raises(SettingsError, match=r"one of ideal, turtlebot, high.*did you mean .ideal.\?"):
        noise_named("idea")


def test_the_deprecated_name_of_a_noise_profile_is_accepted_with_a_warning():
    with pytest.warns(FutureWarning, match="'bad' is deprecated; use 'high'"):
        assert noise_named("bad") == noise_named("high")


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"physics_rate": 0}, "physics_rate must be between 1 and 100000, got 0"),
        ({"physics_rate": 10**9}, "physics_rate must be between"),
        ({"scan_rate": 30}, "scan_rate must be a divisor of physics_rate"),
        ({"odometry_rate": 0}, "odometry_rate"),
        ({"alpha1": -1.0}, "alpha1"),
        ({"range_noise": -0.1}, "range_noise must be not negative"),
        ({"range_dropouts": 0.6, "range_max_readings": 0.5}, "range_dropouts must be with"),
    ],
)
def test_errors_about_settings_name_the_parameter(values, named):
    with pytest.raises(SettingsError, match=named):
        SimulationSettings(**values)


@pytest.mark.parametrize("values", [{"world": ""}, {"world": "w", "seed": -1}, {"world": "w", "speed": -1.0}])
def test_errors_about_settings_of_the_node_name_the_parameter(values):
    with pytest.raises(SettingsError, match=list(values)[-1]):
        BridgeSettings(**values)


def test_an_unknown_robot_is_refused_with_the_nearest_name():
    with pytest.raises(RobotError, match='did you mean "turtlebot_lidar"'):
        robot_named("turtlebot_lidr")


@pytest.mark.parametrize("name", ["turtlebot_lidar", "turtlebot_kinect"])
def test_lasers_are_at_the_height_that_costmaps_of_the_turtlebot_expect(name):
    assert 0.25 < ROBOTS[name].laser.pose_in_base[2, 3] < 0.35
