"""A battery: voltage over charge, discharge by loads, charge curve.

Standard figures are those of the makers: a Kobuki's pack of 14.8 V and 2.2 Ah lasts for some 3 h of driving
and charges in some 1.5 h; a TurtleBot3's has 11.1 V and 1.8 Ah.
"""

import enum
from dataclasses import dataclass
from typing import Tuple

import numpy as np

from planar.config.parameters import ZERO_OR_MORE, Interval, check_parameters, parameter

SECONDS_PER_HOUR = 3600.0
# Charge below which a charger supplies its full current, and the smallest fraction of it [1].
FULL_CURRENT_CHARGE, SMALLEST_CURRENT = 0.8, 0.05


class ChargerState(enum.IntEnum):
    """Charger states of kobuki_msgs/SensorState."""

    DISCHARGING = 0
    DOCKING_CHARGED = 2
    DOCKING_CHARGING = 6


@dataclass(frozen=True)
class BatterySettings:
    """Parameters of the battery of a simulated robot."""

    battery_charge: float = parameter(1.0, "charge of the battery at the start", bounds=Interval(0.0, 1.0))
    battery_capacity: float = parameter(
        0.0, "capacity of the battery; 0: that of the robot's standard pack", "Ah", ZERO_OR_MORE
    )
    computer_power: float = parameter(4.0, "power of the robot's computer and sensors", "W", ZERO_OR_MORE)

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class BatteryProfile:
    """A kind of battery, with the loads of the robot that it is made for.

    Attributes:
        capacity: Capacity [Ah].
        charges: Charges, 0 to 1, at which the voltage is given.
        voltages: Voltage at rest at these charges [V].
        resistance: Internal resistance [Ohm].
        charging_current: Current of the charger up to FULL_CURRENT_CHARGE [A].
        base_power: Power of the base at rest [W].
        low_voltage: Voltage below which the base states that the battery is low [V].
        critical_voltage: Voltage below which it states that it is nearly empty [V].
        fits_dock: Whether the robot has the contacts of a Kobuki's dock.
    """

    capacity: float
    charges: Tuple[float, ...]
    voltages: Tuple[float, ...]
    resistance: float
    charging_current: float
    base_power: float
    low_voltage: float
    critical_voltage: float
    fits_dock: bool = False

    @property
    def full_voltage(self) -> float:
        """Voltage at rest of the full battery [V]."""
        return self.voltages[-1]


KOBUKI_BATTERY = BatteryProfile(
    capacity=2.2,
    charges=(0.0, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0),
    voltages=(12.4, 13.3, 13.8, 14.2, 14.7, 15.2, 15.8, 16.5),
    resistance=0.12,
    charging_current=2.3,
    base_power=5.0,
    low_voltage=14.0,
    critical_voltage=13.2,
    fits_dock=True,
)
TURTLEBOT3_BATTERY = BatteryProfile(
    capacity=1.8,
    charges=(0.0, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0),
    voltages=(9.6, 10.3, 10.6, 10.9, 11.2, 11.5, 11.9, 12.6),
    resistance=0.1,
    charging_current=1.5,
    base_power=3.0,
    low_voltage=11.0,
    critical_voltage=10.5,
)


class Battery:
    """A battery with its charge.

    Args:
        profile: Kind of battery.
        charge: Charge at the start, 0 to 1.
        capacity: Capacity [Ah]; 0 for that of the profile.

    Attributes:
        charge: Charge, 0 to 1.
        current: Current into the battery [A], negative while it discharges.
        is_empty: Whether it has been discharged completely; it then stays out of use.
        capacity: Capacity [Ah].
    """

    def __init__(self, profile: BatteryProfile, charge: float = 1.0, capacity: float = 0.0):
        self._profile = profile
        self.capacity = capacity or profile.capacity
        self.charge, self.current = charge, 0.0
        self.is_empty = charge <= 0.0

    @property
    def is_full(self) -> bool:
        """Whether a charger finds it fully charged."""
        return self.charge >= 1.0

    @property
    def voltage(self) -> float:
        """Voltage under the present load [V]."""
        at_rest = float(np.interp(self.charge, self._profile.charges, self._profile.voltages))
        return at_rest + self.current * self._profile.resistance

    def discharge(self, power: float, seconds: float) -> None:
        """Supply a load.

        Args:
            power: Power of the load [W].
            seconds: Duration [s].
        """
        at_rest = float(np.interp(self.charge, self._profile.charges, self._profile.voltages))
        self.current = 0.0 if self.is_empty else -power / at_rest
        self._add(seconds)
        if self.charge <= 0.0:
            self.is_empty, self.current = True, 0.0

    def recharge(self, seconds: float) -> None:
        """Be charged: at full current first, then by one that falls with the missing charge.

        Args:
            seconds: Duration [s].
        """
        fraction = (1.0 - self.charge) / (1.0 - FULL_CURRENT_CHARGE)
        full = self._profile.charging_current
        self.current = 0.0 if self.is_full else full * min(max(fraction, SMALLEST_CURRENT), 1.0)
        self._add(seconds)

    def _add(self, seconds: float) -> None:
        added = self.current * seconds / (self.capacity * SECONDS_PER_HOUR)
        self.charge = min(max(self.charge + added, 0.0), 1.0)
