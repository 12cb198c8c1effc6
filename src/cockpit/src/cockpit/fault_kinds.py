"""The fault kinds of the simulator, read by a child process.

Listing them loads the physics packages, which should not stay in the cockpit's memory.
"""

import subprocess
import sys
from functools import lru_cache
from typing import Dict, List

import msgspec.msgpack

from cockpit.errors import CockpitError
from cockpit.models.faults import FaultKindInfo

READING_SECONDS = 60.0


@lru_cache(maxsize=None)
def fault_kinds() -> Dict[str, FaultKindInfo]:
    """Return the kinds by name, in the simulator's order; cached.

    Raises:
        CockpitError: The child process failed.
    """
    command = [sys.executable, "-m", __name__]
    try:
        output = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=READING_SECONDS, check=True
        ).stdout
    except (OSError, subprocess.SubprocessError) as error:
        raise CockpitError(f"the kinds of faults cannot be read ({error})") from None
    return {kind.name: kind for kind in msgspec.msgpack.decode(output, type=List[FaultKindInfo])}


def main() -> None:
    from sim_bridge.faults import KINDS

    kinds = [
        FaultKindInfo(name, (kind.__doc__ or "").partition("\n")[0].rstrip("."), kind.unit, *kind.strength)
        for name, kind in KINDS.items()
    ]
    sys.stdout.buffer.write(msgspec.msgpack.encode(kinds))


if __name__ == "__main__":
    main()
