"""Checkpoint of an errand, which survives its node: stages of deliveries and locations of objects."""

from dataclasses import asdict
from typing import Any, Dict, Mapping, Optional, Sequence

from pick_objects.errand import Errand
from pick_objects.job import DeliveryJob, DeliveryStage, ObjectLocation
from pick_objects.mission import Delivery, Mission
from pick_objects.search.area import SearchArea
from planar import PlanarError, Pose2

RESUMED_STAGE = {
    DeliveryStage.FETCHING: DeliveryStage.WAITING,
    DeliveryStage.PICKING_UP: DeliveryStage.WAITING,
    DeliveryStage.SETTING_DOWN: DeliveryStage.CARRYING,
}


class CheckpointError(PlanarError):
    """A checkpoint is malformed, as one of another version may be."""


def checkpoint_of(errand: Errand) -> Dict[str, Any]:
    """Return the errand's state as JSON-compatible values."""
    return {
        "mission": errand.mission.name,
        "is_cancelled": errand.is_cancelled,
        "added": sorted(errand.added),
        "jobs": [
            {
                "delivery": asdict(job.delivery),
                "stage": job.stage.name,
                "attempts": job.attempts,
                "reason": job.reason,
            }
            for job in errand.jobs
        ],
        "object_locations": {
            object_name: {"place": where.place, "pose": asdict(where.pose), "is_carried": where.is_carried}
            for object_name, where in errand.object_locations.items()
        },
    }


def resume_errand(
    mission: Mission, record: Mapping[str, Any], area: Optional[SearchArea] = None
) -> Optional[Errand]:
    """Restore an interrupted errand of a mission from a checkpoint; ``area`` as of ``Errand``.

    Returns:
        The errand; None if the checkpoint belongs to another mission.

    Raises:
        CheckpointError: If the checkpoint is malformed.
    """
    try:
        return _resumed(mission, record, area)
    except CheckpointError:
        raise
    except (PlanarError, LookupError, TypeError, ValueError, AttributeError) as error:
        raise CheckpointError(f"no checkpoint of a mission ({type(error).__name__}: {error})") from error


def _resumed(mission: Mission, record: Mapping[str, Any], area: Optional[SearchArea]) -> Optional[Errand]:
    if record["mission"] != mission.name:
        return None
    jobs = [_job(entry) for entry in record["jobs"]]
    deliveries = [job.delivery for job in jobs]
    if not set(mission.deliveries) <= set(deliveries):
        return None
    names = {delivery.name for delivery in deliveries}
    _require(len(names) == len(jobs), "a delivery is listed twice")
    _require(all(names.issuperset(delivery.after) for delivery in deliveries), "a delivery waits for none")
    for delivery in deliveries:
        if delivery not in mission.deliveries:
            mission = mission.with_delivery(delivery)
    locations = {name: _location(entry) for name, entry in record["object_locations"].items()}
    carried = {name for name, where in locations.items() if where.is_carried}
    carrying = [job.delivery.object_name for job in jobs if job.stage is DeliveryStage.CARRYING]
    _require(len(carrying) <= 1 and carried == set(carrying), "what is carried is not of one delivery")
    errand = Errand(mission, area)
    errand.resume(jobs, locations, bool(record["is_cancelled"]), _texts(record["added"]))
    return errand


def _job(entry: Mapping[str, Any]) -> DeliveryJob:
    values = entry["delivery"]
    delivery = Delivery(**{**values, "after": tuple(_texts(values["after"]))})
    timeout = delivery.goal_timeout
    _require(timeout is None or (isinstance(timeout, (int, float)) and timeout > 0.0), "a time-out")
    _texts([delivery.name, delivery.object_name, entry["reason"]])
    stage = DeliveryStage[entry["stage"]]
    return DeliveryJob(delivery, RESUMED_STAGE.get(stage, stage), int(entry["attempts"]), entry["reason"])


def _location(entry: Mapping[str, Any]) -> ObjectLocation:
    place = entry["place"]
    _require(place is None or isinstance(place, str), "a place without a name")
    return ObjectLocation(place, Pose2.from_dict(entry["pose"]), bool(entry["is_carried"]))


def _texts(values: Any) -> Sequence[str]:
    _require(isinstance(values, (list, tuple)), "no list of texts")
    _require(all(isinstance(value, str) for value in values), "no texts")
    return values


def _require(is_met: bool, problem: str) -> None:
    if not is_met:
        raise CheckpointError(f"no checkpoint of a mission ({problem})")
