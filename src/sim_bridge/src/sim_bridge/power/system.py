"""The power system of a robot: battery, motors and charger."""

from dataclasses import dataclass
from typing import Dict, Sequence, Tuple

from sim_bridge.power.battery import Battery, BatteryProfile, BatterySettings, ChargerState
from sim_bridge.power.motors import MotorProfile

# Time between two updates of a battery [simulated s].
POWER_SECONDS = 1.0


@dataclass(frozen=True)
class PowerReading:
    """State of a power system.

    Attributes:
        charge: Charge of the battery, 0 to 1.
        voltage: Voltage of the battery [V].
        current: Current into the battery [A], negative while it discharges.
        motor_currents: Magnitude of the mean current of each motor [A], those on the left first.
        charger: State of the charger.
        is_empty: Whether the battery is empty: the robot has stopped for good.
        capacity: Capacity of the battery [Ah].
    """

    charge: float
    voltage: float
    current: float
    motor_currents: Tuple[float, ...]
    charger: ChargerState
    is_empty: bool
    capacity: float


class PowerSystem:
    """Battery, motors and charger; the computer and the base draw power all the time.

    Args:
        profile: Battery and loads of the robot.
        settings: Charge at the start, capacity and further load.
        motor: Each motor.
    """

    def __init__(
        self, profile: BatteryProfile, settings: BatterySettings, motor: MotorProfile = MotorProfile()
    ):
        self.profile, self._motor = profile, motor
        self._battery = Battery(profile, settings.battery_charge, settings.battery_capacity)
        self._load = profile.base_power + settings.computer_power
        self._angles: Tuple[float, ...] = ()
        self._speeds: Tuple[float, ...] = ()
        self._motor_currents: Tuple[float, ...] = ()
        # Readings by whether the robot is on a dock, which hold until the next update.
        self._readings: Dict[bool, PowerReading] = {}

    @property
    def is_empty(self) -> bool:
        """Whether the battery is empty."""
        return self._battery.is_empty

    def update(self, seconds: float, angles: Sequence[float], is_on_dock: bool) -> None:
        """Charge or discharge the battery.

        Speed and acceleration of the wheels are means over the time since the last update.

        Args:
            seconds: Time since the last update [s].
            angles: Angles of the driven wheels [rad].
            is_on_dock: Whether the robot touches the contacts of a dock.
        """
        self._readings.clear()
        before = self._angles or angles
        speeds = tuple((now - then) / seconds for now, then in zip(angles, before))
        changes = [now - then for now, then in zip(speeds, self._speeds or speeds)]
        self._angles, self._speeds = tuple(angles), speeds
        motions = [(speed, change / seconds) for speed, change in zip(speeds, changes)]
        self._motor_currents = tuple(abs(self._motor.current(*motion)) for motion in motions)
        if is_on_dock and not self.is_empty:
            self._battery.recharge(seconds)
        else:
            motors = sum(self._motor.power(*motion) for motion in motions)
            self._battery.discharge(self._load + motors, seconds)

    def reading(self, is_on_dock: bool) -> PowerReading:
        """Return the present state.

        Args:
            is_on_dock: Whether the robot touches the contacts of a dock.
        """
        if is_on_dock not in self._readings:
            self._readings[is_on_dock] = self._measure(is_on_dock)
        return self._readings[is_on_dock]

    def _measure(self, is_on_dock: bool) -> PowerReading:
        battery, charger = self._battery, ChargerState.DISCHARGING
        if is_on_dock and not battery.is_empty:
            charger = ChargerState.DOCKING_CHARGED if battery.is_full else ChargerState.DOCKING_CHARGING
        return PowerReading(
            battery.charge,
            battery.voltage,
            battery.current,
            self._motor_currents,
            charger,
            battery.is_empty,
            battery.capacity,
        )
