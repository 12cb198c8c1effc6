"""The kind ``commands_deaf``."""

from typing import Optional

from planar import Twist2
from sim_bridge.faults.kind import FaultKind


class DeafDrive(FaultKind):
    """No command is heard."""

    survivable = False

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return None
