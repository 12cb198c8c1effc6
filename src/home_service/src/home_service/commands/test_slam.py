from dataclasses import dataclass

from home_service.options import MappingOptions
from supervision.command_line import option


@dataclass(frozen=True)
class TestSlam(MappingOptions):
    """Starts home and SLAM, driven with keys (terminal or pipe), at the page, or by itself; saves the map."""

    drive: str = option("keys", "who drives the robot", choices=("keys", "page", "auto"))

    @property
    def is_ended_by_a_person(self) -> bool:
        return self.drive != "auto"

    @property
    def is_on_the_web(self) -> bool:
        return super().is_on_the_web or self.drive == "page"

    @property
    def wanted_speed(self) -> float:
        return 1.0 if self.speed is None and self.is_ended_by_a_person else super().wanted_speed

    def run(self) -> int:
        from home_service.ros.mapping import drive_at_the_page, drive_by_keys, explore, make_map
        from home_service.stage import read_stage

        read_stage(self)
        drive = {"keys": drive_by_keys, "page": drive_at_the_page, "auto": explore}[self.drive]
        launch = self.mapping(explores=self.drive == "auto")
        return make_map(self, launch, drive)
