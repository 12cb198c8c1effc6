"""Faults of messages between external nodes: which can be relayed, when they are active, what they change."""

import math
import sys
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Point, Quaternion, Twist, Vector3
from nav_msgs.msg import Odometry as OdometryMessage
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header

from planar import PlanarError, Pose2, SettingsError, Twist2
from planar_ros.messages.conversion import LaserScanArrays, yaw_of
from planar_ros.messages.validation import MessageError
from sim_bridge.faults import KINDS, Fault, load_faults
from sim_bridge.faults.injection import apply_faults
from sim_bridge.faults.kind import FaultKind
from sim_bridge.faults.registry import default_strength, make_fault
from sim_bridge.faults.relay import MESSAGE_METHODS, RelayedFaults, unsupported_by_relay
from sim_bridge.ros.faults.raw import raw_type
from sim_bridge.ros.faults.received import ReceivedCommand, ReceivedOdometry, ReceivedScan
from sim_bridge.ros.faults.relay import transform_of

OUT_OF_REACH = {"wheel_weak", "wheel_stuck", "wheels_blocked"} | {
    "kidnapped", "turned_round", "object_in_way", "way_closed"
}  # fmt: skip
TILT = 0.1


class DoubledRange(FaultKind):
    """All ranges are doubled, up to 5 m."""

    def scan(self, scan):
        return replace(scan, ranges=2.0 * scan.ranges.astype(float), range_max=5.0)


class OnlyBegins(FaultKind):
    """Changes no message."""

    def begin(self, stage):
        raise AssertionError("a relay has no home")


class FarFuture(FaultKind):
    """Scans have a stamp beyond the range of a message."""

    def scan(self, scan):
        return replace(scan, stamp=1e12)


@pytest.fixture(autouse=True)
def custom_module(monkeypatch):
    monkeypatch.setitem(sys.modules, "custom.relayed", sys.modules[__name__])


def data_of(message):
    buffer = BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def scan_message(second=1700000000, seq=7):
    """A scan with a stamp that no float holds, and infinite range_max, as of some drivers."""
    made = LaserScan(
        header=Header(seq, rospy.Time(second, 123456789), "laser"),
        angle_min=-1.0, angle_max=1.0, angle_increment=0.5, time_increment=0.001, scan_time=0.1,
        range_min=0.1, range_max=math.inf,
        ranges=[1.0, math.nan, 2.5, math.inf, 0.75], intensities=[10.0, 0.0, 3.0, 4.0, float(seq)],
    )  # fmt: skip
    return read_back(made, LaserScan)  # rounded to what it holds


def odometry_message(x=2.0, yaw=0.5, seq=7):
    """On a slope, and with a velocity to the side."""
    message = OdometryMessage(header=Header(seq, rospy.Time(seq, 123456789), "odom"), child_frame_id="base")
    message.pose.pose.position = Point(x, 3.0, 0.25)
    half, tilted = yaw / 2.0, TILT / 2.0
    message.pose.pose.orientation = Quaternion(
        -math.sin(half) * math.sin(tilted), math.cos(half) * math.sin(tilted),
        math.sin(half) * math.cos(tilted), math.cos(half) * math.cos(tilted),
    )  # fmt: skip
    message.twist.twist = command_message(0.4, seq)
    message.pose.covariance = [float(number) for number in range(36)]
    message.twist.covariance = [float(-number) for number in range(36)]
    return message


def command_message(v=0.4, seq=7):
    return Twist(Vector3(v, float(seq), 0.2), Vector3(0.3, 0.4, 0.5))


def apply_kind(name, change, value_type, *messages, strength=None):
    """Apply a fault to serialized messages; return messages, or None for none."""
    kind = make_fault(
        name, default_strength(name) if strength is None else strength, np.random.default_rng(0)
    )
    faulty = []
    for message in messages:
        received = value_type.from_msg(value_type.kind().deserialize(data_of(message)))
        value = apply_faults([kind], change, received)
        faulty.append(None if value is None else read_back(received.to_msg(value), type(message)))
    return faulty


def read_back(message, kind):
    return kind().deserialize(data_of(message))


def difference(one, other):
    """The names of the fields that are not the same to the last bit."""
    kinds = zip(one.__slots__, one._slot_types)
    return {
        name for name, kind in kinds if bits(getattr(one, name), kind) != bits(getattr(other, name), kind)
    }


def bits(value, kind):
    if hasattr(value, "serialize"):
        return data_of(value)
    return np.asarray(value).tobytes() if "float" in kind else value


def pitch_of(q):
    return math.asin(2.0 * (q.w * q.y - q.z * q.x))


@pytest.mark.parametrize("name", KINDS)
def test_only_kinds_that_change_messages_can_be_relayed(name):
    reason = unsupported_by_relay(name)
    assert (reason is not None) == (name in OUT_OF_REACH)
    if reason is not None:
        assert reason.startswith(f"{name} changes no scan, odometry or command, only wheels or the home")


def test_custom_kinds_can_be_relayed_by_the_methods_of_their_class():
    assert unsupported_by_relay("custom.relayed/DoubledRange") is None
    assert "custom.relayed/OnlyBegins changes no scan" in unsupported_by_relay("custom.relayed/OnlyBegins")
    faults = RelayedFaults([Fault("custom.relayed/DoubledRange", strength=1.0)])
    assert [len(faults.active(0.0, change)) for change in MESSAGE_METHODS] == [1, 0, 0]


@pytest.mark.parametrize("name", sorted(OUT_OF_REACH))
def test_a_kind_that_cannot_be_relayed_is_refused_in_a_file_with_its_line(name, tmp_path):
    path = tmp_path / "faults.yaml"
    path.write_text(f"faults:\n  - {{kind: scan_nan}}\n  - {{kind: {name}}}\n")
    assert len(load_faults(path)) == 2, "the simulator can"
    with pytest.raises(
        SettingsError, match=rf"faults.yaml:3: faults\[2\].kind cannot be used: {name} changes"
    ):
        load_faults(path, unsupported_by_relay)


def test_a_kind_that_cannot_be_relayed_is_refused_when_added():
    faults = RelayedFaults([])
    with pytest.raises(SettingsError, match="^kidnapped changes no scan"):
        faults.add("kidnapped", 1.0, 0.5, 0.0)
    with pytest.raises(SettingsError, match="there is no fault 'scan_nans' .did you mean \"scan_nan\""):
        faults.add("scan_nans", 1.0, 0.5, 0.0)
    assert not any(faults.active(0.0, change) for change in MESSAGE_METHODS)


def active_counts(faults, times, change="scan"):
    return [len(faults.active(time, change)) for time in times]


def test_times_of_a_fault_count_from_the_first_time_of_the_clock():
    faults = RelayedFaults([Fault("scan_nan", 2.0, 4.0)])
    assert active_counts(faults, [0.0, 3.0]) == [0, 0], "before there is a clock"
    faults.begin(1000.0)
    assert active_counts(faults, [1001.9, 1002.0, 1003.9, 1004.0]) == [0, 1, 1, 0]


def test_only_the_methods_that_a_fault_overrides_are_called():
    faults = RelayedFaults([Fault("scan_nan"), Fault("odometry_stopped"), Fault("commands_deaf")])
    for change, kind in zip(MESSAGE_METHODS, ("scan_nan", "odometry_stopped", "commands_deaf")):
        assert [type(each) for each in faults.active(0.0, change)] == [KINDS[kind]]


def test_an_added_fault_starts_now():
    faults = RelayedFaults([])
    faults.begin(1000.0)
    faults.add("scan_nan", 2.0, 1.0, 1005.0)
    assert active_counts(faults, [1004.9, 1005.0, 1006.9, 1007.0]) == [0, 1, 1, 0]


def test_when_the_clock_jumps_back_the_faults_restart():
    """Else delayed scans of a bag's first round would block those of the second."""
    faults = RelayedFaults([Fault("scan_late", 1.0, strength=0.5)])
    faults.begin(1000.0)
    faults.add("scan_nan", 100.0, 1.0, 1009.0)
    (late, _) = faults.active(1010.0, "scan")
    assert faults.active(1009.5, "scan")[0] is late, "a correction of the clock is no jump"
    assert active_counts(faults, [1000.5, 1001.0]) == [0, 1]
    assert faults.active(1001.0, "scan") != [late]
    assert active_counts(faults, [10.5, 11.4, 11.6]) == [0, 0, 1], "the clock begins where it has jumped to"


def test_random_faults_depend_on_the_seed():
    def noise(seed):
        (kind,) = RelayedFaults([Fault("scan_noisy", strength=0.5)], seed).active(0.0, "scan")
        return kind.scan(
            ReceivedScan.from_msg(LaserScanArrays().deserialize(data_of(scan_message())))
        ).ranges[0]

    assert noise(1) == noise(1) != noise(2)


@pytest.mark.parametrize(
    ("value_type", "message"),
    [
        (ReceivedScan, scan_message()),
        (ReceivedOdometry, odometry_message()),
        (ReceivedCommand, command_message()),
    ],
)
def test_a_raw_message_is_the_same_to_the_last_bit(value_type, message):
    kind = raw_type(value_type.kind)
    wire = data_of(message)
    received = kind().deserialize(wire)
    assert data_of(received) == wire == data_of(kind.from_message(message))
    assert data_of(received.decode()) == wire
    assert (kind._type, kind._md5sum) == (message._type, message._md5sum)
    with pytest.raises(MessageError, match="cannot be read"):
        kind().deserialize(wire[:-3]).decode()


@pytest.mark.parametrize(
    ("change", "value_type", "message"),
    [
        ("scan", ReceivedScan, scan_message()),
        ("odometry", ReceivedOdometry, odometry_message()),
        ("command", ReceivedCommand, command_message()),
    ],
)
def test_an_unchanged_message_is_passed_on_to_the_last_bit(change, value_type, message):
    received = value_type.from_msg(value_type.kind().deserialize(data_of(message)))
    assert data_of(received.to_msg(received)) == data_of(message)
    assert data_of(received.to_msg(replace(received))) == data_of(message)


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("scan_nan", {"ranges"}),
        ("scan_biased", {"ranges"}),
        ("scan_noisy", {"ranges"}),
        ("scan_masked", {"ranges"}),
        ("scan_misdated", {"header"}),
        ("scan_turned", {"angle_min", "angle_max"}),
        ("custom.relayed/DoubledRange", {"ranges", "range_max"}),
    ],
)
def test_only_the_fields_that_a_fault_changes_differ(name, changed):
    message = scan_message()
    (faulty,) = apply_kind(name, "scan", ReceivedScan, message)
    assert difference(faulty, message) == changed


def test_a_scan_is_changed_as_in_the_simulator():
    message = scan_message()
    (faulty,) = apply_kind("scan_turned", "scan", ReceivedScan, message, strength=90.0)
    assert faulty.angle_min == pytest.approx(-1.0 - math.pi / 2.0)
    assert faulty.angle_max == pytest.approx(1.0 - math.pi / 2.0)
    (faulty,) = apply_kind("scan_misdated", "scan", ReceivedScan, message, strength=-0.25)
    assert (faulty.header.stamp - message.header.stamp).to_sec() == pytest.approx(-0.25, abs=1e-6)
    assert (faulty.header.frame_id, faulty.header.seq) == ("laser", 7)
    (faulty,) = apply_kind("custom.relayed/DoubledRange", "scan", ReceivedScan, message)
    assert faulty.ranges[0] == 2.0 and faulty.ranges[2] == 5.0


def test_a_late_scan_is_the_earlier_message():
    messages = [scan_message(1700000000 + number, number) for number in range(3)]
    faulty = apply_kind("scan_late", "scan", ReceivedScan, *messages, strength=2.0)
    assert faulty[:2] == [None, None]
    assert data_of(faulty[2]) == data_of(messages[0])


def test_a_frozen_scan_has_new_headers_to_the_nanosecond():
    first, second = scan_message(1700000000, 1), scan_message(1700000001, 2)
    _, faulty = apply_kind("scan_frozen", "scan", ReceivedScan, first, second)
    assert difference(faulty, first) == {"header"}
    assert data_of(faulty.header) == data_of(second.header)


def test_a_stamp_that_no_message_holds_is_refused():
    with pytest.raises(MessageError, match="a scan at 1e\\+12 s means nothing"):
        apply_kind("custom.relayed/FarFuture", "scan", ReceivedScan, scan_message())


def test_odometry_that_is_scaled_keeps_height_tilt_covariances_and_all_else():
    messages = [odometry_message(2.0), odometry_message(3.0)]
    _, faulty = apply_kind("odometry_scaled", "odometry", ReceivedOdometry, *messages, strength=2.0)
    assert difference(faulty, messages[1]) == {"pose"}
    assert list(faulty.pose.covariance) == messages[1].pose.covariance
    assert (faulty.pose.pose.position.x, faulty.pose.pose.position.z) == (pytest.approx(4.0), 0.25)


def test_odometry_that_turns_keeps_its_tilt():
    messages = [odometry_message(yaw=0.5), odometry_message(yaw=0.5)]
    _, faulty = apply_kind("gyro_biased", "odometry", ReceivedOdometry, *messages, strength=1.0)
    assert yaw_of(faulty.pose.pose.orientation) == pytest.approx(0.52)
    assert pitch_of(messages[1].pose.pose.orientation) == pytest.approx(TILT)
    assert pitch_of(faulty.pose.pose.orientation) == pytest.approx(TILT)


def test_frozen_odometry_is_the_first_with_new_headers():
    first, second = odometry_message(2.0, 0.5, seq=1), odometry_message(3.0, 0.7, seq=2)
    _, faulty = apply_kind("odometry_frozen", "odometry", ReceivedOdometry, first, second)
    assert difference(faulty, first) == {"header"}
    assert data_of(faulty.header) == data_of(second.header)


def test_a_command_that_is_saturated_keeps_its_other_axes():
    (faulty,) = apply_kind("velocity_saturated", "command", ReceivedCommand, command_message(0.4))
    assert faulty == Twist(Vector3(0.15, 7.0, 0.2), Vector3(0.3, 0.4, 0.5))


def test_a_late_command_is_the_earlier_message():
    messages = [command_message(0.1, 1), command_message(0.2, 2)]
    faulty = apply_kind("commands_late", "command", ReceivedCommand, *messages, strength=1.0)
    assert faulty == [None, messages[0]]


@pytest.mark.parametrize(
    ("value_type", "message"),
    [
        (ReceivedScan, LaserScan(angle_min=math.nan, ranges=[1.0])),
        (ReceivedOdometry, OdometryMessage(header=Header(frame_id="odom"))),
        (ReceivedCommand, Twist(linear=Vector3(math.inf, 0.0, 0.0))),
    ],
)
def test_an_invalid_message_is_refused(value_type, message):
    if value_type is ReceivedOdometry:
        message.pose.pose.position.x = math.nan
    with pytest.raises(PlanarError, match="invalid|out of range"):
        value_type.from_msg(message)


def test_the_transform_is_that_of_the_odometry():
    message = odometry_message(2.0, 0.5)
    transform = transform_of(message)
    assert (transform.header, transform.child_frame_id) == (Header(0, message.header.stamp, "odom"), "base")
    assert transform.transform.translation == Vector3(2.0, 3.0, 0.25)
    assert yaw_of(transform.transform.rotation) == pytest.approx(0.5)
    assert pitch_of(transform.transform.rotation) == pytest.approx(TILT)


@pytest.mark.parametrize("lacking", ["frame", "child", "place"])
def test_odometry_without_place_or_frame_has_no_transform(lacking):
    message = odometry_message()
    if lacking == "frame":
        message.header.frame_id = ""
    elif lacking == "child":
        message.child_frame_id = "/"
    else:
        message.pose.pose.position.z = math.nan
    with pytest.raises(PlanarError):
        transform_of(message)


def test_received_odometry_has_the_values_of_the_message():
    received = ReceivedOdometry.from_msg(odometry_message(2.0, 0.5))
    assert (received.base_in_odom.x, received.base_in_odom.y) == (2.0, 3.0)
    assert received.base_in_odom.yaw == pytest.approx(Pose2(2.0, 3.0, 0.5).yaw)
    assert received.twist == Twist2(0.4, 0.5)
