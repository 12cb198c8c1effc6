"""The way in: parse, read what was named, run the command, answer with an exit code."""

import importlib
from argparse import Namespace
from typing import Callable, List, Optional

from home_service.options import MAPPING_COMMANDS, REPORT_COMMANDS, parse
from planar import PlanarError
from planar_ros.node.entry import leaving_when_interrupted
from supervision.display import complain
from supervision.errors import LaunchError
from supervision.interruption import INTERRUPTED, RunInterruptedError, raise_when_interrupted

FAILURE, BAD_INPUT = 1, 2
MODULES = {
    "rehearse": "rehearse",
    "doctor": "ros.doctor",
    "replay": "ros.replaying",
    **dict.fromkeys(REPORT_COMMANDS, "reports"),
    **dict.fromkeys(MAPPING_COMMANDS, "ros.mapping"),
}  # of the commands that are not in the module commands


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs one command; returns its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    try:
        with leaving_when_interrupted():
            options = parse(arguments)
            if "world" in options:
                read_inputs(options)
            command = find_command(options.command)
        raise_when_interrupted()
        return command(options)
    except RunInterruptedError as error:
        complain(str(error))
        return INTERRUPTED
    except LaunchError as error:
        complain(str(error))
        return BAD_INPUT if error.is_bad_input else FAILURE
    except PlanarError as error:
        complain(str(error))
        return BAD_INPUT


def find_command(name: str) -> Callable[[Namespace], int]:
    """The function of that name; no more than it needs is imported, which takes time enough."""
    module = importlib.import_module(f"home_service.{MODULES.get(name, 'ros.commands')}")
    return getattr(module, name)


def read_inputs(options) -> None:
    """Reads everything that was named, so that a mistake is told before anything is started."""
    from pick_objects import errand_mission, load_mission
    from planar import load_map
    from planar.maps.places import load_places, places_of_errand
    from sim_bridge import load_world, robot_named

    options.loaded_world = load_world(options.world)
    options.loaded_map = load_map(options.map) if "map" in options else None
    options.loaded_robot = robot_named(options.robot)
    options.places = load_places(options.zones) if "zones" in options else {}
    if getattr(options, "mission", None):
        options.loaded_mission = load_mission(options.mission, options.places, grid=options.loaded_map)
        options.places = options.loaded_mission.places
    elif "zones" in options:
        options.loaded_mission = errand_mission(*places_of_errand(options.zones))
