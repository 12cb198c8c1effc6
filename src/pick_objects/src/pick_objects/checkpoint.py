"""Checkpoint of an errand, which survives its node: stages of deliveries and locations of objects."""

from dataclasses import asdict
from typing import Any, Dict, Mapping, Optional

from pick_objects.errand import Errand
from pick_objects.job import DeliveryJob, DeliveryStage, ObjectLocation
from pick_objects.mission import Delivery, Mission
from planar import Pose2

RESUMED_STAGE = {
    DeliveryStage.FETCHING: DeliveryStage.WAITING,
    DeliveryStage.PICKING_UP: DeliveryStage.WAITING,
    DeliveryStage.SETTING_DOWN: DeliveryStage.CARRYING,
}


def checkpoint_of(errand: Errand) -> Dict[str, Any]:
    """Return the errand's state as JSON-compatible values."""
    return {
        "mission": errand.mission.name,
        "is_cancelled": errand.is_cancelled,
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


def resume_errand(mission: Mission, record: Mapping[str, Any]) -> Optional[Errand]:
    """Restore an interrupted errand of a mission from a checkpoint.

    Returns:
        The errand; None if the checkpoint belongs to another mission.
    """
    jobs = [_job(entry) for entry in record["jobs"]]
    deliveries = [job.delivery for job in jobs]
    if record["mission"] != mission.name or not set(mission.deliveries) <= set(deliveries):
        return None
    for delivery in deliveries:
        if delivery not in mission.deliveries:
            mission = mission.with_delivery(delivery)
    errand = Errand(mission)
    locations = {
        object_name: ObjectLocation(entry["place"], Pose2(**entry["pose"]), entry["is_carried"])
        for object_name, entry in record["object_locations"].items()
    }
    errand.resume(jobs, locations, record["is_cancelled"])
    return errand


def _job(entry: Mapping[str, Any]) -> DeliveryJob:
    delivery = Delivery(**{**entry["delivery"], "after": tuple(entry["delivery"]["after"])})
    stage = DeliveryStage[entry["stage"]]
    return DeliveryJob(delivery, RESUMED_STAGE.get(stage, stage), entry["attempts"], entry["reason"])
