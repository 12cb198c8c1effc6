"""Was the errand really done? Judged by ground truth, not by what the robot believes."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Set

ARRIVAL_TOLERANCE = 0.25
ERRAND, MARKERS, DEMO = "errand", "markers", "demo"
MARKER_STORY = ["shown at pickup", "hidden", "shown at dropoff"]
FINAL_STATES = ("delivered", "failed")


@dataclass
class Ledger:
    """What was seen of a run. Errors in metres, against the true pose at the moment of arrival."""

    errors: Dict[str, float] = field(default_factory=dict)
    collisions: List[str] = field(default_factory=list)
    markers: List[str] = field(default_factory=list)
    final_state: str = ""
    failure: str = ""

    def is_complete(self, expected: Set[str]) -> bool:
        """Whether everything expected has been seen, or can no longer come."""
        if self.failure or self.final_state == "failed":
            return True
        errand_is_over = ERRAND not in expected or self.final_state in FINAL_STATES
        marker_is_done = not expected & {MARKERS, DEMO} or self.markers[-1:] == MARKER_STORY[-1:]
        return errand_is_over and marker_is_done


@dataclass(frozen=True)
class Verdict:
    """Whether a run succeeded, and why."""

    success: bool
    reason: str


def judge(ledger: Ledger, expected: Set[str]) -> Verdict:
    """Success only if all that was expected was truly seen and nothing was hit."""
    complaint = ledger.failure or None
    if complaint is None and ERRAND in expected:
        complaint = _complaint_about_errand(ledger)
    if complaint is None and expected & {MARKERS, DEMO} and ledger.markers != MARKER_STORY:
        complaint = (
            f"the marker was {', '.join(ledger.markers) or 'never shown'}, not {', '.join(MARKER_STORY)}"
        )
    if complaint is None and ledger.collisions:
        complaint = f"collided with {', '.join(sorted(set(ledger.collisions)))}"
    return Verdict(complaint is None, complaint or _praise(ledger, expected))


def _complaint_about_errand(ledger: Ledger) -> Optional[str]:
    if ledger.final_state != "delivered":
        return f"the errand ended in the state '{ledger.final_state or 'not started'}'"
    for zone in ("pickup", "dropoff"):
        error = ledger.errors.get(zone)
        if error is None:
            return f"the robot never said that it arrived at {zone}"
        if error > ARRIVAL_TOLERANCE:
            return f"at {zone} the robot truly stood {error:.2f} m off, more than {ARRIVAL_TOLERANCE} m"
    return None


def _praise(ledger: Ledger, expected: Set[str]) -> str:
    if ERRAND not in expected:
        return f"the marker was {', '.join(ledger.markers)}"
    worst = max(ledger.errors.values())
    return f"picked up and delivered, at most {worst:.2f} m off the zones, no collision"
