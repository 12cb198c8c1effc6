"""An episode publishes the same events as a run over ROS."""

from collections import Counter
from pathlib import Path

from evaluation.events import EstimateUpdated, MarkerUpdated, MissionUpdated, SensorDistrusted, TruthUpdated
from headless_mission import EpisodeConditions, HeadlessMission, parcel_for
from pick_objects import errand_mission
from planar import load_map
from planar.maps.places import load_pickup_and_dropoff
from sim_bridge import load_world, robot_named
from sim_bridge.faults import Fault

MAP = Path(__file__).resolve().parents[3] / "map"


def errand_of(seed, *faults):
    errand = errand_mission(*load_pickup_and_dropoff(MAP / "zones.yaml"))
    world, grid = load_world(MAP / "home.world"), load_map(MAP / "home.yaml")
    inputs = (world, robot_named("turtlebot_lidar"), grid, errand)
    return HeadlessMission(*inputs, seed, parcel_for(errand), EpisodeConditions(faults=faults))


def observed(mission, *kinds):
    """Run a mission; return its result and its events of some types."""
    received = []
    for kind in kinds:
        mission._observer.events.subscribe(kind, received.append)
    return mission.run(240.0), received


def test_poses_are_published_at_each_tick_and_markers_and_mission_when_they_change():
    run, received = observed(errand_of(1), TruthUpdated, EstimateUpdated, MarkerUpdated, MissionUpdated)
    count = Counter(type(event) for event in received)
    assert count[TruthUpdated] == count[EstimateUpdated] == len(run.trajectory)
    assert count[MarkerUpdated] == len(run.mission_record.markers) == 3
    missions = [event for event in received if isinstance(event, MissionUpdated)]
    assert len(missions) < 12
    assert missions[-1].state == run.mission_record.final_state == "delivered"
    stamps = [event.stamp for event in received]
    assert stamps == sorted(stamps)


def test_a_sensor_that_navigation_does_not_trust_is_published_once():
    run, received = observed(errand_of(5001, Fault("odometry_frozen", start=8.0)), SensorDistrusted)
    assert [event.reason for event in received] == [run.diagnosis]
    assert run.diagnosis
