"""Runs over ROS: the files written for the nodes, and the results read from their run folder."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from cockpit.scene.description import SceneDescription
from laboratory.launch_files import write_launch_files
from laboratory.over_ros import _read_trace
from laboratory.scenario import OFFICIAL, read_scenario
from laboratory.suites import FOLDER, load_suites
from pick_objects import load_mission
from planar import Pose2, SettingsError, load_map
from planar.maps.places import load_places
from sim_bridge.faults import Fault, load_faults

ERRAND = FOLDER / "home_errand.yaml"


def test_generated_deliveries_are_written_as_files(tmp_path):
    homes = read_scenario(FOLDER / "homes.yaml")
    arena = homes.arena(3)
    arguments = write_launch_files(homes, 3, tmp_path)
    assert load_map(arguments["map_file"]).cells.shape == arena.grid.cells.shape
    mission = load_mission(
        arguments["mission_file"], load_places(arguments["zones_file"]), grid=load_map(arguments["map_file"])
    )
    assert mission == homes.task._mission(arena, 3)
    assert arguments["marker_mode"] == "mission"


def test_faults_start_noise_and_parameters_are_written_as_files(tmp_path):
    faults = (Fault("scan_noisy", 8.0, 12.0, 3.0), Fault("kidnapped", 4.0, strength=1.0, seed=3))
    parameters = {"DWAPlannerROS": {"max_vel_x": 0.4}}
    scenario = replace(
        read_scenario(ERRAND), start=Pose2(0.5, 0.1, 0.2), faults=faults, parameters=parameters, planner="x/Y"
    )
    arguments = write_launch_files(scenario, 0, tmp_path)
    assert load_faults(arguments["faults_file"]) == faults
    parameters_file = yaml.safe_load(arguments["parameters_file"].read_text())
    assert parameters_file["/amcl"] == {"initial_pose_x": 0.5, "initial_pose_y": 0.1, "initial_pose_a": 0.2}
    assert parameters_file["/move_base"] == parameters
    world = SceneDescription.from_bytes(Path(parameters_file["/cockpit/world"]).read_bytes())
    assert {part.model for part in world.parts} >= {"home", "kitchen_table"}
    assert parameters_file["/sim_bridge"]["range_noise"] == scenario.simulation.range_noise
    assert (arguments["planner"], arguments["marker_mode"]) == ("x/Y", "service")


def test_a_task_that_cannot_run_over_ros_is_refused_before_the_start():
    scenarios, complaints = load_suites(["fields"], is_over_ros=True)
    assert not scenarios
    assert "fields.yaml: the task reach runs in one process only" in complaints[0]


def test_the_official_move_base_runs_only_over_ros_and_only_if_installed(tmp_path, monkeypatch):
    with pytest.raises(SettingsError, match="planner official runs only over ROS; add --over ros"):
        load_suites(["home_errand"], ["official"])
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    with pytest.raises(SettingsError, match="the official move_base is not installed"):
        load_suites(["home_errand"], ["official"], is_over_ros=True)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(FOLDER.parent / "src"))
    with pytest.raises(SettingsError, match="the official move_base is not installed"):
        load_suites(["home_errand"], ["official"], is_over_ros=True)
    package = "<package><name>move_base</name></package>"
    (tmp_path / "package.xml").write_text(package)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    (scenario,), _ = load_suites(["home_errand"], ["official"], is_over_ros=True)
    arguments = write_launch_files(scenario, 0, tmp_path)
    assert arguments["move_base_pkg"] == "move_base"
    assert "planner" not in arguments


def test_the_official_amcl_runs_only_over_ros_and_only_if_installed(tmp_path, monkeypatch):
    with pytest.raises(SettingsError, match="localizer official runs only over ROS; add --over ros"):
        load_suites(["home_errand"], localizer="official")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    with pytest.raises(SettingsError, match="localizer official: the official amcl is not installed"):
        load_suites(["home_errand"], is_over_ros=True, localizer="official")
    (tmp_path / "package.xml").write_text("<package><name>amcl</name></package>")
    (scenario,), _ = load_suites(["home_errand"], is_over_ros=True, localizer="official")
    assert write_launch_files(scenario, 0, tmp_path)["amcl_pkg"] == "amcl"
    assert scenario.label == "home_errand [official amcl] over ROS"
    ours = replace(scenario, localizer="")
    assert scenario.digest() != ours.digest()
    assert "amcl_pkg" not in write_launch_files(ours, 0, tmp_path)


def test_the_reference_length_does_not_depend_on_the_planner():
    ours = read_scenario(ERRAND)
    arena, official = ours.arena(0), replace(ours, planner=OFFICIAL, is_over_ros=True)
    assert official.task.reference_length(official, arena) == ours.task.reference_length(ours, arena) > 5.0


def test_a_scenario_with_the_official_move_base_is_refused_in_one_process(tmp_path):
    file = tmp_path / "with_official.yaml"
    text = ERRAND.read_text().replace("../map", str(FOLDER.parent / "map"))
    file.write_text(text + "planner: {name: official}\n")
    scenarios, complaints = load_suites([str(file)])
    assert not scenarios
    assert complaints == [f"{file}: planner official runs only over ROS; add --over ros"]
    (scenario,), _ = load_suites([str(file)], ["move_base_lite/MppiPlannerROS"])
    assert scenario.planner == "move_base_lite/MppiPlannerROS"


def test_results_over_ros_are_stored_separately():
    scenario = read_scenario(ERRAND)
    over_ros = replace(scenario, is_over_ros=True)
    assert over_ros.digest() != scenario.digest()
    assert over_ros.label == "home_errand over ROS"


@pytest.mark.parametrize(
    ("result", "outcome"),
    [
        ({"success": True, "collisions": []}, "success"),
        ({"success": False, "collisions": ["box_1::link"]}, "collision"),
        ({"success": False, "simulated_seconds": 301.0}, "timeout"),
        ({"success": False, "simulated_seconds": 20.0}, "failure"),
    ],
)
def test_a_run_folder_is_read_as_a_result(tmp_path, result, outcome):
    (tmp_path / "result.json").write_text(json.dumps({"reason": "stated", **result}))
    still = " 0 0 0 0 0.0 1.0\n"
    (tmp_path / "trajectory_true.tum").write_text(f"0.0 0.0{still}2.0 1.0{still}")
    (tmp_path / "trajectory_estimated.tum").write_text(f"1.0 0.75{still}")
    trace = _read_trace(tmp_path, 300.0)
    assert (trace.outcome, trace.reason) == (outcome, "stated")
    assert trace.localization_error.tolist() == [0.25]
    assert trace.trajectory.tolist() == [[0.0, 0.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0]]


def test_poses_after_the_end_of_the_mission_are_ignored(tmp_path):
    result = {"success": True, "reason": "stated", "simulated_seconds": 2.0}
    (tmp_path / "result.json").write_text(json.dumps(result))
    poses = "".join(f"{stamp} {x} 0 0 0 0 0.0 1.0\n" for stamp, x in ((0.1, 0.0), (2.1, 1.0), (3.0, 1.0)))
    for name in ("true", "estimated"):
        (tmp_path / f"trajectory_{name}.tum").write_text(poses)
    trace = _read_trace(tmp_path, 300.0)
    assert trace.trajectory[:, 0].tolist() == [0.1, 2.1]
    assert trace.localization_error.tolist() == [0.0, 0.0]


def test_a_graph_that_did_not_start_is_reported_with_its_reason(tmp_path):
    (tmp_path / "result.json").write_text(json.dumps({"success": False, "reason": "no ROS master"}))
    with pytest.raises(SettingsError, match="no ROS master"):
        _read_trace(tmp_path, 300.0)
