"""The node ``map_saver``: writes the map on the topic ``map`` to NAME.pgm and NAME.yaml.

    map_saver [--occ 65] [--free 25] [-f NAME] [--timeout SECONDS] [--force]

Unlike the official one it writes the image path relative to the YAML file, so that the pair loads from
anywhere, and writes whole files or none. It exits with code 1 and a reason if there is no map in time,
nothing is known in it, or it cannot be written; with 130 if it is interrupted before.
"""

import argparse
import sys
import threading

import rospy

from map_lite.config import SaverSettings
from planar import UNKNOWN, PlanarError, SettingsError, save_map
from planar.config.parameters import parameters_of
from planar_ros.messages.conversion import OccupancyGridArrays, grid_from_msg
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import fail, init_node, shut_down_on_signals
from supervision.interruption import INTERRUPTED


class NothingToSaveError(PlanarError):
    """No map arrived, or one with unknown cells only."""


def main():
    """Run the node ``map_saver``."""
    parser = _parser()
    arguments = parser.parse_args(rospy.myargv()[1:])
    try:
        settings = SaverSettings(arguments.occupied_at, arguments.free_at)
    except SettingsError as error:
        parser.error(str(error))
    shut_down_on_signals()
    try:
        init_node("map_saver")
        path = _save(arguments, settings)
    except PlanarError as error:
        fail(str(error), exit_code=1)
    except rospy.ROSException:
        if not rospy.is_shutdown():
            raise
        sys.exit(INTERRUPTED)
    rospy.loginfo("Done: %s", path)


def _save(arguments, settings: SaverSettings):
    message = _await_map(arguments.timeout)
    rospy.loginfo(
        "Received a %d X %d map @ %.3f m/pix",
        message.info.width,
        message.info.height,
        message.info.resolution,
    )
    grid = grid_from_msg(message)
    if not arguments.force and (grid.cells == UNKNOWN).all():
        raise NothingToSaveError(
            "nothing is known in this map: all cells are unknown; use --force to save it"
        )
    return save_map(grid, arguments.name, settings.occupied_at, settings.free_at)


def _await_map(timeout):
    topic = rospy.resolve_name("map")
    rospy.loginfo("Waiting for the map")
    received = threading.Event()
    ReadinessMonitor({f"a map on {topic}": received.is_set})
    try:
        return rospy.wait_for_message("map", OccupancyGridArrays, timeout)
    except rospy.ROSInterruptException:
        raise
    except rospy.ROSException:
        raise NothingToSaveError(f"no map on {topic} within {timeout:g} s") from None
    finally:
        received.set()


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="map_saver", description="Save the map on the topic map to a .pgm and a .yaml file."
    )
    for each in parameters_of(SaverSettings):
        text = f"{each.meaning} (%(default)s)"
        parser.add_argument(
            each.name, dest=each.field, type=int, default=each.default, metavar=each.unit.upper(), help=text
        )
    parser.add_argument(
        "-f", dest="name", default="map", help="path of the files without extension (%(default)s)"
    )
    parser.add_argument(
        "--timeout", type=float, metavar="SECONDS", help="give up after this time, wall clock"
    )
    parser.add_argument("--force", action="store_true", help="save also a map with unknown cells only")
    return parser


class _Parser(argparse.ArgumentParser):
    """Exits with code 1 for wrong arguments, as the official map_saver."""

    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(1, f"{self.prog}: error: {message}\n")
