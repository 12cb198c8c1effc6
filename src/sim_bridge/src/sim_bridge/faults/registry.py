"""All kinds of faults, by their names in files."""

from typing import Any, Dict, Optional, Type

import numpy as np

from planar import SettingsError
from planar.config.hints import hint
from sim_bridge.faults import drive, home, odometry, scans
from sim_bridge.faults.kind import CONTRACT, FaultKind

KINDS: Dict[str, Type[FaultKind]] = {
    "scan_stopped": scans.StoppedScan,
    "scan_frozen": scans.FrozenScan,
    "scan_masked": scans.MaskedScan,
    "scan_sparse": scans.SparseScan,
    "scan_nan": scans.NanScan,
    "scan_inf": scans.InfiniteScan,
    "scan_zero": scans.ZeroScan,
    "scan_biased": scans.BiasedScan,
    "scan_noisy": scans.NoisyScan,
    "scan_late": scans.LateScan,
    "scan_misdated": scans.MisdatedScan,
    "scan_turned": scans.TurnedScan,
    "odometry_stopped": odometry.StoppedOdometry,
    "odometry_frozen": odometry.FrozenOdometry,
    "odometry_scaled": odometry.ScaledOdometry,
    "odometry_slipping": odometry.SlippingOdometry,
    "gyro_biased": odometry.BiasedGyro,
    "wheel_weak": drive.WeakWheel,
    "wheel_stuck": drive.StuckWheel,
    "wheels_blocked": drive.BlockedWheels,
    "commands_lost": drive.LostCommands,
    "commands_late": drive.LateCommands,
    "velocity_saturated": drive.SaturatedVelocity,
    "commands_deaf": drive.DeafDrive,
    "kidnapped": home.Kidnapped,
    "turned_round": home.TurnedRound,
    "object_in_way": home.ObjectInWay,
    "way_closed": home.WayClosed,
}


def kind_named(name: str) -> Type[FaultKind]:
    """Return a kind of fault.

    Args:
        name: Key of KINDS, or the dotted name of a user-defined kind (``my_package.my_module/MyFault``).

    Raises:
        SettingsError: There is no such kind, or it does not meet the contract.
    """
    kind: Any = KINDS.get(name) or CONTRACT.load(name)
    if kind is None:
        raise SettingsError(f"there is no fault {name!r}{hint(name, KINDS)}")
    return kind


def make_fault(name: str, strength: float, rng: np.random.Generator) -> FaultKind:
    """Instantiate a kind; a user-defined one is guarded.

    Args:
        name: Name of the kind.
        strength: In the unit of the kind.
        rng: Random generator of the fault.

    Raises:
        SettingsError: There is no such kind.
        FaultError: A user-defined kind cannot be instantiated.
    """
    kind = kind_named(name)
    return kind(strength, rng) if name in KINDS else CONTRACT.make(name, strength, rng)


def default_strength(kind: str) -> float:
    """Return the strength of a fault whose file gives none.

    Raises:
        SettingsError: There is no such kind.
    """
    return kind_named(kind).strength[0]


def strength_error(kind: str, strength: float) -> Optional[str]:
    """Check a strength.

    Args:
        kind: Name of the kind.
        strength: In the unit of the kind.

    Returns:
        The valid interval as a text, such as "from -5 to 5"; None if the strength is in it.

    Raises:
        SettingsError: There is no such kind.
    """
    _, least, largest = kind_named(kind).strength
    return None if least <= strength <= largest else f"from {least:g} to {largest:g}"
