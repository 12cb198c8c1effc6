"""Battery, motors and charger."""

import pytest

from sim_bridge import ROBOTS
from sim_bridge.power.battery import (
    KOBUKI_BATTERY,
    TURTLEBOT3_BATTERY,
    Battery,
    BatterySettings,
    ChargerState,
)
from sim_bridge.power.motors import MotorProfile
from sim_bridge.power.system import PowerSystem

HOUR = 3600.0


def hours_until(is_over, advance) -> float:
    """Return after how many hours of steps of 10 s something is over; fails after 24 h."""
    for step in range(int(24 * HOUR / 10.0)):
        if is_over():
            return step * 10.0 / HOUR
        advance()
    raise AssertionError("not over within a day")


@pytest.mark.parametrize("profile", [KOBUKI_BATTERY, TURTLEBOT3_BATTERY])
def test_voltage_falls_with_the_charge(profile):
    voltages = [Battery(profile, charge / 20.0).voltage for charge in range(21)]
    assert voltages == sorted(voltages)
    assert voltages[0] < profile.critical_voltage < profile.low_voltage < voltages[-1]


def test_a_kobuki_drives_for_about_three_hours():
    system, turned = PowerSystem(KOBUKI_BATTERY, BatterySettings()), [0.0]

    def drive() -> None:
        turned[0] += 0.4 / 0.035 * 10.0  # 0.4 m/s
        system.update(10.0, (turned[0], turned[0]), is_on_dock=False)

    assert 2.5 < hours_until(lambda: system.is_empty, drive) < 3.5


def test_a_standing_robot_lasts_longer_than_a_driving_one():
    standing = PowerSystem(KOBUKI_BATTERY, BatterySettings())
    hours = hours_until(lambda: standing.is_empty, lambda: standing.update(10.0, (0.0, 0.0), False))
    assert 3.0 < hours < 5.0


def test_a_kobuki_charges_in_about_one_and_a_half_hours():
    battery = Battery(KOBUKI_BATTERY, 0.02)
    assert 1.3 < hours_until(lambda: battery.is_full, lambda: battery.recharge(10.0)) < 2.2


def test_the_charging_current_falls_as_the_battery_fills():
    battery, currents = Battery(KOBUKI_BATTERY, 0.5), []
    while not battery.is_full:
        battery.recharge(60.0)
        currents.append(battery.current)
    assert currents[0] == KOBUKI_BATTERY.charging_current and currents[-2] < 0.1 * currents[0]
    assert currents == sorted(currents, reverse=True)


def test_an_empty_battery_stays_empty():
    system = PowerSystem(KOBUKI_BATTERY, BatterySettings(battery_charge=0.0001))
    for _ in range(100):
        system.update(1.0, (0.0, 0.0), is_on_dock=False)
    assert system.is_empty
    system.update(HOUR, (0.0, 0.0), is_on_dock=True)
    reading = system.reading(is_on_dock=True)
    assert reading.is_empty and reading.charger is ChargerState.DISCHARGING and reading.charge == 0.0


def test_charger_states_are_those_of_a_dock():
    settings = BatterySettings(battery_charge=0.99)
    system = PowerSystem(KOBUKI_BATTERY, settings)
    assert system.reading(False).charger == 0
    assert system.reading(True).charger == 6
    system.update(HOUR, (0.0, 0.0), is_on_dock=True)
    assert system.reading(True).charger == 2


def test_motors_need_more_power_for_speed_and_for_acceleration_and_none_at_rest():
    motor = MotorProfile()
    assert motor.power(0.0, 0.0) == 0.0
    assert 0.0 < motor.power(5.0, 0.0) < motor.power(15.0, 0.0) < motor.power(15.0, 20.0)
    assert motor.power(-15.0, 0.0) == motor.power(15.0, 0.0)
    assert motor.power(15.0, -200.0) >= 0.0


def test_a_capacity_of_zero_is_that_of_the_standard_pack():
    assert Battery(KOBUKI_BATTERY, 1.0, 0.0).capacity == 2.2
    assert Battery(KOBUKI_BATTERY, 1.0, 4.4).capacity == 4.4


@pytest.mark.parametrize(
    "name, battery",
    [
        ("turtlebot_lidar", KOBUKI_BATTERY),
        ("turtlebot_kinect", KOBUKI_BATTERY),
        ("turtlebot3_burger", TURTLEBOT3_BATTERY),
        ("turtlebot3_waffle", TURTLEBOT3_BATTERY),
        ("jackal", None),
    ],
)
def test_robots_have_the_batteries_of_their_bases(name, battery):
    assert ROBOTS[name].battery is battery
