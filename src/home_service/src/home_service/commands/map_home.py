from dataclasses import dataclass

from evaluation.options import MappingOptions


@dataclass(frozen=True)
class MapHome(MappingOptions):
    """Let the robot explore the world, save its map, and score it against the true one."""

    def run(self) -> int:
        from headless_mission.inputs import read_world
        from home_service.ros.mapping import make_scored_map

        stage = read_world(self)
        return make_scored_map(self, self.mapping(explores=True), stage)
