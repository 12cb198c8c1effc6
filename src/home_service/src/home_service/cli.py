"""The way in: parse, read what was named, run the command, answer with an exit code."""

from typing import List, Optional

from home_service.display import complain
from home_service.errors import LaunchError, RunInterruptedError
from home_service.interruption import leave, raise_when_interrupted
from home_service.options import MAPPING_COMMANDS, REPORT_COMMANDS, ROS_COMMANDS, parse
from planar import PlanarError

FAILURE, BAD_INPUT, INTERRUPTED = 1, 2, 130


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs one command; returns its exit code: 0 success, 1 failure, 2 bad input, 130 interrupted."""
    raise_when_interrupted()
    try:
        options = parse(arguments)
        if options.command in REPORT_COMMANDS:
            from home_service import reports

            return getattr(reports, options.command)(options)
        if options.command == "doctor":
            from home_service.doctor import doctor

            return doctor(options)
        if options.command == "replay":
            from home_service.replaying import replay

            return replay(options)
        read_inputs(options)
        if options.command in MAPPING_COMMANDS:
            from home_service import mapping

            return getattr(mapping, options.command)(options)
        if options.command in ROS_COMMANDS:
            from home_service import commands

            return getattr(commands, options.command)(options)
        from home_service.rehearse import rehearse

        return rehearse(options)
    except RunInterruptedError:
        complain("interrupted")
        return INTERRUPTED
    except LaunchError as error:
        complain(str(error))
        return BAD_INPUT if error.is_bad_input else FAILURE
    except PlanarError as error:
        complain(str(error))
        return BAD_INPUT


def read_inputs(options) -> None:
    """Reads everything that was named, so that a mistake is told before anything is started."""
    from pick_objects import errand_mission, load_mission
    from planar import load_map
    from planar.places import load_places, places_of_errand
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


if __name__ == "__main__":
    leave(main())
