"""Settings of the service."""

from dataclasses import dataclass

from planar.config.parameters import POSITIVE, ZERO_OR_MORE, Interval, at_least, check_parameters, parameter

SHARE = Interval(0.0, 1.0)


@dataclass(frozen=True)
class EnergySettings:
    """Figures by which charging is planned; charge is a share of the battery's capacity."""

    drive_hours: float = parameter(3.0, "time that a full battery lasts while driving", "h", POSITIVE)
    stand_hours: float = parameter(6.0, "time that a full battery lasts while standing", "h", POSITIVE)
    charge_hours: float = parameter(1.5, "time to charge an empty battery", "h", POSITIVE)
    reserve: float = parameter(0.2, "charge with which the robot is back in its dock", bounds=SHARE)
    full: float = parameter(0.95, "charge at which charging ends if something is due", bounds=SHARE)
    idle_charge: float = parameter(0.9, "charge below which an idle robot returns to its dock", bounds=SHARE)

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class ServiceSettings:
    """Durations, patience and bounds."""

    pickup_seconds: float = parameter(5.0, "duration of picking up", "s", ZERO_OR_MORE)
    dropoff_seconds: float = parameter(0.0, "duration of setting down", "s", ZERO_OR_MORE)
    goal_timeout: float = parameter(180.0, "time after which a goal has failed", "s", POSITIVE)
    attempts: int = parameter(3, "number of attempts to reach a place", bounds=at_least(1))
    retry_seconds: float = parameter(1.0, "pause before the next attempt", "s", ZERO_OR_MORE)
    dock_retry_seconds: float = parameter(60.0, "pause before the next attempt to dock", "s", POSITIVE)
    park_seconds: float = parameter(
        300.0, "idle time from which on the robot waits in its dock", "s", ZERO_OR_MORE
    )
    max_open: int = parameter(1000, "number of open requests; more are refused", bounds=at_least(1))
    replan_seconds: float = parameter(60.0, "longest time between two plans", "s", POSITIVE)

    def __post_init__(self):
        check_parameters(self)
