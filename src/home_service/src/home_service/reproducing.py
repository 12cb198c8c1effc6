"""Repeat a run from its folder and compare."""

import json
import shlex
from pathlib import Path
from typing import Any, Dict

from evaluation.trace import first_difference, read_trace
from home_service import cli, commands
from planar import SettingsError
from planar.files.reading import read_text
from supervision.versions import versions

NOTHING = "end of the trace"


def reproduce(folder: Path) -> int:
    """Repeat a run into ``folder``/again and compare the traces.

    Returns:
        0 if the runs are the same, 1 if not.

    Raises:
        SettingsError: If the folder does not suffice to repeat the run.
    """
    before, lines = read_result(folder), read_trace(folder)
    for name, version in versions().items():
        if before["versions"].get(name) != version:
            print(f"{name} is {version} now, was {before['versions'].get(name, 'unknown')}")
    for reason in before.get("not_repeatable_because", ()):
        print(f"that run may not be repeatable: {reason}")
    if before["command"] not in commands.FOLDER.names():
        again = shlex.join([f"./scripts/{before['command']}.sh", *before["arguments"]])
        raise SettingsError(f"{folder}: only its own command runs this again: {again}")
    parent = folder / "again"
    known = set(parent.glob("*/result.json"))
    cli.main([before["command"], *before["arguments"], "--output", str(parent)])
    made = sorted(set(parent.glob("*/result.json")) - known)
    if not made:
        raise SettingsError(f"{folder}: the run could not be made again")
    after = read_result(made[0].parent)
    for reason in after.get("not_repeatable_because", ()):
        print(f"this run may not be repeatable: {reason}")
    difference = first_difference(lines, read_trace(made[0].parent))
    if difference is None:
        print(f"the same: {len(lines)} messages, hash {after['hash'][:16]}")
        return 0
    print(f"not the same; the first difference:\n  was: {difference.here or NOTHING}")
    print(f"  is:  {difference.there or NOTHING}")
    return 1


def read_result(folder: Path) -> Dict[str, Any]:
    """Read result.json of a run folder.

    Raises:
        SettingsError: If a field is missing that is needed to repeat the run.
    """
    path = folder / "result.json"
    try:
        result = json.loads(read_text(path))
    except OSError as error:
        raise SettingsError(f"{path}: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise SettingsError(f"{path}: not JSON ({error})") from None
    for key in ("command", "arguments", "hash", "versions"):
        if not isinstance(result, dict) or key not in result:
            raise SettingsError(f"{path}: no {key}: that run cannot be made again")
    kinds = {"command": str, "arguments": list, "hash": str, "versions": dict}
    for key, kind in kinds.items():
        if not isinstance(result[key], kind):
            raise SettingsError(f"{path}: {key} is not what a run writes there")
    return result
