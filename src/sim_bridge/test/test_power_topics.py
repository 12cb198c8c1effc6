"""Events and diagnoses of a battery, as kobuki_node's."""

from dataclasses import replace

import pytest

pytest.importorskip("rospy")
pytest.importorskip("kobuki_msgs.msg")

from kobuki_msgs.msg import PowerSystemEvent  # noqa: E402

from sim_bridge.power.battery import KOBUKI_BATTERY, ChargerState  # noqa: E402
from sim_bridge.power.system import PowerReading  # noqa: E402
from sim_bridge.ros.power_topics import diagnostic_status, events_between, percent  # noqa: E402

FULL = PowerReading(1.0, 16.4, -0.6, (0.1, 0.1), ChargerState.DISCHARGING, False, 2.2)
CHARGING, CHARGED = ChargerState.DOCKING_CHARGING, ChargerState.DOCKING_CHARGED


@pytest.mark.parametrize(
    "last, power, events",
    [
        (FULL, replace(FULL, voltage=16.3), []),
        (FULL, replace(FULL, charger=CHARGING), [PowerSystemEvent.PLUGGED_TO_DOCKBASE]),
        (
            replace(FULL, charger=CHARGING),
            replace(FULL, charger=CHARGED),
            [PowerSystemEvent.CHARGE_COMPLETED],
        ),
        (replace(FULL, charger=CHARGED), FULL, [PowerSystemEvent.UNPLUGGED]),
        (replace(FULL, voltage=14.1), replace(FULL, voltage=14.0), [PowerSystemEvent.BATTERY_LOW]),
        (replace(FULL, voltage=13.3), replace(FULL, voltage=13.1), [PowerSystemEvent.BATTERY_CRITICAL]),
        (replace(FULL, voltage=13.9), replace(FULL, voltage=14.1), []),
    ],
)
def test_events_are_those_of_changes_and_of_falling_voltages(last, power, events):
    assert events_between(last, power, KOBUKI_BATTERY) == events


@pytest.mark.parametrize(
    "voltage, charger, message",
    [
        (16.0, ChargerState.DISCHARGING, "Healthy"),
        (13.8, ChargerState.DISCHARGING, "Low"),
        (13.0, ChargerState.DISCHARGING, "Dangerous"),
        (16.5, CHARGED, "Maximum"),
    ],
)
def test_the_diagnosis_has_the_levels_of_kobuki_node(voltage, charger, message):
    status = diagnostic_status(replace(FULL, voltage=voltage, charger=charger), KOBUKI_BATTERY)
    assert status.message == message


def test_the_percentage_is_that_of_kobuki_node():
    assert percent(16.5, KOBUKI_BATTERY) == 100.0
    assert percent(13.2, KOBUKI_BATTERY) == pytest.approx(5.0)
