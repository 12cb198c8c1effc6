from dataclasses import dataclass

from home_service.options import MappingOptions
from supervision.command_line import option


@dataclass(frozen=True)
class TestSlam(MappingOptions):
    """Starts home and SLAM, driven with keys (terminal or pipe), or by itself; saves the map."""

    drive: str = option("keys", "who drives the robot", choices=("keys", "auto"))

    @property
    def is_ended_by_a_person(self) -> bool:
        return self.drive == "keys"

    @property
    def wanted_speed(self) -> float:
        return 1.0 if self.speed is None and self.drive == "keys" else super().wanted_speed

    def run(self) -> int:
        from home_service.ros.mapping import make_map
        from home_service.stage import read_stage

        read_stage(self)
        by_keys = self.drive == "keys"
        return make_map(self, self.launch("slam.launch" if by_keys else "mapping.launch"), by_keys)
