import pytest

from add_markers import CarriedParcel, MarkerSettings, TimedParcel
from planar import Pose2, SettingsError
from planar.maps.places import NamedPlace

PICKUP, DROPOFF = NamedPlace("pickup", Pose2(2.0, 3.0), 0.4), NamedPlace("dropoff", Pose2(-2.0, 1.0), 0.4)
ELSEWHERE = Pose2(0.0, 0.0)


def test_the_parcel_waits_is_carried_and_set_down():
    parcel = CarriedParcel(PICKUP, DROPOFF, 5.0)
    assert parcel.update(0.0, ELSEWHERE) == PICKUP.pose
    assert parcel.update(10.0, Pose2(2.1, 3.1)) == PICKUP.pose
    assert parcel.update(14.9, Pose2(2.1, 3.1)) == PICKUP.pose
    assert parcel.update(15.0, Pose2(2.1, 3.1)) is None
    assert parcel.update(20.0, ELSEWHERE) is None
    assert parcel.update(30.0, Pose2(-2.1, 1.1)) == DROPOFF.pose
    assert parcel.update(40.0, ELSEWHERE) == DROPOFF.pose


def test_a_robot_that_only_passes_by_takes_nothing():
    parcel = CarriedParcel(PICKUP, DROPOFF, 5.0)
    parcel.update(0.0, PICKUP.pose)
    parcel.update(3.0, ELSEWHERE)
    assert parcel.update(6.0, PICKUP.pose) == PICKUP.pose
    assert parcel.update(10.9, PICKUP.pose) == PICKUP.pose


def test_nothing_is_delivered_before_it_was_picked_up():
    parcel = CarriedParcel(PICKUP, DROPOFF, 5.0)
    assert parcel.update(0.0, DROPOFF.pose) == PICKUP.pose


def test_a_robot_of_unknown_pose_changes_nothing():
    parcel = CarriedParcel(PICKUP, DROPOFF, 0.0)
    assert parcel.update(0.0, None) == PICKUP.pose
    assert parcel.update(1.0, PICKUP.pose) is None
    assert parcel.update(2.0, None) is None


def test_the_demo_follows_the_clock():
    parcel = TimedParcel(PICKUP, DROPOFF, 5.0, 5.0)
    shown = [parcel.update(100.0 + t) for t in (0.0, 4.9, 5.0, 9.9, 10.0, 60.0)]
    assert shown == [PICKUP.pose, PICKUP.pose, None, None, DROPOFF.pose, DROPOFF.pose]


def test_an_unknown_source_of_the_pose_is_refused():
    with pytest.raises(SettingsError, match="pose_source must be one of tf"):
        MarkerSettings(zones_file="x", pose_source="gps")


def test_a_clock_that_jumps_ahead_and_back_does_not_delay_the_parcel():
    carried, timed = CarriedParcel(PICKUP, DROPOFF, 5.0), TimedParcel(PICKUP, DROPOFF, 5.0, 5.0)
    for now in (1e6, 0.0):
        assert carried.update(now, PICKUP.pose) == timed.update(now) == PICKUP.pose
    assert carried.update(5.0, PICKUP.pose) is timed.update(5.0) is None
