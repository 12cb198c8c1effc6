"""All kinds of faults, by the names that files give them."""

from typing import Dict, Optional, Type

import numpy as np

from planar import SettingsError
from planar.config.hints import hint
from sim_bridge.faults.kind import FaultKind
from sim_bridge.faults.odometry.frozen import FrozenOdometry
from sim_bridge.faults.odometry.gyro_biased import BiasedGyro
from sim_bridge.faults.odometry.scaled import ScaledOdometry
from sim_bridge.faults.odometry.slipping import SlippingOdometry
from sim_bridge.faults.odometry.stopped import StoppedOdometry
from sim_bridge.faults.own import GuardedFault, own_kind
from sim_bridge.faults.rooms.kidnapped import Kidnapped
from sim_bridge.faults.rooms.obstacle import ObjectInWay
from sim_bridge.faults.rooms.turned_round import TurnedRound
from sim_bridge.faults.rooms.wall import WayClosed
from sim_bridge.faults.scans.biased import BiasedScan
from sim_bridge.faults.scans.frozen import FrozenScan
from sim_bridge.faults.scans.inf import InfiniteScan
from sim_bridge.faults.scans.late import LateScan
from sim_bridge.faults.scans.masked import MaskedScan
from sim_bridge.faults.scans.misdated import MisdatedScan
from sim_bridge.faults.scans.nan import NanScan
from sim_bridge.faults.scans.noisy import NoisyScan
from sim_bridge.faults.scans.sparse import SparseScan
from sim_bridge.faults.scans.stopped import StoppedScan
from sim_bridge.faults.scans.turned import TurnedScan
from sim_bridge.faults.scans.zero import ZeroScan
from sim_bridge.faults.wheels.blocked import BlockedWheels
from sim_bridge.faults.wheels.commands_deaf import DeafDrive
from sim_bridge.faults.wheels.commands_late import LateCommands
from sim_bridge.faults.wheels.commands_lost import LostCommands
from sim_bridge.faults.wheels.saturated import SaturatedVelocity
from sim_bridge.faults.wheels.stuck import StuckWheel
from sim_bridge.faults.wheels.weak import WeakWheel

KINDS: Dict[str, Type[FaultKind]] = {
    "scan_stopped": StoppedScan,
    "scan_frozen": FrozenScan,
    "scan_masked": MaskedScan,
    "scan_sparse": SparseScan,
    "scan_nan": NanScan,
    "scan_inf": InfiniteScan,
    "scan_zero": ZeroScan,
    "scan_biased": BiasedScan,
    "scan_noisy": NoisyScan,
    "scan_late": LateScan,
    "scan_misdated": MisdatedScan,
    "scan_turned": TurnedScan,
    "odometry_stopped": StoppedOdometry,
    "odometry_frozen": FrozenOdometry,
    "odometry_scaled": ScaledOdometry,
    "odometry_slipping": SlippingOdometry,
    "gyro_biased": BiasedGyro,
    "wheel_weak": WeakWheel,
    "wheel_stuck": StuckWheel,
    "wheels_blocked": BlockedWheels,
    "commands_lost": LostCommands,
    "commands_late": LateCommands,
    "velocity_saturated": SaturatedVelocity,
    "commands_deaf": DeafDrive,
    "kidnapped": Kidnapped,
    "turned_round": TurnedRound,
    "object_in_way": ObjectInWay,
    "way_closed": WayClosed,
}


def kind_named(name: str) -> Type[FaultKind]:
    """One of these, or other people's by its dotted name, my_package.my_module/MyFault.

    Raises SettingsError if there is none, or with what it lacks.
    """
    kind = KINDS.get(name) or own_kind(name)
    if kind is None:
        raise SettingsError(f"there is no fault {name!r}{hint(name, KINDS)}")
    return kind


def fault_named(name: str, strength: float, rng: np.random.Generator) -> FaultKind:
    """One of a kind, made; other people's is watched."""
    kind = kind_named(name)
    return kind(strength, rng) if name in KINDS else GuardedFault(name, kind, strength, rng)


def usual_strength(kind: str) -> float:
    """The strength of a fault that says nothing of it."""
    return kind_named(kind).strength[0]


def why_not_of_strength(kind: str, strength: float) -> Optional[str]:
    """What a strength of the kind must be, if it is not: "from -5 to 5"; None if it is."""
    _, least, largest = kind_named(kind).strength
    return None if least <= strength <= largest else f"from {least:g} to {largest:g}"
