"""What of an errand outlives its node: how each delivery stands, and where each object is."""

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
    """Made of what JSON knows."""
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
        "whereabouts": {
            object_name: {"place": where.place, "pose": asdict(where.pose), "is_carried": where.is_carried}
            for object_name, where in errand.object_locations.items()
        },
    }


def resume_errand(mission: Mission, record: Mapping[str, Any]) -> Optional[Errand]:
    """The errand of a mission, taken up where an earlier one was cut short.

    None if the record is of another mission.
    """
    jobs = [_job(told) for told in record["jobs"]]
    deliveries = [job.delivery for job in jobs]
    if record["mission"] != mission.name or not set(mission.deliveries) <= set(deliveries):
        return None
    for delivery in deliveries:
        if delivery not in mission.deliveries:
            mission = mission.with_delivery(delivery)
    errand = Errand(mission)
    places = {
        object_name: ObjectLocation(told["place"], Pose2(**told["pose"]), told["is_carried"])
        for object_name, told in record["whereabouts"].items()
    }
    errand.resume(jobs, places, record["is_cancelled"])
    return errand


def _job(told: Mapping[str, Any]) -> DeliveryJob:
    delivery = Delivery(**{**told["delivery"], "after": tuple(told["delivery"]["after"])})
    stage = DeliveryStage[told["stage"]]
    return DeliveryJob(delivery, RESUMED_STAGE.get(stage, stage), told["attempts"], told["reason"])
