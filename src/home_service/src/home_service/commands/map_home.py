from dataclasses import dataclass

from evaluation.options import MappingOptions


@dataclass(frozen=True)
class MapHome(MappingOptions):
    """Explore a world with SLAM, return, save the map, and score it against the true one.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    def run(self) -> int:
        from headless_mission.inputs import read_mapped_world
        from home_service.ros.mapping import make_scored_map

        stage = read_mapped_world(self)
        return make_scored_map(self, self.mapping(explores=True), stage)
