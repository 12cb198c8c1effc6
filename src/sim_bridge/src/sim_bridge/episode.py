"""An episode: a simulation stepped by control periods, with hooks (dm_control: composer.Environment)."""

import math
from typing import Callable, Optional, Sequence

from planar import Twist2
from sim_bridge.driving.idle_time import last_steps
from sim_bridge.faults.injection import FaultInjector
from sim_bridge.faults.kind import FaultContext
from sim_bridge.robot import StepResult
from sim_bridge.simulation import ROBOT_NAME, Simulation


class EpisodeHooks:
    """What takes part in an episode; override what is needed."""

    def before_step(self, episode: "Episode") -> None:
        """Change the scene before a simulation step."""

    def after_step(self, episode: "Episode", step: StepResult) -> None:
        """Receive what was measured in a simulation step, before faults of the environment are updated."""

    def at_tick(self, episode: "Episode", step: StepResult) -> None:
        """Act at the end of a control period; ``episode.command`` may be set.

        Args:
            episode: The episode.
            step: Result of the last simulation step of the period.
        """


class Episode:
    """Steps one simulation; every loop of simulation, control and judging in one process is this one.

    Args:
        simulation: The simulation.
        period: Control period [s].
        latency: Time until a command takes effect, at most the period [s].
        faults: Faults of the run, whose wrappers the simulation was built with.
        hooks: What takes part, in the order in which it is called.

    Attributes:
        simulation: The simulation.
        latency: Time until a command takes effect [s].
        command: Velocity command of the latest tick; None sends none, so that the drive keeps the last one
            until its time-out.
    """

    def __init__(
        self,
        simulation: Simulation,
        period: float,
        latency: float = 0.0,
        faults: Optional[FaultInjector] = None,
        hooks: Sequence[EpisodeHooks] = (),
    ):
        self.simulation, self.latency, self._faults, self._hooks = simulation, latency, faults, tuple(hooks)
        self._steps = round(period / simulation.step_seconds)
        self._steps_of_latency = round(latency / simulation.step_seconds)
        self.command: Optional[Twist2] = None
        self._in_flight: Optional[Twist2] = None

    def step(self, command: Optional[Twist2] = None) -> StepResult:
        """Advance by one simulation step.

        Args:
            command: Velocity command; None sends none.
        """
        for hooks in self._hooks:
            hooks.before_step(self)
        step = self.simulation.step(command)
        for hooks in self._hooks:
            hooks.after_step(self, step)
        self._update_faults(step)
        return step

    def _update_faults(self, step: StepResult) -> None:
        if self._faults is not None:
            place = FaultContext(self.simulation.scene, ROBOT_NAME, step.base_in_world)
            self._faults.update(step.stamp, place)

    def idle(self, until: float) -> bool:
        """Let time pass without the hooks while the robot stands; all but the last steps are skipped.

        Commands in flight are discarded. With a fault that is active meanwhile, no steps are skipped.

        Args:
            until: Simulated time to advance to, rounded up to whole control periods, unless a model is moved
                before [s].

        Returns:
            Whether time has passed: not if the robot or something else moves.
        """
        scene, period = self.simulation.scene, self._steps * self.simulation.step_seconds
        until = min(until, scene.moves.next_after(scene.stamp))
        count = math.ceil((until - scene.stamp) / period - 1e-6) * self._steps
        if count <= 0 or not self.simulation.park():
            return False
        self.command = self._in_flight = None
        skipped = count - last_steps(self.simulation.step_seconds)
        if skipped > 0 and (self._faults is None or self._faults.are_inactive(scene.stamp, until)):
            scene.skip(skipped)
            count -= skipped
        for _ in range(count):
            step = self.simulation.step()
            self._update_faults(step)
        self.simulation.wake()
        return True

    def advance(self) -> StepResult:
        """Advance by one control period and its tick; return the last simulation step."""
        for number in range(self._steps):
            sent = self._in_flight if number == 0 else None
            if number == self._steps_of_latency:
                sent = self.command
            step = self.step(sent)
        self._in_flight = self.command if self._steps_of_latency == self._steps else None
        for hooks in self._hooks:
            hooks.at_tick(self, step)
        return step

    def run(self, is_over: Callable[[], bool]) -> StepResult:
        """Advance until ``is_over``; return the last simulation step."""
        while True:
            step = self.advance()
            if is_over():
                return step
