"""How a lesson went: what was tried with the robot, one after the other, and whether it did that."""

from dataclasses import dataclass, field
from typing import List, Optional

from run_project.judging.verdict import Verdict


@dataclass(frozen=True)
class Trial:
    """One thing tried, in words, with what came of it."""

    is_good: bool
    told: str


@dataclass
class Outcome:
    """All trials of a lesson."""

    trials: List[Trial] = field(default_factory=list)

    def note(self, is_good: bool, told: str) -> str:
        """Adds a trial; returns what is told of it."""
        self.trials.append(Trial(is_good, told))
        return told

    def verdict(self, failure: Optional[str] = None) -> Verdict:
        """Success if something was tried and all of it went well; ``failure``: why it was cut short."""
        good = sum(trial.is_good for trial in self.trials)
        story = "; ".join(trial.told for trial in self.trials) or "nothing tried"
        if failure:
            return Verdict(False, f"{failure}; {story}")
        return Verdict(0 < good == len(self.trials), f"{good} of {len(self.trials)} as meant: {story}")
