"""Topics of a robot's battery: battery_state, and those of kobuki_node."""

from typing import List, Optional

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from kobuki_msgs.msg import PowerSystemEvent
from sensor_msgs.msg import BatteryState

from sim_bridge.power.battery import BatteryProfile, ChargerState
from sim_bridge.power.system import PowerReading
from sim_bridge.ros.publishers import RobotPublishers

EVENTS = {
    ChargerState.DISCHARGING: PowerSystemEvent.UNPLUGGED,
    ChargerState.DOCKING_CHARGING: PowerSystemEvent.PLUGGED_TO_DOCKBASE,
    ChargerState.DOCKING_CHARGED: PowerSystemEvent.CHARGE_COMPLETED,
}
STATUS = {
    ChargerState.DISCHARGING: BatteryState.POWER_SUPPLY_STATUS_DISCHARGING,
    ChargerState.DOCKING_CHARGING: BatteryState.POWER_SUPPLY_STATUS_CHARGING,
    ChargerState.DOCKING_CHARGED: BatteryState.POWER_SUPPLY_STATUS_FULL,
}
CHARGING = {
    ChargerState.DISCHARGING: "Not Charging",
    ChargerState.DOCKING_CHARGING: "Full Charging",
    ChargerState.DOCKING_CHARGED: "Trickle Charging",
}
# Percentage that kobuki_node assigns to the critical voltage.
CRITICAL_PERCENT = 5.0


class PowerTopics:
    """Publishes the state of a battery when it has been updated, and events when it changes.

    Args:
        profile: The battery.
        publishers: Publishers of the robot.
        is_kobuki: Whether the robot has kobuki_node's topics.
    """

    def __init__(self, profile: BatteryProfile, publishers: RobotPublishers, is_kobuki: bool):
        self._profile = profile
        self._last: Optional[PowerReading] = None
        self._state = publishers.publisher("battery_state", BatteryState)
        self._events = self._diagnostics = None
        if is_kobuki:
            self._events = publishers.publisher("mobile_base/events/power_system", PowerSystemEvent, 100)
            self._diagnostics = publishers.publisher("/diagnostics", DiagnosticArray)

    def publish(self, power: PowerReading, stamp: rospy.Time) -> None:
        """Publish a state, unless it is the last one.

        Args:
            power: Latest state.
            stamp: Time of the message.
        """
        last, self._last = self._last, power
        if power is last:
            return
        if self._events is not None and last is not None:
            for event in events_between(last, power, self._profile):
                self._events.publish(PowerSystemEvent(event=event))
        if self._state.get_num_connections():
            self._state.publish(battery_state_msg(power, stamp))
        if self._diagnostics is not None and self._diagnostics.get_num_connections():
            message = DiagnosticArray(status=[diagnostic_status(power, self._profile)])
            message.header.stamp = stamp
            self._diagnostics.publish(message)


def events_between(last: PowerReading, power: PowerReading, profile: BatteryProfile) -> List[int]:
    """Return the events of kobuki_msgs/PowerSystemEvent between two states."""
    events = [] if power.charger is last.charger else [EVENTS[power.charger]]
    for event, level in (
        (PowerSystemEvent.BATTERY_LOW, profile.low_voltage),
        (PowerSystemEvent.BATTERY_CRITICAL, profile.critical_voltage),
    ):
        if power.charger is ChargerState.DISCHARGING and power.voltage <= level < last.voltage:
            events.append(event)
    return events


def battery_state_msg(power: PowerReading, stamp: rospy.Time) -> BatteryState:
    """Return the message of a state."""
    message = BatteryState(
        voltage=power.voltage,
        current=power.current,
        charge=power.charge * power.capacity,
        capacity=power.capacity,
        design_capacity=power.capacity,
        percentage=power.charge,
        temperature=float("nan"),
        power_supply_status=STATUS[power.charger],
        power_supply_health=BatteryState.POWER_SUPPLY_HEALTH_GOOD,
        power_supply_technology=BatteryState.POWER_SUPPLY_TECHNOLOGY_LION,
        present=True,
    )
    message.header.stamp = stamp
    return message


def diagnostic_status(power: PowerReading, profile: BatteryProfile) -> DiagnosticStatus:
    """Return the diagnosis of a battery with the values of kobuki_node."""
    discharging, ok, warn = (
        power.charger is ChargerState.DISCHARGING,
        DiagnosticStatus.OK,
        DiagnosticStatus.WARN,
    )
    level, text = warn, "Dangerous"
    if power.charger is ChargerState.DOCKING_CHARGED:
        level, text = ok, "Maximum"
    elif power.voltage > profile.low_voltage:
        level, text = ok, "Healthy"
    elif power.voltage > profile.critical_voltage:
        text = "Low"
    values = {
        "Voltage (V)": f"{power.voltage:.1f}",
        "Percent": f"{percent(power.voltage, profile):g}",
        "Charge (Ah)": f"{power.charge * power.capacity:.2f}",
        "Capacity (Ah)": f"{power.capacity:g}",
        "Source": "None" if discharging else "Dock",
        "Charging State": CHARGING[power.charger],
        "Current (A)": f"{max(power.current, 0.0):.2f}",
    }
    return DiagnosticStatus(
        level=level,
        name="mobile_base: Battery",
        message=text,
        hardware_id="Kobuki",
        values=[KeyValue(key, value) for key, value in values.items()],
    )


def percent(voltage: float, profile: BatteryProfile) -> float:
    """Return kobuki_node's estimate of the charge [%] by the voltage [V]."""
    span = profile.full_voltage - profile.critical_voltage
    share = (voltage - profile.critical_voltage) / span
    return min(max((100.0 - CRITICAL_PERCENT) * share + CRITICAL_PERCENT, 0.0), 100.0)
