from dataclasses import dataclass

from evaluation.options import MappingOptions
from supervision.command_line import option


@dataclass(frozen=True)
class TestSlam(MappingOptions):
    """Start home and SLAM, driven by keyboard, in the browser or by the explorer; save the map.

    With keys or the page there is no time limit. Keys come from the terminal
    or from a pipe: echo i:2.0 j:1.5 | ./scripts/test_slam.sh

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    drive: str = option(
        "keys",
        "keys; page: in the browser, until Ctrl-C, implies --web; auto: the robot explores autonomously",
        choices=("keys", "page", "auto"),
    )

    @property
    def is_interactive(self) -> bool:
        return self.drive != "auto"

    @property
    def shows_cockpit(self) -> bool:
        return super().shows_cockpit or self.drive == "page"

    def run(self) -> int:
        from headless_mission.inputs import read_mapped_world
        from home_service.ros.mapping import drive_by_keyboard, drive_in_browser, explore, make_map

        read_mapped_world(self)
        drive = {"keys": drive_by_keyboard, "page": drive_in_browser, "auto": explore}[self.drive]
        launch = self.mapping(explores=self.drive == "auto")
        return make_map(self, launch, drive)
