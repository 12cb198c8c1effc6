from dataclasses import dataclass

from evaluation.options import MappingOptions
from supervision.command_line import option


@dataclass(frozen=True)
class TestSlam(MappingOptions):
    """Start home and SLAM, driven by keyboard, in the cockpit or by the explorer; save the map."""

    drive: str = option("keys", "how the robot is driven", choices=("keys", "page", "auto"))

    @property
    def is_interactive(self) -> bool:
        return self.drive != "auto"

    @property
    def shows_cockpit(self) -> bool:
        return super().shows_cockpit or self.drive == "page"

    @property
    def effective_speed(self) -> float:
        return 1.0 if self.speed is None and self.is_interactive else super().effective_speed

    def run(self) -> int:
        from headless_mission.inputs import read_world
        from home_service.ros.mapping import drive_by_keyboard, drive_in_browser, explore, make_map

        read_world(self)
        drive = {"keys": drive_by_keyboard, "page": drive_in_browser, "auto": explore}[self.drive]
        launch = self.mapping(explores=self.drive == "auto")
        return make_map(self, launch, drive)
