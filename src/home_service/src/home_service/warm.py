"""Compiles the kernels of every node ahead of time, so that none stalls when it is needed first."""

import explorer_lite.warming
import move_base_lite.warming
import slam_lite.warming
from amcl_lite import LocalizerSettings
from amcl_lite.localizer import warm_up as warm_up_localizer
from home_service.commands.rehearse import Rehearse
from home_service.rehearsal import LOCALIZATION_CONFIG, NAVIGATION_CONFIG
from planar.config.settings_file import settings_from_yaml


def main() -> int:
    """Does what each node does when it starts, then plays the mission."""
    warm_up_localizer(settings_from_yaml(LocalizerSettings, LOCALIZATION_CONFIG)[0])
    move_base_lite.warming.warm_up(move_base_lite.load_settings(NAVIGATION_CONFIG))
    explorer_lite.warming.warm_up()
    slam_lite.warming.warm_up()
    return Rehearse().run()


if __name__ == "__main__":
    raise SystemExit(main())
