from dataclasses import dataclass

from home_service.options import GraphOptions, HomeOptions


@dataclass(frozen=True)
class Launch(GraphOptions, HomeOptions):
    """Starts the simulated home with the robot in it, until Ctrl-C."""

    is_ended_by_a_person = True

    def run(self) -> int:
        from home_service.ros.conducting import stay_open
        from home_service.stage import read_home

        read_home(self)
        return stay_open(self, self.launch("world.launch"), "the home is open; Ctrl-C closes it")
