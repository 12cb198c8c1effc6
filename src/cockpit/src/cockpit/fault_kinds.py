"""The kinds of faults that the simulator has, told by a process of their own that ends when it has.

They bring physics along, which is not to stay in the cockpit's memory.
"""

import subprocess
import sys
from functools import lru_cache
from typing import Dict, List

import msgspec.msgpack

from cockpit.errors import CockpitError
from cockpit.models.faults import Kind

READING_SECONDS = 60.0


@lru_cache(maxsize=None)
def known_kinds() -> Dict[str, Kind]:
    """By their names, in the simulator's order; read once. Raises CockpitError."""
    command = [sys.executable, "-m", __name__]
    try:
        told = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=READING_SECONDS, check=True
        ).stdout
    except (OSError, subprocess.SubprocessError) as error:
        raise CockpitError(f"the kinds of faults cannot be read ({error})") from None
    return {kind.name: kind for kind in msgspec.msgpack.decode(told, type=List[Kind])}


def main() -> None:
    from sim_bridge.faults import KINDS

    kinds = [
        Kind(name, (kind.__doc__ or "").partition("\n")[0].rstrip("."), kind.unit, *kind.strength)
        for name, kind in KINDS.items()
    ]
    sys.stdout.buffer.write(msgspec.msgpack.encode(kinds))


if __name__ == "__main__":
    main()
